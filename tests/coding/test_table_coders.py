"""Coded weights, cameras and triangles: within half a step, on grids and off them; any bytes."""

from __future__ import annotations

import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from eigenfield.coding.arrays.cameras import HEADER as CAMERA_HEADER
from eigenfield.coding.arrays.cameras import code_cameras, code_deflated, decode_cameras, decode_deflated
from eigenfield.coding.arrays.triangles import code_triangles, decode_triangles, sorted_triangles
from eigenfield.coding.arrays.weights import code_weights, decode_weights
from eigenfield.core.camera import Camera
from eigenfield.core.errors import FormatError
from support.arrays import COLUMNS, GRID, ROWS, array_cameras, array_triangles, smooth_weights
from support.coded_meshes import damaged


def test_triangles_come_back_in_order_with_their_sense():
    triangles = array_triangles()
    ordered = sorted_triangles(triangles)

    def cyclic(rows):
        return {min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in rows.tolist()}

    assert len(ordered) == len(triangles) and cyclic(ordered) == cyclic(triangles)
    stream = code_triangles(ordered)
    np.testing.assert_array_equal(decode_triangles(stream), ordered)
    assert len(stream) < len(triangles)  # of 6 bytes plain


def test_triangles_of_no_camera_are_refused():
    for wrong in (-1, 100_000):
        stream = code_triangles(np.array([[wrong, 1, 2]], np.int32))
        with pytest.raises(FormatError, match="cameras"):
            decode_triangles(stream)


@pytest.mark.parametrize("grid", [None, GRID, GRID[::-1, ::-1]], ids=["line", "grid", "turned"])
@pytest.mark.parametrize("step", [0.2, 0.01])
def test_weights_come_back_within_half_a_step(grid, step):
    weights = smooth_weights(noise=0.5)
    data, expected = code_weights(weights, step, grid)
    back = decode_weights(data)
    assert np.array_equal(back, expected) and back.dtype == np.float32
    error = (back - weights).astype(np.float64)
    assert np.sqrt((error**2).mean()) < 0.31 * step  # uniform: 0.289
    if grid is None:
        assert np.abs(error).max() <= step / 2 + 1e-6


def test_every_component_has_its_step():
    weights = smooth_weights(3, noise=2.0)
    steps = np.array([0.5, 0.05, 0.005])
    back = decode_weights(code_weights(weights, steps)[0])
    worst = np.abs(back - weights).max(axis=0)
    assert (worst <= steps / 2 + 1e-6).all() and (worst > steps / 4).all()


def test_a_grid_makes_smooth_weights_cheaper():
    weights = smooth_weights()
    assert len(code_weights(weights, 0.02, GRID)[0]) < 0.7 * len(code_weights(weights, 0.02)[0])


def test_a_grid_with_holes():
    grid = np.full((ROWS + 1, COLUMNS), -1)
    grid[1:] = GRID
    grid[2, 3] = -1
    grid[grid > GRID[1, 3]] -= 1
    weights = smooth_weights()[: ROWS * COLUMNS - 1]
    back = decode_weights(code_weights(weights, 0.1, grid)[0])
    assert np.abs(back - weights).max() <= 0.05 + 1e-6


def test_no_components_and_one_camera():
    assert decode_weights(code_weights(np.zeros((5, 0), np.float32), 0.1)[0]).shape == (5, 0)
    assert decode_weights(code_weights(np.ones((1, 2), np.float32), 0.1, [[0]])[0]) == pytest.approx(
        np.ones((1, 2)), abs=0.05
    )


@pytest.mark.parametrize(
    ("weights", "step", "grid", "match"),
    [
        (np.full((2, 1), np.nan), 0.1, None, "finite"),
        (np.ones((2, 1)), 0.0, None, "positive"),
        (np.ones((2, 1)), 1e-9, None, "steps"),
        (np.ones((2, 1)), 0.1, [[0, 0]], "grid"),
        (np.ones((2, 1)), 0.1, [[0, 2]], "grid"),
    ],
)
def test_weights_that_cannot_be_coded(weights, step, grid, match):
    with pytest.raises(ValueError, match=match):
        code_weights(weights.astype(np.float32), step, grid)


