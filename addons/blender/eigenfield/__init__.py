"""eigenfield in Blender: arrays of cameras are rendered and encoded, and its scenes are looked at."""

from . import array, encode, imported, panel, preferences, program, sight

PARTS = preferences, array, sight, encode, imported, panel


def register():
    for part in PARTS:
        part.register()


def unregister():
    program.stop_all()  # also called where Blender is left
    for part in reversed(PARTS):
        part.unregister()
