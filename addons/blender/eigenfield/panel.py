"""The tab Eigenfield in the sidebar of the 3D view."""

import textwrap

import bpy

from .array import array_of
from .encode import Run, rendered
from .imported import CLIP, FRAME, EIGENFIELD_OT_import, timeline_of
from .parallax import MEANINGS
from .program import RefusalError
from .sight import promise

CHARACTER_PIXELS = 7  # of a label at the usual size, on average


def write(layout, context, text, icon="NONE"):
    """A text in as many lines as the panel needs."""
    width = context.region.width if context.region else 300
    scale = context.preferences.system.ui_scale or 1  # 0 without a window
    characters = max(16, int(width / scale / CHARACTER_PIXELS) - 4)
    column = layout.column(align=True)
    for number, line in enumerate(textwrap.wrap(text, characters, break_on_hyphens=False)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1" if icon != "NONE" else "NONE")


def draw_promise(layout, context):
    """What lies between the nearest and the farthest thing in view, from a camera to the next."""
    try:
        found = promise(context)
    except RefusalError as error:
        write(layout, context, str(error), icon="INFO")
        return
    if found is None:
        return
    units, word = context.scene.unit_settings, found["word"]

    def length(name):
        return bpy.utils.units.to_string(units.system, "LENGTH", found[name] * units.scale_length, precision=3)

    box = layout.box()
    write(box, context, f"Parallax {found['pixels']:.3g} px, {found['ratio']:.1%} of the longer side")
    write(box, context, f"{length('near')} to {length('far')} away")
    write(box, context, f"{word}: {MEANINGS[word]}", icon="CHECKMARK" if word == "good" else "INFO")
    if word != "good":
        write(box, context, f"good up to a spacing of {length('good')}")


class EIGENFIELD_PT_array(bpy.types.Panel):
    bl_label = "Camera Array"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenfield"

    def draw(self, context):
        settings, layout = context.scene.eigenfield, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(align=True)
        for name in ("rows", "columns", "spacing"):
            column.prop(settings, name)
        layout.prop(settings, "use_zero_plane")
        line = layout.row()
        line.enabled = settings.use_zero_plane
        line.prop(settings, "distance")
        draw_promise(layout, context)
        shown = array_of(context.scene) is not None
        layout.operator("eigenfield.show_array", text="Update the cameras" if shown else "Show the cameras")
        if shown:
            layout.operator("eigenfield.hide_array")
        layout.separator()
        layout.prop(settings, "folder")
        layout.prop(settings, "animation")
        layout.operator("eigenfield.render_array", icon="RENDER_STILL")


class EIGENFIELD_PT_encode(bpy.types.Panel):
    bl_label = "Encode"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenfield"

    def draw(self, context):
        layout, job = self.layout, Run.job
        if Run.is_running():
            part = job.part
            layout.progress(factor=part or 0, text=job.words if part is None else f"{part:.0%}, {job.words}")
            layout.operator("eigenfield.cancel", icon="CANCEL", text="Stopping" if job.stopped else "Cancel")
            return
        try:
            rendered(context.scene)
        except RefusalError as error:
            write(layout, context, str(error), icon="INFO")
        else:
            layout.operator("eigenfield.encode", icon="FILE_MOVIE")
        if job is None or job.stopped:
            return
        if job.error:
            write(layout, context, job.error, icon="ERROR")
            return
        for line in job.output[:2]:  # the third is the command that Open runs
            write(layout, context, line.replace(str(Run.output), Run.output.name))
        line = layout.row()
        line.operator("eigenfield.open", icon="URL")
        again = line.operator(EIGENFIELD_OT_import.bl_idname, icon="IMPORT", text="Import")
        again.filepath, again.known = str(Run.output), True
        if Run.viewer is not None and not Run.viewer.is_running and Run.viewer.error:
            write(layout, context, Run.viewer.error, icon="ERROR")


class EIGENFIELD_PT_clip(bpy.types.Panel):
    bl_label = "Clip"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenfield"

    @classmethod
    def poll(cls, context):
        return context.object is not None and CLIP in context.object

    def draw(self, context):
        mesh = context.object
        self.layout.prop(mesh, "eigenfield_time")
        write(self.layout, context, f"Frame {mesh[FRAME]} of {timeline_of(mesh).frames}, counted from 0")


CLASSES = EIGENFIELD_PT_array, EIGENFIELD_PT_encode, EIGENFIELD_PT_clip


def register():
    for of in CLASSES:
        bpy.utils.register_class(of)


def unregister():
    for of in reversed(CLASSES):
        bpy.utils.unregister_class(of)
