"""From photographs to cameras and a proxy mesh (section 3.1 of the paper): the stages in order."""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Collection
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration import structure_from_motion, triangulate_points
from eigenfield.capture import Capture, LightField, PhotoSet
from eigenfield.capture.identity import capture_identity
from eigenfield.capture.survey import refuse_one_place
from eigenfield.capture.writers.save import save_calibration
from eigenfield.core.arguments import checked
from eigenfield.core.brief import brief_repr
from eigenfield.core.errors import OptionError
from eigenfield.core.fields import takes_options
from eigenfield.core.mesh import Mesh
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.proxy import (
    Primitive,
    find_view,
    fit_sphere,
    insert_primitive,
    parse_primitive,
    parse_region,
    read_mesh,
    surface_from_views,
    unwrap_mesh,
    write_ply,
)
from eigenfield.proxy.surface.trim import SurfaceError
from eigenfield.reconstruction.array import align_array, looks_one_way, relief_of_array
from eigenfield.reconstruction.layered import (
    LayerSource,
    asked_count,
    better_count,
    check_capture,
    layers_of_capture,
)
from eigenfield.reconstruction.options import SurfaceOptions
from eigenfield.reconstruction.report import ProxyReport, measure_proxy
from eigenfield.reconstruction.run import StageRunner
from eigenfield.reconstruction.stage_files import (
    STAGE_CAMERAS_FILE,
    STAGE_ERROR_FILE,
    STAGE_MESH_FILE,
    read_cameras,
    write_cameras,
)
from eigenfield.reconstruction.unseen import held_out_names, rule_for, without
from eigenfield.runtime.stages import Stages
from eigenfield.runtime.tasks import Workers
from eigenfield.stereo import ReferenceView

