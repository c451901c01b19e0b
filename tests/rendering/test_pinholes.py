"""Neighbouring triangles cover every pixel between them exactly once: from a thousand eyes, in both renderers."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import OpenGLRenderer, Renderer, ViewWeights
from support.pinholes import OPACITY, crumpled, eyes, painted


@pytest.mark.parametrize("sheets", [True, False], ids=["sheets", "opaque"])
@pytest.mark.parametrize("opengl", [False, True], ids=["software", "opengl"])
def test_a_thousand_eyes_see_no_pinhole(request, sheets, opengl):
    scene, part = painted(sheets), OPACITY if sheets else 1
    renderer = OpenGLRenderer(scene, context=request.getfixturevalue("context")) if opengl else Renderer(scene)
    wrong = 0
    for camera in eyes():
        picture = renderer.draw(camera, ViewWeights(), background=(1.0,))
        wrong += (np.abs(picture.coverage - part) > 1e-3).sum() + (np.abs(picture.image - (1 - part)) > 5e-3).sum()
    assert wrong == 0


def test_visibility_has_no_pinhole():
    mesh = crumpled()
    assert all((rasterise_view(mesh, camera).face >= 0).all() for camera in eyes())
