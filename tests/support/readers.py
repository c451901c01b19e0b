"""Readers of calibrated captures with the writers of their formats, and what a reader must get right."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eigenfield.capture import formats
from eigenfield.capture.photographs.lens import source_positions
from eigenfield.capture.readers.bundler import read_bundler
from eigenfield.capture.readers.deepview import read_deepview
from eigenfield.capture.readers.llff import read_llff
from eigenfield.capture.readers.metashape import read_metashape
from eigenfield.capture.readers.middlebury import read_middlebury
from eigenfield.capture.readers.nvm import read_nvm
from eigenfield.capture.readers.opencv import read_opencv
from eigenfield.capture.readers.projections import read_projections
from eigenfield.capture.readers.realitycapture import read_realitycapture
from eigenfield.capture.readers.strecha import read_strecha
from support import calibrations as write
from support.calibrations import CUBE, HEIGHT, WIDTH, stations

FINDERS = {row.name: row.find for row in formats.FORMATS if row.rank == formats.RANK_CAMERAS}


def write_llff(folder):
    write.photographs(folder / "images")
    return write.llff(folder, stations(square=True, centred=True))


def write_realitycapture(folder):
    write.photographs(folder / "images")  # whose sizes the CSV does not say
    return write.realitycapture(folder, stations(True, True))


WRITERS = {
    "deepview": (lambda folder: write.deepview(folder, stations()), read_deepview),
    "realitycapture": (write_realitycapture, read_realitycapture),
    "llff": (write_llff, read_llff),
    "middlebury": (lambda folder: write.middlebury(folder, stations()), read_middlebury),
    "strecha": (lambda folder: write.strecha(folder / "gt_dense_cameras", stations()), read_strecha),
    "bundler": (lambda folder: write.bundler(folder, stations(True, True)), read_bundler),
    "metashape": (lambda folder: write.metashape(folder, stations()), read_metashape),
    "opencv": (lambda folder: write.opencv_files(folder / "calib", stations()), read_opencv),
    "opencv-xml": (lambda folder: write.opencv_files(folder / "calib", stations(), kind="xml"), read_opencv),
    "easymocap": (lambda folder: write.easymocap(folder, stations()), read_opencv),
    "toml": (lambda folder: write.toml(folder, stations()), read_opencv),
    "nvm": (lambda folder: write.nvm(folder, stations(True, True)), read_nvm),
    "projections": (lambda folder: write.projections(folder, stations()), read_projections),
}
CENTRED = ("llff", "bundler", "nvm", "realitycapture")  # without a principal point here, and with square pixels
FORMATS = dict.fromkeys(("opencv-xml", "easymocap", "toml"), "opencv")


def stem(entry) -> str:
    return Path(entry.file).name.removesuffix(".png")


def check_cube(calibration, truth, tolerance=1e-6):
    """Every entry sees the cube where the station of its name does, at the photographs' size."""
    assert calibration.errors == ()
    by_name = {s.name.removesuffix(".png"): s for s in truth}
    assert sorted(map(stem, calibration.entries)) == sorted(by_name)
    for entry in calibration.entries:
        width, height = entry.intrinsics.width or WIDTH, entry.intrinsics.height or HEIGHT
        camera = entry.camera(width, height, calibration.path)
        pixels, depth = camera.project(CUBE)
        assert (depth > 0).all()
        scale = WIDTH / width
        assert np.abs(pixels * scale - by_name[stem(entry)].pixels(CUBE)).max() < tolerance
        assert np.abs(camera.centre - by_name[stem(entry)].eye).max() < tolerance
        assert camera.K[0, 1] == 0


def check_lens(entry, pixels_of, tolerance=2e-4):
    """Rays through the centres of pinhole pixels, projected in the format's own words, land where the map says."""
    camera = entry.camera(WIDTH, HEIGHT, Path("x"))
    assert entry.lens is not None
    x, y, inside = source_positions(camera.K, entry.lens, WIDTH, HEIGHT)
    rows, columns = np.mgrid[2:HEIGHT:9, 1:WIDTH:11]
    rays = np.linalg.solve(camera.K, np.stack([columns + 0.5, rows + 0.5, np.ones_like(rows)]).reshape(3, -1))
    points = camera.centre + (7.0 * rays).T @ camera.R
    expected = pixels_of(points) - 0.5
    found = np.stack([x[rows, columns], y[rows, columns]], axis=-1).reshape(-1, 2)
    assert np.abs(found - expected).max() < tolerance
    assert inside[HEIGHT // 2, WIDTH // 2]
