"""Structure from motion on drawn photographs with known cameras, and on what people do wrong."""

from __future__ import annotations

import json
import os
import signal
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from eigenfield.calibration import (
    KnownLens,
    SfmResult,
    calibration_error,
    structure_from_motion,
)
from eigenfield.calibration.align import angle_between
from eigenfield.calibration.lenses import undistort_pixels
from eigenfield.calibration.motion.features import FeatureOptions, extract_features_of
from eigenfield.calibration.motion.matching import choose_pairs
from eigenfield.capture import GridLayout, Lens, LightField, PhotoSet, Shot, open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError, OutputError
from eigenfield.rendering import draw_texture
from eigenfield.runtime.executor import open_executor
from eigenfield.runtime.parallel import set_threads, threads
from eigenfield.runtime.parts import Parts
from support.motion import HEIGHT, WIDTH, K, cameras, photographed, picture, relief, spotted


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> tuple[PhotoSet, LightField]:
    """Five photographs and the truth."""
    return photographed(tmp_path_factory.mktemp("scene") / "photos")


@pytest.fixture(scope="module")
def kept(scene: tuple[PhotoSet, LightField], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A work folder in which features and matches are finished: the run was killed then."""

    class KilledError(Exception):
        pass

    def kill(stage: str, done: int, total: int) -> None:
        if stage == "cameras":
            raise KilledError

    folder = tmp_path_factory.mktemp("work")
    with pytest.raises(KilledError):
        structure_from_motion(scene[0], intrinsics=KnownLens(K), work=folder, progress=kill)
    return folder


@pytest.fixture(scope="module")
def solved(scene: tuple[PhotoSet, LightField], kept: Path) -> SfmResult:
    """Their cameras, by known intrinsics: the killed run goes on from its matches."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("eigenfield.calibration.motion.cache.extract_features", None)  # calling it would fail
        patch.setattr("eigenfield.calibration.motion.cache.match_pairs", None)
        return structure_from_motion(scene[0], intrinsics=KnownLens(K), work=kept)


@pytest.fixture(autouse=True, scope="module")
def strong_features() -> Iterator[None]:
    """Small photographs have few features: looking for weaker ones, as the temple needs, takes four times as long."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("eigenfield.calibration.motion.features.FEATURE_MIN_MEDIAN_COUNT", 0)
        yield


def with_shots(photos: PhotoSet, *shots: Shot) -> PhotoSet:
    return replace(photos, shots=(*photos.shots, *shots))


def numbers(field: LightField) -> bytes:
    return b"".join(c.K.tobytes() + c.R.tobytes() + c.t.tobytes() for c in field.cameras)


# what works


@pytest.mark.slow
def test_workers_find_the_same_features_and_matches(scene, kept, tmp_path, monkeypatch):
    monkeypatch.setattr("eigenfield.calibration.motion.on_workers.PHOTOGRAPHS_A_TASK", 2)
    monkeypatch.setattr("eigenfield.calibration.motion.on_workers.PAIRS_A_TASK", 4)
    monkeypatch.setattr("eigenfield.calibration.motion.sfm.map_views", lambda *_: None)
    with open_executor(1) as workers, pytest.raises(CaptureError):
        parts = Parts(workers, tmp_path / "parts", "of this capture")
        parts.folder.mkdir()
        structure_from_motion(scene[0], intrinsics=KnownLens(K), work=tmp_path / "work", parts=parts)
    here, there = (
        {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*.npz")}
        for folder in (kept, tmp_path / "work")
    )
    assert len(here) == 6 and here == there
    made = [place.name.split("-")[0] for place in parts.folder.iterdir() if place.is_dir()]
    assert made.count("features") == 3 and made.count("matches") == 3


def test_cameras_with_known_lens_are_found(scene, solved):
    photos, truth = scene
    motion = solved
    assert motion.light_field.names == photos.names
    error = calibration_error(motion.light_field, truth)
    assert error.rotation.max() < 0.1 and error.position.max() < 0.002
    assert all(np.array_equal(camera.K, K) for camera in motion.light_field.cameras)
    assert len(motion.points) > 200 and motion.points.track_lengths.min() >= 2
    assert all(entry.registered and entry.error < 0.5 and entry.observations > 30 for entry in motion.report)


def test_points_lie_where_the_photographs_show_them(scene, solved):
    _, truth = scene
    motion = solved
    points = motion.points
    assert len(motion.light_field.cameras) == len(truth.cameras)
    for index, camera in enumerate(motion.light_field.cameras):
        here = points.view == index
        pixels, depth = camera.project(points.positions[points.point[here]])
        assert (depth > 0).all()
        assert np.median(np.linalg.norm(pixels - points.pixels[here], axis=1)) < 0.5
        column, row = points.pixels[here].astype(int).T
        shown = truth.photograph(index).pixels[row, column]
        assert np.median(np.abs(shown - points.colours[points.point[here]] / 255)) < 0.1


@pytest.mark.slow
def test_a_focal_length_is_found_where_none_is_known(scene):
    photos, truth = scene
    motion = structure_from_motion(photos)
    assert len(motion.light_field) == len(photos)
    error = calibration_error(motion.light_field, truth)
    assert np.abs(error.focal).max() < 0.05 and error.position.max() < 0.02


@pytest.mark.slow
def test_any_number_of_threads_and_a_work_folder_give_the_same_cameras(scene, solved):
    set_threads(1 if threads() > 1 else 3)
    try:
        motion = structure_from_motion(scene[0], intrinsics=KnownLens(K))
    finally:
        set_threads(None)
    assert numbers(motion.light_field) == numbers(solved.light_field)
    assert motion.points.positions.tobytes() == solved.points.positions.tobytes()


def test_the_world_is_the_natural_gauge(solved):
    field = solved.light_field
    centres = np.array([camera.centre for camera in field.cameras])
    np.testing.assert_allclose(centres.mean(axis=0), 0, atol=1e-9)
    gaps = np.linalg.norm(centres[:, None] - centres[None], axis=2) + np.diag([np.inf] * len(centres))
    assert np.median(gaps.min(axis=1)) == pytest.approx(1)
    mean = sum(camera.R for camera in field.cameras) / len(field)
    assert angle_between(np.linalg.svd(mean)[0] @ np.linalg.svd(mean)[2], np.eye(3)) < 1e-6


@pytest.mark.slow
def test_a_known_lens_is_kept_and_its_distortion_understood(scene, tmp_path):
    """The photographs bent by a strong lens: the cameras come out as before."""
    photos, truth = scene
    lens = KnownLens(K, Lens("brown", (-0.25, 0.05, 0.001, -0.002, 0.0)))
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    straight = undistort_pixels(np.column_stack([u.ravel(), v.ravel()]), lens).reshape(HEIGHT, WIDTH, 2) - 0.5
    shots = []
    for index, shot in enumerate(photos.shots):
        pixels = truth.photograph(index).pixels
        bent = cv2.remap(pixels, *straight.astype(np.float32).transpose(2, 0, 1), cv2.INTER_CUBIC)
        shots.append(picture(tmp_path, shot.name, np.clip(bent, 0, 1)))
    bent_photos = replace(photos, root=tmp_path, shots=tuple(shots))
    motion = structure_from_motion(bent_photos, intrinsics=lens)
    error = calibration_error(motion.light_field, truth)
    assert error.rotation.max() < 0.15 and error.position.max() < 0.003
    assert all(view.lens == lens.lens for view in motion.light_field.views)


# what people do wrong


@pytest.mark.slow
def test_photographs_that_do_not_belong_are_named_and_a_twin_stands_in_its_place(scene, tmp_path):
    photos, truth = scene
    blank = picture(tmp_path, "blank.png", np.full((HEIGHT, WIDTH, 3), 0.5))
    other = picture(tmp_path, "other.png", spotted(99)[:HEIGHT, :WIDTH])
    blurred = cv2.GaussianBlur(truth.photograph(2).pixels, (0, 0), 12)
    soft = picture(tmp_path, "soft.png", np.clip(blurred, 0, 1))
    (tmp_path / "cut.png").write_bytes(photos.shots[0].path.read_bytes()[:5000])
    cut = Shot("cut.png", tmp_path / "cut.png", WIDTH, HEIGHT)
    (tmp_path / "twin.png").write_bytes(photos.shots[3].path.read_bytes())
    twin = Shot("twin.png", tmp_path / "twin.png", WIDTH, HEIGHT)
    motion = structure_from_motion(with_shots(photos, blank, other, soft, cut, twin), intrinsics=KnownLens(K))
    assert motion.light_field.names == (*photos.names, "twin.png")
    found = {entry.name: entry.code for entry in motion.report if not entry.registered}
    assert found == {
        "blank.png": "few-features", "other.png": "few-matches", "soft.png": "few-features", "cut.png": "unreadable"
    }  # fmt: skip
    assert len(motion.light_field.problems) == 4
    assert any("other.png has no camera: too few matches" in line for line in motion.light_field.problems)
    error = calibration_error(motion.light_field, truth)
    assert error.rotation.max() < 0.1
    a, b = motion.light_field.cameras[3], motion.light_field.cameras[5]
    assert np.linalg.norm(a.centre - b.centre) < 0.01 and angle_between(a.R, b.R) < 0.05


@pytest.mark.slow
def test_a_second_scene_is_named_as_a_group_apart(scene, tmp_path):
    photos, _ = scene
    mesh, texture = relief(), spotted(5)
    shots = [
        picture(tmp_path, f"second_{i}.png", draw_texture(mesh, texture, camera, samples=1).image)
        for i, camera in enumerate(cameras(5)[1:4])
    ]
    motion = structure_from_motion(with_shots(photos, *shots), intrinsics=KnownLens(K))
    assert motion.light_field.names == photos.names
    lost = [entry for entry in motion.report if not entry.registered]
    assert [entry.code for entry in lost] == ["apart"] * 3
    assert "no view to register against" in lost[0].reason and "second_1.png" in lost[0].reason


def test_too_few_photographs_and_rectified_grids_are_refused(scene):
    photos, _ = scene
    with pytest.raises(CaptureError) as error:
        structure_from_motion(photos.subset([0, 1]))
    assert error.value.code == "too-few"
    line = np.arange(len(photos))
    layout = GridLayout(line * 0, line, np.column_stack([line, line * 0]).astype(float), rectified=True)
    with pytest.raises(CaptureError) as error:
        structure_from_motion(replace(photos, layout=layout))
    assert error.value.code == "planar-rectified" and "encode" in str(error.value)


@pytest.mark.parametrize(
    ("kind", "words"), [("blank", "too few features"), ("foreign", "share too little"), ("still", "show no depth")]
)
@pytest.mark.slow
def test_photographs_that_make_no_scene_fail_in_one_line(kind, words, scene, tmp_path):
    photos, truth = scene
    pictures = {
        "blank": [np.full((HEIGHT, WIDTH, 3), 0.4)] * 4,
        "foreign": [spotted(seed)[:HEIGHT, :WIDTH] for seed in (11, 12, 13, 14)],
        "still": [truth.photograph(0).pixels] * 4,  # a camera on a tripod: no parallax
    }[kind]
    shots = [picture(tmp_path, f"{i}.png", pixels) for i, pixels in enumerate(pictures)]
    with pytest.raises(CaptureError) as error:
        structure_from_motion(replace(photos, root=tmp_path, shots=tuple(shots)), intrinsics=KnownLens(K))
    assert error.value.code == "calibration-failed" and words in str(error.value)
    assert "\n" not in str(error.value) and error.value.remedy


def test_intrinsics_must_be_as_many_as_photographs(scene):
    with pytest.raises(OptionError) as error:
        structure_from_motion(scene[0], intrinsics=[KnownLens(K)] * 2)
    assert error.value.code == "intrinsics-count"


def test_features_stay_within_the_mask(scene, tmp_path):
    photos, _ = scene
    mask = np.zeros((HEIGHT, WIDTH, 3))
    mask[:, 100:200] = 1
    hidden = picture(tmp_path, "mask.png", mask)
    found = extract_features_of(replace(photos.shots[0], mask=hidden.path), FeatureOptions())
    whole = extract_features_of(photos.shots[0], FeatureOptions())
    assert 20 < len(found) < len(whole)
    assert (found.points[:, 0] >= 100).all() and (found.points[:, 0] < 200).all()


def test_features_of_a_reduced_photograph_lie_in_its_own_pixels(scene):
    photos, _ = scene
    whole = extract_features_of(photos.shots[0], FeatureOptions())
    half = extract_features_of(photos.shots[0], FeatureOptions(max_side=WIDTH // 2))
    nearest = np.linalg.norm(half.points[:, None] - whole.points[None], axis=2).min(axis=1)
    assert len(half) > 30 and np.median(nearest) < 1.0


def test_an_exception_of_the_progress_ends_it(scene, kept):
    class EnoughError(Exception):
        pass

    def report(stage: str, done: int, total: int) -> None:
        if stage == "cameras" and done > 2:
            raise EnoughError

    with pytest.raises(EnoughError):
        structure_from_motion(scene[0], intrinsics=KnownLens(K), work=kept, progress=report)


# which photographs are compared


def layout_of(rows: int, columns: int) -> GridLayout:
    r, c = np.divmod(np.arange(rows * columns), columns)
    return GridLayout(r, c, np.column_stack([c, -r]).astype(float), measured=True)


def test_pairs_of_a_grid_are_neighbours_and_join_it_all():
    pairs = choose_pairs([None] * 54, "grid", layout_of(6, 9))
    assert pairs == sorted(set(pairs)) and all(i < j for i, j in pairs)
    joined = {0}
    for _ in range(54):
        joined |= {j for i, j in pairs if i in joined} | {i for i, j in pairs if j in joined}
    assert len(joined) == 54
    assert (0, 1) in pairs and (0, 9) in pairs and (0, 53) not in pairs
    assert choose_pairs([None] * 54, "positions", layout_of(6, 9)) == choose_pairs([None] * 54, "auto", layout_of(6, 9))


def test_similar_photographs_are_found(scene):
    photos, _ = scene
    features = [extract_features_of(shot, FeatureOptions()) for shot in photos.shots]
    pairs = choose_pairs(features, "similar", None)
    assert {(i, i + 1) for i in range(4)} <= set(pairs) <= set(choose_pairs(features, "exhaustive", None))


def test_a_layout_is_needed_to_match_by_it():
    with pytest.raises(OptionError) as error:
        choose_pairs([None] * 4, "grid", None)
    assert error.value.code == "matching-layout"
    with pytest.raises(OptionError):
        choose_pairs([None] * 4, "vocabulary", None)  # type: ignore[arg-type]


# the verb


@pytest.mark.slow
def test_the_verb_writes_what_inspect_and_open_capture_read(scene, tmp_path, run):
    photos, truth = scene
    (tmp_path / "K.txt").write_text("\n".join(" ".join(map(str, row)) for row in K))
    folder = tmp_path / "photos"
    folder.symlink_to(photos.root, target_is_directory=True)
    code, said, err = run("calibrate", folder, "--intrinsics", tmp_path / "K.txt", "--quiet")
    assert (code, err) == (0, "")  # nothing of COLMAP's log, which goes past Python, if it goes anywhere
    assert "5 of 5 photographs registered" in said
    out = tmp_path / "photos-calibration"
    assert sorted(p.name for p in out.iterdir()) == ["points.ply", "report.json", "sparse", "transforms.json"]
    report = json.loads((out / "report.json").read_text())
    assert report["registered"] == 5 and [v["name"] for v in report["views"]] == list(photos.names)
    field = open_capture(folder, calibration=out / "transforms.json")
    assert calibration_error(field, truth).position.max() < 0.002
    code, seen, _ = run("inspect", folder, "--calibration", out / "transforms.json", "--json")
    assert code == 0 and json.loads(seen)["views"] == 5
    # nothing is replaced unasked
    before = (out / "transforms.json").read_bytes()
    with pytest.raises(OutputError) as error:
        run("calibrate", folder, "--traceback")
    assert error.value.code == "output-exists"
    assert (out / "transforms.json").read_bytes() == before


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_the_mapping(scene, kept):
    """The progress is called from COLMAP's thread; the signal reaches the one that waits for it."""

    def report(stage: str, done: int, total: int) -> None:
        if stage == "cameras" and done == 2:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.5)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where a shell runs the tests behind it
    try:
        with pytest.raises(KeyboardInterrupt):
            structure_from_motion(scene[0], intrinsics=KnownLens(K), work=kept, progress=report)
    finally:
        signal.signal(signal.SIGINT, before)


