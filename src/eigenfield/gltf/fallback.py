"""What viewers without a decoder of ours show of a coded mesh: a relief of the middle view, and its picture.

Of cameras that look one way, the reference camera's view is drawn from the means and laid over a smooth height field of
its depth: it has no holes, and shows the scene best where it was photographed. Fine depth would need many triangles,
since a picture bends on a large triangle that recedes. Cameras that look several ways get the mesh itself with fewer
triangles, and its atlas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_8bit import encode_small_preview
from eigenfield.core.camera import Camera, axis_angles
from eigenfield.core.clip import Clip
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.scene import Scene
from eigenfield.gltf.accessors import DTYPES
from eigenfield.gltf.coarse import coarse_mesh
from eigenfield.gltf.write_geometry import index_type

SceneT = TypeVar("SceneT", bound=Scene | Clip)

MAX_AXIS_ANGLE_DEGREES = 25.0  # between a camera's axis and the mean axis, of cameras that look one way
MAX_MARGIN_FRACTION = 0.12  # by which the view is widened, of the reference camera's side
DEPTH_MEDIAN_PIXELS = 5
DEPTH_BLUR_RATIO = 0.5  # of the spacing of the height field's points
HALF_COVERED = 0.5  # opacity from which on a sheet is there
SQUARE_COVERED = 0.25  # of a square of the height field, from which on it is shown


@dataclass(frozen=True)
class Size:
    """How much of a scene other viewers show.

    Attributes:
        points: Of the relief.
        side: Of the picture, in texels.
    """

    points: int
    side: int
    quality: int


@dataclass(frozen=True)
class Budget:
    """What other viewers get.

    Attributes:
        ratio: Bytes of mesh and picture to those of what is coded, at most.
        side: Of the view that is drawn, in pixels.
        sizes: The first that is within the budget is taken, else the last.
    """

    ratio: float
    side: int
    sizes: tuple[Size, ...]


SMALL = Budget(
    0.06,
    256,
    (
        Size(200, 384, 55),
        Size(160, 288, 55),
        Size(128, 224, 50),
        Size(100, 160, 45),
        Size(80, 128, 40),
        Size(48, 80, 35),
        Size(30, 48, 30),
        Size(16, 40, 30),
    ),
)
GOOD = Budget(
    0.25,
    1024,
    (
        Size(3000, 1024, 80),
        Size(2000, 896, 75),
        Size(1400, 768, 70),
        Size(1000, 640, 70),
        Size(700, 512, 65),
        Size(450, 448, 60),
        Size(300, 384, 60),
        *SMALL.sizes,
    ),
)
BUDGETS = {"small": SMALL, "good": GOOD, "none": None}
SETTING = "fallback"  # of a scene, left out for the default
DEFAULT = "small"


def with_fallback(scene: SceneT, fallback: str) -> SceneT:
    """The scene or clip, to be written with this, a key of BUDGETS, for other viewers. OptionError `fallback`."""
    if fallback not in BUDGETS:
        raise OptionError("fallback", f"no fallback is called {fallback}", remedy=f"use one of {', '.join(BUDGETS)}")
    kept = {key: value for key, value in scene.settings.items() if key != SETTING}
    return replace(scene, settings=kept if fallback == DEFAULT else {**kept, SETTING: fallback})


def make_fallback(scene: Scene, atlas: NDArray[np.uint8], coded: int) -> tuple[Mesh, Payload] | None:
    """A mesh and its picture within the budget that the scene's settings name; None where they want none.

    Args:
        atlas: (H, W) or (H, W, 3) codes of its mean.
        coded: Bytes of the coded parts.
    """
    budget = BUDGETS.get(scene.provenance.fallback or DEFAULT, SMALL)
    if budget is None:
        return None
    one_way = axis_angles(scene.rig.cameras).max() <= MAX_AXIS_ANGLE_DEGREES
    drawn = _draw_middle(scene, atlas, budget.side) if one_way else None
    for size in budget.sizes:
        if drawn is None:
            mesh, picture = coarse_mesh(scene.proxy.mesh, 2 * size.points), atlas
        else:
            mesh, picture = _relief(drawn, size.points), drawn.picture
        payload = Payload("jpeg", encode_small_preview(picture, size.side, size.quality))
        if plain_bytes(mesh) + len(payload.data) <= budget.ratio * coded:
            break
    return mesh, payload


def plain_bytes(mesh: Mesh) -> int:
    """Bytes of a mesh as plain floats with the smallest indices."""
    assert mesh.uv is not None
    return mesh.vertices.nbytes + mesh.uv.nbytes + mesh.faces.size * DTYPES[index_type(mesh, True)].itemsize


@dataclass(frozen=True, eq=False)
class _Drawn:
    """The middle view.

    Attributes:
        picture: (h, w) or (h, w, 3) codes; beside what is covered those of the nearest covered pixel.
        inverse_depth: (h, w), likewise.
        covered: (h, w) where there is a surface.
    """

    camera: Camera
    picture: NDArray[np.uint8]
    inverse_depth: NDArray[np.float32]
    covered: NDArray[np.bool_]


def _draw_middle(scene: Scene, atlas: NDArray[np.uint8], side: int) -> _Drawn | None:
    """None where the reference camera sees nothing."""
    mesh, sheets = scene.proxy.mesh, scene.proxy.sheets
    camera = _middle_camera(scene.rig.cameras[scene.rig.reference], mesh, side)
    if camera is None:
        return None
    counts = (len(mesh.faces),) if sheets is None else sheets.faces
    shape = camera.height, camera.width
    picture, depth = np.zeros((*shape, *atlas.shape[2:]), np.float32), np.zeros(shape, np.float32)
    shown, colours = np.zeros(shape, np.float32), atlas.astype(np.float32)
    for first, last in zip(np.cumsum((0, *counts)), np.cumsum(counts), strict=False):
        part = replace(mesh, faces=mesh.faces[first:last])
        inverse, uv = _places(part, camera)
        opacity = (inverse > 0).astype(np.float32)
        if sheets is not None:
            opacity *= np.clip(_sample(sheets.opacity, uv), 0, 1)
        over = opacity if picture.ndim == 2 else opacity[..., None]
        picture += over * (_sample(colours, uv) - picture)
        depth = np.where(opacity >= HALF_COVERED, inverse, depth)
        shown += opacity * (1 - shown)
    covered = depth > 0
    if not covered.any():
        return None
    picture /= np.maximum(shown if picture.ndim == 2 else shown[..., None], HALF_COVERED)
    nearest = _nearest(covered)
    codes = np.rint(picture.clip(0, 255)).astype(np.uint8)
    return _Drawn(camera, codes.reshape(-1, *codes.shape[2:])[nearest], depth.reshape(-1)[nearest], covered)


def _middle_camera(camera: Camera, mesh: Mesh, side: int) -> Camera | None:
    """The camera with the frame of the mesh in its view, at most MAX_MARGIN_FRACTION wider, in `side` pixels."""
    pixels, depth = camera.project(mesh.vertices.astype(np.float64))
    if not (depth > 0).any():
        return None
    size = np.array((camera.width, camera.height), np.float64)
    margin = MAX_MARGIN_FRACTION * size
    low = np.clip(pixels[depth > 0].min(axis=0), -margin, size + margin)
    high = np.clip(pixels[depth > 0].max(axis=0), -margin, size + margin)
    if (high - low).min() < 1:
        return None
    scale = side / (high - low).max()
    width, height = np.maximum(np.rint(scale * (high - low)).astype(int), 2).tolist()
    frame = np.array([(scale, 0, -scale * low[0]), (0, scale, -scale * low[1]), (0, 0, 1)])
    return replace(camera, K=frame @ camera.K, width=width, height=height)


def _places(mesh: Mesh, camera: Camera) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(h, w) inverse depth, 0 where the camera sees nothing, and (h, w, 2) texture coordinates."""
    from eigenfield.imaging.raster import rasterise_view

    raster = rasterise_view(mesh, camera)
    covered = raster.face >= 0
    uv = np.zeros((*covered.shape, 2), np.float32)
    if covered.any():
        assert mesh.uv is not None
        shares = raster.corner_shares(*np.nonzero(covered))
        uv[covered] = np.einsum("nk,nkx->nx", shares, mesh.uv[mesh.faces[raster.face[covered]]])
    return np.where(covered, raster.inverse_depth, np.float32(0)), uv


