"""Layered reliefs: depth maps of one camera, as a mesh."""
