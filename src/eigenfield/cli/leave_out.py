"""`--leave-out`: photographs that take no part."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import click

from eigenfield.cli.common import first_names, note
from eigenfield.core.camera_names import named_cameras
from eigenfield.core.errors import OptionError, one_line

if TYPE_CHECKING:
    from eigenfield.capture import Footage, LightField, PhotoSet

    C = TypeVar("C", LightField, PhotoSet, LightField | PhotoSet)

ADVISED = "advised"
LEAVE_OUT_MIN_LEFT = 3  # photographs
LEAVE_OUT_MAX_LOOKED_AT = 60  # photographs of a capture whose harmful ones are named without being asked

leave_out_option = click.option(
    "--leave-out",
    "without",
    metavar="NAMES",
    help="Photographs to leave out: names with commas, or advised (those `inspect` calls harmful).",
)


def leave_out(capture: C, rule: str | None, quiet: bool) -> C:
    """The capture without some photographs; without a rule, a line says which ones may do harm.

    Args:
        rule: Names, `advised`, or None.

    Raises:
        OptionError: `leave-out`: no photograph has the name, or fewer than three are left.
    """
    from eigenfield.calibration.harm import advise

    names = capture.names
    if rule is None:
        if not quiet and len(names) <= LEAVE_OUT_MAX_LOOKED_AT:
            found = advise(capture)
            if found:
                first = f"{one_line(names[found[0].index])} {found[0].reason}"
                more = f"; so do {len(found) - 1} more" if len(found) > 1 else ""
                note(f"a photograph may do harm: {first}{more}; --leave-out {ADVISED} leaves out what `inspect` names")
        return capture
    if rule == ADVISED:
        found = advise(capture)
        out = {harm.index for harm in found}
        for harm in found:
            note(f"left out: {one_line(names[harm.index])} {harm.reason}", quiet)
        if not found:
            note("no photograph does harm: none is left out", quiet)
    else:
        out = set(named_cameras(rule, names, "leave-out"))
        note(f"left out: {first_names([one_line(names[index]) for index in sorted(out)], 5)}", quiet)
    kept = [index for index in range(len(names)) if index not in out]
    if len(kept) < LEAVE_OUT_MIN_LEFT:
        raise OptionError(
            "leave-out", f"{len(kept)} photographs would be left", remedy=f"leave at least {LEAVE_OUT_MIN_LEFT}"
        )
    return capture.subset(kept) if out else capture


def leave_out_cameras(footage: Footage, rule: str | None, quiet: bool) -> Footage:
    """Footage without some cameras, by what its first instant shows; as `leave_out`."""
    if rule is None:
        return footage
    kept = leave_out(footage.instant(0), rule, quiet).names
    return footage.subset(index for index, name in enumerate(footage.names) if name in kept)
