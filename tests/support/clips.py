"""Small clips whose frame n shows n, for the tests of files and of the web viewer.

The upper half of the mean has n as black and white blocks, the lowest bit on the left. Below, the atlas has a column
for each eigen texture, and of frame n the texture n modulo their number alone is not zero, there and nowhere else: that
column differs in the last camera from its ground by the group's strength. Groups take turns in strengths, weights and
scales, so that no frame looks right with what another group has.

With sheets there is a second one before the lower rim of the first, white before black. It has the blocks of n by its
opacity: all that can be seen of it is what is 1 there.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.coding.mesh.coder import decode_placed
from eigenfield.coding.video.film import encode_film
from eigenfield.coding.video.film_layout import EMPTY_CODE, MEANS, TEXTURES, PlaneSizes, film_layout, join_parts
from eigenfield.core.clip import Clip, Timeline
from eigenfield.core.films import CodedGroup, FilmLayout
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Affine, Payload
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.encoding.geometry.coded import coded_cameras, coded_mesh
from eigenfield.gltf import coded_clip, load_clip
from eigenfield.gltf.clips import CodedGroups, StoredGroup
from eigenfield.gltf.group import group_bytes
from eigenfield.gltf.source import HeldBytes
from support import glb_surgery
from support.scenes import bumpy_square, tiny_scene

BITS = 8  # of a frame's number
TEXTURES_COUNT = 4
LUMA, CHROMA, BASIS = (128, 128), (64, 64), (128, 128)
OPACITY = 64, 128
OPAQUE = 1023  # code
RIM, FRONT = 0.78, 0.875  # rows of the atlas: of those of the first sheet from which on it is black, and of the second
FRONT_MIDDLE = 0.94  # row of the atlas, at which the second sheet is read
TO_RGB = np.array([[1, 0, 1.5748], [1, -0.187324, -0.468124], [1, 1.8556, 0]], np.float32)
BLACK, WHITE, GREY, CONTRAST = 160, 930, 512, 590  # codes, within those that encoders use
TEXTURE_SCALE = 0.5 / CONTRAST  # a weight of 1 is half of the range
STRENGTHS = 1.0, -1.0, 0.4, -0.4  # of groups in turn: the product of the next two
WEIGHTS = 1.0, -2.0, 0.4, -0.8  # of the last camera
SCALES = 1.0, 0.5, 1.0, 0.5  # of textures
MEAN_STEPS = 1, 2, 1, 2  # codes that a code of the mean stands for


def numbered_clip(
    lengths: Sequence[int] = (5, 7), rate: Fraction = Fraction(10), cameras: int = 4, first: float = 0.0, crf: int = 8,
    sheets: bool = False,
) -> Clip:  # fmt: skip
    """Luma of `LUMA` with textures, and flat chroma without, in groups of so many frames."""
    plain = tiny_scene(cameras=cameras)
    proxy = two_sheets() if sheets else Proxy(bumpy_square())
    surface = coded_mesh(proxy, plain.rig.cameras, plain.rig.reference)
    views = coded_cameras(plain.rig.cameras, surface.value.mesh, None)
    rig = replace(plain.rig, cameras=views.value)
    planes = [PlaneSizes(1, LUMA, ((BASIS, TEXTURES_COUNT),)), PlaneSizes(2, CHROMA, ())]
    layout = film_layout(planes, OPACITY if sheets else None)
    starts = np.cumsum([0, *lengths])
    groups = [
        group_bytes(numbered_group(layout, index % len(STRENGTHS), range(start, start + count), cameras, crf))
        for index, (start, count) in enumerate(zip(starts[:-1].tolist(), lengths, strict=True))
    ]
    timeline = Timeline(rate, int(starts[-1]), first)
    return coded_clip(
        rig, surface.value.mesh, timeline, layout, groups, list(lengths),
        to_rgb=TO_RGB, settings={"clip": {"group": 0.5}}, scores={}, generator="eigenfield test",
        payloads=surface.payloads | views.payloads,
        sheets=None if surface.value.sheets is None else surface.value.sheets.faces,
    )  # fmt: skip


def two_sheets() -> Proxy:
    """A bumpy square, and before its lower rim a flat strip."""
    square, strip = bumpy_square(), bumpy_square(4)
    assert square.uv is not None and strip.uv is not None
    flat = strip.vertices * np.float32((0.93, 0.1, 0)) + np.float32((0, 0.845, -0.3))
    mesh = Mesh(
        np.concatenate([square.vertices, flat]).astype(np.float32),
        np.concatenate([square.faces, strip.faces + len(square.vertices)]).astype(np.int32),
        np.concatenate([square.uv * (1, FRONT - 0.015), strip.uv * (1, 0.09) + (0, FRONT + 0.02)]).astype(np.float32),
    )
    return Proxy(mesh, sheets=Sheets((len(square.faces), len(strip.faces)), opacity_of(0) / np.float32(OPAQUE)))


def numbered_group(layout: FilmLayout, turn: int, numbers: range, cameras: int, crf: int) -> CodedGroup:
    """The group of the frames with these numbers. turn: of its strength, weights and scales."""
    across = WEIGHTS[turn] * np.linspace(-1, 1, cameras, dtype=np.float32)
    own = np.tile(across[:, None], (1, TEXTURES_COUNT))
    stream, _ = encoder("weights-1")(own, 0.01)
    chroma = np.full((2, *CHROMA), EMPTY_CODE, np.uint16)
    part = layout.opacity
    sheets = part is not None
    frames = [(join_parts(layout, MEANS, [mean_of(n, sheets)[None] // MEAN_STEPS[turn], chroma]) for n in numbers)]
    frames += [(join_parts(layout, TEXTURES, [textures_of(n, sheets)]) for n in numbers)]
    if part is not None:
        frames += [(join_parts(layout, part.film, [opacity_of(n)[None]]) for n in numbers)]
    films = [encode_film(own, size, crf, 8) for own, size in zip(frames, layout.sizes, strict=True)]
    zeros, ones = np.full(TEXTURES_COUNT, float(EMPTY_CODE)), np.full(TEXTURES_COUNT, SCALES[turn] * TEXTURE_SCALE)
    return CodedGroup(
        weights=((Payload("weights-1", stream),), ()),
        means=(
            Affine(np.array([MEAN_STEPS[turn] / 1023]), np.zeros(1)),
            Affine(np.full(2, 1 / 1023), np.full(2, float(EMPTY_CODE))),
        ),
        bases=((Affine(ones, zeros),), ()),
        units=tuple(zip(*films, strict=True)),
    )


def mean_of(number: int, sheets: bool = False) -> NDArray[np.uint16]:
    """(rows, columns) codes of luma."""
    rows, columns = LUMA
    codes = np.full(LUMA, GREY, np.uint16)
    for bit in range(BITS):
        codes[: rows // 2, block(bit, columns)] = WHITE if number >> bit & 1 else BLACK
    if sheets:
        codes[round(RIM * rows) :] = BLACK
        codes[round(FRONT * rows) :] = WHITE
    return codes


def opacity_of(number: int) -> NDArray[np.uint16]:
    """(rows, columns) codes of an opacity."""
    rows, columns = OPACITY
    codes = np.full(OPACITY, OPAQUE, np.uint16)
    for bit in range(BITS):
        codes[round(FRONT * rows) :, block(bit, columns)] = OPAQUE * (number >> bit & 1)
    return codes


def textures_of(number: int, sheets: bool = False) -> NDArray[np.uint16]:
    """(TEXTURES_COUNT, rows, columns) codes of luma."""
    rows, columns = BASIS
    codes = np.full((TEXTURES_COUNT, *BASIS), EMPTY_CODE, np.uint16)
    index, wide = number % TEXTURES_COUNT, columns // TEXTURES_COUNT
    end = round(RIM * rows) if sheets else rows
    codes[index, rows // 2 : end, index * wide : (index + 1) * wide] = EMPTY_CODE + CONTRAST
    return codes


def block(bit: int, columns: int) -> slice:
    return slice(bit * columns // BITS, (bit + 1) * columns // BITS)


def shown_number(luma: NDArray[np.float32]) -> int:
    """The number that the upper half of a mean shows; luma: (rows, columns) in 0..1."""
    rows, columns = luma.shape
    middle = luma[rows // 8 : 3 * rows // 8]
    return sum(int(middle[:, block(bit, columns)].mean() > 0.5) << bit for bit in range(BITS))


def shown_opacity(opacity: NDArray[np.float32]) -> int:
    """The number that the second sheet's part of an opacity shows."""
    rows, columns = opacity.shape
    middle = opacity[round(FRONT * rows) + 2 : -2]
    return sum(int(middle[:, block(bit, columns)].mean() > 0.5) << bit for bit in range(BITS))


