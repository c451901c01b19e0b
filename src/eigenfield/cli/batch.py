"""`eigenfield batch`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from eigenfield.cli.capture_options import BY_HAND, surface_options
from eigenfield.cli.common import PATH, common_options, note
from eigenfield.cli.encode import parse_atlas, parse_target_size
from eigenfield.cli.field_options import field_options
from eigenfield.cli.progress import progress_bars
from eigenfield.encoding import EncodeOptions


@click.command(
    epilog="""\b
Examples:
  eigenfield batch captures/
  eigenfield batch captures.toml -o scenes --preset small
  eigenfield batch captures/ --workers 2
  eigenfield batch s3://lab/captures -o s3://lab/scenes
  eigenfield batch captures/ --cluster tcp://head:8786
  eigenfield batch captures/ --cluster ssh:anna,bert"""
)
@click.argument("source", type=PATH, nargs=-1, required=True, metavar="CAPTURES")
@click.option(
    "--output", "-o", type=PATH, metavar="DIR", help="Folder to write.  [default: CAPTURES-scenes, beside them]"
)
@click.option("--workers", type=int, metavar="N", help="Processes of this machine; with --cluster slurm, its jobs.")
@click.option(
    "--cluster",
    metavar="ADDRESS",
    help="Workers on other machines: a Dask scheduler's address, slurm, or ssh:HOST,HOST (the extra cluster).",
)
@field_options(EncodeOptions, atlas=parse_atlas, target_size=parse_target_size)
@surface_options("surface", "layers", *BY_HAND)
@common_options
def command(
    source: tuple[Path, ...], output: Path | None, workers: int | None, cluster: str | None, quiet: bool,
    **options: Any,
) -> None:  # fmt: skip
    """Encode and measure many captures: a folder of them, their paths, or a .toml that lists them.

    DIR then holds index.html with all scenes a click away, table.md, table.csv and table.json, and scenes/. A capture
    that fails is a line of the table, and the others go on. The same command goes on with what is missing: after an
    interruption, after a worker was killed, or with captures that were added.
    """  # fmt: skip
    from eigenfield.batches import batch
    from eigenfield.batches.table import as_markdown
    from eigenfield.runtime.objects import address_of

    started = time.monotonic()
    named = {name.removeprefix("rights_"): value for name, value in options.items()}  # as on the command line
    shared = {name: value for name, value in named.items() if value not in (None, (), "auto")}
    given = source[0] if len(source) == 1 else list(source)
    try:
        with progress_bars(quiet) as progress:
            done = batch(given, output, workers=workers, cluster=cluster, progress=progress, **shared)
    except KeyboardInterrupt:
        note("the same command goes on with what is missing", quiet)
        raise
    click.echo(as_markdown(done.records), nl=False)
    before = f", {done.taken_up} of them finished before" if done.taken_up else ""
    finished = len(done.records) - len(done.failed)
    note(f"{address_of(done.page)}: {finished} scenes{before}, {time.monotonic() - started:.0f} s", quiet)
    for record in done.failed:
        where = f" (on {record['worker']})" if record["worker"] else ""
        click.echo(f"eigenfield: {record['name']}: {record['error']}{where}", err=True)
    if done.failed:
        click.get_current_context().exit(2)
