"""What a proxy is like, for people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import AtlasStatistics, atlas_statistics
from eigenfield.proxy.background import camera_coverage
from eigenfield.proxy.surface.trim import SurfaceError


@dataclass(frozen=True, eq=False)
class ProxyReport:
    """A proxy in figures.

    triangles: how many. coverage: (n,) the part of each camera's pixels on which it puts surface.
    error: of its simplification; None where the surface was not simplified (reliefs). atlas: of its UVs.
    """

    triangles: int
    coverage: NDArray[np.float64]
    error: SurfaceError | None
    atlas: AtlasStatistics

    def lines(self, names: Sequence[str]) -> list[str]:
        """For people. names: of the cameras."""
        least = int(self.coverage.argmin())
        told = f"coverage {self.coverage.mean():.1%}"
        if self.coverage[least] < 0.9995:
            told += f", least {self.coverage[least]:.1%} in {names[least]}"
        lines = [f"  {self.triangles} triangles, {told}"]
        if self.error is not None:
            lines.append(f"  simplified with an error of {self.error}")
        return [*lines, f"  {self.atlas}"]


def report_of(mesh: Mesh, cameras: Sequence[Camera], error: SurfaceError | None) -> ProxyReport:
    """Measured on a mesh with an atlas."""
    return ProxyReport(len(mesh.faces), camera_coverage(mesh, cameras), error, atlas_statistics(mesh))
