"""The options of `encode`: what they mean, what they refuse, and that the command line has them all."""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import FrozenInstanceError, fields, replace

import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.cli.encode import command
from eigenfield.cli.field_options import from_fields
from eigenfield.core.errors import OptionError
from eigenfield.core.fields import options_of
from eigenfield.core.open_options import OpenOptions
from eigenfield.encoding import EncodeOptions, Target
from eigenfield.encoding.options import PRESETS, UNKNOWN_CHOICE_TEXTS, density_for_quality
from eigenfield.gltf import encode_scene, save
from eigenfield.reconstruction import SurfaceOptions
from support.captures import write_capture

FOR_MAPS = [{"align": True}, {"uv_ssim": 0.9}, {"keep_maps": "maps"},
            {"codec": "png"}, {"max_angle": 90}]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("options") / "nine")


def command_line(*words):
    """The options that the command line makes of these words."""
    given = dict(command.make_context("encode", ["capture", "-o", "scene.glb", *words]).params)
    return from_fields(EncodeOptions, given)


def test_making_options_does_nothing_else(caplog):
    caplog.set_level("DEBUG")
    for asked in ({}, *FOR_MAPS, {"target": Target(size=5000)}):
        made = EncodeOptions(**asked)
        assert {name: value for name, value in vars(made).items() if value is not None} == asked
        assert made == EncodeOptions(**asked) == pickle.loads(pickle.dumps(made)) and hash(made) == hash(replace(made))
        assert made != EncodeOptions(**asked, textures=3)
        made.resolved()
    assert not caplog.records
    with pytest.raises(FrozenInstanceError):
        EncodeOptions().textures = 3
    for values, named, says in (
        ((15,), {}, "positional"),
        ((), {"fit_spheres": 3}, "EncodeOptions has no option fit_spheres"),
        ((), {"preste": "small"}, "did you mean preset"),
    ):
        with pytest.raises(OptionError, match=says):
            EncodeOptions(*values, **named)
    with pytest.raises(OptionError, match="Target has no option bytes; there are size, psnr, ssim"):
        Target(bytes=5000)


@pytest.mark.parametrize("asked", FOR_MAPS, ids=lambda asked: next(iter(asked)))
def test_what_is_about_texture_maps_alone_is_the_paper_s_way(asked):
    assert EncodeOptions(**asked).resolved().fit == "none"
    for fitted in ({"target": Target(psnr=30)}, {"preset": "best"}, {"fit": "photographs"}):
        with pytest.raises(OptionError, match="about texture maps"):
            EncodeOptions(**asked, **fitted)


def test_the_paper_s_way_is_said_where_it_was_not_asked_for(folder, caplog):
    capture = open_capture(folder)
    ef.encode(capture, folder / "proxy.ply", atlas=64, textures=1, uv_ssim=0.5)
    (record,) = caplog.records
    assert record.getMessage().startswith("--uv-ssim is about texture maps, which a fit does not make")
    caplog.clear()
    ef.encode(capture, folder / "proxy.ply", atlas=64, textures=1, fit="none")
    assert not caplog.records


def test_the_rest_is_fitted():
    for asked in ({}, {"quality": 50}, {"textures": 3, "hold_out": "odd"}, {"target": Target(psnr=30)}):
        assert EncodeOptions(**asked).resolved().fit == "photographs"
    with pytest.raises(OptionError, match="no preset"):
        EncodeOptions(fit="none", preset="best")


@pytest.mark.parametrize(
    ("asked", "meant"),
    [
        ({}, {"fit": "photographs", "preset": "balanced", "quality": 89, "density": density_for_quality(89)}),
        ({"preset": "small"}, {"fit": "photographs", "quality": 79, "density": density_for_quality(79)}),
        ({"quality": 60, "density": 1.2, "textures": 4}, {"fit": "photographs", "preset": "balanced"}),
        ({"target": Target(psnr=30)}, {"fit": "photographs", "preset": "balanced"}),
        ({"fit": "none"}, {"textures": 15, "density": 1.5, "max_angle": 85}),
        ({"uv_ssim": 0.9}, {"fit": "none", "density": 1.5, "max_angle": 85}),
        ({"codec": "png", "atlas": (64, 32), "density": 1.0, "max_angle": 90}, {"fit": "none", "textures": 15}),
    ],
)  # fmt: skip
def test_what_options_mean(asked, meant):
    resolved = EncodeOptions(**asked).resolved()
    assert {name: value for name, value in vars(resolved).items() if value is not None} == {**asked, **meant}
    assert resolved.resolved() == resolved


def test_choices_are_what_there_is_to_choose():
    tables = {"preset": PRESETS}
    choices = {name: set(one.choices) for name, one in options_of(EncodeOptions) if one.choices}
    assert all(choices[name] == set(table) for name, table in tables.items())
    assert set(choices) == {*UNKNOWN_CHOICE_TEXTS, "codec"}
    for name in choices:
        with pytest.raises(OptionError, match=r"called magic|codec 'magic'") as caught:
            EncodeOptions(**{name: "magic"})
        assert caught.value.code == name
        assert all(one in caught.value.remedy for one in choices[name])


