"""The parts of the Blender add-on that need no Blender: the program beside it, and what a spacing promises."""

from __future__ import annotations

import importlib
import sys
import time
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from eigenfield.encoding import verdict
from eigenfield.gltf import container, save
from support.clips import numbered_clip
from support.scenes import tiny_scene

ADDON = Path(__file__).parents[1] / "addons/blender/eigenfield"
FRAME = -1.0, 1.0, -0.5, 0.5  # at depth 1
LINE = """import sys
print('{"step": "depth", "stage": "views", "done": 1, "total": 4, "part": null, "left": ""}', file=sys.stderr)
"""


package = ModuleType("addon")
package.__path__ = [str(ADDON)]
sys.modules["addon"] = package
clip, parallax, program = (importlib.import_module(f"addon.{name}") for name in ("clip", "parallax", "program"))


def run(script: str, *words: str):
    return program.Job(sys.executable, "-c", script, *words)


def wait(job, seconds: float = 20.0) -> None:
    until = time.monotonic() + seconds
    while job.is_running:
        assert time.monotonic() < until
        time.sleep(0.01)


def test_a_job_tells_how_far_it_is_and_what_was_said():
    job = run(LINE + "print('first'); print('second'); print('a note', file=sys.stderr)")
    assert job in program.running
    wait(job)
    assert job.output == ["first", "second"] and job.said == "a note" and job.error is None
    assert job.part == 0.25 and job.words == "depth"
    assert job not in program.running
    job.progress = {**job.progress, "part": 0.5, "left": "about 3 min left", "note": "compiling"}
    assert job.part == 0.5 and job.words == "depth, about 3 min left, compiling"


def test_a_job_that_says_much_does_not_wait_for_its_reader():
    job = run("import sys\nfor _ in range(20000): print('x' * 20, file=sys.stderr); print('y' * 20)")
    wait(job)
    assert len(job.output) == 20000


def test_the_error_of_a_job_is_the_program_s_own_line(tmp_path):
    job = program.Job(sys.executable, "-m", "eigenfield", "info", tmp_path / "no.glb")
    wait(job)
    assert job.error.startswith("eigenfield: ") and str(tmp_path / "no.glb") in job.error
    silent = run("raise SystemExit(3)")
    wait(silent)
    assert silent.error == f"{sys.executable} failed"
    with pytest.raises(program.RefusalError, match="does not run"):
        program.Job(str(tmp_path / "none"))


def test_a_job_is_waited_for_and_stopped_where_nobody_waits():
    job = run(LINE + "import time; time.sleep(0.5); print('all')")
    said = list(job.steps())
    assert said[0][0] in (0, 0.25) and said[-1] == (0.25, "depth") and job.output == ["all"]
    with pytest.raises(program.RefusalError, match="no more"):
        list(run("import sys; print('no more', file=sys.stderr); sys.exit(2)").steps())
    job = run("import time; time.sleep(60)")
    steps = job.steps()
    next(steps)
    steps.close()
    wait(job)
    assert job.stopped


def test_jobs_end_with_blender_and_are_no_errors_then():
    jobs = [run("import time; time.sleep(60)") for _ in range(2)]
    program.stop_all()
    for job in jobs:
        wait(job)
        assert job.error is None


def test_a_program_is_looked_for(monkeypatch):
    assert program.find_program("/opt/it") == "/opt/it"
    monkeypatch.setenv("PATH", "")
    with pytest.raises(program.RefusalError, match="name it in the add-on's preferences"):
        program.find_program("")


def box(low, high):
    """(8, 3) corners in Blender's order."""
    return np.array([[(low, high)[int(bit)][axis] for axis, bit in enumerate(bits)] for bits in BITS], float)


BITS = "000", "001", "011", "010", "100", "101", "111", "110"


