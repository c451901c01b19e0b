"""Texel positions, visibility, resampling and gutters on planes whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.encoding.atlas import atlas_side, make_atlas, texels_per_pixel
from eigenfield.encoding.projected.encode import write_maps
from eigenfield.encoding.projected.project import texture_map, texture_maps
from eigenfield.encoding.spread import make_spreader, push_pull
from eigenfield.runtime.parallel import set_threads
from support.observations import InMemory

SIZE = 32


def camera(x=0.0, y=0.0, z=-1.0, size=SIZE):
    """Looks along +z from (x, y, z); the square [-0.5, 0.5]² at z = 0 fills the picture when z = -1 and x = y = 0."""
    K = np.array([[size, 0, size / 2], [0, size, size / 2], [0, 0, 1.0]])
    return Camera(K, np.eye(3), -np.array([x, y, z], float), size, size)


def square(low, high, z, uv_low, uv_high):
    """Two triangles parallel to the picture plane, y down as v."""
    corners = np.array([[low, low, z], [high, low, z], [high, high, z], [low, high, z]], np.float32)
    u, w = uv_low, uv_high
    uv = np.array([[u[0], u[1]], [w[0], u[1]], [w[0], w[1]], [u[0], w[1]]], np.float32)
    return corners, np.array([[0, 2, 1], [0, 3, 2]], np.int32), uv


def mesh_of(*squares):
    vertices, faces, uv, base = [], [], [], 0
    for v, f, t in squares:
        vertices.append(v)
        faces.append(f + base)
        uv.append(t)
        base += len(v)
    return Mesh(np.concatenate(vertices), np.concatenate(faces), np.concatenate(uv))


PLANE = mesh_of(square(-0.5, 0.5, 0, (0, 0), (1, 1)))


def photograph(seed=0, size=SIZE):
    return np.random.default_rng(seed).random((size, size, 3)).astype(np.float32)


def test_texel_positions_are_at_texel_centres():
    atlas = make_atlas(PLANE, 8, 4)
    assert atlas.count == 32
    row, column = np.divmod(atlas.texel, 8)
    expected = np.stack([(column + 0.5) / 8 - 0.5, (row + 0.5) / 4 - 0.5, np.zeros(32)], 1)
    np.testing.assert_allclose(atlas.position, expected, atol=1e-6)
    np.testing.assert_allclose(atlas.along[0], [1 / 8, 0, 0], atol=1e-7)
    np.testing.assert_allclose(atlas.down[0], [0, 1 / 4, 0], atol=1e-7)


def test_at_density_one_the_map_is_the_photograph():
    picture = photograph()
    values, seen = texture_map(make_atlas(PLANE, SIZE, SIZE), camera(), picture)
    assert seen.all()
    np.testing.assert_allclose(values.reshape(SIZE, SIZE, 3), picture, atol=2e-5)


@pytest.mark.parametrize("channels", [1, 2, 6])
def test_any_number_of_channels(channels):
    picture = np.random.default_rng(1).random((SIZE, SIZE, channels)).astype(np.float32)
    values, _ = texture_map(make_atlas(PLANE, SIZE, SIZE), camera(), picture)
    np.testing.assert_allclose(values.reshape(SIZE, SIZE, channels), picture, atol=2e-5)


def test_a_dense_photograph_is_averaged_not_point_sampled():
    """A checkerboard of single pixels is grey in an atlas four times coarser."""
    picture = np.indices((SIZE, SIZE)).sum(0)[..., None].repeat(3, 2).astype(np.float32) % 2
    values, _ = texture_map(make_atlas(PLANE, SIZE // 4, SIZE // 4), camera(), picture)
    inner = values.reshape(SIZE // 4, SIZE // 4, 3)[2:-2, 2:-2]
    assert np.abs(inner - 0.5).max() < 0.02


def test_minification_is_per_axis():
    """Columns keep their stripes where only rows are denser than the atlas."""
    picture = np.zeros((SIZE, SIZE, 3), np.float32)
    picture[:, 1::2] = 1
    values, _ = texture_map(make_atlas(PLANE, SIZE, SIZE // 4), camera(), picture)
    np.testing.assert_allclose(values.reshape(SIZE // 4, SIZE, 3), picture[: SIZE // 4], atol=1e-5)


def test_an_occluder_hides_exactly_what_lies_behind_it():
    """A square of half the width at half the distance hides the whole plane but what a shifted camera sees past it."""
    mesh = mesh_of(square(-0.5, 0.5, 0, (0, 0), (0.5, 1)), square(-0.125, 0.125, -0.5, (0.6, 0), (1, 1)))
    atlas = make_atlas(mesh, 128, 64)
    eye = camera(0.1, 0.0)
    _, seen = texture_map(atlas, eye, photograph())
    behind = atlas.face < 2
    # from the eye at (0.1, 0, -1) the occluder at z = -0.5 casts on z = 0 what is stretched twice about the eye
    x, y = atlas.position[behind, 0], atlas.position[behind, 1]
    shadow_x, shadow_y = (x - 0.1) / 2 + 0.1, y / 2
    margin = 1.5 / SIZE
    surely_hidden = (np.abs(shadow_x) < 0.125 - margin) & (np.abs(shadow_y) < 0.125 - margin)
    surely_seen = (np.abs(shadow_x) > 0.125 + margin) | (np.abs(shadow_y) > 0.125 + margin)
    inside = np.abs(x - 0.1) < 0.5
    assert surely_hidden.sum() > 100
    assert not seen[behind][surely_hidden & inside].any()
    assert seen[behind][surely_seen & inside].all()
    assert seen[~behind].all()


def test_sloped_surfaces_do_not_speckle():
    """A plane that recedes steeply hides nothing of itself."""
    corners = np.array([[-2, 0.5, 0], [2, 0.5, 0], [2, 0.5, 4], [-2, 0.5, 4]], np.float32)
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
    mesh = Mesh(corners, np.array([[0, 2, 1], [0, 3, 2]], np.int32), uv)
    atlas = make_atlas(mesh, 64, 256)
    eye = camera(z=-0.5)
    flat, depth = eye.project(atlas.position)
    inside = (depth > 0) & (flat >= 0).all(1) & (flat <= SIZE).all(1)
    _, seen = texture_map(atlas, eye, photograph())
    assert inside.sum() > 1000
    assert (seen[inside] > 0).all()


def test_outside_the_photograph_and_behind_the_camera_are_not_seen():
    atlas = make_atlas(PLANE, SIZE, SIZE)
    _, seen = texture_map(atlas, camera(x=0.5), photograph())
    columns = seen.reshape(SIZE, SIZE)
    assert columns[:, SIZE // 2 :].all() and not columns[:, : SIZE // 2].any()
    _, seen = texture_map(atlas, camera(z=1.0), photograph())
    assert not seen.any()


def test_grazing_texels_are_not_seen():
    """At 3 degrees above a plane nothing counts unless it is asked for, at 10 degrees all of it does."""
    atlas = make_atlas(PLANE, SIZE, SIZE)
    for degrees, asked, expected in ((3, {}, False), (3, {"max_angle": 90}, True), (10, {}, True)):
        a = np.radians(degrees)
        forward = np.array([0, -np.cos(a), np.sin(a)])
        down = np.array([0, np.sin(a), np.cos(a)])
        R = np.stack([[1.0, 0, 0], down, forward])
        eye = Camera(np.array([[20.0, 0, 16], [0, 20, 16], [0, 0, 1]]), R, -R @ (-20 * forward), SIZE, SIZE)
        assert (texture_map(atlas, eye, photograph(), **asked)[1].mean() > 0.9) == expected


def test_masks_hide_and_do_not_bleed():
    picture = np.zeros((SIZE, SIZE, 3), np.float32)
    picture[:, : SIZE // 2] = 1  # white counts, black does not
    mask = picture[..., 0].copy()
    values, seen = texture_map(make_atlas(PLANE, 3 * SIZE, 3 * SIZE), camera(), picture, mask)
    assert 0.4 < seen.mean() < 0.52
    np.testing.assert_allclose(values[seen > 0], 1, atol=1e-5)


def test_maps_of_all_cameras_stream_and_are_the_same_at_any_number_of_threads(tmp_path):
    atlas = make_atlas(PLANE, SIZE, SIZE)
    eyes = [camera(x) for x in (-0.2, 0.0, 0.2)]
    results = []
    for count in (1, 2):
        set_threads(count)
        try:
            with texture_maps(atlas, eyes, InMemory([photograph(i) for i in range(3)]), work=tmp_path) as maps:
                results.append((np.array(maps.values).tobytes(), np.array(maps.seen).tobytes()))
        finally:
            set_threads(None)
    assert results[0] == results[1]
    assert list(tmp_path.iterdir()) == []


def test_a_photograph_that_cannot_be_read_ends_the_work_and_leaves_nothing(tmp_path):
    class Broken(InMemory):
        def photograph(self, index):
            if index == 1:
                raise CaptureError("image-truncated", "ends early", path="b.jpg")
            return super().photograph(index)

    with (
        pytest.raises(CaptureError, match=r"b\.jpg"),
        texture_maps(make_atlas(PLANE, 8, 8), [camera()] * 5, Broken([photograph()] * 5), work=tmp_path),
    ):
        pass
    assert list(tmp_path.iterdir()) == []


def test_density_is_texels_per_pixel():
    assert texels_per_pixel(PLANE, camera()) * SIZE == pytest.approx(1.0)
    assert atlas_side(PLANE, camera(size=512), 1.5) == 768
    assert atlas_side(PLANE, camera(size=512), 1.4) == 768  # 716.8, up to the next multiple of 64
    assert atlas_side(PLANE, camera(size=512), 100) == 4096
    assert atlas_side(PLANE, camera(size=512), 100, pixels=10 * 512 * 512) == 2304  # sqrt(20) * 512 = 2290
    with pytest.raises(ProxyError, match="sees nothing"):
        texels_per_pixel(PLANE, camera(z=1.0))


def test_density_of_a_floor_that_runs_on_behind_the_camera():
    """As of the part before it, cut into small triangles."""

    def floor(z):
        u, v = np.meshgrid(np.linspace(0, 1, 2), (np.array(z) + 4) / 14)
        vertices = np.stack([10 * u - 5, np.full_like(u, 0.5), 14 * v - 4], axis=-1).reshape(-1, 3)
        corner = 2 * np.arange(len(z) - 1)[:, None]
        faces = (corner[:, None] + [[0, 1, 3], [0, 3, 2]]).reshape(-1, 3)
        uv = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)
        return Mesh(vertices.astype(np.float32), faces.astype(np.int32), uv)

    eye = camera(z=0.0, size=96)
    whole = texels_per_pixel(floor([-4.0, 10.0]), eye)
    assert whole == pytest.approx(texels_per_pixel(floor(np.linspace(0.2, 10, 400)), eye), rel=0.02)


def test_an_atlas_without_a_texel_is_refused():
    tiny = mesh_of(square(-0.5, 0.5, 0, (0.01, 0.01), (0.02, 0.02)))
    with pytest.raises(ProxyError, match="larger --atlas"):
        make_atlas(tiny, 16, 16)


def two_charts():
    return mesh_of(square(-0.5, 0, 0, (0.05, 0.1), (0.45, 0.9)), square(0, 0.5, 0, (0.55, 0.1), (0.95, 0.9)))


def test_gutters_repeat_their_own_chart():
    atlas = make_atlas(two_charts(), 128, 64)
    left = atlas.face < 2
    spread = make_spreader(atlas, np.ones(atlas.count, bool))
    picture = spread(np.where(left, 1.0, 0.0).astype(np.float32)[:, None])[..., 0]
    rows, columns = np.divmod(atlas.texel, 128)
    for reach in (1, 2, 3):  # what bicubic taps and two mip levels reach
        right_edge = columns[left].max() + reach
        assert (picture[rows.min() : rows.max(), right_edge] == 1).all()
        assert (picture[rows.min() : rows.max(), columns[~left].min() - reach] == 0).all()
        assert (picture[rows.min() - reach, columns[left].min() : columns[left].max()] == 1).all()


def test_unseen_texels_are_filled_smoothly():
    atlas = make_atlas(PLANE, 64, 64)
    ramp = (atlas.texel % 64 / 64).astype(np.float32)[:, None]
    hole = np.ones((64, 64), bool)
    hole[20:40, 25:35] = False
    picture = make_spreader(atlas, hole.reshape(-1))(ramp)[..., 0]
    expected = np.arange(64) / 64
    np.testing.assert_array_equal(picture[:20], np.broadcast_to(expected, (20, 64)).astype(np.float32))
    assert np.abs(picture[20:40] - expected).max() < 0.12
    assert np.abs(np.diff(picture, axis=1)).max() < 0.12


@settings(max_examples=25)
@given(height=st.integers(1, 33), width=st.integers(1, 33), channels=st.integers(1, 6), seed=st.integers(0, 99))
def test_push_pull_keeps_what_is_known_and_stays_within_its_range(height, width, channels, seed):
    generator = np.random.default_rng(seed)
    weight = (generator.random((height, width)) < 0.3).astype(np.float32)
    weight[generator.integers(height), generator.integers(width)] = 1
    picture = generator.random((height, width, channels)).astype(np.float32) * weight[..., None]
    known = weight > 0
    result = push_pull(picture, weight)
    np.testing.assert_array_equal(result[known], picture[known])
    assert (result >= picture[known].min(0) - 1e-5).all() and (result <= picture[known].max(0) + 1e-5).all()


def test_filling_is_linear():
    """So that the filled sum is the sum of the filled: what the renderer relies on."""
    atlas = make_atlas(two_charts(), 48, 48)
    generator = np.random.default_rng(5)
    spread = make_spreader(atlas, generator.random(atlas.count) < 0.5)
    a, b = (generator.random((atlas.count, 3)).astype(np.float32) for _ in range(2))
    np.testing.assert_allclose(spread(2 * a - 3 * b), 2 * spread(a) - 3 * spread(b), atol=1e-5)


def test_maps_and_visibility_are_written(tmp_path):
    atlas = make_atlas(PLANE, SIZE, SIZE)
    with texture_maps(atlas, [camera(-0.3), camera(0.3)], InMemory([photograph(i) for i in range(2)])) as maps:
        spread = make_spreader(atlas, maps.seen.any(axis=0))
        write_maps(maps, np.full((atlas.count, 3), 0.5, np.float32), spread, ["a.jpg", "b.jpg"], tmp_path / "maps")
    assert sorted(path.name for path in (tmp_path / "maps").iterdir()) == [
        "a.map.png", "a.seen.png", "b.map.png", "b.seen.png", "mean.png",
    ]  # fmt: skip
