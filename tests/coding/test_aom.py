"""libaom through the machine's ffmpeg: the same pictures in fewer bytes; what becomes of a machine without, and of a
program that fails."""

import shutil

import numpy as np
import pytest

from eigenfield.coding.pictures import aom
from eigenfield.coding.pictures.pictures_10bit import MAX_CODE, SVT_CODER, decode_10bit, encode_10bit
from eigenfield.encoding.fitted import planes
from eigenfield.encoding.options import PRESETS

HAS_AOM = aom.aom_program() is not None


@pytest.fixture(autouse=True)
def _look_again():
    """The program is looked for once; here it comes and goes."""
    aom.aom_program.cache_clear()
    yield
    aom.aom_program.cache_clear()


def codes() -> np.ndarray:
    """Discs and rings of many sizes, soft and sharp, on a slope, with a little grain."""
    rng = np.random.default_rng(3)
    rows, columns = np.mgrid[:256, :320]
    picture = 0.3 + columns / 1000.0
    for _ in range(60):
        away = np.hypot(rows - rng.uniform(0, 256), columns - rng.uniform(0, 320)) / rng.uniform(4, 40)
        picture = np.where(away < 1, 0.5 + 0.4 * np.sin(away * rng.uniform(0, 20) + rng.uniform(0, 6)), picture)
    picture = picture + rng.normal(0, 0.01, picture.shape)
    return np.rint(picture * MAX_CODE).clip(0, MAX_CODE).astype(np.uint16)


def error(data: bytes) -> float:
    return float(np.square(decode_10bit(data, False, "picture") - codes().astype(float)).mean())


@pytest.mark.slow
@pytest.mark.skipif(not HAS_AOM, reason="no ffmpeg program with libaom")
def test_fewer_bytes_at_the_same_error():
    made = [encode_10bit(codes(), crf, 4) for crf in (24, 32, 40)]
    data = aom.encode_aom(codes(), 32)
    sizes, errors = [len(one) for one in made], [error(one) for one in made]
    assert len(data) < 0.96 * np.exp(np.interp(error(data), errors, np.log(sizes)))
    assert aom.encode_aom(codes(), 32) == data


@pytest.mark.skipif(not HAS_AOM, reason="no ffmpeg program with libaom")
def test_every_code_is_kept_within_the_step_and_all_sides_fit():
    for height, width in ((64, 64), (66, 130), (64, 4096)):
        ramp = np.broadcast_to(np.linspace(0, MAX_CODE, width), (height, width)).astype(np.uint16)
        back = decode_10bit(aom.encode_aom(ramp, 4), False, "ramp")
        assert back.shape == ramp.shape
        assert np.abs(back.astype(int) - ramp).max() <= 8


def fake(folder, monkeypatch, body: str) -> None:
    program = folder / "ffmpeg"
    program.write_text(f"#!/bin/sh\n{body}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")


def test_a_machine_without_it(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert aom.aom_program() is None
    with pytest.raises(ValueError, match="libaom"):
        aom.encode_aom(codes(), 30)


def test_a_program_without_libaom_is_not_used(tmp_path, monkeypatch):
    fake(tmp_path, monkeypatch, "echo Unknown encoder >&2; exit 8")
    assert shutil.which("ffmpeg") == str(tmp_path / "ffmpeg")
    assert aom.aom_program() is None


def test_a_program_that_fails_later_is_replaced_with_a_warning(tmp_path, monkeypatch, caplog):
    fake(tmp_path, monkeypatch, "echo out of luck >&2; exit 1")
    monkeypatch.setattr(aom, "aom_program", lambda: str(tmp_path / "ffmpeg"))
    data = aom.encode_aom(codes(), 30)
    assert data == SVT_CODER(codes(), 30)
    assert "out of luck" in caplog.text


def test_an_interrupted_program_is_no_failure(tmp_path, monkeypatch, caplog):
    fake(tmp_path, monkeypatch, "exit 255")
    monkeypatch.setattr(aom, "aom_program", lambda: str(tmp_path / "ffmpeg"))
    with pytest.raises(KeyboardInterrupt):
        aom.encode_aom(codes(), 30)
    assert not caplog.records


def test_a_program_that_leaves_nothing_is_not_used(tmp_path, monkeypatch):
    fake(tmp_path, monkeypatch, "exit 0")
    assert aom.aom_program() is None


def test_the_best_preset_alone_is_patient():
    assert [name for name, preset in PRESETS.items() if preset.patient] == ["best"]
    rate = planes.PLANE_PRESETS[0].rate(0.01, patient=True)
    assert rate.coder is aom.encode_aom
    assert rate.trial is SVT_CODER
