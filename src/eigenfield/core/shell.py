"""Words of commands that messages suggest."""

from __future__ import annotations

import os
import shlex


def shell_word(path: str | os.PathLike[str]) -> str:
    """A path as one word of a command line, which is not taken for an option."""
    text = os.fspath(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)
