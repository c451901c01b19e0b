"""Two pages that eigenfield makes: the scene of the first one, and the page that opens files, in open/.

`docs/scene.glb` is what `eigenfield demo` leaves in demo/scene.glb.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import eigenfield as ef

if TYPE_CHECKING:
    from sphinx.application import Sphinx


def write_pages(app: Sphinx, problem: Exception | None) -> None:
    """Write scene.html with its poster scene.jpg, and open/ with the same scene to choose."""
    if problem is None and app.builder.format == "html":
        scene, out = Path(app.srcdir) / "scene.glb", Path(app.outdir)
        ef.export(scene, out / "scene.html", plain=True, title="A light field", overwrite=True, progress=None)
        ef.export(scene, out / "open", kind="app", overwrite=True, progress=None)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", write_pages)
    return {"parallel_read_safe": True}
