"""Photographs beside a scene, as PNG of the size of its cameras, decoded on request."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import replace

from eigenfield.capture import LightField
from eigenfield.core.errors import CaptureError
from eigenfield.core.scene import Scene
from eigenfield.imaging.png import png_bytes

PHOTOGRAPHS_AT_ONCE = 2  # decoded at a time: a large one takes 16 bytes a pixel and more
PHOTOGRAPH_CACHE_BYTES = 64 * 2**20  # of PNG


class Photographs:
    """The photographs of a scene's cameras, undistorted and without their masks; may be called from any thread.

    Attributes:
        names: Index of a camera to its name, for those with a photograph.
    """

    def __init__(self, scene: Scene, capture: LightField, views: Mapping[int, int]) -> None:
        """Check the photographs' sizes.

        Args:
            views: Index of a scene's camera to the index of its view in the capture, of `match_photographs`.

        Raises:
            CaptureError: `photograph-size`: a photograph does not have its camera's size.
        """
        for index, view in views.items():
            camera, other = scene.rig.cameras[index], capture.views[view].camera
            if (camera.width, camera.height) != (other.width, other.height):
                raise CaptureError(
                    "photograph-size",
                    f"is {other.width}x{other.height}, the scene's camera of that name {camera.width}x{camera.height}",
                    path=capture.views[view].path,
                    remedy="name the photographs that were encoded",
                )
        self.names: Mapping[int, str] = {index: scene.rig.names[index] for index in sorted(views)}
        self._capture = replace(capture, views=tuple(replace(view, mask=None) for view in capture.views))
        self._views = dict(views)
        self._cache: OrderedDict[int, bytes] = OrderedDict()
        self._lock = threading.Lock()
        self._slots = threading.BoundedSemaphore(PHOTOGRAPHS_AT_ONCE)

    def png(self, index: int) -> bytes:
        """A camera's photograph as 8-bit RGB PNG.

        Raises:
            CaptureError: It cannot be decoded.
        """
        cached = self._recall(index)
        if cached is not None:
            return cached
        with self._slots:
            cached = self._recall(index)  # another thread may have made it while this one waited
            if cached is None:
                cached = png_bytes(self._capture.photograph(self._views[index]).pixels)
                self._store(index, cached)
            return cached

    def _recall(self, index: int) -> bytes | None:
        with self._lock:
            if index in self._cache:
                self._cache.move_to_end(index)
            return self._cache.get(index)

    def _store(self, index: int, data: bytes) -> None:
        with self._lock:
            self._cache[index] = data
            while len(self._cache) > 1 and sum(map(len, self._cache.values())) > PHOTOGRAPH_CACHE_BYTES:
                self._cache.popitem(last=False)
