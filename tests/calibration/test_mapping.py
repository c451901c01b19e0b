"""What is kept of a sparse model."""

from __future__ import annotations

import pytest

from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.mapping import _adjust_and_filter


@pytest.mark.parametrize(
    ("focal", "distortion", "fixed", "kept"),
    [
        (400.0, 0.05, False, 6),
        (30.0, 0.05, False, 0),  # less than a tenth of the longer side
        (400.0, 1.2, False, 0),
        (30.0, 0.05, True, 6),  # a lens that is given is believed
    ],
)
def test_views_of_a_lens_that_cannot_be_are_dropped(focal, distortion, fixed, kept):
    options = pycolmap.SyntheticDatasetOptions()
    options.num_rigs, options.num_cameras_per_rig, options.num_frames_per_rig, options.num_points3D = 1, 1, 6, 60
    options.camera_model_id = pycolmap.CameraModelId.SIMPLE_RADIAL
    options.camera_width, options.camera_height = 400, 300
    options.camera_params = [focal, 200, 150, distortion]
    options.sensor_from_rig_translation_stddev = options.sensor_from_rig_rotation_stddev = 0.0
    pycolmap.set_random_seed(0)
    model = pycolmap.synthesize_dataset(options)
    _adjust_and_filter(model, fixed)
    assert model.num_reg_images() == kept
