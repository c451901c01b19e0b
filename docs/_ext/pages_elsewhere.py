"""Pages whose text lies outside docs/, and links that lead there."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

TEXTS = {
    "reference/changes": "CHANGELOG.md",
    "reference/three": "web/eigenfield-three/README.md",
    "reference/security": "SECURITY.md",
}
PAGES = {f"../{file}": f"/{page}.md" for page, file in TEXTS.items()} | {"../README.md": "/index.md"}
LINK = re.compile(r"\]\((?!https?:|/|#)([^)#\s]+)")


def show(app: Sphinx, name: str, source: list[str]) -> None:
    """Put the text of a file in place of its page, and lead links to pages of the site."""
    root = Path(app.srcdir).parent
    file = TEXTS.get(name, f"docs/{name}.md")
    if name in TEXTS:
        app.env.note_dependency(root / file)
        source[0] = (root / file).read_text("utf-8")

    def lead(match: re.Match[str]) -> str:
        target = posixpath.relpath(posixpath.join(posixpath.dirname(file), match[1]), "docs")
        elsewhere = PAGES.get(target)
        if elsewhere is None and name in TEXTS:
            elsewhere = f"/{target}"
        return match[0] if elsewhere is None else f"]({elsewhere}"

    source[0] = LINK.sub(lead, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", show)
    return {"parallel_read_safe": True}
