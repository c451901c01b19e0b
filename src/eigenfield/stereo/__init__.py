"""Depth from many photographs: plane sweep, semi-global optimisation, refinement over all views."""

from eigenfield.stereo.canvas import Canvas, view_matrices

__all__ = ["Canvas", "view_matrices"]
