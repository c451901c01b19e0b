"""What other viewers show of a coded mesh."""

import io
from dataclasses import replace

import cv2
import numpy as np
import pytest
import trimesh
from PIL import Image

import eigenfield as ef
from eigenfield.core.camera import Camera
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.fields import options_of
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.encoding import EncodeOptions
from eigenfield.gltf import encode_scene, parts, save, store_scores, validate
from eigenfield.gltf.coded_pictures import shown_mean
from eigenfield.gltf.container import parse_glb
from eigenfield.gltf.fallback import BUDGETS, SMALL, make_fallback, plain_bytes, with_fallback
from eigenfield.imaging.metrics import ssim
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import ViewWeights, renderer_of
from support import glb_surgery
from support.coded_scenes import coded_scene
from support.scenes import tiny_scene
from support.soft_scenes import coded_soft_scene

PLENTY = 10**6  # bytes of coded parts
SIDE = 256


def drawn(mesh: Mesh, picture: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """The mesh with a picture as a viewer shows it, and where there is any of it."""
    raster = rasterise_view(mesh, camera)
    covered = raster.face >= 0
    shares = raster.corner_shares(*np.nonzero(covered))
    uv = np.einsum("ni,nij->nj", shares, mesh.uv[mesh.faces[raster.face[covered]]])
    height, width = picture.shape[:2]
    found = np.zeros((*covered.shape, 3))
    at = np.clip(uv * (width, height), 0, (width - 1, height - 1)).astype(int)
    found[covered] = picture.reshape(height, width, -1)[at[:, 1], at[:, 0]] / 255
    return found, covered


def smooth_scene():
    """The coded scene, whose mean has one grain a texel, as pictures are: with shapes of a few texels."""
    scene = coded_scene()
    planes = tuple(
        replace(plane, mean=np.atleast_3d(cv2.GaussianBlur(plane.mean, (0, 0), 2.5)).astype(np.float32))
        for plane in scene.appearance.planes
    )
    return replace(scene, appearance=replace(scene.appearance, planes=planes))


def middle(scene, side: int = SIDE) -> Camera:
    camera = scene.rig.cameras[scene.rig.reference]
    scale = side / max(camera.width, camera.height)
    return replace(
        camera, K=np.diag([scale, scale, 1]) @ camera.K, width=round(camera.width * scale),
        height=round(camera.height * scale),
    )  # fmt: skip


def pieces_and_border(mesh: Mesh) -> tuple[int, int]:
    """Connected pieces, and closed lines of edges that one triangle has alone: 1 and 1 of a surface without holes."""
    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    lonely = whole.edges[trimesh.grouping.group_rows(whole.edges_sorted, require_count=1)]
    return len(whole.split(only_watertight=False)), len(trimesh.graph.connected_components(lonely))


@pytest.mark.parametrize(
    ("budget", "coded", "least"), [("small", PLENTY, 0.8), ("small", 100_000, 0.8), ("small", 60_000, 0.8),
                                   ("good", PLENTY, 0.93), ("good", 100_000, 0.9)],
)  # fmt: skip
def test_it_looks_like_the_mean_from_the_middle_and_has_no_holes(budget, coded, least):
    scene = with_fallback(smooth_scene(), budget)
    atlas = shown_mean(scene)
    mesh, picture = make_fallback(scene, atlas, coded)
    camera = middle(scene)
    shown, there = drawn(mesh, np.asarray(Image.open(io.BytesIO(picture.data)).convert("RGB")), camera)
    meant, covered = drawn(scene.proxy.mesh, atlas, camera)
    assert (there & covered).sum() > 0.97 * covered.sum()
    assert ssim(shown, meant, there & covered) > least
    assert pieces_and_border(mesh) == (1, 1)


def test_it_takes_its_part_of_the_bytes():
    scene = coded_scene()
    sizes = []
    for coded in (10, 50_000, 100_000, PLENTY):
        mesh, picture = make_fallback(scene, shown_mean(scene), coded)
        sizes.append(plain_bytes(mesh) + len(picture.data))
        assert len(mesh.vertices) <= 1.4 * SMALL.sizes[0].points
        if coded > 10:
            assert sizes[-1] <= 0.06 * coded
    assert sizes == sorted(sizes) and sizes[0] < 2_500 < sizes[-1]


@pytest.mark.slow
def test_good_takes_at_most_a_quarter():
    scene, sizes = with_fallback(coded_scene(), "good"), []
    for coded in (20_000, 100_000, 400_000):
        mesh, picture = make_fallback(scene, shown_mean(scene), coded)
        sizes.append(plain_bytes(mesh) + len(picture.data))
        assert sizes[-1] <= 0.25 * coded
    assert sizes == sorted(sizes) and sizes[0] > 1_200


def test_none_shows_others_nothing_and_is_the_same_scene(tmp_path):
    scene = coded_scene()
    save(scene, tmp_path / "bare.glb", fallback="none")
    save(scene, tmp_path / "small.glb")
    assert validate(tmp_path / "bare.glb") == []
    found = parse_glb((tmp_path / "bare.glb").read_bytes()).json
    assert not {"meshes", "materials", "textures", "samplers", "images"} & found.keys()
    assert not any("mesh" in node for node in found["nodes"])
    bare, small = ef.load(tmp_path / "bare.glb"), ef.load(tmp_path / "small.glb")
    np.testing.assert_array_equal(bare.proxy.mesh.vertices, small.proxy.mesh.vertices)
    np.testing.assert_array_equal(ef.render(bare).image, ef.render(small).image)
    sizes, whole = parts(tmp_path / "bare.glb"), parts(tmp_path / "small.glb")
    assert sizes["total"] == sum(bytes for part, bytes in sizes.items() if part != "total") < whole["total"] - 1_500
    assert sizes["textures"] == whole["textures"] and sizes["mean"] < whole["mean"]
    store_scores(tmp_path / "bare.glb", {"psnr": 30})
    assert ef.load(tmp_path / "bare.glb").scores == {"psnr": 30} and validate(tmp_path / "bare.glb") == []


def test_a_mesh_that_is_missing_and_not_coded_is_a_fault(tmp_path):
    path = tmp_path / "plain.glb"
    save(tiny_scene(), path)
    gltf, binary = glb_surgery.split(path.read_bytes())
    del gltf["meshes"]
    path.write_bytes(glb_surgery.join(gltf, binary))
    with pytest.raises(FormatError, match="meshes"):
        ef.load(path)


def test_what_no_fallback_is_called_is_refused_by_name(tmp_path):
    with pytest.raises(OptionError, match="small, good, none"):
        save(coded_scene(), tmp_path / "a.glb", fallback="big")
    assert not list(tmp_path.iterdir())
    (choices,) = (one.choices for name, one in options_of(EncodeOptions) if name == "fallback")
    assert choices == tuple(BUDGETS)
    with pytest.raises(OptionError, match="--fit none has no fallback"):
        EncodeOptions(fit="none", fallback="good")


def test_a_far_view_of_it_lies_where_the_surface_lies():
    """Its points are on the surface, up to what smoothing takes off."""
    scene = coded_scene()
    mesh, _ = make_fallback(scene, shown_mean(scene), PLENTY)
    fine = scene.proxy.mesh
    distance = np.linalg.norm(mesh.vertices[:, None] - fine.vertices[fine.faces].mean(axis=1), axis=2).min(axis=1)
    assert np.quantile(distance, 0.9) < 0.05 * np.ptp(scene.proxy.mesh.vertices, axis=0).max()


def test_sheets_are_one_surface_without_holes(tmp_path):
    path = tmp_path / "sheets.glb"
    save(coded_soft_scene(), path)
    assert validate(path) == []
    (shown,) = trimesh.load(path).geometry.values()
    mesh = Mesh(np.asarray(shown.vertices, np.float32), np.asarray(shown.faces, np.int32))
    assert pieces_and_border(mesh) == (1, 1)
    assert shown.visual.material.alphaMode in (None, "OPAQUE")


def test_sheets_look_like_their_mean_as_the_scene_draws_it():
    scene = coded_soft_scene()
    camera, atlas = middle(scene), shown_mean(scene)
    mean = renderer_of(scene).draw(camera, ViewWeights(), textures=0)
    for budget, least in (("small", 0.6), ("good", 0.7)):
        mesh, picture = make_fallback(with_fallback(scene, budget), atlas, PLENTY)
        shown, there = drawn(mesh, np.asarray(Image.open(io.BytesIO(picture.data)).convert("RGB")), camera)
        found = ssim(shown, mean.image, there & (mean.coverage > 0.9))
        assert found is not None and found > least, (budget, found)


def test_cameras_that_look_several_ways_get_the_mesh_itself():
    scene = coded_scene()
    around = np.array([(0.0, 0, 1), (0, 1, 0), (-1, 0, 0)])
    turned = (*scene.rig.cameras[:-1], replace(scene.rig.cameras[-1], R=around @ scene.rig.cameras[-1].R))
    walk = replace(scene, rig=replace(scene.rig, cameras=turned))
    atlas = shown_mean(walk)
    mesh, picture = make_fallback(walk, atlas, PLENTY)
    corners = {tuple(corner) for corner in scene.proxy.mesh.uv.tolist()}
    assert {tuple(corner) for corner in mesh.uv.tolist()} <= corners
    height, width = Image.open(io.BytesIO(picture.data)).size[::-1]
    assert height * atlas.shape[1] == pytest.approx(width * atlas.shape[0], rel=0.05)


def test_a_reference_camera_that_sees_nothing_is_no_error():
    scene = coded_scene()
    behind = scene.proxy.mesh.vertices.copy()
    centre = scene.rig.cameras[scene.rig.reference].centre
    mesh = replace(scene.proxy.mesh, vertices=(2 * centre - behind).astype(np.float32))
    found, picture = make_fallback(replace(scene, proxy=Proxy(mesh)), shown_mean(scene), PLENTY)
    assert len(found.faces) and picture.data


@pytest.mark.slow
@pytest.mark.parametrize("budget", BUDGETS)
def test_a_file_that_is_written_again_keeps_it(tmp_path, budget):
    scene = coded_scene()
    first = encode_scene(with_fallback(scene, budget))
    assert (first == encode_scene(scene)) == (budget == "small")
    path = tmp_path / "scene.glb"
    path.write_bytes(first)
    assert encode_scene(ef.load(path)) == first
