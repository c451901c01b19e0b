"""From photographs to cameras and a proxy mesh (section 3.1 of the paper)."""

from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.run import ReconstructionSettings
from eigenfield.reconstruction.whole import Reconstruction, check_settings, reconstruct

__all__ = ["Reconstruction", "ReconstructionSettings", "check_settings", "looks_one_way", "reconstruct"]
