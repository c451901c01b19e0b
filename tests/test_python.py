"""Python as a person expects it: paths are taken, values show themselves briefly, and wrong arguments are named."""

from __future__ import annotations

import inspect
import io
import pickle
import shutil
import sys
import types
import urllib.request
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.capture import PhotoSet
from eigenfield.core import notebook
from eigenfield.core.arguments import checked
from eigenfield.core.scene import Residual
from support import charts
from support.captures import write_array, write_capture
from support.motion import photographed
from support.program import call
from support.scenes import tiny_scene
from support.soft_scenes import coded_soft_scene

NO_PHOTOGRAPHS = PhotoSet(Path(), (), None, (), "folder")


def error(function, *arguments, **named) -> str:
    with pytest.raises(ef.OptionError) as caught:
        function(*arguments, **named)
    return str(caught.value)


@pytest.fixture(scope="module")
def nine(tmp_path_factory) -> Path:
    return write_capture(tmp_path_factory.mktemp("python") / "nine")


@pytest.fixture(scope="module")
def small(nine) -> ef.Scene:
    return ef.encode(nine, nine / "proxy.ply", fit="none", textures=2, atlas=64)


@pytest.mark.parametrize(
    ("words", "options"),
    [
        pytest.param(["--surface", "relief"], {"surface": "relief"}, marks=pytest.mark.slow),
        (["--fit", "none", "--textures", "3", "--hold-out", "every:5", "--blind"],
         {"fit": "none", "textures": 3, "hold_out": "every:5", "blind": True}),
    ],
)  # fmt: skip
def test_encode_takes_a_folder_and_writes_what_the_command_line_does(words, options, tmp_path):
    write_array(tmp_path / "photos", side=3)
    assert call("encode", tmp_path / "photos", "-q", "-o", tmp_path / "theirs.glb", *words) == 0
    scene = ef.encode(tmp_path / "photos", **options)
    ef.save(scene, tmp_path / "ours.glb")
    assert (tmp_path / "ours.glb").read_bytes() == (tmp_path / "theirs.glb").read_bytes()


def test_encode_and_evaluate_take_paths_and_captures(nine):
    options = {"fit": "none", "textures": 2, "atlas": 64}
    made = [ef.encode(given, str(nine / "proxy.ply"), **options) for given in (str(nine), nine, ef.open(nine))]
    assert len({scene.appearance.planes[0].mean.tobytes() for scene in made}) == 1
    found = [ef.evaluate(made[0], given, png_maps="none")["image"] for given in (str(nine), nine, ef.open(nine))]
    assert found[0] == found[1] == found[2]


def test_a_scene_and_a_picture_show_themselves_briefly():
    scene = tiny_scene(held_out=(1,), cameras=6)
    assert repr(scene).count("\n") == 2 and "6 cameras, 1 of them held out" in repr(scene)
    made = ef.Scene(scene.proxy, scene.rig, scene.appearance)
    assert repr(made).startswith("Scene of 6 cameras") and len(repr(made)) < 300
    assert len(repr(ef.render(scene))) < 80


def test_a_scene_that_is_made_of_its_parts_has_the_methods(tmp_path):
    parts = tiny_scene(cameras=6)
    made = ef.Scene(parts.proxy, parts.rig, parts.appearance)
    np.testing.assert_array_equal(made.render().image, ef.render(parts).image)
    made.save(tmp_path / "made.glb", codec="png")
    assert ef.load(tmp_path / "made.glb").names == made.names
    assert "proxy: The surface." in inspect.getdoc(ef.Scene)


def within(value) -> list:
    """A value and all that its fields and sequences hold."""
    if isinstance(value, tuple):
        return [one for each in value[:2] for one in within(each)]
    if not is_dataclass(value):
        return []
    return [value, *(one for field in fields(value) if field.init for one in within(getattr(value, field.name)))]


