"""Weights, cameras, names and triangles in few bytes."""
