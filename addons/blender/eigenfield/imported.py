"""A scene of eigenfield: its mesh, and the texture that the active camera sees, which follows that camera.

Blender decodes neither AV1 nor the coded mesh, and its Python cannot hold what eigenfield needs. So the program
eigenfield writes mean, eigen textures and weights as plain files (`eigenfield export --as obj`), and this reads those.
"""

import json
import shutil
import subprocess
import tempfile
from math import tan
from pathlib import Path

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy_extras.io_utils import ImportHelper
from mathutils import Matrix, Quaternion

from .array import RefusalError

LISTING = "eigenfield.json"
CHUNK = 1 << 14  # texels that stay in a processor's cache while textures are summed
MARK = "eigenfield_folder"  # of an imported mesh: where its textures are
UPRIGHT = Matrix.Rotation(np.pi / 2, 4, "X")  # from OBJ's axes, y up, to Blender's
fields = {}  # by folder
drawn = {}  # by object: where the camera stood whose texture it has


class Field:
    """What a folder holds: texture = mean + sum of weight * (code - zero) * scale, rows from the bottom as Blender's.

    mean: (H W, 4) float32, the fourth the opacity. codes: (H W, 3) uint8 of each eigen texture. weights: (cameras,
    textures).
    """

    def __init__(self, folder):
        self.listing = json.loads((folder / LISTING).read_text(encoding="utf-8"))
        mean, self.size = read_pixels(inside(folder, self.listing["mean"]))
        self.mean = mean.reshape(-1, 4)
        self.codes = [codes_of(inside(folder, entry["file"])) for entry in self.listing["textures"]]
        self.weights = np.array(list(self.listing["weights"].values()), np.float32)
        self.places = np.array(self.listing["places"], float)
        self.triangles = np.array(self.listing["triangles"], int).reshape(-1, 3)

    def place(self, point):
        """View-plane coordinates, from -1 to 1, of a point in OBJ's axes."""
        plane = self.listing["viewPlane"]
        extent, away = np.array(plane["extent"]), np.array(point[:2]) - plane["origin"][:2]
        return np.divide(away, extent, out=np.zeros(2), where=extent > 0).clip(-1, 1)

    def texture(self, place):
        """(H W, 4) float32, from 0 to 1."""
        among, parts = between(place, self.places, self.triangles)
        steps, away = [], np.zeros(1, np.float32)
        for weight, entry in zip(parts @ self.weights[among], self.listing["textures"], strict=True):
            steps.append((weight * np.array(entry["scale"])).astype(np.float32))
            away = away + steps[-1] * np.array(entry["zero"], np.float32)
        texture = self.mean.copy()
        for first in range(0, len(texture), CHUNK):
            chunk = slice(first, first + CHUNK)
            colours = texture[chunk, :3] - away
            for codes, step in zip(self.codes, steps, strict=True):
                colours += codes[chunk] * step
            texture[chunk, :3] = colours
        return texture.clip(0, 1, out=texture)


def between(place, places, triangles):
    """What a place (2,) takes of places (n, 2): the corners of its triangle and its barycentric coordinates, outside of
    all triangles and on a line of cameras those of the nearest point.

    Returns: (k,) indices, (k,) weights that sum to 1.
    """
    if len(triangles):
        corners = places[triangles]
        a, b, p = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], place - corners[:, 0]
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        second = (p[:, 0] * b[:, 1] - p[:, 1] * b[:, 0]) / area
        third = (a[:, 0] * p[:, 1] - a[:, 1] * p[:, 0]) / area
        parts = np.stack([1 - second - third, second, third], axis=1)
        best = parts.min(axis=1).argmax()
        if parts[best].min() >= -1e-9:
            return triangles[best], parts[best]
        segments = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    elif len(places) > 1:
        spread = places - places.mean(axis=0)
        order = np.argsort(spread @ np.linalg.svd(spread)[2][0], kind="stable")
        segments = np.stack([order[:-1], order[1:]], axis=1)
    else:
        return np.zeros(1, int), np.ones(1)
    start, along = places[segments[:, 0]], places[segments[:, 1]] - places[segments[:, 0]]
    part = (((place - start) * along).sum(axis=1) / (along**2).sum(axis=1)).clip(0, 1)
    nearest = ((start + part[:, None] * along - place) ** 2).sum(axis=1).argmin()
    return segments[nearest], np.array([1 - part[nearest], part[nearest]])


def inside(folder, name):
    """A file that a listing names: nobody has another one read by giving a folder away."""
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise RefusalError(f"{folder / LISTING} names {name!r}, which is not in its folder")
    return path


