"""From photographs to cameras and a proxy mesh (the paper's section 3.1): the stages in order, kept when finished."""

from __future__ import annotations

import hashlib
import json
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate import (
    Planar,
    PlanarStart,
    refine_planar,
    register_views,
    start_given,
    start_planar,
    structure_from_motion,
)
from eigenfield.camera import Camera
from eigenfield.capture import Lens, LightField, PhotoSet
from eigenfield.capture.save import save_calibration
from eigenfield.errors import CaptureError, OptionError, ProxyError
from eigenfield.holdout import held_out_cameras
from eigenfield.mesh import Mesh
from eigenfield.parallel import parallel_map
from eigenfield.progress import Progress
from eigenfield.proxy import (
    Primitive,
    atlas_statistics,
    find_view,
    fit_sphere,
    insert_primitive,
    parse_primitive,
    parse_region,
    read_mesh,
    relief_mesh,
    second_layer,
    surface_from_views,
    unwrapped,
    write_ply,
)
from eigenfield.stages import Stages, file_digest, stage_key
from eigenfield.stereo import Canvas, depth_buffers, depth_range, mean_texture
from eigenfield.stereo.extend import without_specks
from eigenfield.viewplane import fit_view_plane

log = logging.getLogger("eigenfield.reconstruction")

SURFACES = ("auto", "relief", "poisson")
DEFAULT_TRIANGLES = 30_000
PIXELS = 120_000_000  # of all photographs together that depth is estimated from; larger captures are reduced
OFF_PLANE = 0.15  # of the array's extent that cameras may stand off their plane, for a relief
SPECK = 2e-4  # of the canvas: smaller pieces that stand apart in depth are taken for errors
CUT_ROUNDS = 4  # of making fewer cuts
CUT = 4.0  # pixels in the outermost view that two neighbours may slip apart before the relief is slit between them
TOLERANCE = 0.08  # pixels there that the mesh may leave the depth map
RANGE_VIEWS = 25  # round the central one, in which a range of depths is searched
FEWEST_POINTS = 30  # of structure from motion that say a range of depths
WIDENED = 0.15  # of that range, on both sides
STRANGE, STRANGE_LEAST = 2.0, 8.0  # times the typical difference from the others, and grey levels more: another scene
DENSE = 25  # given views from which on cameras are refined unless told otherwise
ALIKE = 12.0  # degrees between a camera's axis and the mean axis, for a relief
FACING = 25.0  # degrees between the mean axis and the normal of the array's plane, likewise
MESH, CAMERAS, DEPTH = "mesh.ply", "cameras.npz", "depth.npz"

Capture = LightField | PhotoSet


