"""Depth maps and measures that workers make: the same bytes as in one process, and nothing finished made twice."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eigenfield.core.errors import WorkerError
from eigenfield.proxy.surface import multiview
from eigenfield.runtime.executor import open_executor
from eigenfield.runtime.parts import Parts
from support.captures import write_capture
from support.motion import photographed


def build_number(folder, number):
    (folder / "number").write_text(str(number))
    with (folder.parent / "made").open("a") as file:
        file.write(f"{number}\n")


def test_finished_parts_are_taken_up(tmp_path):
    with open_executor() as workers:
        parts = Parts(workers, tmp_path, "of this capture")
        places = parts.make("n", build_number, [(1,), (2,), (3,)], 1e6)
        assert (next(places) / "number").read_text() == "1"
        places.close()  # the run is killed here
        made = [int(line) for line in (tmp_path / "made").read_text().split()]
        assert made in ([1], [1, 2], [1, 2, 3])
        again = [(place / "number").read_text() for place in parts.make("n", build_number, [(1,), (2,), (3,)], 1e6)]
        assert again == ["1", "2", "3"] and sorted((tmp_path / "made").read_text().split()) == ["1", "2", "3"]
        other = Parts(workers, tmp_path, "of another")
        assert len(list(other.make("n", build_number, [(4,)], 1e6))) == 1


def test_a_part_meets_no_worker_that_has_too_little_memory(tmp_path, monkeypatch):
    monkeypatch.setattr("eigenfield.runtime.executor.machine_memory", lambda: 1e9)
    with open_executor(1) as workers:
        parts = Parts(workers, tmp_path, "of this capture")
        with pytest.raises(WorkerError, match=r"needs about 2\.0 GB of memory, and no worker has more than 1\.0 GB"):
            list(parts.make("n", build_number, [(1,)], 2e9))
    assert not (tmp_path / "made").exists()


def picture(index, rng):
    from eigenfield.core.camera import Camera

    K = np.array([[60.0, 0, 24], [0, 60.0, 18], [0, 0, 1]])
    camera = Camera(K, np.eye(3), np.array([-0.1 * index, 0.0, 0.0]), 48, 36)
    pixels = rng.integers(0, 255, (36, 48, 3)).astype(np.uint8)
    return multiview.WorkingPicture(camera, np.roll(pixels, 0, 1), None, None)


@pytest.mark.slow
def test_workers_make_the_same_depth_maps(tmp_path):
    rng = np.random.default_rng(0)
    wide = rng.integers(0, 255, (36, 80, 3)).astype(np.uint8)
    pictures = []
    for index in range(4):
        one = picture(index, rng)
        pictures.append(multiview.WorkingPicture(one.camera, wide[:, 2 * index : 2 * index + 48].copy(), None, None))
    points = np.stack([*np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)), np.full((9, 9), 3.0)], -1)
    points = points.reshape(-1, 3) + rng.normal(0, 0.3, (81, 3))
    here, tolerance = multiview._depth_views(pictures, points, None, None)
    with open_executor(2) as workers:
        there, other = multiview._depth_views(pictures, points, Parts(workers, tmp_path, "x"), None)
    assert tolerance == other and len(here) == len(there) == 4
    for a, b in zip(here, there, strict=True):
        assert a.inverse_depth.any() and a.inverse_depth.tobytes() == b.inverse_depth.tobytes()


@pytest.mark.slow
def test_workers_measure_the_same(run, fitted):
    folder, scene = fitted
    here, there = (run("evaluate", scene, folder, "-q", "--json", *words) for words in ([], ["--workers", 2]))
    assert here.code == there.code == 0, there.err
    figures = [{key: value for key, value in json.loads(ran.out).items() if key != "seconds"} for ran in (here, there)]
    assert figures[0] == figures[1] and len(figures[0]["cameras"]) == 9
    assert not list(scene.parent.glob(".eigenfield-shared*"))


@pytest.mark.slow
def test_workers_make_the_same_texture_maps(run, tmp_path):
    folder = write_capture(tmp_path / "nine")
    words = ["--proxy", folder / "proxy.ply", "--max-angle", 15, "--textures", 2, "--atlas", 64, "-q"]
    for name, more in (("here", []), ("there", ["--workers", 1])):
        ran = run("encode", folder, "-o", tmp_path / f"{name}.glb", *words, *more)
        assert ran.code == 0, ran.err
    assert (tmp_path / "here.glb").read_bytes() == (tmp_path / "there.glb").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["here.glb", "nine", "there.glb"]
    next((folder / "images").iterdir()).write_bytes(b"no picture")
    code, _, err = run("encode", folder, "-o", tmp_path / "bad.glb", *words, "--workers", 1)
    assert code == 2 and err.count("\n") == 1 and "images/" in err, err


@pytest.mark.parametrize("words", [["--workers", "0"], ["--workers", "2", "--proxy", "PROXY"]])
def test_workers_that_make_no_sense_are_one_line(run, tmp_path, words):
    folder = write_capture(tmp_path / "nine")
    words = [str(folder / "proxy.ply") if word == "PROXY" else word for word in words]
    code, _, err = run("encode", folder, "-q", "-o", tmp_path / "a.glb", *words)
    assert code == 2 and err.count("\n") == 1 and "workers" in err, err


@pytest.mark.slow
def test_a_surface_from_all_sides_gives_the_same_bytes(run, tmp_path):
    photographed(tmp_path / "photos")
    words = ["--surface", "poisson", "--fit", "none", "--atlas", 256, "-q"]
    for name, more in (("here", []), ("there", ["--workers", 2])):
        ran = run("encode", tmp_path / "photos", "-o", tmp_path / f"{name}.glb", *words, *more)
        assert ran.code == 0, ran.err
    assert (tmp_path / "here.glb").read_bytes() == (tmp_path / "there.glb").read_bytes()
    assert not (tmp_path / "there.work" / "parts").exists()
