"""The paper's way: photographs projected into texture maps, their mean and eigen textures. From a plan to a scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.scene import Scene
from eigenfield.encoding.agreement import warn_of_disagreement
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.options import DEFAULT_MAX_ANGLE, resolved_value
from eigenfield.encoding.plan import EncodePlan, component_count
from eigenfield.encoding.projected.align import align_maps
from eigenfield.encoding.projected.eigen import eigen_textures, eigenvectors, gram_matrix, weights_of
from eigenfield.encoding.projected.harmonise import harmonise_maps
from eigenfield.encoding.projected.maps_on_workers import maps_on_workers
from eigenfield.encoding.projected.mean import Mean, mean_map
from eigenfield.encoding.projected.project import RESAMPLING, TextureMaps, texture_maps
from eigenfield.encoding.projected.uv_measure import smallest_count
from eigenfield.encoding.spread import Spreader, make_spreader
from eigenfield.encoding.views import nothing_seen_error
from eigenfield.imaging.png import png_bytes
from eigenfield.runtime.files import make_folder, write_bytes
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.tasks import Workers


def encode_projected(
    plan: EncodePlan, work: Path | None = None, progress: Progress | None = None, workers: Workers | None = None
) -> Scene:
    """A scene by the paper's sections 3.2 and 3.3; its textures are numbers, which `save` codes.

    Args:
        work: Folder for a scratch file of 4 bytes x channels x cameras x texels.
        workers: Of `open_executor`: they make the texture maps. None: this process does.

    Raises:
        CaptureError: A photograph cannot be read, or no camera sees the proxy (`nothing-seen`).
        OutputError: The scratch folder is full (`disk-full`), or maps cannot be written.
    """
    begin_step(progress, "maps")
    options, views = plan.options, plan.views
    settings = {"uvSsim": options.uv_ssim, "align": "dis" if options.align else None, "resampling": RESAMPLING}
    max_angle = resolved_value(options.max_angle)
    if max_angle != DEFAULT_MAX_ANGLE:
        settings["maxAngle"] = max_angle
    colours, maps_of_workers = None, None
    sources = make_atlas(plan.mesh, *plan.atlas), views.rig.encoded_cameras, views.observations
    if workers is not None:
        maps_of_workers = maps_on_workers(workers, *sources, work, max_angle, progress)
    with texture_maps(*sources, max_angle=max_angle, maps=maps_of_workers, work=work, progress=progress) as maps:
        if options.harmonise not in (None, "none"):
            settings["harmonise"] = options.harmonise
            colours = views.for_all_cameras(harmonise_maps(maps, options.harmonise, progress))
        if options.align:
            reference = views.taken_by.tolist().index(views.rig.reference)
            align_maps(maps, reference, progress)
        mean = mean_map(maps, progress)  # equation 1
        if not mean.seen.any():
            raise nothing_seen_error()
        spreader = make_spreader(maps.atlas, mean.seen)
        basis = _basis_of(maps, mean, spreader, plan, work, progress)  # equations 2 to 6
        if options.keep_maps is not None:
            write_maps(maps, mean.values, spreader, views.observation_names, Path(options.keep_maps), progress=progress)
    return plan.scene((Plane(spreader(mean.values), (basis,)),), settings, colours=colours)


def _basis_of(
    maps: TextureMaps, mean: Mean, spreader: Spreader, plan: EncodePlan, work: Path | None, progress: Progress | None
) -> Basis:
    """N eigen textures, filled, and the cameras' weights, of the maps' deviations from the mean.

    Unseen texels deviate by nothing, which is equation 2 without filling any map.
    """
    options = plan.options
    gram = gram_matrix(maps, mean, progress)  # of X, equations 3 to 5
    _warn_of_disagreement(maps, mean, gram, plan)
    vectors = eigenvectors(gram)  # equation 6
    if options.uv_ssim is None:
        count = component_count(resolved_value(options.textures), maps.count)
    else:
        average = spreader(mean.values)
        count = smallest_count(maps, mean, average, vectors, options.uv_ssim, work=work, progress=progress)
    weights = weights_of(vectors, count)
    compact = eigen_textures(maps, mean, weights, progress)
    pictures = np.zeros((count, maps.atlas.height, maps.atlas.width, maps.channels), np.float32)
    for index in range(count):
        pictures[index] = spreader(compact[index])
    ones, zeros = np.ones((count, maps.channels), np.float32), np.zeros((count, maps.channels), np.float32)
    return Basis(pictures, ones, zeros, weights)


def _warn_of_disagreement(maps: TextureMaps, mean: Mean, gram: NDArray[np.float64], plan: EncodePlan) -> None:
    """`warn_of_disagreement` of texture maps: the diagonal of their Gram matrix holds the squared deviations."""
    views, seen = plan.views, np.array([int(np.count_nonzero(row)) for row in maps.seen])
    names, places = views.observation_names, views.coordinates[views.taken_by]
    squares = np.diag(gram)
    count, values = mean.count.astype(np.float64)[:, None], mean.values.astype(np.float64)
    centre = (count * values).sum(axis=0) / max(float(count.sum()), 1.0)
    total = float((count * (values - centre) ** 2).sum()) + float(squares.sum())
    warn_of_disagreement(squares, seen, maps.channels, total, names, places, aligned=bool(plan.options.align))


def write_maps(
    maps: TextureMaps,
    mean: NDArray[np.float32],
    spreader: Spreader,
    names: Sequence[str],
    folder: Path,
    progress: Progress | None = None,
) -> None:
    """Write `NAME.map.png` (filled by equation 2, gutters dilated) and `NAME.seen.png` for every observation, and
    `mean.png`. Existing files of these names are replaced; each is whole or absent.

    Args:
        maps: Of No observations.
        mean: (n, C) at the chart texels.
        names: Of the observations, each once.
        folder: Is made if it does not exist.
    """
    make_folder(folder)

    flat = [name.replace("/", "_").replace("\\", "_") for name in names]
    stems = [Path(name).stem for name in flat]
    labels = stems if len(set(stems)) == len(stems) else flat

    def write(index: int) -> None:
        seen = np.array(maps.seen[index])
        stem = labels[index]
        filled = spreader(np.where(seen[:, None] > 0, maps.values[index], mean))
        visibility = maps.atlas.image(seen[:, None].astype(np.float32))
        write_bytes(folder / f"{stem}.map.png", png_bytes(filled), overwrite=True)
        write_bytes(folder / f"{stem}.seen.png", png_bytes(visibility), overwrite=True)

    write_bytes(folder / "mean.png", png_bytes(spreader(mean)), overwrite=True)
    tracked_map(write, range(maps.count), "maps as pictures", progress)
