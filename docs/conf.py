"""The site: `make docs` builds it into build/docs, with warnings as errors."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

from eigenfield.core.version import __version__

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "eigenfield"
copyright = "the eigenfield authors"
release = version = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "commands",
    "pages_elsewhere",
    "scene_page",
    "for_programs",
]
exclude_patterns = ["_ext", "_templates"]
templates_path = ["_templates"]

myst_enable_extensions = ["attrs_inline", "deflist"]
myst_heading_anchors = 3

default_role = "literal"  # names between single backticks in docstrings
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
maximum_signature_line_length = 90
napoleon_numpy_docstring = False

html_theme = "furo"
html_title = "eigenfield"
html_sidebars = {  # the theme's own, and a way to the page that opens files
    "**": [
        *(f"sidebar/{part}.html" for part in ("brand", "search", "scroll-start", "open", "navigation", "scroll-end")),
        "sidebar/variant-selector.html",
    ]
}
html_favicon = "_static/icon.svg"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"


def signature_to_show(
    app: Sphinx, what: str, name: str, found: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str, str | None] | None:
    """A class is shown without its arguments, which are its attributes and listed one a line below it. A function that
    is a default is shown by its name."""
    if what == "class":
        return "", None
    return None if signature is None else (re.sub(r"<function (\w+)>", r"\1", signature), returned)


def setup(app: Sphinx) -> None:
    app.connect("autodoc-process-signature", signature_to_show)
