"""The places of a mesh's vertices over the frames of a group (`motion-1`), in few bytes.

The faces and the texture coordinates are those of the mesh, and places stand on its lattice. The stream says which
vertices move, and where each of these is in each frame (`motion_kernels`). docs/coding.md describes the bytes.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.entropy import range_coder
from eigenfield.coding.mesh.motion_kernels import (
    AGAIN,
    AXES,
    CONTEXTS,
    MAX_NEIGHBOURS,
    MIXTURES,
    MOTION_MAX_STEPS,
    code_motion,
    code_moving,
    motion_cost,
)

VERSION = 1
HEADER = struct.Struct("<BIIH")  # version; vertices, those that move, frames; then a byte of flags for each frame


def encode_motion(places: NDArray[np.int64], faces: NDArray[np.int32], frames: NDArray[np.int64]) -> bytes:
    """The bytes, the same each time.

    Args:
        places: (v, 3) lattice coordinates of the mesh.
        faces: (m, 3) its faces.
        frames: (T, v, 3) lattice coordinates in each frame.

    Raises:
        ValueError: There is no frame, or there are more than the limits allow; or a vertex reaches 2^20 steps from
            the lattice's origin.
    """
    moves = (frames != places).any(axis=(0, 2))
    if not 1 <= len(frames) <= limits.MAX_GROUP_FRAMES or len(frames) * moves.sum() > limits.MAX_MOTION:
        raise ValueError("no frames, or too many of them")
    if not (np.abs(frames) < MOTION_MAX_STEPS).all():
        raise ValueError("vertices beyond the lattice")
    steps = np.concatenate([places[None], places[None], frames])[:, moves]
    steps = np.ascontiguousarray(steps, np.int64)
    near, starts, twins = _neighbours(places, faces, moves)
    flags = np.zeros(len(frames), np.uint8)
    for number in range(len(frames)):
        axes = (steps[number + 2] != steps[number + 1]).any(axis=0)
        flags[number] = int(axes @ [1, 2, 4])
        if axes.any():
            costs = [motion_cost(steps, number + 2, again, near, starts) for again in (0, AGAIN)]
            flags[number] |= AGAIN * (costs[1] < costs[0])
    header = HEADER.pack(VERSION, len(places), int(moves.sum()), len(frames)) + flags.tobytes()
    if not moves.any():
        return header

    def run(coder: Any) -> None:
        code_moving(coder, moves.astype(np.uint8), *_neighbours(places, faces)[:2])
        code_motion(coder, steps, flags, near, starts, twins)

    body = range_coder.coded_bytes(run, CONTEXTS, MIXTURES, room=frames[:, moves].size + len(places) + 1024)
    return range_coder.pad_bytes(header + body, _numbers(flags, int(moves.sum())))


def decode_motion(
    data: bytes, places: NDArray[np.int64], faces: NDArray[np.int32], where: str
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The vertices that move, (n,) increasing, and their lattice coordinates (T, n, 3) in each frame.

    Args:
        places, faces: As of `encode_motion`.

    Raises:
        FormatError: `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`.
    """
    range_coder.check_header(data, HEADER.size, VERSION, where)
    _, vertices, moving, frames = HEADER.unpack_from(data)
    if vertices != len(places) or moving > vertices or not 1 <= frames <= limits.MAX_GROUP_FRAMES:
        message = f"{moving} of {vertices} vertices move in {frames} frames, the mesh has {len(places)}"
        raise range_coder.damaged_error(message, where)
    first = HEADER.size + frames
    range_coder.check_header(data, first, VERSION, where)
    flags = np.frombuffer(data, np.uint8, frames, HEADER.size)
    if (flags > AXES + AGAIN).any():
        raise range_coder.damaged_error("frames that cannot be", where)
    if frames * moving > limits.MAX_MOTION:  # those in which nothing moves take memory too
        raise range_coder.damaged_error(f"{moving} vertices that move in {frames} frames", where)
    range_coder.check_numbers(data, _numbers(flags, moving), 3 * limits.MAX_MOTION, where)
    found = np.zeros(vertices, np.uint8)
    if moving == 0:
        return np.zeros(0, np.int64), np.zeros((frames, 0, 3), np.int64)
    coder = range_coder.decoder(data[first:], CONTEXTS, MIXTURES)
    code_moving(coder, found, *_neighbours(places, faces)[:2])
    moves = found.astype(bool)
    if moves.sum() != moving:
        raise range_coder.damaged_error(f"{moves.sum()} vertices move, {moving} are announced", where)
    steps = np.zeros((2 + frames, moving, 3), np.int64)
    steps[:2] = places[moves]
    code_motion(coder, steps, flags, *_neighbours(places, faces, moves))
    range_coder.check_end(coder, where)
    return np.flatnonzero(moves), steps[2:]


def _numbers(flags: NDArray[np.uint8], moving: int) -> int:
    """How many coordinates are coded."""
    return sum((flag & AXES).bit_count() for flag in flags.tolist()) * moving


def _neighbours(
    places: NDArray[np.int64], faces: NDArray[np.int32], moves: NDArray[np.bool_] | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """The vertices before that predict each, from (n + 1,) starts on, and (n,) whether it is one at the same place.

    At most MAX_NEIGHBOURS of them: the first vertex at the same place, else those of the faces round it, in the order
    of faces and of the corners behind the vertex. Both may be named twice.

    Args:
        moves: (v,) whether a vertex counts, and is numbered; None: all.
    """
    kept = np.ones(len(places), bool) if moves is None else moves
    number = np.cumsum(kept) - 1
    places, faces = places[kept], np.where(kept[faces], number[faces], -1)
    count = len(places)
    _, leader, same = np.unique(places, axis=0, return_index=True, return_inverse=True)
    leader = leader[same.reshape(-1)]
    twins = leader < np.arange(count)
    own = np.repeat(faces, 2, axis=1).reshape(-1)  # each corner beside both others
    other = np.stack([faces[:, (k + step) % 3] for k in range(3) for step in (1, 2)], axis=1).reshape(-1)
    usable = (other >= 0) & (other < own)
    usable &= ~twins[np.maximum(own, 0)] if count else False
    own, other = own[usable], other[usable]
    order = np.argsort(own, kind="stable")
    own, other = own[order], other[order]
    rank = np.arange(len(own)) - np.searchsorted(own, own)
    own, other = own[rank < MAX_NEIGHBOURS], other[rank < MAX_NEIGHBOURS]
    own, other = np.concatenate([own, np.flatnonzero(twins)]), np.concatenate([other, leader[twins]])
    order = np.argsort(own, kind="stable")
    starts = np.searchsorted(own[order], np.arange(count + 1))
    return np.ascontiguousarray(other[order], np.int64), starts.astype(np.int64), twins
