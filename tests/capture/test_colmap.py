"""COLMAP models, binary and text: the same cameras from both, every lens model, damage named."""

from __future__ import annotations

import struct
from pathlib import Path

import cv2
import numpy as np
import pycolmap
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.capture.photographs.lens import Lens, source_positions
from eigenfield.capture.readers.colmap import COLMAP_MODELS, read_colmap
from eigenfield.core.errors import CaptureError

WIDTH, HEIGHT = 32, 24
PARAMETERS = {
    "SIMPLE_PINHOLE": (40.0, 15.5, 12.25),
    "PINHOLE": (40.0, 41.0, 15.5, 12.25),
    "SIMPLE_RADIAL": (40.0, 15.5, 12.25, -0.1),
    "RADIAL": (40.0, 15.5, 12.25, -0.1, 0.02),
    "OPENCV": (40.0, 41.0, 15.5, 12.25, -0.1, 0.02, 0.003, -0.004),
    "OPENCV_FISHEYE": (40.0, 41.0, 15.5, 12.25, -0.1, 0.02, 0.003, -0.004),
    "FULL_OPENCV": (40.0, 41.0, 15.5, 12.25, -0.1, 0.02, 0.003, -0.004, 0.01, 0.05, -0.02, 0.003),
    "SIMPLE_RADIAL_FISHEYE": (40.0, 15.5, 12.25, -0.1),
    "RADIAL_FISHEYE": (40.0, 15.5, 12.25, -0.1, 0.02),
    "SIMPLE_FISHEYE": (40.0, 15.5, 12.25),
    "FISHEYE": (40.0, 41.0, 15.5, 12.25),
}
LENSES = {
    "SIMPLE_PINHOLE": None,
    "PINHOLE": None,
    "SIMPLE_RADIAL": Lens("brown", (-0.1, 0, 0, 0, 0)),
    "RADIAL": Lens("brown", (-0.1, 0.02, 0, 0, 0)),
    "OPENCV": Lens("brown", (-0.1, 0.02, 0.003, -0.004, 0)),
    "OPENCV_FISHEYE": Lens("fisheye", (-0.1, 0.02, 0.003, -0.004)),
    "FULL_OPENCV": Lens("rational", (-0.1, 0.02, 0.003, -0.004, 0.01, 0.05, -0.02, 0.003)),
    "SIMPLE_RADIAL_FISHEYE": Lens("fisheye", (-0.1, 0, 0, 0)),
    "RADIAL_FISHEYE": Lens("fisheye", (-0.1, 0.02, 0, 0)),
    "SIMPLE_FISHEYE": Lens("fisheye", (0, 0, 0, 0)),
    "FISHEYE": Lens("fisheye", (0, 0, 0, 0)),
}
NAMES = ("a photo.png", "left/b.png", "left/deep er/c.png", "ü.png")


def pose(index: int) -> tuple[np.ndarray, np.ndarray]:
    """A unit quaternion w x y z and a translation."""
    q = np.array([1.0, 0.1 * index, -0.05, 0.02 * index])
    return q / np.linalg.norm(q), np.array([0.5 * index, -0.2, 3.0 + index])


def cameras_bin(model: str = "PINHOLE", number: int | None = None, width: int = WIDTH) -> bytes:
    return struct.pack("<Q", 1) + camera_record(7, PARAMETERS[model], number, model, width)


def camera_record(camera: int, p: tuple[float, ...], number: int | None = None, model="", width: int = WIDTH) -> bytes:
    number = COLMAP_MODELS[model][0] if number is None else number
    return struct.pack("<IiQQ", camera, number, width, HEIGHT) + struct.pack(f"<{len(p)}d", *p)


def images_bin(points: int = 2, names: tuple[str, ...] = NAMES) -> bytes:
    out = struct.pack("<Q", len(names))
    for i, name in enumerate(names):
        q, t = pose(i)
        out += struct.pack("<I7dI", i + 1, *q, *t, 7) + name.encode() + b"\0" + struct.pack("<Q", points)
        out += struct.pack("<ddQ", 1.5, 2.5, 2**64 - 1) * points
    return out


def cameras_txt(model: str = "PINHOLE", parameters: tuple[float, ...] | None = None) -> str:
    values = " ".join(map(repr, PARAMETERS.get(model, ()) if parameters is None else parameters))
    return f"# Camera list\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n7 {model} {WIDTH} {HEIGHT} {values}\n"


def images_txt(points: str = "1.5 2.5 -1 3 4 17") -> str:
    out = "# Image list with two lines of data per image:\n"
    for i, name in enumerate(NAMES):
        q, t = pose(i)
        out += f"{i + 1} {' '.join(map(repr, [*map(float, q), *map(float, t)]))} 7 {name}\n{points}\n"
    return out


