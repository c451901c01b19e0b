"""What the exports hold: other programs read them, and find there what the scene draws."""

from __future__ import annotations

import base64
import json
from dataclasses import replace

import cv2
import numpy as np
import pycolmap
import pytest
import trimesh
from PIL import Image

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.gltf import encode_scene, save
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.gltf.container import parse_glb
from eigenfield.proxy import read_mesh
from eigenfield.rendering import RenderJob, draw_texture, mean_texture, renderer_of, view_weights
from eigenfield.rendering import texture as texture_of
from eigenfield.rendering.weights import encoded_places
from eigenfield.viewer import exports
from eigenfield.viewer.exports.quilt import quilt_views
from support.composed import layered_scene
from support.scenes import tiny_scene
from support.soft_scenes import soft_scene


def pixels(path):
    with Image.open(path) as picture:
        return np.asarray(picture).astype(np.float32) / 255


def turned_away(scene):
    """The scene in another world: rotated, so that no axis of the capture is one of a viewer's."""
    from scipy.spatial.transform import Rotation

    from eigenfield.core.viewplane import fit_view_plane

    R = Rotation.from_euler("xyz", [70, -40, 25], degrees=True).as_matrix()
    cameras = tuple(replace(camera, R=camera.R @ R.T) for camera in scene.rig.cameras)
    mesh = Mesh((scene.proxy.mesh.vertices @ R.T).astype(np.float32), scene.proxy.mesh.faces, scene.proxy.mesh.uv)
    return replace(
        scene, proxy=Proxy(mesh), rig=replace(scene.rig, cameras=cameras, view_plane=fit_view_plane(cameras))
    )


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """Cameras of `tiny_scene` look along +z with y down; here they look somewhere else."""
    path = tmp_path_factory.mktemp("scene") / "scene.glb"
    save(turned_away(tiny_scene(cameras=9, held_out=(4,))), path, codec="png")
    return ef.load(path)


@pytest.fixture(scope="module")
def fitted(fitted):
    return ef.load(fitted[1])


def test_the_glb_opens_upright_in_trimesh(scene, tmp_path):
    save(scene, tmp_path / "a.glb", codec="png")
    opened = trimesh.load(tmp_path / "a.glb")
    proxy = next(name for name in opened.graph.nodes_geometry)
    turn, name = opened.graph[proxy]
    mesh = opened.geometry[name]
    np.testing.assert_allclose(mesh.visual.uv * [1, -1] + [0, 1], scene.proxy.mesh.uv, atol=1e-6)
    picture = np.asarray(mesh.visual.material.baseColorTexture).astype(np.float32) / 255
    np.testing.assert_allclose(picture, scene.appearance.planes[0].mean, atol=1e-6)
    up = np.mean([-camera.R[1] for camera in scene.rig.cameras], axis=0)
    forward = np.mean([camera.R[2] for camera in scene.rig.cameras], axis=0)
    np.testing.assert_allclose(turn[:3, :3] @ up, [0, 1, 0], atol=1e-5)
    np.testing.assert_allclose(turn[:3, :3] @ forward, [0, 0, -1], atol=1e-5)


@pytest.mark.parametrize("folder", [False, True])
def test_the_obj_opens_in_trimesh_and_draws_the_mean(scene, tmp_path, folder):
    if folder:
        exports.write_obj_folder(scene, tmp_path / "it")
        path = tmp_path / "it" / "mesh.obj"
    else:
        path = tmp_path / "a name #1.obj"
        exports.write_obj(scene, path)
        assert {p.name for p in tmp_path.iterdir()} == {"a name #1.obj", "a_name__1.mtl", "a_name__1.png"}
    opened = trimesh.load(path, process=False)
    assert opened.faces.shape == scene.proxy.mesh.faces.shape
    turn = capture_to_gltf(scene.rig)
    texture = np.asarray(opened.visual.material.image).astype(np.float32) / 255
    np.testing.assert_allclose(texture, scene.appearance.planes[0].mean, atol=0.5 / 255 + 1e-6)
    uv = np.column_stack([opened.visual.uv[:, 0], 1 - opened.visual.uv[:, 1]]).astype(np.float32)
    mesh = Mesh((opened.vertices @ turn).astype(np.float32), opened.faces.astype(np.int32), uv)
    camera = scene.rig.cameras[0]
    expected = draw_texture(scene.proxy.mesh, scene.appearance.planes[0].mean, camera)
    drawn = draw_texture(mesh, texture, camera)
    np.testing.assert_allclose(drawn.image, expected.image, atol=0.01)
    np.testing.assert_array_equal(drawn.coverage, expected.coverage)
    up = np.mean([-camera.R[1] for camera in scene.rig.cameras], axis=0)
    np.testing.assert_allclose(turn @ up, [0, 1, 0], atol=1e-5)
    again = read_mesh(path)  # our own reader of OBJ
    np.testing.assert_allclose(again.vertices @ turn, scene.proxy.mesh.vertices, atol=1e-5)


