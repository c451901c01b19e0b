"""A scene for other programs: a page, a video, meshes with textures, texture maps, a quilt, photographs with a model,
Gaussians.

Each kind is a module. What is written is whole or absent; existing files stay unless `overwrite` says otherwise.
"""

from __future__ import annotations

from eigenfield.viewer.exports.app import write_app
from eigenfield.viewer.exports.clip_folder import write_clip_folder
from eigenfield.viewer.exports.colmap import write_colmap
from eigenfield.viewer.exports.export import OPTIONS, export
from eigenfield.viewer.exports.folder import refuse_folder
from eigenfield.viewer.exports.glb import write_glb
from eigenfield.viewer.exports.guests import write_guests_page
from eigenfield.viewer.exports.maps import write_maps
from eigenfield.viewer.exports.names import file_names
from eigenfield.viewer.exports.obj import write_obj, write_obj_folder
from eigenfield.viewer.exports.quilt import QUILT_DEVICES, quilt_of, write_quilt
from eigenfield.viewer.exports.splats import write_splats
from eigenfield.viewer.exports.usdz import write_usdz
from eigenfield.viewer.exports.views import write_views
from eigenfield.viewer.page import write_page

__all__ = [
    "OPTIONS",
    "QUILT_DEVICES",
    "export",
    "file_names",
    "quilt_of",
    "refuse_folder",
    "write_app",
    "write_clip_folder",
    "write_colmap",
    "write_glb",
    "write_guests_page",
    "write_maps",
    "write_obj",
    "write_obj_folder",
    "write_page",
    "write_quilt",
    "write_splats",
    "write_usdz",
    "write_views",
]
