"""Rooms import only from rooms below them; the public face is what `__all__` says; importing it is quick."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import eigenfield

ROOT = Path(eigenfield.__file__).parent
FLOORS = {
    0: [
        "camera",
        "mesh",
        "scene",
        "viewplane",
        "raster",
        "errors",
        "files",
        "stages",
        "jit",
        "parallel",
        "progress",
        "metrics",
        "flip",
    ],
    1: ["capture", "stereo"],
    2: ["calibrate", "proxy", "basis", "texturing"],
    3: [
        "rendering",
        "format",
        "fitting",
        "simplification",
        "draft",
        "pipeline",
        "holdout",
        "reconstruction",
        "residual",
    ],
    4: ["evaluation", "demo", "viewer"],
    5: ["cli", "__init__"],
    6: ["__main__"],
}
FLOOR = {room: floor for floor, rooms in FLOORS.items() for room in rooms}
SAME_FLOOR = {
    ("basis", "texturing"),
    ("fitting", "rendering"),
    ("fitting", "format"),
    ("fitting", "simplification"),
    ("simplification", "format"),
    ("draft", "fitting"),
    ("draft", "simplification"),
    ("draft", "format"),
    ("draft", "rendering"),
    ("draft", "holdout"),
    ("pipeline", "draft"),
    ("pipeline", "fitting"),
    ("reconstruction", "holdout"),
    ("residual", "format"),
    ("residual", "rendering"),
}
EXCEPTIONS = {("scene.py", "format"), ("scene.py", "viewer")}  # Scene.save, and how a notebook shows a scene


def imports(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("eigenfield"):
            parts = node.module.split(".")
            if len(parts) > 1:
                yield parts[1]
            else:
                yield from (alias.name if alias.name in FLOOR else "__version__" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name.split(".")[1] for alias in node.names if alias.name.startswith("eigenfield."))


def sources():
    return sorted(path for path in ROOT.rglob("*.py"))


@pytest.mark.parametrize("path", sources(), ids=lambda path: str(path.relative_to(ROOT)))
def test_a_room_imports_only_from_rooms_below(path):
    relative = path.relative_to(ROOT)
    room = relative.parts[0].removesuffix(".py")
    for other in imports(path):
        if other in (room, "__version__") or (str(relative), other) in EXCEPTIONS or room == "__init__":
            continue
        below = FLOOR[other] < FLOOR[room] or (room, other) in SAME_FLOOR or FLOOR[other] == FLOOR[room] == 0
        assert below, f"{relative} (floor {FLOOR[room]}) imports {other} (floor {FLOOR[other]})"


def test_every_public_name_exists_and_is_documented():
    for name in eigenfield.__all__:
        value = getattr(eigenfield, name)
        assert name == "__version__" or value.__doc__, name
    assert set(eigenfield.__all__) <= set(dir(eigenfield))


def test_import_is_quick_and_loads_nothing_heavy():
    code = (
        "import sys, time; t = time.perf_counter(); import eigenfield; t = time.perf_counter() - t;"
        "heavy = {'numpy', 'numba', 'cv2', 'scipy', 'matplotlib', 'av', 'trimesh', 'rich'} & set(sys.modules);"
        "assert not heavy, heavy; assert t < 0.5, t"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_nothing_prints_but_the_command_line():
    for path in sources():
        if path.relative_to(ROOT).parts[0] != "cli":
            calls = [n for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(n, ast.Call)]
            assert not any(isinstance(c.func, ast.Name) and c.func.id == "print" for c in calls), path
