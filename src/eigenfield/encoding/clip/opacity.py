"""The opacity of sheets in a group: fitted in each frame's photographs, coded as a film, and read back.

What a frame's sheets let through is fitted first, and coded before colours are fitted, so that they make up for what
coding changes. Pixels that stand still must not flicker: texels that no moving pixel sees keep the opacity of the
group's first frame, and later frames are fitted to moving pixels alone.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import MAX_CODE, crf_of
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.clip.active import ALL_COUNT, MIN_SHARE
from eigenfield.encoding.clip.films import CodedFilm, FilmScale, code_film, film_step
from eigenfield.encoding.clip.frames import Arrays, FramePass, GroupFrames, load_arrays
from eigenfield.encoding.clip.rest import CameraAtRest
from eigenfield.encoding.fitted.footprints import Footprints, masked_footprints
from eigenfield.encoding.fitted.kernels import adjoint
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.opacity import opacity_in_rounds
from eigenfield.encoding.fitted.planes import OPACITY_STEP, step_of
from eigenfield.encoding.options import resolved_value

CLIP_OPACITY_ROUNDS = 2  # a frame
OPACITY_STEP_RATIO = 1.0  # of the quantiser step that a film is asked for, to a picture's


@contextlib.contextmanager
def open_coded_opacity(group: GroupFrames) -> Iterator[tuple[GroupFrames, CodedFilm | None]]:
    """The group with the opacity of its frames as decoders find it, and the film that it was coded to; the same group
    and None where it has no sheets.

    Args:
        group: `opened`.
    """
    moving = group.clip.moving
    if moving is None or moving.opacity is None:
        yield group, None
        return
    fitted = group.run_frames("opacity", lambda number, first: _fit(group, number, first))
    film = _code(group, fitted)
    read = group.run_frames(
        "decoded-opacity", lambda number, first, one: {"opacity": one[0][0]}, film.decoded(), fitted
    )
    start = group.numbers.start

    def of_frame(number: int) -> NDArray[np.float32]:
        found: NDArray[np.float32] = load_arrays(read.folders[number - start])["opacity"]
        return found

    yield replace(group, clip=replace(group.clip, opacity=of_frame)), film


def _fit(group: GroupFrames, number: int, first: Path | None) -> Arrays:
    """The opacity of a frame, and the texels of it that moving pixels see.

    Args:
        first: The stage of the group's first frame, which is fitted to all pixels; None: it is this one.
    """
    clip, moving = group.clip, group.clip.moving
    assert moving is not None
    photographs, given = group.photographs(number), moving.given_opacity(number)
    seen, moves = np.zeros(given.shape, np.bool_), [_moves(group, camera) for camera in range(len(clip.cameras))]
    if first is not None and not any(map(np.any, moves)):
        return {"opacity": given, "seen": seen}

    @contextlib.contextmanager
    def open_data(proxy: Proxy) -> Iterator[FitData]:
        with clip.open_on_proxy(proxy, (given.shape[0], given.shape[1])) as every:
            if proxy is start:
                seen[:] = _seen_moving(every, moves)
            if first is None:
                yield FitData(photographs, every)
                return
            with masked_footprints(every, moves.__getitem__, clip.work) as some:
                yield FitData(photographs, some)

    start = moving.proxy(number, given)
    found = opacity_in_rounds(start, open_data, CLIP_OPACITY_ROUNDS)
    assert found.sheets is not None
    return {"opacity": found.sheets.opacity, "seen": seen}


def _moves(group: GroupFrames, camera: int) -> NDArray[np.bool_]:
    """(h, w) which pixels of a camera show anything that moves."""
    one = group.clip.cameras[camera]
    if group.rest is None:
        return np.ones((one.height, one.width), np.bool_)
    return np.asarray(CameraAtRest.load(group.rest, camera).share < 255)


def _seen_moving(footprints: Footprints, moves: Sequence[NDArray[np.bool_]]) -> NDArray[np.bool_]:
    """(H, W) which texels of an opacity, as large as the footprints' atlas, any moving pixel of a camera sees."""
    texels = np.zeros((1, *footprints.surface.size), np.float32)
    for camera, own in enumerate(moves):
        image = own[None].astype(np.float32)
        adjoint(*footprints.of(camera), footprints.surface.size, image, ALL_COUNT, texels)
    return np.asarray(np.abs(texels[0]) > MIN_SHARE)


def _code(group: GroupFrames, fitted: FramePass) -> CodedFilm:
    """The film of opacities, in which what no moving pixel sees is that of the first frame."""
    clip = group.clip
    layout = clip.layout([one.settings.textures for one in clip.planes])  # how many does not matter to its own film
    assert layout.opacity is not None
    still = load_arrays(fitted.folders[0])["opacity"]
    changes = np.any(list(fitted.each("seen")), axis=0)
    step = film_step(OPACITY_STEP * step_of(resolved_value(clip.plan.options.quality)), OPACITY_STEP_RATIO, len(group))
    scale = FilmScale(crf_of(step * MAX_CODE), (1 / MAX_CODE,), (0,), (0, MAX_CODE))
    pictures = ([np.where(changes, own, still)[None]] for own in fitted.each("opacity"))
    return code_film(layout, layout.opacity.film, scale, pictures, group.keeper("film-of-opacity", fitted))
