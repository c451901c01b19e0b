"""What messages say leads somewhere: commands run, options and pages exist, and what was given is called what it is."""

from __future__ import annotations

import ast
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import eigenfield
from eigenfield.cli import VERBS, group
from eigenfield.cli.encode import GROUPS
from eigenfield.cli.encode import command as encode_command
from eigenfield.cli.help import TOPICS
from support.captures import write_array
from support.motion import photographed
from support.program import call

ROOT = Path(__file__).parents[2]
COMMAND = re.compile(r"`(eigenfield [^`]+)`")
SPLAT_PROPERTIES = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                    "rot_0", "rot_1", "rot_2", "rot_3"]  # fmt: skip


def flat(node: ast.AST) -> str:
    """A text of the sources as it stands there, an expression in it as {}."""
    if isinstance(node, ast.JoinedStr):
        return "".join(flat(part) for part in node.values)
    return node.value if isinstance(node, ast.Constant) else "{}"


def texts_of(source: str) -> list[str]:
    """Every text of a file of the package that is no docstring."""
    tree, found = ast.parse(source), []
    passed = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            passed |= {id(part) for part in node.values}
        if isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str)):
            found += [flat(node)] * (id(node) not in passed)
    return found


SOURCES = [path.read_text("utf-8") for path in sorted(Path(eigenfield.__file__).parent.rglob("*.py"))]
# Each worker collects this file, so that it parses no more of the package than it must
WITH_COMMANDS = [text for source in SOURCES if "`eigenfield " in source for text in texts_of(source)]
COMMANDS = sorted({command for text in WITH_COMMANDS for command in COMMAND.findall(text)})


@pytest.fixture(scope="module")
def texts() -> list[str]:
    """Every text of the package that is no docstring."""
    return [text for source in SOURCES for text in texts_of(source)]


@pytest.fixture(scope="module")
def places(tmp_path_factory, fitted):
    """What stands for the words of a command: photographs, a mesh, a scene."""
    folder = tmp_path_factory.mktemp("words")
    capture, scene = fitted
    write_array(folder / "array")
    photographed(folder / "photos")
    for instant in ("0000", "0001"):
        shutil.copytree(folder / "array", folder / "footage" / instant)
    bare = {"encode": folder / "array", "calibrate": folder / "photos", "FOOTAGE": folder / "footage"}
    return {"CAPTURE": capture, "MESH": capture / "proxy.ply", "SCENE": scene, **bare}


SLOW = pytest.mark.slow