def capture(folder: Path, cameras: bytes | str, images: bytes | str, model: str = "sparse/0") -> Path:
    (folder / model).mkdir(parents=True, exist_ok=True)
    for stem, content in (("cameras", cameras), ("images", images)):
        if isinstance(content, bytes):
            (folder / model / f"{stem}.bin").write_bytes(content)
        else:
            (folder / model / f"{stem}.txt").write_text(content, encoding="utf-8")
    for i, name in enumerate(NAMES):
        path = folder / "images" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.new("RGB", (WIDTH, HEIGHT), (40 * i, 100, 200)).save(path)
    return folder


def refused(code: str, path: Path) -> CaptureError:
    with pytest.raises(CaptureError) as caught:
        open_capture(path)
    error = caught.value
    assert error.code == code and error.remedy and error.path and "\n" not in str(error), str(error)
    return error


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("model", list(PARAMETERS))
def test_models_and_poses(tmp_path, binary, model):
    if binary:
        capture(tmp_path, cameras_bin(model), images_bin())
    else:
        capture(tmp_path, cameras_txt(model), images_txt())
    light_field = open_capture(tmp_path)
    assert light_field.format == "colmap" and light_field.problems == ()
    assert light_field.names == ("a photo.png", "b.png", "c.png", "ü.png")
    fy = 40.0 if PARAMETERS[model][1] == 15.5 else 41.0
    for i, view in enumerate(light_field.views):
        (w, *xyz), t = pose(i)
        assert np.allclose(view.camera.K, [[40, 0, 15.5], [0, fy, 12.25], [0, 0, 1]])
        axis = np.array(xyz)
        angle = 2 * np.arctan2(np.linalg.norm(axis), w)
        expected = cv2.Rodrigues(axis / np.linalg.norm(axis) * angle)[0]  # an independent way from quaternion to matrix
        assert np.allclose(view.camera.R, expected, atol=1e-12) and np.allclose(view.camera.t, t)
        assert view.lens == LENSES[model]
        assert abs(light_field.photograph(i).pixels[12, 16, 0] - 40 * i / 255) < 1e-6


def test_binary_goes_before_text(tmp_path):
    capture(tmp_path, cameras_txt("SIMPLE_PINHOLE"), images_txt())
    capture(tmp_path, cameras_bin("PINHOLE"), images_bin())
    assert open_capture(tmp_path).views[0].camera.K[1, 1] == 41


@pytest.mark.parametrize("model", ["sparse/0", "sparse", ".", "colmap/sparse/0"])
def test_where_a_model_may_lie(tmp_path, model):
    capture(tmp_path, cameras_bin(), images_bin(), model)
    assert len(open_capture(tmp_path)) == 4
    if model.startswith("sparse"):
        assert len(open_capture(tmp_path / model)) == 4
        assert len(open_capture(tmp_path / model / "images.bin")) == 4


def test_a_model_elsewhere_than_the_photographs(tmp_path):
    capture(tmp_path / "one", cameras_bin(), images_bin(), "model")
    light_field = open_capture(tmp_path / "one" / "images", calibration=tmp_path / "one" / "model")
    assert len(light_field) == 4 and not light_field.problems


def test_transforms_json_goes_before_a_model(tmp_path):
    capture(tmp_path, cameras_bin(), images_bin())
    (tmp_path / "transforms.json").write_text("{}")
    assert refused("calibration-json", tmp_path).path == str(tmp_path / "transforms.json")


def test_masks_as_colmap_names_them(tmp_path):
    capture(tmp_path, cameras_bin(), images_bin())
    for name in NAMES:
        path = tmp_path / "masks" / (name + ".png")
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.new("L", (WIDTH, HEIGHT), 0 if "c.png" in name else 255).save(path)
    light_field = open_capture(tmp_path, masks=tmp_path / "masks")
    assert not light_field.problems
    assert light_field.photograph(2).mask.max() == 0 and light_field.photograph(1).mask is None


def test_empty_lines_of_points(tmp_path):
    assert len(open_capture(capture(tmp_path, cameras_txt(), images_txt("")))) == 4


