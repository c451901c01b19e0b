"""An array of cameras around the active one; for `eigenfield encode` its pictures, transforms.json and the mesh."""

import contextlib
import json
from pathlib import Path

import bpy
from mathutils import Matrix

from .program import RefusalError
from .steps import Stepped

MARK = "eigenfield_array"  # of the collection of an array


class EIGENFIELD_PG_array(bpy.types.PropertyGroup):
    rows: bpy.props.IntProperty(name="Rows", default=5, min=1, max=100)
    columns: bpy.props.IntProperty(name="Columns", default=5, min=1, max=100)
    spacing: bpy.props.FloatProperty(
        name="Spacing", description="Between two neighbours", default=0.1, min=1e-6, precision=4, unit="LENGTH"
    )
    use_zero_plane: bpy.props.BoolProperty(
        name="Zero plane", description="Shift the lenses, so that a plane stays in place in all pictures"
    )
    distance: bpy.props.FloatProperty(
        name="Distance", description="From the cameras to the zero plane", default=5.0, min=1e-6, unit="LENGTH"
    )
    folder: bpy.props.StringProperty(
        name="Folder",
        description="For pictures, transforms.json and proxy.obj",
        default="//capture",
        subtype="DIR_PATH",
    )
    animation: bpy.props.BoolProperty(
        name="Animation", description="Every frame of the scene, in folders of their own: frame_0001 and so on"
    )


def active_camera(scene):
    """The camera that the array stands around, also while one of the array's is looked through."""
    camera = scene.camera
    if camera is not None and any(MARK in of for of in camera.users_collection):
        camera = camera.parent
    if camera is None or camera.type != "CAMERA":
        raise RefusalError("The scene has no active camera")
    if camera.data.type != "PERSP":
        raise RefusalError(f"{camera.name} is no perspective camera")
    return camera


def make_array(scene):
    """New cameras, row by row from the top left one, as children of the active camera; those of before go."""
    middle, settings = active_camera(scene), scene.eigenfield
    remove_array(scene)
    collection = bpy.data.collections.new("Camera array")
    collection[MARK] = True
    scene.collection.children.link(collection)
    scale = middle.matrix_world.to_scale()
    cameras = []
    for row in range(settings.rows):
        for column in range(settings.columns):
            x = (column - (settings.columns - 1) / 2) * settings.spacing
            y = ((settings.rows - 1) / 2 - row) * settings.spacing
            camera = bpy.data.objects.new(f"view_{row:02}_{column:02}", middle.data.copy())
            camera.parent = middle
            camera.matrix_basis = Matrix.Translation((x / scale.x, y / scale.y, 0))
            if settings.use_zero_plane:
                shift_lens(camera.data, x / settings.distance, y / settings.distance)
            collection.objects.link(camera)
            cameras.append(camera)
    return cameras


def shift_lens(lens, x, y):
    """Shift a lens by the tangents of two angles, to the left and down. Blender counts in sides that the lens fits."""
    sensor = lens.sensor_height if lens.sensor_fit == "VERTICAL" else lens.sensor_width
    lens.shift_x -= x * lens.lens / sensor
    lens.shift_y -= y * lens.lens / sensor


def array_of(scene):
    """The collection of the array that is in the scene, or None."""
    return next((of for of in scene.collection.children if MARK in of), None)


def remove_array(scene):
    collection = array_of(scene)
    if collection is None:
        return
    if scene.camera is not None and scene.camera.name in collection.objects:
        scene.camera = scene.camera.parent
    for camera in list(collection.objects):
        bpy.data.cameras.remove(camera.data)  # its object goes with it
    bpy.data.collections.remove(collection)


def picture_size(scene):
    render = scene.render
    return (
        render.resolution_x * render.resolution_percentage // 100,
        render.resolution_y * render.resolution_percentage // 100,
    )


def entry_of(camera, scene, depsgraph):
    """A camera's frame of transforms.json, but for its picture: Blender's axes are those of that format."""
    width, height = picture_size(scene)
    camera = camera.evaluated_get(depsgraph)
    projection = camera.calc_matrix_camera(
        depsgraph, x=width, y=height, scale_x=scene.render.pixel_aspect_x, scale_y=scene.render.pixel_aspect_y
    )
    place, turn, _ = camera.matrix_world.decompose()
    return {
        "fl_x": projection[0][0] * width / 2,
        "fl_y": projection[1][1] * height / 2,
        "cx": (1 - projection[0][2]) * width / 2,
        "cy": (1 + projection[1][2]) * height / 2,
        "transform_matrix": [list(row) for row in Matrix.LocRotScale(place, turn, None)],
    }


