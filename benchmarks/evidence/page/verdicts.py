"""In plain sentences, made from the figures alone: where a peer is better, where ours needs fewer bytes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from evidence.markup import Html, duration, element, finite, items, join, listing, number, percent
from evidence.page.source import Source, Tree, label_of, peer_rates

VIEW_WEIGHTS = ("nearest3", "delaunay", "bilinear")
MANY = 4  # captures named one by one
MEASURES = {"psnr": "RGB", "psnr_luma": "luma"}


def verdicts(source: Source) -> Html:
    behind = [*_fewer_bytes(source, ours=False), *_quicker_peers(source), *_better_between(source)]
    ahead = _fewer_bytes(source, ours=True)
    parts = []
    if behind:
        parts += [element("h3", "Where a peer is better", id="peers-better"), items(behind)]
    if ahead:
        parts += [element("h3", "Where ours needs fewer bytes", id="ours-better"), items(ahead)]
    return join(parts)


def _fewer_bytes(source: Source, ours: bool) -> list[Html]:
    """A line for each peer that needs fewer bytes than ours somewhere; the other way round for ours."""
    rates: dict[str, dict[str, Tree]] = {}
    for name in source.captures:
        for peer, values in peer_rates(source, name).items():
            rates.setdefault(peer, {})[name] = values
    lines = []
    for peer, captures in rates.items():
        parts = [part for key in MEASURES if (part := _verdict(source, peer, captures, key, ours))]
        if parts:
            who = join(["than ", element("strong", peer)] if ours else [element("strong", peer), " needs fewer bytes"])
            lines.append(join([who, " ", join(parts, "; "), "."]))
    return lines


def _verdict(source: Source, peer: str, captures: dict[str, Tree], key: str, ours: bool) -> Html:
    """What one measure says: BD-rates, and where there is none because one curve lies wholly above the other."""
    known = {name: value for name, rates in captures.items() if (value := finite(rates.get(key))) is not None}
    if ours:
        fewer = {name: b for name, b in known.items() if b < 0}
    else:  # ours needs (100 + b) % of the peer's bytes: the peer needs 100 / (100 + b) of ours
        fewer = {name: -100 * b / (100 + b) for name, b in known.items() if b > 0}
    parts = [join([f"at equal {MEASURES[key]} PSNR ", _on(fewer, len(known))])] if fewer else []
    outright = []
    for name in captures:
        if name not in known and (found := _outright(source, name, peer, key, ours)) is not None:
            gain, change = found
            words = [number(gain, 1, sign=True, unit=" dB"), ", ", percent(change, 0, sign=True), " bytes"]
            outright.append((name, join(words)))
    if outright:
        parts.append(join([f"for a higher {MEASURES[key]} PSNR than the best of the other's, on ", _list(outright)]))
    return join(parts, " and ")


def _outright(source: Source, name: str, peer: str, key: str, ours: bool) -> tuple[float, float] | None:
    """Where one side has a point that beats the other's best in quality and in bytes: by how many dB, and by how many
    percent of bytes, of the smallest such point."""
    curves = listing(source.figures(name, "rates"), "curves")
    mine = [p for c in curves if c.get("kind") == "ours" for p in _points(c, key)]
    theirs = [p for c in curves if c.get("kind") != "ours" and label_of(c) == peer for p in _points(c, key)]
    winner, loser = (mine, theirs) if ours else (theirs, mine)
    if not winner or not loser:
        return None
    size, best = max(loser, key=lambda point: point[1])
    beating = [point for point in winner if point[1] > best and point[0] < size]
    if not beating:
        return None
    smallest = min(beating)
    return smallest[1] - best, 100 * (smallest[0] / size - 1)


def _points(curve: Tree, key: str) -> list[tuple[float, float]]:
    """(bytes, quality) of the points that have both."""
    found = ((finite(point.get("bytes")), finite(point.get(key))) for point in listing(curve, "points"))
    return [(size, value) for size, value in found if size and value is not None]


def _list(found: Iterable[tuple[str, Html]]) -> Html:
    """tarot (−35 %), fern (−10 %)."""
    return join((join([name, " (", words, ")"]) for name, words in found), ", ")


def _on(changes: dict[str, float], measured: int) -> Html:
    """On which captures something needs fewer bytes, by how many percent; ends of the range where it is all of many."""
    if len(changes) == measured > MANY:
        ends = [percent(value, 0, sign=True) for value in (max(changes.values()), min(changes.values()))]
        return join([f"on all {measured} comparable captures (", join(ends, " to "), ")"])
    of_all = f"on {len(changes)} of {measured} comparable captures: " if measured > 1 else "on "
    return join([of_all, _list((name, percent(value, 0, sign=True)) for name, value in changes.items())])


def _quicker_peers(source: Source) -> list[Html]:
    """Peers that hand out one view from a cold file sooner than ours."""
    quicker: dict[str, list[tuple[str, Html]]] = {}
    for name in source.captures:
        curves = listing(source.figures(name, "rates"), "curves")
        ours = [t for c in curves if c.get("kind") == "ours" for t in access(c)]
        for curve in curves if ours else ():
            theirs = access(curve)
            if curve.get("kind") != "ours" and theirs and max(theirs) < min(ours):
                words = join([duration(max(theirs)), " against ", duration(min(ours))])
                quicker.setdefault(label_of(curve), []).append((name, words))
    said = " shows one view from a cold file sooner, at every rate measured, on "
    return [join([element("strong", peer), said, _list(found), "."]) for peer, found in quicker.items()]


def access(curve: Tree, places: Sequence[str] = ("middle", "first")) -> list[float]:
    """Seconds to the first view that is asked for, one in the middle of the array, of the points that say so."""
    found = []
    for point in listing(curve, "points"):
        value: Any = point.get("access_seconds")
        if isinstance(value, dict):
            value = next((value[place] for place in places if value.get(place) is not None), None)
        if finite(value) is not None:
            found.append(float(value))
    return found


def is_ours(method: Tree) -> bool:
    """Whether a way to draw a view is our scene: by its key, one of the view weights, or by what it is called."""
    name = label_of(method).lower()
    return method.get("key") in VIEW_WEIGHTS or name.startswith("our") or "eigenfield" in name


def _better_between(source: Source) -> list[Html]:
    """Other ways that come closer to held-out photographs than ours does."""
    better: dict[str, list[tuple[str, Html]]] = {}
    for name in source.captures:
        methods = listing(source.figures(name, "between"), "methods")
        ours = max((v for m in methods if is_ours(m) and (v := finite(m.get("psnr"))) is not None), default=None)
        for method in methods:
            value = finite(method.get("psnr"))
            if ours is not None and value is not None and value > ours and not is_ours(method):
                words = number(value - ours, 2, sign=True, unit=" dB")
                better.setdefault(label_of(method), []).append((name, words))
    said = " comes closer to held-out photographs (RGB PSNR) than ours with the best of its view weights, on "
    return [join([element("strong", method), said, _list(found), "."]) for method, found in better.items()]
