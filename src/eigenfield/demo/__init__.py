"""The capture that `eigenfield demo` draws: a glossy jar before a wall, with exactly known geometry."""

from eigenfield.demo.capture import draw_demo_capture

__all__ = ["draw_demo_capture"]
