"""From photographs to cameras and a proxy mesh (section 3.1 of the paper)."""

from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.whole import Reconstruction, reconstruct

__all__ = ["Reconstruction", "looks_one_way", "reconstruct"]