@pytest.mark.parametrize(
    ("asked", "code"),
    [({"codec": "png", "quality": 50}, "quality"), ({"quality": -1}, "quality"), ({"density": 101}, "density"),
     ({"max_angle": 91}, "max-angle"),
     ({"atlas": (64, 20_000)}, "atlas"), ({"residual": 40, "target": Target(size=5000)}, "residual"),
     ({"metres_per_unit": 0.0}, "metres"), ({"textures": -1}, "textures"), ({"uv_ssim": 0.0}, "uv-ssim")],
)  # fmt: skip
def test_what_cannot_be_is_refused_at_once(asked, code):
    with pytest.raises(OptionError) as caught:
        EncodeOptions(**asked)
    assert caught.value.code == code and caught.value.remedy


def test_every_option_has_help_and_is_one_of_the_command_line(run):
    assert [name for name, _ in options_of(EncodeOptions)] == [field.name for field in fields(EncodeOptions)]
    others = {name: one for kind in (OpenOptions, SurfaceOptions) for name, one in options_of(kind) if one.offered}
    offered = {parameter.name: parameter for parameter in command.params}
    said = " ".join(run("encode", "--help").out.split())
    del others["triangles"]  # `EncodeOptions` has its own
    for name, one in others.items():
        assert offered[name].help == one.help and f"--{one.name or name.replace('_', '-')}" in said
    for name, one in options_of(EncodeOptions):
        assert one.help.endswith((".", "]")) and f"{name}: {' '.join(one.help.split())}" in EncodeOptions.__doc__
        parts = {name: one} if one.parts is None else {f"{name}_{part}": own for part, own in options_of(one.parts)}
        for part, own in parts.items():
            assert offered[part].help == own.help and f"--{own.name or part.replace('_', '-')}" in said


def test_options_are_known_before_anything_heavy_is_loaded():
    """`eigenfield encode --help` comes at once."""
    code = "import sys, eigenfield.cli.encode; assert not {'numpy', 'numba', 'PIL'} & set(sys.modules), sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_command_line_maps_by_name():
    assert command_line() == EncodeOptions()
    words = (
        "-n 3 --align --harmonise=affine --density 1.2 --atlas 64x32 --triangles 60 --hold-out odd --reference a.png"
    )
    words += " --codec webp --residual --keep-maps maps --metres-per-unit 0.5 --uv-ssim 0.9"
    made = command_line(*words.split(), "--fit", "none")
    assert made == EncodeOptions(
        textures=3, align=True, harmonise="affine", density=1.2, atlas=(64, 32), triangles=60, hold_out="odd",
        reference="a.png", codec="webp", residual=40, keep_maps=made.keep_maps,
        metres_per_unit=0.5, uv_ssim=0.9, fit="none",
    )  # fmt: skip
    assert str(made.keep_maps) == "maps"
    words = "--preset small --target-size 1.5kB --atlas 64"
    assert command_line(*words.split()) == EncodeOptions(preset="small", target=Target(size=1500), atlas=64)
    assert command_line("--quality", "70", "--residual", "12") == EncodeOptions(quality=70, residual=12)


def test_options_and_their_fields_by_name_are_the_same(folder):
    capture, proxy = open_capture(folder), folder / "proxy.ply"
    asked = {"textures": 2, "atlas": 64, "fit": "none"}
    made = [
        ef.encode(capture, proxy, EncodeOptions(**asked)),
        ef.encode(capture, proxy, **asked),
        ef.encode(capture, proxy, EncodeOptions(**{**asked, "textures": 5}), textures=2),
    ]
    assert len({encode_scene(scene) for scene in made}) == 1
    with pytest.raises(OptionError, match="colour"):
        ef.encode(capture, proxy, colour="red")


@pytest.mark.parametrize("words", ["--codec png", "--quality 40", "--fit none", "--preset small"])
@pytest.mark.slow
def test_the_library_saves_what_the_command_line_does(folder, tmp_path, run, words):
    words = ["--proxy", str(folder / "proxy.ply"), "--atlas", "64", "-n", "2", *words.split()]
    code, _, err = run("encode", folder, "-q", "-o", tmp_path / "cli.glb", *words)
    assert code == 0, err
    options = command_line(*words)
    scene = ef.encode(open_capture(folder), folder / "proxy.ply", options)
    save(scene, tmp_path / "library.glb", **options.for_save)
    assert (tmp_path / "library.glb").read_bytes() == (tmp_path / "cli.glb").read_bytes()


def test_what_save_is_given():
    nothing = {"codec": None, "quality": None}
    assert EncodeOptions(codec="png").for_save == {"codec": "png", "quality": None}
    assert EncodeOptions(fit="none", quality=40).for_save == {"codec": None, "quality": 40}
    assert EncodeOptions(quality=40).for_save == EncodeOptions(codec="png", residual=40).for_save == nothing
    assert EncodeOptions(codec="png", residual=40).coding == {"codec": "png", "quality": None}


@pytest.mark.parametrize(
    "words", ["--preset small -n 2 --residual 30", "--fit none -n 2 --atlas 64 --codec png --residual"]
)
@pytest.mark.slow
def test_a_residual_from_the_library_is_that_of_the_command_line(folder, tmp_path, run, words):
    words = ["--proxy", str(folder / "proxy.ply"), *words.split()]
    code, _, err = run("encode", folder, "-q", "-o", tmp_path / "cli.glb", *words)
    assert code == 0, err
    made = ef.encode(open_capture(folder), folder / "proxy.ply", command_line(*words))
    save(made, tmp_path / "library.glb", **command_line(*words).for_save)
    assert made.residual is not None
    assert (tmp_path / "library.glb").read_bytes() == (tmp_path / "cli.glb").read_bytes()
