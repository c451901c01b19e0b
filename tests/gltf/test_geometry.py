"""Mesh, cameras and weights in a file as coded streams: near enough, kept as they are, gone with what they are of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.core.camera import Camera
from eigenfield.core.errors import FormatError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payloads, cameras_key, mesh_key
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.encoding.geometry.coded import CAMERA_STEP_PX, DEPTH_ERROR_PX, MESH_STEP_PX, coded_cameras, coded_mesh
from eigenfield.gltf import parts, save, validate
from eigenfield.gltf.coarse import coarse_mesh
from eigenfield.gltf.container import parse_glb
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout import read_layout
from eigenfield.gltf.packed import unpack
from eigenfield.gltf.source import read_file
from eigenfield.proxy.atlas.unwrap import unwrap_mesh
from eigenfield.proxy.relief.find_lattice import _column_spacing, relief_lattice, relief_proxy
from support.coded_scenes import coded
from support.scenes import bumpy_square, row_grid, tiny_scene
from support.schema import extension_of
from support.soft_scenes import soft_scene
from support.surfaces import ball, relief


def coded_scene() -> Scene:
    """Nine cameras on a grid before a bumpy square."""
    return coded(replace(tiny_scene(3, 4, 9, 64), proxy=Proxy(bumpy_square(40))), np.arange(9).reshape(3, 3))


def test_rounding_moves_the_mesh_by_what_is_stated():
    mesh, cameras = bumpy_square(40), row_grid(9)
    made = coded_mesh(relief_proxy(mesh, cameras, DEPTH_ERROR_PX), cameras, 4)
    found = made.value.mesh
    assert len(found.faces) == len(mesh.faces) and made.payloads.bytes < mesh.vertices.nbytes / 4
    most = MESH_STEP_PX / 2 * np.sqrt(2) + DEPTH_ERROR_PX * 1.5
    for camera in cameras:
        before, after = camera.project(mesh.vertices)[0], camera.project(found.vertices)[0]
        apart = np.linalg.norm(before[:, None] - after[None], axis=2).min(axis=1)
        assert apart.max() < most


@pytest.mark.parametrize("virtual", [False, True])
def test_a_relief_is_coded_on_the_pixels_it_was_made_on(virtual):
    cameras = row_grid(9)
    made_in = cameras[5] if not virtual else replace(cameras[4], t=cameras[4].t + np.array([0.07, -0.03, 0.01]))
    mesh = relief(made_in, 0.5, virtual)
    assert relief_lattice(mesh, cameras, DEPTH_ERROR_PX) is not None
    made = coded_mesh(relief_proxy(mesh, cameras, DEPTH_ERROR_PX), cameras, 4)
    found = made.value.mesh
    assert made.payloads.bytes < 1.6 * len(mesh.vertices)  # of 20 bytes a vertex and 12 a face
    for camera in cameras:
        before, after = camera.project(mesh.vertices)[0], camera.project(found.vertices)[0]
        apart = np.linalg.norm(before[:, None] - after[None], axis=2).min(axis=1)
        assert apart.max() < 2 * DEPTH_ERROR_PX + 0.02


def test_other_meshes_are_no_relief():
    mesh = bumpy_square(20)
    assert mesh.uv is not None
    bent = replace(mesh, uv=(mesh.uv**2).astype(np.float32))
    assert relief_lattice(bent, row_grid(9), DEPTH_ERROR_PX) is None


def beside(mesh: Mesh, other: Mesh, part: float) -> Mesh:
    """Both in one atlas, the first in this part of its width and height."""
    assert mesh.uv is not None and other.uv is not None
    uv = np.concatenate([mesh.uv * part, other.uv * (1 - part) + part])
    faces = np.concatenate([mesh.faces, other.faces + len(mesh.vertices)])
    return Mesh(np.concatenate([mesh.vertices, other.vertices]), faces.astype(np.int32), uv.astype(np.float32))


def test_what_stands_before_a_relief_makes_it_none():
    """A chart that is no picture of the relief's camera cannot be simplified by depth alone. One that is, shifted, can,
    as a layer of the relief behind it."""
    cameras = row_grid(9)
    wall = relief(cameras[5], 0.5, False)
    thing = unwrap_mesh(Mesh((ball(level=2).vertices * 0.3 + (0, 0, 2)).astype(np.float32), ball(level=2).faces))
    assert relief_lattice(beside(wall, thing, 0.75), cameras, DEPTH_ERROR_PX) is None
    layer = replace(wall, vertices=(wall.vertices * 1.1 - 0.1 * cameras[5].centre).astype(np.float32))
    assert relief_lattice(beside(wall, layer, 0.5), cameras, DEPTH_ERROR_PX) is not None


@settings(max_examples=40)
@given(
    st.integers(120, 3000), st.floats(0.3, 1), st.floats(0, 0.6), st.sampled_from([1, 2, 4]), st.integers(0, 2**32 - 1)
)
@example(497, 0.5078125, 0.35107486324499243, 1, 28482)  # three peaks at the limit
def test_columns_are_found_however_many_vertices_stand_between_them(columns, part, between, cells, seed):
    """Rows of a canvas of so many columns that takes a part of the atlas; most flat places have vertices in every
    second or fourth column alone; those of contours stand on quarters."""
    rng = np.random.default_rng(seed)
    wide = int(columns * part)
    whole = np.concatenate([rng.integers(0, wide, 600), cells * rng.integers(0, wide // cells, 1400)])
    contours = rng.integers(0, 4 * wide, int(between * 2000)) / 4
    first = rng.uniform(0, 1 - part)
    values = (first + (np.concatenate([whole, contours]) + 0.5) / columns).astype(np.float32).astype(np.float64)
    found, near = 1 / _column_spacing(values) / columns, 0.02 / wide
    assert min(abs(found * finer - 1) for finer in (1, 2, 4, 1 / 2, 1 / 4)) < near
    assert abs(found - 1) < near or between > 0.2 or cells > 1  # else others are as good a guess


def test_vertices_in_no_columns():
    assert _column_spacing(np.random.default_rng(1).uniform(0, 1, 3000)) == 0
    assert _column_spacing(np.full(100, 0.5)) == 0
    assert _column_spacing(np.zeros(3)) == 0


def test_a_mesh_around_the_camera_goes_onto_a_grid_in_the_world():
    mesh = bumpy_square(20)
    K = np.array([[50.0, 0, 24], [0, 50.0, 20], [0, 0, 1]])
    inside = (Camera(K, np.eye(3), np.zeros(3), 48, 40), Camera(K, np.eye(3), np.array([0.1, 0, 0.0]), 48, 40))
    found = coded_mesh(relief_proxy(mesh, inside, DEPTH_ERROR_PX), inside, 0).value.mesh
    apart = np.linalg.norm(mesh.vertices[:, None] - found.vertices[None], axis=2).min(axis=1)
    assert apart.max() < 0.01


def test_sheets_keep_their_faces_and_one_of_no_size_is_left_out():
    scene = soft_scene()
    mesh, sheets, cameras = scene.proxy.mesh, scene.proxy.sheets, scene.rig.cameras
    assert sheets is not None
    made = coded_mesh(scene.proxy, cameras, 4).value
    assert made.sheets is not None and made.sheets.faces == sheets.faces and made.sheets.opacity is sheets.opacity
    vertices = mesh.vertices.copy()
    middle = np.unique(mesh.faces[242:370])
    vertices[middle] = vertices[middle[0]]
    made = coded_mesh(Proxy(replace(mesh, vertices=vertices), None, sheets), cameras, 4).value
    assert made.sheets is not None and made.sheets.faces == (242, 98) and len(made.mesh.faces) == 340
    assert made.mesh.uv is not None and made.mesh.uv[made.mesh.faces[242:], 0].min() > 2 / 3


def test_cameras_are_near_what_they_were():
    mesh, cameras = bumpy_square(), row_grid(9)
    random = np.random.default_rng(0)
    shaken = [replace(c, t=c.t + random.normal(0, 0.01, 3)) for c in cameras]
    found = coded_cameras(shaken, mesh, None)
    assert found.payloads.bytes < 12 * 4 * 9
    for before, after in zip(shaken, found.value, strict=True):
        moved = np.abs(before.project(mesh.vertices)[0] - after.project(mesh.vertices)[0])
        assert moved.max() < 4 * CAMERA_STEP_PX


def test_a_coded_scene_through_a_file(tmp_path):
    scene, path = coded_scene(), tmp_path / "coded.glb"
    save(scene, path)
    assert validate(path) == []
    back = ef.load(path)
    np.testing.assert_array_equal(back.proxy.mesh.vertices, scene.proxy.mesh.vertices)
    np.testing.assert_array_equal(back.proxy.mesh.faces, scene.proxy.mesh.faces)
    np.testing.assert_array_equal(back.proxy.mesh.uv, scene.proxy.mesh.uv)
    np.testing.assert_array_equal(
        back.appearance.planes[0].bases[0].weights, scene.appearance.planes[0].bases[0].weights
    )
    for one, two in zip(back.rig.cameras, scene.rig.cameras, strict=True):
        np.testing.assert_array_equal(one.matrix, two.matrix)
        assert (one.width, one.height) == (two.width, two.height)
    save(back, tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == path.read_bytes()
    save(replace(scene, payloads=Payloads()), tmp_path / "plain.glb")
    assert parts(path)["mesh"] < parts(tmp_path / "plain.glb")["mesh"] / 3


def test_streams_of_another_mesh_or_other_cameras_are_not_written(tmp_path):
    scene = coded_scene()
    assert cameras_key(scene.rig.cameras) in scene.payloads and mesh_key(scene.proxy.mesh) in scene.payloads
    turned = (*scene.rig.cameras[1:], scene.rig.cameras[0])
    for cameras in (
        turned,
        scene.rig.cameras[:-1],
        (replace(scene.rig.cameras[0], t=np.ones(3)), *scene.rig.cameras[1:]),
    ):
        assert cameras_key(cameras) not in scene.payloads
    path = tmp_path / "other.glb"
    save(replace(scene, proxy=Proxy(bumpy_square(12)), rig=replace(scene.rig, cameras=turned)), path)
    extension = extension_of(read_file(path))
    assert extension["needs"] == ["av1-10bit-2", "codedWeights", "stacks"] and "mesh" not in extension
    assert len(ef.load(path).proxy.mesh.faces) == len(bumpy_square(12).faces)


def test_the_mesh_for_other_viewers_is_coarse_and_textured():
    mesh = bumpy_square(40)
    coarse = coarse_mesh(mesh, 200)
    assert 100 < len(coarse.faces) <= 200 and coarse.uv is not None
    assert np.abs(coarse.vertices[:, :2] - (2 * coarse.uv - 1)).max() < 0.2  # about as in the fine one
    assert coarse_mesh(bumpy_square(4), 128).faces.shape == bumpy_square(4).faces.shape


def measured_scene() -> Scene:
    """Names with measured positions, as Stanford's have, of which no pattern is short."""
    scene = coded_scene()
    places = np.random.default_rng(4).normal(size=(9, 2, 24)).round(6)
    return replace(
        scene, rig=replace(scene.rig, names=tuple("_".join(f"{x:.6f}" for x in place.ravel()) for place in places))
    )


