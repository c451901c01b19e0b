"""The captures that `eigenfield demo` draws: a glossy jar, balls of glass and chrome, exactly known geometry."""

from eigenfield.demo.capture import DEMO_COLUMNS, DEMO_ROWS, draw_demo_capture
from eigenfield.demo.clip import demo_clip_proxy, draw_demo_clip

__all__ = ["DEMO_COLUMNS", "DEMO_ROWS", "demo_clip_proxy", "draw_demo_capture", "draw_demo_clip"]
