"""The proxy as a file keeps it: a mesh, and the lattice that its vertices stand on."""

from __future__ import annotations

from dataclasses import dataclass

from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Proxy:
    """The surface that a scene is drawn on.

    Attributes:
        mesh: With UVs.
        lattice: Pixels and inverse depths of the camera in which a relief was made; None for other meshes, and before
            it was searched.
    """

    mesh: Mesh
    lattice: Lattice | None = None