def test_eigen_textures_beside_the_obj_make_every_camera_s_map(scene, tmp_path):
    exports.write_obj_folder(scene, tmp_path / "it")
    listing = json.loads((tmp_path / "it" / "eigenfield.json").read_text(encoding="utf-8"))
    mean = pixels(tmp_path / "it" / listing["mean"])
    assert list(listing["weights"]) == [scene.rig.names[i] for i in scene.rig.encoded]
    for name, weights in listing["weights"].items():
        texture = mean.astype(float)
        for weight, entry in zip(weights, listing["textures"], strict=True):
            codes = np.round(pixels(tmp_path / "it" / entry["file"]) * 255).reshape(*mean.shape[:2], -1)
            assert codes.shape[2] == len(entry["scale"]) == len(entry["zero"])
            texture += weight * (codes - entry["zero"]) * entry["scale"]
        np.testing.assert_allclose(texture, texture_of(scene, name), atol=1e-5)
    places = np.array(listing["places"])
    np.testing.assert_allclose(places, encoded_places(scene))
    assert listing["triangles"] == scene.rig.triangles.tolist() and listing["sheets"] == []
    plane, turn = listing["viewPlane"], np.array(listing["toCapture"])
    centres = np.array([scene.rig.cameras[i].centre for i in scene.rig.encoded]) @ turn
    np.testing.assert_allclose((centres[:, :2] - plane["origin"][:2]) / plane["extent"], places, atol=1e-9)
    reference = scene.rig.cameras[scene.rig.reference]
    np.testing.assert_allclose(turn @ listing["camera"]["translation"], reference.centre, atol=1e-9)
    exports.write_obj_folder(scene, tmp_path / "two", textures=2)
    assert len(list((tmp_path / "two").glob("eigen_*.png"))) == 2


@pytest.mark.parametrize("kind", ["fitted", "layered"])
def test_planes_become_eigen_textures_of_red_green_and_blue_beside_the_obj(fitted, tmp_path, kind):
    """Luma and chroma, of sizes and regions of their own, as pictures of the whole atlas that sum to the same maps.
    Those of luma are grey."""
    made = fitted if kind == "fitted" else layered_scene()
    exports.write_obj(made, tmp_path / "alone.obj")
    exports.write_obj_folder(made, tmp_path / "it")
    listing = json.loads((tmp_path / "it" / "eigenfield.json").read_text(encoding="utf-8"))
    mean = pixels(tmp_path / "it" / listing["mean"])
    assert mean.shape == (*made.appearance.atlas, 3) and (pixels(tmp_path / "alone.png") == mean).all()
    np.testing.assert_allclose(mean, mean_texture(made).clip(0, 1), atol=0.51 / 255)
    bases = [basis for plane in made.appearance.planes for basis in plane.bases]
    assert len(listing["textures"]) == sum(basis.count for basis in bases)
    for name, weights in listing["weights"].items():
        texture, off = mean_texture(made).astype(float), 1e-5
        for weight, entry in zip(weights, listing["textures"], strict=True):
            codes = np.round(pixels(tmp_path / "it" / entry["file"]) * 255).reshape(*mean.shape[:2], -1)
            assert codes.shape[2] == len(entry["scale"]) == len(entry["zero"])
            texture += weight * (codes - entry["zero"]) * entry["scale"]
            off += 0.501 * abs(weight) * max(entry["scale"])  # half a code
        np.testing.assert_allclose(texture, texture_of(made, name), atol=off)
    grey = sum(basis.count for plane in made.appearance.planes[:1] for basis in plane.bases)
    channels = [len(entry["scale"]) for entry in listing["textures"]]
    assert channels == grey * [1] + (len(channels) - grey) * [3]
    exports.write_obj_folder(made, tmp_path / "one", textures=1)
    kept = sum(basis.count > 0 for basis in bases)
    assert len(list((tmp_path / "one").glob("eigen_*.png"))) == kept


