"""The command line as a person meets it: results, messages, exit codes, and what stays on disk when things go wrong."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from itertools import cycle
from pathlib import Path

import numpy as np
import pytest

from eigenfield.cli import VERBS
from eigenfield.cli.encode import default_output
from eigenfield.gltf import save
from eigenfield.imaging.png import png_bytes
from eigenfield.runtime.files import write_bytes
from eigenfield.runtime.signals import STOP_SIGNALS
from support.captures import write_capture


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("captures with spaces") / "nïne")


@pytest.fixture(scope="module")
def scene(folder, tmp_path_factory):
    from eigenfield import encode
    from eigenfield.capture import open_capture

    path = tmp_path_factory.mktemp("scene") / "scene.glb"
    save(encode(open_capture(folder), folder / "proxy.ply", textures=4, atlas=64, hold_out="view_04.png"), path)
    return path


def test_help_of_every_verb_ends_in_examples(run):
    for verb in VERBS:
        code, out, _ = run(verb, "--help")
        assert code == 0 and "Examples:" in out and f"eigenfield {verb}" in out
    code, out, _ = run("--help")
    assert code == 0 and all(verb in out for verb in VERBS)


def test_the_output_has_the_captures_name_if_none_is_given(run, folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = "encode", folder, "--proxy", folder / "proxy.ply", "--atlas", 64, "-n", 1, "--fit", "none", "--quiet"
    assert run(*words)[0] == 0 and [path.name for path in tmp_path.iterdir()] == [f"{folder.name}.glb"]
    code, _, err = run(*words)
    assert code == 2 and f"{folder.name}.glb: exists already" in err
    assert run(*words, "--overwrite")[0] == 0


@pytest.mark.parametrize(
    ("capture", "name"),
    [("a/my.photos", "my.photos.glb"), ("a/walk.mp4", "walk.glb"), (".", "here.glb"), ("a/..", "here.glb"),
     ("/", "scene.glb"), ("s3://lab/photos", "photos.glb"), ("missing", "missing.glb")],
)  # fmt: skip
def test_a_capture_names_its_output(capture, name, tmp_path, monkeypatch):
    (tmp_path / "here" / "a" / "my.photos").mkdir(parents=True)
    (tmp_path / "here" / "a" / "walk.mp4").touch()
    monkeypatch.chdir(tmp_path / "here")
    assert default_output(Path(capture)) == Path(name)


def test_encode_render_evaluate_info_validate(run, folder, tmp_path):
    output = tmp_path / "my scene.glb"
    code, out, err = run(
        "encode", folder, "--proxy", folder / "proxy.ply", "-o", output, "--atlas", 64, "-n", 3, "--hold-out", "odd",
        "--keep-maps", tmp_path / "maps", "--fit", "none",
    )  # fmt: skip
    assert code == 0, err
    lines = out.splitlines()
    assert re.fullmatch(rf"{re.escape(str(output))}: [0-9,]+ kB, [0-9.]+ times smaller than the photographs", lines[0])
    assert lines[1:] == [
        "no verdict: `eigenfield evaluate SCENE CAPTURE` measures more",
        f"look around in it: eigenfield view '{output}'",
    ]
    assert len(list((tmp_path / "maps").iterdir())) == 2 * 4 + 1
    assert run("validate", output)[0] == 0
    code, out, _ = run("info", output, "--json")
    assert code == 0 and json.loads(out)
    code, out, _ = run("evaluate", output, folder, "--json", "--curve", "--store")
    figures = json.loads(out)
    assert code == 0
    assert figures["image"]["encoded"]["coverage"] == 1.0 and figures["image"]["held_out"]["cameras"] == 5
    assert {"uv", "image", "schema", "bytes", "ratio", "seconds", "curve"} <= set(figures)
    assert (
        sum(figures["bytes"][part] for part in ("mean", "textures", "weights", "mesh", "other"))
        == figures["bytes"]["total"]
    )
    code, out, _ = run("info", output)
    assert code == 0 and "held out" in out
    views = {
        "a.png": ["--at", "0.3,-0.2"],
        "b.png": ["--camera", "view_01.png"],
        "c.mp4": ["--path", "circle", "--frames", "4"],
    }
    for name, how in views.items():
        code, _, err = run("render", output, "-o", tmp_path / name, *how)
        assert code == 0, err
        assert (tmp_path / name).stat().st_size > 100
    assert not [path for path in tmp_path.rglob("*") if path.name.endswith(".part")]


def test_without_a_word_the_photographs_are_fitted(run, folder, tmp_path, caplog):
    """What a new user does: nothing is chosen, and everything can be done with the file."""
    output, whole = tmp_path / "scene.glb", tmp_path / "whole.glb"
    code, out, err = run("encode", folder, "--proxy", folder / "proxy.ply", "-o", output, "--hold-out", "odd")
    assert code == 0 and "times smaller than the photographs" in out
    assert [line[:11] for line in err.splitlines() if not line.startswith("  ")] == [
        "9 photograp",
        "step 1 of 3",
        "step 2 of 3",
        "step 3 of 3",
    ]
    code, _, err = run("encode", folder, "--proxy", folder / "proxy.ply", "-o", whole, "--codec", "webp", "-n", 3)
    assert code == 0, err
    assert "--codec is about texture maps" in caplog.text and "--fit none" in caplog.text
    assert run("validate", output)[0] == 0
    facts = json.loads(run("info", output, "--json")[1])
    assert facts["settings"]["fit"] == "photographs" and len(facts["planes"]) == 2
    assert len(json.loads(run("info", whole, "--json")[1])["planes"]) == 1
    code, out, err = run("evaluate", output, folder, "--plots", tmp_path / "plots")
    assert code == 0 and "the scene was fitted" in out and "uv-curve.png" not in err
    code, _, err = run("evaluate", output, folder, "--curve")
    assert code == 2 and "--curve" in err and "--fit none" in err
    assert run("render", output, "--at", "0.3,-0.2", "-o", tmp_path / "a.png")[0] == 0
    for name, kind in (("page.html", "html"), ("obj", "obj"), ("maps", "maps"), ("model", "colmap")):
        code, _, err = run("export", output, "-o", tmp_path / name, "--as", kind)
        assert code == 0 and (tmp_path / name).exists(), err


def copy_of(folder, tmp_path):
    return shutil.copytree(folder, tmp_path / "capture")


def edit(folder, change):
    path = folder / "transforms.json"
    transforms = json.loads(path.read_text())
    change(transforms)
    path.write_text(json.dumps(transforms))


def truncate_image(folder):
    path = folder / "images" / "view_03.png"
    path.write_bytes(path.read_bytes()[:-200])


def wrong_size(folder):
    write_bytes(folder / "images" / "view_03.png", png_bytes(np.zeros((56, 80, 3), np.float32)), overwrite=True)


def not_an_image(folder):
    (folder / "images" / "view_03.png").write_bytes(b"this is no picture")


def nan_pose(folder):
    edit(folder, lambda t: t["frames"][2]["transform_matrix"][0].__setitem__(3, float("nan")))


def no_rotation(folder):
    edit(folder, lambda t: t["frames"][2]["transform_matrix"][0].__setitem__(0, 3.0))


def two_views(folder):
    edit(folder, lambda t: t.update(frames=t["frames"][:2]))


def broken_json(folder):
    (folder / "transforms.json").write_text('{"frames": [')


def behind(folder):
    rewrite_mesh(folder, lambda v, f: (v * [1, 1, 1] - [0, 0, 20], f))


def nan_vertex(folder):
    def change(v, f):
        v[3] = np.nan
        return v, f

    rewrite_mesh(folder, change)


def index_too_large(folder):
    rewrite_mesh(folder, lambda v, f: (v, np.concatenate([f, [[0, 1, len(v)]]])))


def index_negative(folder):
    rewrite_mesh(folder, lambda v, f: (v, np.concatenate([f, [[0, 1, -1]]])))


def empty_mesh(folder):
    rewrite_mesh(folder, lambda v, f: (v, f[:0]))


def degenerate_mesh(folder):
    rewrite_mesh(folder, lambda v, f: (v * 0, f))


def rewrite_mesh(folder, change):
    """The proxy again as plain PLY text, with `change(vertices, faces)` applied."""
    from eigenfield.proxy import read_mesh

    mesh = read_mesh(folder / "proxy.ply")
    vertices, faces = change(mesh.vertices.astype(float), mesh.faces.astype(int))
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, vertex)) for vertex in vertices] + ["3 " + " ".join(map(str, face)) for face in faces]
    (folder / "proxy.ply").write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize(
    ("damage", "names"),
    [
        (truncate_image, "view_03.png"), (wrong_size, "view_03.png"), (not_an_image, "view_03.png"),
        (nan_pose, "view_02.png"), (no_rotation, "view_02.png"), (two_views, "3"), (broken_json, "transforms.json"),
        (behind, "proxy.ply"), (nan_vertex, "proxy.ply"), (index_too_large, "proxy.ply"), (index_negative, "proxy.ply"),
        (empty_mesh, "proxy.ply"), (degenerate_mesh, "proxy.ply"),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)  # fmt: skip
def test_bad_input_is_one_line_and_exit_code_2(run, folder, tmp_path, damage, names):
    capture = copy_of(folder, tmp_path)
    damage(capture)
    output = tmp_path / "scene.glb"
    code, out, err = run("encode", capture, "--proxy", capture / "proxy.ply", "-o", output, "--atlas", 64, "--quiet")
    assert code == 2 and out == ""
    assert err.startswith("eigenfield: ") and err.count("\n") == 1, err
    assert names in err and ";" in err, err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["capture"]


def test_an_existing_output_is_kept_before_any_work(run, folder, tmp_path):
    output = tmp_path / "scene.glb"
    output.write_bytes(b"precious")
    code, _, err = run("encode", folder, "--proxy", folder / "proxy.ply", "-o", output)
    assert code == 2 and "--overwrite" in err and output.read_bytes() == b"precious"


def test_a_missing_capture_proxy_and_scene_are_named(run, folder, tmp_path):
    for arguments, name in (
        (("encode", tmp_path / "lost", "--proxy", folder / "proxy.ply", "-o", tmp_path / "a.glb"), "lost"),
        (("encode", folder, "--proxy", tmp_path / "lost.ply", "-o", tmp_path / "a.glb"), "lost.ply"),
        (("render", tmp_path / "lost.glb", "-o", tmp_path / "a.png"), "lost.glb"),
        (("evaluate", tmp_path / "lost.glb", folder), "lost.glb"),
        (("info", tmp_path / "lost.glb"), "lost.glb"),
    ):
        code, out, err = run(*arguments)
        assert code == 2 and name in err and out == "" and err.count("\n") == 1, err


def test_a_full_disk_is_one_line_and_leaves_nothing(run, folder, tmp_path, monkeypatch):
    import errno

    def full(descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    output = tmp_path / "scene.glb"
    code, _, err = run("encode", folder, "--proxy", folder / "proxy.ply", "-o", output, "--atlas", 64, "-q")
    assert code == 2 and "no room" in err and "scene.glb" in err
    assert list(tmp_path.iterdir()) == []


def test_unknown_options_and_traceback(run, scene, tmp_path):
    assert run("encode", "--no-such-option")[0] == 2
    assert run("no-such-verb")[0] == 2
    from eigenfield.core.errors import FormatError

    (tmp_path / "bad.glb").write_bytes(scene.read_bytes()[:500])
    code, _, err = run("info", tmp_path / "bad.glb")
    assert code == 2 and "bad.glb" in err
    with pytest.raises(FormatError):
        run("info", tmp_path / "bad.glb", "--traceback")


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.slow
@pytest.mark.parametrize("signals", [STOP_SIGNALS, [getattr(signal, "SIGKILL", None)]], ids=["stopped", "killed"])
def test_a_stopped_encode_leaves_no_debris(folder, tmp_path, signals):
    """At several moments: the output is whole or absent, and nothing else is there, or the next run removes it. All
    signals that stop it are handled by one function."""
    output = tmp_path / "scene.glb"
    command = [sys.executable, "-m", "eigenfield", "encode", str(folder), "--proxy", str(folder / "proxy.ply"),
               "-o", str(output), "--atlas", "512", "-q", "--overwrite"]  # fmt: skip
    for wait, number in zip((0.4, 0.9, 1.4, 1.9), cycle(signals), strict=False):
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, stdout=subprocess.DEVNULL)
        time.sleep(wait)
        process.send_signal(number)
        _, err = process.communicate(timeout=60)
        if number in STOP_SIGNALS:
            assert process.returncode in (0, 130, -number), err
            assert process.returncode != 130 or "interrupted" in err
            assert [path.name for path in tmp_path.iterdir()] in ([], ["scene.glb"])
        if output.exists():
            from eigenfield import load

            load(output)
    subprocess.run(command, check=True)
    assert [path.name for path in tmp_path.iterdir()] == ["scene.glb"]


STOPPED = """
import os, signal, sys, threading
import eigenfield.cli as cli