# real captures


def strecha(folder: Path) -> tuple[PhotoSet, LightField]:
    shots, true = [], []
    for path in sorted((folder / "images").glob("*.jpg")):
        v = np.array((folder / "gt_dense_cameras" / f"{path.name}.camera").read_text().split(), float)
        R = v[12:21].reshape(3, 3).T
        true.append(Camera.from_matrices(v[:9].reshape(3, 3), R, -R @ v[21:24], 1536, 1024, path.name))
        shots.append(Shot(path.name, path, 1536, 1024))
    photos = PhotoSet(folder / "images", tuple(shots), None, (), "folder")
    return photos, photos.with_cameras(true)


def middlebury(folder: Path) -> tuple[PhotoSet, LightField]:
    shots, true = [], []
    for line in (folder / "templeSR_par.txt").read_text().splitlines()[1:]:
        name, *rest = line.split()
        v = np.array(rest, float)
        true.append(Camera.from_matrices(v[:9].reshape(3, 3), v[9:18].reshape(3, 3), v[18:], 640, 480, name))
        shots.append(Shot(name, folder / "images" / name, 640, 480))
    photos = PhotoSet(folder / "images", tuple(shots), None, (), "folder")
    return photos, photos.with_cameras(true)


@pytest.mark.slow
def test_the_fountain_is_calibrated_to_its_truth(data):
    photos, truth = strecha(data / "fountain_P11_half")
    known = [KnownLens(camera.K) for camera in truth.cameras]
    field = structure_from_motion(photos, intrinsics=known).light_field
    error = calibration_error(field, truth)
    assert len(field) == 11 and error.rotation.max() < 0.1 and error.position.max() < 0.001


@pytest.mark.slow
def test_the_temple_is_calibrated_to_its_truth(data):
    photos, truth = middlebury(data / "temple_ring16")
    known = [KnownLens(camera.K) for camera in truth.cameras]
    field = structure_from_motion(photos, intrinsics=known).light_field
    error = calibration_error(field, truth)
    assert len(field) >= 13 and error.rotation.max() < 0.6 and error.position.max() < 0.005
