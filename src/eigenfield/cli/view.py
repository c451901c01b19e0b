"""`eigenfield view`: look around in a scene, in a browser."""

from __future__ import annotations

import threading
import webbrowser
from pathlib import Path

import click

from eigenfield.cli.capture_options import capture_argument, capture_options
from eigenfield.cli.common import PATH, common_options, note
from eigenfield.core.open_options import OpenOptions


@click.command(
    epilog="""\b
Examples:
  eigenfield view scene.glb
  eigenfield view scene.glb capture/
  eigenfield view scene.glb smaller.glb
  eigenfield view scene.glb --no-browser --port 8000"""
)
@click.argument("scene", type=PATH)
@capture_argument(required=False)
@capture_options
@click.option(
    "--port", type=click.IntRange(0, 65535), default=0, metavar="N", help="Port.  [default: one that is free]"
)
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    metavar="ADDRESS",
    help="Address to listen on. Any other lets the network see the scene; headsets want it by `adb reverse` instead, "
    "as browsers allow VR on localhost and https only.",
)
@click.option("--no-browser", is_flag=True, help="Print the address only.")
@click.option("--metres-per-unit", type=float, metavar="F", help="Metres in one unit of the capture, for VR.")
@common_options
def command(
    scene: Path,
    capture: Path | None,
    place: OpenOptions,
    port: int,
    host: str,
    no_browser: bool,
    metres_per_unit: float | None,
    quiet: bool,
) -> None:
    """Look around in SCENE, in a browser, beside the photographs of CAPTURE if it is given.

    A second .glb in place of CAPTURE is compared with SCENE: one eye sees both, with a divider between them.

    The address goes to standard output. Only this machine can open it, unless --host says otherwise, and
    nothing is fetched from elsewhere. Ctrl-C ends it, with exit code 0.
    """
    from eigenfield.viewer import view

    with view(
        scene, capture, host=host, port=port, browser=False, metres_per_unit=metres_per_unit, **place.changed()
    ) as server:
        try:
            click.echo(server.address)
            if server.is_public:
                note(f"listening on {server.host}: anyone on the network can see the scene", quiet)
            note("Ctrl-C ends it", quiet)
            if not no_browser and not webbrowser.open(server.address):
                note("no browser was found: open the address in one", quiet)
            wait_for_end()
        except KeyboardInterrupt:
            note("stopped", quiet)


def wait_for_end() -> None:
    """Until Ctrl-C, or SIGTERM, which main turns into the same."""
    forever = threading.Event()
    while not forever.wait(1.0):  # in steps: on Windows a wait without end cannot be interrupted
        pass
