"""Small mistakes that no test notices: `python benchmarks/mutants.py ROOM`, on systems that have `os.fork`.

A mutant is the program with one mistake: another comparison or sign, a constant that is off by one, a statement that
is missing. Some test should fail. Where none does, a test is missing, or the line is not needed, or both say the same.

1. The tree is copied. The working tree is never changed.
2. The room's tests run once, each file in a process of its own, and note the lines of the room that each test runs.
   Files of other rooms' tests that import the room follow. All this ends when half of the time has passed.
3. Lines are drawn at random, and a mutation of each. The tests that run the line are run until one fails. Each run is
   a fork of a process that has already imported what the tests import, except the package itself.

Python does not see lines of a compiled kernel: every test of a file that imports the kernel counts as running it. A
changed kernel, or a changed constant that kernels import, makes numba compile again what the tests call. That takes up
to a minute, so fewer such mutants are tried in the same time.

A test that finds an earlier test's result in a cache does not count as running the lines that made it. What is run in
processes that tests start is not seen either. A reader therefore looks at each survivor and at each line not run.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import importlib
import inspect
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import threading
import time
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from mutations import Mutation, find_mutations

NOT_COPIED = (".git", ".venv", ".hypothesis", "build", "demo", "node_modules", "__pycache__", "shared")
OTHER_SECONDS = 40.0  # of a file of another room's tests
TEST_SECONDS = 60.0  # of tests for one mutant, as they take without it; longer tests are left out
START_SECONDS, COMPILE_SECONDS, SLOWER = (
    20.0,
    180.0,
    4.0,
)  # a mutant's tests may take these more, and this times as long
Lines = set[tuple[str, int]]  # files and numbers


class _Watch:
    """A plugin of pytest that runs the chosen tests, and says what failed first or which lines each test ran."""

    def __init__(self, chosen: list[str] | None, place: str) -> None:
        self.chosen, self.place, self.failed = chosen, place, ""
        self.imports, self.lines = Lines(), Lines()  # lines: of what runs now
        self.fixtures = defaultdict[str, Lines](Lines)
        self.tests: dict[str, dict[str, Any]] = {}

    def trace(self, frame: Any, event: str, _: object) -> Any:
        name = frame.f_code.co_filename
        if not name.startswith(self.place):
            return None
        body = not frame.f_code.co_flags & inspect.CO_OPTIMIZED  # of a module or class: it runs once in a process
        if event == "line":
            (self.imports if body else self.lines).add((name, frame.f_lineno))
        return self.trace

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        if self.chosen is not None:
            found = {item.nodeid: item for item in items}
            items[:] = [found[name] for name in self.chosen if name in found]
        self.imports |= self.lines

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        outer = self.lines
        if fixturedef.scope != "function":  # other tests use it too
            self.lines = self.fixtures[fixturedef.argname]
        try:
            return (yield)
        finally:
            self.lines = outer

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Function) -> Iterator[None]:
        self.lines, begin = Lines(), time.monotonic()
        test = self.tests[item.nodeid] = {"lines": self.lines, "fixtures": item.fixturenames, "passed": True}
        try:
            return (yield)
        finally:
            test["seconds"] = time.monotonic() - begin

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid
            self.tests[report.nodeid]["passed"] = False

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.failed = self.failed or "import"

    def noted(self, tree: Path) -> dict[str, Any]:
        """Each test with its lines, and the modules that are not of the tree."""
        for test in self.tests.values():
            lines = self.imports.union(test["lines"], *(self.fixtures[name] for name in test["fixtures"]))
            test["lines"] = [(str(Path(file).relative_to(tree / "src")), line) for file, line in sorted(lines)]
        files = {name: getattr(module, "__file__", None) for name, module in list(sys.modules.items())}
        others = [name for name, file in files.items() if file and not file.startswith(str(tree))]
        return {"tests": self.tests, "modules": others}


class Tree:
    """A copy of the tree, and the process that runs tests in it."""

    def __init__(self, root: Path, folder: Path) -> None:
        self.folder, self.output = folder / "tree", folder / "result.json"
        self.cache = folder / "cache"  # of kernels: a folder for each state of a file of them
        self.cache.mkdir()
        shutil.copytree(root, self.folder, ignore=shutil.ignore_patterns(*NOT_COPIED), symlinks=True)

    def run(self, room: str, files: list[str], chosen: list[str] | None, limit: float) -> Any:
        """What a forked process notes: what failed first of the chosen tests, or all tests and their lines.

        A word if it ended without a note.
        """
        self.output.unlink(missing_ok=True)
        known = set(self.cache.iterdir())
        begin, late, child = time.monotonic(), False, os.fork()
        if not child:
            try:
                self._run(room, files, chosen)
            finally:
                os._exit(0)
        try:
            while not late and os.waitpid(child, os.WNOHANG)[0] == 0:
                time.sleep(0.01)
                late = time.monotonic() - begin > limit + COMPILE_SECONDS * (known != set(self.cache.iterdir()))
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child, signal.SIGKILL)  # and what its tests have started
            for state in set(self.cache.iterdir()) - known if chosen else ():
                shutil.rmtree(state)
        if late:
            os.waitpid(child, 0)
            return "timed out"
        return json.loads(self.output.read_text()) if self.output.exists() else "its end"

    def _run(self, room: str, files: list[str], chosen: list[str] | None) -> None:
        os.setsid()
        for stream in range(3):
            os.dup2(os.open(os.devnull, os.O_RDWR), stream)
        os.chdir(self.folder)
        os.environ["PYTHONPATH"] = str(self.folder / "src")
        sys.path.insert(0, os.environ["PYTHONPATH"])
        watch = _Watch(chosen, str(self.folder / "src" / room))
        if chosen is None:
            sys.settrace(watch.trace)
            threading.settrace(watch.trace)
        else:
            sys.dont_write_bytecode, os.environ["PYTHONDONTWRITEBYTECODE"] = True, "1"
        os.environ["NUMBA_CACHE_DIR"] = str(self.cache)
        if "numba" in sys.modules:
            sys.modules["numba"].config.reload_config()
        words = ["-q", "-m", "not slow", "-p", "no:cacheprovider", "--assert=plain", "--tb=no", *files]
        code = pytest.main(words if chosen is None else ["-x", *words], plugins=[watch])
        sys.settrace(None)
        passed = code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
        result = {"failed": "" if passed else watch.failed or "pytest"}
        self.output.write_text(json.dumps(result | (watch.noted(self.folder) if chosen is None else {})))


class Room:
    """A room's mutations, and the tests that run each line."""

    def __init__(self, root: Path, name: str, seed: int) -> None:
        [place] = (root / "src").glob(f"*/{name}")
        self.name = str(place.relative_to(root / "src"))
        module = self.name.removesuffix(".py").replace("/", ".")
        texts = {str(p.relative_to(root)): p.read_text("utf-8") for p in sorted((root / "tests").rglob("test_*.py"))}
        self.own = [file for file in texts if file.startswith(f"tests/{name.split('/')[0]}/")]
        shares = {file: text.count(module) / len(text) for file, text in texts.items() if file not in self.own}
        self.others = sorted((file for file in shares if shares[file]), key=shares.__getitem__, reverse=True)
        self.tests, self.seconds = defaultdict[tuple[str, int], list[str]](list), dict[str, float]()
        lines = defaultdict[tuple[str, int], list[Mutation]](list)
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            for mutation in find_mutations(str(file.relative_to(root / "src")), file.read_bytes()):
                lines[mutation.path, mutation.line].append(mutation)
        draw = random.Random(seed)
        drawn = [draw.sample(found, len(found)) for found in draw.sample(list(lines.values()), len(lines))]
        turns = range(max(map(len, drawn), default=0))  # one mutation of each line, then another of each
        self.mutations = [found[turn] for turn in turns for found in drawn if turn < len(found)]

    def measure(self, tree: Tree, until: float, say: Callable[[str], None]) -> None:
        """Run the tests without a mutation."""
        for file in [*self.own, *self.others]:
            if time.monotonic() > until:
                say("half of the time is over, other tests are left out")
                break
            result = tree.run(self.name, [file], None, 600.0 if file in self.own else OTHER_SECONDS)
            if isinstance(result, str):
                say(f"{file}: {result}, left out")
                continue
            for module in result["modules"]:  # the next processes have them from the start
                with contextlib.suppress(Exception), warnings.catch_warnings(action="ignore"):
                    importlib.import_module(module)
            say(f"{file}: {len(result['tests'])} tests")
            for test, ran in result["tests"].items():
                if not ran["passed"]:
                    say(f"{test} fails without a mutation, left out")
                    continue
                self.seconds[test] = ran["seconds"]
                for path, line in ran["lines"]:
                    self.tests[path, line].append(test)

    def chosen(self, mutation: Mutation) -> list[str]:
        """The tests that run a mutation's line: the quickest, file by file."""
        names = {test for line in mutation.lines for test in self.tests[mutation.path, line]}
        total, files = 0.0, defaultdict[str, list[str]](list)
        for test in sorted(names, key=lambda test: (self.seconds[test], test)):
            total += self.seconds[test]
            if total < TEST_SECONDS or not files:
                files[test.split("::")[0]].append(test)
        return [test for tests in sorted(files.values(), key=self.sum) for test in tests]

    def sum(self, tests: list[str]) -> float:
        return sum(self.seconds[test] for test in tests)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("room", help="a folder or a file below the package: core, core/camera.py")
    parser.add_argument("--minutes", type=float, default=10, help="for all; default: 10")
    parser.add_argument("--seed", type=int, default=0, help="another draws other lines, also beside the first")
    parser.add_argument("--root", type=Path, default=Path(__file__).parents[1], help="holds src and tests")
    given = parser.parse_args(arguments)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # ends the tests and removes the copy
    begin, rows, counts = time.monotonic(), list[str](), Counter[str]()

    def say(text: str) -> None:
        print(f"{time.monotonic() - begin:4.0f} s  {text}", file=sys.stderr, flush=True)

    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        tree = Tree(given.root, Path(folder).resolve())
        room = Room(tree.folder, given.room, given.seed)
        room.measure(tree, begin + given.minutes * 30, say)
        gc.freeze()
        for mutation in room.mutations:
            if time.monotonic() - begin > given.minutes * 60:
                break
            if not (chosen := room.chosen(mutation)):
                counts["in lines that no test runs"] += 1
                continue
            file = tree.folder / "src" / mutation.path
            source = file.read_bytes()
            file.write_bytes(mutation.apply(source))
            files = list(dict.fromkeys(test.split("::")[0] for test in chosen))
            result = tree.run(room.name, files, chosen, START_SECONDS + SLOWER * room.sum(chosen))
            file.write_bytes(source)
            failed = result if isinstance(result, str) else result["failed"]
            verdict = "survived" if not failed else failed if failed == "timed out" else "killed"
            counts[verdict] += 1
            detail = f" by {failed}" if verdict == "killed" else f", tests: {len(chosen)}"
            row = mutation.row(source, verdict + detail)
            say(row)
            rows += [row] if verdict != "killed" else []
    print("| file | line | before | after | verdict |", "| --- | ---: | --- | --- | --- |", *sorted(rows), sep="\n")
    print(f"\n{room.name}, seed {given.seed}: " + ", ".join(f"{n} {word}" for word, n in sorted(counts.items())) + ".")
    return 0


if __name__ == "__main__":
    sys.exit(main())
