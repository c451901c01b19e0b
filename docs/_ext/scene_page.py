"""What is made beside the pages: the scenes of the first one, the page that opens files, in open/, the add-on's zip.

`docs/scene.glb` is what `eigenfield demo` leaves in demo/scene.glb. `docs/scenes/` has encoded captures whose licence
lets anybody show them: NAME.glb, and NAME.json with its `title` and, in `from`, what it was made from, by whom and
under which licence. Of these `in-motion.glb` is a clip, of what `draw_demo_clip(folder, rows=3, columns=3, size=256,
frames=24)` draws, on the mesh of each frame (`encode folder --clip --proxy folder/mesh_%04d.ply`).
"""

from __future__ import annotations

import html
import json
import runpy
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import eigenfield as ef

if TYPE_CHECKING:
    from sphinx.application import Sphinx

TITLE = "A jar, an orange and two balls"
PLACE = "<!-- scenes -->"  # of the first page


def captures(docs: Path) -> dict[Path, dict[str, str]]:
    """What is said of each encoded capture."""
    paths = sorted(docs.glob("scenes/*.glb"))
    return {path: json.loads(path.with_suffix(".json").read_text("utf-8")) for path in paths}


def card(path: Path, about: dict[str, str]) -> str:
    """A picture that leads to the page of a scene or a clip, which plays there, and what it was made from."""
    title, made = html.escape(about["title"]), html.escape(f"{about['from']}; {path.stat().st_size / 1000:.0f} kB")
    picture = f'<img src="open/samples/{path.stem}.jpg" alt="" loading="lazy">'
    return f'<a href="scenes/{path.stem}.html">{picture}<strong>{title}</strong><span>{made}</span></a>'


def show_captures(app: Sphinx, name: str, source: list[str]) -> None:
    """Put the captures into the first page; nothing where there is none."""
    if name == "index":
        cards = "".join(card(path, about) for path, about in captures(Path(app.srcdir)).items())
        source[0] = source[0].replace(PLACE, f'<div class="scenes">{cards}</div>' if cards else "")


def write_pages(app: Sphinx, problem: Exception | None) -> None:
    """Write scene.html with its poster scene.jpg, scenes/, open/ with all of them to choose, and the add-on's zip."""
    if problem is None and app.builder.format == "html":
        docs, out = Path(app.srcdir), Path(app.outdir)
        scene, others = docs / "scene.glb", captures(docs)
        ef.export(scene, out / "scene.html", title=TITLE, overwrite=True, progress=None)
        (out / "scenes").mkdir(exist_ok=True)
        for path, about in others.items():
            page = out / "scenes" / f"{path.stem}.html"
            ef.export(path, page, title=about["title"], overwrite=True, progress=None)
        with TemporaryDirectory() as folder:  # the sample is called by its file
            samples = [Path(shutil.copy(scene, Path(folder) / "jar.glb")), *others]
            ef.export(samples, out / "open", kind="app", overwrite=True, progress=None)
        runpy.run_path(str(docs.parent / "packaging/addon.py"))["pack"](out / "eigenfield-blender.zip")


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", show_captures)
    app.connect("build-finished", write_pages)
    return {"parallel_read_safe": True}
