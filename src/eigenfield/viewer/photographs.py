"""Photographs beside a scene, as PNG of the size of its cameras, decoded when they are asked for."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import replace

from eigenfield.capture import LightField
from eigenfield.core.errors import CaptureError
from eigenfield.core.scene import Scene
from eigenfield.imaging.png import png_bytes

AT_ONCE = 2  # photographs decoded at a time: a large one takes 16 bytes a pixel and more
KEPT = 64 * 2**20  # bytes of PNG that are kept for the next time


class Photographs:
    """The photographs of a scene's cameras, lens removed, masks left alone; may be called from any thread."""

    def __init__(self, scene: Scene, capture: LightField, views: Mapping[int, int]) -> None:
        """views: index of a scene's camera to the index of its view in the capture, as `match_photographs` gives.

        Raises CaptureError `photograph-size` for a photograph that is not of its camera's size.
        """
        for index, view in views.items():
            own, other = scene.rig.cameras[index], capture.views[view].camera
            if (own.width, own.height) != (other.width, other.height):
                raise CaptureError(
                    "photograph-size",
                    f"is {other.width}x{other.height}, the scene's camera of that name {own.width}x{own.height}",
                    path=capture.views[view].path,
                    remedy="name the photographs that were encoded",
                )
        self.names: Mapping[int, str] = {index: scene.rig.names[index] for index in sorted(views)}
        self._capture = replace(capture, views=tuple(replace(view, mask=None) for view in capture.views))
        self._views = dict(views)
        self._kept: OrderedDict[int, bytes] = OrderedDict()
        self._gate = threading.Lock()
        self._slots = threading.BoundedSemaphore(AT_ONCE)

    def png(self, index: int) -> bytes:
        """Camera `index`'s photograph as 8-bit RGB PNG. Raises CaptureError where it cannot be decoded."""
        kept = self._recall(index)
        if kept is not None:
            return kept
        with self._slots:
            kept = self._recall(index)  # another thread may have made it while this one waited
            if kept is None:
                kept = png_bytes(self._capture.photograph(self._views[index]).pixels)
                self._keep(index, kept)
            return kept

    def _recall(self, index: int) -> bytes | None:
        with self._gate:
            if index in self._kept:
                self._kept.move_to_end(index)
            return self._kept.get(index)

    def _keep(self, index: int, data: bytes) -> None:
        with self._gate:
            self._kept[index] = data
            while len(self._kept) > 1 and sum(map(len, self._kept.values())) > KEPT:
                self._kept.popitem(last=False)
