"""Exposures that a fit brings together: found where they pay, and fitted to."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from eigenfield.core.proxy import Proxy
from eigenfield.encoding import left_out
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.exposures import fit_exposures
from eigenfield.encoding.fitted.fit import fit_mean
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import open_fit_data, open_subsampled
from eigenfield.encoding.fitted.solve import measure_scales
from eigenfield.encoding.views import make_rig
from eigenfield.rendering import draw_texture
from support.captures import backdrop, shaded_texture
from support.observations import InMemory
from support.scenes import row_grid

CAMERAS = row_grid(9, 64, 56)
GAINS = np.array([0.8, 0.95, 1.1, 1.05, 0.9, 1.2, 1.0, 0.85, 1.15])[:, None] * (1, 1.05, 0.95)
GAINS /= np.exp(np.log(GAINS).mean(axis=0))
OFFSETS = np.array([0.02, -0.01, 0.0, 0.03, -0.03, 0.01, -0.02, 0.015, -0.015])[:, None] * (1.0, 0.5, -1.0)
OFFSETS -= OFFSETS.mean(axis=0)


@pytest.fixture(scope="module")
def pictures():
    """Of a surface that looks the same from everywhere, in one exposure."""
    return [0.15 + 0.6 * draw_texture(backdrop(), shaded_texture(0, 9), camera, samples=2).image for camera in CAMERAS]


@pytest.fixture(scope="module")
def exposed(pictures):
    """The same in exposures of their own."""
    return [(picture - o) / g for picture, g, o in zip(pictures, GAINS, OFFSETS, strict=True)]


def plan_of(photographs, harmonise=None):
    rig = make_rig([f"{index}" for index in range(9)], CAMERAS, np.zeros(9, bool), 4)
    views = SimpleNamespace(
        rig=rig,
        observations=InMemory([p.astype(np.float32) for p in photographs]),
    )
    return SimpleNamespace(options=SimpleNamespace(harmonise=harmonise), views=views, proxy=Proxy(backdrop()))


def test_known_exposures_are_found_where_they_pay(exposed, monkeypatch):
    assert fit_exposures(plan_of(exposed)) is None, "small photographs are not tried"
    monkeypatch.setattr(left_out, "BETWEEN_MIN_SIDE_PIXELS", 32)
    found = fit_exposures(plan_of(exposed))
    np.testing.assert_allclose(found[:, 0], GAINS, rtol=0.01)
    np.testing.assert_allclose(found[:, 1], OFFSETS, atol=0.004)
    np.testing.assert_allclose(np.log(found[:, 0]).mean(axis=0), 0, atol=1e-3)
    np.testing.assert_allclose(found[:, 1].mean(axis=0), 0, atol=1e-3)


def test_equal_exposures_stay(pictures, monkeypatch):
    monkeypatch.setattr(left_out, "BETWEEN_MIN_SIDE_PIXELS", 32)
    assert fit_exposures(plan_of(pictures)) is None
    shone = [0.9 * draw_texture(backdrop(), shaded_texture(k, 9), camera).image for k, camera in enumerate(CAMERAS)]
    assert fit_exposures(plan_of(shone)) is None, "a highlight that wanders is no exposure"


def test_what_is_asked_for_is_done(pictures, exposed):
    assert fit_exposures(plan_of(exposed, "none")) is None
    np.testing.assert_allclose(fit_exposures(plan_of(pictures, "affine"))[:, 0], 1, atol=0.003)
    assert not fit_exposures(plan_of(exposed, "gain"))[:, 1].any()


def test_a_fit_is_to_the_common_exposure(exposed):
    colours = np.stack([GAINS, OFFSETS], axis=1).astype(np.float32)

    def left(given):
        with open_fit_data(CAMERAS, InMemory(exposed), Proxy(backdrop()), (64, 64), colours=given) as data:
            model = PlaneModel.grey(split_matrix()[0], (64, 64))
            found = fit_mean(data, model, measure_scales(data, model), 4)
            return np.sqrt(found.squares.sum() / found.pixels.sum())

    assert left(colours) < 0.25 * left(None)


def test_photographs_in_the_common_exposure(pictures, exposed):
    colours = np.stack([GAINS, OFFSETS], axis=1).astype(np.float32)
    luma = split_matrix()[0]
    with (
        open_fit_data(CAMERAS, InMemory(exposed), Proxy(backdrop()), (64, 64), colours=colours) as data,
        open_subsampled(data, 2) as some,
    ):
        for index, picture in enumerate(pictures):
            drawn, inside = data.target(index, luma)[0], data.footprint(index)[0] == 1
            np.testing.assert_allclose(drawn[inside], (picture @ luma[0])[inside], atol=0.6 / 255)
            assert set(np.unique(some.target(index, luma))) <= set(np.unique(data.target(index, luma)))
        weights = np.array([data.observations.weights(index).max() for index in range(9)])
        assert weights.max() == 255 and (np.argsort(-weights)[:2] == np.argsort(GAINS.mean(axis=1))[:2]).all()
        np.testing.assert_allclose(weights / 255, ((1 / GAINS**2).mean(1) / (1 / GAINS**2).mean(1).max()), atol=0.003)
        assert data.white(luma) == pytest.approx(float(((GAINS + OFFSETS) @ luma[0]).max()), abs=1e-6)
