"""Layered reliefs: depth maps seen from one camera, as a mesh."""