@pytest.mark.parametrize("model", PARAMETERS)
def test_lenses_are_those_of_colmap(tmp_path, model):
    """Where COLMAP itself puts what the pinhole picture's pixels show."""
    (entry,) = read_colmap(capture(tmp_path, cameras_bin(model), images_bin(names=NAMES[:1])) / "sparse" / "0").entries
    K = entry.intrinsics.matrix(WIDTH, HEIGHT)
    of_colmap = pycolmap.Camera(model=model, width=WIDTH, height=HEIGHT, params=PARAMETERS[model])
    rays = [[(x + 0.5 - K[0, 2]) / K[0, 0], (y + 0.5 - K[1, 2]) / K[1, 1], 1] for y in range(24) for x in range(32)]
    theirs = of_colmap.img_from_cam(np.array(rays)).reshape(HEIGHT, WIDTH, 2)
    lens = entry.lens or Lens("brown", (0.0,) * 5)
    x, y, _ = source_positions(K, lens, WIDTH, HEIGHT)
    np.testing.assert_allclose(np.stack([x, y], axis=2) + 0.5, theirs, atol=1e-4)


UNREAD = {7: ("FOV", 5), 10: ("THIN_PRISM_FISHEYE", 12), 11: ("RAD_TAN_THIN_PRISM_FISHEYE", 16), 12: (
    "SIMPLE_DIVISION", 4), 13: ("DIVISION", 5), 16: ("EUCM", 6), 17: ("EQUIRECTANGULAR", 2)}  # fmt: skip


@pytest.mark.parametrize("number", [*UNREAD, 999, -1])
def test_other_models_are_refused_by_name(tmp_path, number):
    name, count = UNREAD.get(number, (str(number), 4))
    cameras = struct.pack("<Q", 1) + camera_record(7, (9.0,) * count, number)
    error = refused("camera-model", capture(tmp_path, cameras, images_bin()))
    assert name in str(error)


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("number", UNREAD)
def test_a_camera_of_another_model_costs_its_own_views_alone(tmp_path, number, binary):
    """A panorama between photographs; whether an image uses it or not, the others are read."""
    name, count = UNREAD[number]
    if binary:
        foreign = camera_record(3, (9.0,) * count, number)
        cameras = struct.pack("<Q", 2) + foreign + camera_record(7, PARAMETERS["PINHOLE"], model="PINHOLE")
        mixed = images_bin().replace(struct.pack("<I", 7) + b"left/b.png", struct.pack("<I", 3) + b"left/b.png")
        unused = images_bin()
    else:
        cameras = cameras_txt() + f"3 {name} 2000 1000 {' '.join(['9'] * count)}\n"
        mixed, unused = images_txt().replace("7 left/b.png", "3 left/b.png"), images_txt()
    light_field = open_capture(capture(tmp_path / "unused", cameras, unused))
    assert len(light_field) == 4 and not light_field.problems
    light_field = open_capture(capture(tmp_path / "used", cameras, mixed))
    assert light_field.names == ("a photo.png", "c.png", "ü.png")
    (line,) = [problem for problem in light_field.problems if "camera 3" in problem]
    assert f"1 image: left/b.png) has the camera model {name}, which is not read" in line


@pytest.mark.parametrize("inner", ["sparse", "colmap/sparse"])
def test_the_model_of_most_images_is_read_and_the_others_named(tmp_path, inner):
    """COLMAP begins a model anew where photographs do not hang together; the first need not be the largest."""
    capture(tmp_path, cameras_txt(), images_txt()[: images_txt().index("\n3 ") + 1], f"{inner}/0")
    capture(tmp_path, cameras_bin(), images_bin(), f"{inner}/1")
    capture(tmp_path, cameras_bin(), images_bin()[:90], f"{inner}/2")  # damaged
    capture(tmp_path, cameras_bin(), images_bin(names=NAMES[:3]), f"{inner}/10")
    light_field = open_capture(tmp_path)
    assert len(light_field) == 4
    (line,) = light_field.problems
    assert "sparse/1 is read" in line and "sparse/0 (2 images), sparse/2 (damaged), sparse/10 (3 images)" in line
    assert len(open_capture(tmp_path / "images", calibration=tmp_path / inner / "10")) == 3


def test_other_models_are_refused_in_text_too(tmp_path):
    error = refused("camera-model", capture(tmp_path, cameras_txt("FOV", (1.0,) * 5), images_txt()))
    assert "model FOV" in str(error) and error.path is not None and error.path.endswith("cameras.txt")


@pytest.mark.parametrize("stem", ["cameras", "images"])
def test_every_truncation_of_a_binary_file_names_it(tmp_path, stem):
    capture(tmp_path, cameras_bin(), images_bin())
    path = tmp_path / "sparse" / "0" / f"{stem}.bin"
    whole = path.read_bytes()
    for size in range(len(whole)):
        path.write_bytes(whole[:size])
        assert refused("colmap-truncated", tmp_path).path == str(path)
    path.write_bytes(whole + b"\0")
    assert refused("colmap-damaged", tmp_path).path == str(path)


