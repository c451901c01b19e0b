"""The still surface of footage with a moving sheet before it, from the photographs of all frames.

Sheet 0 is the relief that stands still, and sheet 1 one height field over the same view for all that moves: its depth
and its opacity are those of each frame. What moves and is hidden from that view has no place in it.
"""

from __future__ import annotations

import hashlib
import logging
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.capture import LightField
from eigenfield.core.progress import Progress, begin_step, track
from eigenfield.core.proxy import MovingProxy, Proxy, Sheets
from eigenfield.encoding.clip.digest import footage_digest
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.relief.moving_sheet import MovingSheet, SheetGrid, sheet_grid
from eigenfield.reconstruction.frame import read_pictures, resized_cameras, shown_pixels
from eigenfield.reconstruction.whole import Reconstruction
from eigenfield.runtime.files import read_arrays
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.change import changed_pixels
from eigenfield.stereo.moving import MovingDepth, StillDepth, find_moving

if TYPE_CHECKING:
    from eigenfield.capture.footage import Footage

log = logging.getLogger("eigenfield.encode")

MAX_SETTLED_FRAMES = 16  # that are looked at for what stands still
MOVING_MIN_FRACTION = 0.001  # of the reference view that must move in some frame
MOVING_MIN_OPACITY = 0.05  # of a pixel that moves
HELD_STEPS = 0.25  # of a label: a vertex that moves less stays where it was
FRAME_STAGE = "moving-{:05d}"
ARRAYS_FILE, OPACITY_FILE, LABELS_FILE = "arrays.npz", "opacity.npy", "labels.npy"


