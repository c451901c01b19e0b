"""The proxy over frames in a row of a clip: its mesh on the lattice of the mesh that the file has, and its opacity."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.codecs import encoder
from eigenfield.coding.mesh.coder import decode_placed, vertex_origins
from eigenfield.coding.mesh.motion_kernels import MOTION_MAX_STEPS
from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.encoding.fitted.planes import even_opacity, opacity_size
from eigenfield.encoding.plan import EncodePlan
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.meshes.sequence import SEQUENCE_REMEDY

MOTION_CODEC = "motion-1"
SHOWN_MIN_OPACITY = 0.05  # of a surface that moves, for a pixel to see it move
CHANGE_MIN_OPACITY = 0.1  # by which what a pixel sees of a sheet changes, at least: less is none where photographs stay


@dataclass(frozen=True, eq=False)
class MovingMesh:
    """A mesh at each of some frames of a clip, maybe of sheets.

    Attributes:
        first: The first of the frames. They are counted in the clip, here and in all methods.
        mesh: As the file has it.
        places: (v, 3) int64 its lattice coordinates.
        frames: (T, v, 3) int32 those of each frame.
        sheets: Number of faces of each; (): one opaque surface.
        opacity: (T, H, W) of sheets, from which each frame's is fitted.
    """

    first: int
    mesh: Mesh
    lattice: Lattice
    places: NDArray[np.int64]
    frames: NDArray[np.int32]
    sheets: tuple[int, ...] = ()
    opacity: NDArray[np.float32] | None = None

    @property
    def digest(self) -> str:
        """Of all frames."""
        digest = hashlib.sha256(self.frames.tobytes())
        for one in () if self.opacity is None else self.opacity:
            digest.update(np.ascontiguousarray(one).tobytes())
        return digest.hexdigest()

    @property
    def opacity_size(self) -> tuple[int, int] | None:
        """(rows, columns) of a frame's opacity in films; None without sheets."""
        return None if self.opacity is None else opacity_size(self.opacity.shape[1:])

    def given_opacity(self, number: int) -> NDArray[np.float32]:
        """(H, W) of `opacity_size`: that of a frame of sheets as it was given."""
        assert self.opacity is not None
        return even_opacity(np.asarray(self.opacity[number - self.first]))

    def proxy(self, number: int, opacity: NDArray[np.float32] | None) -> Proxy:
        """The proxy in a frame, with an opacity if it is of sheets."""
        sheets = None if opacity is None else Sheets(self.sheets, opacity)
        return Proxy(self.at(number), sheets=sheets)

    def steps(self, numbers: range) -> NDArray[np.int32]:
        """(t, v, 3) lattice coordinates in some frames."""
        return self.frames[numbers.start - self.first : numbers.stop - self.first]

    def moves(self, numbers: range) -> NDArray[np.bool_]:
        """(v,) whether each vertex is elsewhere than in the file's mesh in any of some frames."""
        return np.asarray((self.steps(numbers) != self.places).any(axis=(0, 2)))

    def at(self, number: int) -> Mesh:
        """The mesh in a frame, as decoders find it."""
        only = range(number, number + 1)
        moving = self.moves(only)
        vertices = self.mesh.vertices.copy()
        vertices[moving] = self.lattice.points(self.steps(only)[0, moving].astype(np.int64))
        return replace(self.mesh, vertices=vertices)

    def check_groups(self, spans: Sequence[tuple[int, int]]) -> None:
        """ProxyError `proxy-motion`: more vertices move in a group than a file may have.

        Args:
            spans: The first frame of each group, and the one after its last.
        """
        for first, last in spans:
            moving = int(self.moves(range(first, last)).sum())
            if moving * (last - first) > limits.MAX_MOTION:
                message = f"{moving} vertices move in a group of {last - first} frames: too much for a file"
                remedy = "say a shorter --group, or give meshes with fewer vertices"
                raise ProxyError("proxy-motion", message, remedy=remedy)

    def payload(self, numbers: range) -> Payload | None:
        """The motion of a group as a file has it; None: nothing moves."""
        if not self.moves(numbers).any():
            return None
        steps = self.steps(numbers).astype(np.int64)
        return Payload(MOTION_CODEC, encoder(MOTION_CODEC)(self.places, self.mesh.faces, steps))

    def moving_pixels(self, camera: Camera, numbers: range) -> NDArray[np.bool_]:
        """(h, w) where a camera sees, in any of some frames, a triangle that moves among them, or an opacity that
        changes."""
        steps = self.steps(numbers)
        moving = (steps != steps[0]).any(axis=(0, 2))[self.mesh.faces].any(axis=1)
        found = np.zeros((camera.height, camera.width), bool)
        if self.opacity is None and not moving.any():
            return found
        for first, last in pairwise(accumulate(self.sheets or (len(self.mesh.faces),), initial=0)):
            if first == 0 and not moving[:last].any():
                continue  # the backmost sheet is opaque
            least, most = np.ones(found.shape, np.float32), np.zeros(found.shape, np.float32)
            for number in numbers:
                mesh, opacity = self.at(number), None if self.opacity is None else self.opacity[number - self.first]
                face, shown = shown_faces(replace(mesh, faces=mesh.faces[first:last]), opacity, camera)
                least, most = np.minimum(least, shown), np.maximum(most, shown)
                found |= (shown > SHOWN_MIN_OPACITY) & moving[first:last][face]
            if self.opacity is not None:
                found |= most - least > CHANGE_MIN_OPACITY
        return found