def test_a_fitted_scene_makes_a_colmap_model_of_its_colours(fitted, tmp_path):
    exports.write_colmap(RenderJob(fitted), tmp_path / "model")
    model = pycolmap.Reconstruction(tmp_path / "model" / "sparse" / "0")
    colours = np.array([point.color for point in model.points3D.values()])
    assert len(colours) > 100
    wanted = 255 * mean_texture(fitted).reshape(-1, 3)
    assert np.abs(colours.mean(axis=0) - wanted.mean(axis=0)).max() < 12


def test_maps_are_equation_8_over_the_whole_atlas(scene, tmp_path):
    """Also on tiles that the mesh does not use: here it lies on half of the atlas."""
    half = Mesh(scene.proxy.mesh.vertices, scene.proxy.mesh.faces, scene.proxy.mesh.uv * np.array([0.4, 1], np.float32))
    scene = replace(scene, proxy=Proxy(half))
    for count in (None, 0, 2):
        folder = tmp_path / str(count)
        exports.write_maps(scene, folder, textures=count)
        listing = json.loads((folder / "eigenfield.json").read_text(encoding="utf-8"))["maps"]
        assert list(listing) == [scene.rig.names[i] for i in scene.rig.encoded]
        basis = scene.appearance.planes[0].bases[0].truncate(scene.appearance.textures if count is None else count)
        for row, file in enumerate(listing.values()):
            expected = scene.appearance.planes[0].mean + np.tensordot(basis.weights[row], basis.values(), 1)
            np.testing.assert_allclose(pixels(folder / file), expected.clip(0, 1), atol=0.51 / 255)


def test_sheets_have_their_opacity_as_alpha(tmp_path):
    scene = soft_scene()
    exports.write_obj(scene, tmp_path / "a.obj")
    exports.write_obj_folder(scene, tmp_path / "obj")
    exports.write_maps(scene, tmp_path / "maps")
    listing = json.loads((tmp_path / "maps" / "eigenfield.json").read_text(encoding="utf-8"))
    maps = [pixels(tmp_path / "maps" / file) for file in listing["maps"].values()]
    means = [pixels(tmp_path / "a.png"), pixels(tmp_path / "obj" / "mean.png")]
    assert np.array_equal(*means) and {one.shape for one in (*maps, *means)} == {(96, 96, 4)}
    for one in (*maps, *means):
        np.testing.assert_array_equal(one[..., 3], means[0][..., 3])
    np.testing.assert_allclose(means[0][..., :3], mean_texture(scene).clip(0, 1), atol=0.51 / 255)
    opacity = cv2.resize(scene.proxy.sheets.opacity, (96, 96))  # of 128 columns
    np.testing.assert_allclose(means[0][..., 3], opacity, atol=0.15)
    assert np.abs(means[0][..., 3] - opacity).mean() < 0.01
    assert "map_d a.png" in (tmp_path / "a.mtl").read_text() and "map_d" in (tmp_path / "obj" / "mesh.mtl").read_text()
    assert trimesh.load(tmp_path / "a.obj", process=False).faces.shape == (468, 3)
    grey = soft_scene(1)
    exports.write_obj(grey, tmp_path / "grey.obj")
    np.testing.assert_array_equal(pixels(tmp_path / "grey.png")[..., 0], pixels(tmp_path / "grey.png")[..., 2])


def test_what_sheets_hardly_show_has_no_points(tmp_path):
    scene = soft_scene()
    exports.write_colmap(RenderJob(scene), tmp_path / "all")
    points = np.array(
        [point.xyz for point in pycolmap.Reconstruction(tmp_path / "all" / "sparse" / "0").points3D.values()]
    )
    disc = points[np.abs(points[:, 2] - 0.1) < 0.15]
    assert len(points) > 1000 and len(disc) > 100 and (np.hypot(*disc[:, :2].T) < 0.9).all()


def opened(path):
    """Primitives in their order, and the picture and the alpha mode of the material, as trimesh reads a .glb."""
    parts = list(trimesh.load(path, process=False, maintain_order=True).geometry.values())
    material = parts[0].visual.material
    return parts, np.asarray(material.baseColorTexture).astype(np.float32) / 255, material.alphaMode


