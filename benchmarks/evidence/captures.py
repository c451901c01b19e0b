"""The captures that are evaluated: where each lies, what it comes with, and which cameras are held out."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

STANFORD = "Stanford Light Field Archive, Stanford Computer Graphics Laboratory"
HCI = "HCI 4D Light Field Benchmark (Honauer et al., ACCV 2016), CC BY-NC-SA 4.0"


@dataclass(frozen=True)
class Capture:
    """One capture.

    folder: of the photographs; for `demo` it is drawn when it is not there. calibration, proxy: files that come with
    it; what is None is estimated (a folder may hold its own calibration). hold_out: rule of `encode --hold-out`; None:
    "odd" where the cameras stand on a grid, else "every:2". circles: file for the figures outside a circle.
    compression: whether figures of compression mean anything on it. studied: whether losses are switched off alone.
    """

    name: str
    title: str
    folder: Path
    calibration: Path | None = None
    proxy: Path | None = None
    hold_out: str | None = None
    circles: Path | None = None
    compression: bool = True
    studied: bool = False
    note: str = ""
    licence: str = ""


def known(out: Path) -> dict[str, Capture]:
    """The captures that have names, by those: the demo, kept in `out`, and what EIGENFIELD_DATA's folder holds."""
    data = os.environ.get("EIGENFIELD_DATA")
    return {"demo": demo(out)} | ({} if not data else shared(Path(data)))


def named(name: str, out: Path) -> Capture:
    """One of them, or a capture of the user's own by its folder. Raises SystemExit where there is neither."""
    found = known(out)
    if name in found:
        return found[name]
    if Path(name).is_dir():
        return of_folder(Path(name))
    raise SystemExit(
        f"{name} is neither a folder nor one of {', '.join(found)} (EIGENFIELD_DATA names the shared ones' folder)"
    )


def of_folder(folder: Path) -> Capture:
    """A capture of the user's own: cameras and proxy are estimated where the folder does not tell them."""
    return Capture(folder.resolve().name, folder.resolve().name, folder.resolve())


def demo(out: Path) -> Capture:
    """The capture that `eigenfield demo` draws, kept in the report's folder."""
    folder = out / "work" / "demo" / "capture"
    return Capture(
        "demo", "Demo (drawn)", folder, proxy=folder / "proxy.ply", hold_out="odd",
        note="Drawn by the project itself, on the exact mesh: what is lost here is not lost to geometry.",
    )  # fmt: skip


def shared(data: Path) -> dict[str, Capture]:
    """The shared captures that lie in `data`, by name."""
    tarot = data / "tarot_17x17_512"
    proxy = tarot / "calibration" / "proxy.ply"
    table = [
        Capture("tarot", "Tarot, 17x17", tarot, tarot / "calibration" / "refined.json", proxy, "odd",
                tarot / "ball.json", studied=True, licence=STANFORD,
                note="A scene of the paper, here at 512x512 (the archive's pictures are 1024x1024)."),
        Capture("tarot-5x4", "Tarot, 5x4", data / "tarot_5x4_1024",
                data / "tarot_5x4_1024" / "calibration" / "refined.json", proxy, "every:2", licence=STANFORD,
                note="20 of the 289 views at full size: as sparse as the paper's own rigs."),
        Capture("amethyst", "Amethyst, 17x17", data / "amethyst_17x17_512", hold_out="odd", compression=False,
                licence=STANFORD, note="A scene of the paper, but decoded from a video: no figures of compression."),
        Capture("jellybeans", "Jelly Beans, 17x17", data / "jellybeans_17x17_768x384", hold_out="odd",
                licence=STANFORD),
        Capture("boxes", "HCI Boxes, 9x9", data / "hci_boxes_9x9", hold_out="odd", licence=HCI),
        Capture("antinous", "HCI Antinous, 9x9", data / "hci_antinous_9x9", hold_out="odd", licence=HCI),
        Capture("shop", "Shop, 9x9", data / "shop_9x9", hold_out="odd", studied=True,
                licence="Scene by Alex Treviño after a concept by Anaïs Maamar; Linus Mossberg's rendering"),
        Capture("fern", "LLFF Fern", data / "llff_fern", hold_out="every:2", licence="Mildenhall et al., LLFF 2019"),
        Capture("cube", "Cube (phone)", data / "cube_colmap_mesh", proxy=data / "cube_colmap_mesh" / "proxy.obj",
                hold_out="every:2", licence="hypothete/unstructured-lumigraph, MIT",
                note="The mesh that comes with it has holes: coverage below 100 %."),
        Capture("fountain", "Fountain-P11", data / "fountain_P11_half", hold_out="every:2",
                licence="Strecha et al., CVPR 2008"),
        Capture("fox", "Fox", data / "fox_transforms_half", hold_out="every:2",
                licence="NVIDIA instant-ngp, non-commercial", note="A walk around, not a plane."),
        Capture("temple", "Temple, 16 of a ring", data / "temple_ring16", hold_out="every:2",
                licence="Seitz et al., Middlebury", note="12 to 42 degrees between neighbours."),
    ]  # fmt: skip
    return {one.name: one for one in table if one.folder.is_dir()}


QUICK = ("boxes", "cube")  # a dense array without a mesh, a few hand-held pictures with one