def test_names_with_measured_positions_are_coded(tmp_path):
    path = tmp_path / "measured.glb"
    save(measured_scene(), path)
    extension = extension_of(read_file(path))
    assert extension["version"] >= "1.6" and "codedNames" in extension["needs"]
    assert "names" not in extension["cameras"] and "pattern" not in extension["cameras"]
    assert ef.load(path).rig.names == measured_scene().rig.names
    assert not [finding for finding in validate(path) if finding.severity == "error"]
    save(coded_scene(), path, overwrite=True)
    extension = extension_of(read_file(path))
    assert "codedNames" not in extension["needs"] and "pattern" in extension["cameras"]


@pytest.mark.parametrize(
    ("change", "codes"),
    [
        (lambda e: e["codedNames"].update(bufferView=e["coded"]["bufferView"]), {"coded-damaged", "coded-truncated"}),
        (lambda e: e["codedNames"].update(count=8), {"coded-damaged"}),
        (lambda e: e["codedNames"].update(count=18), {"camera-count", "camera-name", "coded-damaged"}),
        (lambda e: e["codedNames"].update(count=0), {"json-value"}),
        (lambda e: e["codedNames"].pop("count"), {"json-missing"}),
    ],
)
def test_coded_names_that_cannot_be_are_refused(tmp_path, change, codes):
    path = tmp_path / "measured.glb"
    save(measured_scene(), path)
    glb = unpack(parse_glb(read_file(path)))
    change(glb.json["extensions"]["EIGENFIELD_eigen_textures"]["cameras"])
    with pytest.raises(FormatError) as caught:
        read_layout(Document(glb), Findings(strict=True))
    assert caught.value.code in codes