@pytest.mark.parametrize("draco", [False, True])
def test_a_plain_glb_is_the_proxy_with_its_mean_upright_and_in_metres(scene, tmp_path, draco):
    scene = replace(scene, settings={**scene.settings, "metresPerUnit": 0.25, "origin": [100.0, 0.0, 0.0]})
    exports.write_glb(scene, tmp_path / "a.glb", draco=draco)
    (mesh,), picture, mode = opened(tmp_path / "a.glb")
    np.testing.assert_array_equal(picture, np.rint(255 * mean_texture(scene).clip(0, 1)).astype(np.float32) / 255)
    assert mode in (None, "OPAQUE") and mesh.faces.shape == scene.proxy.mesh.faces.shape
    turn = capture_to_gltf(scene.rig)
    found = read_mesh(tmp_path / "a.glb")  # by our own reader, which places it as its node says
    off = np.abs(found.vertices[found.faces] - 0.25 * (scene.proxy.mesh.vertices @ turn.T)[scene.proxy.mesh.faces])
    assert draco or off.max() < 1e-5
    low, high = (0.25 * (scene.proxy.mesh.vertices @ turn.T)[:, None]).min(0), found.vertices.min(axis=0)
    np.testing.assert_allclose(low[0], high, atol=1e-4)
    gltf = parse_glb((tmp_path / "a.glb").read_bytes()).json
    assert [node["name"] for node in gltf["nodes"]] == ["proxy", "reference camera"]
    assert gltf["nodes"][0]["extras"] == {"origin": [100, 0, 0]}
    centre = scene.rig.cameras[scene.rig.reference].centre
    np.testing.assert_allclose(gltf["nodes"][1]["translation"], 0.25 * turn @ centre, atol=1e-6)
    exports.write_glb(scene, tmp_path / "b.glb", draco=draco, metres_per_unit=2.0)
    np.testing.assert_allclose(read_mesh(tmp_path / "b.glb").vertices, 8 * found.vertices, atol=1e-4)


@pytest.mark.parametrize(("image", "most"), [("png", 0.5 / 255), ("jpeg", 0.04), ("webp", 0.06)])
def test_a_plain_glb_has_the_texture_of_a_viewpoint(fitted, tmp_path, image, most):
    exports.write_glb(fitted, tmp_path / "a.glb", at=(0.6, -0.4), image=image)
    _, picture, _ = opened(tmp_path / "a.glb")
    place = view_weights(fitted, (0.6, -0.4))
    expected = sum(
        value * texture_of(fitted, fitted.names[row])
        for row, value in zip(place.rows.tolist(), place.values.tolist(), strict=True)
    )
    assert np.abs(picture - expected.clip(0, 1)).mean() < most
    assert np.abs(expected - mean_texture(fitted)).max() > 0.01  # it is not the mean's


def test_sheets_of_a_plain_glb_are_blended_back_to_front(tmp_path):
    scene = soft_scene()
    exports.write_glb(scene, tmp_path / "a.glb")
    exports.write_obj(scene, tmp_path / "a.obj")
    parts, picture, mode = opened(tmp_path / "a.glb")
    assert [len(part.faces) for part in parts] == list(scene.proxy.sheets.faces) and mode == "BLEND"
    np.testing.assert_array_equal(picture, pixels(tmp_path / "a.png"))
    exports.write_glb(scene, tmp_path / "b.glb", image="webp", draco=True)
    parts, lossy, mode = opened(tmp_path / "b.glb")
    assert [len(part.faces) for part in parts] == list(scene.proxy.sheets.faces) and mode == "BLEND"
    np.testing.assert_array_equal(lossy[..., 3], picture[..., 3])
    with pytest.raises(OptionError, match="a JPEG has none"):
        exports.write_glb(scene, tmp_path / "c.glb", image="jpeg")
    assert not (tmp_path / "c.glb").exists()


def test_a_grey_scene_and_attributes_as_a_plain_glb(tmp_path):
    for image in ("png", "jpeg", "webp"):
        ef.export(tiny_scene(1), tmp_path / f"{image}.glb", image=image)
        assert read_mesh(tmp_path / f"{image}.glb").uv is not None
    with pytest.raises(OptionError, match="picture"):
        ef.export(tiny_scene(6), tmp_path / "six.glb")
    with pytest.raises(OptionError, match="at of write_glb"):
        ef.export(tiny_scene(), tmp_path / "word.glb", at="left")


