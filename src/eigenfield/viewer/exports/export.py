"""A scene for other programs, by the name of what is written or by its kind."""

from __future__ import annotations

import os
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Scene, check_scale
from eigenfield.gltf import load
from eigenfield.rendering import RenderJob, path_points
from eigenfield.rendering.render_jobs import refuse_flight, write_flight
from eigenfield.runtime.files import is_numbered, refuse_existing
from eigenfield.viewer.exports.colmap import write_colmap
from eigenfield.viewer.exports.folder import refuse_folder
from eigenfield.viewer.exports.maps import write_maps
from eigenfield.viewer.exports.obj import refuse_obj, write_obj, write_obj_folder
from eigenfield.viewer.exports.quilt import quilt_of, write_quilt
from eigenfield.viewer.page import write_page

PICTURE_OPTIONS = {"resolution", "background", "weights", "filter", "textures", "samples", "renderer"}
OPTIONS = {  # of each kind, beside the options of all
    "html": {"title", "metres_per_unit"},
    "mp4": PICTURE_OPTIONS | {"path", "frames", "fps"},
    "png": PICTURE_OPTIONS | {"path", "frames"},
    "obj": {"textures"},
    "maps": {"textures"},
    "quilt": PICTURE_OPTIONS | {"quilt", "spread"},
    "colmap": PICTURE_OPTIONS | {"path", "frames", "residual"},
}
