"""Incremental structure from motion over verified matches (Schönberger and Frahm, CVPR 2016), by COLMAP, in memory.

It runs in one thread: with more, COLMAP's bundle adjustment sums in another order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.motion.colmap_core import pycolmap, run_interruptibly
from eigenfield.calibration.motion.matching import MATCHING_MIN_INLIERS, Match
from eigenfield.core.progress import Progress
from eigenfield.runtime.temporary import temporary_folder

# Constants of `map_views`.
MAPPING_MIN_VIEWS = 3  # views of the smallest model
MAPPING_RELAXED_MIN_INLIERS = 14  # points that must agree for a photograph that the usual thresholds leave over
MAPPING_RELAXED_MIN_INLIER_RATIO = 0.15  # fraction of its points that must agree
MAPPING_MIN_OBSERVATIONS = 14  # points that a registered view must see
MAPPING_MIN_ANGLE_DEGREES = 0.5  # angle between the rays of a point that is kept
MAPPING_OUTLIER_SPREADS = (4.0, 3.5, 3.0)  # spreads of the residuals beyond which a point is dropped, one a round
MAPPING_OUTLIER_RANGE_PIXELS = (0.5, 4.0)  # bounds of that limit
MAPPING_LOSS_RANGE_PIXELS = (0.15, 1.5)  # bounds of the loss function's scale
# Focal lengths that are believed, in longer sides of the photograph. Where nearly all lies on one plane and cameras
# are parallel, any focal length explains the matches.
MAPPING_FOCAL_RANGE_SIDES = (0.1, 10.0)
MAPPING_MAX_DISTORTION = 1.0  # absolute value of the radial coefficient that is believed
MAPPING_SIGMA_PER_MEDIAN = 1.4826  # standard deviation of a normal distribution over its median absolute deviation


@dataclass(frozen=True, eq=False)
class SparseModel:
    """A sparse reconstruction.

    Attributes:
        reconstruction: COLMAP's reconstruction; image k + 1 is photograph k.
        registered: Photographs in it, in order.
        separate: Photographs of smaller models that could not be joined, largest first.
    """

    reconstruction: Any
    registered: tuple[int, ...]
    separate: tuple[tuple[int, ...], ...]


def map_views(
    points: Sequence[NDArray[np.float64]],
    cameras: Sequence[Any],
    shared: Sequence[int],
    matches: Sequence[Match],
    fixed: bool,
    seed: int = 0,
    progress: Progress | None = None,
) -> SparseModel | None:
    """Poses and points of the largest set of photographs that fit together; None if there is none.

    Args:
        points: (n, 2) features of each photograph, in pixels of its camera.
        shared: Index of each photograph's camera.
        fixed: The intrinsics are not refined.
    """

    def work(check: Callable[[], None]) -> SparseModel | None:
        database = _database(points, cameras, shared, matches)
        try:
            return _map(database, len(points), fixed, seed, check, progress)
        finally:
            database.close()

    return run_interruptibly(work)


def _database(
    points: Sequence[NDArray[np.float64]], cameras: Sequence[Any], shared: Sequence[int], matches: Sequence[Match]
) -> Any:
    database = pycolmap.Database.open(":memory:")
    for number, camera in enumerate(cameras, 1):
        camera.camera_id = number
        database.write_camera(camera, True)
        rig = pycolmap.Rig(rig_id=number)
        rig.add_ref_sensor(camera.sensor_id)
        database.write_rig(rig, True)
    for number, (places, camera_index) in enumerate(zip(points, shared, strict=True), 1):
        # numbers, because names may repeat or hold characters that SQL does not
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
    options.min_model_size = MAPPING_MIN_VIEWS
    options.min_num_matches = MATCHING_MIN_INLIERS
    if fixed:
        options.ba_refine_focal_length = options.ba_refine_extra_params = options.ba_refine_principal_point = False
        options.mapper.abs_pose_refine_focal_length = options.mapper.abs_pose_refine_extra_params = False
    return options


def _map(
    database: Any, count: int, fixed: bool, seed: int, check: Callable[[], None], progress: Progress | None
) -> SparseModel | None:
    options = _options(fixed, seed)
    manager = pycolmap.ReconstructionManager()
    _run(options, database, manager, count, "cameras", check, progress)
    models = sorted(
        (manager.get(k) for k in range(manager.size())), key=lambda m: (-m.num_reg_images(), -m.num_points3D())
    )
    if not models or models[0].num_reg_images() < MAPPING_MIN_VIEWS:
        return None
    others = [_registered_views(model) for model in models[1:]]
    best = pycolmap.Reconstruction(models[0])
    if best.num_reg_images() < count:
        best = _register_leftovers(best, _options(fixed, seed), database, count, check, progress)
    check()
    _adjust_and_filter(best, fixed)
    registered = _registered_views(best)
    if len(registered) < MAPPING_MIN_VIEWS:
        return None
    rest = [tuple(sorted(set(other) - set(registered))) for other in others]
    separate = tuple(views for views in rest if len(views) >= MAPPING_MIN_VIEWS)
    return SparseModel(best, registered, separate)


def _registered_views(model: Any) -> tuple[int, ...]:
    return tuple(sorted(image - 1 for image in model.reg_image_ids()))


def _run(
    options: Any, database: Any, manager: Any, count: int, stage: str, check: Callable[[], None],
    progress: Progress | None,
) -> None:  # fmt: skip
    pipeline = pycolmap.IncrementalPipeline(options, database, manager)
    report = progress or (lambda stage, done, total: None)
    most = 0

    def report_registered() -> None:
        nonlocal most
        check()
        done = max((manager.get(k).num_reg_images() for k in range(manager.size())), default=0)
        if done > most:
            most = done
            report(stage, done, count)

    report(stage, 0, count)
    for event in ("INITIAL_IMAGE_PAIR_REG_CALLBACK", "NEXT_IMAGE_REG_CALLBACK"):
        pipeline.add_callback(getattr(pycolmap.IncrementalPipelineCallback, event).value, report_registered)
    pipeline.run()
    report(stage, count, count)


def _register_leftovers(
    model: Any, loose: Any, database: Any, count: int, check: Callable[[], None], progress: Progress | None
) -> Any:
    """The model with photographs that register when fewer points need to agree.

    `_adjust_and_filter` removes those that do not hold.
    """
    loose.mapper.abs_pose_min_num_inliers = MAPPING_RELAXED_MIN_INLIERS
    loose.mapper.abs_pose_min_inlier_ratio = MAPPING_RELAXED_MIN_INLIER_RATIO
    loose.triangulation.ignore_two_view_tracks = False
    manager = pycolmap.ReconstructionManager()
    with temporary_folder() as folder:  # a manager reads models only from files
        model.write(folder)
        manager.read(folder)
    _run(loose, database, manager, count, "cameras left over", check, progress)
    return pycolmap.Reconstruction(
        max((manager.get(k) for k in range(manager.size())), key=lambda m: m.num_reg_images())
    )


def _adjust_and_filter(model: Any, fixed: bool) -> None:
    """Bundle adjustment to convergence under Cauchy's loss; then drop outlier points, and views that see too few points
    or whose lens cannot be.

    The loss scale and the limit follow the residuals, whose spread differs tenfold between captures. A fixed limit of
    four pixels lets in enough wrong matches to rotate the cameras of a small photograph by a degree.
    """
    settings = pycolmap.BundleAdjustmentOptions()
    settings.refine_focal_length = settings.refine_extra_params = not fixed
    settings.refine_principal_point = False
    settings.ceres.use_gpu = False
    settings.ceres.loss_function_type = pycolmap.LossFunctionType.CAUCHY
    settings.ceres.solver_options.num_threads = 1
    settings.ceres.solver_options.max_num_iterations = 100
    settings.ceres.solver_options.function_tolerance = 1e-9
    for times in MAPPING_OUTLIER_SPREADS:
        settings.ceres.loss_function_scale = float(np.clip(_residual_spread(model), *MAPPING_LOSS_RANGE_PIXELS))
        config = pycolmap.BundleAdjustmentConfig()
        for image_id in sorted(model.reg_image_ids()):
            config.add_image(image_id)
        config.fix_gauge(pycolmap.BundleAdjustmentGauge.TWO_CAMS_FROM_WORLD)
        # not pycolmap.bundle_adjustment, which turns COLMAP's log back on
        pycolmap.create_default_bundle_adjuster(settings, config, model).solve()
        observations = pycolmap.ObservationManager(model)
        limit = float(np.clip(times * _residual_spread(model), *MAPPING_OUTLIER_RANGE_PIXELS))
        observations.filter_all_points3D(limit, MAPPING_MIN_ANGLE_DEGREES)
        for image_id in sorted(model.reg_image_ids()):
            image = model.image(image_id)
            bogus = image.camera.has_bogus_params(*MAPPING_FOCAL_RANGE_SIDES, MAPPING_MAX_DISTORTION)
            if image.num_points3D < MAPPING_MIN_OBSERVATIONS or (bogus and not fixed):
                observations.deregister_frame(image.frame_id)
        if model.num_reg_images() < MAPPING_MIN_VIEWS:
            return


def _residual_spread(model: Any) -> float:
    """A robust standard deviation of the reprojection errors, pixels."""
    errors = []
    for image_id in sorted(model.reg_image_ids()):
        image = model.image(image_id)
        for seen in image.get_observation_points2D():
            pixel = image.project_point(model.point3D(seen.point3D_id).xyz)
            if pixel is not None:
                errors.append(float(np.linalg.norm(pixel - seen.xy)))
    return MAPPING_SIGMA_PER_MEDIAN * float(np.median(errors)) if errors else 0.0
