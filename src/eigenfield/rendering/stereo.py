"""Two eyes on the view plane: pictures beside or above each other, flat, or on half a sphere each (VR180).

Eyes look the same way, with their x axis along the array's X. In flat pictures the principal points are shifted so that
what lies at the median depth of the scene has no parallax. On half a sphere they look in parallel, and what no
photograph showed is background.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.imaging.colour import as_rgb
from eigenfield.rendering.novel import novel_camera
from eigenfield.rendering.parallel_cameras import camera_towards, parallel_cameras
from eigenfield.rendering.render_jobs import RenderJob, png, write_numbered
from eigenfield.rendering.software.renderer import at_resolution
from eigenfield.rendering.spherical import vr_boxes
from eigenfield.rendering.video import write_video
from eigenfield.rendering.weights import view_weights
from eigenfield.runtime.files import is_numbered
from eigenfield.runtime.parallel import parallel_stream

STEREO_LAYOUTS = ("side-by-side", "top-bottom", "vr180")  # vr180: side by side
STEREO_PART, STEREO_DEGREES = 0.2, 3.0  # the most of the array's width, and as an angle, where nobody says a baseline
VR180_SIDE_STEP_PX, VR180_MAX_SIDE_PX = 16, 2880  # of one eye's picture


@dataclass(frozen=True)
class Baseline:
    """The distance between the eyes.

    Attributes:
        length: In parts of the array's width, or in metres.
    """

    length: float
    in_metres: bool = False

    def part(self, scene: Scene) -> float:
        """Of the array's width, above 0 and at most 1.

        Raises:
            OptionError: `baseline`: the eyes are in one place or wider apart than the array, or the scene does not know
                its metres.
        """
        width, unit = 2 * float(scene.rig.view_plane.extent[0]), scene.provenance.metres_per_unit
        if self.in_metres and unit is None:
            message, remedy = "the scene does not know its metres", "give a part of the array's width, as 0.2"
            raise OptionError("baseline", f"--baseline is in metres, and {message}", remedy=remedy)
        metres = 1000 * width * (unit or 0.0)
        part = self.length / (width * (unit or 1.0)) if self.in_metres and width else self.length
        if 0 < part <= 1 and width > 0:
            return part
        asked = f"{1000 * self.length:.4g} mm" if self.in_metres else f"{self.length:g} of the array's width"
        array = f", which is {metres:.4g} mm wide" if unit else ""
        message = f"eyes {asked} apart do not stand within the array{array}"
        raise OptionError("baseline", message, remedy="give more than 0 and at most 1, a part of the array's width")


@dataclass(frozen=True, eq=False)
class Eyes:
    """How two eyes see the scenes of one array.

    Attributes:
        layout: One of `STEREO_LAYOUTS`.
        part: The distance between the eyes, of the array's width.
        axes: (3, 3) rotation from the world to the eyes' axes: x along the array, y down, z forward.
        depth: From the view plane to what has no parallax, along z.
    """

    layout: str
    part: float
    axes: NDArray[np.float64]
    depth: float

    @staticmethod
    def of(scene: Scene, layout: str, baseline: Baseline | None = None) -> Eyes:
        """The eyes for a scene, or for all frames of the clip that it is of.

        Args:
            layout: One of `STEREO_LAYOUTS`.
            baseline: Default: what is easy on the eyes, and within the array.

        Raises:
            OptionError: `stereo`: there is no such layout; `baseline`; as `parallel_cameras`.
        """
        if layout not in STEREO_LAYOUTS:
            remedy = f"use one of {', '.join(STEREO_LAYOUTS)}"
            raise OptionError("stereo", f"no stereo is called {layout}", remedy=remedy)
        middle = novel_camera(scene, (0.0, 0.0))
        cameras = parallel_cameras(scene, (middle.width, middle.height))
        depth, extent = cameras.depth, float(scene.rig.view_plane.extent[0])
        if baseline is None:
            easy = depth * math.tan(math.radians(STEREO_DEGREES / 2))
            baseline = Baseline(min(STEREO_PART, easy / extent) if extent else STEREO_PART)
        return Eyes(layout, baseline.part(scene), cameras.R, depth)

    def reach(self, scene: Scene) -> tuple[float, float, float]:
        """Degrees, seen from what has no parallax: of the array's width and height, and between the eyes."""
        width, height = (2 * math.degrees(math.atan(extent / self.depth)) for extent in scene.rig.view_plane.extent)
        eyes = 2 * math.degrees(math.atan(self.part * float(scene.rig.view_plane.extent[0]) / self.depth))
        return width, height, eyes

    def said(self, scene: Scene) -> str:
        """The reach of the array in words; of half a sphere also how much of it the photographs fill."""
        width, height, apart = self.reach(scene)
        words = f"the array reaches {width:.1f} x {height:.1f} degrees, the eyes are {apart:.1f} apart"
        if self.layout != "vr180":
            return words
        seen = novel_camera(scene, (0.0, 0.0))
        sides = (
            2 * math.degrees(math.atan(side / (2 * f)))
            for side, f in ((seen.width, seen.K[0, 0]), (seen.height, seen.K[1, 1]))
        )
        return words + "; photographs fill {:.0f} x {:.0f} of 180 degrees".format(*sides)

    def pixels(self, job: RenderJob, at: tuple[float, float]) -> NDArray[np.uint8]:
        """(H, W, 1 to 4) uint8 of both eyes, the left one left or above.

        Args:
            at: The place between the eyes on the view plane; moved so that both stand within the array.
        """
        x, y = min(max(at[0], self.part - 1), 1 - self.part), at[1]
        draw = self._half_sphere if self.layout == "vr180" else self._flat
        both = [draw(job, (x, y), (eye, y)) for eye in (x - self.part, x + self.part)]
        return np.concatenate(both, axis=0 if self.layout == "top-bottom" else 1)

    def _flat(self, job: RenderJob, middle: tuple[float, float], eye: tuple[float, float]) -> NDArray[np.uint8]:
        scene = job.scene
        seen = novel_camera(scene, middle)
        seen = seen if job.resolution is None else at_resolution(seen, job.resolution)
        ray = seen.R.T @ np.linalg.inv(seen.K) @ (seen.width / 2, seen.height / 2, 1.0)
        focus = seen.centre + ray * (self.depth / (self.axes[2] @ ray))
        centre = scene.rig.view_plane.point(*eye)
        camera = camera_towards(seen, self.axes, centre, focus - centre)
        return replace(job, resolution=None).pixels(camera, view_weights(scene, eye, job.weights))

    def _half_sphere(self, job: RenderJob, middle: tuple[float, float], eye: tuple[float, float]) -> NDArray[np.uint8]:
        """What the photographs showed around the eye, by longitude and latitude from -90 to 90 degrees."""
        import cv2

        seen = novel_camera(job.scene, eye)
        width, height = job.resolution or (half_sphere_side(seen),) * 2
        density = width / (math.pi * seen.K[0, 0])  # pixels of the half sphere's middle for one of the photographs
        drawn_size = (max(1, round(seen.width * density)), max(1, round(seen.height * density)))
        seen = at_resolution(seen, drawn_size)
        drawn = replace(job, resolution=None).pixels(seen, view_weights(job.scene, eye, job.weights))
        longitude = (((np.arange(width) + 0.5) / width - 0.5) * math.pi).astype(np.float32)
        latitude = ((0.5 - (np.arange(height) + 0.5) / height) * math.pi).astype(np.float32)[:, None]
        ray = (np.cos(latitude) * np.sin(longitude), -np.sin(latitude), np.cos(latitude) * np.cos(longitude))
        turn = (seen.K @ seen.R @ self.axes.T).astype(np.float32)
        u, v, z = (row[0] * ray[0] + row[1] * ray[1] + row[2] * ray[2] for row in turn)
        ahead = z > 1e-6
        z = np.where(ahead, z, 1)
        columns, rows = (np.where(ahead, one / z - 0.5, -10).astype(np.float32) for one in (u, v))
        behind = [255 * part for part in job.background or (0.0,) * drawn.shape[2]]
        behind = behind if len(behind) == drawn.shape[2] else [sum(behind) / len(behind)] * drawn.shape[2]
        found = cv2.remap(drawn, columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=behind)
        return np.asarray(found, np.uint8).reshape(height, width, drawn.shape[2])


