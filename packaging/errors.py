"""docs/errors.md: the codes of all errors with their messages and remedies, by room, read from the sources.

python packaging/errors.py [--check]
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / "src/eigenfield"
PAGE = ROOT / "docs/errors.md"
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
    for path in sorted(SOURCES.rglob("*.py")):
        room = path.relative_to(SOURCES).parts[0].removesuffix(".py")
        for one in raised(ast.parse(path.read_text(encoding="utf-8"))):
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
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ").strip()


def raised(tree: ast.Module) -> Iterator[Raised]:
    """All errors with a code that the module makes."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or len(node.args) < 2:
            continue
        kind = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        code = node.args[0]
        if kind.endswith("Error") and isinstance(code, ast.Constant) and isinstance(code.value, str):
            inside = [one for one in functions if one.lineno <= node.lineno <= (one.end_lineno or 0)]
            known = names(inside[-1] if inside else tree, tree)
            remedy = next((each.value for each in node.keywords if each.arg == "remedy"), None)
            texts = (said(part, known) if part is not None else "" for part in (node.args[1], remedy))
            yield Raised(kind, code.value, *texts)


def names(function: ast.AST, tree: ast.Module) -> dict[str, ast.expr]:
    """What names stand for in a function and in its module."""
    return {
        target.id: node.value
        for scope in (tree.body, list(ast.walk(function)))
        for node in scope
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }


def said(node: ast.expr, known: dict[str, ast.expr]) -> str:
    """A text of the source, a gap for what it is filled with."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(said(part, {}) for part in parts)
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
