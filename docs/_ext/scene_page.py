"""The scene of the first page: `scene.glb` as `eigenfield export --plain` writes it, with its poster beside it.

`docs/scene.glb` is what `eigenfield demo` leaves in demo/scene.glb.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import eigenfield as ef

if TYPE_CHECKING:
    from sphinx.application import Sphinx


def write_scene(app: Sphinx, problem: Exception | None) -> None:
    if problem is None and app.builder.format == "html":
        output = Path(app.outdir) / "scene.html"
        ef.export(
            Path(app.srcdir) / "scene.glb", output, plain=True, title="A light field", overwrite=True, progress=None
        )


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", write_scene)
    return {"parallel_read_safe": True}
