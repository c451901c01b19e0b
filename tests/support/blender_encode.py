"""Run by Blender's Python: encode the rendered array from the panel, and look at what the panel shows meanwhile.

python blender_encode.py ADDON.zip FOLDER PROGRAM, where FOLDER holds a capture, and PROGRAM is eigenfield.
"""

import importlib
import json
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import bpy

addon, folder, program = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
bpy.ops.wm.read_factory_settings()
bpy.ops.extensions.package_install_files(filepath=addon, repo="user_default", enable_on_install=True)
NAME = "bl_ext.user_default.eigenfield"
preferences = bpy.context.preferences.addons[NAME].preferences
parts = {name: importlib.import_module(f"{NAME}.{name}") for name in ("encode", "panel", "sight", "steps", "program")}
Run, said = parts["encode"].Run, {}
scene = bpy.context.scene


class Layout:
    """Takes what a panel draws."""

    def __init__(self, drawn):
        self.drawn = drawn

    def label(self, text="", icon="NONE"):
        self.drawn.append(text)

    def operator(self, name, text="", icon="NONE"):
        self.drawn.append(f"[{text or name}]")
        return SimpleNamespace()

    def progress(self, factor, text):
        self.drawn.append(f"{text} ({factor:.2f})")

    def prop(self, owner, name):
        getattr(owner, name)

    def separator(self):
        pass

    def column(self, align=False):
        return self

    row = box = column


def draw(kind):
    drawn = []
    panel = getattr(parts["panel"], f"EIGENFIELD_PT_{kind}")
    panel.draw(SimpleNamespace(layout=Layout(drawn)), bpy.context)
    return drawn


# an array before a cube of 2 units, 8 to 10 units away
camera = scene.camera
camera.matrix_world.identity()
camera.location, camera.rotation_euler = (0, -9, 0), (1.5707963, 0, 0)
camera.data.lens, camera.data.sensor_width = 36, 36
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 800, 600, 100
settings = scene.eigenfield
said["promises"] = []
for spacing in (0.1, 1.0):
    settings.spacing = spacing
    said["promises"].append(parts["sight"].promise(bpy.context))
found = dict(parts["sight"].known)
settings.spacing = 0.5
bpy.context.view_layer.update()
said["kept"] = parts["sight"].known == found and bool(found)  # no box is looked at anew
bpy.data.objects["Cube"].location.y = 1
bpy.context.view_layer.update()
said["moved"] = parts["sight"].promise(bpy.context)
bpy.data.objects["Cube"].hide_render = True
bpy.context.view_layer.update()
said["empty"] = parts["sight"].promise(bpy.context)
said["array"] = draw("array")
bpy.data.objects["Cube"].hide_render = False
bpy.context.view_layer.update()
said["array with a cube"] = draw("array")

settings.folder = str(folder / "nothing")
said["not rendered"] = draw("encode")
settings.folder = str(folder)
preferences.program = str(folder / "no program")
said["idle"] = draw("encode")
try:
    bpy.ops.eigenfield.encode()
except RuntimeError as error:
    said["no program"] = str(error)

# as with a window, where it goes on beside Blender
preferences.program = program
parts["encode"].start(bpy.context)
until = time.monotonic() + 120
while Run.job.part is None and time.monotonic() < until:
    time.sleep(0.02)
said["running"] = draw("encode")
assert not bpy.ops.eigenfield.encode.poll()
bpy.ops.eigenfield.cancel()
while Run.is_running() and time.monotonic() < until:
    time.sleep(0.02)
said["stopped"] = draw("encode")

assert bpy.ops.eigenfield.encode() == {"FINISHED"}
said["done"], said["output"] = draw("encode"), str(Run.output)

(folder / "proxy.obj").rename(folder / "kept.obj")
(folder / "proxy.obj").write_text("nothing")
try:
    bpy.ops.eigenfield.encode()
except RuntimeError as error:
    said["error"] = str(error)
said["failed"] = draw("encode")
(folder / "kept.obj").replace(folder / "proxy.obj")


# an operator with a window: what Blender is told, step by step, and what Esc does
class Told:
    bl_label = "Import"

    def __init__(self, count):
        self.reports, self.count, self.closed = [], count, False

    def steps(self, context):
        try:
            for number in range(self.count):
                yield number / 2, f"picture {number}"
            raise parts["program"].RefusalError("no more")
        finally:
            self.closed = True

    def report(self, kind, text):
        self.reports.append(text)


class Window:
    def __init__(self):
        self.said = []
        self.window_manager, self.workspace, self.window = self, self, None
        self.event_timer_add = lambda seconds, window: "timer"
        self.event_timer_remove = self.progress_begin = self.progress_update = lambda *_: None
        self.progress_end = lambda: None
        self.modal_handler_add = lambda operator: None
        self.status_text_set = self.said.append


Stepped = parts["steps"].Stepped
for name, events in (("to the end", ["TIMER", "MOUSEMOVE", "TIMER", "TIMER"]), ("escaped", ["TIMER", "ESC"])):
    kind = type("Operator", (Told, Stepped), {})
    told, window = kind(2), Window()
    results = [told.invoke(window, None), *(told.modal(window, SimpleNamespace(type=event)) for event in events)]
    said[name] = [window.said, told.reports, told.closed, [next(iter(result)) for result in results]]

for name, leave in (
    ("after load", lambda: bpy.ops.wm.read_homefile(use_empty=True)),
    ("after disabling", lambda: bpy.ops.preferences.addon_disable(module=NAME)),  # as where Blender is left
):
    bpy.context.scene.eigenfield.folder = str(folder)
    parts["encode"].start(bpy.context)
    job = Run.job
    leave()
    while job.is_running and time.monotonic() < until:
        time.sleep(0.02)
    said[name] = [job.stopped, job.is_running, job.error]
(folder / "said.json").write_text(json.dumps(said, indent=1))
