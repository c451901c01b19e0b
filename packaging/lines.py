"""Lines of code and of docstrings in each room, without empty ones and comments, beside those of another commit.

`make lines` compares with the last tag, `make lines SINCE=COMMIT` with any other commit.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

SOURCES = "src/eigenfield"
DOCUMENTED = ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef


def main() -> None:
    """Print the table. The first argument names a commit; without one it is the last tag, if there is any."""
    tag = subprocess.run(["git", "describe", "--tags", "--abbrev=0"], capture_output=True, text=True).stdout.strip()
    since = sys.argv[1] if len(sys.argv) > 1 else tag
    now, before = lines_of(None), lines_of(since) if since else Counter()
    say(f"| room | code | docstrings |{f' since {since}: code | docstrings |' if since else ''}")
    say("|---|---|---|" + "---|---|" * bool(since))
    for room in [*sorted({room for room, _ in now | before}), ""]:
        row = [total(now, room, kind) for kind in ("code", "doc")]
        row += [
            f"{now_ - total(before, room, kind):+d}" for now_, kind in zip(row, ("code", "doc"), strict=True)
        ] * bool(since)
        say(f"| {room or 'all'} | " + " | ".join(str(cell) for cell in row) + " |")


def say(line: str) -> None:
    """Write a line to standard output."""
    sys.stdout.write(f"{line}\n")


def total(counts: Counter[tuple[str, str]], room: str, kind: str) -> int:
    """Of one room, or of all where its name is empty."""
    return sum(count for (one, of), count in counts.items() if of == kind and room in ("", one))


def lines_of(commit: str | None) -> Counter[tuple[str, str]]:
    """By room and kind. None: the files as they lie here."""
    counts: Counter[tuple[str, str]] = Counter()
    for path, text in files_of(commit):
        room = path.removeprefix(f"{SOURCES}/").split("/")[0].removesuffix(".py")
        counts[room, "doc"] += (docs := docstring_lines(text))
        filled = [line.strip() for line in text.splitlines()]
        counts[room, "code"] += sum(bool(line) and not line.startswith("#") for line in filled) - docs
    return counts


def files_of(commit: str | None) -> Iterator[tuple[str, str]]:
    """Paths and texts of the Python files."""
    listed = (
        ["git", "ls-files", SOURCES] if commit is None else ["git", "ls-tree", "-r", "--name-only", commit, SOURCES]
    )
    for path in subprocess.run(listed, check=True, capture_output=True, text=True).stdout.splitlines():
        if path.endswith(".py"):
            if commit is not None:
                shown = subprocess.run(["git", "show", f"{commit}:{path}"], check=True, capture_output=True)
                yield path, shown.stdout.decode()
            else:
                yield path, Path(path).read_text(encoding="utf-8")


def docstring_lines(text: str) -> int:
    """Lines of all docstrings that are not empty."""
    count = 0
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            first = node.body[0]
            count += sum(bool(line.strip()) for line in text.splitlines()[first.lineno - 1 : first.end_lineno])
    return count


if __name__ == "__main__":
    main()
