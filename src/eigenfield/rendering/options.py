"""Options that both renderers and the exports take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import OptionError

TEXTURE_FILTERS = ("bilinear", "bicubic")  # of texels; BICUBIC 0, 1 of the shader
BLACK = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class PictureOptions:
    """How a picture is drawn.

    Attributes:
        filter: `bilinear` or `bicubic` (Catmull-Rom).
        background: One number, or one for each channel, 0..1. None: transparent, where the picture becomes a file.
        textures: Number of eigen textures of each basis. Default: all.
        samples: k of k x k samples a pixel, 1 to 16. Default: one, but four at edges (decision 24), or more in a
            picture smaller than the photographs.

    Raises:
        OptionError: `filter`, `textures`.
    """

    filter: str = "bicubic"
    background: Sequence[float] | None = BLACK
    textures: int | None = None
    samples: int | None = None

    def __post_init__(self) -> None:
        check_filter(self.filter)
        check_textures(self.textures)


def check_filter(filter: str) -> None:
    """Raise OptionError `filter` for a filter that is none of `TEXTURE_FILTERS`."""
    if filter not in TEXTURE_FILTERS:
        remedy = f"use one of {', '.join(TEXTURE_FILTERS)}"
        raise OptionError("filter", f"no filter is called {filter!r}", remedy=remedy)


def check_textures(textures: int | None) -> None:
    """Raise OptionError `textures` for a negative number of eigen textures; None stands for all of them."""
    if textures is not None and textures < 0:
        raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")


def background_of(background: Sequence[float] | float | None, channels: int) -> NDArray[np.float32]:
    """(C,) float32 of one number, which stands for all channels, or of C; what is transparent is drawn on black.

    Raises:
        OptionError: `background`: they are of another number, or not finite.
    """
    values = np.atleast_1d(np.asarray(BLACK if background is None else background, np.float32))
    if values.shape == (3,) and channels != 3 and not values.any():
        values = values[:1]  # the default, for attributes that are no colours
    if values.shape not in ((1,), (channels,)) or not np.isfinite(values).all():
        remedy = f"give 1 or {channels} finite ones"
        raise OptionError("background", f"the background has {values.size} values", remedy=remedy)
    return np.ascontiguousarray(np.broadcast_to(values, (channels,)))


PICTURE_DEFAULTS = PictureOptions()
