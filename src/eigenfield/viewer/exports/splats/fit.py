"""The colours of Gaussians, fitted by least squares to what a scene draws in its array's cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.imaging.colour import as_rgb
from eigenfield.imaging.sampling import distances_to, farthest_points
from eigenfield.rendering import camera_weights, renderer_of
from eigenfield.runtime.parallel import parallel_map
from eigenfield.viewer.exports.splats.gaussians import (
    SH_DEGREE,
    SH_ZERO,
    Footprint2D,
    Gaussians,
    footprint_of,
    harmonics_of,
)
from eigenfield.viewer.exports.splats.place import place_gaussians

FIT_PIXELS = 8_000_000  # in all pictures that the colours are fitted to
FIT_MIN_CAMERAS, FIT_MAX_CAMERAS = 9, 16
FIT_ROUNDS = 6
HARMONICS_RIDGE = 2e-4  # of the weight of a Gaussian: what holds degrees 1 and 2 back where cameras do not tell them
HARMONICS_MOST = 0.96  # of a coefficient of these: files of 8 bits hold less than 1


def fit_gaussians(scene: Scene, count: int | None = None, progress: Progress | None = None) -> tuple[Gaussians, float]:
    """Gaussians that look like a scene.

    Args:
        count: As of `place_gaussians`.

    Returns:
        The Gaussians, and their PSNR in dB beside what the scene draws in the cameras that they were fitted to.
    """
    chosen = _cameras(scene)
    cameras = [scene.rig.cameras[index] for index in chosen]
    pictures = parallel_map(lambda index: _picture(scene, index), chosen)
    gaussians = place_gaussians(scene, cameras, count)
    return _fitted(gaussians, cameras, pictures, capture_to_gltf(scene.rig), progress)


def _cameras(scene: Scene) -> list[int]:
    """Encoded cameras that stand far from each other, the one nearest to their middle first."""
    encoded = scene.rig.encoded
    centres = np.array([scene.rig.cameras[index].centre for index in encoded])
    size = max(scene.rig.cameras[index].width * scene.rig.cameras[index].height for index in encoded)
    count = int(np.clip(FIT_PIXELS // size, FIT_MIN_CAMERAS, FIT_MAX_CAMERAS))
    first = int(np.linalg.norm(centres - centres.mean(axis=0), axis=1).argmin())
    return np.sort(encoded[farthest_points(distances_to(centres), first, count)]).tolist()


def _picture(scene: Scene, index: int) -> NDArray[np.float32]:
    """(H, W, 3) what a scene draws in a camera, on black."""
    return as_rgb(renderer_of(scene).draw(scene.rig.cameras[index], camera_weights(scene, index)).image.clip(0, 1))


@dataclass(frozen=True, eq=False)
class _View:
    """What a camera sees of the Gaussians, and what it should see.

    Attributes:
        basis: (N, k) the harmonics of the directions that it sees them in, but for what is common to all cameras.
        picture: (H, W, 3).
    """

    footprint: Footprint2D
    basis: NDArray[np.float32]
    picture: NDArray[np.float32]

    def lacks(self, gaussians: Gaussians) -> tuple[NDArray[np.float32], float]:
        """(N, 4) what each Gaussian's pixels lack, of `Footprint2D.gather`, and the squared error of all pixels."""
        rest = self.picture - self.footprint.draw(gaussians.colours(self.basis))
        return self.footprint.gather(rest), float(np.square(rest, dtype=np.float64).sum())


def _fitted(
    gaussians: Gaussians, cameras: Sequence[Camera], pictures: Sequence[NDArray[np.float32]],
    turn: NDArray[np.float64], progress: Progress | None,
) -> tuple[Gaussians, float]:  # fmt: skip
    """Each round draws the Gaussians and gives each what its pixels lack (SIRT: Gilbert, "Iterative methods for the
    three-dimensional reconstruction of an object from projections", 1972), with the momentum of Nesterov. What a
    Gaussian lacks in each camera becomes harmonics by least squares; a ridge holds those above degree 0 back.

    What is common to all cameras is left to degree 0: the other coefficients are orthogonal to the mean of their
    harmonics over the cameras. Otherwise large ones of both signs would cancel, which files of 8 bits cannot hold.
    """
    bases = [harmonics_of((gaussians.positions - camera.centre) @ turn.T, SH_DEGREE) for camera in cameras]
    common = np.mean(bases, axis=0)
    common[:, 0] = 0
    common /= np.maximum(np.linalg.norm(common, axis=1, keepdims=True), 1e-6)
    footprints = parallel_map(lambda camera: footprint_of(gaussians, camera), cameras)
    views = [
        _View(footprint, basis - (basis * common).sum(axis=1, keepdims=True) * common, picture)
        for footprint, basis, picture in zip(footprints, bases, pictures, strict=True)
    ]
    harmonics = np.zeros((len(gaussians), common.shape[1], 3), np.float32)
    harmonics[:, :1] = gaussians.harmonics
    before = harmonics
    for number in track(range(FIT_ROUNDS), "fitting splats", FIT_ROUNDS, progress):
        leap = harmonics + np.float32(max(number - 1, 0) / (number + 2)) * (harmonics - before)
        shown = replace(gaussians, harmonics=leap)
        found = [sums for sums, _ in parallel_map(lambda view: view.lacks(shown), views)]  # noqa: B023
        if number == 0:
            inverse, ridge = _normal_inverse(
                [(view.basis, sums[:, 3]) for view, sums in zip(views, found, strict=True)]
            )
        lacks = -ridge[..., None] * leap
        for view, sums in zip(views, found, strict=True):
            lacks += view.basis[:, :, None] * sums[:, None, :3]
        before, harmonics = harmonics, _bounded(leap + inverse @ lacks)
    shown = replace(gaussians, harmonics=harmonics)
    error = sum(error for _, error in parallel_map(lambda view: view.lacks(shown), views))
    return shown, float(10 * np.log10(sum(picture.size for picture in pictures) / max(error, 1e-12)))


def _bounded(harmonics: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, k, 3) with a mean colour within 0..1, and the others made smaller where one is above `HARMONICS_MOST`."""
    mean = harmonics[:, :1].clip(-0.5 / SH_ZERO, 0.5 / SH_ZERO)
    largest = np.abs(harmonics[:, 1:]).max(axis=1, keepdims=True)
    others = harmonics[:, 1:] * (HARMONICS_MOST / np.maximum(largest, HARMONICS_MOST))
    return np.concatenate([mean, others], axis=1)


def _normal_inverse(
    views: Sequence[tuple[NDArray[np.float32], NDArray[np.float32]]],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(N, k, k) the inverse of the normal matrix of each Gaussian's harmonics, and (N, k) its ridge.

    Args:
        views: Of each camera the harmonics (N, k) and the sum of weights (N,).
    """
    count = views[0][0].shape[1]
    normal, ridge = np.zeros((len(views[0][0]), count, count), np.float32), np.full((len(views[0][0]), count), 1e-6)
    for basis, weights in views:
        normal += weights[:, None, None] * (basis[:, :, None] * basis[:, None, :])
        ridge[:, 1:] += HARMONICS_RIDGE * weights[:, None]
    normal += ridge[:, :, None] * np.eye(count)
    return np.linalg.inv(normal).astype(np.float32), ridge.astype(np.float32)