def test_a_quilt_begins_at_the_bottom_left_with_the_leftmost_view(scene, tmp_path):
    job = RenderJob(scene)
    quilt = exports.quilt_of(scene, (4, 3), (30, 40), 0.8)
    path = exports.write_quilt(job, quilt, tmp_path / "q.png")
    assert path.name == "q_qs4x3a0.75.png"
    whole = pixels(path)
    assert whole.shape == (120, 120, 3)
    views = quilt_views(job, quilt)
    places = scene.rig.view_plane.coordinates([camera.centre for camera, _ in views])
    np.testing.assert_allclose(places, np.column_stack([np.linspace(-0.8, 0.8, 12), np.zeros(12)]), atol=1e-9)
    for number, (camera, weights) in enumerate(views):
        row, column = 2 - number // 4, number % 4  # from the top
        tile = whole[40 * row : 40 * row + 40, 30 * column : 30 * column + 30]
        np.testing.assert_allclose(tile, renderer_of(scene).draw(camera, weights).image.clip(0, 1), atol=0.51 / 255)
        expected = view_weights(scene, tuple(places[number])).dense(scene.observations)
        np.testing.assert_allclose(weights.dense(scene.observations), expected, atol=1e-9)


def test_a_quilt_converges_on_the_scene_and_moves_sideways_only(scene):
    """What is nearer than the plane of the display moves left as the eye moves right, what is farther to the right;
    nothing moves up or down."""
    views = quilt_views(RenderJob(scene), exports.quilt_of(scene, (5, 1)))
    axes = views[0][0].R
    middle = scene.proxy.mesh.vertices.astype(float).mean(axis=0)
    nearer, farther = middle - axes[2], middle + axes[2]
    for point, sign in ((nearer, -1), (farther, 1)):
        at = np.array([camera.project(point[None])[0][0] for camera, _ in views])
        assert (np.diff(at[:, 0]) * sign > 0.5).all()
        np.testing.assert_allclose(at[:, 1], at[0, 1], atol=1e-6)
    still = np.array([camera.project(middle[None])[0][0] for camera, _ in views])
    assert np.ptp(still[:, 0]) < 3  # the median depth is not quite the middle's


def test_quilts_fit_players_and_say_what_cannot_be(scene):
    large = replace(
        scene, rig=replace(scene.rig, cameras=tuple(camera.resize(4000, 3000) for camera in scene.rig.cameras))
    )
    quilt = exports.quilt_of(large)
    assert (quilt.columns, quilt.rows) == (8, 6) and 8 * quilt.width == 4096 and 6 * quilt.height <= 4096
    assert quilt.suffix == "_qs8x6a1.333"
    same = quilt_views(RenderJob(scene), exports.quilt_of(scene, (2, 2), spread=0))
    assert len({tuple(camera.centre) for camera, _ in same}) == 1
    tall = tiny_scene(cameras=3)  # a row of cameras, turned by a quarter: one above the other
    quarter = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    turned = tuple(replace(c, R=quarter @ c.R, t=quarter @ c.t) for c in tall.rig.cameras)
    with pytest.raises(OptionError, match="side by side"):
        quilt_views(RenderJob(replace(tall, rig=replace(tall.rig, cameras=turned))), exports.quilt_of(tall))


def test_a_colmap_folder_is_read_back_and_shows_what_is_drawn(scene, tmp_path):
    exports.write_colmap(RenderJob(scene), tmp_path / "capture")
    capture = open_capture(tmp_path / "capture")
    assert capture.format == "colmap" and capture.problems == ()
    assert capture.names == tuple(f"{name}.png" for name in scene.rig.names)
    for index, (name, camera) in enumerate(zip(scene.rig.names, scene.rig.cameras, strict=True)):
        found = capture.cameras[index]
        np.testing.assert_allclose(found.matrix, camera.matrix, atol=1e-6)
        expected = ef.render(scene, camera=name).to_uint8()
        np.testing.assert_array_equal(np.round(capture.photograph(index).pixels * 255), expected)
    listing = json.loads((tmp_path / "capture" / "eigenfield.json").read_text(encoding="utf-8"))
    assert listing["heldOut"] == ["view_04.png"]


