"""No popping: on a way through the demo scene nothing jumps, except with the weights that are known to.

Weights that are continuous and made of smooth pieces have a largest slope L: from one frame to the next, a step s
apart, nothing changes by more than L s, and somewhere by nearly that. Half the step then halves the largest change. A
jump is as large at any step, and the ratio tends to 1.
"""

from __future__ import annotations

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.demo import draw_demo_capture
from eigenfield.gltf import save
from eigenfield.rendering import novel_camera, renderer_of, view_weights

pytestmark = pytest.mark.slow

ACROSS = np.array([[-0.83, -0.61], [0.87, 0.72]])  # slanted: through no camera, along no row
PIECE = np.array([[-0.2, -0.12], [0.3, 0.27]])  # of it, for the pictures


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    draw_demo_capture(folder / "capture", rows=5, columns=5, size=64)
    proxy = folder / "capture" / "proxy.ply"
    save(ef.encode(open_capture(folder / "capture"), proxy, textures=6, atlas=128, fit="none"), folder / "demo.glb")
    return ef.load(folder / "demo.glb")


def largest_change(draw, way, steps):
    """The largest root mean square change from frame to frame along a straight way of `steps` equal steps."""
    before, largest = None, 0.0
    for at in np.linspace(*way, steps + 1):
        now = draw((float(at[0]), float(at[1])))
        if before is not None:
            largest = max(largest, float(np.sqrt(np.square(now - before).mean())))
        before = now
    return largest


def ratio(draw, way, steps):
    return largest_change(draw, way, 2 * steps) / largest_change(draw, way, steps)


def textures_of(scene, mode):
    """The texture that equation 8 makes at each place."""
    return lambda at: renderer_of(scene).texture(view_weights(scene, at, mode))


def pictures_of(scene, mode):
    """The picture that the moving camera sees; with 12 x 12 samples a pixel, so that edges move smoothly too."""
    return lambda at: (
        renderer_of(scene).draw(novel_camera(scene, at).resize(32, 32), view_weights(scene, at, mode), samples=12).image
    )


@pytest.mark.parametrize("mode", ["delaunay", "bilinear"])
def test_half_the_step_is_half_the_change(scene, mode):
    assert ratio(textures_of(scene, mode), ACROSS, 100) < 0.52
    assert ratio(pictures_of(scene, mode), PIECE, 60) < 0.55


def test_the_three_nearest_cameras_jump(scene):
    """Equation 7 as printed: the third nearest changes along the way, and its weight with it."""
    assert ratio(textures_of(scene, "nearest3"), ACROSS, 100) > 0.8
    assert ratio(pictures_of(scene, "nearest3"), PIECE, 60) > 0.75
