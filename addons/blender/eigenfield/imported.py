"""A scene of eigenfield: its mesh, and the texture that the active camera sees, which follows that camera.

Blender decodes neither AV1 nor the coded mesh, and its Python cannot hold what eigenfield needs. So the program
eigenfield writes mean, eigen textures and weights as plain files (`eigenfield export --as obj`), and this reads those.
"""

import json
import tempfile
from math import tan
from pathlib import Path

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy_extras.io_utils import ImportHelper
from mathutils import Matrix, Quaternion

from .clip import Timeline, is_clip, timeline_steps
from .field import LISTING, Field, inside, read_field
from .preferences import program
from .program import Job, RefusalError
from .steps import Stepped

EXPORT_PART, READ_PART = 0.75, 0.2  # of an import, by time
MARK = "eigenfield_folder"  # of an imported mesh: where its textures are
CLIP, TIMELINE, FRAME = (
    "eigenfield_clip",
    "eigenfield_timeline",
    "eigenfield_frame",
)  # its file, of a clip; what it shows
TIME = "Of a clip, in seconds from its first frame on: the nearest frame is shown"
SETTLE_SECONDS = 0.3  # while a time is dragged, no frame is read
UPRIGHT = Matrix.Rotation(np.pi / 2, 4, "X")  # from OBJ's axes, y up, to Blender's
fields = {}  # by folder
drawn = {}  # by object: where the camera stood whose texture it has
changed = set()  # objects with a time whose frame is still to be read


def export_steps(scene, found, frame=None):
    """Have eigenfield write a scene's textures beside it, of a clip those of a frame; yields how far that is, and
    returns the folder."""
    folder = scene.with_name(f"{scene.stem}.textures" if frame is None else f"{scene.stem}.frame_{frame:04}.textures")
    words = ["export", scene, "--as", "obj", "-o", folder, "--overwrite", "--progress", "json"]
    for part, said in Job(found, *words, *([] if frame is None else ["--time", frame])).steps():
        yield EXPORT_PART * part, said
    return folder


def field_steps(folder):
    """Read a folder's textures, which are kept; yields how far it is, and returns the Field."""
    listing = json.loads((folder / LISTING).read_text(encoding="utf-8"))
    if listing.get("kind") != "obj" or "places" not in listing:
        raise RefusalError(
            f"{folder} is not what `eigenfield export --as obj` writes into a folder, or an older one did"
        )
    field = Field()
    for part in field.read(folder):
        yield EXPORT_PART + READ_PART * part, "reading textures"
    fields[str(folder)] = field
    yield EXPORT_PART + READ_PART, "mesh and material"
    return field


def read_mesh(folder):
    """A new object of a folder's mesh, without materials."""
    before = set(bpy.data.objects)
    lines = inside(folder, "mesh.obj").read_bytes().split(b"\n")
    with tempfile.TemporaryDirectory() as own:  # without its material, which may name pictures anywhere
        plain = Path(own, "mesh.obj")
        plain.write_bytes(b"\n".join(line for line in lines if not line.lstrip().startswith(b"mtllib")))
        bpy.ops.wm.obj_import(filepath=str(plain), forward_axis="Y", up_axis="Z", validate_meshes=False)
    (mesh,) = set(bpy.data.objects) - before
    for material in mesh.data.materials[:]:
        bpy.data.materials.remove(material)
    mesh.data.materials.clear()
    return mesh


def import_steps(context, folder, name, upright):
    """The mesh with a texture that follows the active camera; the reference camera, which becomes the active one where
    there is none. Yields how far it is, and returns the mesh."""
    field = yield from field_steps(folder)
    mesh = read_mesh(folder)
    turn = UPRIGHT if upright else Matrix(field.listing["toCapture"]).to_4x4()
    mesh.name, mesh.matrix_world, mesh[MARK] = name, turn, str(folder)
    mesh.data.materials.append(new_material(name, field))
    camera = new_camera(name, field.listing["camera"], turn)
    context.collection.objects.link(camera)
    scene = context.scene
    if scene.camera is None:
        scene.camera = camera
    scene.render.use_lock_interface = True  # the texture changes between the frames of an animation
    if hasattr(scene, "cycles"):
        scene.cycles.transparent_max_bounces = max(
            scene.cycles.transparent_max_bounces, 8 + len(field.listing["sheets"])
        )
    follow(scene)
    return mesh


