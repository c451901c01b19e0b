"""Plots of what `evaluate` measures."""

from __future__ import annotations

import dataclasses

import pytest

from eigenfield.evaluation import evaluate
from eigenfield.evaluation.plots import write_plots
from support.redrawn import write_capture
from support.scenes import tiny_scene


@pytest.mark.slow
def test_plots_of_scenes_with_little_to_show(tmp_path):
    line = tiny_scene(textures=0, cameras=4, held_out=(1,))
    names = ("$x^{2$ 照片.png", "b" * 90, "_c", "d")
    scene = dataclasses.replace(line, rig=dataclasses.replace(line.rig, names=names))
    capture = write_capture(line, tmp_path / "c", only=(0, 1))
    views = tuple(dataclasses.replace(v, name=n) for v, n in zip(capture.views, names, strict=False))
    capture = dataclasses.replace(capture, views=views)
    figures = evaluate(scene, capture, curve="all")
    assert [p.name for p in write_plots(figures, scene, capture, tmp_path / "p")] == [
        "uv-curve.png",
        "cameras.png",
        "contact-sheet.png",
    ]
