"""What the sections of the page draw from: the results, the pictures beside them, and where each figure is from."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evidence.markup import (
    Html,
    anchor,
    dig,
    duration,
    element,
    escape,
    finite,
    join,
    link,
    listing,
    number,
    paragraph,
    percent,
)

KINDS = {".webp": "image/webp", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".avif": "image/avif"}

GEOMETRY = "geometry"  # the step that makes cameras and proxy where they are missing

Tree = dict[str, Any]
Draw = Callable[["Source", str, Tree], Any]


@dataclass(frozen=True)
class Source:
    """results: what results.json holds. folder: where paths of pictures begin."""

    results: Tree
    folder: Path

    @property
    def captures(self) -> dict[str, Tree]:
        found = dig(self.results, "captures")
        return {str(k): v for k, v in found.items() if isinstance(v, dict)} if isinstance(found, dict) else {}

    def record(self, name: str, step: str) -> Tree:
        """What the runner kept of a step: empty where it was not run. `geometry` comes before the others' steps."""
        capture = self.captures.get(name)
        found = dig(capture, "geometry") if step == GEOMETRY else dig(capture, "steps", step)
        return found if isinstance(found, dict) else {}

    def steps(self, name: str) -> list[str]:
        """The steps that were tried, in order."""
        steps = dig(self.captures.get(name), "steps")
        return [step for step in (GEOMETRY, *(steps if isinstance(steps, dict) else ())) if self.record(name, step)]

    def figures(self, name: str, step: str) -> Tree | None:
        """The figures of a step of a capture; None where it was not run or failed."""
        found = self.record(name, step).get("figures")
        return found if isinstance(found, dict) and self.problem(name, step) is None else None

    def problem(self, name: str, step: str) -> str | None:
        """Why a step has no figures, where it was tried: in its own words."""
        record = self.record(name, step)
        for where in (record, record.get("figures")):
            if dig(where, "error") is not None:
                return str(dig(where, "error"))
        return None

    def title(self, name: str) -> str:
        return str(dig(self.captures.get(name), "title") or name)


def moment(value: Any) -> str:
    """2025-11-21T22:00:00Z as 2025-11-21 22:00."""
    return re.sub(r"^(\d{4}-\d\d-\d\d)[T ](\d\d:\d\d).*", r"\1 \2", str(value))


def by_capture(source: Source, section: str, step: str, draw: Draw) -> Html:
    """One part a capture that has the step: heading, what `draw` makes of it, where it is from. Failed steps are shown
    with their words; captures without the step are named in a line."""
    parts, without = [], []
    for name in source.captures:
        figures, problem = source.figures(name, step), source.problem(name, step)
        if figures is None and problem is None:
            without.append(name)
            continue
        heading = element("h3", source.title(name), id=anchor(section, name))
        body = failure(f"This step ended with an error: {problem}")
        if figures is not None:
            try:
                body = join([draw(source, name, figures)])
            except Exception as error:  # one odd figure must not cost the page of a run of hours
                body = failure(f"These figures could not be shown ({type(error).__name__}: {error})")
        parts.append(element("article", heading, body, origin(source, name, step)))
    if without:
        parts.append(paragraph(f"Not measured in this run: {', '.join(without)}.", kind="missing"))
    return join(parts)


def failure(words: str) -> Html:
    return paragraph(words, kind="error")


def origin(source: Source, name: str, step: str) -> Html:
    """Commit, date, seconds and command of a step."""
    of = source.record(name, step)
    words = [
        f"commit {of['commit']}" if of.get("commit") else None,
        moment(of["date"]) if of.get("date") else None,
        join(["took ", duration(of["seconds"])]) if of.get("seconds") is not None else None,
        element("code", of["command"]) if of.get("command") else None,
    ]
    known = [word for word in words if word]
    return paragraph(join(known, " · "), kind="origin") if known else Html("")


def picture(source: Source, path: Any, words: Any, alt: str) -> Html:
    """A picture within the page, with words below. Only files below the report's folder are read."""
    if not isinstance(path, str) or not path:
        return Html("")
    address = _embedded(source.folder, path)
    if address is None:
        shown = paragraph(f"picture missing: {path}", kind="missing picture")
    else:
        shown = Html(f'<img src="{address}" alt="{escape(alt)}" loading="lazy" decoding="async">')
    return element("figure", shown, element("figcaption", words))


def _embedded(folder: Path, path: str) -> str | None:
    """The file as a data: address; None for what is no picture in the folder."""
    kind = KINDS.get(Path(path).suffix.lower())
    if kind is None or not path.isprintable():
        return None
    place = (folder / path).resolve()
    if not place.is_relative_to(folder.resolve()) or not place.is_file():
        return None
    return f"data:{kind};base64,{base64.b64encode(place.read_bytes()).decode('ascii')}"


def gallery(*pictures: Html, large: bool = False) -> Html:
    shown = [p for p in pictures if p]
    return element("div", *shown, class_="pictures large" if large else "pictures") if shown else Html("")


def capture_link(source: Source, section: str, step: str, name: str) -> Html:
    """The capture's name, leading to its part of a section where it has one."""
    there = source.figures(name, step) is not None or source.problem(name, step) is not None
    return link(anchor(section, name), name) if there else escape(name)


# -- what several sections ask of the figures -------------------------------------------------------------------------


def worst(figures: Any, key: str, digits: int) -> Html | None:
    """The worst camera's value and name."""
    one = dig(figures, "worst", key)
    if not isinstance(one, dict):
        return None
    return join([number(one.get("value"), digits), " ", element("span", one.get("camera"), class_="sub")])


def scene_bytes(source: Source, name: str) -> Any:
    return dig(source.figures(name, "scene"), "bytes", "total")


def held_out(scene: Tree | None) -> Tree | None:
    """Figures over held-out cameras."""
    found = dig(scene, "held_scene", "held_out")
    return found if isinstance(found, dict) else None


def is_headline_peer(name: str) -> bool:
    """SVT-AV1 at preset 2: the peer that the headline names."""
    return re.search(r"av1[- ](preset[- ])?2\b", name.lower()) is not None


def label_of(curve: Tree) -> str:
    """What a person calls a curve or a method."""
    return str(curve.get("title") or curve.get("name") or "?")


def peer_rates(source: Source, name: str) -> dict[str, Tree]:
    """BD-rates of ours relative to each peer: its label to {"psnr", "psnr_luma"} in percent."""
    rates = source.figures(name, "rates")
    found = dig(rates, "bd")
    if not isinstance(found, dict):
        return {}
    labels = {str(curve.get("name")): label_of(curve) for curve in listing(rates, "curves")}
    return {labels.get(str(key), str(key)): value for key, value in found.items() if isinstance(value, dict)}


def shaded(value: Any) -> Html:
    """A BD-rate, shaded where the peer needs fewer bytes."""
    known = finite(value)
    words = percent(value, 0, sign=True)
    return element("span", words, class_="behind") if known is not None and known > 0 else words


def headline_rate(source: Source, name: str, key: str) -> Any:
    """BD-rate against SVT-AV1 preset 2."""
    return next((v.get(key) for peer, v in peer_rates(source, name).items() if is_headline_peer(peer)), None)
