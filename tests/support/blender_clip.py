"""Run by Blender's Python: import a frame of a clip, read others by their times, and open the file that was saved.

python blender_clip.py ADDON.zip FOLDER PROGRAM, where FOLDER has clip.glb and PROGRAM is eigenfield.
"""

import importlib
import json
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np

addon, folder, program = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=addon, repo="user_default", enable_on_install=True)
NAME = "bl_ext.user_default.eigenfield"
preferences = bpy.context.preferences.addons[NAME].preferences
preferences.program = program
panel = importlib.import_module(f"{NAME}.panel").EIGENFIELD_PT_clip
said = {"before": panel.poll(bpy.context), "panel": [], "folders": [], "times": []}


class Layout:
    """Takes what the panel draws."""

    def label(self, text="", icon="NONE"):
        said["panel"].append(text)

    def prop(self, owner, name):
        getattr(owner, name)

    def column(self, align=False):
        return self


def keep(name):
    """What is seen: the texture, the vertices, and what the panel says."""
    (image,) = (image for image in bpy.data.images if image.name.endswith("texture"))
    (mesh,) = bpy.data.meshes
    (shown,) = (shown for shown in bpy.data.objects if shown.type == "MESH")
    assert [slot.name for slot in shown.material_slots] == [bpy.data.materials[0].name] and len(bpy.data.materials) == 1
    width, height = image.size
    np.savez(
        folder / f"{name}.npz",
        texture=np.array(image.pixels).reshape(height, width, 4)[::-1, :, :3],
        vertices=np.array([vertex.co for vertex in mesh.vertices]),
    )
    assert panel.poll(bpy.context)
    panel.draw(SimpleNamespace(layout=Layout()), bpy.context)
    said["folders"].append(Path(shown["eigenfield_folder"]).name)
    said["times"].append(shown.eigenfield_time)
    return shown


assert bpy.ops.eigenfield.import_scene(filepath=str(folder / "clip.glb"), upright=False, time=0.22) == {"FINISHED"}
shown = keep("second")
shown.eigenfield_time = 0.43
shown = keep("fourth")
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "clip.blend"))
bpy.ops.wm.open_mainfile(filepath=str(folder / "clip.blend"))
shown = keep("opened")
preferences = bpy.context.preferences.addons[NAME].preferences
preferences.program = str(folder / "no program")
try:
    shown.eigenfield_time = 0.1
except RuntimeError as error:
    print(error)
keep("kept")
preferences.program = program
shown.eigenfield_time = 0
keep("first")
(folder / "said.json").write_text(json.dumps(said, indent=1))
