"""The options of every command on the page of commands: what `--help` prints, as Markdown.

click hands its help to a formatter; this one writes headings, definition lists and code instead of columns.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from eigenfield.cli import VERBS, group

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGE = "reference/commands"


class Markdown(click.HelpFormatter):
    """Writes one command's help below a heading of the second level."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        self.write(f"```text\n{prog} {args}\n```\n\n")

    def write_text(self, text: str) -> None:
        for paragraph in inspect.cleandoc(text).split("\n\n"):
            if paragraph.startswith("\b\n"):  # lines that stay as they are
                self.write(f"```text\n{paragraph[2:]}\n```\n\n")
            else:
                self.write(f"{escaped(paragraph)}\n\n")

    def write_dl(self, rows: Sequence[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        for name, words in rows:
            self.write(f"`{name}`\n: {escaped(words)}\n\n")

    @contextmanager
    def section(self, name: str) -> Iterator[None]:
        self.write(f"**{escaped(name)}**\n\n")
        yield

    @contextmanager
    def indentation(self) -> Iterator[None]:
        yield


def escaped(text: str) -> str:
    """Text with options as code, and no other character that Markdown reads but between backticks."""
    text = re.sub(r"(?<![`\w-])--[a-z][a-z-]*", r"`\g<0>`", re.sub(r"\s+", " ", text))
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if i % 2 else re.sub(r"([\\*_<\[])", r"\\\1", part) for i, part in enumerate(parts))


def help_page() -> str:
    """All commands in the order of `eigenfield --help`, in Markdown."""
    formatter = Markdown()
    top = click.Context(group, info_name="eigenfield")
    for name in VERBS:
        command = group.get_command(top, name)
        assert command is not None
        formatter.write(f"## {name}\n\n")
        command.format_help(click.Context(command, info_name=name, parent=top), formatter)
    return formatter.getvalue()


def add_help(app: Sphinx, name: str, source: list[str]) -> None:
    if name == PAGE:
        source[0] += "\n" + help_page()


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", add_help)
    return {"parallel_read_safe": True}
