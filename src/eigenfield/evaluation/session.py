"""A scene beside its photographs: the scores of one camera."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import LightField, Photograph, match_photographs
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.scene import Scene
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.atlas import Atlas, make_atlas
from eigenfield.encoding.options import DEFAULT_MAX_ANGLE
from eigenfield.encoding.projected.align import align_map
from eigenfield.encoding.projected.harmonise import harmonised_map
from eigenfield.encoding.projected.project import RESAMPLING, texture_map
from eigenfield.encoding.residual.views import captured_samples, corrected_picture
from eigenfield.evaluation.exclusion import ExcludedCircle
from eigenfield.evaluation.image import ImageScores, measure_outside, measure_picture
from eigenfield.evaluation.uv import MapScores, measure_map
from eigenfield.rendering import Picture, Renderer, camera_colour, camera_weights

log = logging.getLogger("eigenfield.evaluation")

PictureScores = tuple[ImageScores, ImageScores | None]  # of all of a picture, and outside its circle

PNG_MAP_CHOICES = CURVE_CHOICES = ("all", "sample", "none")
EVALUATION_SAMPLE_CAMERAS = 16  # of "sample"


@dataclass(frozen=True, eq=False)
class CameraScores:
    """The scores of one camera.

    Attributes:
        texture: Of the texture map; None if it is not measured, or the camera is held out.
        residual: Of the picture with its residual; None without one.
    """

    drawn: PictureScores
    texture: MapScores | None
    residual: PictureScores | None


@dataclass(frozen=True, eq=False)
class Session:
    """A scene beside its photographs, ready to be measured; shared by all threads.

    Attributes:
        photographs: From the index of a scene's camera to the index of its view in the capture.
        counts: Numbers of eigen textures for the UV scores, increasing; pictures are drawn with the last.
        curved: Indices of the cameras that are measured with all of `counts`; others are with the last only.
        atlas: Of the texture maps; None if none are measured.
        max_angle: Of the texture maps, degrees (`EncodeOptions`).
        reference: The texture map and visibility that maps are aligned to; None: they are not aligned.
        circles: Excluded circles by camera, if any.
        packed: Indices of cameras whose filled maps are packed as PNG.
    """

    scene: Scene
    capture: LightField
    photographs: Mapping[int, int]
    renderer: Renderer
    counts: Sequence[int]
    curved: frozenset[int]
    filter: str
    weights: str
    atlas: Atlas | None
    max_angle: int
    reference: tuple[NDArray[np.float32], NDArray[np.uint8]] | None
    circles: Mapping[str, ExcludedCircle] | None
    packed: frozenset[int]
    flip: bool

    def photograph(self, index: int) -> Photograph:
        """A camera's photograph.

        Raises:
            CaptureError: `photograph-size`: it does not have the camera's size.
        """
        view, camera = self.capture.views[self.photographs[index]], self.scene.rig.cameras[index]
        picture = self.capture.photograph(self.photographs[index])
        height, width = picture.pixels.shape[:2]
        if (width, height) != (camera.width, camera.height):
            raise CaptureError(
                "photograph-size",
                f"is {width}x{height}, the scene's camera of that name {camera.width}x{camera.height}",
                path=view.path,
                remedy="evaluate with the photographs that were encoded",
            )
        return picture

    def picture(self, index: int, samples: int | None = None) -> Picture:
        """The picture drawn from a camera.

        A harmonised scene gives an encoded camera its own exposure, and a held-out one what those around it have.

        Args:
            samples: Samples a pixel. Default: the renderer's.
        """
        return self.renderer.draw(
            self.scene.rig.cameras[index],
            camera_weights(self.scene, index, self.weights),
            filter=self.filter,
            textures=self.counts[-1],
            samples=samples,
            colour=camera_colour(self.scene, index),
        )

    def texture(self, index: int, photograph: Photograph) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """A camera's texture map as `encode` made it: (n, 3) values and (n,) visibility."""
        assert self.atlas is not None
        values, seen = texture_map(
            self.atlas, self.scene.rig.cameras[index], photograph.pixels, photograph.mask, self.max_angle
        )
        colours = self.scene.appearance.colours
        if colours is not None:
            values = harmonised_map(values, seen, colours[index])
        if self.reference is None or index == self.scene.rig.reference:
            return values, seen
        return align_map(self.atlas, values, seen, *self.reference)

    @property
    def measures_residual(self) -> bool:
        """Whether captured views are measured with their residual too.

        The residual is the difference to the whole scene, drawn with all textures and the bicubic filter.
        """
        whole = self.counts[-1] == self.scene.appearance.textures and self.filter == "bicubic"
        return whole and self.scene.residual is not None

    def measure(self, index: int, difference: NDArray[np.float32] | None = None) -> CameraScores:
        """All scores of one camera.

        Args:
            difference: (H, W, 3) its residual, if any.
        """
        photograph = self.photograph(index)
        drawn = self.picture(index)
        residual = None
        if difference is not None:
            samples = captured_samples(self.scene, index)
            belongs = drawn if samples is None else self.picture(index, samples)
            residual = self._scores_of(index, corrected_picture(belongs, difference), photograph)
        texture = None
        if self.atlas is not None and not self.scene.rig.held_out[index]:
            values, seen = self.texture(index, photograph)
            row = int(self.scene.rows(index))
            counts = self.counts if index in self.curved else self.counts[-1:]
            texture = measure_map(
                self.scene.appearance.planes[0], row, self.atlas, values, seen, counts, index in self.packed
            )
        return CameraScores(self._scores_of(index, drawn, photograph), texture, residual)

    def _scores_of(self, index: int, drawn: Picture, photograph: Photograph) -> PictureScores:
        """Of the whole picture, and of the part outside its circle if there are circles."""
        given = drawn.image, drawn.covered, photograph.pixels, photograph.mask
        scores = measure_picture(*given, self.flip)
        if self.circles is None:
            return scores, None
        return scores, measure_outside(*given, self.circles.get(self.scene.rig.names[index]), self.flip)


