"""`info`: a screenful, however much a file holds; `--json` has all of it."""

from __future__ import annotations

import json
from pathlib import Path

from eigenfield.cli.info import LINE_MAX_CHARACTERS, text_lines
from eigenfield.gltf import describe

SCENE = Path(__file__).parents[2] / "docs" / "scene.glb"


def test_the_text_is_short_and_the_json_is_whole(run):
    code, out, _ = run("info", SCENE)
    assert code == 0 and len(out.splitlines()) <= 20 and all(len(line) <= 120 for line in out.splitlines())
    assert "73 encoded, 8 held out" in out and "psnr 34.99" in out and "36 of 768x768" in out
    layout, found = describe(SCENE)[0], json.loads(run("info", SCENE, "--json").out)
    assert found["settings"] == layout.settings and found["scores"] == layout.scores and len(layout.scores) > 5


def test_what_is_free_in_a_file_stays_a_line_or_two(run):
    """Settings and scores may be anything; sheets, planes and names many."""
    found = json.loads(run("info", SCENE, "--json").out)
    found["settings"] = {"a\nb": "c\nd", "many": list(range(1000))} | {f"key{i}": {"x": i} for i in range(100)}
    found["scores"] = {"image": {"encoded": {"psnr": "x" * 1000}, "held_out": None}, "between": {"n\nm": [1.5] * 1000}}
    found["planes"] *= 10
    found["cameras"]["held_out"] = [f"view {i}" for i in range(1000)]
    found["cameras"]["sizes"] = [{"size": [i, i], "count": 1} for i in range(1, 100)]
    found["cameras"]["harmonised"] = {"between": "mixed", "gain": {"R": [0.9, 1.1], "G": [0.8, 1.2], "B": [1, 1]}}
    opacity = {"size": [64, 64], "type": "video/AV1"}
    found["proxy"]["sheets"] = {"triangles": list(range(1, 33)), "opacity": opacity}
    lines = text_lines(found)
    assert len(lines) <= 19 and all("\n" not in line and len(line) <= LINE_MAX_CHARACTERS + 20 for line in lines)
    text = "\n".join(lines)
    assert "sheets        32 of 1 to 32 triangles" in text and "gains of 0.800 to 1.200" in text
    for scores in ({}, {"image": 3}, {"image": {"encoded": []}, "between": None}):
        assert "scores        none" in text_lines(found | {"scores": scores})[-1]
