"""eigenfield in Blender: arrays of cameras are rendered for `eigenfield encode`, and its scenes are looked at."""

from . import array, imported


def register():
    array.register()
    imported.register()


def unregister():
    imported.unregister()
    array.unregister()
