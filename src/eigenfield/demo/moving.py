"""The clip's scene: the still one, with moving parts, as one mesh of constant topology and texture coordinates.

Balls that turn are whole, in two charts. A face stays where some camera of the array sees it at some time. Pigments
and fine relief are made once, at rest, and go with their part; light, shadows and reflections are those of each time.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.demo.cameras import DEMO_FOCAL_WIDTHS, array_centre
from eigenfield.demo.capture import BALLS, Look
from eigenfield.demo.geometry import (
    ALL_PARTS,
    CHART_FRAME_PIXELS,
    CHROME_SPHERE,
    FRONT_POLAR_RADIANS,
    GLASS_SPHERE,
    MARBLE_SPHERE,
    ORANGE_SPHERE,
    VISIBLE_BLOCK_SIDES,
    DemoGeometry,
    SurfacePart,
    background_parts,
    ball_part,
    block_parts,
    cull_back_faces,
    grid_faces,
    jar_parts,
    join_parts,
    surroundings_parts,
)
from eigenfield.demo.lettering import POSTER
from eigenfield.demo.light import Shadows, environment_map
from eigenfield.demo.motion import SHEET_PLANE_Z_UNITS, lights_at, moved, moved_normals, shadows_at
from eigenfield.demo.rays import build_tree
from eigenfield.demo.surface import CLIP_FINISHES, Charts, Material, light_material
from eigenfield.runtime.parallel import parallel_map

CULL_TIMES = 24  # at which it is looked whether a face is seen
SHEET_CELLS = 14  # on each side
AROUND_ATLAS_SHARE = 0.75  # side of the atlas of what the balls show, over that of the surface


def moving_scene() -> DemoGeometry:
    """All that cameras see, at rest. What moves has few triangles: each vertex takes bytes in each frame."""
    balls = [
        *(ball_part("orange", ORANGE_SPHERE, 12, 32, np.pi / 2, behind=behind) for behind in (False, True)),
        *(ball_part("marble", MARBLE_SPHERE, 10, 26, np.pi / 2, behind=behind) for behind in (False, True)),
        ball_part("chrome", CHROME_SPHERE, 26, 64, FRONT_POLAR_RADIANS),
        ball_part("glass", GLASS_SPHERE, 13, 36, FRONT_POLAR_RADIANS),
    ]
    parts = [*background_parts(), *jar_parts(), *block_parts(VISIBLE_BLOCK_SIDES), _sheet_part(), *balls]
    return join_parts([part for part in map(_cull, parts) if len(part.faces)])


def moving_surroundings() -> DemoGeometry:
    """What the chrome and the glass ball show, at rest."""
    return join_parts([*surroundings_parts(), _sheet_part()])


def at_time(scene: DemoGeometry, time: float) -> DemoGeometry:
    """A scene whose parts are where they are at a time; faces and texture coordinates are those at rest.

    Args:
        scene: At rest.
        time: From 0 to 1, which is the whole turn.
    """
    label = np.zeros(len(scene.mesh.vertices), np.int64)
    label[scene.mesh.faces] = scene.part[:, None]
    rest = scene.mesh.vertices.astype(np.float64)
    vertices, normals = rest.copy(), scene.normals.copy()
    for number, name in enumerate(ALL_PARTS):
        own = label == number
        vertices[own] = moved(name, rest[own], time)
        normals[own] = moved_normals(name, rest[own], scene.normals[own], time)
    mesh = Mesh(vertices.astype(np.float32), scene.mesh.faces, scene.mesh.uv)
    return replace(scene, mesh=mesh, normals=normals)


class MovingLook:
    """What the views of a time share."""

    def __init__(self, side: int) -> None:
        """Make all that does not change.

        Args:
            side: Of the surface's atlas, in texels.
        """
        self.scene = moving_scene()
        self._around = moving_surroundings()
        self._baked = MovingSurface(self.scene, side)
        self._baked_around = MovingSurface(self._around, max(int(AROUND_ATLAS_SHARE * side), 64))

    def __call__(self, time: float) -> Look:
        """The look of a time from 0 to 1."""
        shadows = shadows_at(time)
        return Look(
            self._baked.at(time, shadows),
            self._baked_around.at(time, shadows),
            build_tree(at_time(self._around, time).mesh),
            environment_map(lights_at(time)),
            at_time(self.scene, time),
            np.array([(*moved(name, middle[None], time)[0], radius) for name, (middle, radius) in BALLS.items()]),
        )


class MovingSurface:
    """The atlas of a scene whose parts move: pigments stay, and the light on them changes."""

    def __init__(self, scene: DemoGeometry, side: int) -> None:
        """Make the materials.

        Args:
            scene: At rest.
            side: Texels.
        """
        self._charts = Charts(scene, side, CLIP_FINISHES)
        self._materials = parallel_map(self._charts.material, self._charts.pieces)

    def at(self, time: float, shadows: Shadows) -> NDArray[np.float32]:
        """(side, side, 8) as `bake_surface`.

        Args:
            time: From 0 to 1.
            shadows: Of that time.
        """
        surface = np.zeros((self._charts.side**2, 8), np.float32)

        def work(rest: Material) -> None:
            now = rest._replace(
                point=moved(rest.name, rest.point, time),
                normal=moved_normals(rest.name, rest.point, rest.normal, time),
            )
            surface[rest.texel] = light_material(now, shadows)

        parallel_map(work, self._materials)
        return self._charts.extended(surface)


def _cull(part: SurfacePart) -> SurfacePart:
    times = np.arange(CULL_TIMES) / CULL_TIMES
    return cull_back_faces(
        part,
        [(moved(part.name, part.vertices, time), moved_normals(part.name, part.vertices, part.outward, time))
         for time in times.tolist()],
    )  # fmt: skip


def _sheet_part() -> SurfacePart:
    """The printed sheet, flat before the wall."""
    steps = np.linspace(0, 1, SHEET_CELLS + 1)
    across, down = (grid.reshape(-1) for grid in np.meshgrid(steps * POSTER.width, steps * POSTER.height))
    points = np.column_stack([POSTER.left + across, POSTER.top - down, np.full(len(across), SHEET_PLANE_Z_UNITS)])
    scale = DEMO_FOCAL_WIDTHS * CHART_FRAME_PIXELS / float(np.linalg.norm(array_centre() - points.mean(axis=0)))
    normals = np.tile((0.0, 0.0, 1.0), (len(points), 1))
    faces = grid_faces(SHEET_CELLS + 1, SHEET_CELLS + 1)
    return SurfacePart("sheet", points, faces, normals, np.column_stack([across, down]) * scale, normals)