@pytest.mark.parametrize("command", [pytest.param(each, marks=[SLOW] * (" encode " in each)) for each in COMMANDS])
@pytest.mark.slow
def test_a_command_that_a_message_gives_runs(command, places, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("eigenfield.calibration.motion.features.FEATURE_MIN_MEDIAN_COUNT", 0)  # of small photographs
    _, verb, *words = shlex.split(command)
    capture = places.get("FOOTAGE" if "--clip" in words else verb, places["CAPTURE"])
    given = [verb, *(str(capture if word in ("CAPTURE", "{}") else places.get(word, word)) for word in words)]
    if verb == "encode":
        given += ["--preset", "small"]
    if verb == "calibrate":
        given += ["-o", str(tmp_path / "cameras")]
    if verb == "view":  # serves until it is stopped
        process = subprocess.Popen([sys.executable, "-m", "eigenfield", *given, "--no-browser"], stdout=subprocess.PIPE)
        assert process.stdout.readline().startswith(b"http")
        process.terminate()
        process.communicate(timeout=30)
        return
    code, _, err = run(*given)
    assert code == 0, err


def test_a_command_stands_in_backticks_and_is_whole(texts):
    """So that the test above runs it; lines that are a command, or end in one, and the list of topics have none."""
    named = re.compile(rf"(?<!`)\beigenfield (?:{'|'.join(VERBS)})\b(?! \{{)(?! TOPIC)(?! COMMAND)")
    assert [text for text in texts if named.search(text) and "Examples:" not in text] == []


def test_options_pages_and_extras_that_messages_name_exist(texts):
    options = {word for verb in VERBS for option in group.get_command(None, verb).params
               for word in (*option.opts, *option.secondary_opts)} | {"--help", "--version"}  # fmt: skip
    others = {"--image_path", "--overlay"}  # of other programs
    named = {word for text in texts for word in re.findall(r"(?<![\w-])--[a-z][a-z-]*[a-z](?![\w-])", text)}
    assert named - options - others == set()
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
    assert {name for text in texts for name in re.findall(r"eigenfield\[(\w+)\]", text)} <= set(extras)
    assert {name for text in texts for name in re.findall(r"`eigenfield help ([\w-]+)`", text)} <= set(TOPICS)
    assert [text for text in texts if "docs/" in text] == []  # a wheel holds them elsewhere


def refused(run, *words) -> str:
    code, out, err = run(*words)
    assert code == 2 and out == "" and err.count("\n") == 1, err
    return err


def test_a_missing_mesh_is_named_before_the_capture_is_read(run, places, tmp_path):
    err = refused(run, "encode", places["encode"], "--proxy", "nothing.ply", "-o", tmp_path / "a.glb")
    assert err.startswith("eigenfield: nothing.ply: this mesh does not exist")
    err = refused(run, "encode", places["encode"], "--proxy", places["MESH"], "-o", tmp_path / "a.glb")
    assert f"`eigenfield encode {places['encode']} -o scene.glb`" in err


@pytest.mark.parametrize("name", ["x.jpg", "scene", "scene.gltf"])
def test_an_output_that_is_no_glb_is_refused_at_once(run, places, tmp_path, name, monkeypatch):
    monkeypatch.setattr("eigenfield.capture.open_any", None)  # calling it would fail
    err = refused(run, "encode", places["encode"], "-o", tmp_path / name)
    assert f"{name}: a scene is a .glb file; name it {name.split('.')[0]}.glb" in err


def test_what_is_out_of_range_is_told_the_range(run, places, tmp_path):
    err = refused(run, "encode", places["CAPTURE"], "-o", tmp_path / "a.glb", "--target-size", "1kB")
    assert "a target size of 1000 bytes is out of range; say one above 1000 bytes" in err
    err = refused(run, "encode", places["CAPTURE"], "-o", tmp_path / "a.glb", "--target-psnr", "200")
    assert "a target psnr of 200 dB is out of range; say one between 1 and 99 dB" in err
    err = refused(run, "render", places["SCENE"], "-o", tmp_path / "a.png", "--at", "5,5")
    assert "the viewpoint 5,5 lies outside the array; give two numbers from -1 to 1" in err


def test_a_splat_a_picture_and_an_address_are_recognised(run, places, tmp_path):
    header = "".join(f"property float {name}\n" for name in SPLAT_PROPERTIES)
    text = f"ply\nformat binary_little_endian 1.0\nelement vertex 5\n{header}end_header\n"
    splat, output = tmp_path / "splat.ply", tmp_path / "a.glb"
    splat.write_bytes(text.encode() + np.zeros((5, len(SPLAT_PROPERTIES)), "<f4").tobytes())
    picture, address = next(places["encode"].glob("*.png")), "https://example.org/a"
    capture = places["CAPTURE"]
    assert "is a Gaussian splat, and no mesh" in refused(run, "encode", capture, "--proxy", splat, "-o", output)
    assert "is a PNG picture, and no mesh" in refused(run, "encode", capture, "--proxy", picture, "-o", output)
    assert "is a Gaussian splat, and no .glb" in refused(run, "info", splat)
    assert "is a PNG picture, and no .glb" in refused(run, "render", picture, "-o", tmp_path / "a.png")
    assert "photographs that it was trained on" in refused(run, "encode", splat, "-o", output)
    for words in (
        ["encode", address, "-o", output], ["encode", capture, "--proxy", f"{address}.ply", "-o", output],
        ["inspect", address], ["info", f"{address}.glb"], ["evaluate", f"{address}.glb", capture],
    ):  # fmt: skip
        assert refused(run, *words).startswith("eigenfield: https://example.org/a")
    assert not output.exists()


def test_help_shows_pages_and_the_options_of_commands(run):
    code, out, _ = run("help")
    assert code == 0 and all(topic in out for topic in TOPICS)
    for topic in TOPICS:
        code, out, _ = run("help", topic)
        assert code == 0 and out.startswith("# ") and out.rstrip() == (
            ROOT / "docs" / f"{topic}.md"
        ).read_text("utf-8").rstrip()  # fmt: skip
    assert run("help", "encode").out == run("encode", "--help").out
    assert "`eigenfield help` lists them" in refused(run, "help", "nothing")


def test_a_command_that_does_not_exist_brings_the_nearest(run):
    code, _, err = run("encod", "photos")
    assert code == 2 and "did you mean encode?" in err


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_completes(shell, run, monkeypatch, capfd):
    code, out, _ = run("completion", shell)
    assert code == 0 and "_EIGENFIELD_COMPLETE" in out
    monkeypatch.setenv("_EIGENFIELD_COMPLETE", f"{shell}_complete")
    monkeypatch.setenv("COMP_WORDS", "eigenfield enc")
    monkeypatch.setenv("COMP_CWORD", "enc" if shell == "fish" else "1")
    capfd.readouterr()
    assert call() == 0 and "encode" in capfd.readouterr().out


def test_the_help_of_encode_stands_in_groups(run):
    names = [name for group in GROUPS.values() for name in group]
    assert len(set(names)) == len(names) and set(names) <= {option.name for option in encode_command.params}
    out = run("encode", "--help").out
    assert [out.index(f"{title}:") for title in GROUPS] == sorted(out.index(f"{title}:") for title in GROUPS)
    screen = "\n".join(out.splitlines()[:24])
    assert all(word in screen for word in ("--output", "--preset", "--proxy", "--calibration", "--grid"))
    assert (
        out.index("--fit-sphere") < out.index("The paper's way") < min(out.index("--uv-ssim S"), out.index("--align "))
    )
    shown = [option for option in encode_command.params if not getattr(option, "hidden", False)]
    assert all(word in out for option in shown for word in option.opts if word.startswith("--"))
