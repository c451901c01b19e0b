"""`eigenfield info`: the content of a scene file."""

from __future__ import annotations

import json
import textwrap
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.clip_facts import clip_facts, clip_lines, film_plane_facts, film_sheet_facts
from eigenfield.cli.common import PATH, common_options, echo_json, first_names

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from eigenfield.gltf.layout import Surroundings
    from eigenfield.gltf.layout_planes import PlaneLayout
    from eigenfield.gltf.layout_sheets import SheetsLayout

LINE_MAX_CHARACTERS = 100  # of settings and scores, which are free in a file
AXES_TEXT = (
    "cameras are world-to-camera with x right, y down, z forward; lengths are in the capture's own unit; "
    "the proxy's node turns its axes to glTF's (Y up, the array looking along -Z)"
)


@click.command(
    epilog="""\b
Examples:
  eigenfield info scene.glb
  eigenfield info clip.glb
  eigenfield info --json scene.glb"""
)
@click.argument("file", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="Everything, as JSON: cameras, settings, scores.")
@common_options
def command(file: Path, as_json: bool, quiet: bool) -> None:
    """Show what the FILE of a scene or a clip holds: bytes by part, cameras, textures, settings and scores."""
    from eigenfield.gltf import stores_clip

    facts = _clip_facts(file) if stores_clip(file) else _scene_facts(file)
    if as_json:
        echo_json({"file": str(file), **facts})
        return
    total = facts["bytes"]["total"]
    click.echo(f"{file}: {total:,} bytes, format {facts['format']}, by {json.dumps(facts['generator'])}")
    for line in text_lines(facts):
        click.echo(line)


def _scene_facts(file: Path) -> dict[str, Any]:
    from eigenfield.gltf import describe

    layout, parts = describe(file)
    sheets = None if layout.sheets is None else _sheet_facts(layout.sheets)
    return _facts(layout, parts, [_plane_facts(plane) for plane in layout.planes or ()], sheets)


def _clip_facts(file: Path) -> dict[str, Any]:
    from eigenfield.gltf import describe_clip

    layout, heads, parts = describe_clip(file)
    assert layout.films is not None
    planes = [film_plane_facts(plane) for plane in layout.films.planes]
    facts = _facts(layout, parts, planes, film_sheet_facts(layout))
    return {**facts, "clip": clip_facts(layout, heads)}


def _facts(
    layout: Surroundings, parts: dict[str, int], planes: list[dict[str, Any]], sheets: dict[str, Any] | None
) -> dict[str, Any]:
    mesh, cameras, plane = layout.mesh, layout.cameras, layout.view_plane
    assert mesh is not None and cameras is not None and plane is not None and layout.reference is not None
    held_out = [name for name, held in zip(cameras.names, cameras.held_out, strict=True) if held]
    sizes = Counter((camera.width, camera.height) for camera in cameras.cameras)
    return {
        "format": layout.version,
        "generator": layout.generator,
        "bytes": parts,
        "textures": max((basis["textures"] for entry in planes for basis in entry["bases"]), default=0),
        "planes": planes,
        "proxy": {"vertices": len(mesh.vertices), "triangles": len(mesh.faces), "sheets": sheets},
        "cameras": {
            "count": len(cameras.names),
            "encoded": cameras.encoded,
            "held_out": held_out,
            "reference": cameras.names[layout.reference],
            "harmonised": _colour_facts(cameras.colours, cameras.mixed_colours),
            "sizes": [{"size": list(size), "count": count} for size, count in sizes.most_common()],
        },
        "view_plane": {
            "width": 2 * float(plane.extent[0]),
            "height": 2 * float(plane.extent[1]),
            "origin": plane.origin.tolist(),
            "right": plane.right.tolist(),
            "up": plane.up.tolist(),
        },
        "axes": AXES_TEXT,
        "rights": layout.rights.said,
        "settings": layout.settings,
        "scores": layout.scores,
    }


def _colour_facts(colours: NDArray[np.float32] | None, mixed: bool) -> dict[str, Any] | None:
    """Smallest and largest gain and offset of R, G and B, and whether views between cameras have a mixture of them;
    None where the scene is not harmonised."""
    if colours is None:
        return None
    low, high = colours.min(axis=0).tolist(), colours.max(axis=0).tolist()
    return {"between": "mixed" if mixed else "common"} | {
        name: {channel: [low[i][c], high[i][c]] for c, channel in enumerate("RGB")}
        for i, name in enumerate(("gain", "offset"))
    }


def _sheet_facts(sheets: SheetsLayout) -> dict[str, Any]:
    opacity = sheets.opacity
    return {
        "triangles": list(sheets.faces),
        "opacity": {"size": [opacity.width, opacity.height], "type": opacity.mime},
    }


def _plane_facts(plane: PlaneLayout) -> dict[str, Any]:
    mean = plane.mean
    return {
        "channels": mean.channels,
        "mean": {"size": [mean.width, mean.height], "type": mean.mime},
        "bases": [
            {
                "textures": basis.count,
                "size": list(basis.size),
                "types": sorted({texture.mime for texture in basis.textures}),
            }
            for basis in plane.bases
        ],
    }


