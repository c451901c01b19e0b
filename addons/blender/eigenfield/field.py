"""What a folder of `eigenfield export --as obj` holds: the textures of a scene, and what of them a place takes."""

import json

import bpy
import numpy as np

from .program import RefusalError

LISTING = "eigenfield.json"
CHUNK = 1 << 14  # texels that stay in a processor's cache while textures are summed


class Field:
    """What a folder holds: texture = mean + sum of weight * (code - zero) * scale, rows from the bottom as Blender's.

    mean: (H W, 4) float32, the fourth the opacity. codes: (H W, C) uint8 of each eigen texture, C 1 where it is grey.
    weights: (cameras, textures).
    """

    def read(self, folder):
        """Fill it, one picture at a time; yields what part is read."""
        self.listing = json.loads((folder / LISTING).read_text(encoding="utf-8"))
        entries = self.listing["textures"]
        mean, self.size = read_pixels(inside(folder, self.listing["mean"]))
        self.mean, self.codes = mean.reshape(-1, 4), []
        room = np.empty_like(mean)  # new memory for each picture costs more than to decode it
        for entry in entries:
            yield len(self.codes) / len(entries)
            self.codes.append(codes_of(inside(folder, entry["file"]), len(entry["scale"]), room))
        self.weights = np.array(list(self.listing["weights"].values()), np.float32)
        self.places = np.array(self.listing["places"], float)
        self.triangles = np.array(self.listing["triangles"], int).reshape(-1, 3)

    def place(self, point):
        """View-plane coordinates, from -1 to 1, of a point in OBJ's axes."""
        plane = self.listing["viewPlane"]
        extent = np.array(plane["extent"])
        away = np.array([plane["right"], plane["up"]]) @ np.subtract(point, plane["origin"])
        return np.divide(away, extent, out=np.zeros(2), where=extent > 0).clip(-1, 1)

    def texture(self, place):
        """(H W, 4) float32, from 0 to 1."""
        among, parts = between(place, self.places, self.triangles)
        steps, away = [], np.zeros(1, np.float32)
        for weight, entry in zip(parts @ self.weights[among], self.listing["textures"], strict=True):
            steps.append((weight * np.array(entry["scale"])).astype(np.float32))
            away = away + steps[-1] * np.array(entry["zero"], np.float32)
        texture = self.mean.copy()
        for first in range(0, len(texture), CHUNK):
            chunk = slice(first, first + CHUNK)
            colours = texture[chunk, :3] - away
            for codes, step in zip(self.codes, steps, strict=True):
                colours += codes[chunk] * step
            texture[chunk, :3] = colours
        return texture.clip(0, 1, out=texture)


def read_field(folder):
    field = Field()
    for _ in field.read(folder):
        pass
    return field


def between(place, places, triangles):
    """What a place (2,) takes of places (n, 2): the corners of its triangle and its barycentric coordinates, outside of
    all triangles and on a line of cameras those of the nearest point.

    Returns: (k,) indices, (k,) weights that sum to 1.
    """
    if len(triangles):
        corners = places[triangles]
        a, b, p = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], place - corners[:, 0]
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        second = (p[:, 0] * b[:, 1] - p[:, 1] * b[:, 0]) / area
        third = (a[:, 0] * p[:, 1] - a[:, 1] * p[:, 0]) / area
        parts = np.stack([1 - second - third, second, third], axis=1)
        best = parts.min(axis=1).argmax()
        if parts[best].min() >= -1e-9:
            return triangles[best], parts[best]
        segments = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    elif len(places) > 1:
        spread = places - places.mean(axis=0)
        order = np.argsort(spread @ np.linalg.svd(spread)[2][0], kind="stable")
        segments = np.stack([order[:-1], order[1:]], axis=1)
    else:
        return np.zeros(1, int), np.ones(1)
    start, along = places[segments[:, 0]], places[segments[:, 1]] - places[segments[:, 0]]
    part = (((place - start) * along).sum(axis=1) / (along**2).sum(axis=1)).clip(0, 1)
    nearest = ((start + part[:, None] * along - place) ** 2).sum(axis=1).argmin()
    return segments[nearest], np.array([1 - part[nearest], part[nearest]])


def inside(folder, name):
    """A file that a listing names: nobody has another one read by giving a folder away."""
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise RefusalError(f"{folder / LISTING} names {name!r}, which is not in its folder")
    return path


def read_pixels(path, room=None):
    """(4 H W,) float32 from 0 to 1, and (width, height).

    room: Of that shape, written, if it fits.
    """
    image = bpy.data.images.load(str(path))
    try:
        image.colorspace_settings.name = "Non-Color"
        size = tuple(image.size)
        count = 4 * size[0] * size[1]
        pixels = np.empty(count, np.float32) if room is None or len(room) != count else room
        image.pixels.foreach_get(pixels)
        return pixels, size
    finally:
        bpy.data.images.remove(image)


def codes_of(path, channels, room):
    """(H W, channels) uint8. room: As of `read_pixels`."""
    pixels = read_pixels(path, room)[0]
    pixels *= 255
    pixels += 0.5
    return pixels.astype(np.uint8).reshape(-1, 4)[:, :channels].copy()
