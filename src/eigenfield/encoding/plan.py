"""What a scene is before it has textures: its options, cameras and mesh, and the size of its atlas."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Appearance, Plane
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations, cameras_of
from eigenfield.core.payloads import Payloads, mesh_key, size_of
from eigenfield.core.proxy import Proxy
from eigenfield.core.rights import Rights
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.encoding.atlas import texels_per_pixel
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.views import CaptureViews
from eigenfield.gltf.fallback import with_fallback

log = logging.getLogger("eigenfield.encode")


@dataclass(frozen=True, eq=False)
class PreparedProxy:
    """A proxy with an atlas, before it is made ready for a quality.

    Attributes:
        given: The file, the mesh or the proxy as it came.
        proxy: With UVs and, if it is a relief, its lattice; for a fit its vertices are where the photographs agree.
        views: The cameras that it was prepared for.
        by_quality: Whether another quality needs it prepared anew, with other triangles and charts.
        exact: Whether it is as it was given, but for the lattice; an opacity is not coded with it then.
    """

    given: str | os.PathLike[str] | Mesh | Proxy
    proxy: Proxy
    views: CaptureViews
    by_quality: bool
    exact: bool = False


@dataclass(frozen=True, eq=False)
class EncodePlan:
    """Everything that is decided before textures are made.

    Attributes:
        asked: The options as they were given.
        options: The resolved options for one quality, without a target.
        prepared: The proxy that the same plan at another quality starts from.
        views: The cameras as the file keeps them, and which of them are encoded.
        proxy: The proxy as the file keeps it.
        payloads: The coded mesh, opacity and cameras; empty without a fit, unless it is of a clip.
        atlas: Width and height of its atlas.
    """

    asked: EncodeOptions
    options: EncodeOptions
    prepared: PreparedProxy
    views: CaptureViews
    proxy: Proxy
    payloads: Payloads
    atlas: tuple[int, int]

    @property
    def mesh(self) -> Mesh:
        """The proxy's mesh."""
        return self.proxy.mesh

    @property
    def mesh_bytes(self) -> int:
        """Of the coded mesh in the file; 0 where it is not coded."""
        return size_of(self.payloads.get(mesh_key(self.mesh), ()))

    @cached_property
    def density(self) -> float:
        """The atlas's texels per pixel of the reference photograph, along one axis."""
        camera = self.views.rig.cameras[self.views.rig.reference]
        return float(np.sqrt(np.prod(self.atlas))) * texels_per_pixel(self.mesh, camera)

    def settings(self, textures: int, own: Mapping[str, Any]) -> dict[str, Any]:
        """What a file says about how it was made.

        Args:
            textures: Eigen textures of the plane that has most.
            own: Settings that record how the planes were made.
        """
        views, rig = self.views, self.views.rig
        sizes = [rig.cameras[index].width * rig.cameras[index].height for index in views.taken_by]
        used = np.flatnonzero(np.isin(cameras_of(views.capture), rig.encoded)).tolist()
        return {
            "textures": textures,
            "atlas": list(self.atlas),
            "density": round(self.density, 4),
            "holdOut": self.options.hold_out,
            **own,
            **_scale(views.capture, self.options.metres_per_unit),
            **_origin(views.capture),
            **_lenses(views.capture),
            **_as_stored(views.capture),
            **_tone(views.capture),
            "photographs": {
                "count": len(views.observations),
                "bytes": sum(views.capture.bytes(index) for index in used),
                "pixels": sum(sizes),
            },
        }

    def scene(
        self,
        planes: tuple[Plane, ...],
        own: Mapping[str, Any],
        *,
        payloads: Payloads | None = None,
        colours: NDArray[np.float32] | None = None,
        to_rgb: NDArray[np.float32] | None = None,
    ) -> Scene:
        """The scene with these planes.

        Args:
            planes: As in `Scene`, with a row of weights for each encoded camera.
            own: Settings that record how the planes were made.
        """
        textures = max(sum(basis.count for basis in one.bases) for one in planes)
        made = Scene(
            proxy=replace(self.proxy, lattice=None),
            rig=self.views.rig,
            appearance=Appearance(planes=planes, colours=colours, to_rgb=to_rgb),
            settings=self.settings(textures, own),
            generator=f"eigenfield {__version__}",
            payloads=self.payloads | (payloads or {}),
            rights=self.options.rights or Rights(),
        )
        return made if self.options.fallback is None else with_fallback(made, self.options.fallback)


def component_count(asked: int, observations: int) -> int:
    """At most No - 1 components exist (equation 6); asking for more is no error."""
    most = observations - 1
    if asked > most:
        log.warning("%d eigen textures were asked for; %d photographs give at most %d", asked, observations, most)
    return min(asked, most)


def _scale(capture: CalibratedObservations, asked: float | None) -> dict[str, float]:
    """The settings about the real size: as asked, or as in the capture."""
    scale = capture.metres_per_unit if asked is None else asked
    return {} if scale is None else {"metresPerUnit": scale}


def _origin(capture: CalibratedObservations) -> dict[str, list[float]]:
    """Where a capture that was far from its origin stood, so that what is exported stands there again."""
    return {"origin": capture.origin.tolist()} if capture.origin.any() else {}


def _lenses(capture: CalibratedObservations) -> dict[str, Any]:
    """The lenses that were removed, so that the photographs alone are enough to measure the scene by."""
    lenses = [None if lens is None else [lens[0], list(lens[1])] for lens in capture.lenses]
    return {"lenses": lenses} if any(lenses) else {}


def _as_stored(capture: CalibratedObservations) -> dict[str, list[int]]:
    """The photographs that are not turned by their EXIF orientation, where no size tells: for the same purpose."""
    indices = list(capture.as_stored)
    return {"asStored": indices} if indices else {}


def _tone(capture: CalibratedObservations) -> dict[str, Any]:
    """How linear values became the photographs' own numbers."""
    return {} if capture.exposure is None else {"tone": {"curve": "sRGB", "exposure": capture.exposure}}
