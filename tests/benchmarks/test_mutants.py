"""Mutations are small, and those that no test notices are listed."""

from __future__ import annotations

import ast
import os
import subprocess
import sys

import pytest

import mutants
from mutations import find_mutations

SOURCE = '''"""Words 1 < 2."""
from numba import njit
LIMIT = 3

def inside(a, b: int = 2, *, low: "1 < 2" = -1):
    """Words 1 < 2."""
    log.info("%d", 1 < 2)
    if not a:
        raise ValueError(f"{1 < 2}", 1 < 2)
    for x in zip(a, a, strict=True):
        if x > LIMIT and b:
            break
        b += x * 0.5
    if sys.platform == "win32":
        b += 1
    return b if x else low
'''
CHANGED = {
    "LIMIT = 4", "LIMIT = (2)", "b: int = 3", "b: int = (1)", "= (1)):", "-2", "-(0)", "if (a):", "pass", "x >= LIMIT",
    "x <= LIMIT", "x > LIMIT or b", "continue", "x / 0.5", "x * 0.75", "return None", "if (not x)",
}  # fmt: skip


def test_mutations_are_of_what_runs_and_still_python():
    source = SOURCE.encode()
    texts = [mutation.apply(source).decode() for mutation in find_mutations("a.py", source)]
    lines = SOURCE.splitlines()
    changed = []
    for text in texts:
        ast.parse(text)
        [pair] = [(old, new) for old, new in zip(lines, text.splitlines(), strict=True) if old != new]
        changed.append(pair)
    assert {old for old, _ in changed} == {lines[n] for n in (2, 4, 7, 8, 10, 11, 12, 15)}
    for part in CHANGED:
        assert any(part in new for _, new in changed), part
    assert len(set(texts)) == len(texts)


ROOM = """def larger(a, b):
    return a if a > b else b


def unused():
    return 1
"""
TEST = """from made.room.a import larger


def test_larger():
    assert larger(1, 2) == larger(2, 1) == 2
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="mutants are forks")
def test_a_survivor_is_listed_and_a_line_without_a_test_is_counted(tmp_path):
    for name, text in (("src/made/room/a.py", ROOM), ("tests/room/test_a.py", TEST)):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(text)
    command = [sys.executable, mutants.__file__, "room", "--root", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    *_, survivor, _, counts = done.stdout.splitlines()
    before, after = "`` return a if a > b else b ``", "`` return a if (a >= b) else b ``"
    assert survivor == f"| made/room/a.py | 2 | {before} | {after} | survived, tests: 1 |"
    assert counts == "made/room, seed 0: 3 in lines that no test runs, 2 killed, 1 survived."
    assert done.stderr.count("killed by tests/room/test_a.py::test_larger") == 2
    assert (tmp_path / "src/made/room/a.py").read_text() == ROOM
