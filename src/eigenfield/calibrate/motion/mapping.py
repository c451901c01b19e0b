"""Incremental structure from motion over verified matches (Schönberger and Frahm, CVPR 2016), by COLMAP, in memory.

One thread throughout: COLMAP's bundle adjustment sums in another order with more.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.motion.colmap_core import interruptible, pycolmap
from eigenfield.calibrate.motion.matching import FEWEST_INLIERS, Match
from eigenfield.core.progress import Progress

SMALLEST_MODEL = 3  # views
LOOSE_INLIERS, LOOSE_RATIO = 14, 0.15  # for photographs that the usual thresholds leave over
FEWEST_OBSERVATIONS = 14  # points that a registered view must see
SMALLEST_ANGLE = 0.5  # degrees between the rays of a point that is kept
LIMITS = (4.0, 3.5, 3.0)  # spreads of the residuals beyond which a point is dropped, round after round
ERRORS = (0.5, 4.0)  # pixels between which that limit is held
SPREADS = (0.15, 1.5)  # pixels between which the scale of the loss is held
NORMAL = 1.4826  # standard deviation of a normal distribution over its median deviation


@dataclass(frozen=True, eq=False)
class Model:
    """What came out of the mapper.

    reconstruction: COLMAP's; image k + 1 is photograph k.
    registered: photographs in it, in order. tried: those that were lost again because too little held.
    others: photographs of smaller models that could not be joined, largest first.
    """

    reconstruction: Any
    registered: tuple[int, ...]
    tried: tuple[int, ...]
    others: tuple[tuple[int, ...], ...]


def map_views(
    points: Sequence[NDArray[np.float64]],
    cameras: Sequence[Any],
    shared: Sequence[int],
    matches: Sequence[Match],
    fixed: bool,
    seed: int = 0,
    progress: Progress | None = None,
) -> Model | None:
    """Poses and points of the largest set of photographs that hold together; None where nothing does.

    points: (n, 2) features of each photograph, in pixels of its camera. cameras: pycolmap cameras.
    shared: each photograph's camera. fixed: the cameras' intrinsics are not touched.
    """

    def work(check: Callable[[], None]) -> Model | None:
        database = _database(points, cameras, shared, matches)
        try:
            return _map(database, len(points), fixed, seed, check, progress)
        finally:
            database.close()

    return interruptible(work)


def _database(
    points: Sequence[NDArray[np.float64]],
    cameras: Sequence[Any],
    shared: Sequence[int],
    matches: Sequence[Match],
) -> Any:
    database = pycolmap.Database.open(":memory:")
    for number, camera in enumerate(cameras, 1):
        camera.camera_id = number
        database.write_camera(camera, True)
        rig = pycolmap.Rig(rig_id=number)
        rig.add_ref_sensor(camera.sensor_id)
        database.write_rig(rig, True)
    for number, (places, camera_index) in enumerate(zip(points, shared, strict=True), 1):
        # names are only for people, and may repeat or hold what SQL does not: numbers do as well
        image = pycolmap.Image(name=f"{number:06d}", camera_id=camera_index + 1, image_id=number)
        database.write_image(image, True)
        frame = pycolmap.Frame(frame_id=number, rig_id=camera_index + 1)
        frame.add_data_id(image.data_id)
        database.write_frame(frame, True)
        database.write_keypoints(number, np.ascontiguousarray(places, np.float32).reshape(-1, 2))
    for match in matches:
        if match.geometry is not None:
            database.write_two_view_geometry(match.first + 1, match.second + 1, match.geometry)
    return database


def _options(fixed: bool, seed: int) -> Any:
    options = pycolmap.IncrementalPipelineOptions()
    options.num_threads = options.mapper.num_threads = 1
    options.random_seed = options.mapper.random_seed = options.triangulation.random_seed = seed
    options.extract_colors = False
    options.min_model_size = SMALLEST_MODEL
    options.min_num_matches = FEWEST_INLIERS
    if fixed:
        options.ba_refine_focal_length = options.ba_refine_extra_params = options.ba_refine_principal_point = False
        options.mapper.abs_pose_refine_focal_length = options.mapper.abs_pose_refine_extra_params = False
    return options


def _map(
    database: Any, count: int, fixed: bool, seed: int, check: Callable[[], None], progress: Progress | None
) -> Model | None:
    options = _options(fixed, seed)
    manager = pycolmap.ReconstructionManager()
    _run(options, database, manager, count, "cameras", check, progress)
    models = sorted(
        (manager.get(k) for k in range(manager.size())), key=lambda m: (-m.num_reg_images(), -m.num_points3D())
    )
    if not models or models[0].num_reg_images() < SMALLEST_MODEL:
        return None
    others = [_registered(model) for model in models[1:]]
    best = pycolmap.Reconstruction(models[0])
    if best.num_reg_images() < count:
        best = _loosened(best, _options(fixed, seed), database, count, check, progress)
    check()
    before = set(_registered(best))
    _polish(best, fixed)
    registered = _registered(best)
    if len(registered) < SMALLEST_MODEL:
        return None
    rest = [tuple(sorted(set(other) - set(registered))) for other in others]
    return Model(
        best, registered, tuple(sorted(before - set(registered))), tuple(r for r in rest if len(r) >= SMALLEST_MODEL)
    )


def _registered(model: Any) -> tuple[int, ...]:
    return tuple(sorted(image - 1 for image in model.reg_image_ids()))


def _run(
    options: Any,
    database: Any,
    manager: Any,
    count: int,
    stage: str,
    check: Callable[[], None],
    progress: Progress | None,
) -> None:
    pipeline = pycolmap.IncrementalPipeline(options, database, manager)
    most = 0

    def registered() -> None:
        nonlocal most
        check()
        done = max((manager.get(k).num_reg_images() for k in range(manager.size())), default=0)
        if progress is not None and done > most:
            most = done
            progress(stage, done, count)

    if progress is not None:
        progress(stage, 0, count)
    for event in ("INITIAL_IMAGE_PAIR_REG_CALLBACK", "NEXT_IMAGE_REG_CALLBACK"):
        pipeline.add_callback(getattr(pycolmap.IncrementalPipelineCallback, event).value, registered)
    pipeline.run()
    if progress is not None:
        progress(stage, count, count)


def _loosened(
    model: Any, loose: Any, database: Any, count: int, check: Callable[[], None], progress: Progress | None
) -> Any:
    """The model with what registers when fewer points need to agree; `_polish` throws out what does not hold."""
    loose.mapper.abs_pose_min_num_inliers = LOOSE_INLIERS
    loose.mapper.abs_pose_min_inlier_ratio = LOOSE_RATIO
    loose.triangulation.ignore_two_view_tracks = False
    manager = pycolmap.ReconstructionManager()
    with tempfile.TemporaryDirectory(prefix="eigenfield-") as folder:  # a manager takes models from files alone
        model.write(folder)
        manager.read(folder)
    _run(loose, database, manager, count, "cameras left over", check, progress)
    return pycolmap.Reconstruction(
        max((manager.get(k) for k in range(manager.size())), key=lambda m: m.num_reg_images())
    )


def _polish(model: Any, fixed: bool) -> None:
    """Adjust everything to convergence under Cauchy's loss, and drop points that do not fit, then views that see too
    few.

    The loss's scale and the limit follow the residuals, whose spread differs tenfold from capture to capture; a fixed
    limit of four pixels lets in enough wrong matches to turn the cameras of a small photograph by a degree.
    """
    settings = pycolmap.BundleAdjustmentOptions()
    settings.refine_focal_length = settings.refine_extra_params = not fixed
    settings.refine_principal_point = False
    settings.ceres.use_gpu = False
    settings.ceres.loss_function_type = pycolmap.LossFunctionType.CAUCHY
    settings.ceres.solver_options.num_threads = 1
    settings.ceres.solver_options.max_num_iterations = 100
    settings.ceres.solver_options.function_tolerance = 1e-9
    for times in LIMITS:
        settings.ceres.loss_function_scale = float(np.clip(_spread(model), *SPREADS))
        config = pycolmap.BundleAdjustmentConfig()
        for image_id in sorted(model.reg_image_ids()):
            config.add_image(image_id)
        config.fix_gauge(pycolmap.BundleAdjustmentGauge.TWO_CAMS_FROM_WORLD)
        # not pycolmap.bundle_adjustment: that one turns COLMAP's log back on
        pycolmap.create_default_bundle_adjuster(settings, config, model).solve()
        observations = pycolmap.ObservationManager(model)
        limit = float(np.clip(times * _spread(model), *ERRORS))
        observations.filter_all_points3D(limit, SMALLEST_ANGLE)
        for image_id in sorted(model.reg_image_ids()):
            image = model.image(image_id)
            if image.num_points3D < FEWEST_OBSERVATIONS:
                observations.deregister_frame(image.frame_id)
        if model.num_reg_images() < SMALLEST_MODEL:
            return


def _spread(model: Any) -> float:
    """A robust standard deviation of the reprojection errors, pixels."""
    errors = []
    for image_id in sorted(model.reg_image_ids()):
        image = model.image(image_id)
        for seen in image.get_observation_points2D():
            pixel = image.project_point(model.point3D(seen.point3D_id).xyz)
            if pixel is not None:
                errors.append(float(np.linalg.norm(pixel - seen.xy)))
    return NORMAL * float(np.median(errors)) if errors else 0.0
