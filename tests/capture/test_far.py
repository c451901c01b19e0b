"""Worlds far from their origin: cameras and mesh move to it together, and what is written stands where it stood."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eigenfield.capture import open_capture
from eigenfield.capture.points import SparsePoints
from eigenfield.capture.writers.save import save_calibration
from eigenfield.encoding import encode
from eigenfield.gltf import load, save
from eigenfield.proxy import read_mesh, write_mesh
from eigenfield.proxy.primitives.shapes import parse_primitive
from eigenfield.rendering import RenderJob
from eigenfield.viewer import exports
from support.captures import write_capture
from support.program import call

FAR = {
    "UTM": np.array([448_262.123, 5_411_933.456, 307.789]),
    "ECEF": np.array([-2_703_115.5, -4_262_080.25, 3_887_374.125]),
    "one axis": np.array([0.0, 0.0, -80_000.0]),
}


def write_both(folder, shift):
    """The same capture about the origin and far from it, with a mesh of doubles."""
    near = write_capture(folder / "near")
    mesh = read_mesh(near / "proxy.ply")
    far = folder / "far"
    (far / "images").mkdir(parents=True)
    for path in (near / "images").iterdir():
        (far / "images" / path.name).write_bytes(path.read_bytes())
    document = json.loads((near / "transforms.json").read_text())
    for frame in document["frames"]:
        for axis in range(3):
            frame["transform_matrix"][axis][3] += shift[axis]
    (far / "transforms.json").write_text(json.dumps(document))
    lines = ["ply", "format ascii 1.0", f"element vertex {len(mesh.vertices)}"]
    lines += [f"property double {axis}" for axis in "xyzst"]
    lines += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header"]
    table = np.hstack([mesh.vertices.astype(np.float64) + shift, mesh.uv[:, :1], 1 - mesh.uv[:, 1:]])
    lines += [" ".join(map(repr, row)) for row in table.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist()]
    (far / "proxy.ply").write_text("\n".join(lines) + "\n")
    return near, far


@pytest.mark.parametrize("name", FAR)
def test_the_scene_is_that_of_the_same_world_about_its_origin(tmp_path, name, caplog):
    near, far = write_both(tmp_path, FAR[name])
    one, other = open_capture(near), open_capture(far)
    assert not one.origin.any() and not one.problems
    shift = FAR[name] - other.origin
    assert np.abs(shift).max() < 10 and "georeferenced" in other.problems[0]
    for a, b in zip(one.cameras, other.cameras, strict=True):
        assert np.abs(b.centre - a.centre - shift).max() < 2e-8 and np.array_equal(a.K, b.K)
    mesh = read_mesh(far / "proxy.ply", other.origin)
    assert np.abs(mesh.vertices - read_mesh(near / "proxy.ply").vertices - shift).max() < 2e-6

    options = {"fit": "none", "textures": 1, "atlas": 64}
    scenes = [encode(capture, folder / "proxy.ply", **options) for capture, folder in ((one, near), (other, far))]
    assert "far from the origin" not in caplog.text and "float32" not in caplog.text
    means = [scene.appearance.planes[0].mean for scene in scenes]
    assert np.abs(means[0] - means[1]).mean() < 2e-3
    assert scenes[1].settings["origin"] == other.origin.tolist() and "origin" not in scenes[0].settings


def test_exports_stand_where_the_capture_stood(tmp_path):
    near, far = write_both(tmp_path, FAR["UTM"])
    options = {"fit": "none", "textures": 1, "atlas": 64}
    save(encode(open_capture(far), far / "proxy.ply", **options), tmp_path / "far.glb")
    scene = load(tmp_path / "far.glb")
    assert np.array_equal(scene.origin, open_capture(far).origin)

    exports.write_colmap(RenderJob(scene), tmp_path / "model")
    written = open_capture(tmp_path / "model")
    for one, other in zip(open_capture(near).cameras, written.where_it_stood().cameras, strict=True):
        assert np.abs(other.centre - one.centre - FAR["UTM"]).max() < 1e-5  # a scene keeps float32
    import pycolmap

    points = pycolmap.Reconstruction(str(tmp_path / "model" / "sparse" / "0")).points3D.values()
    around = np.array([point.xyz for point in points]) - FAR["UTM"]
    vertices = read_mesh(near / "proxy.ply").vertices
    assert (around > vertices.min(axis=0) - 1e-4).all() and (around < vertices.max(axis=0) + 1e-4).all()

    exports.write_obj(scene, tmp_path / "mesh.obj")
    exports.write_obj_folder(scene, tmp_path / "folder")
    to_capture = np.array(json.loads((tmp_path / "folder" / "eigenfield.json").read_text())["toCapture"])
    rows = [line.split()[1:] for line in (tmp_path / "mesh.obj").read_text().splitlines() if line.startswith("v ")]
    places = np.array(rows, np.float64) @ to_capture.T
    assert np.abs(places.min(axis=0) - FAR["UTM"] - vertices.min(axis=0)).max() < 1e-5
    assert np.abs(places.max(axis=0) - FAR["UTM"] - vertices.max(axis=0)).max() < 1e-5


@pytest.mark.parametrize("suffix", [".ply", ".glb"])
def test_a_proxy_that_is_written_stands_where_the_capture_stood(tmp_path, suffix):
    mesh = read_mesh(write_capture(tmp_path / "near") / "proxy.ply")
    write_mesh(mesh, tmp_path / f"far{suffix}", origin=FAR["ECEF"])
    back = read_mesh(tmp_path / f"far{suffix}", FAR["ECEF"])
    assert np.abs(back.vertices - mesh.vertices).max() < 1e-8 + np.spacing(4e6)
    assert np.array_equal(back.faces, mesh.faces) and np.abs(back.uv - mesh.uv).max() < 1e-6
    write_mesh(mesh, tmp_path / f"a{suffix}", origin=np.zeros(3))
    write_mesh(mesh, tmp_path / f"b{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_a_calibration_that_is_written_stands_where_the_capture_stood(tmp_path):
    _, far = write_both(tmp_path, FAR["UTM"])
    capture = open_capture(far)
    place = np.array([[0.5, 0.25, 1.5], [0.25, 0.5, 1.0]])
    points = SparsePoints(
        place, np.zeros((2, 3), np.uint8), np.zeros(2), np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]), np.ones((4, 2))
    )
    save_calibration(capture, tmp_path / "out", points)
    document = json.loads((tmp_path / "out" / "transforms.json").read_text())
    wanted = json.loads((far / "transforms.json").read_text())
    for frame, given in zip(document["frames"], wanted["frames"], strict=True):
        assert np.allclose(frame["transform_matrix"], given["transform_matrix"], rtol=0, atol=2e-8)
    for model in ("transforms.json", "sparse/0"):
        again = open_capture(far, calibration=tmp_path / "out" / model)
        for one, other in zip(capture.cameras, again.cameras, strict=True):
            assert np.abs(one.centre + capture.origin - other.centre - again.origin).max() < 2e-8
    import pycolmap

    read = pycolmap.Reconstruction(str(tmp_path / "out" / "sparse" / "0")).points3D
    assert np.allclose([read[1].xyz, read[2].xyz], place + capture.origin, rtol=0, atol=1e-8)
    data = (tmp_path / "out" / "points.ply").read_bytes().split(b"end_header\n")[1]
    record = np.frombuffer(data, np.dtype([("position", "<f8", 3), ("colour", "u1", 3)]))
    assert np.allclose(record["position"], place + capture.origin, rtol=0, atol=1e-8)


def test_one_camera_that_stands_apart_hides_nothing(tmp_path):
    """An entry at the origin, as programs write cameras that they did not find."""
    _, far = write_both(tmp_path, FAR["UTM"])
    document = json.loads((far / "transforms.json").read_text())
    lost = {"file_path": "images/lost.png", "fl_x": 60, "transform_matrix": np.eye(4).tolist()}
    document["frames"].insert(3, lost)
    (far / "transforms.json").write_text(json.dumps(document))
    assert open_capture(far).origin.any()


def test_shapes_are_given_in_the_capture_s_world():
    sphere = parse_primitive("sphere:448262.5,5411933,307,2").moved(-np.array([448262.0, 5411933, 306]))
    assert sphere.centre == (0.5, 0.0, 1.0) and sphere.radius == 2
    plane = parse_primitive("plane:448262.5,5411933,307,0,0,1,2").moved(-np.array([448262.0, 5411933, 306]))
    assert plane.middle == (0.5, 0.0, 1.0) and plane.normal == (0, 0, 1)


def test_inspect_says_where_the_origin_lies_and_draws_the_mesh(tmp_path, capsys):
    _, far = write_both(tmp_path, FAR["UTM"])
    assert call("inspect", far, "--proxy", far / "proxy.ply", "--json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["origin"] == open_capture(far).origin.tolist() and min(report["proxy"]["coverage"].values()) > 0.9