def test_whatever_holds_arrays_shows_itself_in_one_line(nine, tmp_path):
    write_array(tmp_path / "photos", side=3)
    scene = coded_soft_scene()
    residual = Residual(bytes(10**5), (40, 48), np.arange(9), (1.0, 2.0), False, True, "av1")
    scene = replace(scene, residual=residual)
    capture, array = ef.open(nine), ef.open(tmp_path / "photos")
    found = within(scene)[1:] + within(capture) + within(array) + [scene.payloads]
    assert {"Mesh", "Rig", "Appearance", "Plane", "Basis", "Sheets", "Camera", "ViewPlane", "Residual", "View",
            "LightField", "PhotoSet", "GridLayout"} <= {type(one).__name__ for one in found}  # fmt: skip
    assert [one for one in map(repr, found) if "\n" in one or len(one) > 360] == []
    assert repr(scene.mesh) == "Mesh(vertices=float32 (289, 3), faces=int32 (468, 3), uv=float32 (289, 2))"
    assert repr(scene.rig).startswith("Rig(names=9 str, cameras=9 Camera, held_out=bool (9,), reference=4")
    assert repr(scene.proxy) == "Proxy(mesh=Mesh(...), lattice=None, sheets=Sheets(...))"
    assert "video=100,000 bytes" in repr(residual)
    assert repr(capture).startswith("LightField(root=") and "views=9 View, problems=()" in repr(capture)
    assert "t=[0.5, 0.5, 3.0], width=" in repr(scene.cameras[0])


def test_a_loaded_scene_has_its_parts_at_hand(small, tmp_path):
    small.save(tmp_path / "a.glb")
    scene = ef.load(tmp_path / "a.glb")
    assert scene.mesh is scene.proxy.mesh and scene.cameras is scene.rig.cameras and scene.names is scene.rig.names
    scene.save(tmp_path / "b.glb")
    assert (tmp_path / "b.glb").read_bytes() == (tmp_path / "a.glb").read_bytes()
    picture = scene.render(at=(0.3, -0.2))
    np.testing.assert_array_equal(picture.image, ef.render(scene, at=(0.3, -0.2)).image)
    (one,) = scene.render_many(at=[(0.3, -0.2)])
    np.testing.assert_array_equal(one.image, picture.image)
    (plane,) = scene.appearance.planes
    np.testing.assert_allclose(scene.mean, plane.mean, atol=1e-6)
    expected = plane.mean + np.einsum("n,nhwc->hwc", plane.bases[0].weights[3], plane.bases[0].values())
    np.testing.assert_allclose(scene.texture(scene.names[3]), expected, atol=1e-5)
    with pytest.raises(ef.OptionError, match="no camera is called nobody"):
        scene.texture("nobody")
    for again in (small, replace(scene, scores={}), pickle.loads(pickle.dumps(scene)), scene.with_mesh(scene.mesh)):
        assert type(again) is ef.Scene and again.mean.shape == (64, 64, 3)
    assert inspect.signature(ef.load).parameters.keys() == {"path", "time"} and "Read a scene" in ef.load.__doc__


def test_a_path_stands_for_a_scene(nine, small, tmp_path):
    path, other = tmp_path / "a.glb", tmp_path / "b.glb"
    small.save(path)
    scene = ef.load(path)
    for given in (path, str(path)):
        np.testing.assert_array_equal(ef.render(given, at=(0, 0)).image, scene.render(at=(0, 0)).image)
        assert len(list(ef.render_many(given, cameras=scene.names[:2]))) == 2
        ef.save(given, other, overwrite=True)
        assert other.read_bytes() == path.read_bytes()
    figures = ef.evaluate(path, nine, png_maps="none")
    assert figures["bytes"]["total"] == path.stat().st_size
    assert figures["image"] == ef.evaluate(scene, nine, png_maps="none")["image"]
    text = tmp_path / "text.glb"
    text.write_text("no scene")
    for function in (
        ef.render,
        ef.render_many,
        lambda it: ef.save(it, tmp_path / "c.glb"),
        lambda it: ef.evaluate(it, nine),
    ):
        for wrong, says in ((tmp_path / "no.glb", "no.glb: does not exist; check the name"), (text, "does not begin")):
            with pytest.raises(ef.FormatError, match=says) as caught:
                function(wrong)
            assert "\n" not in str(caught.value)


