"""Look around in a scene: the page in a browser, its server, one file with all of it, a frame in a notebook.

    with Server(make_manifest(glb, "scene.glb")) as server:
        webbrowser.open(server.address)

The page itself is TypeScript, in web/; its build lies in static/.
"""

from __future__ import annotations

from eigenfield.viewer.manifest import Content, Manifest, make_manifest
from eigenfield.viewer.notebook import scene_html
from eigenfield.viewer.page import page_html, single_file
from eigenfield.viewer.photographs import Photographs
from eigenfield.viewer.server import Server
from eigenfield.viewer.view import view

__all__ = [
    "Content", "Manifest", "Photographs", "Server", "make_manifest", "page_html", "scene_html", "single_file", "view",
]  # fmt: skip
