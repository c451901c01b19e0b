"""The report of `eigenfield inspect` as lines for people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eigenfield.cli.inspect_footage import clip_needs, footage_lines
from eigenfield.core.errors import EigenfieldError, one_line

NEIGHBOUR_MAX_STOPS = 0.3  # of exposure


def report_lines(report: dict[str, Any], offsets: Mapping[str, int] | None = None) -> list[str]:
    """The report as lines for people.

    Args:
        offsets: Of the cameras of footage, as they were given.
    """
    sizes = ", ".join(f"{s['width']}x{s['height']} ({s['views']})" for s in report["sizes"])
    files = ", ".join(
        f"{f['format']} {f['depth']} bit{' with alpha' if f['alpha'] else ''} ({f['views']})" for f in report["files"]
    )
    bare = len(report["photographs"])
    bent = (
        "distortion is taken out of {distorted} of {views} views" if report["distorted"] else "no distortion is stated"
    )
    lenses = f"  lenses     {bent.format(**report)}"
    what = f"{bare} photographs without cameras" if bare else f"{report['views']} views"
    lines = [
        f"{report['root']}: {what} from {report['format']}",
        f"  sizes      {sizes or 'none'}",
        f"  files      {files or 'none'}, {report['bytes']:,} bytes",
        f"  focal      {_focal_text(report['photographs'])}" if bare else lenses,
        f"  masks      {report['masks']} files",
    ]
    if report["footage"] is not None:
        lines += footage_lines(report["footage"], offsets or {})
    if report["layout"] is not None:
        lines += _layout_lines(report["layout"], bare > 0)
    if report["array"] is not None:
        lines += _array_lines(report["array"])
    if report["neighbours"] is not None:
        lines += _neighbour_lines(report["neighbours"], report["footage"] is not None)
    lines += [f"  harmful    {one_line(one['photograph'])} {one['reason']}" for one in report["harmful"]]
    if report["harmful"]:
        lines.append("             take them again, or leave them out: encode --leave-out advised")
    if report["proxy"] is not None:
        lines += _proxy_lines(report["proxy"])
    lines += [f"  note       {note}" for note in report["notes"]]
    lines.append(f"  problems   {len(report['problems']) or 'none'}")
    lines += [f"    - {problem}" for problem in report["problems"]]
    if report["verdict"] is not None:
        lines.append(f"  verdict    {report['verdict']['says']}")
    runs = "would run" if report["footage"] is None else clip_needs(report["views"], report["proxy"] is not None)
    lines.append(f"  encode     {runs if report['refused'] is None else _refusal_text(report['refused'])}")
    return lines + [f"  next       {command}" for command in report["next"]]


def _refusal_text(refused: dict[str, Any]) -> str:
    error = EigenfieldError(refused["code"], refused["message"], path=refused["file"], remedy=refused["remedy"])
    return f"is refused: {error}"


def _focal_text(photographs: list[dict[str, Any]]) -> str:
    known = [shot["focal"] for shot in photographs if shot["focal"] is not None]
    if not known:
        return "not known: no EXIF says it, nor do the names"
    low, high = min(known), max(known)
    pixels = f"{low:.0f}" if high - low < 0.5 else f"{low:.0f} to {high:.0f}"
    return f"{pixels} pixels, known of {len(known)} of {len(photographs)} photographs"


def _layout_lines(layout: dict[str, Any], bare: bool) -> list[str]:
    positions = "positions measured" if layout["measured"] else "positions not measured"
    if layout["exact"]:
        positions = "positions exact"
    lines = [f"  layout     grid of {layout['rows']} rows x {layout['columns']} columns by name, {positions}"]
    if layout["missing"]:
        lines.append(f"  missing    {len(layout['missing'])} nodes of the grid have no photograph")
    if bare and not layout["signs"]:
        lines.append("  direction  not said by the names: the photographs must tell which way rows and columns run")
    return lines


def _array_lines(array: dict[str, Any]) -> list[str]:
    grid = array["grid"]
    shape = "cameras on a line" if array["line"] else "no regular grid"
    if grid is not None:
        shape = f"grid of {grid['rows']} rows x {grid['columns']} columns"
    width, height, thickness = array["width"], array["height"], array["thickness"]
    lines = [
        f"  array      {shape}",
        f"  extent     {width:.4g} x {height:.4g} world units, up to {thickness:.3g} off its plane",
        f"  baseline   {array['spacing']:.4g} to the nearest camera (median)",
    ]
    if array["focus"] is None:
        return [*lines, "  cone       none: the cameras look in parallel or apart"]
    place = ", ".join(f"{v:.4g}" for v in array["focus"])
    return [*lines, f"  cone       {array['cone']:.1f} degrees about ({place}), {array['distance']:.4g} away"]


def _neighbour_lines(neighbours: dict[str, Any], clip: bool) -> list[str]:
    from eigenfield.calibration.neighbours import NEIGHBOUR_MAX_PARALLAX_RATIO
    from eigenfield.encoding.verdict import MIN_OVERLAP

    parallax, limit, widest = neighbours["parallax"], neighbours["parallax_limit"], neighbours["widest"]
    names = " and ".join(widest["photographs"])
    part = NEIGHBOUR_MAX_PARALLAX_RATIO * parallax / limit
    lines = [f"  parallax   neighbours are {parallax:.3g} px apart (median), {part:.1%} of the longer side"]
    if widest["parallax"] > limit:
        lines.append(f"             widest: {widest['parallax']:.3g} px, between {names}")
    overlap, stops = neighbours["overlap"], neighbours["exposure"]
    shared = "" if overlap >= MIN_OVERLAP else ": too little, take them nearer to each other"
    lines.append(f"  overlap    neighbours show at least {overlap:.0%} of the same{shared}")
    drift = "" if stops <= NEIGHBOUR_MAX_STOPS else ": fix the exposure"
    if drift and not clip:
        drift += "; `encode` takes out a gain and an offset"
    lines.append(f"  exposure   neighbours differ by at most {stops:.2f} stops{drift}")
    return lines


def _proxy_lines(proxy: dict[str, Any]) -> list[str]:
    low, high = (", ".join(f"{v:.4g}" for v in proxy[key]) for key in ("low", "high"))
    uv = "with UVs" if proxy["uv"] else "no UVs"
    lines = [
        f"  proxy      {proxy['vertices']} vertices, {proxy['triangles']} triangles, {uv}",
        f"  box        ({low}) to ({high})",
    ]
    parts = ", ".join(f"{name} {part:.0%}" for name, part in proxy["coverage"].items())
    if not any(proxy["coverage"].values()):
        return [*lines, "  coverage   none: no view looked at sees the proxy; is it in the cameras' frame?"]
    return [*lines, f"  coverage   {parts}"]
