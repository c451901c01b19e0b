"""Triangle meshes in few bytes."""
