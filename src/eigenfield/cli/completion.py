"""`eigenfield completion`: what a shell runs to complete commands, options and file names."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

COMPLETION_VARIABLE = "_EIGENFIELD_COMPLETE"  # set by the script when it asks for completions


@click.command(
    epilog="""\b
Examples:
  eval "$(eigenfield completion bash)"                                   # in ~/.bashrc
  eval "$(eigenfield completion zsh)"                                    # in ~/.zshrc
  eigenfield completion fish > ~/.config/fish/completions/eigenfield.fish"""
)
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    """Print the script that completes commands, options and file names in SHELL."""
    assert context.parent is not None
    found = get_completion_class(shell)
    assert found is not None
    click.echo(found(context.parent.command, {}, "eigenfield", COMPLETION_VARIABLE).source())
