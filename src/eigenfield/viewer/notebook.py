"""A scene or a clip in a notebook: the viewer in a frame that holds everything it needs, and may reach nothing."""

from __future__ import annotations

import html
from dataclasses import replace

from eigenfield.core.clip import Clip
from eigenfield.core.errors import EigenfieldError
from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene
from eigenfield.viewer.page import single_file

NOTEBOOK_TITLE = "Eigen-texture scene"
NOTEBOOK_HEIGHT_PX = 480
NOTEBOOK_MAX_BYTES = 64 * 2**20  # of a scene's file; notebooks save what they show, and are slow with more
NOTEBOOK_FEATURES = "xr-spatial-tracking; gyroscope; accelerometer; gamepad"


def scene_html(scene: Scene | Clip) -> str:
    """The scene or the clip as an <iframe>, for Jupyter and its like; one line of text where it cannot be shown.

    What has no payload is coded once; the residual is left out. The frame is an origin of its own (`sandbox` without
    `allow-same-origin`): it can neither read the notebook nor act in it."""
    try:
        if isinstance(scene, Clip):
            glb = encode_scene(scene)
        else:
            glb = scene.derive("glb", lambda: encode_scene(replace(scene, residual=None)))
        if len(glb) > NOTEBOOK_MAX_BYTES:
            return _line(
                f"a scene of {len(glb) / 1e6:.0f} MB is too large for a notebook; save it and use "
                "`eigenfield view SCENE`"
            )
        page = single_file(glb, title=NOTEBOOK_TITLE).decode("utf-8")
    except EigenfieldError as error:
        return _line(str(error))
    return (
        f'<iframe srcdoc="{html.escape(page)}" title="{NOTEBOOK_TITLE}" width="100%" '
        f'height="{NOTEBOOK_HEIGHT_PX}" style="border: 0" '
        f'allow="{NOTEBOOK_FEATURES}" allowfullscreen sandbox="allow-scripts allow-downloads"></iframe>'
    )


def _line(message: str) -> str:
    return f"<pre>{html.escape(message)}</pre>"
