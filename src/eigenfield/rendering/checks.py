"""Options that both renderers and the exports take."""

from __future__ import annotations

from eigenfield.core.errors import OptionError

TEXTURE_FILTERS = ("bilinear", "bicubic")  # of texels; BICUBIC 0, 1 of the shader


def check_filter(filter: str) -> None:
    """Refuse an unknown filter.

    Args:
        filter: Its name.

    Raises:
        OptionError: `filter`: it is none of `TEXTURE_FILTERS`.
    """
    if filter not in TEXTURE_FILTERS:
        remedy = f"use one of {', '.join(TEXTURE_FILTERS)}"
        raise OptionError("filter", f"no filter is called {filter!r}", remedy=remedy)


def check_textures(textures: int | None) -> None:
    """Refuse a negative number of eigen textures.

    Args:
        textures: The number; None: all of them.

    Raises:
        OptionError: `textures`: it is negative.
    """
    if textures is not None and textures < 0:
        raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")
