"""docs/errors.md: the codes of all errors with their messages and remedies, by room, read from the sources.

python packaging/errors.py [--check]
"""

from __future__ import annotations

import ast
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / "src/eigenfield"
PAGE = ROOT / "docs/errors.md"
CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
GAP = "…"  # stands for a value
HEAD = """# Errors by code

An error that you can correct is one line: the file, what is wrong, the remedy. Its code stays the same, so that scripts
may compare it: `error.code` in Python, `code` in what `--json` prints. The codes are sorted by the
[room](architecture.md) of the source that raises them; … stands for a value. `python packaging/errors.py` makes this
page from the source. Findings about a scene file stand in [the scene file](format.md).
"""


class Raised(NamedTuple):
    """An error where the source makes it."""

    kind: str
    code: str
    message: str
    remedy: str


def main() -> None:
    """Write the page. With `--check`: fail where it is not what would be written."""
    made = page()
    if "--check" in sys.argv and made != PAGE.read_text(encoding="utf-8"):
        raise SystemExit("docs/errors.md is not what the source says: run python packaging/errors.py")
    PAGE.write_text(made, encoding="utf-8")


def page() -> str:
    """The page as Markdown."""
    rooms: dict[str, dict[tuple[str, str], list[Raised]]] = defaultdict(lambda: defaultdict(list))
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(SOURCES.rglob("*.py"))}
    helpers = {name: function for tree in trees.values() for name, function in helpers_in(tree).items()}
    for path, tree in trees.items():
        room = path.relative_to(SOURCES).parts[0].removesuffix(".py")
        for one in raised(tree, helpers):
            rooms[room][one.code, one.kind].append(one)
    parts = [HEAD]
    for room, codes in sorted(rooms.items()):
        rows = [row(code, kind, found) for (code, kind), found in sorted(codes.items())]
        head = ["code", "error", "what it says", "what to do"]
        lines = "".join(f"| {' | '.join(cells)} |\n" for cells in (head, ["---"] * 4, *rows))
        parts.append(f"## {room}\n\n{lines}")
    return "\n".join(parts)


def row(code: str, kind: str, found: list[Raised]) -> list[str]:
    """One code of a room; what it says in different places stands below each other."""
    messages = list(dict.fromkeys(one.message for one in found if one.message))
    remedies = list(dict.fromkeys(one.remedy for one in found if one.remedy))
    return [f"`{code}`", kind, *("<br>".join(cell(text) for text in texts) for texts in (messages, remedies))]


def cell(text: str) -> str:
    """A text as it may stand in a table of Markdown."""
    shown = text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ").strip()
    return re.sub(f"{GAP}{GAP}+", GAP, shown)


def raised(tree: ast.Module, helpers: dict[str, ast.FunctionDef]) -> Iterator[Raised]:
    """All errors with a code that the module makes, by itself or by a helper."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or len(node.args) < 2 or not is_code(node.args[0]):
            continue
        inside = [one for one in functions if one.lineno <= node.lineno <= (one.end_lineno or 0)]
        known = names(inside[-1] if inside else tree, tree, node.lineno)
        name = name_of(node)
        if name.endswith("Error"):
            yield Raised(name, said(node.args[0], {}), said(node.args[1], known), said(keyword(node, "remedy"), known))
        elif name in helpers:
            made = error_of(helpers[name])
            assert made is not None
            arguments = bound(helpers[name], node)
            message, remedy = said(made.args[1], known | arguments), said(keyword(made, "remedy"), known | arguments)
            yield Raised(name_of(made), said(made.args[0], arguments), message, remedy)


def helpers_in(tree: ast.Module) -> dict[str, ast.FunctionDef]:
    """Functions that make an error of a code that they are given."""
    functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    return {one.name: one for one in functions if "code" in parameters(one)[:1] and error_of(one) is not None}


def parameters(function: ast.FunctionDef) -> list[str]:
    return [one.arg for one in function.args.args if one.arg != "self"]


def bound(function: ast.FunctionDef, call: ast.Call) -> dict[str, ast.expr]:
    """What the parameters of a function are in a call."""
    own = parameters(function)
    defaults = function.args.defaults
    found: dict[str, ast.expr] = dict(zip(own[len(own) - len(defaults) :], defaults, strict=True))
    return found | dict(zip(own, call.args, strict=False)) | {one.arg: one.value for one in call.keywords if one.arg}


def error_of(function: ast.FunctionDef) -> ast.Call | None:
    """The error that a function makes first."""
    calls = (node for node in ast.walk(function) if isinstance(node, ast.Call) and len(node.args) > 1)
    return next((call for call in calls if name_of(call).endswith("Error")), None)


def name_of(call: ast.Call) -> str:
    return call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")


def keyword(call: ast.Call, name: str) -> ast.expr:
    return next((one.value for one in call.keywords if one.arg == name), ast.Constant(None))


def is_code(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and bool(CODE.fullmatch(node.value))


def names(function: ast.AST, tree: ast.Module, line: int) -> dict[str, ast.expr]:
    """What names stand for at a line of a function: what was assigned to them last."""
    found: dict[str, ast.expr] = {}
    for scope in (tree.body, sorted(ast.walk(function), key=lambda node: getattr(node, "lineno", 0))):
        for node in scope:
            if isinstance(node, ast.Assign) and (scope is tree.body or node.lineno <= line):
                for target in node.targets:
                    found |= assigned(target, node.value)
    return found


def assigned(target: ast.expr, value: ast.expr) -> dict[str, ast.expr]:
    """What an assignment gives to each name, also of several at once."""
    match target, value:
        case ast.Name(id=name), _:
            return {name: value}
        case ast.Tuple(elts=names), ast.Tuple(elts=values) if len(names) == len(values):
            return {key: one for pair in zip(names, values, strict=True) for key, one in assigned(*pair).items()}
        case ast.Tuple(elts=names), _:  # of which nothing is known
            return {name.id: value for name in names if isinstance(name, ast.Name)}
    return {}


def said(node: ast.expr, known: dict[str, ast.expr]) -> str:
    """A text of the source, a gap for what it is filled with."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(said(part, known) for part in parts)
        case ast.FormattedValue(value=value):
            return said(value, known)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return said(left, known) + said(right, known)
        case ast.IfExp(body=one, orelse=other):
            return f"{said(one, known)} / {said(other, known)}"
        case ast.Name(id=name) if name in known:
            return said(known[name], {key: value for key, value in known.items() if key != name})
        case ast.Constant(value=None):
            return ""
    return GAP


if __name__ == "__main__":
    main()
