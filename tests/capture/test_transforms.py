"""transforms.json: intrinsics, poses, paths, sizes, lenses, masks."""

from __future__ import annotations

import json
import os
import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.capture.pairing import is_same_picture
from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.errors import CaptureError
from support.transforms_files import HEIGHT, WIDTH, camera, document, picture, pose, refused, rotation, write


def test_cameras_come_out_as_they_went_in(tmp_path):
    capture = open_capture(write(tmp_path / "a capture ü"))
    assert capture.format == "transforms" and capture.problems == () and len(capture) == 4
    assert capture.names == ("v0.png", "v1.png", "v2.png", "v3.png")
    for i, view in enumerate(capture.views):
        for key in ("K", "R", "t"):
            assert np.allclose(getattr(view.camera, key), getattr(camera(i), key), atol=1e-12)
        assert (view.camera.width, view.camera.height) == (WIDTH, HEIGHT) and view.lens is None
        assert capture.bytes(i) == view.path.stat().st_size
    photograph = capture.photograph(2)
    assert photograph.mask is None and photograph.pixels.flags.c_contiguous
    assert np.array_equal(photograph.pixels * np.float32(255), np.asarray(picture(2)))


def test_a_point_right_and_above_appears_right_and_above(tmp_path):
    """The hand-made known case: a camera at the origin with the identity pose looks along -z, y up."""
    top = document(3)
    for frame in top["frames"]:
        frame |= {"transform_matrix": np.eye(4).tolist(), "cx": 20.0, "cy": 15.0, "fl_x": 10.0, "fl_y": 20.0}
    (pixel,), (depth,) = open_capture(write(tmp_path, top)).views[0].camera.project([[1.0, 0.5, -2.0]])
    assert np.allclose(pixel, [20 + 10 * 0.5, 15 - 20 * 0.25]) and depth == 2


def test_the_json_itself_and_a_relative_folder_may_be_named(tmp_path, monkeypatch):
    write(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert open_capture("transforms.json").names == open_capture(".").names == open_capture(tmp_path).names


def test_global_intrinsics_and_per_frame_ones_that_win(tmp_path):
    top = document()
    own = {key: top["frames"][1][key] for key in ("fl_x", "fl_y")}
    for frame in top["frames"]:
        for key in ("fl_x", "fl_y", "cx", "cy", "w", "h"):
            del frame[key]
    top["frames"][1] |= own
    top |= {"fl_x": 60.0, "camera_angle_x": 0.1, "w": WIDTH, "h": HEIGHT}
    views = open_capture(write(tmp_path, top)).views
    assert np.allclose(views[0].camera.K, [[60, 0, 20], [0, 60, 15], [0, 0, 1]])
    assert np.allclose(views[1].camera.K, [[51, 0, 20], [0, 48, 15], [0, 0, 1]])


@pytest.mark.parametrize("sizes", [True, False])
def test_camera_angle_of_the_original_nerf(tmp_path, sizes):
    top = {
        "camera_angle_x": 0.9,
        "frames": [{"file_path": f"./images/v{i}", "transform_matrix": pose(camera(i))} for i in range(3)],
    }
    if sizes:
        top |= {"w": WIDTH, "h": HEIGHT, "camera_angle_y": 0.5}
    K = open_capture(write(tmp_path, top)).views[0].camera.K
    fx = WIDTH / 2 / np.tan(0.45)
    assert np.allclose(np.diag(K), [fx, HEIGHT / 2 / np.tan(0.25) if sizes else fx, 1])
    assert np.allclose(K[:2, 2], [WIDTH / 2, HEIGHT / 2])


def test_applied_transform_is_undone(tmp_path):
    """Stored poses are in the world that applied_transform leads to; the capture's world is the one from before."""
    Q, shift, scale = rotation(1.0, -0.4, 0.3), np.array([1.0, -2.0, 0.5]), 0.25
    top = document()
    for frame in top["frames"]:
        matrix = np.array(frame["transform_matrix"])
        matrix[:3, 3] = scale * (Q @ matrix[:3, 3] + shift)
        matrix[:3, :3] = Q @ matrix[:3, :3]
        frame["transform_matrix"] = matrix.tolist()
    top |= {"applied_transform": np.hstack([Q, shift[:, None]]).tolist(), "applied_scale": scale}
    capture = open_capture(write(tmp_path, top))
    assert len(capture.views) == len(top["frames"])
    point = np.array([[0.4, -0.2, 2.0]])
    for i, view in enumerate(capture.views):
        assert np.allclose(view.camera.project(point)[0], camera(i).project(point)[0], atol=1e-9)
        assert np.allclose(view.camera.centre, camera(i).centre, atol=1e-9)


def test_nerfstudios_own_applied_transform(tmp_path):
    """What `ns-process-data` writes: x, z, -y. COLMAP's world comes back."""
    top = document()
    A = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0]])
    for frame in top["frames"]:
        frame["transform_matrix"] = (np.vstack([A, [0, 0, 0, 1]]) @ np.array(frame["transform_matrix"])).tolist()
    capture = open_capture(write(tmp_path, top | {"applied_transform": A.tolist()}))
    assert all(np.allclose(view.camera.centre, camera(i).centre) for i, view in enumerate(capture.views))


