"""The exposures of photographs that a fit brings together, and whether that pays.

Gains and offsets are those of `harmonise.fit_colours`, from coarse texture maps of all photographs. They are used where
the mean comes clearly nearer to all photographs, so that textures are spared, and photographs left out of a trial are
predicted hardly worse: by the mean and by what the photographs around them deviate from it, once as all are, and once
in a common exposure that then becomes a mixture of those around.
"""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.core.proxy import opaque_mesh
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.left_out import interpolation, is_sparse, spread_inside
from eigenfield.encoding.plan import EncodePlan
from eigenfield.encoding.projected.harmonise import Cells, average_cells
from eigenfield.encoding.projected.project import texture_maps

log = logging.getLogger("eigenfield.fit")

EXPOSURE_ATLAS_SIDE_TEXELS = 256  # of the maps; cells are averages over a few of their texels
EXPOSURE_MODEL = "affine"
EXPOSURE_MIN_GAIN_DB = 2.0  # by which the mean comes nearer to the photographs; chosen on Cube, Fountain and Temple
EXPOSURE_MAX_LOSS_DB = 1.0  # by which photographs left out may be predicted worse: chance, where there is no order


def fit_exposures(
    plan: EncodePlan, work: Path | None = None, progress: Progress | None = None
) -> NDArray[np.float32] | None:
    """(No, 2, 3) gains and offsets of the plan's observations; None where photographs stay as they are.

    Args:
        plan: Its `harmonise` says what is fitted; None: what pays.
        work: Folder for a scratch file of 0.8 MB a photograph.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    model, views = plan.options.harmonise, plan.views
    if model == "none" or (model is None and not is_sparse(plan)):
        return None
    atlas = make_atlas(opaque_mesh(plan.proxy), EXPOSURE_ATLAS_SIDE_TEXELS, EXPOSURE_ATLAS_SIDE_TEXELS)
    with texture_maps(atlas, views.rig.encoded_cameras, views.observations, work=work, progress=progress) as maps:
        cells = average_cells(maps)
    if model is None:
        by_mean, between = _gains_of(cells, plan)
        used = by_mean >= EXPOSURE_MIN_GAIN_DB and between >= -EXPOSURE_MAX_LOSS_DB
        words = "in a common exposure the mean is %.1f dB nearer to the photographs, those left out are %.1f dB: %s"
        log.info(words, by_mean, between, "exposures are brought together" if used else "exposures stay as they are")
        if not used:
            return None
    return cells.fit(model or EXPOSURE_MODEL)


def _gains_of(cells: Cells, plan: EncodePlan) -> tuple[float, float]:
    """dB by which a common exposure brings the mean nearer to photographs, and predictions nearer to those left out."""
    rig = plan.views.rig
    left_out = spread_inside(rig)
    others = [index for index in range(len(rig.encoded)) if index not in left_out]
    known = replace(cells, values=cells.values[others], weights=cells.weights[others])
    mixing = interpolation(rig, others, left_out)
    identity = np.zeros((len(others), 2, 3), np.float32)
    identity[:, 0] = 1
    errors = []
    for colours in (identity, known.fit(EXPOSURE_MODEL)):
        gain, offset = np.moveaxis(colours.astype(np.float64), 1, 0)[:, :, None]
        maps, weights = known.values * gain + offset, known.weights / gain**2
        total = weights.sum(axis=0)
        mean = np.divide((weights * maps).sum(axis=0), total, out=np.zeros_like(total), where=total > 0)
        apart = np.where(weights > 0, maps - mean, 0)
        drawn = mean + np.einsum("ho,omc->hmc", mixing, apart)
        drawn = drawn * np.einsum("ho,oxc->hxc", mixing, 1 / gain) - np.einsum("ho,oxc->hxc", mixing, offset / gain)
        counts = (cells.weights[left_out] > 0) & (total > 0)
        left = np.square(drawn - cells.values[left_out])[counts]
        errors.append((float((weights * apart**2).sum()), float(left.sum())))
    by_mean, between = 10 * np.log10(np.maximum(errors[0], 1e-12) / np.maximum(errors[1], 1e-12))
    return float(by_mean), float(between)
