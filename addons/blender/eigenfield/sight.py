"""What the array's spacing promises: depths of what the active camera sees, by the boxes of objects."""

from itertools import islice

import bpy
import numpy as np
from bpy.app.handlers import persistent

from .array import active_camera, entry_of, picture_size
from .parallax import depth_range, good_factor, overlap_part, parallax_pixels, word_of

SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
MAX_INSTANCES = 5000  # of more the first, which take a quarter of a second
known = {}  # the range of depths, by what it was found for; empty once something has moved


def promise(context):
    """What neighbours of the array show: pixels, ratio (to the longer side), near and far, word, and the spacing that
    is good. None where the camera sees no surface.

    Raises RefusalError where there is no camera.
    """
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    settings, camera = scene.eigenfield, active_camera(scene)
    entry, sides = entry_of(camera, scene, depsgraph), picture_size(scene)
    found = depths(scene, camera, entry, depsgraph)
    if found is None:
        return None
    along = [side for side, count in zip(sides, (settings.columns, settings.rows), strict=True) if count > 1] or sides
    plane = settings.distance if settings.use_zero_plane else None
    near, far = found
    pixels = parallax_pixels(settings.spacing, entry["fl_x"], near, far)
    ratio, overlap = pixels / max(sides), overlap_part(settings.spacing, entry["fl_x"], near, far, along, plane)
    return {
        "pixels": pixels,
        "ratio": ratio,
        "near": near,
        "far": far,
        "word": word_of(ratio, overlap),
        "good": settings.spacing * good_factor(ratio, overlap),
    }


def depths(scene, camera, entry, depsgraph):
    """`depth_range` of what a camera sees of all that is rendered."""
    width, height = picture_size(scene)
    frame = (
        -entry["cx"] / entry["fl_x"],
        (width - entry["cx"]) / entry["fl_x"],
        (entry["cy"] - height) / entry["fl_y"],
        entry["cy"] / entry["fl_y"],
    )
    place = np.array(entry["transform_matrix"])
    key = scene.name, scene.frame_current, frame, place.tobytes(), camera.data.clip_start
    if key not in known:
        known.clear()
        boxes, corners = [], {}
        for instance in islice(depsgraph.object_instances, MAX_INSTANCES):
            shown = instance.object
            if shown.type not in SURFACES or shown.hide_render:
                continue
            name = shown.name_full
            if name not in corners:
                corners[name] = np.array(shown.bound_box)
            matrix = np.array(instance.matrix_world)
            boxes.append(corners[name] @ matrix[:3, :3].T + matrix[:3, 3])
        turned = (np.array(boxes).reshape(-1, 8, 3) - place[:3, 3]) @ place[:3, :3]
        known[key] = depth_range(turned, frame, camera.data.clip_start)
    return known[key]


@persistent
def forget(scene, depsgraph=None):
    """Something has changed that is no setting of the scene."""
    if depsgraph is None or any(not isinstance(update.id, bpy.types.Scene) for update in depsgraph.updates):
        known.clear()


HANDLERS = ("depsgraph_update_post", "load_post", "undo_post")


def register():
    for event in HANDLERS:
        getattr(bpy.app.handlers, event).append(forget)


def unregister():
    for event in HANDLERS:
        getattr(bpy.app.handlers, event).remove(forget)
