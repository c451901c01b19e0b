"""Coded meshes: the same faces, within half a lattice step; any triangles; any bytes."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding.mesh import corner_kernels as mesh_corner_kernels
from eigenfield.coding.mesh import face_kernels as mesh_kernels
from eigenfield.coding.mesh import value_kernels as mesh_value_kernels
from eigenfield.coding.mesh.coder import HEADER, decode_mesh, encode_mesh, whole_faces
from eigenfield.core.errors import FormatError
from eigenfield.core.lattice import camera_lattice, world_lattice
from eigenfield.core.mesh import Mesh
from support import coded_meshes


def same(one, other):
    return all(np.array_equal(a, b) for a, b in zip(
        (one.vertices, one.faces, one.uv), (other.vertices, other.faces, other.uv), strict=True
    ))  # fmt: skip


@pytest.mark.parametrize("charts", [1, 3])
def test_a_relief_comes_back_within_half_a_step(charts):
    mesh, lattice = coded_meshes.relief(charts=charts)
    data, expected = encode_mesh(mesh, lattice)
    back = decode_mesh(data)
    assert same(back, expected)
    assert np.array_equal(coded_meshes.face_set(back, lattice), coded_meshes.face_set(mesh, lattice))
    assert np.array_equal(coded_meshes.corner_set(back, lattice, 8), coded_meshes.corner_set(mesh, lattice, 8))
    assert back.vertices.dtype == np.float32 and back.faces.dtype == np.int32 and back.uv.dtype == np.float32
    assert len(back.vertices) == len(mesh.vertices)


def test_a_relief_takes_few_bytes():
    mesh, lattice = coded_meshes.relief(60, 80)
    data, _ = encode_mesh(mesh, lattice)
    assert (len(data) - HEADER.size) * 8 / len(mesh.vertices) < 3  # the bumps; a plain grid costs next to nothing


def test_texture_moves_with_the_surface_where_it_is_a_map_of_it():
    mesh, _ = coded_meshes.relief(40, 40)
    coarse = camera_lattice(coded_meshes.CAMERA, 3.0, 1e-3)
    back = decode_mesh(encode_mesh(mesh, coarse, uv_bits=10)[0])
    pixel = back.vertices.astype(np.float64) @ coded_meshes.CAMERA[:, :3].T
    x, y = (pixel[:, :2] / pixel[:, 2:]).T
    off = np.abs(back.uv * 64 - np.stack([x - 0.5 + 2, y - 0.5 + 2], axis=1)).max()
    assert off < 64 / 2**10  # the map's tolerance, far below the lattice's 1.5 pixels


def test_fine_digits_cost_only_the_vertices_that_have_them():
    plain, _ = coded_meshes.relief(40, 40)
    mesh, lattice = coded_meshes.relief(40, 40, step=0.125, astray=0.1)
    fine, expected = encode_mesh(mesh, lattice, fine=3)
    back = decode_mesh(fine)
    assert same(back, expected)
    assert np.array_equal(coded_meshes.face_set(back, lattice), coded_meshes.face_set(mesh, lattice))
    astray = (np.rint(lattice.coordinates(mesh.vertices))[:, :2] % 8 != 0).any(axis=1).sum()
    pixels = encode_mesh(plain, camera_lattice(coded_meshes.CAMERA, 1.0, 1e-3))[0]
    assert len(pixels) < len(fine) < len(pixels) + 2 * astray + 120
    assert len(fine) < 0.9 * len(encode_mesh(mesh, lattice)[0])
    with pytest.raises(ValueError, match="fine"):
        encode_mesh(*coded_meshes.ball(), fine=1)


def test_a_ball_with_a_seam_and_poles():
    mesh, lattice = coded_meshes.ball()
    data, expected = encode_mesh(mesh, lattice)
    back = decode_mesh(data)
    assert same(back, expected)
    assert np.array_equal(coded_meshes.corner_set(back, lattice, 12), coded_meshes.corner_set(mesh, lattice, 12))
    step = 2 / 1023
    nearest = np.abs(back.vertices[:, None] - mesh.vertices[None]).max(axis=2).min(axis=1)
    assert nearest.max() <= step / 2 + 1e-6


@settings(max_examples=60)
@given(st.integers(0, 2**31), st.integers(3, 60), st.integers(0, 120))
def test_any_triangles_come_back(seed, vertices, faces):
    mesh, lattice = coded_meshes.soup(seed, vertices, faces)
    data, expected = encode_mesh(mesh, lattice)
    back = decode_mesh(data)
    assert same(back, expected)
    assert np.array_equal(coded_meshes.corner_set(back, lattice, 12), coded_meshes.corner_set(mesh, lattice, 12))


@settings(max_examples=25)
@given(st.integers(0, 2**31), st.integers(3, 60), st.integers(0, 120))
def test_any_triangles_over_a_plane_come_back(seed, vertices, faces):
    mesh, _ = coded_meshes.soup(seed, vertices, faces)
    mesh = replace(mesh, vertices=mesh.vertices + np.float32(5))
    lattice = camera_lattice(coded_meshes.CAMERA, 2.0, 0.002)
    back = decode_mesh(encode_mesh(mesh, lattice)[0])
    assert np.array_equal(coded_meshes.corner_set(back, lattice, 12), coded_meshes.corner_set(mesh, lattice, 12))


def test_vertices_without_a_face_and_faces_without_area_are_left_out():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.01, 0, 0], [5, 5, 5]], np.float32)
    faces = np.array([[0, 1, 2], [0, 3, 1], [1, 1, 2]], np.int32)
    mesh = Mesh(vertices, faces, vertices[:, :2] / 8)
    back = decode_mesh(encode_mesh(mesh, world_lattice([0, 0, 0], 0.1))[0])
    assert len(back.faces) == 1 and len(back.vertices) == 3


def parts_of(mesh, counts):
    """Each sheet as a mesh of its own."""
    return [replace(mesh, faces=faces) for faces in np.split(mesh.faces, np.cumsum(counts)[:-1])]


@settings(max_examples=60)
@given(st.lists(st.tuples(st.integers(0, 2**31), st.integers(3, 30), st.integers(1, 40)), min_size=1, max_size=5),
       st.booleans())  # fmt: skip
def test_sheets_come_back_in_their_order_each_with_its_faces(soups, flat):
    """Their vertices are at few points, so that most places of one sheet are at those of another."""
    mesh, counts = coded_meshes.joined([coded_meshes.soup(*soup)[0] for soup in soups])
    lattice = world_lattice([0, 0, 0], 1.0)
    if flat:
        mesh, lattice = (
            replace(mesh, vertices=mesh.vertices + np.float32(5)),
            camera_lattice(coded_meshes.CAMERA, 2.0, 0.002),
        )
    data, expected = encode_mesh(mesh, lattice, sheets=counts)
    back = decode_mesh(data)
    assert same(back, expected)
    whole = whole_faces(mesh, lattice)
    left = [int(part.sum()) for part in np.split(whole, np.cumsum(counts)[:-1])]
    assert sum(left) == len(back.faces)
    for before, after in zip(parts_of(mesh, counts), parts_of(back, left), strict=True):
        assert np.array_equal(coded_meshes.corner_set(before, lattice, 12), coded_meshes.corner_set(after, lattice, 12))
    owner = np.full(len(back.vertices), -1)
    for sheet, after in enumerate(parts_of(back, left)):
        assert np.isin(owner[after.faces], [-1, sheet]).all()
        owner[after.faces] = sheet


def test_a_sheet_on_another_costs_no_depth_of_either():
    """At the same points of the lattice they are places of their own: neither moves."""
    mesh, lattice = coded_meshes.relief(20, 24)
    twice, counts = coded_meshes.joined([mesh, mesh])
    data, back = encode_mesh(twice, lattice, sheets=counts)
    alone = encode_mesh(mesh, lattice)[1]
    for part in parts_of(back, counts):
        assert np.array_equal(coded_meshes.face_set(part, lattice), coded_meshes.face_set(alone, lattice))
    assert len(back.vertices) == 2 * len(alone.vertices) and len(data) > HEADER.size


def test_one_sheet_has_the_bytes_of_a_mesh():
    for mesh, lattice in (coded_meshes.relief(charts=3), coded_meshes.ball(), coded_meshes.soup()):
        assert encode_mesh(mesh, lattice, sheets=(len(mesh.faces),))[0] == encode_mesh(mesh, lattice)[0]


def test_sheets_that_do_not_divide_the_mesh_are_refused():
    mesh, lattice = coded_meshes.ball()
    with pytest.raises(ValueError, match="divide"):
        encode_mesh(mesh, lattice, sheets=(len(mesh.faces) - 1,))
    with pytest.raises(ValueError, match="share a vertex"):
        encode_mesh(mesh, lattice, sheets=(100, len(mesh.faces) - 100))


def test_the_same_mesh_gives_the_same_bytes():
    mesh, lattice = coded_meshes.ball()
    assert encode_mesh(mesh, lattice)[0] == encode_mesh(mesh, lattice)[0]


def test_an_empty_mesh():
    mesh = Mesh(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32), np.zeros((0, 2), np.float32))
    back = decode_mesh(encode_mesh(mesh, world_lattice([0, 0, 0], 1))[0])
    assert back.vertices.shape == (0, 3) and back.faces.shape == (0, 3)


def test_what_does_not_fit_is_refused():
    mesh, lattice = coded_meshes.ball()
    with pytest.raises(ValueError, match="texture"):
        encode_mesh(replace(mesh, uv=None), lattice)
    with pytest.raises(ValueError, match="lattice"):
        encode_mesh(mesh, world_lattice([0, 0, 0], 1e-7))
    with pytest.raises(ValueError, match="camera"):
        encode_mesh(mesh, camera_lattice(coded_meshes.CAMERA, 1.0, 1e-3))


@pytest.fixture(scope="module")
def streams():
    return [encode_mesh(*made)[0] for made in (coded_meshes.relief(8, 9, charts=2), coded_meshes.ball(6, 4))]


@settings(max_examples=150)
@given(st.data())
def test_damaged_bytes_give_a_mesh_or_a_format_error(streams, data):
    try:
        mesh = decode_mesh(coded_meshes.damaged(data, data.draw(st.sampled_from(streams))), "here")
    except FormatError as error:
        assert error.code.startswith("coded-") and error.where == "here"
        return
    assert len(mesh.faces) == 0 or mesh.faces.max() < len(mesh.vertices)
    assert np.isfinite(mesh.vertices).all() and np.isfinite(mesh.uv).all()


def test_large_numbers_in_a_short_stream_allocate_nothing(streams):
    for field in range(3):
        stream = bytearray(streams[0])
        stream[4 + 4 * field : 8 + 4 * field] = (2**26).to_bytes(4, "little")
        with pytest.raises(FormatError) as caught:
            decode_mesh(bytes(stream))
        assert caught.value.code == "coded-size"


def test_the_bytes_do_not_change_between_versions():
    """Files are read for years: a change of the code needs a new version number."""
    data, _ = encode_mesh(*coded_meshes.soup(5))
    assert hashlib.sha256(data).hexdigest()[:16] == "5d67f488b49172ea"
    mesh, _ = coded_meshes.soup(6)
    matrix = np.array([[64.0, 0, 32, 0], [0, 64, 32, 0], [0, 0, 1, 8]])
    data, _ = encode_mesh(mesh, camera_lattice(matrix, 0.5, 2.0**-10), fine=1)
    assert hashlib.sha256(data).hexdigest()[:16] == "fea6fdf40602c3ef"


def test_the_page_has_the_contexts_of_the_code():
    page = (Path(__file__).parents[2] / "docs" / "coding.md").read_text(encoding="utf-8")
    firsts = {
        "LEFT": mesh_kernels.LEFT, "RIGHT": mesh_kernels.RIGHT, "EDGE": mesh_kernels.EDGE, "FRESH": mesh_kernels.FRESH,
        "SEED": mesh_kernels.SEED, "ASKED": mesh_corner_kernels.ASKED, "NEW": mesh_corner_kernels.NEW,
        "CHART": mesh_corner_kernels.CHART, "DEPTH": mesh_value_kernels.DEPTH, "TEXTURE": mesh_value_kernels.TEXTURE,
    }  # fmt: skip
    for name, first in firsts.items():
        assert f"| {first} | {name} " in page
    assert f"| {mesh_value_kernels.CONTEXTS} | end |" in page
    data, _ = encode_mesh(*coded_meshes.relief(8, 9, charts=3))  # charts that are maps of x and y
    assert hashlib.sha256(data).hexdigest()[:16] == "802544364517cfaa"


def test_a_chart_that_is_a_map_takes_few_bytes():
    """Beyond the first, two offsets of 15 bits and some flags."""
    sizes = [len(encode_mesh(*coded_meshes.relief(30, 31, charts=charts))[0]) for charts in (1, 5)]
    assert sizes[1] - sizes[0] < 48