@dataclass(frozen=True)
class Settings:
    """How photographs become a proxy; `reconstruct` describes each."""

    surface: str = "auto"
    refine: bool | None = None
    triangles: int = DEFAULT_TRIANGLES
    background: bool | None = None
    primitives: tuple[str, ...] = ()
    fit_spheres: tuple[str, ...] = ()
    blind: str | None = None

    def __post_init__(self) -> None:
        if self.surface not in SURFACES:
            raise OptionError("surface", f"no surface is called {self.surface}", remedy=f"use {', '.join(SURFACES)}")
        for text in self.primitives:
            parse_primitive(text)
        for text in self.fit_spheres:
            parse_region(text)


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Cameras and proxy of a capture.

    light_field: the photographs with their cameras, those left out named in its problems.
    mesh: with an atlas, in the cameras' world.
    calibration: the folder with a transforms.json and a COLMAP model, where cameras were estimated or refined.
    seconds: of each stage, in order; 0 where it was taken up from an earlier run.
    """

    light_field: LightField
    mesh: Mesh
    calibration: Path | None
    seconds: dict[str, float]


def reconstruct(
    capture: Capture,
    *,
    surface: str = "auto",
    refine: bool | None = None,
    triangles: int = DEFAULT_TRIANGLES,
    background: bool | None = None,
    primitives: Sequence[str] = (),
    fit_spheres: Sequence[str] = (),
    blind: str | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Reconstruction:
    """Estimate what a capture lacks: cameras where it has none, and a proxy mesh.

    surface: "relief" for arrays that look one way (two layers seen from the centre), "poisson" for everything else,
    "auto" to choose. refine: correct the cameras of an array together with its depth; None: where no calibration was
    given and they are not exact. triangles: of the proxy, about so many at most. background: close the frustum behind
    what was reconstructed; None: unless there are masks. primitives: `sphere:...` or `plane:...`, put in by hand.
    fit_spheres: `VIEW:X,Y,W,H`, spheres fitted to an outline.
    blind: a rule of `hold_out` (see `encode`): these views take no part, each only registers its own camera; arrays
    only. work: the folder of finished stages; None keeps none.

    Raises CaptureError, ProxyError, OptionError, OutputError, each naming the file and the remedy.
    """
    settings = Settings(surface, refine, triangles, background, tuple(primitives), tuple(fit_spheres), blind)
    with Stages(work) as stages:
        run = _Run(stages, settings, progress, {})
        identity = _identity(capture)
        light_field, points, calibration = (
            (capture, None, None) if _has_cameras(capture) else _by_motion(run, capture, identity)
        )
        if _wants_relief(light_field, settings):
            light_field, mesh, folder = _relief(run, light_field, points, identity)
            calibration = folder or calibration
        else:
            assert isinstance(light_field, LightField)
            if settings.blind is not None:
                raise OptionError(
                    "blind", "only arrays that look one way can be reconstructed blind",
                    remedy="leave out --blind: held-out views then help to find cameras and proxy",
                )  # fmt: skip
            mesh = _poisson(run, light_field, points, identity)
        assert isinstance(light_field, LightField)
        mesh = _finished(run, light_field, mesh, identity)
        return Reconstruction(light_field, mesh, calibration if work is not None else None, run.seconds)


@dataclass(frozen=True)
class _Run:
    stages: Stages
    settings: Settings
    progress: Progress | None
    seconds: dict[str, float]

    def stage(self, name: str, inputs: Sequence[Any], build: Callable[[Path], None]) -> Path:
        """The folder of a finished stage, and how long it took."""
        started = time.monotonic()
        key = stage_key([name, *inputs])
        ready = self.stages.path(name, key).is_dir()
        folder = self.stages.run(name, key, build)
        self.seconds[name] = 0.0 if ready else time.monotonic() - started
        log.info("%s: %s", name, "taken up" if ready else f"{self.seconds[name]:.1f} s")
        return folder


def _has_cameras(capture: Capture) -> bool:
    """Cameras are known, or told by a grid."""
    return isinstance(capture, LightField) or capture.layout is not None


def _identity(capture: Capture) -> list[Any]:
    """All that a result depends on: every file's bytes, cameras, lenses, layout."""
    if isinstance(capture, LightField):
        own: list[Any] = [
            [view.camera.K.tolist(), view.camera.R.tolist(), view.camera.t.tolist(), str(view.lens)]
            for view in capture.views
        ]
        files = [(view.name, view.path, view.mask, view.upright) for view in capture.views]
    else:
        layout = capture.layout
        own = [] if layout is None else [_plain(layout)]
        own += [[shot.focal, shot.width, shot.height] for shot in capture.shots]
        files = [(shot.name, shot.path, shot.mask, shot.upright) for shot in capture.shots]
    digests = parallel_map(
        lambda file: [file[0], file_digest(file[1]), None if file[2] is None else file_digest(file[2]), file[3]], files
    )
    return [digests, own]


def _plain(value: Any) -> dict[str, Any]:
    """A dataclass of arrays and numbers as JSON can hold it."""
    items = ((field.name, getattr(value, field.name)) for field in fields(value))
    return {name: item.tolist() if isinstance(item, np.ndarray) else item for name, item in items}


def _by_motion(run: _Run, photos: Capture, identity: list[Any]) -> tuple[LightField, NDArray[np.float64], Path]:
    """Cameras of photographs of which nothing is known, by structure from motion."""
    assert isinstance(photos, PhotoSet)

    def build(folder: Path) -> None:
        motion = structure_from_motion(photos, work=run.stages.folder / "matches", progress=run.progress)
        save_calibration(motion.light_field, folder / "calibration", motion.points)
        _write_cameras(folder / CAMERAS, photos, motion.light_field, motion.points.positions)

    folder = run.stage("motion", [identity], build)
    light_field, points = _read_cameras(folder / CAMERAS, photos)
    return light_field, points, folder / "calibration"


