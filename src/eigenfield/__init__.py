"""eigenfield: photographs from a camera array in, one small .glb to look around in out."""

from __future__ import annotations

__version__ = "0.1.0"
