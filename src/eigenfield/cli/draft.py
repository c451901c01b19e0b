"""`encode --draft` and `encode --view`: a first look at a scene, and a page in which the scene takes its place."""

from __future__ import annotations

import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from eigenfield.cli.common import note
from eigenfield.cli.progress import StepProgress, duration_range
from eigenfield.core.errors import EigenfieldError
from eigenfield.core.progress import begin_step
from eigenfield.core.shell import shell_word

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.core.progress import Progress
    from eigenfield.core.scene import Scene
    from eigenfield.encoding import EncodeOptions
    from eigenfield.reconstruction import SurfaceOptions
    from eigenfield.viewer.server import Server

DRAFT_STEP = "draft"


def draft_of(
    capture: Capture,
    proxy: Path | None,
    options: EncodeOptions,
    surface: SurfaceOptions | None,
    progress: Progress | None,
    quiet: bool,
) -> Scene | None:
    """A draft; None, with a note, where it would save nothing or cannot be made.

    Args:
        proxy: A mesh; None: it is estimated.
        surface: That is made; None: the proxy is given.
    """
    from eigenfield.encoding.cost import expected_cost
    from eigenfield.encoding.draft import DRAFT_WORTH_SECONDS, make_draft
    from eigenfield.runtime.parallel import threads

    seconds = expected_cost(capture, options, surface, threads()).seconds
    if seconds <= DRAFT_WORTH_SECONDS:
        note(f"a draft saves nothing here: the scene itself takes {duration_range(seconds)}", quiet)
        return None
    if isinstance(progress, StepProgress):
        progress.plan({}, {DRAFT_STEP: "draft: fewer and smaller photographs, without a fit"})
    begin_step(progress, DRAFT_STEP)
    try:
        return make_draft(capture, proxy, options, surface, progress)
    except EigenfieldError as error:
        note(f"no draft: {error.message}; going on with the whole scene", quiet)
        return None


def draft_lines(output: Path, scene: Scene) -> list[str]:
    """What is said of the file of a draft, in place of `last_lines`."""
    from eigenfield.encoding.draft import DRAFT_KEY
    from eigenfield.gltf import parts
    from eigenfield.runtime.objects import address_of

    factor, used = scene.settings[DRAFT_KEY], scene.settings["photographs"]["count"]
    smaller = f" at 1/{factor} of their size" if factor > 1 else ""
    return [
        f"{output}: {parts(output)['total'] / 1e3:,.0f} kB, a draft from {used} photographs{smaller}, without a fit",
        "the same command without --draft makes the scene itself, which is sharper and most often smaller",
        f"look around in the draft: eigenfield view {shell_word(address_of(output))}",
    ]


class Window:
    """The viewer's page while a scene is encoded: a draft, and the scene in its place."""

    def __init__(self, title: str, quiet: bool) -> None:
        """Nothing is opened yet."""
        self._title, self._quiet = title, quiet
        self._server: Server | None = None

    def __enter__(self) -> Window:
        return self

    def __exit__(self, *_: object) -> None:
        if self._server is not None:
            self._server.close()

    def show_draft(self, scene: Scene, progress: Progress | None) -> None:
        """Open the page with a draft."""
        from eigenfield.gltf import encode_scene

        known = progress.seconds_left if isinstance(progress, StepProgress) else lambda: None
        self._show(encode_scene(scene), known)

    def show(self, output: Path) -> None:
        """Put a file into the page, or open one."""
        from eigenfield.gltf import outline, without_residual

        self._show(without_residual(outline(output)[1]), None)

    def wait(self) -> None:
        """Until Ctrl-C."""
        from eigenfield.cli.view import wait_for_end

        note("the page stays open until Ctrl-C", self._quiet)
        try:
            wait_for_end()
        except KeyboardInterrupt:
            note("stopped", self._quiet)

    def _show(self, glb: bytes, seconds_left: Callable[[], float | None] | None) -> None:
        from eigenfield.viewer.manifest import make_manifest
        from eigenfield.viewer.server import Server

        manifest = make_manifest(glb, self._title, seconds_left=seconds_left)
        if self._server is not None:
            self._server.manifest = manifest
            return
        self._server = Server(manifest)
        self._server.start()
        click.echo(self._server.address)
        if not webbrowser.open(self._server.address):
            note("no browser was found: open the address in one", self._quiet)