log = logging.getLogger("eigenfield.reconstruction")


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Cameras and proxy of a capture.

    Attributes:
        light_field: The photographs with their cameras; `problems` lists those that were left out.
        proxy: In the cameras' world, with an atlas, unless `reconstruct` was to leave that of a surface from all sides
            to who simplifies it.
        calibration: The folder with a transforms.json and a COLMAP model, if cameras were estimated or refined.
        seconds: Time of each stage, in order; 0 for stages of an earlier run.
        report: Quality measures of the proxy's mesh.
        hold_out: A rule of `hold_out` (see `encode`) for the photographs of `light_field`, which holds out those that
            `hold_out`, or else `blind`, named among all photographs; None: there are none.
        reference: Of a relief: the view over whose pixels it stands, by its texture coordinates too; None for others.
    """

    light_field: LightField
    proxy: Proxy
    calibration: Path | None
    seconds: dict[str, float]
    report: ProxyReport
    hold_out: str | None = None
    reference: ReferenceView | None = None

    __repr__ = brief_repr


@checked
@takes_options(SurfaceOptions)
def reconstruct(
    capture: Capture,
    options: SurfaceOptions | None = None,
    *,
    atlas: bool = True,
    work: Path | None = None,
    workers: Workers | None = None,
    progress: Progress | None = notebook_progress,
    **changes: Any,
) -> Reconstruction:
    """Estimate what a capture lacks: cameras if it has none, and a proxy.

    Args:
        capture: Photographs, with or without cameras.
        options: What is asked for; None for the defaults.
        atlas: Whether a surface from all sides gets an atlas.
        work: The folder of finished stages; None: nothing is stored.
        workers: Of `open_executor`: they find features, compare pairs, and make the depth maps of cameras all around.
            They see `work`.
        progress: Called within stages; by default bars in a notebook.
        changes: In place of those of `options`.

    Raises:
        CaptureError: The photographs cannot be read or do not fit together.
        ProxyError: There is no surface.
        OptionError: An option does not fit the capture.
        OutputError: `work` cannot be written.
    """
    settings = replace(options or SurfaceOptions(), **changes)
    check_settings(capture, settings)
    blind, hold_out = settings.blind, settings.hold_out
    unseen = held_out_names(blind, capture)
    unknown = capture.light_field is None and capture.layout is None
    rule = blind if hold_out is None else hold_out
    held = None if unknown and rule == "odd" else held_out_names(rule, capture)
    with Stages(work) as stages:
        run = StageRunner(stages, settings, capture_identity(capture), progress, {}, workers)
        points = calibration = array = None
        if capture.light_field is None and capture.layout is None:  # nothing is known about the cameras
            capture, points, calibration = _estimate_cameras(run, capture, unseen)
        if held is None:
            held = held_out_names(rule, capture)
        if _is_array(without(capture, unseen), settings):
            if workers is not None:
                log.warning("an array has one depth map of all views: workers have no part in it")
            array = align_array(run, capture, points, unseen)
        if array is not None:
            light_field, calibration = array.light_field, array.folder / "calibration"
        else:
            assert capture.light_field is not None
            light_field = capture.light_field
        source = LayerSource(capture, light_field, array, points, unseen | held)
        if settings.surface == "layers":
            proxy, error = layers_of_capture(run, source, asked_count(run, source)), None
        else:
            mesh, error = _opaque_surface(run, source, without(light_field, unseen), atlas)
            proxy = Proxy(mesh)
            count = better_count(run, source, mesh) if settings.surface == "auto" else None
            if count is not None:
                proxy, error = layers_of_capture(run, source, count), None
        report = measure_proxy(proxy.mesh, light_field.cameras, error)
        folder = calibration if work is not None else None
        by_hand = [*settings.primitives, *settings.fit_spheres]
        relief = array is not None and proxy.sheets is None and not by_hand
        reference = array.depth().reference if array is not None and relief else None
        rule = rule_for(light_field, rule, held)
        return Reconstruction(light_field, proxy, folder, run.seconds, report, rule, reference)


def check_settings(capture: Capture, settings: SurfaceOptions) -> None:
    """Before the long stages: refuse settings that do not fit what is known of a capture.

    Raises:
        CaptureError, OptionError: As `reconstruct`.
    """
    seen = without(capture, held_out_names(settings.blind, capture))
    for text in settings.fit_spheres:
        find_view(parse_region(text), seen.names)
    refuse_one_place(capture)
    if settings.surface == "layers":
        check_capture(capture)
    if capture.light_field is not None or capture.layout is not None:
        _is_array(seen, settings)  # raises


def _opaque_surface(
    run: StageRunner, source: LayerSource, shown: LightField, atlas: bool
) -> tuple[Mesh, SurfaceError | None]:
    """A relief, or a surface from all sides, made from the photographs `shown`; `atlas`: whether the latter has one."""
    if source.array is not None:
        return _add_atlas(run, shown, relief_of_array(run, source.capture, source.array)), None
    mesh, error = _poisson(run, shown, source.points)
    return _add_atlas(run, shown, mesh) if atlas else mesh, error


def _estimate_cameras(
    run: StageRunner, photos: PhotoSet, unseen: Collection[str]
) -> tuple[LightField, NDArray[np.float64], Path]:
    """Cameras of photographs without any information, by structure from motion."""

    blind = [index for index, name in enumerate(photos.names) if name in unseen]

    def build(folder: Path) -> None:
        with run.parts() as parts:
            motion = structure_from_motion(
                photos, work=run.stages.folder / "matches", parts=parts, progress=run.progress, blind=blind
            )
        save_calibration(motion.light_field, folder / "calibration", motion.points)
        write_cameras(folder / STAGE_CAMERAS_FILE, photos, motion.light_field, motion.points.positions)

    folder = run.stage("motion", blind, build)
    light_field, points = read_cameras(folder / STAGE_CAMERAS_FILE, photos)
    return light_field, points, folder / "calibration"


def _is_array(capture: Capture, settings: SurfaceOptions) -> bool:
    """Whether cameras and depth are found as an array's; always for a grid with unknown cameras.

    Raises OptionError `surface`.
    """
    if capture.light_field is None:
        if settings.surface == "poisson":
            raise OptionError(
                "surface", "a grid without calibration has no metric frame for a Poisson surface",
                remedy="leave out --surface, or calibrate first",
            )  # fmt: skip
        return True
    if settings.surface in ("auto", "layers"):
        return looks_one_way(capture.cameras)
    return settings.surface == "relief"


def _poisson(
    run: StageRunner, light_field: LightField, points: NDArray[np.float64] | None
) -> tuple[Mesh, SurfaceError]:
    settings = run.settings
    by_hand = [settings.primitives, settings.fit_spheres, settings.background]
    inputs = [None if points is None else len(points), settings.triangles, by_hand, light_field.names]

    def build(folder: Path) -> None:
        known = triangulate_points(light_field, progress=run.progress) if points is None else points
        with run.parts() as parts:
            surface = surface_from_views(
                light_field, known, triangles=settings.triangles, background=settings.background,
                primitives=_requested_primitives(run, light_field), parts=parts, progress=run.progress,
            )  # fmt: skip
        log.info("surface: %d points from %d depth maps, error %s", surface.points, surface.views, surface.error)
        write_ply(surface.mesh, folder / STAGE_MESH_FILE)
        (folder / STAGE_ERROR_FILE).write_text(json.dumps(asdict(surface.error)), encoding="utf-8")

    folder = run.stage("surface", inputs, build)
    error = json.loads((folder / STAGE_ERROR_FILE).read_text(encoding="utf-8"))
    return read_mesh(folder / STAGE_MESH_FILE), SurfaceError(**error)


def _add_atlas(run: StageRunner, light_field: LightField, mesh: Mesh) -> Mesh:
    """The mesh with an atlas; primitives are inserted into a relief first."""
    settings = run.settings
    relief = mesh.uv is not None
    by_hand = [settings.primitives, settings.fit_spheres] if relief else []
    if relief and not any(by_hand):
        return mesh
    inputs = [hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).hexdigest(), by_hand, light_field.names]

    def build(folder: Path) -> None:
        result = mesh
        for primitive in _requested_primitives(run, light_field) if relief else ():
            result = insert_primitive(result, primitive, light_field.cameras)
        result = unwrap_mesh(result, triangles=len(result.faces), cameras=light_field.cameras, progress=run.progress)
        write_ply(result, folder / STAGE_MESH_FILE)

    return read_mesh(run.stage("proxy", inputs, build) / STAGE_MESH_FILE)


def _requested_primitives(run: StageRunner, light_field: LightField) -> list[Primitive]:
    """The primitives of the settings, with spheres fitted to their outlines."""
    shapes = [parse_primitive(text).moved(-light_field.origin) for text in run.settings.primitives]
    for text in run.settings.fit_spheres:
        region = parse_region(text)
        fitted = fit_sphere(
            find_view(region, light_field.names), region, light_field.cameras, light_field, progress=run.progress
        )
        log.info("%s: %s", text, fitted)
        shapes.append(fitted.sphere)
    return shapes
