"""`eigenfield validate`: every finding in scene files."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import click

from eigenfield.cli.common import PATH, common_options, echo_json
from eigenfield.runtime.objects import address_of


@click.command(
    epilog="""\b
Exit code 0 if no file has an error, 2 otherwise. `eigenfield help format` explains the codes.

\b
Examples:
  eigenfield validate scene.glb
  eigenfield validate --json scenes/*.glb"""
)
@click.argument("files", nargs=-1, required=True, metavar="FILE...", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="Findings as JSON, a list with one object a file.")
@common_options
@click.pass_context
def command(context: click.Context, files: tuple[Path, ...], as_json: bool, quiet: bool) -> None:
    """Check scene FILEs, pictures included, and list every finding: errors, warnings, informations."""
    from eigenfield.gltf import validate

    found = {address_of(file): validate(file) for file in files}
    if as_json:
        echo_json([{"file": file, "findings": [asdict(f) for f in findings]} for file, findings in found.items()])
    else:
        for file, findings in found.items():
            if not findings and not quiet:
                click.echo(f"{file}: no findings")
            for finding in findings:
                if finding.severity == "error" or not quiet:
                    click.echo(f"{file}: {finding.severity} {finding.code} at {finding.where}: {finding.message}")
    if any(finding.severity == "error" for findings in found.values() for finding in findings):
        context.exit(2)
