"""Rooms import only from rooms below them, in no circle; `__all__` is what is exported; importing it is quick."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import eigenfield

ROOT = Path(eigenfield.__file__).parent
FLOORS = [  # from the ground up; rooms of one floor do not know each other
    ["core"],
    ["runtime"],
    ["imaging"],
    ["coding"],
    ["gltf", "capture", "stereo"],
    ["proxy", "calibration"],
    ["reconstruction", "rendering"],
    ["encoding"],
    ["evaluation", "viewer", "demo"],
    ["batches", "api"],
    ["cli"],
    ["__init__", "__main__"],
]
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}


def module_name(path):
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}


@cache
def nodes(path):
    """Imports, calls and classes of a file, wherever in it: it is parsed once for all tests."""
    wanted = (ast.Import, ast.ImportFrom, ast.Call, ast.ClassDef)
    return [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, wanted)]


def imports(path):
    """The package's own modules that a file imports, wherever in it."""
    for node in nodes(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.split(".")[0] == "eigenfield")
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "eigenfield":
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in MODULES else node.module


def room_of(module):
    return [*module.split("."), "__init__"][1]


def folder_of(module):
    """The folder in a module's room, or the module itself where it is in none."""
    return [*module.split("."), "__init__", "__init__"][2]


def test_rooms_import_only_from_rooms_below():
    offenders = []
    for name, path in MODULES.items():
        for other in imports(path):
            same = room_of(name) == room_of(other)
            if not same and FLOOR[room_of(other)] >= FLOOR[room_of(name)] and name != "eigenfield":
                offenders.append(f"{name} (floor {FLOOR[room_of(name)]}) imports {other}")
    assert len(MODULES) > 200 and not offenders, "\n".join(offenders)


def assert_no_circle(graph, what):
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        raise AssertionError(f"a circle of {what}: {' <- '.join(error.args[1])}") from None


def test_no_circle_of_imports():
    assert_no_circle({name: set(imports(path)) - {name} for name, path in MODULES.items()}, "imports")


def test_no_circle_of_folders():
    """Within a room its folders stand on floors too, and so does each of its modules that is in no folder."""
    graphs = {}
    for name, path in MODULES.items():
        for other in imports(path):
            room, folder, another = room_of(name), folder_of(name), folder_of(other)
            if room == room_of(other) and folder != another:
                graphs.setdefault(room, {}).setdefault(folder, set()).add(another)
    assert len(graphs) > 10
    for room, graph in graphs.items():
        assert_no_circle(graph, f"folders in {room}")


def test_every_room_has_a_floor():
    rooms = {path.relative_to(ROOT).parts[0].removesuffix(".py") for path in MODULES.values()}
    assert rooms == set(FLOOR)


def test_every_public_name_exists_and_is_documented():
    for name in eigenfield.__all__:
        value = getattr(eigenfield, name)
        assert name == "__version__" or value.__doc__, name
    assert set(eigenfield.__all__) <= set(dir(eigenfield))


def test_import_is_quick_and_loads_nothing_heavy():
    code = (
        "import sys, time; t = time.perf_counter(); import eigenfield; t = time.perf_counter() - t;"
        "heavy = {'numpy', 'numba', 'cv2', 'scipy', 'matplotlib', 'av', 'trimesh', 'rich'} & set(sys.modules);"
        "assert not heavy, heavy; print(t)"
    )
    times = [float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(3)]
    assert min(times) < 0.5, times  # the quickest, since the machine may be busy


def test_nothing_prints_but_the_command_line():
    others = [path for path in MODULES.values() if path.relative_to(ROOT).parts[0] != "cli"]
    assert len(others) > 200
    for path in others:
        calls = [node for node in nodes(path) if isinstance(node, ast.Call)]
        assert not any(isinstance(c.func, ast.Name) and c.func.id == "print" for c in calls), path


def test_no_public_class_name_twice():
    places = {}
    for name, path in MODULES.items():
        for node in nodes(path):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(name)
    for name, module in (("Scene", "scene"), ("Clip", "clip")):  # to which `api` adds methods: decision 41
        assert sorted(places.pop(name)) == ["eigenfield.api", f"eigenfield.core.{module}"]
    offenders = [f"{name}: {', '.join(modules)}" for name, modules in sorted(places.items()) if len(modules) > 1]
    assert len(places) > 100 and not offenders, "\n".join(offenders)


def test_the_table_of_the_paper_s_equations_leads_to_them():
    """Each row of docs/architecture.md names a file, and functions that stand in it; each equation has a row."""
    text = (ROOT.parents[1] / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \| `([a-z_/]+\.py)` \|$", text, re.MULTILINE)
    numbers = [span for paper, _, _ in rows for span in re.findall(r"^(\d)(?: to (\d))?:", paper)]
    assert [n for first, last in numbers for n in range(int(first), int(last or first) + 1)] == list(range(1, 9))
    for _, here, file in rows:
        code = (ROOT / file).read_text(encoding="utf-8")
        names = re.findall(r"`(?:\w+\.)?(_?[a-z_]+)`", here)
        assert all(f"def {name}(" in code for name in names), (file, names)
