"""`eigenfield inspect`: the content of a capture, and its problems."""

from __future__ import annotations

import contextlib
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.capture_options import capture_argument, capture_options
from eigenfield.cli.common import PATH, common_options, echo_json, note
from eigenfield.cli.inspect_lines import report_lines
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.shell import shell_word

if TYPE_CHECKING:
    from eigenfield.calibration import NeighbourPair
    from eigenfield.capture import Capture, GridLayout, LightField, PhotoSet
    from eigenfield.capture.lightfield import View
    from eigenfield.capture.survey import CameraArray
    from eigenfield.core.mesh import Mesh

SCHEMA = "eigenfield.inspect/1"
SIZES_MAX_SPREAD = 0.02  # of the greatest, up to which sizes differ by what a program cut off
MORE_PHOTOGRAPHS = "take photographs nearer to each other"
MORE_VIEWS = {
    "walk": "ask for more --walk-frames, or walk more slowly", "video": "put more cameras there",
    "quilt": "draw more views into the quilt",
}  # fmt: skip


@click.command(
    "inspect",
    epilog="""\b
Examples:
  eigenfield inspect capture/
  eigenfield inspect photos/ --calibration refined.json --json
  eigenfield inspect frames/ --grid 17x17
  eigenfield inspect videos/ --frame 2.5s
  eigenfield inspect videos/ --clip 1s:3s
  eigenfield inspect capture/ --proxy mesh.ply --overlay overlay.png""",
)
@capture_argument()
@capture_options
@click.option("--proxy", type=PATH, metavar="MESH", help="A mesh in the cameras' world, to check against them.")
@click.option(
    "--overlay",
    type=PATH,
    metavar="PNG",
    help="Draw the mesh's outline over the photographs at the array's corners and centre.",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing overlay.")
@click.option(
    "--json", "as_json", is_flag=True, help="Print JSON; `eigenfield help capture-formats` says what is in it."
)
@common_options
def command(
    capture: Path,
    place: OpenOptions,
    proxy: Path | None,
    overlay: Path | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Say what CAPTURE holds, what is wrong with it, and what to run next.

    Every photograph is decoded once, so that all damaged ones are listed together. The exit code is 0 where
    `eigenfield encode` would run (with --proxy: with this mesh), and 2 where it would end at once.
    """
    if overlay is not None and proxy is None:
        raise OptionError(
            "overlay-needs-proxy", "--overlay draws a mesh over the photographs", remedy="name it with --proxy"
        )
    if overlay is not None:
        from eigenfield.runtime.files import refuse_existing

        refuse_existing(overlay, overwrite)

    from eigenfield.calibration import measure_neighbours
    from eigenfield.calibration.harm import find_harmful, look_at
    from eigenfield.capture import Footage, open_path
    from eigenfield.capture.clip_range import parse_clip, parse_offsets
    from eigenfield.capture.survey import decode_all
    from eigenfield.cli.inspect_footage import describe_footage

    found = open_path(capture, place, strict=False)
    footage = found if isinstance(found, Footage) else None
    opened = replace(found.instant(0), problems=found.problems) if isinstance(found, Footage) else found
    if proxy is not None and opened.light_field is None:
        raise OptionError(
            "proxy-needs-cameras",
            "--proxy is drawn by the capture's cameras, and it has none",
            remedy=f"run `eigenfield calibrate {shell_word(capture)}` first",
        )
    mesh = None
    if proxy is not None and opened.light_field is not None:
        from eigenfield.proxy import read_mesh

        mesh = read_mesh(proxy, opened.light_field.origin)
    with progress_bars(quiet) as progress:
        damaged, looks = decode_all(opened, look_at, progress)
        broken = {error.path for error in damaged}
        sound = [i for i, one in enumerate(opened.sources) if not broken & {str(one.path), str(one.mask)}]
        pairs = measure_neighbours(opened, sound, progress)
        harms = find_harmful(opened, looks, progress)
        filmed = None if footage is None else describe_footage(footage, parse_clip(place.clip or ":").step, progress)
    if footage is not None:  # frames that are held or damaged are counted there, and masked out
        masks = {str(one.mask) for one in opened.sources}
        damaged = [error for error in damaged if error.code != "mask-black" or error.path in masks]
    refusal = _refusal(capture, place, opened, damaged, proxy)
    report = describe(opened, damaged, 3 if footage is None else 2)
    if not place.also and capture.exists() and not _lies_in(opened.root, capture):  # unpacked into another folder
        report["root"] = str(capture)
    if footage is not None:
        report |= {"footage": filmed, "bytes": footage.bytes}
    report["refused"] = None if refusal is None else _error(refusal)
    report["harmful"] = [
        {"photograph": opened.names[harm.index], "kind": harm.kind, "reason": harm.reason} for harm in harms
    ]
    report["blurred"] = [opened.names[harm.index] for harm in harms if harm.kind == "blurred"]
    report["next"] = _next_commands(report, capture, place, proxy)
    if pairs:
        report["neighbours"] = _neighbours(opened, pairs)
        report["verdict"] = _verdict(opened, report["neighbours"])
    if mesh is not None and opened.light_field is not None:
        report["proxy"] = _proxy(mesh, opened, damaged, overlay, overwrite)
        from eigenfield.proxy.placement import describe_placement

        seen = opened.light_field.subset(sound)
        report["problems"] += describe_placement(mesh, seen.cameras, seen, seen.origin, proxy) if sound else []
        if overlay is not None:
            note(f"overlay written to {overlay}", quiet)
    if as_json:
        echo_json(report)
    else:
        click.echo("\n".join(report_lines(report, parse_offsets(place.offset))))
    if refusal is not None:
        click.get_current_context().exit(2)


def _refusal(
    capture: Path, place: OpenOptions, opened: Capture, damaged: Sequence[CaptureError], proxy: Path | None
) -> CaptureError | None:
    """The error with which `encode` would end before any long work; None where it would run."""
    from eigenfield.capture import open_path
    from eigenfield.capture.survey import refuse_one_place

    try:
        if opened.problems or len(opened) < 3:
            open_path(capture, place)
        if proxy is None:
            refuse_one_place(opened)
    except CaptureError as error:
        return error
    return damaged[0] if damaged else None


def _lies_in(root: Path, capture: Path) -> bool:
    return root.resolve().is_relative_to((capture if capture.is_dir() else capture.parent).resolve())


def _error(error: CaptureError) -> dict[str, Any]:
    return {"file": error.path, "code": error.code, "message": error.message, "remedy": error.remedy}


def describe(capture: Capture, damaged: list[CaptureError], fewest: int = 3) -> dict[str, Any]:
    """The report, as `--json` prints it; `docs/capture-formats.md` documents the keys.

    Args:
        fewest: Photographs that are enough.
    """
    import numpy as np

    from eigenfield.capture.messages import Note, count_phrase
    from eigenfield.capture.survey import file_kinds, in_one_place, measure_array

    views = () if capture.light_field is None else capture.light_field.views
    sizes = Counter(capture.sizes)
    notes = [str(line) for line in capture.problems if isinstance(line, Note)]
    problems = [line for line in capture.problems if not isinstance(line, Note)]
    if len(sizes) > 1:
        low, high = np.min(list(sizes), axis=0), np.max(list(sizes), axis=0)
        alike = bool(((high - low) <= SIZES_MAX_SPREAD * high).all())
        (notes if alike else problems).append(f"the photographs have {len(sizes)} different sizes")
    notes += _credit_notes(capture)
    if len(capture) < fewest:
        bare = count_phrase(capture.sources, "photograph is", "photographs are")
        what = f"{len(views)} photographs with a camera are" if capture.light_field is not None else bare
        problems.append(f"{what} too few, at least {fewest} are needed")
    array = measure_array([view.camera for view in views]) if len(views) >= 3 else None
    if array is not None and capture.light_field is not None and in_one_place(capture.light_field):
        problems.append("all cameras stand in one place")
    return {
        "schema": SCHEMA,
        "root": str(capture.root),
        "format": capture.format,
        "views": len(views),
        "bytes": sum(capture.bytes(i) for i in range(len(capture))),
        "sizes": [{"width": w, "height": h, "views": n} for (w, h), n in sizes.most_common()],
        "files": [{"format": f, "depth": d, "alpha": a, "views": n} for f, d, a, n in file_kinds(capture)],
        "distorted": sum(source.lens is not None for source in capture.sources),
        "masks": sum(source.mask is not None for source in capture.sources),
        "array": None if array is None else _array(array),
        "notes": notes,
        "problems": problems + [str(error) for error in damaged],
        "damaged": [{"file": error.path, "code": error.code, "message": error.message} for error in damaged],
        "origin": [0.0, 0.0, 0.0] if capture.light_field is None else capture.light_field.origin.tolist(),
        "cameras": [_camera(view) for view in views],
        "proxy": None,
        "layout": None if capture.layout is None else _layout(capture.layout),
        "photographs": [] if capture.light_field is not None else _photographs(capture),
        "refused": None,
        "next": [],
        "blurred": [],
        "harmful": [],
        "neighbours": None,
        "verdict": None,
        "footage": None,
    }


def _credit_notes(capture: Capture) -> list[str]:
    """A line that offers what the first photograph says of its author and rights, which no file gets unasked."""
    from eigenfield.capture.photographs.exif import read_credit
    from eigenfield.capture.photographs.read import read_header
    from eigenfield.core.rights import fault_of

    said: tuple[str | None, str | None] = (None, None)
    if capture.sources:
        path = capture.sources[0].path
        with contextlib.suppress(CaptureError, OSError):
            said = read_credit(path, read_header(path))
    words = [
        f"{option} {shlex.quote(text)}"
        for option, text in zip(("--author", "--licence"), said, strict=True)
        if text is not None and fault_of(text) is None
    ]
    return [f"the photographs say whose they are: encode {' '.join(words)} would keep it"] if words else []


def _neighbours(capture: Capture, pairs: Sequence[NeighbourPair]) -> dict[str, Any]:
    from statistics import median

    from eigenfield.calibration.neighbours import NEIGHBOUR_MAX_PARALLAX_RATIO

    widest = max(pairs, key=lambda pair: pair.parallax)
    return {
        "pairs": len(pairs),
        "parallax": median(pair.parallax for pair in pairs),
        "parallax_limit": NEIGHBOUR_MAX_PARALLAX_RATIO * _side(capture),
        "widest": {
            "photographs": [capture.names[widest.first], capture.names[widest.second]],
            "parallax": widest.parallax,
        },
        "overlap": min(pair.overlap for pair in pairs),
        "exposure": max(abs(pair.stops) for pair in pairs),
    }


def _side(capture: Capture) -> float:
    """The longer side of a photograph, in pixels."""
    from statistics import median

    return float(median(max(size) for size in capture.sizes))


def _verdict(capture: Capture, neighbours: Mapping[str, Any]) -> dict[str, str]:
    """What the photographs promise, as the report says it."""
    from eigenfield.encoding.verdict import verdict_beforehand

    more, names = MORE_VIEWS.get(capture.format, MORE_PHOTOGRAPHS), " and ".join(neighbours["widest"]["photographs"])
    found = verdict_beforehand(
        neighbours["parallax"] / _side(capture), neighbours["overlap"], f"{more}, first between {names}"
    )
    return {"word": found.word, "says": str(found)}


def _layout(layout: GridLayout) -> dict[str, Any]:
    rows, columns = layout.shape
    return {
        "rows": rows,
        "columns": columns,
        "missing": [list(node) for node in layout.missing_nodes],
        "measured": layout.measured,
        "signs": layout.signs,
        "rectified": layout.rectified,
        "exact": layout.exact,
        "focal": layout.focal,
    }


def _photographs(photo_set: PhotoSet) -> list[dict[str, Any]]:
    layout = photo_set.layout
    return [
        {
            "name": shot.name,
            "file": str(shot.path),
            "width": shot.width,
            "height": shot.height,
            "focal": shot.focal,
            "mask": None if shot.mask is None else str(shot.mask),
            "node": None if layout is None else [int(layout.rows[index]), int(layout.columns[index])],
            "position": None if layout is None else layout.positions[index].tolist(),
        }
        for index, shot in enumerate(photo_set.shots)
    ]


def _next_commands(report: dict[str, Any], capture: Path, place: OpenOptions, proxy: Path | None) -> list[str]:
    """Commands that make sense now, with the options that this one had, most useful first."""
    if report["refused"] is not None:
        return []
    pairs = {"grid": place.grid, "quilt": place.quilt}
    shapes = {name: None if pair is None else "x".join(map(str, pair)) for name, pair in pairs.items()}
    given: dict[str, Any] = {**vars(replace(place, also=None)), **shapes, "strict": None, "proxy": proxy}
    said = [
        f"--{name.replace('_', '-')} {shell_word(value) if isinstance(value, Path) else shlex.quote(str(value))}"
        for name, values in given.items()
        for value in (values if isinstance(values, tuple) else (values,))
        if value is not None
    ]
    folders = [capture, *map(Path, place.also or ())]
    words = " ".join([*(shell_word(folder) for folder in folders), *said])
    advised = " --leave-out advised" if report["harmful"] else ""
    if place.clip is not None:
        from eigenfield.cli.inspect_footage import clip_commands

        return clip_commands(words + advised, words, report["views"], proxy is not None)
    encode = f"eigenfield encode {words}{advised} -o scene.glb"
    return [encode] if report["views"] or place.also else [encode, f"eigenfield calibrate {words}"]


def _array(array: CameraArray) -> dict[str, Any]:
    width, height = (2 * array.plane.extent).tolist()
    return {
        "width": width,
        "height": height,
        "thickness": array.thickness,
        "spacing": array.spacing,
        "line": array.plane.is_line,
        "grid": None if array.grid is None else {"rows": array.grid.rows, "columns": array.grid.columns},
        "origin": array.plane.origin.tolist(),
        "right": array.plane.right.tolist(),
        "up": array.plane.up.tolist(),
        "focus": None if array.focus is None else array.focus.tolist(),
        "distance": array.distance,
        "cone": array.cone,
    }


def _camera(view: View) -> dict[str, Any]:
    K = view.camera.K
    return {
        "name": view.name,
        "file": str(view.path),
        "width": view.camera.width,
        "height": view.camera.height,
        "focal": [float(K[0, 0]), float(K[1, 1])],
        "principal": [float(K[0, 2]), float(K[1, 2])],
        "centre": view.camera.centre.tolist(),
        "forward": view.camera.R[2].tolist(),
        "lens": None if view.lens is None else {"model": view.lens.model, "coefficients": list(view.lens.coefficients)},
        "mask": None if view.mask is None else str(view.mask),
    }


def _proxy(
    mesh: Mesh, light_field: LightField, damaged: list[CaptureError], overlay: Path | None, overwrite: bool
) -> dict[str, Any]:
    from eigenfield.capture.overlay import draw_overlay
    from eigenfield.capture.survey import corners_and_centre
    from eigenfield.runtime.files import write_bytes

    bad = {error.path for error in damaged}
    sound = [i for i, view in enumerate(light_field.views) if not bad & {str(view.path), str(view.mask)}]
    chosen = [sound[i] for i in corners_and_centre([light_field.views[i].camera for i in sound])] if sound else []
    coverage: list[float] = []
    if chosen:
        picture, coverage = draw_overlay(light_field, mesh, chosen)
        if overlay is not None:
            write_bytes(overlay, picture, overwrite=overwrite)
    return {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.faces),
        "uv": mesh.uv is not None,
        "low": mesh.vertices.min(axis=0).tolist(),
        "high": mesh.vertices.max(axis=0).tolist(),
        "coverage": {light_field.views[i].name: part for i, part in zip(chosen, coverage, strict=True)},
    }
