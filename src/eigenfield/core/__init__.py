"""Plain data: cameras, meshes, the view plane, scenes; errors and progress."""