@pytest.mark.parametrize(
    ("boxes", "wanted"),
    [
        ([((-1, -1, -5), (1, 1, -3))], (3, 5)),
        ([((-1, -1, 3), (1, 1, 5))], None),  # behind the camera
        ([((9, -1, -3), (11, 1, -2))], None),  # beside the picture
        ([((-90, -2, -50), (90, -2, 50))], (4, 50)),  # a floor below: it is seen from where the picture ends
        ([((-4, -2, -6), (4, 2, 6))], (4, 6)),  # a room around the camera: its floor, its far wall
        ([((-1, -1, -5), (1, 1, -3)), ((0, 0, -40), (0.1, 0.1, -30))], (3, 40)),
        ([((-2, -0.1, -0.4), (2, 0.1, 0.4))], (0.2, 0.4)),  # across the camera: what is before its near end
        ([], None),
    ],
)
def test_depths_are_those_of_surfaces_in_view(boxes, wanted):
    corners = np.array([box(*each) for each in boxes]).reshape(-1, 8, 3)
    found = parallax.depth_range(corners, FRAME, 0.1)
    assert found == (None if wanted is None else pytest.approx(wanted))


def test_parallax_and_overlap_have_their_closed_forms():
    assert parallax.parallax_pixels(0.1, 1000, 2, 5) == pytest.approx(0.1 * 1000 / 2 - 0.1 * 1000 / 5)
    assert parallax.overlap_part(0.1, 1000, 2, 2, (200, 100)) == pytest.approx(0.5)
    assert parallax.overlap_part(0.1, 1000, 2, 2, (200,)) == pytest.approx(0.75)
    assert parallax.overlap_part(0.1, 1000, 2, 2, (100,), plane=2) == 1
    assert parallax.overlap_part(1, 1000, 2, 2, (100,)) == pytest.approx(-4)


@pytest.mark.parametrize("ratio", [0.0, 0.015, 0.016, 0.073, 0.074])
@pytest.mark.parametrize("overlap", [0.59, 0.6, 1.0])
def test_the_word_is_that_of_inspect(ratio, overlap):
    assert parallax.word_of(ratio, overlap) == verdict.verdict_beforehand(ratio, overlap, "").word
    assert parallax.MEANINGS == verdict.MEANINGS


def test_the_longest_good_spacing_is_at_a_limit():
    for spacing in (0.01, 0.3):
        ratio = parallax.parallax_pixels(spacing, 1000, 2, 3) / 800
        overlap = parallax.overlap_part(spacing, 1000, 2, 3, (800, 600))
        longest = spacing * parallax.good_factor(ratio, overlap)
        assert longest == pytest.approx(0.015 * 800 / 1000 / (1 / 2 - 1 / 3))
    assert parallax.good_factor(0.0, 0.2) == pytest.approx(0.5)
    assert parallax.good_factor(0.0, 1.0) == np.inf


@pytest.fixture
def clip_file(tmp_path):
    save(numbered_clip((3, 2)), tmp_path / "clip.glb")
    return tmp_path / "clip.glb"


def test_a_clip_is_known_by_its_chunk_of_groups(clip_file, tmp_path):
    assert container.GROUPS_CHUNK == clip.GROUPS_CHUNK and clip.is_clip(clip_file)
    data = clip_file.read_bytes()
    clip_file.write_bytes(data[:-8])  # within its last group
    assert clip.is_clip(clip_file)
    for damaged in (b"", b"glTF", data[:40], b"ply" + data[3:]):
        clip_file.write_bytes(damaged)
        assert not clip.is_clip(clip_file)
    save(tiny_scene(), tmp_path / "scene.glb")
    assert not clip.is_clip(tmp_path / "scene.glb")


def test_the_program_says_when_frames_are_shown(clip_file, monkeypatch):
    monkeypatch.setattr(clip, "Job", lambda found, *words: program.Job(sys.executable, *found, *words))
    steps, found = clip.timeline_steps(clip_file, ["-m", "eigenfield"]), None
    while found is None:
        try:
            next(steps)
        except StopIteration as stop:
            found = stop.value
    assert found == clip.Timeline(10, 5)
    with pytest.raises(program.RefusalError, match="another version, or another program"):
        list(clip.timeline_steps(clip_file, ["-c", "print('{}')"]))


def test_the_frame_of_a_time_is_the_nearest_one_that_there_is():
    timeline = clip.Timeline(10, 5)
    assert [timeline.frame_at(time) for time in (0, 0.04, 0.06, 0.26, 0.4, 9)] == [0, 0, 1, 3, 4, 4]
    uneven = clip.Timeline(30000 / 1001, 90)
    times = np.float32([uneven.time_of(frame) for frame in range(90)])  # as Blender keeps them
    assert [uneven.frame_at(float(time)) for time in times] == list(range(90))
