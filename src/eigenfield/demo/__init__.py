"""The capture that `eigenfield demo` draws: a glossy jar, balls of glass and chrome, exactly known geometry."""

from eigenfield.demo.capture import DEMO_COLUMNS, DEMO_ROWS, draw_demo_capture

__all__ = ["DEMO_COLUMNS", "DEMO_ROWS", "draw_demo_capture"]
