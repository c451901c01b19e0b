"""The paper's equations 1 to 8 in plain NumPy: slow, obvious, float64. Everything fast is held against this.

T: (Nc, n, C) texture maps, zero where not seen. v: (Nc, n) visibility, 0 or 1.
"""

from __future__ import annotations

import numpy as np


def mean_texture(T, v):
    """Equation 1: the mean over the cameras that see a texel; 0 where none does."""
    total = (T * v[..., None]).sum(axis=0)
    count = v.sum(axis=0)[:, None]
    return np.divide(total, count, out=np.zeros_like(total), where=count > 0)


def filled_maps(T, v):
    """Equation 2: what a camera does not see comes from the mean."""
    return np.where(v[..., None] > 0, T, mean_texture(T, v))


def decomposition(T, v, N):
    """Equations 3 to 6: subtract the mean, which gives X; its singular value decomposition; keep N.

    Returns the mean (n, C), eigen textures (N, n, C) and weights (Nc, N), the weights with unit mean square and their
    entry of largest magnitude positive.
    """
    mean = mean_texture(T, v)
    D = (filled_maps(T, v) - mean).reshape(len(T), -1)
    U, S, Vt = np.linalg.svd(D, full_matrices=False)
    U, S, Vt = U[:, :N], S[:N], Vt[:N]
    sign = np.where(U[np.abs(U).argmax(axis=0), np.arange(N)] < 0, -1.0, 1.0)
    scale = np.sqrt(len(T))
    return mean, (Vt * (S * sign)[:, None] / scale).reshape(N, *mean.shape), U * sign * scale


def barycentric(point, triangle):
    """The three weights of equation 7: coordinates of a viewpoint in a triangle of camera positions."""
    a, b, c = np.asarray(triangle, float)
    matrix = np.array([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [1, 1, 1]])
    return np.linalg.solve(matrix, [point[0], point[1], 1])


def nearest3_weights(point, positions, rows):
    """Equation 7: the texture weights at a viewpoint from the three nearest cameras."""
    nearest = np.argsort(np.linalg.norm(np.asarray(positions) - point, axis=1), kind="stable")[:3]
    return barycentric(point, np.asarray(positions)[nearest]) @ np.asarray(rows)[nearest]


def texture(mean, eigen, row):
    """Equation 8: mean plus weighted sum of eigen textures."""
    return mean + np.tensordot(row, eigen, axes=1)


def free_view(scene, camera):
    """(H, W, 3): equation 8 pixel by pixel for a camera anywhere, textures read bilinearly, black where nothing is.

    Equation 7 for each point of the surface: the ray from it to the camera meets the view plane at X, Y, and the
    Delaunay weights there are that point's own.
    """
    from eigenfield.imaging.raster import rasterise_view
    from eigenfield.rendering import view_weights

    face = rasterise_view(scene.proxy.mesh, camera).face
    rows, columns = np.nonzero(face >= 0)
    corners = scene.proxy.mesh.vertices.astype(float)[scene.proxy.mesh.faces[face[rows, columns]]]
    pixels = np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))])
    directions = (camera.R.T @ np.linalg.solve(camera.K, pixels)).T
    eye = camera.centre
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    reach = ((corners[:, 0] - eye) * normals).sum(1) / (directions * normals).sum(1)
    points = eye + reach[:, None] * directions
    # barycentric coordinates: the corners' sum makes the point, and they add up to 1
    corners, homogeneous = np.insert(corners, 3, 1.0, axis=2), np.insert(points, 3, 1.0, axis=1)
    part = (np.linalg.pinv(corners.transpose(0, 2, 1)) @ homogeneous[..., None])[..., 0]  # by least squares
    uv = (part[..., None] * scene.proxy.mesh.uv[scene.proxy.mesh.faces[face[rows, columns]]]).sum(1)

    plane = scene.rig.view_plane
    normal = np.cross(plane.right, plane.up)
    along = ((plane.origin - points) @ normal) / ((eye - points) @ normal)
    places = plane.coordinates(np.where(along[:, None] > 0, points + along[:, None] * (eye - points), eye))
    mean, basis = scene.appearance.planes[0].mean, scene.appearance.planes[0].bases[0]
    weights = np.stack([view_weights(scene, place).dense(scene.observations) for place in places]) @ basis.weights
    colours = bilinear(mean, uv)
    for j, eigen in enumerate(basis.values()):
        colours += weights[:, j, None] * bilinear(eigen, uv)
    picture = np.zeros((camera.height, camera.width, 3))
    picture[rows, columns] = np.clip(colours, 0, 1)
    return picture


def bilinear(texture, uv):
    """(n, C) of a texture (H, W, C) at (n, 2) u, v; the centre of the first texel is at half a texel."""
    height, width = texture.shape[:2]
    x, y = np.clip(uv[:, 0] * width - 0.5, 0, width - 1), np.clip(uv[:, 1] * height - 0.5, 0, height - 1)
    left, top = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    fx, fy = (x - left)[:, None], (y - top)[:, None]
    upper = (1 - fx) * texture[top, left] + fx * texture[top, left + 1]
    lower = (1 - fx) * texture[top + 1, left] + fx * texture[top + 1, left + 1]
    return (1 - fy) * upper + fy * lower


def finer(texture, size):
    """(h, w, C) made `size` = (H, W) by Catmull and Rom's cubic, texel centres on texel centres, borders repeated."""
    for axis, fine in enumerate(size):
        coarse = texture.shape[axis]
        x = (np.arange(fine) + 0.5) / fine * coarse - 0.5
        base = np.floor(x).astype(int)
        total = 0
        for tap in range(-1, 3):
            d = np.abs(x - (base + tap))
            weight = np.where(d < 1, 1.5 * d**3 - 2.5 * d**2 + 1, -0.5 * d**3 + 2.5 * d**2 - 4 * d + 2)
            shape = [1, 1, 1]
            shape[axis] = fine
            total = total + weight.reshape(shape) * np.take(texture, np.clip(base + tap, 0, coarse - 1), axis)
        texture = total
    return texture


def composite(scene, mix):
    """(H, W, D): what is drawn for view weights mix (No,): each plane's mean and sums made as fine as the finest,
    channels side by side, then joined by `to_rgb`."""
    channels = []
    for plane in scene.appearance.planes:
        total = finer(plane.mean.astype(float), scene.appearance.atlas)
        for basis in plane.bases:
            sum_ = np.zeros((*basis.size, plane.mean.shape[2]))
            (row, column), (height, width) = basis.corner, basis.textures.shape[1:3]
            inside = sum_[row : row + height, column : column + width]
            inside += np.tensordot(mix @ basis.weights, basis.values().astype(float), 1)
            total += finer(sum_, scene.appearance.atlas)
        channels.append(total)
    stacked = np.concatenate(channels, axis=2)
    return stacked if scene.appearance.to_rgb is None else stacked @ scene.appearance.to_rgb.T.astype(float)
