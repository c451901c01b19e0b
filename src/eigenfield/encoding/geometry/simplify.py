"""Any proxy as a fitted file keeps it."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.core.payloads import Coded
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.geometry.coded import coded_mesh, mesh_of_stream
from eigenfield.encoding.geometry.simplify_relief import simplify_relief_rd


def simplify_proxy_rd(
    proxy: Proxy, cameras: Sequence[Camera], reference: int, observations: Observations, lambda_: float, texels: float
) -> Coded[Mesh]:
    """The mesh as a file keeps it: a relief simplified by rate and distortion, other meshes with all their triangles.

    Args:
        proxy: With its lattice, if it is a relief.
        cameras: The encoded ones.
        reference: Index of the reference camera among them.
        observations: Theirs.
        lambda_: Rate-distortion weight: squared error for one byte, for each pixel that a texel is seen in.
        texels: Of the atlas, for one pixel of the reference camera.
    """
    if proxy.lattice is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            made = simplify_relief_rd(proxy.mesh, proxy.lattice, cameras, observations, lambda_, texels)
            return mesh_of_stream(made.stream, made.mesh)
    return coded_mesh(proxy, cameras, reference)
