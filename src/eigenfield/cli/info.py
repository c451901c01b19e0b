"""`eigenfield info`: the content of a scene file."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import PATH, common_options, echo_json, first_names

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from eigenfield.gltf.layout import FileLayout
    from eigenfield.gltf.layout_planes import PlaneLayout
    from eigenfield.gltf.layout_sheets import SheetsLayout

AXES_TEXT = (
    "cameras are world-to-camera with x right, y down, z forward; lengths are in the capture's own unit; "
    "the proxy's node turns its axes to glTF's (Y up, the array looking along -Z)"
)


@click.command(
    epilog="""\b
Examples:
  eigenfield info scene.glb
  eigenfield info --json scene.glb"""
)
@click.argument("file", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="The same as JSON.")
@common_options
def command(file: Path, as_json: bool, quiet: bool) -> None:
    """Show what a scene FILE holds: bytes by part, textures, cameras, view plane, settings and scores."""
    from eigenfield.gltf import describe

    layout, parts = describe(file)
    facts = _facts(layout, parts)
    if as_json:
        echo_json({"file": str(file), **facts})
        return
    click.echo(f"{file}: {parts['total']:,} bytes, format {layout.version}, by {json.dumps(layout.generator)}")
    for line in _text_lines(facts):
        click.echo(line)


def _facts(layout: FileLayout, parts: dict[str, int]) -> dict[str, Any]:
    cameras, mesh, plane = layout.cameras, layout.mesh, layout.view_plane
    assert cameras is not None and mesh is not None and plane is not None and layout.reference is not None
    held_out = [name for name, held in zip(cameras.names, cameras.held_out, strict=True) if held]
    sizes = Counter((camera.width, camera.height) for camera in cameras.cameras)
    return {
        "format": layout.version,
        "generator": layout.generator,
        "bytes": parts,
        "textures": max((basis.count for plane in layout.planes or () for basis in plane.bases), default=0),
        "planes": [_plane_facts(entry) for entry in layout.planes or ()],
        "proxy": {
            "vertices": len(mesh.vertices),
            "triangles": len(mesh.faces),
            "sheets": None if layout.sheets is None else _sheet_facts(layout.sheets),
        },
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


def _text_lines(facts: dict[str, Any]) -> list[str]:
    total = facts["bytes"]["total"]
    lines = ["bytes"]
    for name, count in facts["bytes"].items():
        lines.append(f"  {name:10}{count:14,}{100 * count / total:8.1f} %")
    lines.append(f"eigen         {facts['textures']} textures of the basis that has most")
    for plane in facts["planes"]:
        mean = plane["mean"]
        channels = f"{plane['channels']} channel{'' if plane['channels'] == 1 else 's'}"
        lines.append(f"mean          {_size(mean['size'])}, {channels}, {mean['type']}")
        for basis in plane["bases"]:
            types = f", {', '.join(basis['types'])}" if basis["types"] else ""
            lines.append(f"basis         {basis['textures']} textures of {_size(basis['size'])}, {channels}{types}")
    proxy = facts["proxy"]
    lines.append(f"proxy         {proxy['vertices']:,} vertices, {proxy['triangles']:,} triangles")
    if proxy["sheets"] is not None:
        triangles, opacity = proxy["sheets"]["triangles"], proxy["sheets"]["opacity"]
        counts = ", ".join(f"{count:,}" for count in triangles)
        lines.append(f"sheets        {len(triangles)}, back to front of {counts} triangles; "
                     f"opacity {_size(opacity['size'])}, {opacity['type']}")  # fmt: skip
    cameras = facts["cameras"]
    sizes = ", ".join(f"{entry['count']} of {_size(entry['size'])}" for entry in cameras["sizes"])
    lines.append(f"cameras       {sizes}; {cameras['encoded']} encoded, {len(cameras['held_out'])} held out")
    if cameras["held_out"]:
        lines.append(f"held out      {first_names(cameras['held_out'], 8)}")
    if cameras["harmonised"]:
        lines.extend(
            f"{title:14}"
            + "; ".join(
                f"{channel} {low:.3f} to {high:.3f}" for channel, (low, high) in cameras["harmonised"][key].items()
            )
            for title, key in (("harmonised by", "gain"), ("  plus", "offset"))
        )
        common = cameras["harmonised"]["between"] == "common"
        lines.append(f"  between     {'the common exposure' if common else 'exposures mixed by the view weights'}")
    lines.append(f"reference     {cameras['reference']}")
    plane = facts["view_plane"]
    shape = f"{plane['width']:g} x {plane['height']:g}" if plane["height"] else f"a line of {plane['width']:g}"
    lines.append(f"view plane    {shape}; X from -1 to 1 to the right, Y from -1 to 1 upwards, as the cameras see it")
    lines.append(f"              0,0 at {_vector(plane['origin'])}, X along {_vector(plane['right'])}, "
                 f"Y along {_vector(plane['up'])}")  # fmt: skip
    lines.append(f"axes          {facts['axes']}")
    for name in ("settings", "scores"):
        lines.append(name if facts[name] else f"{name:14}none")
        lines.extend(_tree(facts[name], "  "))
    return lines


def _size(size: list[int]) -> str:
    return f"{size[0]}x{size[1]}"


def _vector(numbers: list[float]) -> str:
    return "(" + ", ".join(f"{number:.4g}" for number in numbers) + ")"


def _tree(value: dict[str, Any], indent: str) -> list[str]:
    """A JSON object as indented lines, an entry each; strings stay quoted, for they come from a file."""
    lines = []
    for key, entry in value.items():
        name = json.dumps(key)[1:-1]
        if isinstance(entry, dict):
            lines.append(f"{indent}{name}")
            lines.extend(_tree(entry, indent + "  "))
        else:
            lines.append(f"{indent}{name:{max(1, 26 - len(indent))}} {_leaf(entry)}")
    return lines


def _leaf(entry: Any) -> str:
    text = f"{entry:.6g}" if isinstance(entry, float) else json.dumps(entry)
    return text if len(text) <= 100 else text[:100] + "…"