def _wants_relief(capture: Capture, settings: Settings) -> bool:
    if isinstance(capture, PhotoSet):
        if settings.surface == "poisson":
            raise OptionError(
                "surface", "a grid without calibration has no metric frame for a Poisson surface",
                remedy="leave out --surface, or calibrate first",
            )  # fmt: skip
        return True
    if settings.surface != "auto":
        return settings.surface == "relief"
    return looks_one_way(capture.cameras)


def looks_one_way(cameras: Sequence[Camera]) -> bool:
    """Whether cameras stand on a plane and look across it alike: a relief shows all that they see."""
    plane = fit_view_plane(cameras)
    axes = np.array([camera.R[2] for camera in cameras])
    mean = axes.mean(axis=0)
    if np.linalg.norm(mean) < 0.5:
        return False
    angles = np.degrees(np.arccos(np.clip(axes @ (mean / np.linalg.norm(mean)), -1, 1)))
    normal = np.cross(plane.right, plane.up)
    centres = np.array([camera.centre for camera in cameras]) - plane.origin
    along = np.degrees(np.arccos(min(1.0, abs(float(normal @ mean)) / float(np.linalg.norm(mean)))))
    thickness = float(np.abs(centres @ normal).max()) / float(np.linalg.norm(np.ptp(centres, axis=0)))
    return bool(angles.max() < ALIKE and thickness < OFF_PLANE and (along < FACING or plane.extent.min() == 0))


def _relief(
    run: _Run, capture: Capture, points: NDArray[np.float64] | None, identity: list[Any]
) -> tuple[LightField, Mesh, Path | None]:
    """Cameras and depth of an array together, then the layered relief."""
    refine = _refines(capture, run.settings)
    known = np.flatnonzero(~held_out_cameras(run.settings.blind, capture.names, _positions(capture)))
    inputs = [identity, refine, known.tolist(), None if points is None else len(points)]

    def build(folder: Path) -> None:
        pictures = _pictures(capture)
        part = capture.subset(known)
        shown = pictures if len(known) == len(pictures) else pictures[known]
        planar = refine_planar(shown, _start(part, shown, points), exact=not refine, progress=run.progress)
        if len(known) < len(pictures):
            new = np.setdiff1d(np.arange(len(pictures)), known)
            bases = None if isinstance(capture, PhotoSet) else _resized(capture)
            planar = register_views(planar, known, pictures[new], new, _positions(capture), bases)
        light_field = _light_field(capture, planar)
        save_calibration(light_field, folder / "calibration")
        _write_cameras(folder / CAMERAS, capture, light_field, np.zeros((0, 3)))
        _write_planar(folder / DEPTH, planar)

    folder = run.stage("array", inputs, build)
    light_field, _ = _read_cameras(folder / CAMERAS, capture)

    def mesh(place: Path) -> None:
        pictures = _pictures(capture)
        masks = _masks(capture)
        depth = _read_planar(folder / DEPTH)
        keep = np.intersect1d(known, [capture.names.index(name) for name in light_field.names])
        shown = None if masks is None else masks[keep]
        layers = _layers(depth, pictures[keep], shown, depth.matrices[keep], run.settings.triangles)
        write_ply(layers, place / MESH)

    relief = run.stage("relief", [inputs, run.settings.triangles], mesh)
    return light_field, read_mesh(relief / MESH), folder / "calibration"


