"""Shapes put into a mesh by hand."""
