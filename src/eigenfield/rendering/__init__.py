"""Viewpoints into pictures: view weights, novel cameras, the software renderer and the OpenGL one."""

from __future__ import annotations

from eigenfield.rendering.novel import FLIGHT_FRAMES, FLIGHT_PATHS, novel_camera, path_points
from eigenfield.rendering.opengl.renderer import OpenGLRenderer
from eigenfield.rendering.options import TEXTURE_FILTERS, PictureOptions
from eigenfield.rendering.picture import Picture, camera_colour
from eigenfield.rendering.render_jobs import RenderJob
from eigenfield.rendering.render_many import render_many
from eigenfield.rendering.software.renderer import (
    Renderer,
    at_resolution,
    camera_index,
    draw_texture,
    render,
    renderer_of,
    viewpoint,
    viewpoint_colour,
)
from eigenfield.rendering.texture import mean_texture, texture
from eigenfield.rendering.video import write_video
from eigenfield.rendering.weight_map import weight_map
from eigenfield.rendering.weights import WEIGHT_MODES, ViewWeights, camera_weights, delaunay_triangles, view_weights

__all__ = [
    "FLIGHT_FRAMES", "FLIGHT_PATHS", "TEXTURE_FILTERS", "WEIGHT_MODES", "OpenGLRenderer", "Picture", "PictureOptions",
    "RenderJob", "Renderer", "ViewWeights", "at_resolution", "camera_colour", "camera_index", "camera_weights",
    "delaunay_triangles", "draw_texture", "mean_texture", "novel_camera", "path_points", "render", "render_many",
    "renderer_of", "texture", "view_weights", "viewpoint", "viewpoint_colour", "weight_map", "write_video",
]  # fmt: skip
