"""`eigenfield help`: the pages of the documentation, which a wheel holds too (`pyproject.toml` puts them in)."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from eigenfield.core.errors import OptionError

TOPICS = {
    "captures": "which command for which photographs, what goes wrong",
    "usage": "commands, options of encode, scripts",
    "time": "seconds, memory and disk",
    "install": "extras, the first run",
    "python": "the same in a program",
    "calibration": "how cameras are found, charts",
    "meshes": "what is read of a mesh",
    "exports": "what other programs get",
    "cluster": "many captures on many machines",
    "viewer": "keys, controls and addresses of the viewer",
    "measures": "what every figure means",
    "capture-formats": "what is read of photographs and calibrations, inspect --json",
    "format": "the file format, codes of findings",
}


def page(topic: str) -> str:
    """A page of the documentation, in Markdown.

    Args:
        topic: One of `TOPICS`.
    """
    package = Path(__file__).parents[1]
    inside, beside = package / "docs", package.parents[1] / "docs"  # of a wheel, and of a clone
    return ((inside if inside.is_dir() else beside) / f"{topic}.md").read_text("utf-8")


@click.command(
    epilog="""\b
Examples:
  eigenfield help
  eigenfield help captures
  eigenfield help encode"""
)
@click.argument("topic", required=False)
@click.pass_context
def command(context: click.Context, topic: str | None) -> None:
    """Read a page of the documentation, or the options of a command.

    Without TOPIC, list the topics.
    """
    assert context.parent is not None and isinstance(context.parent.command, click.Group)
    group = context.parent.command
    if topic is None:
        formatter = click.HelpFormatter()
        with formatter.section("Topics: eigenfield help TOPIC"):
            formatter.write_dl(list(TOPICS.items()))
        click.echo(formatter.getvalue().rstrip())
        click.echo(f"\nOptions of a command: eigenfield help COMMAND ({', '.join(group.list_commands(context))})")
    elif topic in TOPICS:
        _show(page(topic))
    elif (verb := group.get_command(context, topic)) is not None:
        click.echo(verb.get_help(click.Context(verb, parent=context.parent, info_name=topic)))
    else:
        raise OptionError("help-topic", f"no topic is called {topic}", remedy="`eigenfield help` lists them")


def _show(text: str) -> None:
    """The page with its headings and tables on a terminal, else as it is."""
    if not sys.stdout.isatty():
        click.echo(text.rstrip())
        return
    from rich.console import Console
    from rich.markdown import Markdown

    Console().print(Markdown(text, hyperlinks=False))