def new_camera(name, entry, turn):
    lens = bpy.data.cameras.new(f"{name} camera")
    lens.sensor_fit, lens.clip_start = "VERTICAL", min(entry["znear"], lens.clip_start)
    lens.lens = lens.sensor_height / (2 * tan(entry["yfov"] / 2))
    camera = bpy.data.objects.new(lens.name, lens)
    x, y, z, w = entry["rotation"]
    camera.matrix_world = turn @ Matrix.LocRotScale(entry["translation"], Quaternion((w, x, y, z)), None)
    return camera


def new_material(name, field):
    """Light of its own, of the texture's colours; where the texture is not opaque, what lies behind shows through."""
    image = bpy.data.images.new(f"{name} texture", *field.size, alpha=True)
    image.alpha_mode = "CHANNEL_PACKED"
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    picture, light, output = (nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "Emission", "OutputMaterial"))
    picture.image, picture.interpolation, picture.extension = image, "Cubic", "EXTEND"
    links.new(picture.outputs["Color"], light.inputs["Color"])
    surface = light.outputs[0]
    if field.listing["sheets"]:
        glass, mixed = nodes.new("ShaderNodeBsdfTransparent"), nodes.new("ShaderNodeMixShader")
        links.new(picture.outputs["Alpha"], mixed.inputs[0])
        links.new(glass.outputs[0], mixed.inputs[1])
        links.new(surface, mixed.inputs[2])
        surface = mixed.outputs[0]
    links.new(surface, output.inputs["Surface"])
    for place, node in enumerate((picture, light, output)):
        node.location = 300 * place, 0
    return material


@persistent
def follow(scene, depsgraph=None):
    """Give every imported mesh the texture of where the active camera stands."""
    camera = scene.camera
    if camera is None:
        return
    for mesh, image in textured(scene.objects):
        field = field_of(mesh[MARK])
        if field is None or tuple(image.size) != field.size:
            continue
        turn, eye = (of if depsgraph is None else of.evaluated_get(depsgraph) for of in (mesh, camera))
        place = field.place(turn.matrix_world.inverted() @ eye.matrix_world.translation)
        if np.allclose(drawn.get(mesh.name, np.inf), place, atol=1e-5):
            continue
        drawn[mesh.name] = place
        image.pixels.foreach_set(field.texture(place).ravel())
        image.update()


def field_of(folder):
    """What an imported mesh is drawn from, read when it is first needed; None where its folder is gone."""
    if folder not in fields:
        try:
            fields[folder] = read_field(Path(folder))
        except (OSError, ValueError, RuntimeError, KeyError):
            fields[folder] = None
    return fields[folder]


@persistent
def follow_soon(scene, depsgraph):
    """Where there is a window, a few times a second at most, so that the camera moves smoothly."""
    if bpy.app.background:
        follow(scene, depsgraph)
    elif not bpy.app.timers.is_registered(settle):
        bpy.app.timers.register(settle, first_interval=0.2)


def settle():
    follow(bpy.context.scene)


def textured(objects):
    """The imported meshes among objects, each with its texture."""
    for mesh in objects:
        if MARK in mesh and mesh.data.materials and mesh.data.materials[0]:
            for node in mesh.data.materials[0].node_tree.nodes:
                if node.type == "TEX_IMAGE" and node.image:
                    yield mesh, node.image


@persistent
def after_load(*_):
    fields.clear()
    after_undo()


@persistent
def after_undo(*_):
    drawn.clear()
    bpy.context.view_layer.update()  # until then every object stands at the origin
    follow(bpy.context.scene)


@persistent
def before_save(*_):
    """The file keeps the textures, for those who open it without this add-on or without the folder."""
    for _, image in textured(bpy.data.objects):
        image.pack()


class EIGENFIELD_OT_import(Stepped, bpy.types.Operator, ImportHelper):
    bl_idname = "eigenfield.import_scene"
    bl_label = "Import a scene of eigenfield"
    bl_description = "A scene's .glb, or the eigenfield.json of its textures, drawn as the active camera sees it"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".glb"
    filter_glob: bpy.props.StringProperty(default="*.glb;eigenfield.json", options={"HIDDEN"})
    upright: bpy.props.BoolProperty(
        name="Upright",
        description="The array looks along Y with Z up; without, the scene lies where its photographs were rendered",
        default=True,
    )

    time: bpy.props.FloatProperty(name="Time", description=TIME, min=0, unit="TIME_ABSOLUTE")
    known: bpy.props.BoolProperty(description="The path is set, and not asked for", options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context, event):
        self.in_window = True
        return Stepped.invoke(self, context, event) if self.known else ImportHelper.invoke(self, context, event)

    def execute(self, context):
        if getattr(self, "in_window", False):  # the path was chosen
            return Stepped.invoke(self, context, None)
        return super().execute(context)

    def steps(self, context):
        path = Path(self.filepath)
        if path.name == LISTING:
            yield from import_steps(context, path.parent, path.parent.name.removesuffix(".textures"), self.upright)
            return
        found, timeline, frame = program(context), None, None
        if is_clip(path):
            timeline = yield from timeline_steps(path, found)
            frame = timeline.frame_at(self.time)
        folder = yield from export_steps(path, found, frame)
        mesh = yield from import_steps(context, folder, path.stem, self.upright)
        if timeline is not None:
            mesh[CLIP], mesh[TIMELINE], mesh[FRAME] = str(path), [float(of) for of in timeline], frame
            mesh.eigenfield_time = timeline.time_of(frame)