def start_session(
    scene: Scene,
    capture: LightField,
    *,
    curve: str = "none",
    textures: int | None = None,
    filter: str = "bicubic",
    weights: str = "delaunay",
    circles: Mapping[str, ExcludedCircle] | None = None,
    png_maps: str = "none",
    flip: bool = False,
) -> Session:
    """Check that scene and photographs belong together, and prepare what all cameras share.

    Arguments and errors are those of `evaluate`."""
    if png_maps not in PNG_MAP_CHOICES:
        raise OptionError(
            "png-maps", f"no way to count maps is called {png_maps}", remedy=f"use {', '.join(PNG_MAP_CHOICES)}"
        )
    if curve not in CURVE_CHOICES:
        raise OptionError(
            "curve", f"no cameras of a curve are called {curve}", remedy=f"use {', '.join(CURVE_CHOICES)}"
        )
    if scene.appearance.channels != 3:
        raise OptionError(
            "not-photographs",
            f"the scene is not of photographs: it has {scene.appearance.channels} channels, not R, G, B",
            remedy="evaluate those that are",
        )
    photographs = match_photographs(scene, capture)
    align, max_angle = _map_settings(scene)
    one_plane = len(scene.appearance.planes) == 1 and scene.appearance.to_rgb is None
    maps = one_plane and not scene.provenance.is_fitted  # a fit makes none
    if curve != "none" and not maps:
        raise OptionError(
            "curve",
            "the scene was fitted to pictures and has no texture maps to measure",
            remedy="leave --curve out, or encode with --fit none",
        )
    encoded = [int(index) for index in scene.rig.encoded if int(index) in photographs] if maps else []
    if align and scene.rig.reference not in photographs:
        log.warning(
            "%s, the reference of the alignment, is missing: no UV measure", scene.rig.names[scene.rig.reference]
        )
        encoded = []
    height, width = scene.appearance.atlas
    some = {"all": encoded, "sample": sample_evenly(encoded, EVALUATION_SAMPLE_CAMERAS), "none": []}
    count = scene.appearance.textures if textures is None else textures
    if not 0 <= count <= scene.appearance.textures:
        raise OptionError(
            "textures",
            f"{count} textures were asked for, the scene has {scene.appearance.textures}",
            remedy=f"ask for 0 to {scene.appearance.textures}",
        )
    session = Session(
        scene=scene,
        capture=capture,
        photographs=photographs,
        renderer=Renderer(scene),
        counts=(count,) if curve == "none" else tuple(range(count + 1)),
        curved=frozenset(some[curve]),
        filter=filter,
        weights=weights,
        atlas=make_atlas(scene.proxy.mesh, width, height) if encoded else None,
        max_angle=max_angle,
        reference=None,
        circles=circles,
        packed=frozenset(some[png_maps]),
        flip=flip,
    )
    if align and encoded:
        reference = session.texture(scene.rig.reference, session.photograph(scene.rig.reference))
        session = replace(session, reference=reference)
    return session


def _map_settings(scene: Scene) -> tuple[bool, int]:
    """Whether the texture maps were aligned, and their `max_angle`, by the scene's settings."""
    provenance = scene.provenance
    resampling = RESAMPLING if provenance.resampling is None else provenance.resampling
    max_angle = DEFAULT_MAX_ANGLE if provenance.max_angle is None else provenance.max_angle
    known = resampling == RESAMPLING and provenance.align in [None, "dis"]
    if not (known and isinstance(max_angle, int) and 1 <= max_angle <= 90):
        raise OptionError(
            "settings-unknown",
            f"the scene was made with resampling {resampling!r}, alignment {provenance.align!r} and angles up to "
            f"{max_angle!r}, which this version has not",
            remedy="evaluate with the version that encoded it",
        )
    return provenance.align is not None, max_angle


def sample_evenly(indices: Sequence[int], count: int) -> list[int]:
    """At most `count` of the indices, evenly spread."""
    return [indices[i] for i in spread_indices(len(indices), count)]
