"""What lies among photographs and is not read: named with its count and the remedy, or refused by what it is."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pillow_heif
import pytest
from PIL import Image

from eigenfield.capture import open_any, open_capture
from eigenfield.capture.photographs import kinds
from eigenfield.capture.photographs.read import decode
from eigenfield.core.errors import CaptureError
from support.captures import write_capture
from support.named import picture, refused, write, write_video

DOCS = Path(__file__).parents[2] / "docs"
HEIC_LINE = "4 files were not read: .heic (pip install 'eigenfield[photos]')"


@pytest.fixture
def bare(monkeypatch):
    """Nothing of the extras is installed."""
    monkeypatch.setattr(kinds, "is_installed", lambda module: False)


def write_heic(path, seed=0, **options):
    path.parent.mkdir(parents=True, exist_ok=True)
    pillow_heif.from_pillow(picture(seed, 64, 48)).save(path, **options)


def mixed(folder):
    """Four PNG and four HEIC."""
    write(folder, ["a.png", "b.png", "c.png", "d.png"])
    for i in range(4):
        write_heic(folder / f"IMG_{i}.HEIC", i)
    return folder


def test_photographs_without_their_package_are_counted(tmp_path, bare, run):
    opened = open_any(mixed(tmp_path / "m"))
    assert len(opened) == 4 and opened.problems[-1] == HEIC_LINE
    code, out, _ = run("inspect", tmp_path / "m")
    assert code == 0 and HEIC_LINE in out
    for i in range(4):
        write_heic(tmp_path / "h" / f"IMG_{i}.heic")
    error = refused("photographs-missing", tmp_path / "h")
    assert "no photographs" in error.message and error.remedy == HEIC_LINE
    refused("names-unknown", tmp_path / "h", format="folder")
    write(tmp_path / "h", ["poster.png"])
    assert refused("too-few", tmp_path / "h").remedy == HEIC_LINE


def test_with_their_package_they_are_read(tmp_path):
    opened = open_any(mixed(tmp_path / "m"))
    assert len(opened) == 8 and not opened.problems


def test_a_calibration_names_missed_photographs_only(tmp_path, bare):
    folder = write_capture(tmp_path / "c")
    write_heic(folder / "images" / "more.heic")
    (folder / "images" / "notes.zip").write_bytes(b"PK")
    assert open_capture(folder).problems == ("1 file was not read: .heic (pip install 'eigenfield[photos]')",)


def test_copies_are_left_out(tmp_path):
    folder = write(tmp_path / "c", ["IMG_1.png", "IMG_2.png", "IMG_3.png"])
    for i in (1, 2):
        write_heic(folder / f"img_{i}.heic", i)
    (folder / "IMG_3.mov").write_bytes(b"of a live photograph")
    opened = open_any(folder)
    assert opened.names == ("IMG_1.png", "IMG_2.png", "IMG_3.png")
    assert opened.problems == ("3 files were not read: .heic, .mov (they are of photographs that are read)",)


def test_other_files_are_named_by_what_they_are(tmp_path):
    folder = write(tmp_path / "c", ["a.png", "b.png", "c.png"])
    for name in ("walk.mp4", "more.zip", "x.insp", "old.bmp", "notes.txt", "mesh.ply"):
        (folder / name).write_bytes(b"")
    lines = "\n".join(open_any(folder).problems)
    for words in (".mp4 (a video: ", ".zip (an archive: ", ".insp (a panorama: ", ".bmp (a picture of another format"):
        assert words in lines
    assert ".txt" not in lines and ".ply" not in lines
    for name, what in (("a.png", "one photograph"), ("mesh.ply", "--proxy"), ("old.bmp", "convert it")):
        assert what in str(refused("calibration-unknown", folder / name))


def test_a_finished_scene_is_no_capture():
    assert "eigenfield view" in str(refused("calibration-unknown", DOCS / "scene.glb"))


# panoramas


def equirectangular(width: int = 512) -> Image.Image:
    """A ball of noise that is smooth over directions, seen from its middle."""
    height = width // 2
    v, u = np.mgrid[:height, :width]
    angle, up = (u + 0.5) / width * 2 * np.pi, (0.5 - (v + 0.5) / height) * np.pi
    ways = np.stack([np.cos(up) * np.cos(angle), np.cos(up) * np.sin(angle), np.sin(up)], axis=-1)
    random = np.random.default_rng(3)
    values = sum(np.sin(ways @ random.normal(size=3) * 20 + random.uniform(0, 6)) for _ in range(12))
    grey = np.clip(127 + 20 * values, 0, 255).astype(np.uint8)
    return Image.fromarray(np.repeat(grey[..., None], 3, axis=2))


def test_panoramas_are_refused_by_what_they_show(tmp_path):
    folder = write(tmp_path / "c", ["a.png", "b.png", "c.png"], width=512, height=256)
    assert len(open_any(folder)) == 3  # twice as wide as high, and noise
    ball = equirectangular()
    ball.save(folder / "p.png")
    error = refused("image-panorama", folder)
    assert "p.png" in str(error) and "perspective" in error.remedy
    opened = open_any(folder, strict=False)
    assert len(opened) == 3 and "is a panorama" in opened.problems[-1]
    cut = Image.fromarray(np.asarray(ball)[64:192, 100:356])  # a part of it is none
    cut.save(folder / "p.png")
    assert len(open_any(folder)) == 4
    white = np.full((256, 512, 3), 255, np.uint8)
    white[60:200, 150:380] = np.random.default_rng(0).integers(0, 256, (140, 230, 3))
    Image.fromarray(white).save(folder / "p.png")  # a thing before a white background
    assert len(open_any(folder)) == 4


def test_panoramas_are_refused_by_their_metadata(tmp_path):
    folder = write(tmp_path / "c", ["a.png", "b.png", "c.png"])
    xmp = (
        b'<x:xmpmeta xmlns:x="adobe:ns:meta/"><GPano:ProjectionType>equirectangular</GPano:ProjectionType></x:xmpmeta>'
    )
    picture(1, 60, 40).save(folder / "d.jpg", xmp=xmp)
    assert "GPano" in str(refused("image-panorama", folder))


def test_wide_views_with_cameras_are_no_panoramas(tmp_path):
    folder = write_capture(tmp_path / "c")
    for path in (folder / "images").iterdir():
        equirectangular().resize((64, 56)).save(path)
    assert len(open_capture(folder)) == 9


def test_videos_of_live_photographs_make_no_rig(tmp_path):
    folder = write(tmp_path / "c", ["a.png", "b.png", "c.png"])
    for name in "abc":
        write_video(folder / f"{name}.mov", 2)
    assert open_any(folder).format == "folder"


@pytest.mark.parametrize(
    ("name", "data", "module", "extra"),
    [
        ("a.heic", b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "pi_heif.as_plugin", "photos"),
        ("a.jxl", b"\xff\x0a" + bytes(40), "pillow_jxl.JpegXLImagePlugin", "photos"),
        ("a.nef", b"MM\0*" + bytes(40), "rawpy", "raw"),
        ("a.exr", b"\x76\x2f\x31\x01" + bytes(40), "OpenEXR", "renders"),
    ],
)
def test_a_file_without_its_package_is_refused_by_name(tmp_path, monkeypatch, name, data, module, extra):
    monkeypatch.setitem(sys.modules, module, None)
    (tmp_path / name).write_bytes(data)
    with pytest.raises(CaptureError) as caught:
        decode(tmp_path / name)
    assert caught.value.code == "image-kind" and caught.value.remedy == f"pip install 'eigenfield[{extra}]'"


RENAMED = "a.jpe", "b.JFIF", "c.pjpeg", "d.mpo", "e.jpg_large", "f.jpg!d", "g.png?width=1.5", "h"


def test_photographs_with_other_endings_are_read_by_content(tmp_path):
    folder = write(tmp_path / "c", ["x.png"])
    for seed, name in enumerate(RENAMED):
        picture(seed).save(folder / name, "PNG" if "png" in name else "JPEG")
    for name in ("x.jpg_original", "y.thm", "._a.jpg", "z.jpg.bak"):
        picture(20).save(folder / name, "JPEG")
    (folder / "README").write_text("notes")
    opened = open_any(folder)
    assert opened.names == (*sorted(RENAMED, key=str.casefold), "x.png") and not opened.problems
    (folder / "b.JFIF").write_bytes(b"GIF89a")
    picture(21).save(folder / "p.img", "JPEG")
    lines = "\n".join(open_any(folder).problems)
    assert "1 file was not read: .img (pictures by their content" in lines and ".jfif (no picture" in lines
    (tmp_path / "rig").mkdir()
    for number in range(2):
        write_video(tmp_path / "rig" / f"{number}.mp4", 2)
    picture(0).save(tmp_path / "rig" / "poster", "JPEG")
    assert open_any(tmp_path / "rig", strict=False).format == "video"


def test_files_that_are_elsewhere_are_to_be_downloaded(tmp_path):
    folder = write(tmp_path / "c", ["a.png", "b.png", "c.png"])
    for name in (
        ".IMG_7.JPG.icloud",
        "IMG_8.heic.nextcloud",
        "IMG_9.jpg.crdownload",
        ".a.png.icloud",
        ".notes.txt.icloud",
    ):
        (folder / name).write_bytes(b"bplist00")
    (folder / "lost.jpg").symlink_to(tmp_path / "nowhere")
    line = "4 files were not read: .crdownload, .icloud, .jpg, .nextcloud (not on this machine: download them first)"
    assert open_any(folder).problems == (line,)
    for path in folder.glob("*.png"):
        path.unlink()
    assert "download them first" in str(refused("photographs-missing", folder).remedy)


def test_folders_inside_are_named_at_any_depth(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(Path("CARD/DCIM/100APPLE"), ["a.jpg", "b.jpg"])
    write(Path("CARD/scene 1/images"), ["a.jpg"])
    (Path("CARD/DCIM/101APPLE")).mkdir()
    Path("CARD/DCIM/101APPLE/.c.HEIC.icloud").write_bytes(b"bplist00")
    write(Path("CARD/@eaDir/a.jpg"), ["SYNOPHOTO.jpg"])
    found = "name CARD/DCIM/100APPLE, CARD/DCIM/101APPLE, 'CARD/scene 1': one, or several if they are one capture"
    assert refused("photographs-missing", Path("CARD")).remedy == found
    assert refused("names-unknown", Path("CARD"), format="folder").remedy == found


def test_photographs_that_are_named_one_by_one_lead_to_their_folder(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    write(Path("-photos"), ["a.png", "b.png", "c.png"])
    files = [f"./-photos/{name}.png" for name in "abc"]
    verbs = ("inspect",), ("encode", "-o", "s.glb"), ("encode", "--proxy", DOCS / "scene.glb", "-o", "s.glb")
    for verb in (*verbs, ("calibrate",), ("evaluate", DOCS / "scene.glb")):
        code, _, error = run(*verb, *files)
        assert code == 2 and "name their folder: ./-photos" in error
    assert "name the folder of all photographs: ./-photos" in run("inspect", files[0])[2]
    assert "eigenfield encode ./-photos -o" in run("inspect", "./-photos")[1]
