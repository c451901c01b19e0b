"""Small mistakes that no test notices: `python benchmarks/mutants.py ROOM`, on systems that have `os.fork`.

A mutant is the program with one mistake: another comparison or sign, a constant that is off by one, a statement that
is missing. Some test should fail. Where none does, a test is missing, or the line is not needed.

1. The tree is copied. The working tree is never changed.
2. The room's tests run once, each file in a process of its own, and note the lines of the room that each test runs.
   Tests of other rooms that import the room follow until a third of the time has passed.
3. Lines are drawn at random, and a mutation of each. The tests that run the line are run until one fails. Each run is
   a fork of a process that has already imported what the tests import, except the package itself.

Python does not see lines of a compiled kernel: every test of a file that imports the kernel counts as running it. A
changed kernel, or a changed constant that kernels import, makes numba compile again what the tests call. The new code
goes to a temporary cache and takes up to a minute, so fewer such mutants are tried in the same time.

A test that finds an earlier test's result in a cache does not count as running the lines that made it. A reader
therefore looks at each survivor, and may find that a test which was not run kills it.
"""

from __future__ import annotations

import argparse
import ast
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
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

NOT_COPIED = (".git", ".venv", ".hypothesis", "build", "demo", "node_modules", "__pycache__", "shared")
TEST_SECONDS = 60.0  # of tests for one mutant, as they take without it; longer tests are left out
OTHER_SECONDS = 40.0  # of a file of another room's tests
START_SECONDS, COMPILE_SECONDS, TIMES = 20.0, 180.0, 4.0  # limits of a mutant: these more, and so many times as long
OTHERS: dict[type[ast.AST], list[type[Any]]] = {
    ast.Lt: [ast.LtE, ast.GtE], ast.LtE: [ast.Lt, ast.Gt], ast.Gt: [ast.GtE, ast.LtE], ast.GtE: [ast.Gt, ast.Lt],
    ast.Eq: [ast.NotEq], ast.NotEq: [ast.Eq], ast.Is: [ast.IsNot], ast.IsNot: [ast.Is], ast.In: [ast.NotIn],
    ast.NotIn: [ast.In], ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div], ast.Div: [ast.Mult],
    ast.FloorDiv: [ast.Mult], ast.Mod: [ast.FloorDiv], ast.LShift: [ast.RShift], ast.RShift: [ast.LShift],
    ast.BitAnd: [ast.BitOr], ast.BitOr: [ast.BitAnd], ast.And: [ast.Or], ast.Or: [ast.And],
}  # fmt: skip
LEFT_ALONE = (ast.JoinedStr, ast.Import, ast.ImportFrom, ast.arg)
NOT_WALKED = ("annotation", "returns", "decorator_list")
OF_THE_MACHINE = ("sys.platform", "os.name", "TYPE_CHECKING", "sys.version_info")
NEWLINE = b"\n"
COMPILED = ("kernel", "intrinsic")  # names of decorators


@dataclass(frozen=True)
class Mutation:
    """One change of a file.

    Attributes:
        path: Below `src`.
        lines: Python says that it runs one of these when it runs the changed part.
        start: Of the bytes that are replaced.
        end: Of the bytes that are replaced.
        text: In their place.
    """

    path: str
    lines: range
    start: int
    end: int
    text: str

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.text.encode() + source[self.end :]

    def row(self, source: bytes, verdict: str) -> str:
        """A row of the table: file, line, what stood there, what stands there, verdict."""
        first, last = source.rfind(b"\n", 0, self.start) + 1, source.find(b"\n", self.end) - len(source)
        texts = (" ".join(text[first:last].decode().split())[:100] for text in (source, self.apply(source)))
        before, after = (f"`` {text} ``".replace("|", "\\|") for text in texts)
        return f"| {self.path} | {source.count(NEWLINE, 0, self.start) + 1} | {before} | {after} | {verdict} |"


