"""A mesh in the axes of another program, of another size or moved is named; one that fits is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Photograph
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.placement import describe_placement


def hills() -> Mesh:
    """A square of hills that no axis change maps to itself."""
    side = 24
    y, x = np.mgrid[0:side, 0:side] / (side - 1) * 2 - 1
    z = 0.3 * np.sin(3 * x) + 0.25 * np.cos(4 * y) * x + 0.2 * y + 0.3 * x**2
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    faces = np.concatenate([corner[:, None] + np.array(c) for c in ((0, 1, side + 1), (0, side + 1, side))])
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32))


def look_down(x: float, y: float) -> Camera:
    """A camera above the hills that looks straight down."""
    turn = np.diag([1.0, -1, -1])
    return Camera(np.array([[90.0, 0, 48], [0, 90, 36], [0, 0, 1]]), turn, -turn @ (x, y, 2.6), 96, 72)


class Photographs:
    """Of a surface whose colour is a smooth function of the place."""

    def __init__(self, mesh: Mesh, cameras: list[Camera]) -> None:
        random = np.random.default_rng(5)
        ways, phases = random.normal(size=(3, 24)) * 12, random.uniform(0, 6, 24)
        self.pictures = []
        for camera in cameras:
            raster = rasterise_view(mesh, camera)
            row, column = np.nonzero(raster.face >= 0)
            corners = mesh.vertices[mesh.faces[raster.face[row, column]]]
            place = np.einsum("nk,nkx->nx", raster.corner_shares(row, column), corners)
            colours = np.sin(place @ ways + phases).reshape(-1, 3, 8).mean(axis=2)
            picture = np.full((camera.height, camera.width, 3), 0.5, np.float32)
            picture[row, column] = 0.5 + 0.5 * colours
            self.pictures.append(picture)

    def __len__(self) -> int:
        return len(self.pictures)

    def camera_of(self, index: int) -> int:
        return index

    def time_of(self, index: int) -> int:
        return 0

    def photograph(self, index: int) -> Photograph:
        return Photograph(self.pictures[index], None)


MESH = hills()
CAMERAS = [look_down(x, y) for x in (-0.8, 0, 0.8) for y in (-0.6, 0.6)]
AWAY = np.array([7.0, -3.0, 2.0])


@pytest.fixture(scope="module")
def photographs():
    return Photographs(MESH, CAMERAS)


def moved(matrix, shift=(0, 0, 0)):
    return Mesh((MESH.vertices @ np.array(matrix).T + np.array(shift)).astype(np.float32), MESH.faces)


AXES = {
    "-x, y, z": np.diag([-1.0, 1, 1]),
    "x, y, -z": np.diag([1.0, 1, -1]),
    "x, z, -y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
}


@pytest.mark.parametrize("words", AXES)
def test_axes_of_another_program_are_named(photographs, words):
    lines = describe_placement(moved(AXES[words]), CAMERAS, photographs, path=Path("m.obj"))
    assert (
        len(lines) == 1
        and f"m.obj: the photographs agree better on this mesh with its x, y, z taken as {words}:" in lines[0]
    )
    assert "inspect CAPTURE --proxy MESH --overlay" in lines[0]


@pytest.mark.parametrize(
    ("matrix", "shift", "words"),
    [(np.eye(3) * 2, (0, 0, 0), "0.513 times as large"), (np.eye(3) * 0.75, (0, 0, 0), "1.33 times as large"),
     (np.eye(3), (0.5, 0, 0), "along x"), (np.eye(3), (0, 0, -0.5), "along z")],
)  # fmt: skip
def test_another_size_and_place_are_named(photographs, matrix, shift, words):
    lines = describe_placement(moved(matrix, shift), CAMERAS, photographs)
    assert len(lines) == 1 and words in lines[0]


def test_a_mesh_that_fits_is_not_named(photographs):
    assert describe_placement(MESH, CAMERAS, photographs) == []
    noise = Photographs(MESH, CAMERAS)
    noise.pictures = [np.random.default_rng(i).random((72, 96, 3)).astype(np.float32) for i in range(len(CAMERAS))]
    assert describe_placement(MESH, CAMERAS, noise) == []
    away = [Camera(c.K, c.R, c.t - c.R @ (-AWAY), c.width, c.height) for c in CAMERAS]
    lines = describe_placement(moved(AXES["-x, y, z"], -AWAY), away, photographs, AWAY)
    assert len(lines) == 1 and "taken as -x, y, z" in lines[0]  # about the origin of the file


def test_a_mesh_that_covers_little_is_named(photographs):
    part = MESH.part(np.abs(MESH.vertices[MESH.faces]).max(axis=(1, 2)) < 0.45)
    lines = describe_placement(part, CAMERAS, photographs)
    assert len(lines) == 1 and "% of the photographs, and nothing is drawn beside it" in lines[0]
