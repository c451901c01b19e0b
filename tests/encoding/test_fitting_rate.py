"""fitting/rate.py: textures are coded at another step where error and bytes are less, by two prices."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from eigenfield.coding.pictures.pictures_10bit import svt_coder
from eigenfield.encoding.fitted import rate
from eigenfield.encoding.fitted.code_planes import code_basis, code_mean
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.planes import PLANE_PRESETS
from eigenfield.encoding.fitted.rate import Lambdas, Rate, code_block_rd, lambda_of_step, measure_lambda
from eigenfield.encoding.fitted.solve import Scales

SIZE, CAMERAS, STEP = (48, 64), 8, 0.03


@pytest.fixture(scope="module")
def made() -> tuple[Block, PlaneModel, Scales]:
    """Four components, each half as strong as the one before, of blobs a few texels wide; each texel of the mean is
    seen in ten pixels."""
    rng = np.random.default_rng(5)
    noise = rng.normal(0, 1, (5, 1, *SIZE)).astype(np.float32)
    soft = np.stack([cv2.GaussianBlur(one[0], (0, 0), 2.0)[None] for one in noise])
    soft /= soft.std()
    strength = 0.2 * 0.5 ** np.arange(4, dtype=np.float32)
    block = Block((0, SIZE[0], 0, SIZE[1]), soft[:4] * strength[:, None, None, None], np.ones((CAMERAS, 4), np.float32))
    model = PlaneModel(np.eye(1, 3, dtype=np.float32), 0.5 + 0.1 * soft[4], SIZE, [block])
    share = np.full(SIZE, 10.0, np.float32)
    return block, model, Scales(share, share, (0.0, 0.0))


def left(block: Block, scales: Scales, step: float, price: float) -> float:
    """Squared error and the price of bytes with the best number of components, written out."""
    coded = code_basis(rate._basis_of(block, SIZE), step, rate.RATE_STEP_CODER)
    values = coded.basis.values().transpose(0, 3, 1, 2)
    sizes = [len(one.data) / one.count for one in coded.pictures for _ in range(one.count)]
    totals = []
    for count in range(block.count + 1):
        drawn = np.zeros_like(block.textures)
        drawn[:count] = values[:count]
        error = float((np.square(block.textures - drawn) * scales.coarse).sum())
        totals.append(error + price * (sum(sizes[:count]) + count * rate.RATE_WEIGHT_BYTES * CAMERAS))
    return min(totals)


def test_the_step_is_one_that_both_prices_find_cheaper(made):
    block, _, scales = made
    basis, chosen = rate._basis_of(block, SIZE), set()
    for predicted in np.geomspace(1e-4, 0.3, 7):
        for measured in (predicted / 3, predicted, predicted * 3):
            prices = predicted, measured
            cheaper = [
                factor
                for factor in rate.RATE_STEP_RATIOS
                if all(left(block, scales, STEP * factor, each) < left(block, scales, STEP, each) for each in prices)
            ]
            found = rate._best_factor(basis, block, scales, STEP, Lambdas(*prices))
            assert found == (cheaper or [1.0])[0]
            chosen.add(found)
    assert chosen == {1.0, *rate.RATE_STEP_RATIOS}  # dear bytes: coarser; cheap ones: finer


def test_textures_are_coded_at_the_step_that_was_found(made):
    block, _, scales = made
    found = {}
    for search in (False, True):
        coded = code_block_rd(block, SIZE, scales, Rate(STEP, STEP, svt_coder(8), search=search), Lambdas(1e-4, 1e-4))
        assert coded.count == block.count
        found[search] = coded
    finer = code_basis(rate._basis_of(block, SIZE), STEP / 1.2, svt_coder(8))
    assert [one.data for one in found[True].pictures] == [one.data for one in finer.pictures]
    usual = code_basis(rate._basis_of(block, SIZE), STEP, svt_coder(8))
    assert [one.data for one in found[False].pictures] == [one.data for one in usual.pictures]


def test_what_a_byte_of_the_mean_takes_off_is_measured(made):
    _, model, scales = made
    found = measure_lambda(model, scales, Rate(STEP, STEP, svt_coder(8), search=True))
    assert found.predicted == pytest.approx(lambda_of_step(STEP) * 10)
    values = np.ascontiguousarray(model.mean.transpose(1, 2, 0))
    errors, sizes = [], []
    for step in (STEP / 1.25, STEP * 1.25):
        kept, file = code_mean(values, step, svt_coder(8))
        errors.append(10 * float(np.square(kept.astype(np.float64) - values).sum()))
        sizes.append(len(file.data))
    slope = (errors[1] - errors[0]) / (sizes[0] - sizes[1])
    assert found.measured == pytest.approx(np.clip(slope, found.predicted / 4, found.predicted * 4), rel=1e-4)
    assert found.measured != pytest.approx(found.predicted, rel=0.01)


def test_nothing_is_measured_where_nothing_is_looked_for(made):
    block, model, scales = made
    for plain in (
        measure_lambda(model, scales, Rate(STEP, STEP, svt_coder(8))),
        measure_lambda(
            PlaneModel(model.matrix, model.mean, SIZE, []), scales, Rate(STEP, STEP, svt_coder(8), search=True)
        ),
    ):
        assert plain.measured == plain.predicted
    flat = PlaneModel(model.matrix, np.full_like(model.mean, 0.5), SIZE, [block])  # of as many bytes at either step
    even = measure_lambda(flat, scales, Rate(STEP, STEP, svt_coder(8), search=True))
    assert even.measured == even.predicted


def test_luma_is_searched_where_cameras_are_many():
    luma, chroma = PLANE_PRESETS["luma-chroma"]
    assert luma.rate(0.01).search
    assert not luma.rate(0.01, few=True).search and not chroma.rate(0.01).search
