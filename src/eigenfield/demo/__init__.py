"""The captures that `eigenfield demo` draws: a glossy jar, balls of glass and chrome, exactly known geometry."""

from eigenfield.demo.capture import DEMO_COLUMNS, DEMO_ROWS, draw_demo_capture
from eigenfield.demo.clip import CLIP_MESHES, draw_demo_clip

__all__ = ["CLIP_MESHES", "DEMO_COLUMNS", "DEMO_ROWS", "draw_demo_capture", "draw_demo_clip"]
