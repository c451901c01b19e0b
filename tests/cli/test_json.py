"""Every verb's --json has a schema in docs/schema/. The fixture `run` checks all that any test prints against it."""

from __future__ import annotations

import importlib
import json

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from eigenfield.calibration.motion.report import describe_motion
from eigenfield.calibration.motion.result import SfmResult, ViewReport
from eigenfield.capture import open_capture
from eigenfield.capture.points import SparsePoints
from eigenfield.cli import VERBS
from support import printed


def test_every_verb_that_prints_json_has_a_schema():
    commands = {verb: importlib.import_module(f"eigenfield.cli.{verb}").command for verb in VERBS}
    with_json = {verb for verb, command in commands.items() if any("--json" in p.opts for p in command.params)}
    assert with_json == set(printed.VERBS)
    for verb in printed.VERBS:
        Draft202012Validator.check_schema(printed.schema(verb))
        assert printed.schema(verb)["title"].startswith("eigenfield.")


def test_scenes_and_figures(run, fitted):
    folder, scene = fitted
    info = json.loads(run("info", scene, "--json").out)
    result = run("evaluate", scene, folder, "--json", "-q")
    assert result.code == 0, result.err
    figures = json.loads(result.out)
    findings = json.loads(run("validate", scene, folder / "proxy.ply", "--json").out)
    assert findings[1]["findings"]
    for verb, report in (("info", info), ("evaluate", figures), ("validate", findings[0])):
        more = report | {"new": 1}
        assert "new" in str(printed.violation(verb, [more] if verb == "validate" else more))


@pytest.mark.parametrize("key", ["schema", "views", "lenses"])
def test_a_calibration(fitted, key):
    light_field = open_capture(fitted[0])
    views = tuple(ViewReport(view.name, True, "", "", 100, 3, 50, 0.25) for view in light_field.views)
    lost = ViewReport("lost.png", False, "few-features", "has 3 features", 3, 0, 0, None)
    points = SparsePoints(
        np.zeros((2, 3)), np.zeros((2, 3), np.uint8), np.array([0.5, 1.0]), np.arange(2), np.arange(2), np.zeros((2, 2))
    )
    report = json.loads(json.dumps(describe_motion(SfmResult(light_field, points, (*views, lost)))))
    assert printed.violation("calibrate", report) is None
    del report[key]
    assert key in str(printed.violation("calibrate", report))
