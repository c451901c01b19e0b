"""A plan's photographs fitted once, and coded at any quality."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from eigenfield.core.payloads import Payloads
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.scene import Scene
from eigenfield.encoding.agreement import warn_of_disagreement
from eigenfield.encoding.fitted.colour import to_rgb
from eigenfield.encoding.fitted.exposures import EXPOSURE_MODEL, fit_exposures
from eigenfield.encoding.fitted.observations import FitData, open_fit_data
from eigenfield.encoding.fitted.planes import Fits, fitted_textures, open_fits
from eigenfield.encoding.options import PRESETS, resolved_value
from eigenfield.encoding.plan import EncodePlan, component_count


@dataclass(frozen=True, eq=False)
class FittedEncoder:
    """Planes fitted to photographs, which stay open, to be coded at one quality or many.

    Attributes:
        plan: The plan whose photographs they are fitted to.
        data: The observations of the encoded cameras, and their footprints on the mesh.
    """

    plan: EncodePlan
    data: FitData
    fits: Fits
    progress: Progress | None = None

    def encode(self, quality: int) -> Scene:
        """The scene coded at a quality, 0 to 100, with the PSNR of its planes in its settings."""
        return self.with_figures(self.encode_without_figures(quality))

    def encode_without_figures(self, quality: int) -> Scene:
        """The scene coded at a quality; its settings have placeholders for the PSNR."""
        begin_step(self.progress, "code")
        options = self.plan.options
        settings = {"fit": options.fit, "fitted": {"quality": quality, "psnr": self.fits.psnr_figures()}}
        colours = self.data.observations.colours
        if colours is not None:
            settings["harmonise"] = options.harmonise or EXPOSURE_MODEL
        planes = self.fits.code_planes(quality, self.plan.views.grid, self.progress)
        return self.plan.scene(
            tuple(plane.value for plane in planes.values()),
            settings,
            payloads=Payloads.merge(plane.payloads for plane in planes.values()),
            colours=None if colours is None else self.plan.views.for_all_cameras(colours),
            to_rgb=to_rgb(),
        )

    def with_figures(self, scene: Scene) -> Scene:
        """A scene of `encode_without_figures`, with the PSNR of each of its planes in its settings."""
        fitted = {**scene.settings["fitted"], "psnr": self.fits.psnr_figures(scene.appearance.planes)}
        return replace(scene, settings={**scene.settings, "fitted": fitted})


@contextlib.contextmanager
def open_encoder(
    plan: EncodePlan, work: Path | None = None, progress: Progress | None = None, warn: bool = True
) -> Iterator[FittedEncoder]:
    """Fit planes to a plan's photographs.

    Args:
        plan: One whose options ask for a fit.
        work: Folder for scratch files of up to 17 bytes a pixel.
        warn: Whether photographs that do not show what the others do are named in a warning.
    """
    begin_step(progress, "fit")
    views, options = plan.views, plan.options
    cameras, observations = views.rig.encoded_cameras, views.observations
    count = fitted_textures(len(observations)) if options.textures is None else options.textures
    textures, preset = component_count(count, len(observations)), PRESETS[resolved_value(options.preset)]
    size, colours = (plan.atlas[1], plan.atlas[0]), fit_exposures(plan, work, progress)
    scattered = views.scattered and plan.proxy.sheets is None
    with (
        open_fit_data(
            cameras, observations, plan.proxy, size, work, progress, views.rig.encoded_reference, colours
        ) as data,
        open_fits(data, plan.density, textures, scattered, preset, work, progress) as fits,
    ):
        if warn:
            mean = fits.planes[0][1].mean_alone
            names, places = views.observation_names, views.coordinates[views.taken_by]
            warn_of_disagreement(mean.squares, mean.pixels, mean.channels, mean.total, names, places)
        yield FittedEncoder(plan, data, fits, progress)
