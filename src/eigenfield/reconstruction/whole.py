"""From photographs to cameras and a proxy mesh (the paper's section 3.1): the stages in order, kept when finished."""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate import structure_from_motion, triangulate_points
from eigenfield.capture import Capture, LightField, PhotoSet
from eigenfield.capture.lightfield import PhotographSource
from eigenfield.capture.writers.save import save_calibration
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
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
from eigenfield.reconstruction.array import looks_one_way, relief_of_array
from eigenfield.reconstruction.kept import CAMERAS, ERROR, MESH, read_cameras, write_cameras
from eigenfield.reconstruction.report import ProxyReport, report_of
from eigenfield.reconstruction.run import DEFAULT_TRIANGLES, Run, Settings
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import Stages, file_digest

log = logging.getLogger("eigenfield.reconstruction")


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Cameras and proxy of a capture.

    light_field: the photographs with their cameras, those left out named in its problems.
    mesh: with an atlas, in the cameras' world.
    calibration: the folder with a transforms.json and a COLMAP model, where cameras were estimated or refined.
    seconds: of each stage, in order; 0 where it was taken up from an earlier run.
    report: what the mesh is like.
    """

    light_field: LightField
    mesh: Mesh
    calibration: Path | None
    seconds: dict[str, float]
    report: ProxyReport


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
    given or there are 25 views or more, unless they are exact. triangles: of the proxy, about so many at most.
    background: close the frustum behind what was reconstructed; None: unless there are masks. primitives: `sphere:...`
    or `plane:...`, put in by hand. fit_spheres: `VIEW:X,Y,W,H`, spheres fitted to an outline. blind: a rule of
    `hold_out` (see `encode`): these views take no part, each only registers its own camera; arrays only. work: the
    folder of finished stages; None keeps none.

    Raises CaptureError, ProxyError, OptionError, OutputError, each naming the file and the remedy.
    """
    settings = Settings(surface, refine, triangles, background, tuple(primitives), tuple(fit_spheres), blind)
    for text in fit_spheres:  # before the long stages
        find_view(parse_region(text), capture.names)
    with Stages(work) as stages:
        run = Run(stages, settings, progress, {})
        identity = _identity(capture)
        points = calibration = error = None
        if capture.light_field is None and capture.layout is None:  # not even a grid says where the cameras stood
            capture, points, calibration = _by_motion(run, capture, identity)
        if _wants_relief(capture, settings) or capture.light_field is None:
            light_field, mesh, folder = relief_of_array(run, capture, points, identity)
            calibration = folder or calibration
        else:
            light_field = capture
            if settings.blind is not None:
                raise OptionError(
                    "blind", "only arrays that look one way can be reconstructed blind",
                    remedy="leave out --blind: held-out views then help to find cameras and proxy",
                )  # fmt: skip
            mesh, error = _poisson(run, light_field, points, identity)
        mesh = _finished(run, light_field, mesh, identity)
        report = report_of(mesh, light_field.cameras, error)
        return Reconstruction(light_field, mesh, calibration if work is not None else None, run.seconds, report)


def _identity(capture: Capture) -> list[Any]:
    """All that a result depends on: every file's bytes, cameras, lenses, layout."""
    if capture.light_field is None:
        own: list[Any] = [] if capture.layout is None else [_plain(capture.layout)]
        own += [[shot.focal, shot.width, shot.height] for shot in capture.shots]
    else:
        own = [
            [view.camera.K.tolist(), view.camera.R.tolist(), view.camera.t.tolist(), str(view.lens)]
            for view in capture.views
        ]

    def digest(source: PhotographSource) -> list[Any]:
        mask = None if source.mask is None else file_digest(source.mask)
        return [source.name, file_digest(source.path), mask, source.upright]

    return [parallel_map(digest, capture.sources), own]


def _plain(value: Any) -> dict[str, Any]:
    """A dataclass of arrays and numbers as JSON can hold it."""
    items = ((field.name, getattr(value, field.name)) for field in fields(value))
    return {name: item.tolist() if isinstance(item, np.ndarray) else item for name, item in items}


def _by_motion(run: Run, photos: PhotoSet, identity: list[Any]) -> tuple[LightField, NDArray[np.float64], Path]:
    """Cameras of photographs of which nothing is known, by structure from motion."""

    def build(folder: Path) -> None:
        motion = structure_from_motion(photos, work=run.stages.folder / "matches", progress=run.progress)
        save_calibration(motion.light_field, folder / "calibration", motion.points)
        write_cameras(folder / CAMERAS, photos, motion.light_field, motion.points.positions)

    folder = run.stage("motion", [identity], build)
    light_field, points = read_cameras(folder / CAMERAS, photos)
    return light_field, points, folder / "calibration"


def _wants_relief(capture: Capture, settings: Settings) -> bool:
    """Always, for a grid whose cameras are not known. Raises OptionError `surface` where that cannot be."""
    if capture.light_field is None:
        if settings.surface == "poisson":
            raise OptionError(
                "surface", "a grid without calibration has no metric frame for a Poisson surface",
                remedy="leave out --surface, or calibrate first",
            )  # fmt: skip
        return True
    if settings.surface != "auto":
        return settings.surface == "relief"
    return looks_one_way(capture.cameras)


def _poisson(
    run: Run, light_field: LightField, points: NDArray[np.float64] | None, identity: list[Any]
) -> tuple[Mesh, SurfaceError]:
    settings = run.settings
    by_hand = [settings.primitives, settings.fit_spheres, settings.background]
    inputs = [identity, None if points is None else len(points), settings.triangles, by_hand]

    def build(folder: Path) -> None:
        known = triangulate_points(light_field, progress=run.progress) if points is None else points
        surface = surface_from_views(
            light_field, known, triangles=settings.triangles, background=settings.background,
            primitives=_by_hand(run, light_field), progress=run.progress,
        )  # fmt: skip
        log.info("surface: %d points from %d depth maps, error %s", surface.points, surface.views, surface.error)
        write_ply(surface.mesh, folder / MESH)
        (folder / ERROR).write_text(json.dumps(asdict(surface.error)), encoding="utf-8")

    folder = run.stage("surface", inputs, build)
    return read_mesh(folder / MESH), SurfaceError(**json.loads((folder / ERROR).read_text(encoding="utf-8")))


def _finished(run: Run, light_field: LightField, mesh: Mesh, identity: list[Any]) -> Mesh:
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
        result = unwrap_mesh(result, triangles=len(result.faces), cameras=light_field.cameras, progress=run.progress)
        write_ply(result, folder / MESH)

    return read_mesh(run.stage("proxy", inputs, build) / MESH)


def mesh_digest(mesh: Mesh) -> str:
    """A digest of a mesh's vertices and faces."""
    return hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).hexdigest()


def _by_hand(run: Run, light_field: LightField) -> list[Primitive]:
    """The primitives that were asked for, spheres fitted to their outlines."""
    shapes = [parse_primitive(text) for text in run.settings.primitives]
    for text in run.settings.fit_spheres:
        region = parse_region(text)
        fitted = fit_sphere(
            find_view(region, light_field.names), region, light_field.cameras, light_field, progress=run.progress
        )
        log.info("%s: %s", text, fitted)
        shapes.append(fitted.sphere)
    return shapes