MIRROR, STRETCH = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]], [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0]]


@pytest.mark.parametrize("value", [MIRROR, STRETCH, [[0] * 4] * 3, [[float("nan")] * 4] * 3])
def test_applied_transforms_that_cannot_be_undone(tmp_path, value):
    refused("applied-transform", write(tmp_path, document() | {"applied_transform": value}))


# photographs and entries


def test_entries_and_photographs_without_the_other_are_named(tmp_path):
    write(tmp_path, document(9), count=5)
    picture().save(tmp_path / "images" / "extra.jpg")
    problems = "\n".join(open_capture(tmp_path).problems)
    assert "4 calibration entries have no photograph (transforms.json): images/v5.png" in problems
    assert "1 photograph has no calibration entry: extra.jpg" in problems


def test_fewer_than_three_photographs(tmp_path):
    error = refused("too-few", write(tmp_path, document(5), count=2))
    assert str(error).startswith(str(tmp_path)) and "2 photographs" in str(error)


def test_natural_order_and_names_shared_by_folders(tmp_path):
    top = document(4)
    for i, name in enumerate(("a/v10.png", "b/v2.png", "a/v2.png", "a/V1.png")):
        top["frames"][i]["file_path"] = name
        (tmp_path / name).parent.mkdir(exist_ok=True)
        picture().save(tmp_path / name)
    (tmp_path / "transforms.json").write_text(json.dumps(top))
    assert open_capture(tmp_path).names == ("a/v2.png", "b/v2.png", "V1.png", "v10.png")


def test_calibration_elsewhere(tmp_path):
    """By relative path back into the photographs' folder, and by file name where folders differ."""
    top = document()
    for frame in top["frames"]:
        frame["file_path"] = "../" + frame["file_path"]
    write(tmp_path / "capture")
    (tmp_path / "capture" / "transforms.json").unlink()
    (tmp_path / "capture" / "calibration").mkdir()
    inside = tmp_path / "capture" / "calibration" / "refined.json"
    inside.write_text(json.dumps(top))
    far = tmp_path / "far"
    far.mkdir()
    (far / "cameras.json").write_text(json.dumps(top))
    for calibration in (inside, far / "cameras.json"):
        for root in (tmp_path / "capture", tmp_path / "capture" / "images"):
            capture = open_capture(root, calibration=calibration)
            assert len(capture) == 4 and capture.root == root and not capture.problems


@pytest.mark.skipif(os.name == "nt", reason="links to folders need a privilege there")
def test_photographs_behind_a_link_are_found_by_a_path_that_leads_out_of_it(tmp_path):
    """The calibration's path is right from its own folder. From the linked one the system finds it, too, for there `..`
    is the folder of the link's target."""
    write(tmp_path / "deep" / "store" / "capture")
    (tmp_path / "link").symlink_to(tmp_path / "deep" / "store")
    top = document()
    for frame in top["frames"]:
        frame["file_path"] = "../../../link/capture/" + frame["file_path"]
    far = tmp_path / "far" / "a" / "b"
    far.mkdir(parents=True)
    (far / "cameras.json").write_text(json.dumps(top))
    capture = open_capture(tmp_path / "link" / "capture", calibration=far / "cameras.json")
    assert len(capture) == 4 and all(capture.bytes(i) for i in range(4))


def test_photographs_outside_the_named_folder_are_not_used(tmp_path):
    """Whoever names a folder of photographs means these, not those that the calibration was made from."""
    write(tmp_path / "original")
    (tmp_path / "mine").mkdir()
    for i in range(3):
        picture(9, 20, 15).save(tmp_path / "mine" / f"V{i}.PNG")
    capture = open_capture(tmp_path / "mine", calibration=tmp_path / "original" / "transforms.json")
    assert [view.path.parent.name for view in capture.views] == ["mine"] * 3
    assert "1 calibration entry has no photograph" in capture.problems[0]


