"""Places of a mesh over time: they come back as they are, cost little where they are to be expected, and any bytes."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding import limits
from eigenfield.coding.mesh.coder import decode_mesh, decode_placed, encode_mesh
from eigenfield.coding.mesh.motion import HEADER, decode_motion, encode_motion
from eigenfield.core.errors import FormatError
from support import coded_meshes

WHERE = "the motion"


def placed(mesh, lattice):
    found = decode_placed(encode_mesh(mesh, lattice)[0])
    return found.places, found.mesh.faces


def decoded(data, places, faces, count):
    """(T, v, 3) of all vertices."""
    moving, steps = decode_motion(data, places, faces, WHERE)
    frames = np.tile(places, (count, 1, 1))
    frames[:, moving] = steps
    return frames


def turned(places, count, angle=0.02):
    """A body that turns about an axis."""
    found = []
    for frame in range(1, count + 1):
        c, s = np.cos(angle * frame), np.sin(angle * frame)
        found.append(np.rint((places - 512) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T + 512))
    return np.array(found, np.int64)


def test_places_of_a_mesh_are_what_its_vertices_stand_on():
    mesh, lattice = coded_meshes.ball()
    stream, expected = encode_mesh(mesh, lattice)
    found = decode_placed(stream)
    assert np.array_equal(found.mesh.vertices, expected.vertices)
    assert np.array_equal(lattice.points(found.places).astype(np.float32), decode_mesh(stream).vertices)


def test_a_body_that_turns_comes_back_in_few_bytes():
    places, faces = placed(*coded_meshes.ball(48, 24))
    frames = turned(places, 12)
    data = encode_motion(places, faces, frames)
    assert np.array_equal(decoded(data, places, faces, 12), frames)
    assert data == encode_motion(places, faces, frames)
    assert 8 * len(data) / (12 * len(places)) < 4.5  # bits a vertex and frame, of three coordinates
    later = 8 * (len(data) - len(encode_motion(places, faces, frames[:6]))) / (6 * len(places))
    assert later < 4  # the frame before says most of it


def test_what_stands_still_costs_nothing():
    places, faces = placed(*coded_meshes.relief(60, 80))
    still = encode_motion(places, faces, np.tile(places, (30, 1, 1)))
    assert len(still) == HEADER.size + 30
    assert decode_motion(still, places, faces, WHERE)[1].shape == (30, 0, 3)
    moved = np.tile(places, (30, 1, 1))
    moved[10:, :20, 2] += 5  # twenty vertices, once
    data = encode_motion(places, faces, moved)
    assert np.array_equal(decoded(data, places, faces, 30), moved)
    assert len(data) < len(still) + 60


def test_surfaces_that_touch_can_part():
    """Two vertices at one place of the mesh are two when they move."""
    mesh, lattice = coded_meshes.ball()
    places, faces = placed(mesh, lattice)
    seam = len(places) - len(np.unique(places, axis=0))
    assert seam > 5
    frames = np.tile(places, (2, 1, 1))
    frames[1] += np.arange(len(places))[:, None]
    assert np.array_equal(decoded(encode_motion(places, faces, frames), places, faces, 2), frames)


@settings(max_examples=40)
@given(st.integers(0, 2**31), st.integers(3, 40), st.integers(1, 60), st.integers(1, 6), st.integers(0, 19))
def test_any_motion_comes_back(seed, vertices, faces, count, digits):
    places, corners = placed(*coded_meshes.soup(seed, vertices, faces))
    random = np.random.default_rng(seed)
    frames = np.tile(places, (count, 1, 1))
    frames += random.integers(-(2**digits), 2**digits, frames.shape) * (random.random((len(places), 1)) < 0.5)
    data = encode_motion(places, corners, frames)
    assert np.array_equal(decoded(data, places, corners, count), frames)


def test_motion_that_cannot_be_coded():
    places, faces = placed(*coded_meshes.ball())
    with pytest.raises(ValueError, match="beyond"):
        encode_motion(places, faces, np.tile(places, (1, 1, 1)) + 2**20)
    for frames in (0, limits.MAX_GROUP_FRAMES + 1):
        with pytest.raises(ValueError, match="too many"):
            encode_motion(places, faces, np.zeros((frames, *places.shape), np.int64))


def test_damaged_streams_are_our_errors_or_other_numbers():
    places, faces = placed(*coded_meshes.ball())
    data = encode_motion(places, faces, turned(places, 5))
    random = np.random.default_rng(1)
    for size in {0, 3, HEADER.size - 1, HEADER.size + 2, len(data) // 2}:
        with pytest.raises(FormatError) as caught:
            decode_motion(data[:size], places, faces, WHERE)
        assert caught.value.code in ("coded-truncated", "coded-damaged", "coded-size") and caught.value.where == WHERE
    for _ in range(300):
        bad = bytearray(data)
        for at in random.integers(0, len(bad), random.integers(1, 4)):
            bad[at] = random.integers(256)
        try:
            moving, steps = decode_motion(bytes(bad), places, faces, WHERE)
        except FormatError as error:
            assert error.code.startswith("coded-")
        else:
            assert steps.shape[1:] == (len(moving), 3) and np.abs(steps).max(initial=0) <= 3 * 2**20


@pytest.mark.parametrize(
    ("header", "code"),
    [
        ((2, 0, 0, 5), "coded-version"),
        ((1, 1, 0, 5), "coded-damaged"),
        ((1, 0, 10**6, 5), "coded-damaged"),
        ((1, 0, 0, 0), "coded-damaged"),
        ((1, 0, 0, 2000), "coded-damaged"),
    ],
)
def test_headers_that_cannot_be(header, code):
    places, faces = placed(*coded_meshes.ball())
    version, more, moving, frames = header
    data = HEADER.pack(version, len(places) + more, moving, frames) + bytes(40)
    with pytest.raises(FormatError) as caught:
        decode_motion(data, places, faces, WHERE)
    assert caught.value.code == code


def test_few_bytes_announce_no_more_than_they_may():
    places, faces = placed(*coded_meshes.relief(60, 80))
    data = HEADER.pack(1, len(places), len(places), 100) + b"\x07" * 100 + bytes(40)
    with pytest.raises(FormatError) as caught:
        decode_motion(data, places, faces, WHERE)
    assert caught.value.code == "coded-size"


def test_the_bytes_of_a_known_motion():
    places, faces = placed(*coded_meshes.ball(8, 5))
    data = encode_motion(places, faces, turned(places, 3))
    assert hashlib.sha256(data).hexdigest() == KNOWN


KNOWN = "abde72439f682154f1600037b149eca3a1b6e0a06bfad92845f72130ddaab5ad"
