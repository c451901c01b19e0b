"""Photographs for the examples: a small array of the scene that `eigenfield demo` draws, in place of your own."""

from __future__ import annotations

import sys
from pathlib import Path

import eigenfield as ef
from eigenfield.demo import draw_demo_capture


def folder() -> Path:
    """Where an example reads and writes: what its command line names, else ./example."""
    place = Path(sys.argv[1] if len(sys.argv) > 1 else "example")
    place.mkdir(exist_ok=True)
    return place


def capture(place: Path, name: str = "capture", columns: int = 3) -> Path:
    """PLACE/NAME with images/, transforms.json and the exact proxy.ply, drawn where it is not there."""
    if not (place / name).exists():
        draw_demo_capture(place / name, rows=3, columns=columns, size=96)
    return place / name


def scene(place: Path) -> Path:
    """PLACE/scene.glb, encoded where it is not there."""
    path = place / "scene.glb"
    if not path.exists():
        photographs = capture(place)
        ef.encode(photographs, photographs / "proxy.ply", preset="small").save(path)
    return path
