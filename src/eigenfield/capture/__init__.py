"""Captures: photographs with one camera each (`LightField`), or photographs alone (`PhotoSet`).

    light_field = open_capture("capture/")   # a calibration of any format in `formats.FORMATS`
    photograph = light_field.photograph(0)   # decoded now, lens removed, mask beside it
    photo_set = open_photographs("photos/")  # no cameras; the grid that the names state is `photo_set.layout`
    either = open_any("folder/")
    footage = open_footage("videos/")        # one of these at each instant: `footage.instant(0)`

`docs/capture-formats.md` describes the formats, their conventions and common pitfalls.
"""

from __future__ import annotations

from eigenfield.capture.footage import Footage
from eigenfield.capture.formats import FORMATS
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.opening import open_any, open_capture, open_path, open_photographs
from eigenfield.capture.opening_footage import open_footage
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.photoset import Capture, PhotoSet, Shot
from eigenfield.capture.scene_photographs import match_photographs, with_scene_cameras
from eigenfield.core.observations import Photograph

__all__ = [
    "FORMATS",
    "Capture",
    "Footage",
    "GridLayout",
    "Lens",
    "LightField",
    "PhotoSet",
    "Photograph",
    "Shot",
    "View",
    "match_photographs",
    "open_any",
    "open_capture",
    "open_footage",
    "open_path",
    "open_photographs",
    "read_header",
    "with_scene_cameras",
]