@pytest.mark.parametrize(
    ("change", "codes"),
    [
        (lambda e: e["mesh"].update(bufferView=e["cameras"]["coded"]["bufferView"]), {"coded-truncated"}),
        (lambda e: e["cameras"].update(coded=e["mesh"]["bufferView"]), {"coded-version"}),
        (lambda e: e["cameras"]["pattern"].update(counts=[8, 1]), {"camera-count"}),
        (lambda e: e["viewPlane"].update(codedTriangles=e["cameras"]["coded"]["bufferView"]), {"coded-version"}),
        (lambda e: e["planes"][0]["bases"][0].update(picture=[]), {"json-type"}),
        (lambda e: e["cameras"].update(size=[0, 40]), {"json-value"}),
        (lambda e: e["planes"][0]["bases"][0].update(codedWeights=e["mesh"]["bufferView"]),
         {"coded-version"}),
        (lambda e: e["planes"][0]["bases"][0]["textures"][0].update(scale=[1.0, 2.0]), {"json-value"}),
    ],
)  # fmt: skip
def test_streams_that_do_not_belong_are_refused(tmp_path, change, codes):
    path = tmp_path / "coded.glb"
    save(coded_scene(), path)
    glb = unpack(parse_glb(read_file(path)))
    change(glb.json["extensions"]["EIGENFIELD_eigen_textures"])
    with pytest.raises(FormatError) as caught:
        read_layout(Document(glb), Findings(strict=True))
    assert caught.value.code in codes


