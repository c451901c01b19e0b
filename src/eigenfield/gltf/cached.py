"""The payloads of a scene's parts that have not changed since they were coded, and the bytes of the others."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from eigenfield.core.payloads import (
    Key,
    Payload,
    PicturePayload,
    cameras_key,
    mean_key,
    mesh_key,
    opacity_key,
    preview_key,
    size_of,
    textures_key,
    weights_key,
)
from eigenfield.core.scene import Scene
from eigenfield.runtime.parallel import parallel_map


@dataclass(frozen=True, eq=False)
class CachedPayloads:
    """Payloads of the parts that have not changed, named by its place in a scene: `mesh`, `cameras`, `opacity`,
    `planes[0].mean`, `planes[0].bases[1].weights`. One more is `preview`, the picture for other viewers.

    Attributes:
        lost: Bytes of the payload of each part that has changed.
    """

    payloads: Mapping[str, tuple[Payload, ...]]
    lost: Mapping[str, int]

    def one(self, part: str) -> Payload | None:
        """The payload of a part that has a single one."""
        return next(iter(self.payloads.get(part, ())), None)

    def pictures(self, part: str) -> tuple[PicturePayload, ...]:
        """The payloads of a part that is pictures."""
        return tuple(one for one in self.payloads.get(part, ()) if isinstance(one, PicturePayload))


def cached_payloads(scene: Scene) -> CachedPayloads:
    """The payloads of a scene's parts, found by their content. Those that are left over are taken to be of the parts
    that have changed, in the order of the scene."""
    if not scene.payloads:
        return CachedPayloads({}, {})
    parts = _parts(scene)
    keys = dict(zip(parts, parallel_map(lambda key: key(), parts.values()), strict=True))
    used = set(keys.values())
    left: defaultdict[str, deque[Key]] = defaultdict(deque)
    for key in scene.payloads:
        if key not in used:
            left[key[0]].append(key)
    found, lost = {}, {}
    for part, key in keys.items():
        if key in scene.payloads:
            found[part] = scene.payloads[key]
        elif left[key[0]]:
            lost[part] = size_of(scene.payloads[left[key[0]].popleft()])
    made_of = [f"planes[{p}].mean" for p in range(len(scene.appearance.planes))]
    made_of += ["opacity"] if "opacity" in keys else []
    sources = [keys[part] for part in made_of]
    preview = scene.payloads.get(preview_key(sources, scene.appearance.to_rgb, scene.appearance.colours is not None))
    return CachedPayloads(found if preview is None else {**found, "preview": preview}, lost)


def _parts(scene: Scene) -> dict[str, Callable[[], Key]]:
    """The key of each part that may be coded, to be computed."""
    found: dict[str, Callable[[], Key]] = {
        "mesh": partial(mesh_key, scene.proxy.mesh), "cameras": partial(cameras_key, scene.rig.cameras)
    }  # fmt: skip
    if scene.proxy.sheets is not None:
        found["opacity"] = partial(opacity_key, scene.proxy.sheets.opacity)
    for p, plane in enumerate(scene.appearance.planes):
        found[f"planes[{p}].mean"] = partial(mean_key, plane.mean)
        for b, basis in enumerate(plane.bases):
            found[f"planes[{p}].bases[{b}].textures"] = partial(textures_key, basis)
            found[f"planes[{p}].bases[{b}].weights"] = partial(weights_key, basis.weights)
    return found
