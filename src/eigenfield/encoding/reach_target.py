"""Means, eigen textures and weights fitted to the photographs: from a plan to a scene, of a quality or for a target.

A file that is to reach a size, a PSNR or an SSIM gets a second fit where another mesh or atlas belongs to it.
"""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.fitted.encoder import FittedEncoder, open_encoder
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.left_out import has_scores
from eigenfield.encoding.options import EncodeOptions, resolved_value
from eigenfield.encoding.plan import EncodePlan
from eigenfield.encoding.prepare import plan_at_quality, plan_encoding
from eigenfield.encoding.target import TARGET_FIRST_QUALITY, Attempt, Target, search_quality
from eigenfield.gltf import encode_scene
from eigenfield.imaging.metrics import psnr, ssim
from eigenfield.rendering import Renderer, ViewWeights
from eigenfield.runtime.parallel import parallel_stream

log = logging.getLogger("eigenfield.encode")

REFIT_MIN_MESH_RATIO = 0.03  # of a file's bytes by which another mesh must differ for a second fit
REFIT_MAX_NEAR_QUALITIES = 3  # from the plan's quality, within which mesh and atlas are nearly the same
REFIT_MIN_ATLAS_RATIO = 0.1  # of its side by which another atlas must differ for a second fit
SCORES_MAX_BYTES = 240  # of the scores that `encode` adds
FIGURES_MAX_BYTES = 16  # that the PSNR of two planes takes more than its placeholders, which may deflate to nothing
TARGET_MAX_OBSERVATIONS = 48  # evenly spread, over which a PSNR or SSIM is measured


def encode_fitted(plan: EncodePlan, work: Path | None = None, progress: Progress | None = None) -> Scene:
    """A scene whose drawn pictures match the plan's photographs as far as its quality, or its target, allows.

    Its planes are coded already: `save` keeps their bytes.

    Args:
        work: Folder for scratch files of up to 17 bytes a pixel.

    Raises:
        CaptureError: A photograph cannot be read, or no camera sees the proxy (`nothing-seen`).
        OutputError: The scratch folder is full (`disk-full`).
    """
    if plan.asked.target is not None:
        return reach_target(plan, plan.asked.target, work, progress)
    with open_encoder(plan, work, progress) as encoder:
        return encoder.encode(resolved_value(plan.options.quality))


def reach_target(plan: EncodePlan, target: Target, work: Path | None, progress: Progress | None) -> Scene:
    """The scene whose file reaches the target, or with a warning the nearest.

    Mesh and atlas belong to a quality. Where the target is met at one that has clearly others than the plan's, there is
    a second fit, on those, and the better file of both is taken.

    Args:
        plan: Made for the preset's quality.
    """
    with open_encoder(plan, work, progress) as encoder:
        attempt = _search(target, encoder)
        scene = encoder.with_figures(attempt.result)
        other = _other_plan(plan, attempt, work, progress)
        if other is not None:
            attempt = _with_psnr(target, attempt, encoder.data)
    if other is not None:
        words = "fitted again for quality %d: mesh %d bytes instead of %d, atlas %dx%d instead of %dx%d"
        log.info(words, attempt.quality, other.mesh_bytes, plan.mesh_bytes, *other.atlas, *plan.atlas)
        with open_encoder(other, work, progress, warn=False) as encoder:
            second = _with_psnr(target, _search(target, encoder, attempt.quality), encoder.data)
            sizes = second.size, second.measured, attempt.size, attempt.measured
            if target.merit(second) > target.merit(attempt):
                log.info("kept: %d bytes, %.4f instead of %d, %.4f", *sizes)
                attempt, scene = second, encoder.with_figures(second.result)
            else:
                log.info("not kept: %d bytes, %.4f, and the first has %d, %.4f", *sizes)
    if not target.is_met(attempt):
        _warn_of_miss(target, attempt)
    return scene


def _other_plan(
    plan: EncodePlan, attempt: Attempt[Scene], work: Path | None, progress: Progress | None
) -> EncodePlan | None:
    """The plan for the quality that was found, where its mesh or atlas differs enough for a second fit; else None."""
    if abs(attempt.quality - resolved_value(plan.options.quality)) <= REFIT_MAX_NEAR_QUALITIES:
        return None
    other = plan_at_quality(plan, attempt.quality, work, progress)
    mesh = abs(other.mesh_bytes - plan.mesh_bytes) >= REFIT_MIN_MESH_RATIO * attempt.size
    atlas = abs(other.atlas[0] / plan.atlas[0] - 1) >= REFIT_MIN_ATLAS_RATIO
    return other if mesh or atlas else None


def _search(target: Target, encoder: FittedEncoder, first: int = TARGET_FIRST_QUALITY) -> Attempt[Scene]:
    """As `search_quality`, of what the encoder makes."""

    added = FIGURES_MAX_BYTES + (SCORES_MAX_BYTES if has_scores(encoder.plan) else 0)

    def code(quality: int) -> Attempt[Scene]:
        scene = encoder.encode_without_figures(quality)
        measured = 0.0 if target.size else _mean_measure(target, scene, encoder.data)
        return Attempt(quality, len(encode_scene(scene)) + added, measured, scene)

    return search_quality(target, code, first)


def _with_psnr(target: Target, attempt: Attempt[Scene], data: FitData) -> Attempt[Scene]:
    """What was found, measured too where the target is a size: for `Target.merit`."""
    return attempt if target.size is None else replace(attempt, measured=_mean_measure(target, attempt.result, data))


def _mean_measure(target: Target, scene: Scene, data: FitData) -> float:
    """The mean PSNR or SSIM over covered pixels of some observations, drawn as they are."""
    renderer, observations, cameras = Renderer(scene), data.observations, scene.rig.encoded_cameras

    def of_observation(index: int) -> float | None:
        picture = renderer.draw(cameras[observations.camera_of(index)], ViewWeights.one(index))
        covered, mask = picture.covered, observations.mask(index)
        if mask.size:
            covered &= mask > 0
        measure = psnr if target.ssim is None else ssim
        return measure(picture.image, observations.codes_of(index), covered)

    some = spread_indices(len(data), TARGET_MAX_OBSERVATIONS)
    values = [value for value in parallel_stream(of_observation, some) if value is not None]
    return float(np.mean(values)) if values else 0.0


def _warn_of_miss(target: Target, nearest: Attempt[Scene]) -> None:
    """Say that no file reaches the target, and why."""
    if target.size is not None:
        words = "%d bytes cannot be reached: the coarsest file has %d; take fewer textures, or a lower density"
        log.warning(words, target.size, nearest.size)
    else:
        words = "%g cannot be reached: the finest file has %.4g; take more textures, or a higher density"
        log.warning(words, target.goal, nearest.measured)


@contextlib.contextmanager
def open_fitted(
    capture: CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy,
    options: EncodeOptions,
    work: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Iterator[FittedEncoder]:
    """Fit once, to code at many qualities.

    Arguments and errors are those of `encode`, which makes the same of `fit="photographs"` at each quality. Mesh and
    atlas are those of the options' quality.
    """
    folder = None if work is None else Path(work)
    plan = plan_encoding(capture, proxy, replace(options, fit="photographs"), folder, progress)
    with open_encoder(plan, folder, progress) as encoder:
        yield encoder
