"""A capture that was rendered becomes a scene: `eigenfield encode` in the background, and what it says at the end."""

import time

import bpy
from bpy.app.handlers import persistent

from .array import capture_folder
from .preferences import program
from .program import Job, RefusalError

WATCH_SECONDS = 0.25  # between two looks at the program


class Run:
    """The encode that the panel shows: that which runs, else the last one.

    Attributes:
        job: Its Job; None before the first.
        output: The .glb.
        viewer: The Job that shows a scene in the browser, or None.
    """

    job = output = viewer = None

    @classmethod
    def is_running(cls):
        return cls.job is not None and cls.job.is_running


def rendered(scene):
    """The folder of the array's pictures, of an animation that of the present frame."""
    settings = scene.eigenfield
    folder = capture_folder(settings)
    if settings.animation:
        folder /= f"frame_{scene.frame_current:04}"
    if not (folder / "transforms.json").is_file():
        raise RefusalError(f"{folder} has no transforms.json: render the array first")
    return folder


def start(context):
    folder = rendered(context.scene)
    output = folder.parent / f"{folder.name or 'scene'}.glb"
    words = ["encode", folder, "-o", output, "--overwrite", "--progress", "json"]
    if (folder / "proxy.obj").is_file():
        words += ["--proxy", folder / "proxy.obj"]
    Run.job, Run.output = Job(program(context), *words), output


def watch():
    """Called by Blender now and then while a job runs, so that the panel is drawn anew."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return WATCH_SECONDS if Run.is_running() or (Run.viewer is not None and Run.viewer.is_running) else None


def watch_soon():
    if not bpy.app.timers.is_registered(watch):
        bpy.app.timers.register(watch, first_interval=WATCH_SECONDS)


class EIGENFIELD_OT_encode(bpy.types.Operator):
    bl_idname = "eigenfield.encode"
    bl_label = "Encode"
    bl_description = "Make a scene of the rendered pictures, beside their folder, while Blender goes on"

    @classmethod
    def poll(cls, context):
        return not Run.is_running()

    def execute(self, context):
        try:
            start(context)
            if bpy.app.background:  # a script waits for it
                while Run.is_running():
                    time.sleep(WATCH_SECONDS)
                if Run.job.error:
                    raise RefusalError(Run.job.error)
        except (RefusalError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        watch_soon()
        return {"FINISHED"}


class EIGENFIELD_OT_cancel(bpy.types.Operator):
    bl_idname = "eigenfield.cancel"
    bl_label = "Cancel"
    bl_description = "Stop the encode"

    def execute(self, context):
        if Run.is_running():
            Run.job.stop()
        return {"FINISHED"}


class EIGENFIELD_OT_open(bpy.types.Operator):
    bl_idname = "eigenfield.open"
    bl_label = "Open"
    bl_description = "Look around in the scene, in the browser"

    def execute(self, context):
        if Run.viewer is not None and Run.viewer.is_running:
            Run.viewer.stop()
        try:
            Run.viewer = Job(program(context), "view", Run.output)
        except RefusalError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        watch_soon()
        return {"FINISHED"}


@persistent
def after_load(*_):
    """Another file has another array."""
    if Run.is_running():
        Run.job.stop()
    Run.job = Run.output = None


CLASSES = EIGENFIELD_OT_encode, EIGENFIELD_OT_cancel, EIGENFIELD_OT_open


def register():
    for of in CLASSES:
        bpy.utils.register_class(of)
    bpy.app.handlers.load_post.append(after_load)


def unregister():
    if bpy.app.timers.is_registered(watch):
        bpy.app.timers.unregister(watch)
    bpy.app.handlers.load_post.remove(after_load)
    for of in reversed(CLASSES):
        bpy.utils.unregister_class(of)
