"""Any proxy as a fitted file will have it."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.core.payloads import Coded
from eigenfield.encoding.geometry.coded import DEPTH_ERROR, coded_mesh, mesh_of_stream
from eigenfield.encoding.geometry.simplify_relief import slim_relief
from eigenfield.proxy.relief.find_lattice import relief_lattice


def slim_mesh(
    mesh: Mesh, cameras: Sequence[Camera], reference: int, observations: Observations, price: float, texels: float
) -> Coded[Mesh]:
    """The mesh as a file will have it: a relief with what its pictures are worth (`slim_relief`), other meshes with all
    their triangles (`coded_mesh`)."""
    relief = relief_lattice(mesh, cameras, DEPTH_ERROR)
    if relief is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            slim = slim_relief(mesh, *relief, cameras, observations, price, texels)
            return mesh_of_stream(slim.stream, slim.mesh)
    return coded_mesh(mesh, cameras, reference)