def read_pixels(path):
    """(4 H W,) float32 from 0 to 1, and (width, height)."""
    image = bpy.data.images.load(str(path))
    try:
        image.colorspace_settings.name = "Non-Color"
        size = tuple(image.size)
        pixels = np.empty(4 * size[0] * size[1], np.float32)
        image.pixels.foreach_get(pixels)
        return pixels, size
    finally:
        bpy.data.images.remove(image)


def codes_of(path):
    pixels = read_pixels(path)[0].reshape(-1, 4)[:, :3]
    return np.rint(pixels * 255).astype(np.uint8)


def export_folder(scene, program):
    """Have eigenfield write a scene's textures beside it; the folder."""
    folder = scene.with_name(f"{scene.stem}.textures")
    found = bpy.path.abspath(program) or shutil.which("eigenfield")
    if not found:
        raise RefusalError("eigenfield was not found: install it, and name it in the add-on's preferences")
    command = [found, "export", str(scene), "--as", "obj", "-o", str(folder), "--overwrite", "--quiet"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", errors="replace")
    except OSError as error:
        raise RefusalError(f"{found} does not run: {error}") from None
    if done.returncode:
        raise RefusalError((done.stderr.strip() or f"{found} failed").splitlines()[-1])
    return folder


def import_field(context, folder, name, upright):
    """The mesh with a texture that follows the active camera; the reference camera, which becomes the active one where
    there is none."""
    listing = json.loads((folder / LISTING).read_text(encoding="utf-8"))
    if listing.get("kind") != "obj" or "places" not in listing:
        raise RefusalError(
            f"{folder} is not what `eigenfield export --as obj` writes into a folder, or an older one did"
        )
    field = fields[str(folder)] = Field(folder)
    before = set(bpy.data.objects)
    lines = inside(folder, "mesh.obj").read_bytes().split(b"\n")
    with tempfile.TemporaryDirectory() as own:  # without its material, which may name pictures anywhere
        plain = Path(own, "mesh.obj")
        plain.write_bytes(b"\n".join(line for line in lines if not line.lstrip().startswith(b"mtllib")))
        bpy.ops.wm.obj_import(filepath=str(plain), forward_axis="Y", up_axis="Z", validate_meshes=False)
    (mesh,) = set(bpy.data.objects) - before
    turn = UPRIGHT if upright else Matrix(field.listing["toCapture"]).to_4x4()
    mesh.name, mesh.matrix_world, mesh[MARK] = name, turn, str(folder)
    for material in mesh.data.materials[:]:
        bpy.data.materials.remove(material)
    mesh.data.materials.clear()
    mesh.data.materials.append(new_material(name, field))
    camera = new_camera(name, listing["camera"], turn)
    context.collection.objects.link(camera)
    scene = context.scene
    if scene.camera is None:
        scene.camera = camera
    scene.render.use_lock_interface = True  # the texture changes between the frames of an animation
    if hasattr(scene, "cycles"):
        scene.cycles.transparent_max_bounces = max(scene.cycles.transparent_max_bounces, 8 + len(listing["sheets"]))
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
            fields[folder] = Field(Path(folder))
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
    follow(bpy.context.scene)


@persistent
def before_save(*_):
    """The file keeps the textures, for those who open it without this add-on or without the folder."""
    for _, image in textured(bpy.data.objects):
        image.pack()


class EIGENFIELD_AP_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(
        name="eigenfield", description="The program; empty: the one that the system finds", subtype="FILE_PATH"
    )

    def draw(self, context):
        self.layout.prop(self, "program")


class EIGENFIELD_OT_import(bpy.types.Operator, ImportHelper):
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

    def execute(self, context):
        path = Path(self.filepath)
        try:
            if path.name == LISTING:
                folder, name = path.parent, path.parent.name.removesuffix(".textures")
            else:
                addon = context.preferences.addons.get(__package__)  # None: registered by hand, without preferences
                program = addon.preferences.program if addon is not None else ""
                folder, name = export_folder(path, program), path.stem
            import_field(context, folder, name, self.upright)
        except (RefusalError, OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def add_to_menu(menu, context):
    menu.layout.operator(EIGENFIELD_OT_import.bl_idname, text="Eigenfield scene (.glb)")


CLASSES = EIGENFIELD_AP_preferences, EIGENFIELD_OT_import
HANDLERS = (
    ("load_post", after_load),
    ("undo_post", after_undo),
    ("save_pre", before_save),
    ("depsgraph_update_post", follow_soon),
    ("frame_change_post", follow),
    ("render_pre", follow),
)


def register():
    for of in CLASSES:
        bpy.utils.register_class(of)
    bpy.types.TOPBAR_MT_file_import.append(add_to_menu)
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister():
    if bpy.app.timers.is_registered(settle):
        bpy.app.timers.unregister(settle)
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    bpy.types.TOPBAR_MT_file_import.remove(add_to_menu)
    for of in reversed(CLASSES):
        bpy.utils.unregister_class(of)
