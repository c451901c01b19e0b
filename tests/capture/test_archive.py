"""A capture in a zip, and one in several folders."""

from __future__ import annotations

import json
import os
import shutil
import stat
import zipfile
from pathlib import Path

import pytest

from eigenfield.capture import archive, open_any, open_capture, open_photographs
from eigenfield.core.errors import CaptureError
from support.captures import write_capture
from support.named import picture, refused, write


def zipped(path: Path, files: dict[str, bytes | zipfile.ZipInfo], **options) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name, data in files.items():
            out.writestr(name, data)
    return path


def photographs(tmp_path, prefix: str = "") -> dict[str, bytes]:
    folder = write(tmp_path / "made", ["a.png", "b.png", "c.png"])
    return {prefix + path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def test_a_zip_is_a_folder(tmp_path):
    path = zipped(tmp_path / "my walk.ZIP", photographs(tmp_path))
    opened = open_any(path, work=tmp_path / "work")
    assert opened.names == ("a.png", "b.png", "c.png") and not opened.problems
    before = opened.shots[0].path.stat().st_mtime_ns
    again = open_photographs(path, work=tmp_path / "work")
    assert again.shots[0].path == opened.shots[0].path and again.shots[0].path.stat().st_mtime_ns == before
    assert len(open_any(path)) == 3  # in a temporary folder


def test_folders_around_all_are_passed_over(tmp_path):
    files = photographs(tmp_path, "scan/scan/") | {"__MACOSX/scan/._a.png": b"x", "scan/.DS_Store": b"x"}
    assert len(open_any(zipped(tmp_path / "a.zip", files))) == 3
    files = photographs(tmp_path, "scan\\images\\")  # as some programs write paths
    assert len(open_any(zipped(tmp_path / "b.zip", files))) == 3


def test_a_zip_with_a_calibration(tmp_path, run):
    folder = write_capture(tmp_path / "capture")
    path = Path(shutil.make_archive(str(tmp_path / "c"), "zip", tmp_path, "capture"))
    assert len(open_capture(path)) == len(open_capture(folder)) == 9
    report = json.loads(run("inspect", path, "--json").out)
    assert report["views"] == 9 and report["next"] == [f"eigenfield encode {path} -o scene.glb"]
    assert report["root"] == str(path)


def info(name: str, mode: int = stat.S_IFREG | 0o644) -> zipfile.ZipInfo:
    made = zipfile.ZipInfo(name)
    made.external_attr = mode << 16
    return made


@pytest.mark.parametrize(
    "name", ["../out.png", "a/../../out.png", "/etc/out.png", "C:\\out.png", "..\\out.png", "a\tb.png", "x" * 300]
)
def test_no_path_leaves_its_folder(tmp_path, name):
    (tmp_path / "deep").mkdir()
    path = zipped(tmp_path / "deep" / "a.zip", {name: b"x"})
    error = refused("zip-path", path, work=tmp_path / "work")
    assert "a.zip" in str(error) and not list(tmp_path.rglob("out.png"))
    assert list((tmp_path / "work").iterdir()) == []


def test_links_and_doubles_and_passwords_are_refused(tmp_path):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w") as out:
        out.writestr(info("link.png", stat.S_IFLNK | 0o777), "/etc/passwd")
    assert "link" in str(refused("zip-path", path))
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(path, "w") as out:
        out.writestr("a.png", b"1")
        out.writestr("a.png", b"2")
    assert "twice" in str(refused("zip-damaged", path))
    assert "one name" in str(refused("zip-damaged", zipped(path, {"a": b"1", "a/b.png": b"2"})))
    data = bytearray(zipped(path, {"a.png": b"1"}).read_bytes())
    data[data.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(data)
    refused("zip-encrypted", path)
    refused("zip-empty", zipped(path, {".DS_Store": b"x"}))


def test_bombs_are_refused_before_they_are_unpacked(tmp_path, monkeypatch):
    path = zipped(tmp_path / "a.zip", {"a.tif": bytes(200_000_000)})
    assert "times its size" in str(refused("zip-large", path, work=tmp_path / "work"))
    assert list((tmp_path / "work").iterdir()) == []
    data = bytearray(path.read_bytes())  # a size that is not true: zipfile gives no more, and the sum does not fit
    for mark, place in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        at = data.index(mark) + place
        data[at : at + 4] = (1000).to_bytes(4, "little")
    path.write_bytes(data)
    refused("zip-damaged", path, work=tmp_path / "work")
    monkeypatch.setattr(archive, "ZIP_MAX_FILES", 2)
    refused("zip-large", zipped(path, photographs(tmp_path)))


@pytest.mark.parametrize(
    ("limits", "fits"),
    [
        ({"ZIP_MAX_BYTES": 3000, "ZIP_FREE_BYTES": 3000}, True),
        ({"ZIP_MAX_BYTES": 2999, "ZIP_FREE_BYTES": 3000}, False),
        ({"ZIP_FREE_BYTES": 3000, "ZIP_MAX_RATIO": 0}, True),
        ({"ZIP_FREE_BYTES": 2999, "ZIP_MAX_RATIO": 0}, False),
        ({"ZIP_FREE_BYTES": 0, "ZIP_MAX_RATIO": 10}, True),
        ({"ZIP_FREE_BYTES": 0, "ZIP_MAX_RATIO": 9.99}, False),
    ],
)
def test_a_zip_may_become_as_large_as_each_limit_says(tmp_path, monkeypatch, limits, fits):
    """3000 bytes in a zip of 300, counted as its list of files counts them."""
    for name, value in limits.items():
        monkeypatch.setattr(archive, name, value)
    path = zipped(tmp_path / "a.zip", {"a.png": bytes(1000), "b.png": bytes(2000)})
    with zipfile.ZipFile(path, "a") as file:
        file.comment = bytes(300 - path.stat().st_size)
    assert path.stat().st_size == 300
    with zipfile.ZipFile(path) as file:
        if fits:
            assert len(archive._check(file, path)) == 2
        else:
            with pytest.raises(CaptureError) as caught:
                archive._check(file, path)
            assert caught.value.code == "zip-large"


def test_files_that_share_their_bytes_are_refused(tmp_path):
    """A list that names the same bytes twice sums up to more than the zip."""
    path = zipped(tmp_path / "a.zip", {"a.png": os.urandom(1000), "b.png": os.urandom(1000)})
    with zipfile.ZipFile(path) as file:
        for entry in file.infolist():
            entry.compress_size = path.stat().st_size // 2
        assert len(archive._check(file, path)) == 2
        file.infolist()[0].compress_size += 2
        with pytest.raises(CaptureError, match="times its size"):
            archive._check(file, path)


def test_damaged_zips(tmp_path):
    path = zipped(tmp_path / "a.zip", photographs(tmp_path))
    data = path.read_bytes()
    for changed in (b"", b"no zip at all", data[:-30], data[:200] + bytes(200) + data[400:]):
        path.write_bytes(changed)
        error = refused("zip-damaged", path, work=tmp_path / "work")
        assert "copy it again" in error.remedy
    assert list((tmp_path / "work").iterdir()) == []


# several folders


def test_several_folders_are_one_capture(tmp_path, run):
    left = write(tmp_path / "left", ["IMG_1.png", "IMG_2.png", "only.png"])
    right = tmp_path / "right" / "images"
    right.mkdir(parents=True)
    for number in (1, 2, 3):
        picture(10 + number).save(right / f"IMG_{number}.png")
    opened = open_any(left, also=[tmp_path / "right"])
    names = ("left/IMG_1.png", "left/IMG_2.png", "right/images/IMG_1.png", "right/images/IMG_2.png")
    assert set(opened.names) == {*names, "IMG_3.png", "only.png"} and opened.root == tmp_path
    assert opened.format == "folder"
    code, out, _ = run("inspect", left, tmp_path / "right")
    assert code == 0 and f"eigenfield encode {left} {tmp_path / 'right'} -o" in out
    refused("folders-twice", left, also=[tmp_path / "left"])
    refused("capture-missing", left, also=[tmp_path / "nowhere"])
    refused("names-unknown", left, also=[write(tmp_path / "none", [])])
    refused("folders-options", left, also=[right], grid=(2, 3))
    refused("folders-cameras", left, open_capture, also=[right])
    write(tmp_path / "third", ["a.png"])
    assert "if they are one capture" in refused("photographs-missing", tmp_path).remedy
