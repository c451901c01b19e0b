"""Stages of long work: whole or absent, taken up again, keyed by all they depend on."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time

import pytest

from eigenfield.core.errors import OutputError
from eigenfield.runtime import stages
from eigenfield.runtime.stages import (
    PACKAGE_FOLDER,
    SCENE_ROOMS,
    SURFACE_ROOMS,
    Stages,
    code_version,
    file_digest,
    stage_key,
)


def test_a_finished_stage_is_taken_up(tmp_path):
    calls = []

    def build(folder):
        calls.append(folder)
        (folder / "result.txt").write_text("whole")

    for _ in range(2):
        place = Stages(tmp_path / "work").run("depth", stage_key(["a", 1]), build)
        assert (place / "result.txt").read_text() == "whole"
    assert len(calls) == 1
    Stages(tmp_path / "work").run("depth", stage_key(["a", 2]), build)
    assert len(calls) == 2


def test_a_failed_stage_leaves_nothing(tmp_path):
    def build(folder):
        (folder / "half.txt").write_text("half")
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        Stages(tmp_path).run("depth", "k", build)
    assert list(tmp_path.iterdir()) == []


def test_without_a_folder_nothing_stays():
    with Stages(None) as stages:
        place = stages.run("depth", "k", lambda folder: (folder / "x").write_text("y") and None)
        assert place.is_dir()
    assert not place.exists()


def test_keys_know_the_files_bytes_and_the_options(tmp_path):
    file = tmp_path / "a.png"
    file.write_bytes(b"one")
    first = stage_key([file_digest(file), {"refine": True}])
    assert first == stage_key([file_digest(file), {"refine": True}])
    assert first != stage_key([file_digest(file), {"refine": False}])
    file.write_bytes(b"two")
    assert first != stage_key([file_digest(file), {"refine": True}])


def test_keys_do_not_know_the_order_of_options_and_know_the_program(tmp_path, monkeypatch):
    key = stage_key([{"a": 1, "b": tmp_path}, 2])
    assert key == stage_key([{"b": str(tmp_path), "a": 1}, 2]) and re.fullmatch("[0-9a-f]{16}", key)
    assert key != stage_key([{"a": 1, "b": tmp_path}, 2], SCENE_ROOMS)
    monkeypatch.setattr(stages, "code_version", lambda rooms: "another")
    assert key != stage_key([{"a": 1, "b": tmp_path}, 2])


def test_a_stage_that_another_run_finishes_first_is_taken_as_it_is(tmp_path):
    def build(folder):
        (folder / "who").write_text("we")
        (tmp_path / "depth-k").mkdir()
        (tmp_path / "depth-k" / "who").write_text("they")

    place = Stages(tmp_path).run("depth", "k", build)
    assert (place / "who").read_text() == "they" and list(tmp_path.iterdir()) == [place]


def test_a_stage_that_cannot_appear_is_said(tmp_path):
    with pytest.raises(OutputError):
        Stages(tmp_path).run("depth", "k", lambda folder: (tmp_path / "depth-k").write_text("a file") and None)


@pytest.mark.parametrize("makers", [SURFACE_ROOMS, SCENE_ROOMS])
def test_the_fingerprint_is_that_of_the_rooms_that_make_stages(tmp_path, makers):
    rooms = (*SCENE_ROOMS, "viewer")
    sources = [tmp_path / room / "inner" / "work.py" for room in rooms]
    for source in sources:
        source.parent.mkdir(parents=True)
        source.write_text("first")
    before = code_version(makers, tmp_path)
    for room, source in zip(rooms, sources, strict=True):
        source.write_text("second")
        code_version.cache_clear()
        assert (code_version(makers, tmp_path) != before) == (room in makers), room
        source.write_text("first")
    code_version.cache_clear()
    assert code_version(makers, tmp_path) == before
    sources[0].rename(sources[0].with_name("other.py"))
    code_version.cache_clear()
    assert code_version(makers, tmp_path) != before
    assert code_version(makers) not in (before, code_version(makers, tmp_path))


def test_the_rooms_that_make_stages_are_there():
    assert all((PACKAGE_FOLDER / room / "__init__.py").is_file() for room in SCENE_ROOMS)
    assert "calibration" in SURFACE_ROOMS and "encoding" not in SURFACE_ROOMS
    assert set(SURFACE_ROOMS) | {"encoding", "coding", "gltf", "rendering"} == set(SCENE_ROOMS)


def test_a_place_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "work").write_text("a file")
    with pytest.raises(OutputError, match="work"):
        Stages(tmp_path / "work")


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_what_a_killed_run_left_is_removed_by_the_next(tmp_path):
    code = (
        "import sys, time; from pathlib import Path; from eigenfield.runtime.stages import Stages\n"
        "def build(folder):\n"
        "    (folder / 'half').write_text('x'); print('ready', flush=True); time.sleep(60)\n"
        f"Stages(Path({str(tmp_path)!r})).run('depth', 'k', build)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"ready\n"
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    time.sleep(0.05)
    assert [p.name.endswith(".part") for p in tmp_path.iterdir()] == [True]
    place = Stages(tmp_path).run("depth", "k", lambda folder: (folder / "whole").write_text("x") and None)
    assert [p.name for p in tmp_path.iterdir()] == ["depth-k"]
    assert (place / "whole").exists()
