"""What is decided once for all frames of a clip: cameras, mesh, atlas, how dense each plane is, and footprints."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.video.film_layout import PlaneSizes, film_layout
from eigenfield.core.camera import Camera
from eigenfield.core.films import FilmLayout
from eigenfield.core.observations import CalibratedObservations, Observations, select_cameras
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.clip.active import ActivePlane, Texels, active_texels, open_active_plane
from eigenfield.encoding.clip.motion import MovingMesh
from eigenfield.encoding.clip.rest import CameraAtRest
from eigenfield.encoding.fitted.fit import PlaneSettings
from eigenfield.encoding.fitted.footprints import (
    Footprints,
    offsets_of,
    open_footprints,
    sample_corner,
    subsampled_footprints,
)
from eigenfield.encoding.fitted.model import AtlasComposer, Rectangle, make_composer
from eigenfield.encoding.fitted.observations import (
    DecodedObservations,
    FitData,
    decode_observations,
    open_camera_footprints,
    open_subsampled,
    with_robust_weights,
)
from eigenfield.encoding.fitted.planes import PLANE_PRESETS, PlanePreset, fitted_textures, step_of
from eigenfield.encoding.fitted.rate import Rate
from eigenfield.encoding.fitted.solve import Scales, measure_scales
from eigenfield.encoding.options import DEFAULT_PRESET, PRESETS, SUBSAMPLE_MIN_OBSERVATIONS
from eigenfield.encoding.plan import EncodePlan, component_count
from eigenfield.encoding.views import nothing_seen_error
from eigenfield.rendering.software.drawing import make_surface
from eigenfield.runtime.files import scratch_array, scratch_arrays
from eigenfield.runtime.scratch_cache import ScratchCache, open_scratch_cache

MAX_TEXTURES = 12  # of luma, unless more are asked for: players sum all of them for each frame
OpenActive = Callable[[int, Footprints, Footprints], contextlib.AbstractContextManager[tuple[ActivePlane, ...]]]
CACHE_MAX_BYTES = 4 << 30  # of scratch files, for what passes over frames of moving meshes need again
THINNED_STEP = 2  # pixels, each way, to one that weights are fitted to: all frames of a group have a part in them


@dataclass(frozen=True, eq=False)
class ClipPlane:
    """One plane of all frames.

    Attributes:
        scales: Of frames without masks, on the mesh that all frames have, or the first one has.
        moves: Whether the mesh moves.
    """

    preset: PlanePreset
    settings: PlaneSettings
    rate: Rate
    scales: Scales
    composer: AtlasComposer
    moves: bool = False

    @property
    def rectangle(self) -> Rectangle:
        """All of the components' grid."""
        rows, columns = self.settings.grid
        return 0, rows, 0, columns

    @contextlib.contextmanager
    def open_scales(self, data: FitData, work: Path | None) -> Iterator[tuple[Scales]]:
        """Of a frame, in scratch files."""
        found = _scales(data, self.settings)
        with contextlib.ExitStack() as opened:

            def put(values: NDArray[np.float32]) -> NDArray[np.float32]:
                room = opened.enter_context(scratch_array(values.shape, np.float32, work))
                room[:] = values
                return np.asarray(room)

            mean, coarse = put(found.mean), put(found.coarse)
            noise = (put(found.mean_noise), put(found.coarse_noise)) if found.soft else (mean, coarse)
            yield (replace(found, mean=mean, coarse=coarse, mean_noise=noise[0], coarse_noise=noise[1]),)


