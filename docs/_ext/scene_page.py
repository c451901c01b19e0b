"""What is made beside the pages: the scene of the first one, the page that opens files, in open/, the add-on's zip.

`docs/scene.glb` is what `eigenfield demo` leaves in demo/scene.glb.
"""

from __future__ import annotations

import runpy
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import eigenfield as ef

if TYPE_CHECKING:
    from sphinx.application import Sphinx

TITLE = "A jar, an orange and two balls"


def write_pages(app: Sphinx, problem: Exception | None) -> None:
    """Write scene.html with its poster scene.jpg, open/ with the same scene to choose, and the add-on's zip."""
    if problem is None and app.builder.format == "html":
        scene, out = Path(app.srcdir) / "scene.glb", Path(app.outdir)
        ef.export(scene, out / "scene.html", plain=True, title=TITLE, overwrite=True, progress=None)
        with TemporaryDirectory() as folder:  # the sample is called by its file
            sample = Path(shutil.copy(scene, Path(folder) / "jar.glb"))
            ef.export(sample, out / "open", kind="app", overwrite=True, progress=None)
        runpy.run_path(str(Path(app.srcdir).parent / "packaging/addon.py"))["pack"](out / "eigenfield-blender.zip")


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", write_pages)
    return {"parallel_read_safe": True}