def _sample(picture: NDArray[np.float32], uv: NDArray[np.float32]) -> NDArray[np.float32]:
    import cv2

    height, width = picture.shape[:2]
    at = uv * np.array((width, height), np.float32) - np.float32(0.5)
    found = cv2.remap(picture, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(found, np.float32)


def _nearest(covered: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(h, w) of each pixel the nearest covered one, by its index."""
    from scipy.ndimage import distance_transform_edt

    rows, columns = distance_transform_edt(~covered, return_distances=False, return_indices=True)
    return np.asarray(rows, np.int64) * covered.shape[1] + columns


def _relief(drawn: _Drawn, count: int) -> Mesh:
    """The view as a height field of about `count` points, without the squares that show next to nothing."""
    import cv2

    height, width = drawn.inverse_depth.shape
    spacing = math.sqrt(width * height / count)
    columns, rows = (max(1, round(side / spacing) - 1) for side in (width, height))
    smooth = cv2.GaussianBlur(
        cv2.medianBlur(drawn.inverse_depth, DEPTH_MEDIAN_PIXELS), (0, 0), DEPTH_BLUR_RATIO * spacing
    )
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    inverse = np.asarray(smooth, np.float64)[
        np.minimum(y.astype(int), height - 1), np.minimum(x.astype(int), width - 1)
    ]
    corners = np.stack([x, y, np.ones_like(x)], axis=2).reshape(-1, 3) / inverse.reshape(-1, 1)
    part = cv2.resize(drawn.covered.astype(np.float32), (columns, rows), interpolation=cv2.INTER_AREA)
    row, column = np.nonzero(np.asarray(part) >= min(SQUARE_COVERED, float(np.max(part))))
    first = row * (columns + 1) + column
    below = first + columns + 1
    faces = np.concatenate(
        [np.stack([first, below, first + 1], axis=1), np.stack([first + 1, below, below + 1], axis=1)]
    )
    used, corner = np.unique(faces, return_inverse=True)
    vertices = (corners[used] @ np.linalg.inv(drawn.camera.K).T - drawn.camera.t) @ drawn.camera.R
    uv = np.stack([x / width, y / height], axis=2).reshape(-1, 2)[used]
    return Mesh(vertices.astype(np.float32), corner.reshape(-1, 3).astype(np.int32), uv.astype(np.float32))