def test_pycolmap_reads_the_model_and_its_points_lie_on_the_mesh(scene, tmp_path):
    exports.write_colmap(RenderJob(scene), tmp_path / "capture")
    model = pycolmap.Reconstruction(tmp_path / "capture" / "sparse" / "0")
    assert model.num_images() == 9 and model.num_points3D() > 5000
    for point in list(model.points3D.values())[:: len(model.points3D) // 50]:
        assert 2 <= len(point.track.elements) <= 8
        for element in point.track.elements:
            image = model.images[element.image_id]
            np.testing.assert_allclose(
                image.project_point(point.xyz), image.points2D[element.point2D_idx].xy, atol=1e-6
            )
    colours = np.array([point.color for point in model.points3D.values()])
    assert np.ptp(colours) > 100  # the mean's, which is not grey


def test_other_sizes_viewpoints_and_backgrounds_of_a_colmap_folder(scene, tmp_path):
    job = RenderJob(scene, resolution=(30, 20), background=None)
    exports.write_colmap(job, tmp_path / "path", points=np.array([[0.0, 0.0], [0.4, -0.3], [-0.5, 0.5]]))
    capture = open_capture(tmp_path / "path")
    assert capture.names == ("path_0000.png", "path_0001.png", "path_0002.png")
    assert (capture.cameras[0].width, capture.cameras[0].height) == (30, 20)
    with Image.open(tmp_path / "path" / "images" / "path_0000.png") as picture:
        assert picture.mode == "RGBA"
    skewed = tuple(replace(c, K=c.K + np.array([[0, 2.0, 0], [0, 0, 0], [0, 0, 0]])) for c in scene.rig.cameras)
    exports.write_colmap(RenderJob(replace(scene, rig=replace(scene.rig, cameras=skewed))), tmp_path / "skew")
    assert len(open_capture(tmp_path / "skew")) == 9


def test_captured_cameras_have_their_own_exposure(scene, tmp_path):
    colours = np.tile(np.array([[1.0] * 3, [0.0] * 3], np.float32), (9, 1, 1))
    colours[0] = [[1.3, 1.2, 1.1], [0.02, 0, -0.02]]
    harmonised = replace(scene, appearance=replace(scene.appearance, colours=colours))
    exports.write_colmap(RenderJob(harmonised), tmp_path / "capture")
    expected = ef.render(harmonised, camera=scene.rig.names[0]).to_uint8()
    drawn = pixels(tmp_path / "capture" / "images" / f"{scene.rig.names[0]}.png")
    np.testing.assert_array_equal(np.round(drawn * 255), expected)


def test_grey_scenes_are_pictures_and_other_attributes_are_not(tmp_path):
    grey = tiny_scene(channels=1)
    exports.write_maps(grey, tmp_path / "maps")
    exports.write_obj_folder(grey, tmp_path / "obj")
    exports.write_colmap(RenderJob(grey), tmp_path / "colmap")
    exports.write_quilt(RenderJob(grey), exports.quilt_of(grey, (2, 2)), tmp_path / "q.png")
    assert len(open_capture(tmp_path / "colmap")) == 5
    other = tiny_scene(channels=6)
    for write in (
        lambda: exports.write_maps(other, tmp_path / "a"),
        lambda: exports.write_obj(other, tmp_path / "a.obj"),
        lambda: exports.write_obj_folder(other, tmp_path / "a"),
        lambda: exports.write_colmap(RenderJob(other), tmp_path / "a"),
        lambda: exports.write_guests_page(other, tmp_path / "a.html"),
        lambda: exports.write_quilt(RenderJob(other), exports.quilt_of(other), tmp_path / "a.png"),
    ):
        with pytest.raises(OptionError, match="no picture"):
            write()
    assert {path.name for path in tmp_path.iterdir()} == {"maps", "obj", "colmap", "q_qs2x2a1.2.png"}
    exports.export(other, tmp_path / "a.html", laboratory=True)
    exports.export(other, tmp_path / "open", "app")
    assert not list((tmp_path / "open").rglob("*.jpg")) and list((tmp_path / "open").rglob("*.glb"))


def test_the_page_has_the_file_inside_and_no_title_escapes(scene, tmp_path):
    exports.write_page(scene, tmp_path / "a.html", title="</title><script>alert(1)</script>", metres_per_unit=2.5)
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<script>alert" not in page and '"metresPerUnit":2.5' in page
    start = page.index('id="eigenfield-scene">') + len('id="eigenfield-scene">')
    (tmp_path / "again.glb").write_bytes(base64.b64decode(page[start : page.index("<", start)]))
    assert ef.load(tmp_path / "again.glb").rig.names == scene.rig.names
    loose = tiny_scene()
    exports.write_page(loose, tmp_path / "b.html")
    assert base64.b64encode(encode_scene(loose)).decode() in (tmp_path / "b.html").read_text(encoding="utf-8")
