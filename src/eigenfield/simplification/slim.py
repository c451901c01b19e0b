"""Any proxy as a fitted file will have it."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

from eigenfield.camera import Camera
from eigenfield.format.geometry import DEPTH_ERROR, coded_mesh
from eigenfield.format.relief_lattice import relief_lattice
from eigenfield.format.stored import keep_stream
from eigenfield.mesh import Mesh
from eigenfield.simplification.effect import Grey
from eigenfield.simplification.relief import slim_relief


def slim_mesh(mesh: Mesh, cameras: Sequence[Camera], reference: int, grey: Grey, price: float, texels: float) -> Mesh:
    """The mesh as a file will have it, its stream kept beside it: a relief with what its pictures are worth
    (`slim_relief`), other meshes with all their triangles (`format.geometry.coded_mesh`)."""
    relief = relief_lattice(mesh, cameras, DEPTH_ERROR)
    if relief is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            slim = slim_relief(mesh, *relief, cameras, grey, price, texels)
            keep_stream(slim.mesh, slim.stream)
            return slim.mesh
    return coded_mesh(mesh, cameras, reference)