@dataclass(frozen=True, eq=False)
class _Frames:
    """Footage beside what stands still before its cameras.

    Attributes:
        pictures: (V, H, W, 3) photographs of what stands still.
        known: (V, H, W) where they show it; None: everywhere.
        key: Digest of all that stages depend on.
    """

    footage: Footage
    still: StillDepth
    pictures: NDArray[np.uint8]
    known: NDArray[np.bool_] | None
    stages: Stages
    key: str

    @staticmethod
    def of(footage: Footage, made: Reconstruction, reference: ReferenceView, stages: Stages) -> _Frames:
        mesh, cameras = made.proxy.mesh, resized_cameras(made.light_field)
        pictures, known = read_pictures(made.light_field), shown_pixels(made.light_field)
        inverse = rasterise_view(mesh, reference.camera).inverse_depth
        nearest = distance_transform_edt(inverse == 0, return_distances=False, return_indices=True)
        d = ((inverse[tuple(nearest)] - reference.offset) / reference.scale).astype(np.float32)
        digest = hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes())
        for camera in (reference.camera, *cameras):
            digest.update(camera.matrix.tobytes())
        key = stage_key([footage_digest(footage), digest.hexdigest()], SCENE_ROOMS)
        still = StillDepth.of(view_matrices(reference, cameras), d)
        return _Frames(footage, still, pictures, known, stages, key)

    def changed(self, pictures: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """(V, H, W) where photographs of a frame do not show what stands still."""
        found = np.stack(parallel_map(lambda v: changed_pixels(pictures[v], self.pictures[v]), range(len(pictures))))
        return found if self.known is None else found | ~self.known

    def unsettled(self, progress: Progress | None) -> NDArray[np.bool_]:
        """(V, H, W) where what stands still is not seen in most frames, so that it says nothing about the others."""

        def build(folder: Path) -> None:
            numbers = np.unique(np.linspace(0, len(self.footage) - 1, MAX_SETTLED_FRAMES).round().astype(int)).tolist()
            count = np.zeros(self.pictures.shape[:3], np.uint8)
            for number in track(numbers, "what stands still", len(numbers), progress):
                count += self.changed(read_pictures(self.instant(number)))
            np.savez(folder / ARRAYS_FILE, unsettled=np.packbits(2 * count.astype(np.int16) > len(numbers)))

        folder = self.stages.run("settled", self.key, build)
        shape = self.pictures.shape[:3]
        return np.unpackbits(read_arrays(folder / ARRAYS_FILE)["unsettled"], count=math.prod(shape)).reshape(shape) > 0

    def instant(self, number: int) -> LightField:
        """The photographs of a frame."""
        return cast("LightField", self.footage.instant(number))

    def depths(self, progress: Progress | None) -> list[Path]:
        """The stages of what moves in each frame. Those of an earlier run are taken up."""
        folders: list[Path] = []
        while len(folders) < len(self.footage) and (
            found := self.stages.find(FRAME_STAGE.format(len(folders)), self.key)
        ):
            folders.append(found)
        rest = range(len(folders), len(self.footage))
        if not rest:
            return folders
        unsettled = self.unsettled(progress)

        def build(folder: Path) -> None:
            instant = self.instant(len(folders))
            pictures, shown = read_pictures(instant), shown_pixels(instant)
            before = next(moving_depths(folders[-1:]), None)
            found = find_moving(pictures, self.changed(pictures) | unsettled, self.still, before, shown)
            opacity, texture = (to_codes(one) for one in (found.opacity, found.texture / 255))
            np.savez(folder / ARRAYS_FILE, d=found.d, opacity=opacity, texture=texture)

        numbers = track(rest, "depth of what moves", len(rest), progress)
        folders.extend(self.stages.run(FRAME_STAGE.format(number), self.key, build) for number in numbers)
        return folders


def moving_depths(folders: Sequence[Path]) -> Iterator[MovingDepth]:
    """What moves in each frame, from their stages, one frame in memory at a time."""
    for folder in folders:
        found = read_arrays(folder / ARRAYS_FILE)
        opacity, texture = (found[name].astype(np.float32) for name in ("opacity", "texture"))
        yield MovingDepth(found["d"], opacity / np.float32(255), texture)


def moving_proxy(
    footage: Footage, made: Reconstruction, stages: Stages, progress: Progress | None = None
) -> MovingProxy | None:
    """The still surface with a moving sheet before it; None where that does not pay, and a line says why.

    One frame is in memory at a time, and each is a finished stage.

    Args:
        footage: With the cameras of `made`, in the same order.
        made: From the photographs of what stands still.
        stages: Where frames are kept. The opacity is read from there as it is asked for.

    Raises:
        CaptureError: A frame cannot be read.
        OutputError: The folder cannot be written.
    """
    reference = made.reference
    if reference is None:
        log.info("moving sheet: none, since the surface is no relief before cameras that look one way")
        return None
    begin_step(progress, "moving sheet")
    frames = _Frames.of(footage, made, reference, stages)
    folders = frames.depths(progress)
    seen = np.zeros(reference.shape, np.float32)
    for depth in moving_depths(folders):
        np.maximum(seen, depth.opacity, out=seen)
    share = float((seen > MOVING_MIN_OPACITY).mean())
    if share < MOVING_MIN_FRACTION:
        log.info("moving sheet: none, since %.2f %% of the view moves: the still surface is opaque", 100 * share)
        return None
    grid = sheet_grid(seen > MOVING_MIN_OPACITY)
    sheet = MovingSheet.over(reference, made.proxy.mesh, grid)

    def build(folder: Path) -> None:
        labels = _labels_over_time(folders, grid, frames.still)
        np.save(folder / LABELS_FILE, labels)
        shape = len(folders), sheet.side, sheet.side
        opacity = np.lib.format.open_memmap(folder / OPACITY_FILE, "w+", np.float32, shape)
        each = zip(moving_depths(folders), labels, strict=True)
        for number, (depth, own) in enumerate(track(each, "moving sheet", len(folders), progress)):
            opacity[number] = sheet.opacity(own, depth.opacity)
        opacity.flush()

    folder = stages.run("sheet", frames.key, build)
    labels, opacity = np.load(folder / LABELS_FILE), np.load(folder / OPACITY_FILE, mmap_mode="r")
    log.info("moving sheet: %d triangles over %.0f %% of the view", sheet.faces[1], 100 * share)
    mesh = sheet.mesh(labels[0])
    proxy = Proxy(mesh, sheet.lattice(mesh, footage.cameras or ()), Sheets(sheet.faces, np.array(opacity[0])))
    return MovingProxy(proxy, np.stack([sheet.mesh(own).vertices for own in labels]), opacity)


def _labels_over_time(folders: Sequence[Path], grid: SheetGrid, still: StillDepth) -> NDArray[np.float64]:
    """(T, v) labels of the grid's vertices. Before anything is seen near a vertex, it is where it will be seen."""
    low, high = still.labels[0], still.labels[-1]
    z = None
    for depth in moving_depths(folders[::-1]):
        z = np.clip(grid.fit(depth.d, depth.opacity, z), low, high)
    labels = []
    for depth in moving_depths(folders):
        assert z is not None
        new = np.clip(grid.fit(depth.d, depth.opacity, z), low, high)
        z = np.where(np.abs(new - z) > HELD_STEPS * still.step, new, z)
        labels.append(z)
    return np.stack(labels)