def test_a_picture_is_shown_in_a_notebook_and_saved(tmp_path):
    picture = ef.render(tiny_scene())
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == picture._repr_png_()
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "a.png")), picture.to_uint8())
    with pytest.raises(ef.OutputError):
        picture.save(tmp_path / "a.png")
    picture.save(tmp_path / "a.png", overwrite=True)
    assert "name it a.png" in error(picture.save, tmp_path / "a.jpg")
    attributes = replace(picture, image=np.zeros((4, 4, 5), np.float32))
    assert attributes._repr_png_() is None and "5 channels" in error(attributes.save, tmp_path / "b.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png"]


def test_a_scene_is_exported_and_viewed(tmp_path):
    scene = tiny_scene()
    ef.save(scene, tmp_path / "a.glb")
    for given in (scene, ef.load(tmp_path / "a.glb"), tmp_path / "a.glb"):
        written, what = ef.export(given, tmp_path / "a.html", title="A", overwrite=True)
        assert written == tmp_path / "a.html" and " MB, and a.jpg, its poster" in what
    assert ef.export(scene, tmp_path / "%d.png", path="grid", frames=2, samples=1)[1] == "2 pictures"
    assert "use one of html, mp4" in error(ef.export, scene, tmp_path / "b", "pdf")
    assert "title is not for maps" in error(ef.export, scene, tmp_path / "b", "maps", title="B")
    for given in (scene, tmp_path / "a.glb"):
        with ef.view(given, browser=False) as server, urllib.request.urlopen(server.address, timeout=20) as answer:
            assert b"<html" in answer.read()
    with pytest.raises(ef.EigenfieldError):
        ef.view(tmp_path / "nothing.glb", browser=False)


def test_a_scene_is_viewed_beside_its_photographs(nine, small, tmp_path, caplog):
    scene = small
    bare = shutil.copytree(nine / "images", tmp_path / "bare")  # photographs alone: the cameras are the scene's
    for capture, place in ((nine, {}), (ef.open(nine), {}), (bare, {"format": "folder"})):
        with (
            ef.view(scene, capture, browser=False, **place) as server,
            urllib.request.urlopen(f"{server.address}photographs/4", timeout=20) as answer,
        ):
            shown = np.asarray(Image.open(io.BytesIO(answer.read())))
        np.testing.assert_array_equal(shown, np.asarray(Image.open(bare / "view_04.png").convert("RGB")))
    assert not caplog.records
    (bare / "view_00.png").unlink()
    ef.view(scene, bare, browser=False).close()
    assert f"1 of 9 cameras have no photograph in {bare}" in caplog.text
    with pytest.raises(ef.CaptureError, match="no photograph has the name"):
        write_array(tmp_path / "others", side=3)
        ef.view(scene, tmp_path / "others", browser=False)