def _layers(
    depth: _Depth,
    pictures: NDArray[np.uint8],
    masks: NDArray[np.uint8] | None,
    matrices: NDArray[np.float64],
    triangles: int,
) -> Mesh:
    """The layered relief of a depth map. Where its cuts alone take more than `triangles`, the depth is a noisy one:
    fewer are made."""
    valid = cv2.dilate((depth.count > 0).astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    if masks is not None:
        valid &= _counts(masks, matrices, depth)
    reach = float(np.abs(matrices[:, :2, 2]).max())
    cut, speck = CUT / reach, SPECK
    for _ in range(CUT_ROUNDS):
        d = without_specks(depth.d, cut, round(speck * depth.d.size))
        second = second_layer(pictures, matrices, d, valid, cut=cut)
        mesh = relief_mesh(depth.canvas, d, valid, second, cut=cut, tolerance=TOLERANCE / reach, triangles=triangles)
        if len(mesh.faces) <= 1.1 * triangles:
            break
        cut, speck = 1.6 * cut, 2 * speck
    return mesh


def _counts(masks: NDArray[np.uint8], matrices: NDArray[np.float64], depth: _Depth) -> NDArray[np.bool_]:
    """Where most of the views that see a point have it inside their masks."""
    buffers = depth_buffers(matrices, depth.d, masks.shape[1:3])
    share, _ = mean_texture(masks, matrices, depth.d, buffers)
    counts = share[..., 0] > 127
    if not counts.any():
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    return counts


def _refines(capture: Capture, settings: Settings) -> bool:
    if settings.refine is not None:
        return settings.refine
    if capture.layout is not None and capture.layout.exact:
        return False
    return isinstance(capture, PhotoSet) or len(capture) >= DENSE


def _frame(capture: Capture) -> tuple[tuple[int, int], tuple[int, int]]:
    """(width, height) that holds every photograph, and the same reduced to keep all within PIXELS."""
    sizes = [(s.width, s.height) for s in (capture.shots if isinstance(capture, PhotoSet) else capture.cameras)]
    width, height = (max(side) for side in zip(*sizes, strict=True))
    scale = min(1.0, (PIXELS / (len(sizes) * width * height)) ** 0.5)
    return (width, height), (max(2, round(scale * width)), max(2, round(scale * height)))


def _fitted(picture: NDArray[Any], whole: tuple[int, int], small: tuple[int, int]) -> NDArray[np.uint8]:
    """A photograph in the common frame (those of one camera may differ by a row or two), reduced."""
    missing = whole[1] - picture.shape[0], whole[0] - picture.shape[1]
    if any(missing):
        sides = ((0, missing[0]), (0, missing[1]), (0, 0))[: picture.ndim]
        picture = np.pad(picture, sides, mode="edge")
    if small != whole:
        picture = cv2.resize(picture, small, interpolation=cv2.INTER_AREA)
    return np.asarray(picture, np.uint8)


def _pictures(capture: Capture) -> NDArray[np.uint8]:
    """(n, H, W, 3) all photographs, lenses removed, in their common frame."""
    whole, small = _frame(capture)
    result = np.empty((len(capture), small[1], small[0], 3), np.uint8)

    def put(index: int) -> None:
        result[index] = _fitted(np.rint(capture.photograph(index).pixels * 255).astype(np.uint8), whole, small)

    parallel_map(put, range(len(capture)))
    return result


def _masks(capture: Capture) -> NDArray[np.uint8] | None:
    """(n, H, W, 3) the masks of the photographs, 255 where they count; None where there are none.

    What a removed lens leaves out at the border is no mask: the array's other views see behind it.
    """
    views = capture.shots if isinstance(capture, PhotoSet) else capture.views
    whole, small = _frame(capture)
    result = np.full((len(capture), small[1], small[0], 3), 255, np.uint8)

    def put(index: int) -> bool:
        view = views[index]
        if view.mask is None and getattr(view, "lens", None) is not None:
            return False
        mask = capture.photograph(index).mask
        if mask is None:
            return False
        result[index] = _fitted(np.rint(mask * 255).astype(np.uint8), whole, small)[..., None]
        return True

    return result if any(parallel_map(put, range(len(capture)))) else None


def _start(capture: Capture, pictures: NDArray[np.uint8], points: NDArray[np.float64] | None) -> PlanarStart:
    if isinstance(capture, PhotoSet):
        assert capture.layout is not None
        return start_planar(pictures, capture.layout, capture.names)
    cameras = _resized(capture)
    low, high = _inverse_depths(capture, cameras, pictures, points)
    return start_given(cameras, low, high)


def _resized(capture: LightField) -> list[Camera]:
    """The cameras in the common frame of `_pictures`."""
    whole, small = _frame(capture)
    scale = np.diag([small[0] / whole[0], small[1] / whole[1], 1.0])
    return [replace(camera, K=scale @ camera.K, width=small[0], height=small[1]) for camera in capture.cameras]


def _positions(capture: Capture) -> NDArray[np.float64]:
    """(n, 2) on the array's plane, any unit."""
    if isinstance(capture, PhotoSet):
        assert capture.layout is not None
        return capture.layout.positions
    return fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])


