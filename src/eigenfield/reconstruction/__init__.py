"""From photographs to cameras and a proxy mesh (the paper's section 3.1)."""

from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.report import ProxyReport
from eigenfield.reconstruction.run import DEFAULT_TRIANGLES, SURFACES, Settings
from eigenfield.reconstruction.whole import Reconstruction, reconstruct

__all__ = ["DEFAULT_TRIANGLES", "SURFACES", "ProxyReport", "Reconstruction", "Settings", "looks_one_way", "reconstruct"]
