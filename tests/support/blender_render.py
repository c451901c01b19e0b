"""Run by Blender's Python: install the add-on's zip, render a small array, and a picture from between its cameras.

python blender_render.py ADDON.zip FOLDER, where BLENDER_USER_RESOURCES names a folder of its own.
"""

import sys
from math import pi
from pathlib import Path

import bpy
from mathutils import Matrix

addon, folder = sys.argv[1], Path(sys.argv[2])
bpy.ops.wm.read_factory_settings()
bpy.ops.extensions.package_install_files(filepath=addon, repo="user_default", enable_on_install=True)
scene = bpy.context.scene
bpy.data.objects.remove(bpy.data.objects["Cube"])


def add(kind, colours, **options):
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**options)
    made, material = bpy.context.object, bpy.data.materials.new(kind)
    if material.node_tree is None:
        material.use_nodes = True
    nodes = material.node_tree.nodes
    pattern = nodes.new(f"ShaderNodeTex{colours}")
    pattern.inputs["Scale"].default_value = 4.0
    light = nodes.new("ShaderNodeEmission")
    material.node_tree.links.new(pattern.outputs["Color"], light.inputs["Color"])
    shining, mirror = nodes.new("ShaderNodeAddShader"), nodes.new("ShaderNodeBsdfGlossy")
    mirror.inputs["Roughness"].default_value = 0.1  # what is seen depends on the place
    mirror.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1)
    light.inputs["Strength"].default_value = 0.4
    material.node_tree.links.new(light.outputs[0], shining.inputs[0])
    material.node_tree.links.new(mirror.outputs[0], shining.inputs[1])
    material.node_tree.links.new(shining.outputs[0], nodes["Material Output"].inputs["Surface"])
    made.data.materials.append(material)
    return made


ball = add("ico_sphere", "Voronoi", location=(0, 0, 1), subdivisions=2)
ball.modifiers.new("finer", "SUBSURF").levels = 0  # finer in a render than in the window
add("cube", "Checker", location=(-1.5, 1.5, 0.5), size=1.4, rotation=(0, 0, 0.6))
add("plane", "Noise", location=(0, 3, 1), size=9, rotation=(pi / 2, 0, 0))
add("cube", "Checker", location=(0, -3, 1)).hide_render = True  # would be before everything

camera = scene.camera
camera.location, camera.rotation_euler, camera.scale = (0.2, -6, 1.4), (1.5, 0, 0.05), (2, 2, 2)
scene.render.engine, scene.cycles.samples = "CYCLES", 16
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 300, 400, 24
scene.render.image_settings.color_mode = "RGBA"
settings = scene.eigenfield
settings.rows, settings.columns, settings.spacing, settings.folder = 2, 3, 0.3, str(folder)
settings.use_zero_plane, settings.distance = True, 6.0
before = scene.render.filepath, scene.frame_current, set(bpy.data.objects), len(bpy.data.cameras)
assert bpy.ops.eigenfield.render_array() == {"FINISHED"}
assert scene.camera == camera and scene.render.image_settings.color_mode == "RGBA"
assert (scene.render.filepath, scene.frame_current, set(bpy.data.objects), len(bpy.data.cameras)) == before

settings.rows, settings.columns, settings.animation, settings.folder = 1, 3, True, str(folder / "film")
scene.frame_start, scene.frame_end = 3, 4
for frame, x in ((3, 0.0), (4, 1.0)):
    ball.location.x = x
    ball.keyframe_insert("location", frame=frame)
assert bpy.ops.eigenfield.show_array() == {"FINISHED"}
scene.camera = bpy.data.objects["view_00_01"]  # the array stands around its middle all the same
assert bpy.ops.eigenfield.render_array() == {"FINISHED"}
assert scene.camera == camera and "view_00_01" in bpy.data.objects
assert bpy.ops.eigenfield.hide_array() == {"FINISHED"} and "view_00_01" not in bpy.data.objects

scene.frame_set(3)
camera.matrix_world = camera.matrix_world.normalized() @ Matrix.Translation((0.1, 0.05, 0))
scene.render.filepath = str(folder / "between.png")
scene.render.image_settings.color_mode = "RGB"
bpy.ops.render.render(write_still=True)

camera.data.type = "ORTHO"
try:
    bpy.ops.eigenfield.render_array()
except RuntimeError as error:
    (folder / "refused.txt").write_text(str(error))