class EIGENFIELD_OT_read_frame(Stepped, bpy.types.Operator):
    bl_idname = "eigenfield.read_frame"
    bl_label = "Read a frame"
    bl_description = "Show the frame of a clip that is nearest to the mesh's time"
    bl_options = {"INTERNAL", "UNDO"}
    name: bpy.props.StringProperty(description="Of the imported mesh", options={"SKIP_SAVE"})

    def steps(self, context):
        mesh = bpy.data.objects[self.name]
        frame = timeline_of(mesh).frame_at(mesh.eigenfield_time)
        try:
            folder = yield from export_steps(Path(mesh[CLIP]), program(context), frame)
            yield from field_steps(folder)
            show_frame(context.view_layer, bpy.data.objects[self.name], folder, frame)
            follow(context.scene)
        finally:  # where it failed or was stopped, the time is again that of what is shown
            mesh = bpy.data.objects.get(self.name)
            if mesh is not None and FRAME in mesh and mesh[FRAME] != frame:
                mesh.eigenfield_time = timeline_of(mesh).time_of(mesh[FRAME])


def show_frame(layer, mesh, folder, frame):
    """Exchange an imported mesh's surface for a folder's; its material stays, and so does what is selected."""
    active, selected = layer.objects.active, list(layer.objects.selected)
    new, old = read_mesh(folder), mesh.data
    for material in old.materials:
        new.data.materials.append(material)
    mesh.data = new.data
    bpy.data.objects.remove(new)
    layer.objects.active = active
    for each in selected:
        each.select_set(True)
    if not old.users:
        name = old.name
        bpy.data.meshes.remove(old)
        mesh.data.name = name
    if mesh[MARK] != str(folder):
        fields.pop(mesh[MARK], None)
    mesh[MARK], mesh[FRAME] = str(folder), frame
    drawn.pop(mesh.name, None)


def timeline_of(mesh):
    rate, frames = mesh[TIMELINE]
    return Timeline(rate, int(frames))


def time_changed(mesh, context):
    """Another frame is read, with a window once the time has stayed for a moment."""
    if CLIP not in mesh or timeline_of(mesh).frame_at(mesh.eigenfield_time) == mesh[FRAME]:
        return
    if bpy.app.background:
        bpy.ops.eigenfield.read_frame(name=mesh.name)
        return
    changed.add(mesh.name)
    if bpy.app.timers.is_registered(read_changed):
        bpy.app.timers.unregister(read_changed)
    bpy.app.timers.register(read_changed, first_interval=SETTLE_SECONDS)


def read_changed():
    mesh = bpy.data.objects.get(changed.pop()) if changed else None
    if mesh is not None and CLIP in mesh:
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.eigenfield.read_frame("INVOKE_DEFAULT", name=mesh.name)
    return SETTLE_SECONDS if changed else None


def add_to_menu(menu, context):
    menu.layout.operator(EIGENFIELD_OT_import.bl_idname, text="Eigenfield scene (.glb)")


HANDLERS = (
    ("load_post", after_load),
    ("undo_post", after_undo),
    ("save_pre", before_save),
    ("depsgraph_update_post", follow_soon),
    ("frame_change_post", follow),
    ("render_pre", follow),
)


def register():
    bpy.utils.register_class(EIGENFIELD_OT_import)
    bpy.utils.register_class(EIGENFIELD_OT_read_frame)
    bpy.types.Object.eigenfield_time = bpy.props.FloatProperty(
        name="Time", description=TIME, min=0, unit="TIME_ABSOLUTE", options=set(), update=time_changed
    )
    bpy.types.TOPBAR_MT_file_import.append(add_to_menu)
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister():
    for timer in (settle, read_changed):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    bpy.types.TOPBAR_MT_file_import.remove(add_to_menu)
    del bpy.types.Object.eigenfield_time
    bpy.utils.unregister_class(EIGENFIELD_OT_read_frame)
    bpy.utils.unregister_class(EIGENFIELD_OT_import)