def _light_field(capture: Capture, planar: Planar) -> LightField:
    """The capture with the cameras that were found, at full size, without the views that fit nowhere."""
    views = np.arange(len(capture))
    cameras = planar.model.cameras(views, planar.parameters)
    error = planar.error
    typical = float(np.nanmedian(error))
    strange = ~(error <= max(STRANGE * typical, typical + STRANGE_LEAST))
    problems = [
        f"{capture.names[i]} shows something else, or its camera was moved: it differs by {error[i]:.0f} grey levels "
        f"from the others (they by {typical:.0f}); left out"
        for i in np.flatnonzero(strange)
    ]
    for problem in problems:
        log.warning("%s", problem)
    keep = [int(i) for i in np.flatnonzero(~strange)]
    chosen = capture.subset(keep)
    sizes = [(s.width, s.height) for s in (capture.shots if isinstance(capture, PhotoSet) else capture.cameras)]
    whole, small = _frame(capture)
    grown = []
    for index in keep:
        K = np.diag([whole[0] / small[0], whole[1] / small[1], 1.0]) @ cameras[index].K
        grown.append(replace(cameras[index], K=K, width=sizes[index][0], height=sizes[index][1]))
    if isinstance(chosen, PhotoSet):
        return chosen.calibrated(grown, problems=problems)
    views_ = tuple(replace(view, camera=camera) for view, camera in zip(chosen.views, grown, strict=True))
    return replace(chosen, views=views_, problems=(*chosen.problems, *problems))


def _poisson(run: _Run, light_field: LightField, points: NDArray[np.float64] | None, identity: list[Any]) -> Mesh:
    settings = run.settings
    by_hand = [settings.primitives, settings.fit_spheres, settings.background]
    inputs = [identity, None if points is None else len(points), settings.triangles, by_hand]

    def build(folder: Path) -> None:
        surface = surface_from_views(
            light_field, points, triangles=settings.triangles, background=settings.background,
            primitives=_by_hand(run, light_field), progress=run.progress,
        )  # fmt: skip
        log.info("surface: %d points from %d depth maps, error %s", surface.points, surface.views, surface.error)
        write_ply(surface.mesh, folder / MESH)

    return read_mesh(run.stage("surface", inputs, build) / MESH)


def _finished(run: _Run, light_field: LightField, mesh: Mesh, identity: list[Any]) -> Mesh:
    """With an atlas; in a relief, primitives are put in first."""
    settings = run.settings
    relief = mesh.uv is not None
    by_hand = [settings.primitives, settings.fit_spheres] if relief else []
    if relief and not any(by_hand):
        return mesh
    inputs = [identity, mesh_digest(mesh), by_hand]

    def build(folder: Path) -> None:
        result = mesh
        for primitive in _by_hand(run, light_field) if relief else ():
            result = insert_primitive(result, primitive, light_field.cameras)
        result = unwrapped(result, triangles=len(result.faces), cameras=light_field.cameras, progress=run.progress)
        log.info("atlas: %s", atlas_statistics(result))
        write_ply(result, folder / MESH)

    return read_mesh(run.stage("proxy", inputs, build) / MESH)


def mesh_digest(mesh: Mesh) -> str:
    """A digest of a mesh's vertices and faces."""
    return hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).hexdigest()


def _by_hand(run: _Run, light_field: LightField) -> list[Primitive]:
    """The primitives that were asked for, spheres fitted to their outlines."""
    shapes = [parse_primitive(text) for text in run.settings.primitives]
    for text in run.settings.fit_spheres:
        region = parse_region(text)
        fitted = fit_sphere(
            find_view(region, light_field.names), region, light_field.cameras,
            lambda index: light_field.photograph(index).pixels, progress=run.progress,
        )  # fmt: skip
        log.info("%s: %s", text, fitted)
        shapes.append(fitted.sphere)
    return shapes


def _write_cameras(path: Path, capture: Capture, light_field: LightField, points: NDArray[np.float64]) -> None:
    index = {name: i for i, name in enumerate(capture.names)}
    cameras = light_field.cameras
    lenses = [
        "" if view.lens is None else json.dumps([view.lens.model, list(view.lens.coefficients)])
        for view in light_field.views
    ]
    np.savez(
        path, kept=[index[name] for name in light_field.names], K=[c.K for c in cameras], R=[c.R for c in cameras],
        t=[c.t for c in cameras], sizes=[(c.width, c.height) for c in cameras], lenses=np.array(lenses),
        problems=np.array(light_field.problems, dtype=str), points=points,
    )  # fmt: skip