@pytest.mark.parametrize("grid", [None, GRID], ids=["line", "grid"])
def test_cameras_come_back_within_half_a_step(grid):
    cameras = array_cameras()
    data, intrinsics, poses = code_cameras(
        cameras, intrinsic_step=0.02, rotation_step=1e-4, centre_step=1e-3, grid=grid
    )
    back = decode_cameras(data)
    assert np.array_equal(back[0], intrinsics) and np.array_equal(back[1], poses)
    K = np.array([[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras])
    assert np.abs(intrinsics - K).max() <= 0.01 + 1e-4
    R = poses[:, :, :3].astype(np.float64)
    assert np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max() < 1e-6
    turned = Rotation.from_matrix(R) * Rotation.from_matrix([c.R for c in cameras]).inv()
    assert turned.magnitude().max() <= np.sqrt(3) * 0.5e-4 * 1.1
    centres = -np.einsum("nji,nj->ni", R, poses[:, :, 3])
    assert np.abs(centres - [c.centre for c in cameras]).max() <= 0.5e-3 + 1e-5


def test_a_grid_makes_cameras_on_it_cheaper():
    steps = {"intrinsic_step": 0.02, "rotation_step": 1e-4, "centre_step": 1e-4}
    cameras = array_cameras(jitter=0.0)
    assert len(code_cameras(cameras, **steps, grid=GRID)[0]) < len(code_cameras(cameras, **steps)[0])


def test_cameras_that_look_everywhere():
    random = np.random.default_rng(5)
    turns = Rotation.random(40, random)
    cameras = [Camera(np.diag([300.0, 300, 1]), R, random.normal(size=3), 64, 64) for R in turns.as_matrix()]
    _, _, poses = code_cameras(cameras, intrinsic_step=0.1, rotation_step=1e-4, centre_step=1e-3)
    turned = Rotation.from_matrix(poses[:, :, :3].astype(np.float64)) * turns.inv()
    assert turned.magnitude().max() <= np.sqrt(3) * 0.5e-4 * 1.1


@pytest.mark.parametrize("grid", [None, GRID], ids=["line", "grid"])
def test_deflated_cameras_are_the_same_cameras(grid):
    given = {"intrinsic_step": 0.02, "rotation_step": 1e-4, "centre_step": 1e-3, "grid": grid}
    plain, deflated = code_cameras(array_cameras(), **given), code_deflated(array_cameras(), **given)
    assert deflated[0][0] == 2 and zlib.decompress(deflated[0][1:], -15) == plain[0][1:]
    for found in (deflated[1:], decode_deflated(deflated[0])):
        assert np.array_equal(found[0], plain[1]) and np.array_equal(found[1], plain[2])


def test_a_regular_grid_takes_few_bytes():
    row, column = np.mgrid[:9, :9].reshape(2, 81)
    lens = [[500.0, 0, 256], [0, 500, 256], [0, 0, 1]]
    cameras = [Camera(np.array(lens), np.eye(3), -np.array([0.1 * x, 0.1 * y, 0]), 512, 512)
               for y, x in zip(row, column, strict=True)]  # fmt: skip
    steps = {"intrinsic_step": 0.02, "rotation_step": 1e-5, "centre_step": 1e-4}
    data, _, poses = code_deflated(cameras, **steps, grid=np.arange(81).reshape(9, 9))
    assert len(data) < 80
    assert np.abs(poses[:, :, 3] - [camera.t for camera in cameras]).max() < 1e-4


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "coded-truncated"),
        (b"\1\0", "coded-version"),
        (b"\2\xff\xff", "coded-damaged"),
        (b"\2" + zlib.compress(bytes(300), 9, -15)[:-2], "coded-truncated"),
        (b"\2" + zlib.compress(bytes(300), 9, -15), "coded-damaged"),
        (b"\2" + zlib.compress(bytes(100), 9, -15), "coded-truncated"),
        (b"\2" + zlib.compress(bytes(2**23), 9, -15), "coded-size"),
    ],
)
def test_deflated_cameras_that_cannot_be_are_refused(data, code):
    with pytest.raises(FormatError) as caught:
        decode_deflated(data, "here")
    assert caught.value.code == code and caught.value.where == "here"


def test_no_cameras_are_refused():
    with pytest.raises(ValueError, match="cameras"):
        code_cameras([], intrinsic_step=1, rotation_step=1, centre_step=1)


@pytest.fixture(scope="module")
def streams():
    weights = smooth_weights(3)
    steps = {"intrinsic_step": 0.02, "rotation_step": 1e-4, "centre_step": 1e-3}
    cameras = array_cameras(2, 3)
    return [
        (decode_weights, code_weights(weights, 0.1)[0]), (decode_weights, code_weights(weights, 0.1, GRID)[0]),
        (decode_cameras, code_cameras(cameras, **steps)[0]),
        (decode_cameras, code_cameras(cameras, **steps, grid=np.arange(6).reshape(2, 3))[0]),
        (decode_deflated, code_deflated(cameras, **steps, grid=np.arange(6).reshape(2, 3))[0]),
        (decode_triangles, code_triangles(sorted_triangles(array_triangles()))),
    ]  # fmt: skip


@settings(max_examples=150)
@given(st.data())
def test_damaged_bytes_give_numbers_or_a_format_error(streams, data):
    decode, stream = data.draw(st.sampled_from(streams))
    try:
        back = decode(damaged(data, stream), "here")
    except FormatError as error:
        assert error.code.startswith("coded-") and error.where == "here"
        return
    for part in back if isinstance(back, tuple) else (back,):
        assert np.isfinite(part).all()


def test_large_numbers_in_a_short_stream_allocate_nothing(streams):
    for decode, stream in streams:
        if decode is decode_deflated:
            continue
        large = bytearray(stream)
        at = 1 if decode is decode_triangles else 6
        large[at : at + 4] = (10**5).to_bytes(4, "little")
        with pytest.raises(FormatError):
            decode(bytes(large))
    wide = bytearray(streams[1][1])
    wide[2:6] = b"\xff\xff\xff\xff"
    with pytest.raises(FormatError) as caught:
        decode_weights(bytes(wide))
    assert caught.value.code == "coded-size"
    assert CAMERA_HEADER.size == 130