def half_sphere_side(camera: Camera) -> int:
    """Pixels a side of half a sphere whose middle is as fine as the camera's picture, or the most that players take."""
    side = math.pi * float(camera.K[0, 0]) / VR180_SIDE_STEP_PX
    return min(VR180_SIDE_STEP_PX * max(1, math.ceil(side)), VR180_MAX_SIDE_PX)


def write_stereo(
    views: Iterable[tuple[RenderJob, tuple[float, float]]],
    count: int,
    eyes: Eyes,
    output: Path,
    fps: Fraction,
    *,
    one_thread: bool = False,
    sound: tuple[bytes, float] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Draw views into a video that players know as stereo, or into a .png each. All files appear at the end, or none.

    Args:
        views: The scene of each, and the place between the eyes.
        output: An .mp4, or a .png whose name has a %04d.
        fps: Pictures a second of the video.
        one_thread: Whether the renderer wants that.
        sound: As of `write_video`.

    Raises:
        OptionError: As `Renderer.draw`.
        OutputError: A file cannot be written.
    """

    def draw(view: tuple[RenderJob, tuple[float, float]]) -> NDArray[np.uint8]:
        return eyes.pixels(*view)

    drawn = track(map(draw, views) if one_thread else parallel_stream(draw, views), "drawing", count, progress)
    if is_numbered(output):
        write_numbered(map(png, drawn), count, output, overwrite)
        return
    write_video(output, map(as_rgb, drawn), fps, sound=sound, boxes=vr_boxes(eyes.layout), overwrite=overwrite)