def _read_cameras(path: Path, capture: Capture) -> tuple[LightField, NDArray[np.float64]]:
    with np.load(path) as data:
        kept = [int(i) for i in data["kept"]]
        cameras = [
            Camera(K, R, t, int(size[0]), int(size[1]))
            for K, R, t, size in zip(data["K"], data["R"], data["t"], data["sizes"], strict=True)
        ]
        lenses = [None if not text else Lens(*json.loads(str(text))) for text in data["lenses"]]
        problems, points = tuple(map(str, data["problems"])), data["points"]
    chosen = capture.subset(kept)
    if isinstance(chosen, PhotoSet):
        light_field = chosen.calibrated(cameras, lenses)
    else:
        views = tuple(replace(view, camera=camera) for view, camera in zip(chosen.views, cameras, strict=True))
        light_field = replace(chosen, views=views)
    return replace(light_field, problems=problems), points


def _write_planar(path: Path, planar: Planar) -> None:
    canvas = planar.canvas
    views = np.arange(len(planar.parameters))
    np.savez(
        path, d=planar.d, confidence=planar.confidence, texture=planar.texture, count=planar.count, K=canvas.camera.K,
        R=canvas.camera.R, t=canvas.camera.t, canvas=[canvas.margin, canvas.offset, canvas.scale],
        matrices=planar.model.matrices(canvas, views, planar.parameters), range=[planar.low, planar.high],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Depth:
    """What `_write_planar` kept: the depth map of an array, and how its views look at it."""

    canvas: Canvas
    d: NDArray[np.float32]
    confidence: NDArray[np.float32]
    texture: NDArray[np.float32]
    count: NDArray[np.int32]
    matrices: NDArray[np.float64]
    low: float
    high: float


def _read_planar(path: Path) -> _Depth:
    with np.load(path) as data:
        d = data["d"]
        margin, offset, scale = data["canvas"].tolist()
        camera = Camera(data["K"], data["R"], data["t"], d.shape[1], d.shape[0])
        low, high = data["range"].tolist()
        return _Depth(
            Canvas(camera, int(margin), offset, scale), d, data["confidence"], data["texture"], data["count"],
            data["matrices"], low, high,
        )  # fmt: skip


def _inverse_depths(
    capture: LightField, cameras: Sequence[Camera], pictures: NDArray[np.uint8], points: NDArray[np.float64] | None
) -> tuple[float, float]:
    """The range of inverse depths seen from the camera in the middle, 1 / world units."""
    plane = fit_view_plane(cameras)
    middle = cameras[int(np.argmin(np.linalg.norm(plane.coordinates([c.centre for c in cameras]), axis=1)))]
    if points is not None and len(points) >= FEWEST_POINTS:
        pixels, depth = middle.project(points)
        inside = (depth > 0) & (pixels > 0).all(axis=1) & (pixels < (middle.width, middle.height)).all(axis=1)
        if inside.sum() >= FEWEST_POINTS:
            low, high = np.percentile(1 / depth[inside], [1, 99])
            return max(float(low - WIDENED * (high - low)), 0.3 * float(low)), float(high + WIDENED * (high - low))
    # disparities of one step, from infinity to a fifth of the picture
    provisional = start_given(cameras, *(1e-3, 1.0))
    canvas = provisional.model.canvas(0)
    matrices = provisional.model.matrices(canvas, np.arange(len(cameras)), provisional.parameters)
    chosen = np.argsort(np.linalg.norm(provisional.places, axis=1), kind="stable")[:RANGE_VIEWS]
    found = depth_range(pictures[chosen], matrices[chosen], canvas.shape, (0.0, canvas.camera.width / 5))
    if found is None:
        raise CaptureError(
            "depth-nothing",
            "no depth agrees with the photographs and their cameras",
            path=capture.root,
            remedy="look at the calibration (eigenfield inspect), or let it be estimated: eigenfield calibrate",
        )
    return max(found[0], 0.02 * found[1]) * canvas.scale, found[1] * canvas.scale
