"""Options of the verbs that draw pictures and videos."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from eigenfield.cli.common import pair_of_numbers, together
from eigenfield.core.errors import OptionError

if TYPE_CHECKING:
    from eigenfield.core.clip import Timeline

DEFAULT_FPS = "30"
TIME_TOLERANCE_FRAMES = 1e-6  # of seconds in decimals


@dataclass(frozen=True)
class ClipTime:
    """A time in a clip, or all times from one to another: seconds, or numbers of frames (int).

    Attributes:
        end: Behind the last one; None: to the end of the clip.
        several: Whether there is a range.
    """

    first: int | float
    end: int | float | None = None
    several: bool = False

    def in_clip(self, path: Path) -> float:
        """Seconds of the one time in the clip of a file. OptionError `time`: it has no such frame, or is of one
        instant; there is a range."""
        if self.several:
            remedy = "name one: --time 1.25s"
            raise OptionError("time", "one frame is drawn, and --time has a range", path=path, remedy=remedy)
        timeline = self._timeline(path)
        return self.first if isinstance(self.first, float) else float(timeline.times[self.first])

    def frames(self, path: Path) -> range:
        """Numbers of the frames of a range in the clip of a file. OptionError `time`, as `in_clip`; it is empty."""
        timeline = self._timeline(path)
        first = timeline.frame_at(self.first) if isinstance(self.first, float) else self.first
        if isinstance(self.end, float):  # the first frame that is shown at this time or later
            end = max(0, math.ceil((self.end - timeline.first) * timeline.rate - TIME_TOLERANCE_FRAMES))
        else:
            end = timeline.frames if self.end is None else self.end
        if not first < end <= timeline.frames:
            message = f"--time from frame {first} to {end} leaves nothing, or more than there is"
            remedy = f"name frames between 0 and {timeline.frames}"
            raise OptionError("time", message, path=path, remedy=remedy)
        return range(first, end)

    def _timeline(self, path: Path) -> Timeline:
        from eigenfield.gltf import load_clip, stores_clip

        if not stores_clip(path):
            remedy = "leave --time out"
            raise OptionError("time", "is a scene of one instant, and has no other time", path=path, remedy=remedy)
        timeline = load_clip(path).timeline
        if isinstance(self.first, int) and self.first >= timeline.frames:
            remedy = f"name one from 0 to {timeline.frames - 1}, or seconds as 1.25s"
            raise OptionError("time", f"the clip has no frame {self.first}", path=path, remedy=remedy)
        return timeline


def _number_of(text: str) -> int | float | None:
    """A number of a frame, or seconds; None for nothing. ValueError: neither."""
    found = re.fullmatch(r"(\d{1,9})|(-?(?:\d{1,9}\.?\d{0,9}|\.\d{1,9}))s", text)
    if text and found is None:
        raise ValueError(text)
    return None if found is None else int(found[1]) if found[1] else float(found[2])


def _parse_time(context: click.Context, parameter: click.Parameter, value: str | None) -> ClipTime | None:
    if value is None:
        return None
    first, colon, end = value.strip().partition(":")
    try:
        start, stop = _number_of(first), _number_of(end)
        if start is None and not colon:
            raise ValueError(value)
    except ValueError:
        raise click.BadParameter("seconds as 1.25s, the number of a frame: 37, or a range: 0s:2s") from None
    return ClipTime(0 if start is None else start, stop, bool(colon))


def parse_place(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, float] | None:
    """A click callback: view-plane coordinates, X,Y."""
    if value is None:
        return None
    try:
        x, y = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter("two numbers from -1 to 1 with a comma between them: 0.3,-0.2") from None
    return x, y


def _parse_baseline(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, bool] | None:
    """Fields of `rendering.stereo.Baseline`."""
    found = re.fullmatch(r"(\d{1,9}\.?\d{0,9}|\.\d{1,9}) *(mm|cm|m|)", (value or "").strip())
    if value is not None and found is None:
        raise click.BadParameter("a part of the array's width, as 0.2, or a length, as 63mm")
    return None if found is None else (float(found[1]) * {"mm": 1e-3, "cm": 1e-2}.get(found[2], 1.0), bool(found[2]))


def _parse_colour(context: click.Context, parameter: click.Parameter, value: str) -> tuple[float, ...] | None:
    if value == "transparent":
        return None
    if not re.fullmatch(r"#?[0-9a-fA-F]{6}", value):
        raise click.BadParameter("a colour as '#rrggbb', or transparent")
    digits = value.removeprefix("#")
    return tuple(int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))


def _parse_rate(context: click.Context, parameter: click.Parameter, value: str) -> Fraction:
    try:
        if not re.fullmatch(r"[^eE]{1,40}([eE][-+]?\d{1,2})?", value.strip()):  # 1e999999999 would be computed
            raise ValueError
        rate = Fraction(value).limit_denominator(1001)
    except (ValueError, ZeroDivisionError):
        raise click.BadParameter("pictures a second: 30, 24000/1001") from None
    if not 0 < rate <= 1000:
        raise click.BadParameter("more than 0 and at most 1000 pictures a second")
    return rate


picture_options = together(  # the fields of `RenderJob`
    click.option("--resolution", callback=pair_of_numbers("WIDTHxHEIGHT in pixels: 1024x768"), metavar="WxH",
                 help="Size in pixels.  [default: the camera's]"),
    click.option("--background", callback=_parse_colour, default="#000000", show_default=True, metavar="COLOUR",
                 help="'#rrggbb', or transparent, where the proxy does not reach."),
    click.option("--weights", default="delaunay", show_default=True, metavar="delaunay|nearest3|bilinear",
                 help="How cameras near the viewpoint are mixed."),
    click.option("--filter", default="bicubic", show_default=True, metavar="bicubic|bilinear", help="Texel filter."),
    click.option("--textures", "-n", type=int, metavar="N", help="Eigen textures to sum.  [default: all]"),
    click.option("--samples", type=int, metavar="K",
                 help="K x K samples a pixel.  [default: four at edges, more in small pictures]"),
    click.option("--renderer", default="software", show_default=True, metavar="software|opengl",
                 help="opengl: on the GPU, without a window; needs `pip install 'eigenfield[gpu]'`."),
)  # fmt: skip
flight_options = together(
    click.option("--path", metavar="circle|spiral|grid", help="A fly-through."),
    click.option("--frames", type=int, metavar="N", help="Pictures of a path.  [default: 120]"),
    click.option("--fps", callback=_parse_rate, default=DEFAULT_FPS, show_default=True, metavar="F",
                 help="Pictures a second."),
)  # fmt: skip
stereo_options = together(
    click.option("--stereo", metavar="side-by-side|top-bottom|vr180",
                 help="Two eyes in one picture, the left one left or above; vr180: on half a sphere each."),
    click.option("--baseline", callback=_parse_baseline, metavar="B",
                 help="Between the eyes, a part of the array's width, or a length, 63mm.  [default: 0.2, 3 degrees]"),
)  # fmt: skip
time_option = click.option(
    "--time",
    callback=_parse_time,
    metavar="TIME",
    help="Of a clip: seconds (1.25s), the number of a frame (37), or a range of either for a film (0s:2s).",
)
residual_option = click.option(
    "--residual",
    is_flag=True,
    help="Put the file's residual on captured views: nearer to the photographs, up to nearly lossless.",
)
