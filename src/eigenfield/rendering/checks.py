"""Options that both renderers and the exports take."""

from __future__ import annotations

from eigenfield.core.errors import OptionError

FILTERS = ("bilinear", "bicubic")  # of texels; BICUBIC 0, 1 of the shader


def check_filter(filter: str) -> None:
    """Raise OptionError `filter` unless it is one of `FILTERS`."""
    if filter not in FILTERS:
        raise OptionError("filter", f"no filter is called {filter!r}", remedy=f"use one of {', '.join(FILTERS)}")


def check_textures(textures: int | None) -> None:
    """Raise OptionError `textures` for fewer than no eigen textures; None is all of them."""
    if textures is not None and textures < 0:
        raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")
