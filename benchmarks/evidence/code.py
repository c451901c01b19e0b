"""What a source file means: figures are measured again when that changes, not when a comment does."""

from __future__ import annotations

import ast
from pathlib import Path


def meaning(file: Path) -> bytes:
    """The syntax tree of a Python file, without comments, places and layout."""
    return ast.dump(ast.parse(file.read_text(encoding="utf-8"))).encode()