@dataclass(frozen=True, eq=False)
class FramePixels:
    """The photographs of a frame.

    Attributes:
        number: Of the frame, in the clip.
        every: All their pixels.
        thinned: Every THINNED_STEP-th.
        few, cache: As in `ClipPlan`.
        opened: Closes what is opened for the frame.
        active: The part of each plane that changes within the group; None: all is fitted.
    """

    number: int
    every: FitData
    thinned: FitData
    few: bool
    work: Path | None
    cache: ScratchCache
    opened: contextlib.ExitStack
    active: tuple[ActivePlane, ...] | None

    def fitted(self, plane: ClipPlane) -> FitData:
        """What mean and textures of a plane are fitted to."""
        return self.thinned if plane.preset.subsampled and not self.few else self.every

    def scales(self, plane: ClipPlane) -> Scales:
        """Those of a plane in what it is fitted to."""
        data, key = self.fitted(plane), ("scales", self.number, plane.preset.name)
        if data.observations.masks is None and not plane.moves:
            return plane.scales
        (found,) = self.opened.enter_context(self.cache.open(key, lambda: plane.open_scales(data, self.work)))
        return found

    def weighed(self, data: FitData, variance: float | None) -> contextlib.AbstractContextManager[FitData]:
        """The data, whose pixels count for less where few cameras see them and they are off by far more than a
        variance, once a residual is drawn with it."""
        robust = self.few and variance is not None
        return with_robust_weights(data, self.work) if robust else contextlib.nullcontext(data)


@dataclass(frozen=True, eq=False)
class KeptPhotographs:
    """The photographs of a group as 8-bit codes, each frame's decoded when it is first asked for.

    Attributes:
        codes: From the place of a frame in the group to its array, see `decode_observations`.
        masks: Likewise.
        masked: By place of what is decoded, whether some of its pixels do not count.
    """

    cameras: Sequence[Camera]
    codes: Callable[[int], NDArray[np.uint8]]
    masks: Callable[[int], NDArray[np.uint8]]
    masked: dict[int, bool] = field(default_factory=dict)

    def frame(self, place: int, observations: Callable[[], Observations]) -> DecodedObservations:
        """A frame, decoded.

        Args:
            observations: Its photographs, a camera each; asked for once.
        """
        codes, masks = self.codes(place), self.masks(place)
        if place not in self.masked:
            decoded = decode_observations(self.cameras, observations(), codes, masks)
            self.masked[place] = decoded.masks is not None
            return decoded
        return _of_cameras(self.cameras, codes, masks if self.masked[place] else None)


