"""A folder for a web server: a page that opens files and sends nothing, installable, and there without a network.

It is the page that `eigenfield view` serves. A service worker keeps what was fetched, for times without a network.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.viewer.exports.folder import atomic_folder, write_file, write_listing
from eigenfield.viewer.exports.guests import PICTURE_CHANNELS, draw_poster
from eigenfield.viewer.exports.names import file_names
from eigenfield.viewer.page import page_html, static_file

APP_FILES = ("viewer.js", "viewer.css", "worker.js", "icon.svg", "icon-192.png", "icon-512.png")
THUMBNAIL_WIDTH_PX = 400  # shown half as wide
APP_COLOUR = "#15171a"  # the page's ground
APP_POLICY = (  # `?load=` and `?poster=` may name any host; web/viewer/src/confine.ts narrows it before a scene is read
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src * blob: data:; media-src blob:; "
    "connect-src * blob: data:; manifest-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'"
)
APP_HEAD = (
    '<link rel="icon" href="icon.svg">\n<link rel="apple-touch-icon" href="icon-192.png">\n'
    f'<link rel="manifest" href="manifest.webmanifest">\n<meta name="theme-color" content="{APP_COLOUR}">\n'
    f'<meta http-equiv="Content-Security-Policy" content="{APP_POLICY}">'
)


@dataclass(frozen=True)
class Sample:
    """A scene that the page offers.

    Attributes:
        picture: A JPEG of what it shows; None where it makes no picture.
    """

    name: str
    glb: bytes
    picture: bytes | None


def draw_thumbnail(scene: Scene) -> bytes | None:
    """What a sample shows, as a small JPEG; None for channels that make no picture."""
    if scene.appearance.channels not in PICTURE_CHANNELS:
        return None
    return draw_poster(scene, THUMBNAIL_WIDTH_PX)[0]


def write_app(
    samples: Sequence[Sample],
    folder: Path,
    *,
    title: str | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write index.html and what belongs to it, and each sample as samples/NAME.glb with its picture, NAME.jpg.

    Args:
        title: Of the page. Default: "eigenfield".

    Raises:
        OutputError: `viewer-build`; the folder cannot be written.
    """
    names = [sample.name for sample in samples]
    stems = [f"samples/{path.removesuffix('.png')}" for path in file_names(names)]
    offered = [
        {"name": sample.name, "url": quote(f"{stem}.glb"), "bytes": len(sample.glb)}
        | ({} if sample.picture is None else {"picture": quote(f"{stem}.jpg")})
        for sample, stem in zip(samples, stems, strict=True)
    ]
    config: dict[str, Any] = {"samples": offered, "worker": "worker.js", "version": __version__}
    if title is not None:
        config["title"] = title
    page = page_html(config, APP_HEAD)
    with atomic_folder(folder, overwrite) as part:
        for name in APP_FILES:
            write_file(part / name, static_file(name))
        write_file(part / "index.html", page)
        write_file(part / "manifest.webmanifest", _manifest(title or "eigenfield"))
        for stem, sample in zip(stems, track(samples, "samples", len(samples), progress), strict=True):
            write_file(part / f"{stem}.glb", sample.glb)
            if sample.picture is not None:
                write_file(part / f"{stem}.jpg", sample.picture)
        write_listing(part, "app", {"samples": {name: f"{stem}.glb" for name, stem in zip(names, stems, strict=True)}})


def _manifest(name: str) -> bytes:
    """What a browser needs to install the page, and to open .glb files with it."""
    icons = [{"src": "icon.svg", "sizes": "any", "type": "image/svg+xml", "purpose": "any maskable"}]
    for side in (192, 512):
        icon = {"src": f"icon-{side}.png", "sizes": f"{side}x{side}", "type": "image/png", "purpose": "any maskable"}
        icons.append(icon)
    document = {
        "name": name,
        "short_name": name,
        "id": "./",
        "start_url": "./",
        "scope": "./",
        "display": "standalone",
        "background_color": APP_COLOUR,
        "theme_color": APP_COLOUR,
        "icons": icons,
        "file_handlers": [{"action": "./", "accept": {"model/gltf-binary": [".glb"]}}],
    }
    return json.dumps(document, indent=1, ensure_ascii=False).encode("utf-8", "replace")