def test_the_coarse_mesh_of_many_pieces_is_coarse_and_lies_where_they_lie():
    """Two layers and islands, none of which a simplifier that keeps every piece can take away."""
    side = 12
    y, x = np.mgrid[0:side, 0:side] / (side - 1)
    corner = np.arange(side * side).reshape(side, side)
    quads = np.stack([corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    places = [(0.02, 0.02, 0.4, 0), (0.52, 0.02, 0.4, 1)] + [(0.01 * i, 0.9, 0.008, i % 2) for i in range(90)]
    vertices, texels = [], []
    for left, top, size, layer in places:
        u, v = left + size * x, top + size * y
        vertices.append(np.stack([u, v, 0.02 * np.sin(9 * u) + 0.1 * layer], axis=-1).reshape(-1, 3))
        texels.append(np.stack([u, v], axis=-1).reshape(-1, 2))
    triangles = np.concatenate([faces + number * side * side for number in range(len(places))])
    mesh = Mesh(
        np.concatenate(vertices).astype(np.float32), triangles.astype(np.int32),
        np.concatenate(texels).astype(np.float32),
    )  # fmt: skip
    coarse = coarse_mesh(mesh, 150)
    assert 20 < len(coarse.faces) <= 150
    known = {tuple(row) for row in np.concatenate([mesh.vertices, mesh.uv], axis=1).tolist()}
    assert {tuple(row) for row in np.concatenate([coarse.vertices, coarse.uv], axis=1).tolist()} <= known
    depth = coarse.vertices[coarse.faces][..., 2]
    assert np.ptp(depth, axis=1).max() < 0.06  # no triangle from one layer to the other


def test_what_pictures_of_several_textures_share_is_said_once(tmp_path):
    scene = coded(replace(tiny_scene(3, 24, 9, 64), proxy=Proxy(bumpy_square(40))), np.arange(9).reshape(3, 3))
    path = tmp_path / "shared.glb"
    save(scene, path)
    extension = extension_of(read_file(path))
    (basis,) = extension["planes"][0]["bases"]
    assert "sharedPicture" in extension["needs"] and validate(path) == []
    assert len(basis["textures"]) > 1 and all("mimeType" not in entry for entry in basis["textures"])
    back = ef.load(path).appearance.planes[0].bases[0]
    np.testing.assert_array_equal(back.values(), scene.appearance.planes[0].bases[0].values())