@dataclass(frozen=True, eq=False)
class ClipPlan:
    """A plan of one instant, and what all frames share.

    Attributes:
        few: Whether there are so few cameras that pixels that are far off count for less (`with_robust_weights`).
        footprints: On the plan's mesh.
        thinned: The footprints of every THINNED_STEP-th pixel.
        work: Folder for scratch files.
        moving: The mesh at each frame; None: it stands still.
        opacity: From the number of a frame to that of its sheets, as a file has it; None: there are none, or it is not
            coded yet.
        cache: Of what passes need again of each frame.
    """

    plan: EncodePlan
    planes: tuple[ClipPlane, ...]
    few: bool
    footprints: Footprints
    thinned: Footprints
    work: Path | None
    moving: MovingMesh | None = None
    opacity: Callable[[int], NDArray[np.float32]] | None = None
    cache: ScratchCache = field(default_factory=lambda: ScratchCache(0))

    @property
    def cameras(self) -> Sequence[Camera]:
        """Those that are encoded."""
        return self.plan.views.rig.encoded_cameras

    def observations(self, instant: CalibratedObservations) -> Observations:
        """The photographs of the encoded cameras at an instant."""
        return select_cameras(instant, self.plan.views.rig.encoded.tolist())

    def with_textures(self, counts: Sequence[int]) -> ClipPlan:
        """The same with so many eigen textures of each plane."""
        pairs = zip(self.planes, counts, strict=True)
        planes = tuple(replace(one, settings=replace(one.settings, textures=count)) for one, count in pairs)
        return replace(self, planes=planes)

    def at_quality(self, quality: int) -> ClipPlan:
        """The same coded at another quality, 0 to 100."""
        planes = [replace(one, rate=one.preset.rate(step_of(quality))) for one in self.planes]
        return replace(self, planes=tuple(planes))

    def layout(self, counts: Sequence[int]) -> FilmLayout:
        """Where so many eigen textures of each plane, its mean and the opacity of sheets lie in films. OptionError
        `film-size`."""
        pairs = zip((one.settings for one in self.planes), counts, strict=True)
        planes = [PlaneSizes(len(one.matrix), one.mean, ((one.grid, count),)) for one, count in pairs]
        return film_layout(planes, None if self.moving is None else self.moving.opacity_size)

    @contextlib.contextmanager
    def open_footprints(self, number: int) -> Iterator[tuple[Footprints, Footprints]]:
        """Those of a frame of the clip, and of every THINNED_STEP-th pixel."""
        if self.moving is None:
            yield self.footprints, self.thinned
            return
        with self.cache.open(("footprints", number), lambda: self._open_moving(number)) as found:
            yield found

    @contextlib.contextmanager
    def _open_moving(self, number: int) -> Iterator[tuple[Footprints, Footprints]]:
        """`open_footprints` on a mesh that moves."""
        assert self.moving is not None
        proxy = self.moving.proxy(number, None if self.opacity is None else self.opacity(number))
        with (
            self.open_on_proxy(proxy, self.footprints.surface.size) as every,
            subsampled_footprints(every, THINNED_STEP, self.work) as thinned,
        ):
            yield every, thinned

    @contextlib.contextmanager
    def caching(self) -> Iterator[ClipPlan]:
        """The same, which keeps what passes need again of each frame, as long as there is room."""
        with open_scratch_cache(CACHE_MAX_BYTES, self.work) as cache:
            yield replace(self, cache=cache)

    def open_on_proxy(self, proxy: Proxy, size: tuple[int, int]) -> contextlib.AbstractContextManager[Footprints]:
        """The footprints on another proxy under an atlas of (rows, columns)."""
        surface = make_surface(proxy.mesh, *size)
        return open_footprints(surface, self.cameras, self.footprints.detail, proxy.sheets, self.work)

    @contextlib.contextmanager
    def open_active(self, rest: Path, numbers: range) -> Iterator[OpenActive]:
        """A function from a frame, its footprints and the thinned ones to the part of each plane that changes within a
        group.

        Args:
            rest: The stage of what stands still.
            numbers: Of the group's frames.
        """

        def moves(camera: int) -> NDArray[np.bool_]:
            return np.asarray(CameraAtRest.load(rest, camera).share < 255)

        def thinned_moves(camera: int) -> NDArray[np.bool_]:
            return moves(camera)[sample_corner(camera, THINNED_STEP)]

        fewer = [plane.preset.subsampled and not self.few for plane in self.planes]
        changing: list[Texels] = []
        for number in numbers if self.moving is not None else numbers[:1]:
            with self.open_footprints(number) as (every, thinned):
                now = [active_texels(thinned if few else every, plane.settings, thinned_moves if few else moves)
                       for plane, few in zip(self.planes, fewer, strict=True)]  # fmt: skip
            before = changing or now
            changing = [(a[0] | b[0], a[1] | b[1]) for a, b in zip(before, now, strict=True)]

        @contextlib.contextmanager
        def open_planes(every: Footprints, thinned: Footprints) -> Iterator[tuple[ActivePlane, ...]]:
            with contextlib.ExitStack() as kept:
                yield tuple(
                    kept.enter_context(open_active_plane(
                        thinned if few else every, texels, thinned_moves if few else moves, self.work
                    )) for texels, few in zip(changing, fewer, strict=True)
                )  # fmt: skip

        if self.moving is not None:
            yield lambda number, every, thinned: self.cache.open(
                ("active", number), lambda: open_planes(every, thinned)
            )
        else:
            with open_planes(self.footprints, self.thinned) as planes:
                yield lambda number, every, thinned: contextlib.nullcontext(planes)

    @contextlib.contextmanager
    def open_photographs(self, frames: int) -> Iterator[KeptPhotographs]:
        """Room for the photographs of a group of frames, in scratch files of 4 bytes a pixel."""
        pixels = int(self.footprints.pixel_offsets[-1])
        with (
            scratch_arrays(frames, (pixels, 3), np.uint8, self.work) as codes,
            scratch_arrays(frames, (pixels,), np.uint8, self.work) as masks,
        ):
            yield KeptPhotographs(self.cameras, codes, masks)

    @contextlib.contextmanager
    def open_frame(
        self, number: int, photographs: DecodedObservations, active: OpenActive | None = None
    ) -> Iterator[FramePixels]:
        """The pixels of a frame of the clip.

        Args:
            active: Of `open_active`; None: all is fitted.
        """
        with contextlib.ExitStack() as opened:
            every, thinned = opened.enter_context(self.open_footprints(number))
            data, changing = FitData(photographs, every), None
            some = opened.enter_context(open_subsampled(data, THINNED_STEP, self.work, thinned))
            if active is not None:
                changing = opened.enter_context(active(number, every, thinned))
            yield FramePixels(number, data, some, self.few, self.work, self.cache, opened, changing)


