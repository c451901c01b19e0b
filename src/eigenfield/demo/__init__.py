"""The capture that `eigenfield demo` draws: a glossy jar before a wall, with exactly known geometry."""

from eigenfield.demo.capture import draw_demo_capture
from eigenfield.demo.geometry import demo_scene_geometry

__all__ = ["demo_scene_geometry", "draw_demo_capture"]