def render_array(context):
    """Render the array, picture by picture; yields what part is done, and a few words. What it sets is put back at the
    end, and transforms.json is written last: a folder without it is not finished."""
    scene, settings = context.scene, context.scene.eigenfield
    if settings.rows * settings.columns < 3:
        raise RefusalError("An array has three cameras or more")
    shown = array_of(scene) is not None
    root = capture_folder(settings)
    cameras = make_array(scene)
    frames = (
        range(scene.frame_start, scene.frame_end + 1, scene.frame_step) if settings.animation else [scene.frame_current]
    )
    before = scene.frame_current
    try:
        with plain_pictures(scene):
            for number, frame in enumerate(frames):
                scene.frame_set(frame)
                folder = root / f"frame_{frame:04}" if settings.animation else root
                (folder / "images").mkdir(parents=True, exist_ok=True)
                (folder / "transforms.json").unlink(missing_ok=True)
                entries = []
                for camera in cameras:
                    done, count = number * len(cameras) + len(entries), len(frames) * len(cameras)
                    yield done / count, f"{done} of {count} pictures"
                    scene.camera = camera
                    picture = f"images/{camera.name.split('.')[0]}.png"
                    scene.render.filepath = str(folder / picture)
                    bpy.ops.render.render(write_still=True)
                    entry = entry_of(camera, scene, context.evaluated_depsgraph_get())
                    entries.append({"file_path": picture, **entry})
                write_mesh(folder / "proxy.obj")
                width, height = picture_size(scene)
                document = {"camera_model": "PINHOLE", "w": width, "h": height, "frames": entries}
                (folder / "transforms.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    finally:
        scene.camera = cameras[0].parent
        if not shown:
            remove_array(scene)
        scene.frame_set(before)


def capture_folder(settings):
    if settings.folder.startswith("//") and not bpy.data.filepath:
        raise RefusalError("Save the file first, or choose a folder that does not begin with //")
    return Path(bpy.path.abspath(settings.folder))


def write_mesh(path):
    """All that is rendered, as it is rendered, with the modifiers' levels of a render and in Blender's axes."""
    bpy.ops.wm.obj_export(
        filepath=str(path),
        check_existing=False,
        export_eval_mode="DAG_EVAL_RENDER",
        forward_axis="Y",
        up_axis="Z",
        export_triangulated_mesh=True,
        export_uv=False,
        export_normals=False,
        export_materials=False,
    )


@contextlib.contextmanager
def plain_pictures(scene):
    """Whole PNG of one view each, with alpha where the film is transparent; what is set comes back afterwards."""
    render = scene.render
    image = render.image_settings
    wanted = [(render, name, False) for name in ("use_border", "use_multiview", "use_sequencer", "use_stamp")]
    wanted += [(render, "filepath", render.filepath)]
    if hasattr(image, "media_type"):  # Blender 5
        wanted += [(image, "media_type", "IMAGE")]
    wanted += [(image, "file_format", "PNG")]
    wanted += [(image, "color_mode", "RGBA" if render.film_transparent else "RGB"), (image, "color_depth", "8")]
    before = []
    try:
        for owner, name, value in wanted:
            before.append((owner, name, getattr(owner, name)))
            setattr(owner, name, value)
        yield
    finally:
        for owner, name, value in before:
            setattr(owner, name, value)


class EIGENFIELD_OT_show_array(bpy.types.Operator):
    bl_idname = "eigenfield.show_array"
    bl_label = "Show the cameras"
    bl_description = "Put the cameras of the array into the scene, to look through them"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            make_array(context.scene)
        except RefusalError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class EIGENFIELD_OT_hide_array(bpy.types.Operator):
    bl_idname = "eigenfield.hide_array"
    bl_label = "Remove the cameras"
    bl_description = "Take the cameras of the array out of the scene"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        remove_array(context.scene)
        return {"FINISHED"}


class EIGENFIELD_OT_render_array(Stepped, bpy.types.Operator):
    bl_idname = "eigenfield.render_array"
    bl_label = "Render the array"
    bl_description = "Render all cameras, and write transforms.json and the mesh beside the pictures"

    def steps(self, context):
        yield from render_array(context)
        self.report({"INFO"}, f"{capture_folder(context.scene.eigenfield)} is rendered: Encode makes a scene of it")


CLASSES = (
    EIGENFIELD_PG_array,
    EIGENFIELD_OT_show_array,
    EIGENFIELD_OT_hide_array,
    EIGENFIELD_OT_render_array,
)


def register():
    for of in CLASSES:
        bpy.utils.register_class(of)
    bpy.types.Scene.eigenfield = bpy.props.PointerProperty(type=EIGENFIELD_PG_array)


def unregister():
    del bpy.types.Scene.eigenfield
    for of in reversed(CLASSES):
        bpy.utils.unregister_class(of)
