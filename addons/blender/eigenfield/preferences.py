"""Where the program eigenfield is."""

import bpy

from .program import find_program


class EIGENFIELD_AP_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(
        name="eigenfield", description="The program; empty: the one that the system finds", subtype="FILE_PATH"
    )

    def draw(self, context):
        self.layout.prop(self, "program")


def program(context):
    addon = context.preferences.addons.get(__package__)  # None: registered by hand, without preferences
    return find_program(bpy.path.abspath(addon.preferences.program) if addon is not None else "")


def register():
    bpy.utils.register_class(EIGENFIELD_AP_preferences)


def unregister():
    bpy.utils.unregister_class(EIGENFIELD_AP_preferences)