def waits(*arguments, **options):
    try:
        threading.Event().wait(20)
    finally:  # as a worker that is waited for
        print("stopping", flush=True)
        threading.Event().wait(20)

cli.group.invoke = waits
sys.argv = ["eigenfield", "info", "x.glb"]
print("ready", flush=True)
cli.main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.parametrize("second", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_second_signal_does_not_wait(second):
    with subprocess.Popen([sys.executable, "-c", STOPPED], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None and process.stdout.readline() == b"ready\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGHUP)
        assert process.stdout.readline() == b"stopping\n"
        start = time.monotonic()
        process.send_signal(getattr(signal, second))
        _, err = process.communicate(timeout=15)
    assert process.returncode == 130 and err == b"eigenfield: interrupted\n"
    assert time.monotonic() - start < 5


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
def test_threads_that_do_not_end_are_not_waited_for_and_a_replacement_is():
    program = """
import os, signal, sys, threading, time
import eigenfield.cli as cli
from eigenfield.runtime.signals import hold_signals

def waits(*arguments, **options):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(20)
    finally:
        with hold_signals():
            time.sleep(2)
            print("replaced", flush=True)
        threading.Event().wait(30)

cli.STOP_SECONDS = 0.5
cli.group.invoke = waits
sys.argv = ["eigenfield", "info", "x.glb"]
cli.main()
"""
    start = time.monotonic()
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 130 and done.stdout == "replaced\n" and done.stderr == "eigenfield: interrupted\n"
    assert time.monotonic() - start < 15


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.parametrize("name", ["SIGHUP", "SIGINT"])
def test_a_signal_that_is_ignored_stays_ignored(name):
    """As `nohup` and a shell's `&` want it."""
    program = f"""
import os, signal, sys
import eigenfield.cli as cli
signal.signal(signal.{name}, signal.SIG_IGN)
cli.group.invoke = lambda *arguments, **options: os.kill(os.getpid(), signal.{name})
sys.argv = ["eigenfield", "info", "x.glb"]
cli.main()
"""
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
def test_a_signal_within_an_import_waits_for_its_end(tmp_path):
    """trimesh's modules catch whatever their imports raise, and fail much later without the package."""
    (tmp_path / "package.py").write_text(
        "import os, signal, time\nos.kill(os.getpid(), signal.SIGTERM)\ntime.sleep(0.2)"
    )
    (tmp_path / "swallows.py").write_text("try:\n    import package\nexcept BaseException:\n    package = None")
    program = """
import sys, threading
import eigenfield.cli as cli

def imports_and_waits(*arguments, **options):
    import swallows
    assert swallows.package is not None
    threading.Event().wait(20)

cli.group.invoke = imports_and_waits
sys.argv = ["eigenfield", "info", "x.glb"]
cli.main()
"""
    start = time.monotonic()
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 130 and "interrupted" in done.stderr, done.stderr
    assert time.monotonic() - start < 15


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.parametrize("error", ["ImportError", "cli.EigenfieldError"])
def test_a_signal_that_comes_out_as_another_error_still_ends_with_130(tmp_path, error):
    """A library may turn a KeyboardInterrupt into an error of its own, which may become one of ours."""
    program = f"""
import os, signal, sys, time
import eigenfield.cli as cli

def interrupted_import(*arguments, **options):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(5)
    except KeyboardInterrupt:
        raise {error}("numpy.core.multiarray failed to import")

cli.group.invoke = interrupted_import
sys.argv = ["eigenfield", "info", "x.glb"]
cli.main()
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 130 and "interrupted" in done.stderr, done.stderr
