"""The shading of one view: baked light, reflections of the room, and balls of chrome and glass that show the scene.

A ray from a ball follows at most a few mirrors and lenses until it meets a baked surface or the room. Nothing is
drawn at random, so there is no noise.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.demo.rays import glass_reflectance, mirror_ray, nearest_triangle, refract_ray, sphere_distance
from eigenfield.runtime.jit import kernel

SHADING_BOUNCES = 4  # balls that one ray meets
CHROME_REFLECTANCE = (0.80, 0.81, 0.83)  # at normal incidence
GLASS_ABSORPTION_PER_UNIT = (0.85, 0.22, 0.38)  # a tint of sea green
CHROME, GLASS = 0, 1  # rows of the spheres


@kernel()
def _surface_at(surface, s, t, value):
    """Bilinear interpolation of all channels, at texel (s, t)."""
    height, width = surface.shape[0], surface.shape[1]
    one = np.float32(1)
    s = min(max(s - 0.5, 0.0), width - 1.001)
    t = min(max(t - 0.5, 0.0), height - 1.001)
    u, v = int(s), int(t)
    fs, ft = np.float32(s - u), np.float32(t - v)
    w00, w01 = (one - fs) * (one - ft), fs * (one - ft)
    w10, w11 = (one - fs) * ft, fs * ft
    upper, lower = surface[v], surface[v + 1]
    for c in range(8):
        value[c] = w00 * upper[u, c] + w01 * upper[u + 1, c] + w10 * lower[u, c] + w11 * lower[u + 1, c]


@kernel()
def _add_room(room, layer, x, y, z, share, total):
    """Add (3,) shares of what the room is in a direction: bilinear in an octahedral map, which is the sphere projected
    onto |x| + |y| + |z| = 1, its lower half folded outwards."""
    one = np.float32(1)
    side = room.shape[1]
    shrink = one / (abs(x) + abs(y) + abs(z))
    ox, oz = x * shrink, z * shrink
    if y < 0:
        fold = (one - abs(oz)) if ox >= 0 else abs(oz) - one
        oz = (one - abs(ox)) if oz >= 0 else abs(ox) - one
        ox = fold
    s = (ox * np.float32(0.5) + np.float32(0.5)) * np.float32(side - 1)
    t = (oz * np.float32(0.5) + np.float32(0.5)) * np.float32(side - 1)
    u, v = min(int(s), side - 2), min(int(t), side - 2)
    fs, ft = s - np.float32(u), t - np.float32(v)
    w00, w01 = (one - fs) * (one - ft), fs * (one - ft)
    w10, w11 = (one - fs) * ft, fs * ft
    upper, lower = room[layer, v], room[layer, v + 1]
    for c in range(3):
        total[c] += share[c] * (w00 * upper[u, c] + w01 * upper[u + 1, c] + w10 * lower[u, c] + w11 * lower[u + 1, c])


@kernel()
def _add_surface(value, dx, dy, dz, room, share, scratch, total):
    """Add (3,) shares of the light that a baked surface sends against a direction of any length.

    Reflection: r = d - 2 (d.n) n; Schlick's F = F0 + (F90 - F0)(1 - cos)^5 with F90 = min(1, 12 F0), so that a
    reflectance of 0 gives none.
    """
    one = np.float32(1)
    nx, ny, nz = value[3], value[4], value[5]
    scale = one / np.sqrt((nx * nx + ny * ny + nz * nz) * (dx * dx + dy * dy + dz * dz))
    cosine = -(dx * nx + dy * ny + dz * nz)
    twice = np.float32(2) * cosine / (nx * nx + ny * ny + nz * nz)
    graze = one - min(max(cosine * scale, np.float32(0)), one)
    square = graze * graze
    fresnel = value[6] + (min(one, np.float32(12) * value[6]) - value[6]) * square * square * graze
    for layer in range(2):
        weight = fresnel * (value[7] if layer == 1 else one - value[7])
        if weight > np.float32(1e-4):
            for c in range(3):
                scratch[c] = share[c] * weight
            _add_room(room, layer + 1, dx + twice * nx, dy + twice * ny, dz + twice * nz, scratch, total)
    for c in range(3):
        total[c] += share[c] * value[c]


@kernel()
def _follow(origin, ray, share, spheres, boxes, triangles, around, room, work, total):
    """Add what a ray meets, by way of the balls that it meets first. `origin`, `ray` and `share` are changed."""
    stack, place, value, scratch = work
    for _ in range(SHADING_BOUNCES):
        ball, distance = -1, np.inf
        for k in range(spheres.shape[0]):
            reach = sphere_distance(origin, ray, spheres[k])
            if reach < distance:
                ball, distance = k, reach
        if nearest_triangle(boxes, triangles, origin, ray, distance, stack, place) < np.inf:
            _surface_at(around, place[0] * around.shape[1], place[1] * around.shape[0], value)
            x, y, z = np.float32(ray[0]), np.float32(ray[1]), np.float32(ray[2])
            _add_surface(value, x, y, z, room, share, scratch, total)
            return
        if ball < 0:
            break
        if ball == CHROME:
            _mirror(origin, ray, share, spheres[CHROME], distance)
        else:
            _pass(origin, ray, share, spheres[GLASS], distance)
    _add_room(room, 0, np.float32(ray[0]), np.float32(ray[1]), np.float32(ray[2]), share, total)


@kernel()
def _mirror(origin, ray, share, sphere, distance):
    """Reflect a ray off chrome."""
    graze = 1.0 - mirror_ray(origin, ray, sphere, distance)
    square = graze * graze
    for c in range(3):
        share[c] *= CHROME_REFLECTANCE[c] + (1.0 - CHROME_REFLECTANCE[c]) * square * square * graze


@kernel()
def _pass(origin, ray, share, sphere, distance):
    """Send a ray through glass."""
    cosine = 0.0
    for c in range(3):
        cosine -= ray[c] * (origin[c] + distance * ray[c] - sphere[c]) / sphere[3]
    passed = (1.0 - glass_reflectance(cosine)) ** 2
    chord = refract_ray(origin, ray, sphere, distance)
    for c in range(3):
        share[c] *= passed * np.exp(-GLASS_ABSORPTION_PER_UNIT[c] * chord)


@kernel()
def shade_view(face, maps, part, rays, centre, surface, around, boxes, triangles, spheres, room, samples, picture):
    """Shade one view in linear light, averaged over samples x samples points a pixel.

    Args:
        face: (s H, s W) from the rasteriser at s times the size.
        maps: (m, 3, 3) from its pixels (x, y, 1) to homogeneous texels, one for each triangle.
        part: (m,) the row of `spheres` that a triangle belongs to, -1 for a baked surface.
        rays: (3, 3) world direction of (x, y, 1), by columns.
        centre: (3,) of the camera.
        surface: (h, w, 8) diffuse radiance (3), world normal (3), reflectance at normal incidence, roughness 0..1.
        around: (h, w, 8) likewise, of what the balls show.
        boxes: Of the Tree of what the balls show.
        triangles: Of that Tree.
        spheres: (2, 4) centre and radius of the chrome and the glass ball.
        room: (3, e, e, 3) radiance over the octahedron: sharp, smooth and rough.
        samples: s.
        picture: (H, W, 3), written.
    """
    share, total, value = np.empty(3, np.float32), np.empty(3, np.float32), np.empty(8, np.float32)
    work = (np.empty(64, np.int64), np.empty(2), np.empty(8, np.float32), np.empty(3, np.float32))
    origin, ray = np.empty(3), np.empty(3)
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            total[:] = 0
            for sample in range(samples * samples):
                i = row * samples + sample // samples
                j = column * samples + sample % samples
                f = face[i, j]
                if f < 0:
                    continue
                x, y = j + 0.5, i + 0.5
                for c in range(3):
                    ray[c] = rays[c, 0] * x + rays[c, 1] * y + rays[c, 2]
                share[:] = 1
                if part[f] < 0:
                    m = maps[f]
                    q = 1.0 / (m[2, 0] * x + m[2, 1] * y + m[2, 2])
                    s = (m[0, 0] * x + m[0, 1] * y + m[0, 2]) * q
                    t = (m[1, 0] * x + m[1, 1] * y + m[1, 2]) * q
                    _surface_at(surface, s, t, value)
                    dx, dy, dz = np.float32(ray[0]), np.float32(ray[1]), np.float32(ray[2])
                    _add_surface(value, dx, dy, dz, room, share, work[3], total)
                    continue
                scale = 1.0 / np.sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2])
                for c in range(3):
                    origin[c] = centre[c]
                    ray[c] *= scale
                sphere = spheres[part[f]]
                distance = sphere_distance(origin, ray, sphere)
                if distance == np.inf:  # its outline, where a corner of the mesh is rounded outwards
                    distance = 0.0
                    for c in range(3):
                        distance += ray[c] * (sphere[c] - origin[c])
                if part[f] == GLASS:  # what it reflects and what is seen through it
                    mirrored = glass_reflectance(mirror_ray(origin, ray, sphere, distance))
                    share[:] = mirrored
                    _follow(origin, ray, share, spheres, boxes, triangles, around, room, work, total)
                    for c in range(3):
                        origin[c] = centre[c]
                        ray[c] = scale * (rays[c, 0] * x + rays[c, 1] * y + rays[c, 2])
                    share[:] = 1
                    _pass(origin, ray, share, sphere, distance)
                else:
                    _mirror(origin, ray, share, sphere, distance)
                _follow(origin, ray, share, spheres, boxes, triangles, around, room, work, total)
            for c in range(3):
                picture[row, column, c] = total[c] / np.float32(samples * samples)
