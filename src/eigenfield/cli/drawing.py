"""Options of the verbs that draw pictures and videos."""

from __future__ import annotations

import re
from fractions import Fraction

import click

from eigenfield.cli.common import pair_of_numbers, together

DEFAULT_FPS = "30"


def parse_place(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, float] | None:
    """A click callback: view-plane coordinates, X,Y."""
    if value is None:
        return None
    try:
        x, y = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter("two numbers from -1 to 1 with a comma between them: 0.3,-0.2") from None
    return x, y


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
residual_option = click.option(
    "--residual",
    is_flag=True,
    help="Put the file's residual on captured views: nearer to the photographs, up to nearly lossless.",
)
