"""Means, eigen textures and weights fitted to the photographs: from a plan to a scene."""

from __future__ import annotations

from pathlib import Path

from eigenfield.core.progress import Progress
from eigenfield.core.scene import EncodedScene
from eigenfield.encoding.fitted.encoder import open_encoder
from eigenfield.encoding.fitted.reach import reach_target
from eigenfield.encoding.options import resolved_value
from eigenfield.encoding.plan import EncodePlan


def encode_fitted(plan: EncodePlan, work: Path | None = None, progress: Progress | None = None) -> EncodedScene:
    """A scene whose drawn pictures match the plan's photographs as far as its quality, or its target, allows.

    Its planes are coded already: `save` keeps their bytes.

    Args:
        plan: Cameras, mesh and atlas, and the options.
        work: Folder for scratch files of up to 17 bytes a pixel.
        progress: Reports each stage.

    Raises:
        CaptureError: A photograph cannot be read, or no camera sees the proxy (`nothing-seen`).
        OutputError: The scratch folder is full (`disk-full`).
    """
    if plan.asked.target is not None:
        return reach_target(plan, plan.asked.target, work, progress)
    with open_encoder(plan, work, progress) as encoder:
        return encoder.encode(resolved_value(plan.options.quality))
