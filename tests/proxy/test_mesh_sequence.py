"""A mesh for each frame: which vertex is which, whatever cleaning and unwrapping made of the first one."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import unwrap_mesh, write_ply
from eigenfield.proxy.meshes.sequence import is_sequence, mesh_files, read_sequences
from support.scenes import bumpy_square


def two_sheets(apart):
    """Two squares that lie on each other at 0, an unused vertex before them, and a triangle without an area."""
    square = bumpy_square(4)
    low, high = square.vertices, square.vertices + np.array([0, 0, apart], np.float32)
    vertices = np.concatenate([[[9, 9, 9]], low, high]).astype(np.float32)
    faces = np.concatenate([[[1, 1, 2]], square.faces + 1, square.faces[:, ::-1] + 1 + len(low)]).astype(np.int32)
    return Mesh(vertices, faces)


@pytest.mark.slow
def test_vertices_are_found_again_after_cleaning_and_cutting_charts():
    meshes = [two_sheets(apart) for apart in (0.25, 0.5, 0.75)]
    (sequence,) = read_sequences(meshes, 3)
    assert len(sequence.mesh.faces) == 36 and sequence.positions.shape == (3, 33, 3)
    unwrapped = unwrap_mesh(sequence.mesh)
    for mesh in (sequence.mesh, unwrapped):
        found = sequence.vertices_of(mesh)
        np.testing.assert_array_equal(sequence.positions[0][found], mesh.vertices)
        moved = sequence.positions[2][found] - mesh.vertices
        np.testing.assert_allclose(moved[:, 2], np.where(found > 16, 0.5, 0), atol=1e-6)


def test_sheets_that_lie_on_each_other_are_told_apart_by_their_triangles():
    square = bumpy_square(3)
    other = Mesh(square.vertices, np.array([[0, 1, 4], [0, 4, 3]], np.int32), None)  # the same places, cut otherwise
    vertices = np.concatenate([square.vertices, other.vertices])
    faces = np.concatenate([square.faces, other.faces + len(square.vertices)])
    (sequence,) = read_sequences([Mesh(vertices, faces), Mesh(vertices + np.float32(1), faces)], 2)
    found = sequence.vertices_of(Mesh(vertices, faces))
    np.testing.assert_array_equal(found[faces], faces)


def test_other_triangles_begin_another_sequence():
    one, other = bumpy_square(4), bumpy_square(5)
    turned = Mesh(one.vertices, np.roll(one.faces, 1, axis=0))
    found = read_sequences([one, one, other, turned, turned, one], 6)
    assert [(part.first, len(part.positions)) for part in found] == [(0, 2), (2, 1), (3, 2), (5, 1)]
    assert [part.faces.shape for part in found] == [
        one.faces.shape,
        other.faces.shape,
        one.faces.shape,
        one.faces.shape,
    ]
    np.testing.assert_array_equal(found[2].faces, turned.faces)


def test_the_files_of_a_sequence_are_in_the_order_of_their_numbers(tmp_path):
    for number in (9, 10, 11):
        write_ply(bumpy_square(3), tmp_path / f"mesh_{number}.ply")
    write_ply(bumpy_square(3), tmp_path / "mesh_x.ply")
    assert [path.name for path in mesh_files(tmp_path / "mesh_%d.ply")] == [f"mesh_{n}.ply" for n in (9, 10, 11)]
    (tmp_path / "mesh_10.ply").unlink()
    with pytest.raises(ProxyError) as caught:
        mesh_files(tmp_path / "mesh_%03d.ply")
    assert caught.value.code == "proxy-gap" and "mesh 10 of those from 9 to 11" in str(caught.value)
    with pytest.raises(ProxyError) as caught:
        mesh_files(tmp_path / "nowhere" / "mesh_%d.ply")
    assert caught.value.code == "proxy-missing"


def test_what_is_a_sequence(tmp_path):
    assert is_sequence("mesh_%04d.ply") and is_sequence(tmp_path / "m%d.obj") and is_sequence([bumpy_square(3)])
    assert not is_sequence("mesh.ply") and not is_sequence(bumpy_square(3)) and not is_sequence(None)
    write_ply(bumpy_square(3), tmp_path / "100%d.ply")
    assert not is_sequence(tmp_path / "100%d.ply")  # a mesh that has such a name