def shown_faces(
    mesh: Mesh, opacity: NDArray[np.float32] | None, camera: Camera
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """(h, w) which face of a mesh each pixel of a camera shows, and how opaque it is there: 0 where there is none.

    Args:
        opacity: (H, W) over the atlas; None: opaque.
    """
    raster = rasterise_view(mesh, camera)
    shown = (raster.face >= 0).astype(np.float32)
    if opacity is not None and mesh.uv is not None:
        row, column = np.nonzero(raster.face >= 0)
        corners = mesh.uv[mesh.faces[raster.face[row, column]]]
        uv = np.einsum("nk,nkx->nx", raster.corner_shares(row, column), corners)
        across, down = (uv * opacity.shape[::-1]).astype(np.int64).T
        shown[row, column] = opacity[down.clip(0, len(opacity) - 1), across.clip(0, opacity.shape[1] - 1)]
    return raster.face, shown


def moving_mesh(
    plan: EncodePlan,
    positions: Sequence[NDArray[np.float32]] | NDArray[np.float32],
    origins: NDArray[np.int64] | None = None,
    opacity: NDArray[np.float32] | None = None,
    first: int = 0,
) -> MovingMesh:
    """What moves on the lattice of the plan's mesh, which was made of its first frame.

    Args:
        positions: (T, n, 3) of each frame.
        origins: Which of these n each vertex of the prepared mesh is; None: they are the same.
        opacity: (T, H, W) of sheets.
        first: The first of these frames, counted in the clip.

    Raises:
        ProxyError: `proxy-motion`, a mesh reaches beyond the lattice.
    """
    stream = plan.payloads.only("mesh")
    placed, prepared = decode_placed(stream.data), plan.prepared.proxy
    kept = vertex_origins(stream.data, prepared.mesh, () if prepared.sheets is None else prepared.sheets.faces)
    kept = kept if origins is None else origins[kept]
    frames = np.empty((len(positions), *placed.places.shape), np.int32)
    for number, own in enumerate(positions):
        steps = np.rint(placed.lattice.coordinates(own[kept]))
        inside = (np.abs(steps) < MOTION_MAX_STEPS).all()  # False for NaN
        if not inside or (placed.lattice.flat and steps[:, 2].min() < 0):
            message = (
                f"frame {first + number}: the mesh reaches too far, or behind the camera in which the first "
                "one is coded"
            )
            raise ProxyError("proxy-motion", message, remedy=SEQUENCE_REMEDY)
        frames[number] = steps
    sheets = () if plan.proxy.sheets is None else plan.proxy.sheets.faces
    return MovingMesh(first, placed.mesh, placed.lattice, placed.places, frames, sheets, opacity)
