"""A page for guests: picture, title and a few buttons, with a poster beside it for those who show a link to it."""

from __future__ import annotations

import html
import io
import os
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import quote, urljoin

from PIL import Image

from eigenfield.core.errors import OptionError
from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene
from eigenfield.rendering import RenderJob, at_resolution, viewpoint
from eigenfield.runtime.files import atomic_files
from eigenfield.viewer.page import SAID_MAX_CHARACTERS, Beside, Guests, page_title, single_file

POSTER_MAX_WIDTH_PX = 1200  # what those who show links recommend
POSTER_QUALITY = 85
GROUND = (21 / 255, 23 / 255, 26 / 255)  # of the page
PICTURE_CHANNELS = (1, 3)
FRAME_WIDTH_PX = 640  # of the snippet


def draw_poster(scene: Scene, max_width: int, at: tuple[float, float] | None = None) -> tuple[bytes, tuple[int, int]]:
    """A view of a scene as a JPEG, and its width and height.

    Args:
        max_width: In pixels; no wider than the reference camera's photograph.
        at: On the view plane. Default: the reference camera's.

    Raises:
        OptionError: `not-a-picture`; `viewpoint`: `at` is outside the array.
    """
    camera, weights = viewpoint(scene, at=at)
    width = min(camera.width, max_width)
    size = (width, max(1, round(width * camera.height / camera.width)))
    drawn = io.BytesIO()
    pixels = RenderJob(scene, background=GROUND).rgb(at_resolution(camera, size), weights)
    Image.fromarray(pixels).save(drawn, "JPEG", quality=POSTER_QUALITY, optimize=True)
    return drawn.getvalue(), size


def guests_files(output: Path) -> list[Path]:
    """Poster and page."""
    return [output.with_suffix(".jpg"), output]


def write_guests_page(
    scene: Scene,
    output: Path,
    *,
    title: str | None = None,
    metres_per_unit: float | None = None,
    at: tuple[float, float] | None = None,
    url: str | None = None,
    glb: bytes | None = None,
    no_download: bool = False,
    beside: Beside | None = None,
    overwrite: bool = False,
) -> str:
    """Write NAME.html, which shows the scene and has neither panel nor tools, and NAME.jpg, its poster; both or none.

    The page holds its poster too. The file is for crawlers, which follow addresses only and run no scripts.

    Args:
        title: Of the page. Default: the scene's own, or else `page_title`.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        at: The first view, on the view plane. Default: the reference camera's.
        url: Where the page will be, for links to it. Default: its name, which most crawlers do not follow.
        glb: The file that the page holds, of a clip whose first frame the scene is. Default: the scene's own.
        no_download: Whether the page does not offer the scene as a file.
        beside: A second scene.

    Returns:
        The HTML that shows the page within another one.

    Raises:
        OptionError: `not-a-picture`; `viewpoint`: `at` is outside the array.
        OutputError: `viewer-build`; a file cannot be written.
    """
    title = (scene.rights.title or page_title(output)) if title is None else title
    channels = scene.appearance.channels
    if channels not in PICTURE_CHANNELS:
        raise OptionError(
            "not-a-picture",
            f"the scene has {channels} channels, which make no picture for guests",
            remedy="say --laboratory, for a page that shows them",
        )
    poster, size = draw_poster(scene, POSTER_MAX_WIDTH_PX, at)
    targets = guests_files(output)
    address = quote(os.fsencode(output.name)) if url is None else url
    tags = {
        "og:type": "website",
        "og:title": title,
        **({} if url is None else {"og:url": url}),
        "og:image": urljoin(address, quote(os.fsencode(targets[0].name))),
        "og:image:type": "image/jpeg",
        "og:image:width": str(size[0]),
        "og:image:height": str(size[1]),
        "twitter:card": "summary_large_image",
    }
    glb = encode_scene(replace(scene, residual=None)) if glb is None else glb
    guests = Guests(poster, tags, url)
    how: dict[str, Any] = {"metres_per_unit": metres_per_unit, "start": at, "no_download": no_download}
    page = single_file(glb, title=title, guests=guests, beside=beside, **how)
    with atomic_files(targets, overwrite=overwrite) as (picture, document):
        picture.write_bytes(poster)
        document.write_bytes(page)
    height = round(FRAME_WIDTH_PX * size[1] / size[0])
    said = html.escape(title[:SAID_MAX_CHARACTERS])
    return (
        f'<iframe src="{html.escape(address)}" title="{said}" width="{FRAME_WIDTH_PX}" height="{height}" '
        'style="border: 0" allow="fullscreen; xr-spatial-tracking; gyroscope; accelerometer"></iframe>'
    )