@contextlib.contextmanager
def open_clip_plan(
    plan: EncodePlan, work: Path | None = None, moving: MovingMesh | None = None, density: float | None = None
) -> Iterator[ClipPlan]:
    """The plan of a clip, or of frames in a row whose meshes have the same triangles.

    Args:
        plan: For a fit, of one of the instants.
        moving: The mesh at each frame; None: it stands still.
        density: By which textures are sized, which is the same for all of a clip; None: that of the plan.

    Raises:
        CaptureError: `nothing-seen`, no camera covers a pixel.
    """
    views, options, size = plan.views, plan.options, (plan.atlas[1], plan.atlas[0])
    cameras, count = views.rig.encoded_cameras, len(views.rig.encoded)
    asked = min(fitted_textures(count), MAX_TEXTURES) if options.textures is None else options.textures
    quality = PRESETS[DEFAULT_PRESET].quality if options.quality is None else options.quality  # without a fit
    textures, step = component_count(asked, count), step_of(quality)
    with (
        open_camera_footprints(cameras, plan.proxy, size, work, views.rig.encoded_reference) as footprints,
        subsampled_footprints(footprints, THINNED_STEP, work) as thinned,
    ):
        whole = FitData(_of_cameras(cameras, np.zeros((0, 3), np.uint8), None), footprints)  # all count, none is known

        def plane_of(preset: PlanePreset) -> ClipPlane:
            settings = preset.settings(size, density or plan.density, textures, views.scattered)
            settings = replace(settings, textures=max(1, min(settings.textures, count - 1)), local=0)
            composer = make_composer(footprints.surface, settings.grey_model())
            rate, scales = preset.rate(step), _scales(whole, settings)
            return ClipPlane(preset, settings, rate, scales, composer, moving is not None)

        planes = tuple(map(plane_of, PLANE_PRESETS))
        if not planes[0].scales.mean.any():
            raise nothing_seen_error()
        yield ClipPlan(plan, planes, count < SUBSAMPLE_MIN_OBSERVATIONS, footprints, thinned, work, moving)


def _of_cameras(
    cameras: Sequence[Camera], codes: NDArray[np.uint8], masks: NDArray[np.uint8] | None
) -> DecodedObservations:
    shapes = tuple((camera.height, camera.width) for camera in cameras)
    return DecodedObservations(np.arange(len(cameras)), shapes, codes, offsets_of([h * w for h, w in shapes]), masks)


def _scales(data: FitData, settings: PlaneSettings) -> Scales:
    scales = measure_scales(data, settings.grey_model())
    return scales.for_scattered_cameras() if settings.scattered else scales
