"""A group the paper's way: each frame's photographs projected into texture maps, whose decomposition all frames share.

Equations 1 and 2 are of a frame: its maps have a mean of their own, and what a camera does not see deviates by nothing.
Equations 3 to 6 are of the group: the inner products of all frames' deviations are added. Nothing is fitted in the
pictures, and weights and means are coded as they are.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.atlas import Atlas, make_atlas
from eigenfield.encoding.clip.frames import Arrays, GroupFrames
from eigenfield.encoding.clip.open_loop import OpenGroup, SharedWeights
from eigenfield.encoding.projected.eigen import eigen_textures, eigenvectors, gram_matrix, weights_of
from eigenfield.encoding.projected.mean import Mean, mean_map
from eigenfield.encoding.projected.project import TextureMaps, texture_maps
from eigenfield.encoding.spread import make_spreader


def project_group(group: GroupFrames) -> OpenGroup:
    """Mean and eigen textures of each frame in all planes, for weights that are the same in all of them.

    Maps are made twice, once for the weights and once for the textures: those of all frames would take 13 bytes a
    texel, camera and frame.
    """
    clip = group.clip
    atlas, count = make_atlas(clip.plan.mesh, *clip.plan.atlas), clip.planes[0].settings.textures

    def products(number: int, _: Path | None) -> Arrays:
        with _maps(group, atlas, number) as (maps, mean):
            return {"gram": gram_matrix(maps, mean)}

    done = group.run_frames("inner-products", products)
    weights = weights_of(eigenvectors(done.total("gram")), count)

    def textures(number: int, _: Path | None) -> Arrays:
        found: dict[str, NDArray[np.float32]] = {}
        with _maps(group, atlas, number) as (maps, mean):
            spreader = make_spreader(atlas, mean.seen)
            average, each = spreader(mean.values), [spreader(one) for one in eigen_textures(maps, mean, weights)]
        for plane, one in enumerate(clip.planes):
            settings = one.settings
            found[f"mean{plane}"] = _channels(average, settings.matrix, settings.mean)
            found[f"textures{plane}"] = np.stack([_channels(own, settings.matrix, settings.grid) for own in each])
        return found

    shared = SharedWeights(weights, np.eye(count, dtype=np.float32))
    return OpenGroup(group.run_frames("textures", textures, after=done), (shared,) * len(clip.planes))


@contextlib.contextmanager
def _maps(group: GroupFrames, atlas: Atlas, number: int) -> Iterator[tuple[TextureMaps, Mean]]:
    """The texture maps of a frame, and their mean."""
    with texture_maps(atlas, group.clip.cameras, group.observations(number), work=group.clip.work) as maps:
        yield maps, mean_map(maps)


def _channels(picture: NDArray[np.float32], matrix: NDArray[np.float32], size: tuple[int, int]) -> NDArray[np.float32]:
    """(C, rows, columns) of a picture (H, W, 3) of R, G, B, by a matrix (C, 3); averaged where it has fewer texels."""
    resized = cv2.resize(picture @ matrix.T, size[::-1], interpolation=cv2.INTER_AREA)
    return np.ascontiguousarray(resized.reshape(*size, len(matrix)).transpose(2, 0, 1), np.float32)
