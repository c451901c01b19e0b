"""Captures: photographs with one camera each, read from nerfstudio / instant-ngp `transforms.json` or COLMAP models.

    light_field = open_capture("capture/")
    photograph = light_field.photograph(0)   # decoded now, lens removed, mask beside it

`docs/captures.md` says what is read, under which conventions, and what trips people.
"""

from __future__ import annotations

from eigenfield.capture.lens import Lens
from eigenfield.capture.lightfield import LightField, Photograph, View
from eigenfield.capture.opening import open_capture
from eigenfield.capture.photographs import Header, read_header

__all__ = ["Header", "Lens", "LightField", "Photograph", "View", "open_capture", "read_header"]
