"""A mesh over frames in a row of a clip, on the lattice of the mesh that the file has."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

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
from eigenfield.encoding.plan import EncodePlan
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.meshes.sequence import SEQUENCE_REMEDY, MeshSequence

MOTION_CODEC = "motion-1"


@dataclass(frozen=True, eq=False)
class MovingMesh:
    """A mesh at each of some frames of a clip.

    Attributes:
        first: The first of the frames. They are counted in the clip, here and in all methods.
        mesh: As the file has it.
        places: (v, 3) int64 its lattice coordinates.
        frames: (T, v, 3) int32 those of each frame.
    """

    first: int
    mesh: Mesh
    lattice: Lattice
    places: NDArray[np.int64]
    frames: NDArray[np.int32]

    @property
    def digest(self) -> str:
        """Of all frames."""
        return hashlib.sha256(self.frames.tobytes()).hexdigest()

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
        """(h, w) where a camera sees, in any of some frames, a triangle that moves among them."""
        steps = self.steps(numbers)
        moving = (steps != steps[0]).any(axis=(0, 2))[self.mesh.faces].any(axis=1)
        found = np.zeros((camera.height, camera.width), bool)
        if moving.any():
            for number in numbers:
                face = rasterise_view(self.at(number), camera).face
                found |= (face >= 0) & moving[face]
        return found


def moving_mesh(plan: EncodePlan, sequence: MeshSequence) -> MovingMesh:
    """The meshes of a sequence on the lattice of the plan's mesh, which was made of its first.

    Raises:
        ProxyError: `proxy-motion`, a mesh reaches beyond the lattice.
    """
    stream = plan.payloads.only("mesh")
    placed, prepared = decode_placed(stream.data), plan.prepared.proxy.mesh
    origins = sequence.vertices_of(prepared)[vertex_origins(stream.data, prepared)]
    frames = np.empty((len(sequence.positions), *placed.places.shape), np.int32)
    for number, positions in enumerate(sequence.positions):
        steps = np.rint(placed.lattice.coordinates(positions[origins]))
        inside = (np.abs(steps) < MOTION_MAX_STEPS).all()  # False for NaN
        if not inside or (placed.lattice.flat and steps[:, 2].min() < 0):
            message = (
                f"frame {sequence.first + number}: the mesh reaches too far, or behind the camera in which the first "
                "one is coded"
            )
            raise ProxyError("proxy-motion", message, remedy=SEQUENCE_REMEDY)
        frames[number] = steps
    return MovingMesh(sequence.first, placed.mesh, placed.lattice, placed.places, frames)
