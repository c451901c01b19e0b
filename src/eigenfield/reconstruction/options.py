"""The options of `reconstruct`: each stands here once, and the command line and its help are made from these fields.

Importing this loads nothing but the standard library, so that `eigenfield encode --help` comes at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Options, document_options, option

MESH_KINDS = "relief: two layers seen from the array's centre; poisson: a surface from all sides"
SURFACE_KINDS = ("auto", "relief", "layers", "poisson")


@document_options
@dataclass(frozen=True, kw_only=True)
class SurfaceOptions(Options):
    """How photographs become a proxy, and cameras where they have none. Every option may be left out.

    An option that cannot be, or two that exclude each other, raise OptionError when the value is made: `surface`,
    `layers`, `triangles`, `primitive` or `fit-sphere`.
    """

    surface: str = option(
        f"{MESH_KINDS}; layers: soft sheets with an opacity.  [default: auto]",
        "auto",
        choices=SURFACE_KINDS,
    )
    layers: int | None = option(
        "Soft sheets: 2 to 32, or 1 for none; auto tries 4 and 8 on views left out.  [default: auto]", metavar="N"
    )
    refine: bool | None = option(
        "Correct an array's cameras together with its depth.  [default: where none are given, or 25 or more]",
        deniable=True,
    )
    background: bool | None = option(
        "Close the view behind the scene.  [default: unless there are masks]", name="fill-background", deniable=True
    )
    primitives: Sequence[str] = option(
        "Add a shape to the mesh: sphere:CX,CY,CZ,R or plane:PX,PY,PZ,NX,NY,NZ,EXTENT.",
        (),
        name="primitive",
        metavar="SHAPE",
    )
    fit_spheres: Sequence[str] = option(
        "Add a sphere, fitted to the outline in this region of a photograph.",
        (),
        name="fit-sphere",
        metavar="VIEW:X,Y,W,H",
    )
    triangles: int = option("Triangles of the mesh, at most.  [default: 30000]", 30_000, metavar="N")
    blind: str | None = option(
        "Keep the photographs of a rule (as hold_out) out of cameras and proxy. Each only registers its own camera, "
        "where that is not given, and is left out if it cannot.",
        offered=False,
    )
    hold_out: str | None = option(
        "A rule: every:K, odd, or names. Layers, whose opacity is appearance, are not made from these views.  "
        "[default: those of blind]",
        offered=False,
    )

    def __post_init__(self) -> None:
        from eigenfield.proxy import parse_primitive, parse_region
        from eigenfield.proxy.atlas.unwrap import UNWRAP_MIN_TRIANGLES

        self.check_types()
        for name in ("primitives", "fit_spheres"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if self.surface not in SURFACE_KINDS:
            raise OptionError(
                "surface", f"no surface is called {self.surface}", remedy=f"use {', '.join(SURFACE_KINDS)}"
            )
        self._check_layers()
        if self.triangles < UNWRAP_MIN_TRIANGLES:
            raise OptionError(
                "triangles",
                f"{self.triangles} triangles were asked for",
                remedy=f"ask for {UNWRAP_MIN_TRIANGLES} or more",
            )
        for text in self.primitives:
            parse_primitive(text)
        for text in self.fit_spheres:
            parse_region(text)

    @property
    def by_hand(self) -> str | None:
        """The option by which the surface is made by hand, which soft sheets do not allow; None: there is none."""
        if self.background is not None:
            return "fill-background" if self.background else "no-fill-background"
        return "primitive" if self.primitives else "fit-sphere" if self.fit_spheres else None

    def _check_layers(self) -> None:
        from eigenfield.coding.limits import MAX_SHEETS

        if self.layers is not None and not 1 <= self.layers <= MAX_SHEETS:
            raise OptionError(
                "layers", f"{self.layers} layers were asked for", remedy=f"ask for 2 to {MAX_SHEETS}, or 1 for none"
            )
        if self.layers is not None and self.layers > 1 and self.surface not in ("auto", "layers"):
            raise OptionError(
                "layers", f"a {self.surface} surface has no {self.layers} layers", remedy="use --surface layers"
            )
        if self.surface == "layers" and self.layers == 1:
            raise OptionError("layers", "one layer is an opaque surface", remedy="leave out --surface layers")
        if self.surface == "layers" and self.by_hand is not None:
            raise OptionError(
                "surface", f"layers do not go together with --{self.by_hand}", remedy="leave out one of the two"
            )
