"""From photographs to cameras and a proxy mesh (section 3.1 of the paper)."""

from eigenfield.reconstruction.options import SurfaceOptions

__all__ = ["SurfaceOptions"]