@pytest.mark.slow
def test_cameras_are_found_as_the_command_line_finds_them(tmp_path, monkeypatch):
    monkeypatch.setattr("eigenfield.calibration.motion.features.FEATURE_MIN_MEDIAN_COUNT", 0)  # of small photographs
    photographed(tmp_path / "photos")
    found = ef.calibrate(tmp_path / "photos", tmp_path / "ours", progress=None)
    assert len(found.light_field) == 5 and "\n" not in repr(found) and len(repr(found)) < 400
    assert call("calibrate", tmp_path / "photos", "-q", "-o", tmp_path / "theirs") == 0
    for name in ("transforms.json", "report.json"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    with pytest.raises(ef.OutputError):
        ef.calibrate(tmp_path / "photos", tmp_path / "ours")


def test_a_rig_is_calibrated_by_a_chart_as_on_the_command_line(tmp_path):
    cameras, poses = charts.rig(2, spacing=100, distance=500), charts.board_poses(charts.CHECKER, 4, seed=2, spread=50)
    charts.write_charts(tmp_path / "charts", charts.CHECKER, cameras, poses)
    board = {"chart": "checkerboard", "board": "9x6", "square": "25mm"}
    found = ef.calibrate(tmp_path / "charts", tmp_path / "ours", inverted=False, **board)
    assert [report.reason for report in found.reports] == [None] * 2 and found.unit == "mm"
    assert all("\n" not in text and len(text) < 400 for text in map(repr, (found, *found.reports)))
    words = [word for name, value in board.items() for word in (f"--{name}", value)]
    assert call("calibrate", tmp_path / "charts", "--not-inverted", "-q", "-o", tmp_path / "theirs", *words) == 0
    for name in ("transforms.json", "report.json"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    with pytest.raises(ef.OutputError):
        ef.calibrate(tmp_path / "charts", tmp_path / "ours", **board)


class Kernel:
    """What stands for IPython: a shell with a kernel, and what is displayed."""

    def __init__(self):
        self.shown: list[str] = []
        self.kernel = self
        self.display = types.ModuleType("IPython.display")
        self.display.HTML = str
        self.display.display = self.add
        module = types.ModuleType("IPython")
        module.get_ipython = lambda: self
        self.modules = {"IPython": module, "IPython.display": self.display}

    def add(self, text, display_id):
        self.shown.append(text)
        return self

    def update(self, text):
        self.shown[-1] = text


def test_a_notebook_shows_progress_unless_told_otherwise(nine, monkeypatch):
    kernel, options = Kernel(), {"fit": "none", "textures": 2, "atlas": 64}
    ef.encode(nine, nine / "proxy.ply", **options)  # no notebook
    for name, module in kernel.modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    ef.encode(nine, nine / "proxy.ply", progress=None, **options)
    assert kernel.shown == []
    ef.encode(nine, nine / "proxy.ply", **options)
    assert kernel.shown and all("<progress" in text for text in kernel.shown)
    notebook.notebook_progress("<b>", 0, 2)
    notebook.notebook_progress("<b>", 2, 2)
    assert kernel.shown[-1].startswith("&lt;b&gt; ") and kernel.shown[-1].endswith("2 of 2")


@pytest.mark.parametrize(
    ("name", "arguments", "named", "says"),
    [
        ("render", [3], {}, "scene of render is 3; give a Scene or a Clip or a path"),
        ("render_many", [None], {}, "scene of render_many is None; give a Scene or a Clip or a path"),
        ("render", [None], {"ressolution": 3}, "unexpected keyword argument 'ressolution'"),
        ("load", [3], {}, "path of load is 3; give a path"),
        ("load", [tiny_scene()], {}, "path of load is a Scene; give a path"),
        ("save", [3, "a.glb"], {}, "scene of save is 3"),
        ("open", [None], {}, "path of open is None"),
        ("open", ["a"], {"grid": "3x3"}, "grid of open is '3x3'; give (a whole number, a whole number) or None"),
        ("evaluate", [None, "a"], {}, "scene of evaluate"),
        ("reconstruct", ["photos"], {}, "capture of reconstruct is 'photos'"),
        ("set_threads", ["all"], {}, "count of set_threads is 'all'"),
        ("validate", [None], {}, "path of validate"),
        ("calibrate", [3], {}, "photographs of calibrate is 3"),
        ("calibrate", ["a"], {"board": "9x6"}, "board describes a chart"),
        ("calibrate", ["a"], {"chart": "paper"}, "no chart is called paper; use checkerboard or charuco"),
        ("calibrate", ["a"], {"chart": "charuco", "masks": "b"}, "masks means nothing to charts"),
        ("calibrate", ["a"], {"griid": (3, 3)}, "calibrate has no option griid; did you mean grid?"),
        ("open", ["a"], {"wurk": "b"}, "open has no option wurk; did you mean work?"),
        ("reconstruct", [NO_PHOTOGRAPHS], {"layer": 3}, "reconstruct has no option layer; did you mean layers?"),
        ("encode", ["a"], {"layer": 3}, "encode has no option layer; did you mean layers?"),
        ("view", [3], {}, "scene of view is 3"),
        ("view", [tiny_scene()], {"grid": (3, 3)}, "grid is for a capture"),
        ("export", [3, "a.html"], {}, "scene of export is 3"),
        ("encode", [3], {}, "makes no proxy"),
        ("encode", ["a", 3], {}, "is no proxy"),
        ("encode", [], {}, "missing a required argument: 'capture'"),
        ("encode", ["a"], {"preste": "small"}, "did you mean preset?"),
        ("encode", ["a"], {"fit_spheres": 3}, "fit_spheres of encode is 3; give a sequence, each a text"),
        ("encode", ["a"], {"work": 3}, "work of encode is 3"),
        ("encode", ["a", "b.ply", 3], {}, "options of encode is 3; give an EncodeOptions or None"),
        ("encode", ["a"], {"textures": "many"}, "textures is a str; give a whole number"),
        ("encode", ["a"], {"quality": 101}, "quality"),
        ("encode", ["a"], {"target": 300_000}, "target is an int; give a Target"),
        ("encode", ["a"], {"target": ef.Target(size="1 MB")}, "a target size of 1 MB"),
        ("encode", ["a", "b.ply"], {"surface": "relief"}, "leave out one of the two"),
    ],
)  # fmt: skip
def test_a_wrong_argument_is_named(name, arguments, named, says):
    assert says in error(getattr(ef, name), *arguments, **named)


@pytest.mark.parametrize("named", [{"at": "x"}, {"at": (0, 0, 0)}, {"at": (5, 5)}, {"at": (np.nan, 0)},
                                   {"resolution": "big"}, {"resolution": (0, 5)}, {"samples": 1.5},
                                   {"textures": True}, {"background": "red"}, {"weights": 3},
                                   {"time": "soon"}])  # fmt: skip
def test_a_wrong_view_is_an_option_error(named):
    error(ef.render, tiny_scene(), **named)


def test_arrays_lists_and_numpy_numbers_stand_for_tuples_and_numbers():
    scene = tiny_scene()
    expected = ef.render(scene, at=(0.25, 0.0), resolution=(20, 16)).image
    given = ef.render(scene, at=np.array([0.25, 0.0]), resolution=[np.int64(20), 16]).image
    np.testing.assert_array_equal(given, expected)


def test_annotations_say_what_is_taken():
    @checked
    def function(a: tuple[int, ...], b: int | None = None, *, c: bool = False) -> tuple[int, ...]:
        return a

    assert function([1, 2], c=True) == [1, 2]
    assert "a of function is (1, 'x'); give a sequence, each a whole number" in error(function, (1, "x"))
    assert "b of function is 2.5; give a whole number or None" in error(function, (), 2.5)
    assert "c of function is 1; give True or False" in error(function, (), c=1)
    assert "missing a required argument: 'a'; it takes a, b, c" in error(function)


def test_errors_name_arguments_to_whoever_calls_and_options_on_the_command_line(tmp_path, run):
    scene = tmp_path / "scene.glb"
    ef.save(tiny_scene(3, 3, cameras=6), scene)
    with pytest.raises(ef.OutputError, match="use overwrite=True or another") as caught:
        ef.save(tiny_scene(3, 3, cameras=6), scene)
    assert caught.value.remedy == caught.value.remedy.replace("--", "")
    with pytest.raises(ef.OptionError, match='say kind="html", '):
        ef.export(scene, tmp_path / "scene.unknown")
    assert "say --as html" in run("export", scene, "-o", tmp_path / "scene.unknown").err
    assert "use --overwrite" in run("export", scene, "--as", "glb", "-o", scene).err


def test_weights_of_an_unknown_kind_are_refused_wherever_the_eye_is():
    scene = tiny_scene(3, 3, cameras=6)
    for place in ({}, {"at": (0, 0)}, {"camera": scene.rig.names[0]}):
        with pytest.raises(ef.OptionError) as caught:
            ef.render(scene, weights="foo", **place)
        assert caught.value.code == "weights-mode"


def test_every_parameter_of_a_public_function_is_documented():
    for name in (
        "open",
        "save",
        "export",
        "encode",
        "reconstruct",
        "calibrate",
        "render",
        "render_many",
        "view",
        "evaluate",
        "batch",
    ):
        function = getattr(ef, name)
        for parameter in inspect.signature(function).parameters:
            assert f"\n        {parameter}: " in function.__doc__, (name, parameter)