def _texts(node: ast.AST) -> Iterator[str]:
    """What may stand in a node's place."""
    match node:
        case ast.Expr(value=ast.Constant()):  # a docstring
            pass
        case ast.Expr() | ast.Assign() | ast.AugAssign() | ast.Raise() | ast.Delete():
            yield "pass"
        case ast.Break() | ast.Continue():
            yield "continue" if isinstance(node, ast.Break) else "break"
        case ast.Return(value=ast.expr() as value) if ast.unparse(value) != "None":
            yield "return None"
        case ast.Compare(left=left, ops=ops, comparators=right):
            for index, op in enumerate(ops):
                for other in OTHERS[type(op)]:
                    yield f"({ast.unparse(ast.Compare(left, [*ops[:index], other(), *ops[index + 1 :]], right))})"
        case ast.BinOp(op=op) | ast.BoolOp(op=op) if type(op) in OTHERS:
            changed = type(node)(**dict(ast.iter_fields(node)) | {"op": OTHERS[type(op)][0]()})
            yield f"({ast.unparse(changed)})"
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield f"({ast.unparse(operand)})"
        case ast.Constant(value=bool(value)):
            yield str(not value)
        case ast.Constant(value=int(value)):
            yield from (str(value + 1), f"({value - 1})")
        case ast.Constant(value=float(value)):
            yield repr(value * 1.5 if value else 0.5)


def find_mutations(path: str, source: bytes) -> list[Mutation]:
    """All mutations of a file. Docstrings, annotations, decorators and the words of errors stay as they are."""
    starts = [0, 0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def walk(node: Any, lines: range, kernel: bool, condition: bool) -> Iterator[Mutation]:
        if isinstance(node, ast.stmt) and not kernel:  # a kernel is seen where it is defined
            decorators = getattr(node, "decorator_list", [])
            last = node.body[0].lineno - 1 if hasattr(node, "body") else node.end_lineno
            lines = range(min(d.lineno for d in [node, *decorators]), max(node.lineno, last or 0) + 1)
            kernel = any(name in ast.unparse(d) for d in decorators for name in COMPILED)
        for text in list(_texts(node)) or ([f"(not {ast.unparse(node)})"] if condition else []):
            first, last = (starts[n] for n in (node.lineno, node.end_lineno))
            yield Mutation(path, lines, first + node.col_offset, last + node.end_col_offset, text)
        if isinstance(node, ast.If) and any(name in ast.unparse(node.test) for name in OF_THE_MACHINE):
            return
        for name, value in ast.iter_fields(node):
            for child in value if isinstance(value, list) else [value]:
                skipped = name in NOT_WALKED or isinstance(node, ast.Raise) or isinstance(child, LEFT_ALONE)
                if isinstance(child, ast.AST) and not skipped:
                    yield from walk(child, lines, kernel, name == "test")

    return list(walk(ast.parse(source), range(1), False, False))


class _Watch:
    """A plugin of pytest that runs the chosen tests, and says what failed first or which lines each test ran."""

    def __init__(self, chosen: list[str] | None, room: str) -> None:
        self.chosen, self.room, self.failed = chosen, room, ""
        self.imports, self.lines = set[tuple[str, int]](), set[tuple[str, int]]()  # lines: of what runs now
        self.shared: dict[str, set[tuple[str, int]]] = {}  # by fixture
        self.tests: dict[str, dict[str, Any]] = {}

    def trace(self, frame: Any, event: str, _: object) -> Any:
        name = frame.f_code.co_filename
        if not name.startswith(self.room):
            return None
        body = not frame.f_code.co_flags & inspect.CO_OPTIMIZED  # of a module or class, which runs once a process
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
        if fixturedef.scope != "function":
            self.lines = self.shared.setdefault(fixturedef.argname, set())
        try:
            return (yield)
        finally:
            self.lines = outer

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Function) -> Iterator[None]:
        self.lines, begin = set(), time.monotonic()
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

    def result(self, tree: Path) -> dict[str, Any]:
        """Each test that passed with its lines; and the modules that are not of the tree."""
        tests = {}
        for name, test in self.tests.items():
            shared = (self.shared.get(fixture, set()) for fixture in test["fixtures"])
            lines = sorted(self.imports.union(test["lines"], *shared))
            tests[name] = test | {"lines": [(str(Path(p).relative_to(tree / "src")), n) for p, n in lines]}
        files = ((name, getattr(module, "__file__", None)) for name, module in list(sys.modules.items()))
        return {"tests": tests, "modules": [n for n, file in files if file and not file.startswith(str(tree))]}


