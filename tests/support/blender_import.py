"""Run by Blender's Python: import a scene where its pictures were rendered, and render it from between the cameras.

python blender_import.py ADDON.zip FOLDER PROGRAM, where FOLDER has scene.glb and PROGRAM is eigenfield.
"""

import json
import shutil
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler, Matrix

addon, folder, program = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=addon, repo="user_default", enable_on_install=True)
bpy.context.preferences.addons["bl_ext.user_default.eigenfield"].preferences.program = program
assert bpy.ops.eigenfield.import_scene(filepath=str(folder / "scene.glb"), upright=False) == {"FINISHED"}
scene, camera = bpy.context.scene, bpy.context.scene.camera
np.save(folder / "camera.npy", np.array(camera.matrix_world))

scene.render.engine, scene.cycles.samples = "CYCLES", 16
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = 72, 96
place = Matrix.LocRotScale((0.2, -6, 1.4), Euler((1.5, 0, 0.05)), None)
camera.data.sensor_fit, camera.data.lens = "AUTO", 50.0
camera.matrix_world = place @ Matrix.Translation((0.1, 0.05, 0))
scene.render.filepath = str(folder / "drawn.png")
bpy.ops.render.render(write_still=True)


def texture():
    (image,) = (image for image in bpy.data.images if image.name.endswith("texture"))
    width, height = image.size
    return np.array(image.pixels).reshape(height, width, 4)[::-1, :, :3]


np.save(folder / "texture.npy", texture())
camera.matrix_world = place @ Matrix.Translation((9, -9, 0))  # beyond the array: as from its corner
bpy.context.view_layer.update()
np.save(folder / "corner.npy", texture())
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "imported.blend"))
(folder / "scene.textures").rename(folder / "moved")
bpy.ops.wm.open_mainfile(filepath=str(folder / "imported.blend"))
np.save(folder / "reopened.npy", texture())
(folder / "moved").rename(folder / "scene.textures")
try:
    bpy.ops.eigenfield.import_scene(filepath=str(folder / "broken.glb"))
except RuntimeError as error:
    (folder / "refused.txt").write_text(str(error))
stranger = folder / "stranger.textures"
shutil.copytree(folder / "scene.textures", stranger)
(stranger / "mesh.mtl").write_text("newmtl mean\nmap_Kd ../drawn.png\n")
before = {image.filepath for image in bpy.data.images}
assert bpy.ops.eigenfield.import_scene(filepath=str(stranger / "eigenfield.json")) == {"FINISHED"}
assert {image.filepath for image in bpy.data.images} == before, "a material's picture was read"
listing = json.loads((stranger / "eigenfield.json").read_text())
(stranger / "eigenfield.json").write_text(json.dumps({**listing, "mean": "../drawn.png"}))
try:
    bpy.ops.eigenfield.import_scene(filepath=str(stranger / "eigenfield.json"))
except RuntimeError as error:
    (folder / "outside.txt").write_text(str(error))