def test_two_frames_for_one_photograph(tmp_path):
    top = document()
    top["frames"][3]["file_path"] = "images/../images/v1.png"
    error = refused("frame-twice", write(tmp_path, top))
    assert "frame 3" in str(error) and "v1.png" in str(error)
    lenient = open_capture(tmp_path, strict=False)
    assert len(lenient) == 3 and any("same photograph" in problem for problem in lenient.problems)


# sizes and orientation


def test_cameras_of_another_scale_are_scaled(tmp_path):
    top = document()
    for frame in top["frames"]:
        frame |= {key: 2 * frame[key] for key in ("fl_x", "fl_y", "cx", "cy", "w", "h")}
    capture = open_capture(write(tmp_path, top))
    assert all(np.allclose(view.camera.K, camera(i).K) for i, view in enumerate(capture.views))
    assert len(capture.problems) == 1 and "4 cameras are for another size" in capture.problems[0]


def test_a_photograph_of_another_aspect_is_an_error(tmp_path):
    write(tmp_path)
    picture(0, 40, 27).save(tmp_path / "images" / "v1.png")
    error = refused("image-size", tmp_path)
    assert "v1.png" in str(error) and "40x27" in str(error) and "40x30" in str(error)


@given(
    st.integers(200, 8000), st.integers(200, 8000), st.floats(0.05, 1), st.sampled_from([np.floor, np.ceil, np.round])
)
def test_scaling_and_rounding_keeps_the_picture(width, height, scale, rounding):
    assert is_same_picture(width, height, int(rounding(width * scale)), int(rounding(height * scale)))
    w = int(width * scale)
    assert not is_same_picture(width, height, w, int(height * scale) + 4 + height // width)


def test_a_photograph_changed_after_opening_is_noticed(tmp_path):
    capture = open_capture(write(tmp_path))
    picture(0, 20, 15).save(capture.views[0].path)
    capture.views[1].path.unlink()
    for index, code in ((0, "image-size"), (1, "image-missing")):
        with pytest.raises(CaptureError) as caught:
            capture.photograph(index)
        assert caught.value.code == code


@pytest.mark.parametrize(
    ("camera_size", "turned"), [((30, 40), True), ((40, 30), False), ((60, 80), True), (None, False)]
)
def test_orientation_follows_the_cameras_size(tmp_path, camera_size, turned):
    top = document(3, ".jpg")
    for frame in top["frames"]:
        if camera_size is None:
            del frame["w"], frame["h"]
        else:
            frame |= {"w": camera_size[0], "h": camera_size[1]}
    write(tmp_path, top, 0)
    exif = Image.Exif()
    exif[0x0112] = 6
    for i in range(3):
        picture().save(tmp_path / "images" / f"v{i}.jpg", exif=exif, quality=98, subsampling=0)
    capture = open_capture(tmp_path)
    stored = np.asarray(picture()) / 255
    expected = np.rot90(stored, -1) if turned else stored
    assert np.abs(capture.photograph(0).pixels - expected).max() < 0.03
    assert capture.photograph(0).pixels.shape[:2] == (capture.views[0].camera.height, capture.views[0].camera.width)


# masks


def half() -> Image.Image:
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[:, WIDTH // 2 :] = 255
    return Image.fromarray(mask)


@pytest.mark.parametrize(
    "name", ["masks/v{}.png", "masks/v{}.png.png", "masks/images/v{}.tif", "masks/images/v{}.png.PNG"]
)
def test_masks_from_a_folder(tmp_path, name):
    write(tmp_path)
    for i in range(3):
        path = tmp_path / name.format(i)
        path.parent.mkdir(parents=True, exist_ok=True)
        half().save(path)
    capture = open_capture(tmp_path, masks=tmp_path / "masks")
    assert np.array_equal(capture.photograph(1).mask, np.asarray(half()) / 255)
    assert capture.photograph(3).mask is None
    assert capture.problems == (f"1 photograph has no mask in {tmp_path / 'masks'}: v3.png",)


def test_mask_path_alpha_and_both(tmp_path):
    top = document()
    for i, frame in enumerate(top["frames"][:3]):
        frame["mask_path"] = f"masks/v{i}.png"
    write(tmp_path, top)
    (tmp_path / "masks").mkdir()
    for i in range(3):
        half().save(tmp_path / "masks" / f"v{i}.png")
    alpha = picture().copy()
    alpha.putalpha(half().transpose(Image.Transpose.ROTATE_180))
    alpha.save(tmp_path / "images" / "v0.png")
    alpha.save(tmp_path / "images" / "v3.png")
    capture = open_capture(tmp_path)
    assert capture.photograph(0).mask.max() == 0  # the mask's half and the other one
    assert np.array_equal(capture.photograph(1).mask, np.asarray(half()) / 255)
    assert np.array_equal(capture.photograph(3).mask, np.asarray(half())[::-1, ::-1] / 255)
    (tmp_path / "masks" / "v2.png").unlink()
    assert "v2.png" in str(refused("mask-missing", tmp_path))


def test_wrong_masks(tmp_path):
    write(tmp_path)
    refused("masks-missing", tmp_path, masks=tmp_path / "nowhere")
    (tmp_path / "masks").mkdir()
    refused("masks-missing", tmp_path, masks=tmp_path / "masks")
    half().resize((20, 15)).save(tmp_path / "masks" / "v0.png")
    capture = open_capture(tmp_path, masks=tmp_path / "masks")
    with pytest.raises(CaptureError, match=r"masks.v0\.png.*20x15.*40x30"):
        capture.photograph(0)
    half().save(tmp_path / "masks" / "v0.webp")
    refused("mask-twice", tmp_path, masks=tmp_path / "masks")


@pytest.mark.parametrize(
    "extra", [{"k1": 0.3, "p2": 0.01}, {"camera_model": "OPENCV_FISHEYE", "k1": 0.1}, {"is_fisheye": True}]
)
def test_lenses_from_the_file(tmp_path, extra):
    capture = open_capture(write(tmp_path, document() | extra))
    lens = capture.views[0].lens
    if "p2" in extra:
        assert lens == Lens("brown", (0.3, 0, 0, 0.01, 0))
    else:
        assert lens == Lens("fisheye", (extra.get("k1", 0), 0, 0, 0))
    photograph = capture.photograph(0)
    assert photograph.pixels.shape == (HEIGHT, WIDTH, 3)
    assert np.abs(photograph.pixels - np.asarray(picture(0)) / 255).max() > 0.05
    assert (photograph.mask is not None) == ("p2" in extra)  # only this one reaches beyond the photograph


# threads, subsets


def test_photographs_decode_from_any_thread(tmp_path):
    capture = open_capture(write(tmp_path, document() | {"camera_model": "OPENCV", "k1": -0.1}))
    alone = [capture.photograph(i).pixels for i in range(4)]
    wrong = []

    def work():
        wrong.extend(i for i in range(4) if not np.array_equal(capture.photograph(i).pixels, alone[i]))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_subset(tmp_path):
    capture = open_capture(write(tmp_path)).subset([2, 0])
    assert capture.names == ("v2.png", "v0.png")
    assert np.array_equal(capture.photograph(0).pixels * np.float32(255), np.asarray(picture(2)))


# real captures


def test_tarot(data):
    folder = data / "tarot_17x17_512"
    capture = open_capture(folder, calibration=folder / "calibration" / "refined.json")
    assert len(capture) == 289 and capture.problems == () and capture.names[18] == "out_01_01.jpg"
    assert capture.photograph(0).pixels.shape == (512, 512, 3)
    sparse = open_capture(data / "tarot_5x4_1024", calibration=folder / "calibration" / "refined.json")
    assert len(sparse) == 20 and sparse.views[0].camera.width == 1024
    own = open_capture(data / "tarot_5x4_1024", calibration=data / "tarot_5x4_1024" / "calibration" / "refined.json")
    assert all(
        np.allclose(a.K, b.K) and np.allclose(a.t, b.t) for a, b in zip(sparse.cameras, own.cameras, strict=True)
    )


def test_fox_upstream_lists_more_frames_than_photographs(data):
    folder = data / "fox_transforms_half"
    own = open_capture(folder)
    full = open_capture(folder, calibration=folder / "transforms_upstream_fullres_67frames.json")
    assert own.names == full.names and len(own) == 50 and not own.problems
    assert full.problems[0].startswith("17 calibration entries have no photograph")
    assert all(np.allclose(a.K, b.K) for a, b in zip(own.cameras, full.cameras, strict=True))
    mask = own.photograph(0).mask
    assert mask is not None and 0.95 < mask.mean() < 1