def text_lines(facts: dict[str, Any]) -> list[str]:
    """At most 20 lines of what a file holds; `--json` has all of it."""
    total = facts["bytes"]["total"]
    shares = ((name, count) for name, count in facts["bytes"].items() if count and name != "total")
    lines = [f"bytes         {', '.join(f'{name} {count:,} ({count / total:.0%})' for name, count in shares)}"]
    lines += clip_lines(facts["clip"]) if "clip" in facts else []
    lines += [f"rights        {_short(facts['rights'])}"] if facts["rights"] else []
    cameras, proxy = facts["cameras"], facts["proxy"]
    sizes = [f"{entry['count']} of {_size(entry['size'])}" for entry in cameras["sizes"]]
    lines.append(
        f"cameras       {first_names(sizes, 4)}; {cameras['encoded']} encoded, {len(cameras['held_out'])} held out"
    )
    if cameras["held_out"]:
        lines.append(f"held out      {first_names(cameras['held_out'], 4)}")
    lines.append(f"reference     {cameras['reference']}, where the first view is drawn")
    plane = facts["view_plane"]
    shape = f"{plane['width']:.4g} x {plane['height']:.4g}" if plane["height"] else f"a line of {plane['width']:.4g}"
    lines.append(f"view plane    {shape} about {_vector(plane['origin'])}; X right and Y up, each from -1 to 1")
    lines.append("axes          cameras look along z, with x right and y down; lengths are in the capture's unit")
    lines.append(f"mesh          {proxy['vertices']:,} vertices, {proxy['triangles']:,} triangles")
    if proxy["sheets"] is not None:
        triangles, opacity = proxy["sheets"]["triangles"], proxy["sheets"]["opacity"]
        lines.append(f"sheets        {len(triangles)} of {min(triangles):,} to {max(triangles):,} triangles; "
                     f"opacity {_size(opacity['size'])}, {opacity['type']}")  # fmt: skip
    lines += [_plane_line(plane) for plane in facts["planes"][:3]]
    if cameras["harmonised"]:
        gains = [gain for bounds in cameras["harmonised"]["gain"].values() for gain in bounds]
        common = cameras["harmonised"]["between"] == "common"
        between = "their common exposure" if common else "the exposures around it"
        lines.append(
            f"exposures     gains of {min(gains):.3f} to {max(gains):.3f}; a view between cameras has {between}"
        )
    settings = textwrap.wrap(_leaves(facts["settings"]), LINE_MAX_CHARACTERS, max_lines=2, placeholder=" …")
    lines += [f"{title:14}{line}" for title, line in zip(("settings", ""), settings, strict=False)]
    return lines + _score_lines(facts["scores"])


def _plane_line(plane: dict[str, Any]) -> str:
    """The textures of a plane; what it is for follows from its channels."""
    mean, bases = plane["mean"], plane["bases"]
    name = {1: "luma", 2: "chroma"}.get(plane["channels"], "colour")
    counts = [f"{basis['textures']} of {_size(basis['size'])}" for basis in bases]
    eigen = f"; eigen textures: {first_names(counts, 4)}" if counts else ""
    types = sorted({mean["type"], *(kind for basis in bases for kind in basis["types"])})
    return f"{name:14}mean {_size(mean['size'])}{eigen}; {', '.join(types)}"


def _score_lines(scores: dict[str, Any]) -> list[str]:
    """Known figures among the scores, which a file may hold in any form."""
    image, lines = scores.get("image"), []
    views = image if isinstance(image, dict) else {}
    for title, figures in (
        ("captured", views.get("encoded")),
        ("held out", views.get("held_out")),
        ("texture maps", scores.get("uv")),
    ):
        if isinstance(figures, dict):
            known = {name: figures[name] for name in ("psnr", "psnr_luma", "ssim", "cameras") if name in figures}
            lines.append(f"{title:14}{_short(known)}")
    if isinstance(scores.get("between"), dict):
        lines.append(f"between       {_short(scores['between'])}")
    return lines or ["scores        none: `eigenfield evaluate SCENE CAPTURE --store` measures them"]


def _short(value: dict[str, Any]) -> str:
    return textwrap.shorten(_leaves(value), LINE_MAX_CHARACTERS, placeholder=" …")


def _size(size: list[int]) -> str:
    return f"{size[0]}x{size[1]}"


def _vector(numbers: list[float]) -> str:
    return "(" + ", ".join(f"{number:.4g}" for number in numbers) + ")"


def _leaves(value: dict[str, Any], below: str = "") -> str:
    """The values of a JSON object, two levels deep, in a line; strings stay quoted, for they come from a file."""
    leaves = []
    for key, entry in value.items():
        name = below + json.dumps(key)[1:-1]
        if not isinstance(entry, dict):
            leaves.append(f"{name} {entry:.4g}" if isinstance(entry, float) else f"{name} {json.dumps(entry)}")
        elif entry and not below:
            leaves.append(_leaves(entry, f"{name}."))
    return ", ".join(leaves) or "none"