def test_counts_beyond_the_file_are_refused_before_anything_is_allocated(tmp_path):
    capture(tmp_path, cameras_bin(), images_bin())
    folder = tmp_path / "sparse" / "0"
    for stem in ("cameras", "images"):
        whole = (folder / f"{stem}.bin").read_bytes()
        (folder / f"{stem}.bin").write_bytes(struct.pack("<Q", 2**63) + whole[8:])
        refused("colmap-truncated", tmp_path)
        (folder / f"{stem}.bin").write_bytes(whole)
    (folder / "images.bin").write_bytes(images_bin()[:80] + b"x" * 5000)
    refused("colmap-damaged", tmp_path)


@settings(max_examples=150)
@given(st.data())
def test_changed_bytes_are_read_or_refused(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp() / "colmap fuzz"
    capture(folder, cameras_bin("OPENCV"), images_bin()) if not folder.exists() else None
    for stem, whole in (("cameras", cameras_bin("OPENCV")), ("images", images_bin())):
        broken = bytearray(whole)
        for _ in range(data.draw(st.integers(0, 3))):
            broken[data.draw(st.integers(0, len(broken) - 1))] = data.draw(st.integers(0, 255))
        (folder / "sparse" / "0" / f"{stem}.bin").write_bytes(bytes(broken))
    try:
        light_field = open_capture(folder)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        assert all(np.isfinite(view.camera.matrix).all() for view in light_field.views)


@pytest.mark.parametrize(("cameras", "images", "code"), [
    ("7 PINHOLE 32\n", None, "colmap-line"),
    ("7 PINHOLE 32 24 1 2 x 4\n", None, "colmap-line"),
    ("7 PINHOLE 32 24 1 2 3\n", None, "colmap-line"),
    ("7 PINHOLE 0 24 40 41 15 12\n", None, "camera-size"),
    ("7 PINHOLE 32 24 nan 41 15 12\n", None, "camera-not-finite"),
    ("7 PINHOLE 32 24 -40 41 15 12\n", None, "camera-focal"),
    (None, "1 1 0 0 0 0 0\n\n", "colmap-line"),
    (None, "1 1 0 0 0 0 0 0 8 a photo.png\n\n", "colmap-camera"),
    (None, "1 1 0 0 0 nan 0 0 7 a photo.png\n\n", "camera-not-finite"),
    (None, "1 1 1 0 0 0 0 0 7 a photo.png\n\n", "camera-not-rotation"),
    (None, "1 0 0 0 0 0 0 0 7 a photo.png\n\n", "camera-not-rotation"),
    (None, "1 1 0 0 0 0 0 0 7 a.png\n2 1 0 0 0 0 0 0 7 b.png\n", "colmap-line"),  # no line of points between
    (None, "", "calibration-empty"),
])  # fmt: skip
def test_wrong_text(tmp_path, cameras, images, code):
    error = refused(code, capture(tmp_path, cameras or cameras_txt(), images_txt() if images is None else images))
    assert error.path is not None and error.path.endswith(".txt" if code != "camera-focal" else "0")


def test_quaternions_of_six_digits_are_rotations_enough(tmp_path):
    text = "1 0.978314 -0.0611114 -0.132261 -0.147221 3.02858 -2.21843 -0.89418 7 a photo.png\n\n"
    capture(tmp_path, cameras_txt(), text)
    (entry,) = read_colmap(tmp_path / "sparse" / "0").entries
    assert np.allclose(entry.R @ entry.R.T, np.eye(3), atol=1e-12)
    assert np.allclose(-entry.R @ entry.centre, [3.02858, -2.21843, -0.89418])


# real captures


def test_cube(data):
    light_field = open_capture(data / "cube_colmap_mesh")
    assert len(light_field) == 13 and light_field.format == "colmap" and not light_field.problems
    assert len({(v.camera.width, v.camera.height) for v in light_field.views}) == 3


def test_cube_upstreams_cameras_do_not_fit_its_pictures(data, tmp_path):
    """1280x960 against 1000x748: nearly, but not, the same aspect."""
    model = tmp_path / "sparse"
    model.mkdir()
    (model / "cameras.txt").write_bytes((data / "cube_colmap_mesh" / "upstream" / "cameras.txt").read_bytes())
    (model / "images.txt").write_bytes((data / "cube_colmap_mesh" / "sparse" / "0" / "images.txt").read_bytes())
    with pytest.raises(CaptureError, match=r"1000x748.*1280x960") as caught:
        open_capture(data / "cube_colmap_mesh", calibration=model)
    assert caught.value.code == "image-size"
