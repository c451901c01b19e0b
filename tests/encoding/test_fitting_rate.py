"""encoding/fitted/rate.py: components are coded while they take off more error than their bytes would elsewhere."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from eigenfield.coding.pictures.pictures_10bit import CODER, PATIENT_CODER, svt_coder
from eigenfield.encoding.fitted import planes, rate
from eigenfield.encoding.fitted.code_planes import code_basis
from eigenfield.encoding.fitted.model import Block
from eigenfield.encoding.fitted.rate import Rate, code_block_rd, lambda_of_step, plane_lambda
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.encoding.options import PRESETS

SIZE, CAMERAS, STEP = (48, 64), 8, 0.03
FAST = svt_coder(8)


@pytest.fixture(scope="module")
def made() -> tuple[Block, Scales]:
    """Four components, each half as strong as the one before, of blobs a few texels wide; ten pixels see each texel."""
    rng = np.random.default_rng(5)
    noise = rng.normal(0, 1, (4, 1, *SIZE)).astype(np.float32)
    soft = np.stack([cv2.GaussianBlur(one[0], (0, 0), 2.0)[None] for one in noise])
    strength = 0.2 / soft.std() * 0.5 ** np.arange(4, dtype=np.float32)
    block = Block((0, SIZE[0], 0, SIZE[1]), soft * strength[:, None, None, None], np.ones((CAMERAS, 4), np.float32))
    share = np.full(SIZE, 10.0, np.float32)
    return block, Scales.opaque(share, share, (0.0, 0.0))


def costs(block: Block, scales: Scales, lambda_: float) -> list[float]:
    """Squared error + lambda x bytes with 0 to all components, written out."""
    coded = code_basis(rate._basis_of(block, SIZE), STEP, FAST)
    values = coded.basis.values().transpose(0, 3, 1, 2)
    sizes = [len(one.data) / one.count for one in coded.pictures for _ in range(one.count)]
    totals = []
    for count in range(block.count + 1):
        drawn = np.zeros_like(block.textures)
        drawn[:count] = values[:count]
        error = float((np.square(block.textures - drawn) * scales.coarse).sum())
        totals.append(error + lambda_ * (sum(sizes[:count]) + count * rate.RATE_WEIGHT_BYTES * CAMERAS))
    return totals


def test_as_many_components_are_coded_as_cost_least(made):
    block, scales = made
    counts = []
    for lambda_ in np.geomspace(1e-4, 300, 12):
        coded = code_block_rd(block, SIZE, scales, Rate(STEP, STEP, FAST, FAST), lambda_)
        assert coded.count == np.argmin(costs(block, scales, lambda_))
        counts.append(coded.count)
    assert counts == sorted(counts, reverse=True) and counts[0] == block.count and counts[-1] == 0
    assert len(set(counts)) > 2


def test_a_faster_coder_only_chooses_the_components(made):
    block, scales = made
    lambda_ = next(one for one in np.geomspace(1e-4, 3, 30) if 0 < np.argmin(costs(block, scales, one)) < block.count)
    chosen = code_block_rd(block, SIZE, scales, Rate(STEP, STEP, svt_coder(6), FAST), lambda_)
    count = chosen.count
    few = Block(block.rectangle, block.textures[:count], block.weights[:, :count])
    patient = code_basis(rate._basis_of(few, SIZE), STEP, svt_coder(6))
    assert [one.data for one in chosen.pictures] == [one.data for one in patient.pictures]


def test_what_a_byte_of_the_mean_takes_off(made):
    _, scales = made
    assert plane_lambda(scales, Rate(STEP, STEP, FAST, FAST)) == pytest.approx(lambda_of_step(STEP) * 10)
    half_seen = Scales.opaque(
        scales.mean * np.tile([0, 1], (SIZE[0], SIZE[1] // 2)).astype(np.float32), scales.coarse, (0, 0)
    )
    assert plane_lambda(half_seen, Rate(STEP, STEP, FAST, FAST)) == pytest.approx(lambda_of_step(STEP) * 10)
    assert plane_lambda(Scales.opaque(scales.mean * 0, scales.coarse, (0, 0)), Rate(STEP, STEP, FAST, FAST)) == 0


def test_before_cameras_in_no_array_only_the_components_of_chroma_are_coarser():
    for plane in planes.PLANE_PRESETS:
        array, scattered = plane.rate(STEP), plane.rate(STEP, scattered=True)
        assert scattered.mean_step == array.mean_step
        assert (scattered.texture_step > array.texture_step) == (plane.name == "chroma")
        assert plane.rate(STEP, soft=True, scattered=True) == plane.rate(STEP, soft=True)


def test_the_best_preset_alone_is_patient():
    assert [name for name, preset in PRESETS.items() if preset.patient] == ["best"]
    for plane in planes.PLANE_PRESETS:
        assert plane.rate(STEP).coder is CODER and plane.rate(STEP, patient=True).coder is PATIENT_CODER
