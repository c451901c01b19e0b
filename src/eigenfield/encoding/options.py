"""The options of `encode`: each stands here once, and the command line and its help are made from these fields.

Importing this loads nothing but the standard library, so that `eigenfield encode --help` comes at once.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import TypedDict, TypeVar

from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Options, document_options, option, options_of
from eigenfield.core.rights import Rights
from eigenfield.encoding.target import Target

T = TypeVar("T")

DEFAULT_TEXTURES = 15  # without a fit, as in the paper
DEFAULT_DENSITY = 1.5  # without a fit
DEFAULT_MAX_ANGLE = 85  # degrees, without a fit
DEFAULT_PRESET = "balanced"
ATLAS_MAX_SIDE_TEXELS = 16384
DENSITY_LIMITS = 0.01, 100.0  # atlas texels per photograph pixel along one axis
FIT_MAX_DENSITY = 1.5  # likewise, with a fit
SUBSAMPLE_MIN_OBSERVATIONS = 50  # from which every second pixel each way is enough for weights, and for chroma
MAP_OPTIONS = ("align", "max_angle", "uv_ssim", "keep_maps", "codec")  # options that a fit has no use for
FIT_OPTIONS = ("target", "preset", "fallback")  # options that the paper's way has no use for
UNKNOWN_CHOICE_TEXTS = {
    "fit": "no fit is called",
    "preset": "no preset is called",
    "harmonise": "no harmonisation is called",
    "fallback": "no fallback is called",
}


@dataclass(frozen=True)
class Preset:
    """Quality and effort of a fit.

    Attributes:
        quality: 0 to 100.
        rounds: Rounds of fitting textures and weights in turns, at most; captures of few cameras get more.
        patient: Whether mean and textures are coded for as few bytes as time buys.
    """

    quality: int
    rounds: int
    patient: bool = False


PRESETS = {"small": Preset(79, 2), "balanced": Preset(89, 2), "best": Preset(95, 4, patient=True)}


def density_for_quality(quality: int) -> float:
    """The density of a fit at a quality of 0 to 100, in atlas texels per photograph pixel along one axis.

    Coarse codes lose the detail of a dense atlas. On Tarot 0.9 takes the fewest bytes for the same luma at quality 62,
    1.05 at 68 and 1.35 at 86; on Shop 1.25 does at 80, on Antinous 1.0 at 75.
    """
    return min(max(0.9 + 0.6 * (quality - 60) / 31, 0.9), FIT_MAX_DENSITY)


class Coding(TypedDict):
    """Arguments of `save` and `encode_scene`.

    Attributes:
        codec: "avif", "webp" or "png"; None: what is coded already is kept, and the rest becomes AVIF.
        quality: 0 to 100, for AVIF; None: its default.
    """

    codec: str | None
    quality: int | None


@document_options
@dataclass(frozen=True, kw_only=True)
class EncodeOptions(Options):
    """The options of `encode`. Every option may be left out; `resolved` fills in what that means.

    An option that cannot be, or two that exclude each other, raise OptionError when the value is made. The command
    line has the same options: `--uv-ssim` is `uv_ssim`. Without a fit `codec` and `quality` are about the file: give
    `for_save` to `save`.
    """

    textures: int | None = option(
        "Eigen textures, fewer than there are cameras; a fit keeps those that are worth their bytes.  [default: half "
        "as many as cameras, 20 to 96; with --fit none 15]",
        letter="-n",
        metavar="N",
    )
    uv_ssim: float | None = option(
        "Take as few eigen textures as reach this SSIM in UV space, for example 0.98.", metavar="S"
    )
    density: float | None = option(
        "Texels of the atlas for each pixel of the central photograph, along one axis. The atlas has at most 4096 a "
        "side and twice the photographs' pixels.  [default: 0.9 to 1.5 with the quality; 0.7 of it where cameras look "
        "around and stand on no grid; with --fit none 1.5]",
        metavar="D",
    )
    atlas: int | tuple[int, int] | None = option(
        "Side of the atlas in texels, or WIDTHxHEIGHT, instead of a density.", metavar="N"
    )
    triangles: int | None = option(
        "Triangles of the mesh, at most.  [default: a fit removes triangles while that saves more bytes than it costs "
        "quality; with --fit none 30000, and a mesh with an atlas stays as it is]",
        metavar="N",
    )
    align: bool | None = option("Align the texture maps to the reference camera by optical flow.")
    max_angle: int | None = option(
        "Leave out of a texture map what its camera sees at this many degrees from the normal or more; 90 leaves out "
        "nothing, as in the paper.  [default: 85]",
        limits=(1, 90),
        metavar="DEG",
    )
    harmonise: str | None = option(
        "Take differences of exposure and white balance out of the textures, by a gain, or by a gain and an offset "
        "(affine). Views get the exposure of the cameras around them.  [default: affine where photographs left out "
        "say that it pays, else none; with --fit none none]",
        choices=("none", "gain", "affine"),
        metavar="[none|gain|affine]",
        bare="gain",
    )
    metres_per_unit: float | None = option(
        "Metres in one unit of the cameras' world, so that headsets show the real size.  "
        "[default: as the capture says]",
        metavar="F",
    )
    reference: str | None = option(
        "Camera of the first view and of --density.  [default: the one nearest the centre]", metavar="NAME"
    )
    hold_out: str | None = option(
        "Leave photographs out of the textures, to measure views between the others: every:K (every K-th), odd (those "
        "in odd rows or columns of a grid, counted from 0), or names with commas. Estimated cameras and surfaces still "
        "use them, except soft sheets; see --blind.",
        metavar="RULE",
    )
    codec: str | None = option(
        "How the pictures are coded: avif is lossy, webp and png keep 8 bits exactly.  [default: avif]",
        choices=("avif", "webp", "png"),
    )
    quality: int | None = option(
        "Quality, 0 to 100, instead of a preset's.  [default: the preset's; with --fit none 70]",
        limits=(0, 100),
        metavar="Q",
    )
    fit: str | None = option(
        "none: project the photographs into texture maps and decompose these, as the paper does; faster, with larger "
        "and less sharp files. photographs: fit the textures to the photographs.  [default: photographs; none where "
        "one of --uv-ssim, --align, --max-angle, --codec and --keep-maps is given]",
        choices=("none", "photographs"),
    )
    preset: str | None = option(
        "Small file or best pictures; best takes far longer.  [default: balanced]",
        choices=tuple(PRESETS),
    )
    target: Target | None = option("What the file is to reach, by the fit's quality (`Target`).", parts=Target)
    residual: int | None = option(
        "For archives: also keep what captured views lack, as a video of quality Q, 0 (coarse) to 100 (near-lossless); "
        "40 without a number. Views between the cameras gain nothing.",
        limits=(0, 100),
        metavar="[Q]",
        bare="40",
    )
    fallback: str | None = option(
        "What other glTF viewers show: the middle view in at most 6 % of the file's bytes (small), in at most 25 % "
        "(good), or nothing (none).  [default: small]",
        choices=("small", "good", "none"),
    )
    group: str | None = option(
        "Of a clip: how long what is decoded by itself lasts, in seconds (1.5s) or frames (30).  [default: 1s]",
        metavar="LENGTH",
    )
    rights: Rights | None = option("Title, author, licence and source (`Rights`).", parts=Rights)
    keep_maps: str | os.PathLike[str] | None = option(
        "Also write every texture map and its visibility as PNG.", metavar="DIR"
    )

    def __post_init__(self) -> None:
        self.check_types()
        self._check_file()
        self._check_way()
        self._check_numbers()

    def resolved(self) -> EncodeOptions:
        """The options as they are meant: what was left out is filled in, as far as it follows from the rest alone.

        None stays what depends on the capture, what the chosen way has no use for, and what is decided later: with a
        target the quality and a density that follows it; without a fit the codec and the quality of the file.
        """
        if self._chosen_fit == "none":
            return replace(
                self,
                fit="none",
                textures=DEFAULT_TEXTURES if self.textures is None and self.uv_ssim is None else self.textures,
                density=DEFAULT_DENSITY if self.density is None else self.density,
                max_angle=DEFAULT_MAX_ANGLE if self.max_angle is None else self.max_angle,
            )
        preset, quality, density = self.preset or DEFAULT_PRESET, self.quality, self.density
        if quality is None and self.target is None:
            quality = PRESETS[preset].quality
        if density is None and quality is not None:
            density = density_for_quality(quality)
        return replace(self, fit="photographs", preset=preset, quality=quality, density=density)

    @property
    def coding(self) -> Coding:
        """How pictures that are not fitted are coded: `codec` and `quality` of `save` and `encode_scene`."""
        if self._chosen_fit == "none":
            return {"codec": self.codec, "quality": self.quality}
        return {"codec": None, "quality": None}  # they are coded already

    @property
    def for_save(self) -> Coding:
        """`coding` for the scene that `encode` returns, whose pictures are coded already if it has a residual."""
        return {"codec": None, "quality": None} if self.residual is not None else self.coding

    def refuse_clip_options(self) -> None:
        """Raise OptionError `group-unused`, `target` for what only a clip has."""
        remedy = "say --clip, or leave it out"
        if self.group is not None:
            raise OptionError("group-unused", "--group is about clips", remedy=remedy)
        if self.target is not None and self.target.bitrate is not None:
            raise OptionError("target", "--target-bitrate is about clips", remedy=remedy)

    @property
    def map_options(self) -> list[str]:
        """The given options that are about texture maps, as the command line writes them."""
        return [f"--{name.replace('_', '-')}" for name in MAP_OPTIONS if getattr(self, name) not in (None, False)]

    @property
    def _fit_options(self) -> list[str]:
        return [name for name in FIT_OPTIONS if getattr(self, name) is not None]

    @property
    def _chosen_fit(self) -> str:
        return self.fit or ("none" if self.map_options and not self._fit_options else "photographs")

    def _check_file(self) -> None:
        from eigenfield.coding.stacking import DEFAULT_CODEC, check_codec

        check_codec(self.codec or DEFAULT_CODEC, self.quality)
        if self.residual is not None and self.target is not None:
            message = "a target is about the textures, and a residual comes on top of them"
            raise OptionError("residual", message, remedy="say --quality and --residual Q instead")

    def _check_way(self) -> None:
        """Raise OptionError for values that are not among the choices, and for options that exclude each other."""
        for name, one in options_of(type(self)):
            value = getattr(self, name)
            if name in UNKNOWN_CHOICE_TEXTS and value is not None and value not in one.choices:
                remedy = f"use one of {', '.join(one.choices)}"
                raise OptionError(name, f"{UNKNOWN_CHOICE_TEXTS[name]} {value}", remedy=remedy)
        if self.target is not None:
            self.target.check()
            if self.quality is not None:
                raise OptionError("target", "a target is reached by the quality", remedy="leave one of them out")
        maps, fits = self.map_options, self._fit_options
        if self._chosen_fit == "none" and fits:
            raise OptionError(fits[0], f"--fit none has no {fits[0]}", remedy="leave one of them out")
        if self._chosen_fit != "none" and maps:
            other = f"leave it or the {fits[0]} out" if fits else "leave it out, or --fit none"
            raise OptionError("fit", f"{maps[0]} is about texture maps, and a fit makes none", remedy=other)

    def _check_numbers(self) -> None:
        from eigenfield.core.scene import check_scale

        if self.textures is not None and self.textures < 0:
            raise OptionError("textures", f"{self.textures} eigen textures were asked for", remedy="ask for 0 or more")
        check_scale(self.metres_per_unit)
        if self.max_angle is not None and not 1 <= self.max_angle <= 90:
            raise OptionError(
                "max-angle", f"an angle of {self.max_angle} was asked for", remedy="ask for 1 to 90 degrees"
            )
        if self.uv_ssim is not None and not 0 < self.uv_ssim <= 1:
            raise OptionError("uv-ssim", f"an SSIM of {self.uv_ssim:g} was asked for", remedy="ask for one in (0, 1]")
        low, high = DENSITY_LIMITS
        if self.density is not None and not low <= self.density <= high:
            message = f"a density of {self.density:g} was asked for"
            raise OptionError("density", message, remedy=f"ask for one between {low:g} and {high:g}")
        sides = (self.atlas,) if self.atlas is None or isinstance(self.atlas, int) else self.atlas
        if not all(side is None or 1 <= side <= ATLAS_MAX_SIDE_TEXELS for side in sides):
            remedy = f"ask for sides from 1 to {ATLAS_MAX_SIDE_TEXELS}"
            raise OptionError("atlas", f"an atlas of {self.atlas} was asked for", remedy=remedy)


def resolved_value(value: T | None) -> T:
    """An option that `EncodeOptions.resolved` has filled in."""
    assert value is not None
    return value