def shown_texture(textures: NDArray[np.uint16]) -> int:
    """Which of (N, rows, columns) codes is not zero."""
    (index,) = np.flatnonzero((textures > EMPTY_CODE + CONTRAST // 2).mean(axis=(1, 2)) > 0.02)
    return int(index)


def repeated_clip(clip: Clip, times: int) -> Clip:
    """A clip of coded groups so many times, one after the other."""
    groups = clip.groups
    assert isinstance(groups, CodedGroups)
    made = [StoredGroup(HeldBytes(groups.read(index)), count) for index, count in enumerate(groups.lengths)]
    timeline = replace(clip.timeline, frames=times * clip.timeline.frames)
    return replace(clip, timeline=timeline, groups=replace(groups, stored=made * times))


def groups_of(data: bytes) -> list[bytes]:
    """The bytes of each group of a clip's file."""
    timeline = glb_surgery.split(data)[0]["extensions"][glb_surgery.EXTENSION]["timeline"]
    chunk = glb_surgery.behind(data)[8:]
    return [chunk[one["offset"] : one["offset"] + one["length"]] for one in timeline["groups"]]


def with_groups(data: bytes, groups: Sequence[bytes], gap: int = 0) -> bytes:
    """A clip's file with other groups in the place of its own, whose digests and places are right.

    gap: bytes behind each group, a multiple of 4.
    """
    gltf, binary = glb_surgery.split(data)
    chunk = b""
    for entry, group in zip(gltf["extensions"][glb_surgery.EXTENSION]["timeline"]["groups"], groups, strict=True):
        entry |= {"offset": len(chunk), "length": len(group), "sha256": hashlib.sha256(group).hexdigest()}
        chunk += group + bytes(-len(group) % 4 + gap)
    return glb_surgery.join(gltf, binary, glb_surgery.chunk(b"EFTL", chunk))


def read_all(path: Path) -> None:
    """Decode every frame of a clip's file."""
    clip = load_clip(path)
    for time in clip.timeline.times:
        clip.scene(time)


def finer_mesh(clip: Clip) -> Payload:
    """Another mesh for the groups of a numbered clip: the same square with more vertices."""
    rig = clip.rig
    return coded_mesh(Proxy(bumpy_square(9)), rig.cameras, rig.reference).payloads.only("mesh")


def moving_clip(
    clip: Clip,
    steps: Callable[[int, NDArray[np.int64]], NDArray[np.int64]],
    meshes: Mapping[int, Payload] = MappingProxyType({}),
) -> Clip:
    """A clip of coded groups on a mesh that moves, but in groups in which it is where it was.

    steps: from a frame's number and the lattice coordinates (v, 3) of the mesh to those in that frame.
    meshes: those of groups that have their own.
    """
    groups = clip.groups
    assert isinstance(groups, CodedGroups)
    made, first = [], 0
    for index, count in enumerate(groups.lengths):
        placed = decode_placed(meshes.get(index, groups.payloads.only("mesh")).data)
        frames = np.stack([steps(number, placed.places) for number in range(first, first + count)])
        data = encoder("motion-1")(placed.places, placed.mesh.faces, frames)
        motion = Payload("motion-1", data) if (frames != placed.places).any() else None
        made.append(group_bytes(replace(groups.coded(index), motion=motion, mesh=meshes.get(index))))
        first += count
    return coded_clip(
        clip.rig, groups.mesh, clip.timeline, groups.layout, made, groups.lengths, to_rgb=groups.to_rgb,
        settings=clip.settings, scores=clip.scores, generator=clip.generator, payloads=groups.payloads,
        sheets=groups.sheets,
    )  # fmt: skip