def _digest() -> str:
    """The name of this state of all kernels and of what they import."""
    with contextlib.suppress(Exception):  # another package, or a mutant of what makes the name
        from eigenfield.runtime.jit import _cache_folder

        return _cache_folder()
    return ""


class Tree:
    """A copy of the tree, and what runs in it."""

    def __init__(self, root: Path, folder: Path) -> None:
        self.folder, self.output = folder / "tree", folder / "result.json"
        self.kernels, self.changed, self.digest = folder / "kernels", folder / "changed", ""
        shutil.copytree(root, self.folder, ignore=shutil.ignore_patterns(*NOT_COPIED), symlinks=True)

    def start(self, room: str, files: list[str], chosen: list[str] | None) -> None:
        """Fork a process that runs tests: those chosen until one fails, or all, noting their lines."""
        self.output.unlink(missing_ok=True)
        shutil.rmtree(self.changed, ignore_errors=True)
        self.began, self.child = time.monotonic(), os.fork()
        if self.child:
            return
        try:
            os.setsid()
            for stream in range(3):
                os.dup2(os.open(os.devnull, os.O_RDWR), stream)
            os.chdir(self.folder)
            os.environ["PYTHONPATH"] = str(self.folder / "src")
            sys.path.insert(0, os.environ["PYTHONPATH"])
            digest = _digest()
            changed = self.digest not in ("", digest)
            os.environ["NUMBA_CACHE_DIR"] = str(self.changed if changed else self.kernels)
            if changed:
                self.changed.mkdir()
            if "numba" in sys.modules:
                sys.modules["numba"].config.reload_config()
            watch = _Watch(chosen, str(self.folder / "src" / room))
            words = ["-q", "-m", "not slow", "-p", "no:cacheprovider", "--assert=plain", "--tb=no", *files]
            if chosen is None:
                sys.settrace(watch.trace)
                threading.settrace(watch.trace)
            else:
                words.append("-x")
                sys.dont_write_bytecode, os.environ["PYTHONDONTWRITEBYTECODE"] = True, "1"
            code = pytest.main(words, plugins=[watch])
            sys.settrace(None)
            passed = code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
            failed = None if passed else watch.failed or "pytest"
            noted = watch.result(self.folder) if chosen is None else {}
            self.output.write_text(json.dumps({"failed": failed, "digest": digest} | noted))
        finally:
            os._exit(0)

    def wait(self, limit: float) -> Any:
        """The result, or a word for a process that gave none."""
        while os.waitpid(self.child, os.WNOHANG)[0] == 0:
            time.sleep(0.01)
            if time.monotonic() - self.began > limit + COMPILE_SECONDS * self.changed.exists():
                self._end()
                os.waitpid(self.child, 0)
                return "timed out"
        self._end()
        return json.loads(self.output.read_text()) if self.output.exists() else "process ended"

    def _end(self) -> None:
        """End what the tests have started."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.child, signal.SIGKILL)


class Room:
    """A room's mutations, and the tests that run each line."""

    def __init__(self, root: Path, name: str, seed: int) -> None:
        [place] = (root / "src").glob(f"*/{name}")
        self.source = root / "src"
        self.files = sorted(place.rglob("*.py")) if place.is_dir() else [place]
        self.name = str(place.relative_to(self.source))
        self.tests = defaultdict[tuple[str, int], list[str]](list)  # by line
        self.seconds: dict[str, float] = {}  # by test
        folder = f"tests/{name.split('/')[0]}/"
        module = self.name.removesuffix(".py").replace("/", ".")
        texts = {str(p.relative_to(root)): p.read_text("utf-8") for p in sorted((root / "tests").rglob("test_*.py"))}
        self.own = [file for file in texts if file.startswith(folder)]
        density = {f: text.count(module) / len(text) for f, text in texts.items() if f not in self.own}
        self.others = sorted((file for file in density if density[file]), key=density.__getitem__, reverse=True)
        draw, lines = random.Random(seed), defaultdict[tuple[str, int], list[Mutation]](list)
        for file in self.files:
            path, source = str(file.relative_to(self.source)), file.read_bytes()
            for mutation in find_mutations(path, source):
                lines[path, source[: mutation.start].count(b"\n")].append(mutation)
        of_lines = [draw.sample(found, len(found)) for found in draw.sample(list(lines.values()), len(lines))]
        # a mutation of each line, then a second one of each
        self.mutations = [m for turn in range(max(map(len, of_lines))) for m in (f[turn] for f in of_lines if f[turn:])]

    def measure(self, tree: Tree, until: float, say: Callable[[str], None]) -> None:
        """Run the tests without a mutation."""
        for file in [*self.own, *self.others]:
            if file not in self.own and time.monotonic() > until:
                break
            limit = 600.0 if file in self.own else OTHER_SECONDS
            tree.start(self.name, [file], None)
            result = tree.wait(limit)
            if isinstance(result, str):
                say(f"{file}: {result}, left out")
                continue
            tree.digest = result["digest"]
            for module in result["modules"]:  # the next processes have them
                with contextlib.suppress(Exception):
                    importlib.import_module(module)
            for test, ran in result["tests"].items():
                if not ran["passed"]:
                    say(f"{test} fails without a mutation, left out")
                    continue
                self.seconds[test] = ran["seconds"]
                for path, line in ran["lines"]:
                    self.tests[path, line].append(test)
            say(f"{file}: {len(result['tests'])} tests")

    def chosen(self, mutation: Mutation) -> list[str]:
        """The tests that run a mutation's line: file by file, quick files first, the quick tests of all first."""
        names = dict.fromkeys(test for line in mutation.lines for test in self.tests[mutation.path, line])
        total, files = 0.0, defaultdict[str, list[str]](list)
        for test in sorted(names, key=self.seconds.__getitem__):
            total += self.seconds[test]
            if total > TEST_SECONDS and files:
                break
            files[test.split("::")[0]].append(test)
        order = sorted(files.values(), key=lambda tests: sum(map(self.seconds.__getitem__, tests)))
        return [test for tests in order for test in tests]


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("room", help="a folder or file below the package, such as core or core/camera.py")
    parser.add_argument("--minutes", type=float, default=10, help="for all; default: 10")
    parser.add_argument("--seed", type=int, default=0, help="another draws other lines; default: 0")
    parser.add_argument("--root", type=Path, default=Path(__file__).parents[1], help="holds src and tests")
    given = parser.parse_args(arguments)
    begin = time.monotonic()

    def say(text: str) -> None:
        print(f"{time.monotonic() - begin:4.0f} s  {text}", file=sys.stderr, flush=True)

    rows, counts = list[str](), Counter[str]()
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        tree = Tree(given.root, Path(folder).resolve())
        room = Room(tree.folder, given.room, given.seed)
        room.measure(tree, begin + given.minutes * 20, say)
        gc.freeze()
        for mutation in room.mutations:
            if time.monotonic() - begin > given.minutes * 60:
                break
            if not (chosen := room.chosen(mutation)):
                counts["in lines that no test runs"] += 1
                continue
            file = tree.folder / "src" / mutation.path
            source = file.read_bytes()
            kept = file.rename(tree.folder / "kept")  # with its time, which the name of the kernels' cache depends on
            file.write_bytes(mutation.apply(source))
            tree.start(room.name, sorted({test.split("::")[0] for test in chosen}), chosen)
            result = tree.wait(START_SECONDS + TIMES * sum(map(room.seconds.__getitem__, chosen)))
            kept.replace(file)
            failed = result if isinstance(result, str) else result["failed"]
            verdict = "survived" if not failed else "timed out" if failed == "timed out" else "killed"
            counts[verdict] += 1
            row = mutation.row(
                source, f"killed by {failed}" if verdict == "killed" else f"{verdict}, {len(chosen)} tests"
            )
            say(row)
            if verdict != "killed":
                rows.append(row)
    print("| file | line | before | after | verdict |", "| --- | ---: | --- | --- | --- |", *sorted(rows), sep="\n")
    print(f"\n{room.name}, seed {given.seed}: " + ", ".join(f"{n} {word}" for word, n in sorted(counts.items())) + ".")
    return 0


if __name__ == "__main__":
    sys.exit(main())
