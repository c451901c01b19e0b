"""The paper, Light Field Compression using Eigen Textures, in thirty lines of NumPy: its equations 1 to 8.

`eigenfield` projects the photographs into texture maps, and all else stands here. tests/reference.py has the same
functions, and the fast ones of the package are held against them.

python examples/03_the_paper.py [FOLDER]
"""

from __future__ import annotations

import numpy as np
from PIL import Image

import data
import eigenfield as ef

place = data.folder()
capture = data.capture(place)
scene = ef.encode(capture, capture / "proxy.ply", fit="none", textures=5, atlas=128, keep_maps=place / "maps")


def pictures(ending: str) -> np.ndarray:
    """(Nc, n, C) of all cameras, from 0 to 1."""
    found = [np.asarray(Image.open(path)) / 255 for path in sorted((place / "maps").glob(f"*{ending}"))]
    return np.stack(found).reshape(len(found), 128 * 128, -1)


v = (pictures(".seen.png")[..., :1] > 0.5).astype(float)  # visibility of a texel in a camera
T = pictures(".map.png") * v  # texture maps
N = 5

count = v.sum(axis=0)
mean = np.divide((T * v).sum(axis=0), count, out=np.zeros(T.shape[1:]), where=count > 0)  # equation 1
filled = np.where(v > 0, T, mean)  # equation 2: what a camera does not see comes from the mean
X = (filled - mean).reshape(len(T), -1)  # equations 3 to 5: deviations, a row for each camera
U, S, Vt = np.linalg.svd(X, full_matrices=False)  # equation 6
eigen, weights = Vt[:N] * S[:N, None], U[:, :N]  # N eigen textures, and the weights of each camera

places = scene.rig.view_plane.coordinates([camera.centre for camera in scene.cameras])
viewpoint = places[:4].mean(axis=0) + 0.01
nearest = np.argsort(np.linalg.norm(places - viewpoint, axis=1))[:3]
corners = np.vstack([places[nearest].T, np.ones(3)])
row = np.linalg.lstsq(corners, [*viewpoint, 1], rcond=None)[0] @ weights[nearest]  # equation 7: weights between cameras
texture = mean + np.tensordot(row, eigen, axes=1).reshape(mean.shape)  # equation 8: the texture of that viewpoint

Image.fromarray(np.rint(255 * texture.clip(0, 1)).astype(np.uint8).reshape(128, 128, 3)).save(place / "texture.png")
again = mean + np.tensordot(weights[0], eigen, axes=1).reshape(mean.shape)
error = np.sqrt(np.square(again - filled[0])[v[0, :, 0] > 0].mean())
print(f"{N} of {len(T)} eigen textures: {100 * (S[:N] ** 2).sum() / (S**2).sum():.1f} % of the variance")
print(f"the first camera's texture map comes back within {255 * error:.2f} grey levels")
