"""A page for guests: title, picture and a few buttons, with a poster beside it for those who show a link to it."""

from __future__ import annotations

import html
import io
from dataclasses import replace
from pathlib import Path
from urllib.parse import quote, urljoin

from PIL import Image

from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene
from eigenfield.rendering import RenderJob, at_resolution, viewpoint
from eigenfield.runtime.files import atomic_files, refuse_existing
from eigenfield.viewer.page import Plain, page_title, single_file

POSTER_MAX_WIDTH_PX = 1200  # what those who show links recommend
POSTER_QUALITY = 85
GROUND = (21 / 255, 23 / 255, 26 / 255)  # of the page
FRAME_WIDTH_PX = 640  # of the snippet


def plain_files(output: Path) -> list[Path]:
    """Poster and page.

    Args:
        output: The .html.
    """
    return [output.with_suffix(".jpg"), output]


def refuse_plain(output: Path, overwrite: bool) -> None:
    """Before any work: check that page and poster may be written.

    Args:
        output: The .html.
        overwrite: Whether existing files may be replaced.

    Raises:
        OutputError: One of them may not or cannot be written.
    """
    for path in plain_files(output):
        refuse_existing(path, overwrite)


def write_plain_page(
    scene: Scene,
    output: Path,
    *,
    title: str | None = None,
    metres_per_unit: float | None = None,
    at: tuple[float, float] | None = None,
    url: str | None = None,
    overwrite: bool = False,
) -> str:
    """Write NAME.html, whose panel and tools are one click away, and NAME.jpg, its poster; both or none.

    The page holds its poster too. The file is for crawlers, which follow addresses only and run no scripts.

    Args:
        scene: The scene.
        output: The .html.
        title: Of the page. Default: `page_title`.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        at: The first view, on the view plane. Default: the reference camera's.
        url: Where the page will be. Default: its name, which most crawlers do not follow.
        overwrite: Whether existing files are replaced.

    Returns:
        The HTML that shows the page within another one.

    Raises:
        OptionError: `not-a-picture`; `viewpoint`: `at` is outside the array.
        OutputError: `viewer-build`; a file cannot be written.
    """
    title = page_title(output) if title is None else title
    camera, weights = viewpoint(scene, at=at)
    width = min(camera.width, POSTER_MAX_WIDTH_PX)
    size = (width, max(1, round(width * camera.height / camera.width)))
    drawn = io.BytesIO()
    pixels = RenderJob(scene, background=GROUND).rgb(at_resolution(camera, size), weights)
    Image.fromarray(pixels).save(drawn, "JPEG", quality=POSTER_QUALITY, optimize=True)
    poster = drawn.getvalue()
    targets = plain_files(output)
    address = quote(output.name) if url is None else url
    tags = {
        "og:type": "website",
        "og:title": title,
        **({} if url is None else {"og:url": url}),
        "og:image": urljoin(address, quote(targets[0].name)),
        "og:image:type": "image/jpeg",
        "og:image:width": str(size[0]),
        "og:image:height": str(size[1]),
        "twitter:card": "summary_large_image",
    }
    glb = encode_scene(replace(scene, residual=None))
    plain = Plain(poster, tags)
    page = single_file(glb, title=title, metres_per_unit=metres_per_unit, start=at, plain=plain)
    with atomic_files(targets, overwrite=overwrite) as (picture, document):
        picture.write_bytes(poster)
        document.write_bytes(page)
    height = round(FRAME_WIDTH_PX * size[1] / size[0])
    return (
        f'<iframe src="{html.escape(address)}" title="{html.escape(title)}" width="{FRAME_WIDTH_PX}" height="{height}" '
        'style="border: 0" allow="fullscreen; xr-spatial-tracking; gyroscope; accelerometer"></iframe>'
    )
