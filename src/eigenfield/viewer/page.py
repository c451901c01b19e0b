"""The viewer's page: as the server gives it, and as one file with everything in it."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import os
import re
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from eigenfield.core.errors import OutputError
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.gltf import encode_scene
from eigenfield.rendering import viewpoint
from eigenfield.runtime.files import refuse_existing, write_bytes

STATIC_FOLDER = Path(__file__).parent / "static"  # what `npm run build` in web/ leaves here
SAID_MAX_CHARACTERS = 200  # of a title where a screen reader says it for a picture or a frame
TITLE_ELEMENT = "<title>eigenfield</title>"
NAMES_FOR_ANYTHING = ("scene", "index")  # of a page, which say nothing of what it shows
CONFIG_ELEMENT = '<script type="application/json" id="eigenfield-config">{}</script>'
ICON_ELEMENT = '<link rel="icon" href="data:,">'
SCRIPT_ELEMENT = re.compile(r'<script type="module"[^>]*\bsrc="(?:\./)?viewer\.js"[^>]*></script>')
STYLE_ELEMENT = re.compile(r'<link rel="stylesheet"[^>]*\bhref="(?:\./)?viewer\.css"[^>]*/?>')
# runs the viewer's script, which a page holds packed, in 0.4 times its bytes
UNPACKING_SCRIPT = """
const packed = atob(document.getElementById("eigenfield-viewer").textContent);
const bytes = Uint8Array.from(packed, (letter) => letter.charCodeAt(0));
const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
const script = document.createElement("script");
script.type = "module";
script.textContent = await new Response(unpacked).text();
document.body.append(script);
"""
HEAD_ELEMENT = re.compile(r"<head>\s*(?:<meta charset=[^>]*>)?", re.IGNORECASE)


def static_file(name: str) -> bytes:
    """A file of the built page.

    Raises:
        OutputError: `viewer-build`: it is missing.
    """
    try:
        return (STATIC_FOLDER / name).read_bytes()
    except FileNotFoundError as error:
        raise _not_built(name, "is missing") from error


def page_html(config: Mapping[str, Any], head: str = ICON_ELEMENT) -> bytes:
    """The page with its configuration, as a server gives it beside viewer.js and viewer.css.

    Args:
        config: JSON object, all keys optional: title, scene (URL), bytes, embedded, photographs (camera name to URL),
            metresPerUnit, version, start (X, Y), ui, url, samples (name, url, bytes, picture each), worker (URL), draft
            (URL that says when the whole scene comes), beside (names of both, scene (URL), bytes), download (whether
            the page offers its own scene as a file).
        head: Elements in place of the page's icon, which is none.

    Raises:
        OutputError: `viewer-build`.
    """
    page = _replace_once(_text("index.html"), re.compile(re.escape(ICON_ELEMENT)), lambda _: head)
    return _encode(_configure(page, config))


@dataclass(frozen=True)
class Guests:
    """What a page for guests has of its own.

    Attributes:
        poster: A JPEG of the first view, shown until the scene is there.
        tags: Names and contents of <meta property>, for those who show a link to the page.
        url: Where the page will be: links that it makes begin with that.
    """

    poster: bytes
    tags: Mapping[str, str]
    url: str | None = None


@dataclass(frozen=True)
class Beside:
    """A second scene, right of a divider, where the page's own is left of it.

    Attributes:
        names: Of both, for people.
        glb: The file of the second.
    """

    names: tuple[str, str]
    glb: bytes

    @staticmethod
    def of(scenes: Sequence[object], glb: bytes) -> Beside:
        """The second of two scenes."""
        first, second = shown_names(scenes, "AB")
        return Beside((first, second), glb)


def shown_names(scenes: Sequence[object], otherwise: Sequence[str]) -> list[str]:
    """Names of scenes for people: those of their files, with their folders where two files are called alike.

    Args:
        scenes: Paths, or values, which have no name.
        otherwise: Names of values.
    """
    paths = [
        Path(one) if isinstance(one, str | os.PathLike) else Path(name)
        for one, name in zip(scenes, otherwise, strict=True)
    ]
    stems = [path.stem for path in paths]
    return [
        stem if stems.count(stem) == 1 else f"{path.absolute().parent.name}/{stem}"
        for path, stem in zip(paths, stems, strict=True)
    ]


def single_file(
    glb: bytes,
    *,
    title: str,
    metres_per_unit: float | None = None,
    start: tuple[float, float] | None = None,
    guests: Guests | None = None,
    no_download: bool = False,
    beside: Beside | None = None,
) -> bytes:
    """The viewer and a scene as one page that needs nothing else, from file:// too; the same bytes for the same input.

    The page's own policy allows its script, what unpacks that, and its style, named by their hashes, and no connection
    to anywhere.

    Args:
        metres_per_unit: Metres in one unit of the capture, for headsets.
        start: The first view, on the view plane. Default: the reference camera's.
        guests: Of a page for guests. Default: a page with panel and tools.
        no_download: Whether the page does not offer the scene as a file.
        beside: A second scene.

    Raises:
        OutputError: `viewer-build`.
    """
    config: dict[str, Any] = {"title": title, "embedded": True, "bytes": len(glb), "version": __version__}
    if start is not None:
        config["start"] = list(start)
    if no_download:
        config["download"] = False
    if beside is not None:
        config["beside"] = {"names": beside.names, "bytes": len(beside.glb)}
    head = poster = ""
    if guests is not None:
        config["ui"] = "plain"
        if guests.url is not None:
            config["url"] = guests.url
        tags = guests.tags.items()
        head = "".join(f'\n<meta property="{name}" content="{html.escape(text)}">' for name, text in tags)
        picture = base64.b64encode(guests.poster).decode("ascii")
        said = html.escape(title[:SAID_MAX_CHARACTERS])
        poster = f'<img class="poster" alt="{said}" src="data:image/jpeg;base64,{picture}">'
    if metres_per_unit is not None:
        config["metresPerUnit"] = metres_per_unit
    script, style = _text("viewer.js"), _inline_style(_text("viewer.css"))
    policy = (
        f"default-src 'none'; script-src '{_hash(UNPACKING_SCRIPT)}' '{_hash(script)}'; "
        f"style-src '{_hash(style)}'; img-src blob: data:; media-src blob:; "
        "connect-src blob: data:; base-uri 'none'; form-action 'none'"
    )
    page = _text("index.html")
    page = _replace_once(page, STYLE_ELEMENT, lambda _: f"<style>{style}</style>")
    page = _replace_once(page, SCRIPT_ELEMENT, lambda _: "")  # it comes behind the poster, which else waits for it
    meta = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
    page = _replace_once(page, HEAD_ELEMENT, lambda found: f"{found}\n{meta}{head}")
    data = _inline_bytes(glb, "eigenfield-scene")
    data += "" if beside is None else _inline_bytes(beside.glb, "eigenfield-beside")
    data += _inline_bytes(zlib.compress(script.encode(), 9), "eigenfield-viewer")
    return _encode(_configure(page, config, f'{data}\n<script type="module">{UNPACKING_SCRIPT}</script>', poster))


def write_page(
    scene: Scene,
    output: Path,
    *,
    title: str | None = None,
    metres_per_unit: float | None = None,
    at: tuple[float, float] | None = None,
    glb: bytes | None = None,
    no_download: bool = False,
    beside: Beside | None = None,
    overwrite: bool = False,
) -> None:
    """Write a page that opens by double click and needs no network: viewer and scene in one file.

    The residual, which the viewer does not show, is left out. Payloads are not coded anew.

    Args:
        title: Of the page. Default: the scene's own, or else `page_title`.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        at: The first view, on the view plane. Default: the reference camera's.
        glb: The file that the page holds, of a clip whose first frame the scene is. Default: the scene's own.
        no_download: Whether the page does not offer the scene as a file.
        beside: A second scene.

    Raises:
        OptionError: `viewpoint`: `at` is outside the array.
        OutputError: `viewer-build`; the file cannot be written.
    """
    refuse_existing(output, overwrite)
    if at is not None:
        viewpoint(scene, at=at)  # refuses what is outside
    glb = encode_scene(replace(scene, residual=None)) if glb is None else glb
    title = (scene.rights.title or page_title(output)) if title is None else title
    how: dict[str, Any] = {"metres_per_unit": metres_per_unit, "start": at, "no_download": no_download}
    data = single_file(glb, title=title, beside=beside, **how)
    write_bytes(output, data, overwrite=overwrite)


def page_title(output: Path) -> str:
    """What a page is called where nobody says: its file's name, or that of its folder for scene.html and index.html."""
    name = output.stem
    if name.lower() in NAMES_FOR_ANYTHING:
        name = output.absolute().parent.name or name
    return name.replace("_", " ")


