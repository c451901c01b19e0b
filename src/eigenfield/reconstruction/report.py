"""Quality measures of a proxy, for people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import AtlasStatistics, atlas_statistics
from eigenfield.proxy.background import camera_coverage
from eigenfield.proxy.surface.trim import SurfaceError


@dataclass(frozen=True, eq=False)
class ProxyReport:
    """Quality measures of a proxy.

    Attributes:
        coverage: (n,) fraction of each camera's pixels that the proxy covers.
        error: Of its simplification; None if it was not simplified (reliefs).
        atlas: None where it has none.
    """

    triangles: int
    coverage: NDArray[np.float64]
    error: SurfaceError | None
    atlas: AtlasStatistics | None

    __repr__ = brief_repr

    def lines(self, names: Sequence[str]) -> list[str]:
        """Lines of text."""
        least = int(self.coverage.argmin())
        coverage = f"coverage {self.coverage.mean():.1%}"
        if self.coverage[least] < 0.9995:
            coverage += f", least {self.coverage[least]:.1%} in {names[least]}"
        lines = [f"  {self.triangles} triangles, {coverage}"]
        if self.error is not None:
            lines.append(f"  simplified with an error of {self.error}")
        return lines if self.atlas is None else [*lines, f"  {self.atlas}"]


def measure_proxy(mesh: Mesh, cameras: Sequence[Camera], error: SurfaceError | None) -> ProxyReport:
    """The report of a mesh, with an atlas or without."""
    atlas = None if mesh.uv is None else atlas_statistics(mesh)
    return ProxyReport(len(mesh.faces), camera_coverage(mesh, cameras), error, atlas)