def _text(name: str) -> str:
    """A text of the build with the line ends of an HTML parser, which hashes what it reads."""
    return static_file(name).decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")


def _configure(page: str, config: Mapping[str, Any], more: str = "", first: str = "") -> str:
    """The page with its title and configuration; `first` before it, `more` behind it."""
    for mark in (TITLE_ELEMENT, CONFIG_ELEMENT):
        if page.count(mark) != 1:
            raise _not_built("index.html", f"has not exactly one {mark}")
    page = page.replace(TITLE_ELEMENT, f"<title>{html.escape(str(config.get('title', 'eigenfield')))}</title>")
    before, after = page.split(CONFIG_ELEMENT)  # not `replace`: nothing that came in is searched again
    return before + first + CONFIG_ELEMENT.replace("{}", json_for_html(config)) + more + after


def json_for_html(value: Any) -> str:
    """JSON in ASCII that ends no script element and begins no comment, whatever its strings hold."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _inline_bytes(data: bytes, name: str) -> str:
    text = base64.b64encode(data).decode("ascii")
    return f'<script type="application/octet-stream" id="{name}">{text}</script>'


def _inline_style(text: str) -> str:
    """CSS for a style element: what would end it is escaped."""
    return re.sub(r"</(?=style)", r"<\\/", text, flags=re.IGNORECASE)


def _replace_once(page: str, pattern: re.Pattern[str], text: Callable[[str], str]) -> str:
    """The page with the one place of `pattern` replaced by what `text` makes of it."""
    made, count = pattern.subn(lambda match: text(match[0]), page)
    if count != 1:
        raise _not_built("index.html", f"has {count} places of {pattern.pattern}")
    return made


def _hash(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")


def _encode(page: str) -> bytes:
    return page.encode("utf-8", "replace")  # a title from a file name may hold half a character


def _not_built(name: str, reason: str) -> OutputError:
    return OutputError(
        "viewer-build",
        f"the viewer's page {reason}",
        path=STATIC_FOLDER / name,
        remedy="build it with `npm ci && npm run build` in web/, or install a released package",
    )
