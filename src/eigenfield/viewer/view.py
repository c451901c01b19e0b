"""Looking around in a scene: a server that stays while it is held, and a browser."""

from __future__ import annotations

import logging
import os
import webbrowser
from pathlib import Path
from typing import Any

from eigenfield.capture import LightField, PhotoSet, match_photographs, open_any, with_scene_cameras
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.scene import Scene, check_scale
from eigenfield.gltf import encode_scene, load_clip, one_file, outline, stores_clip, without_residual
from eigenfield.gltf.clip_forms import files_beside
from eigenfield.gltf.source import ByteSource, StoredBytes, scene_file
from eigenfield.runtime.objects import find_objects
from eigenfield.viewer.manifest import make_manifest
from eigenfield.viewer.page import Beside
from eigenfield.viewer.photographs import Photographs
from eigenfield.viewer.server import LOOPBACK, Server

log = logging.getLogger("eigenfield.viewer")


@checked
def view(
    scene: Scene | Clip | str | os.PathLike[str],
    capture: str | os.PathLike[str] | LightField | PhotoSet | Scene | Clip | None = None,
    *,
    host: str = LOOPBACK,
    port: int = 0,
    browser: bool = True,
    metres_per_unit: float | None = None,
    **place: Any,
) -> Server:
    """Look around in a scene, in a browser, until the server is closed or the program ends, as `eigenfield view` does.

        with ef.view("scene.glb", "photos/"):
            input("Enter ends it")

    Args:
        scene: The scene or the clip, or its file; a plain glTF file is shown as it is.
        capture: Photographs of the scene, not of a clip, which are shown beside it: their folder, or what `open_any`
            returns. Or a second scene or clip, or its .glb: one eye sees both, with a divider between them.
        host: Name or address to listen on; any other than this machine's own lets the network see the scene.
        port: To listen on; 0: one that is free.
        browser: Whether a browser is opened; `address` of the result is where the page is.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        place: Arguments of `open_any` for the path of a capture.

    Raises:
        OptionError: `host-unknown`, `port-busy`, `port-refused`, `metres`, `no-capture`, `clip-photographs`; as
            `open_any`.
        FormatError: The file is no scene.
        CaptureError: The photographs cannot be read, none belongs to the scene (`no-photographs`), or one does not have
            its camera's size (`photograph-size`).
    """
    check_scale(metres_per_unit)
    given = {name: value for name, value in place.items() if value is not None}
    name = "scene.glb" if isinstance(scene, Scene | Clip) else Path(scene).name
    photographs, beside = None, dict[str, ByteSource]()
    second = None
    if isinstance(capture, Scene | Clip) or (isinstance(capture, str | os.PathLike) and _is_scene(capture)):
        if given:
            message = f"--{next(iter(given)).replace('_', '-')} is for a capture, and a second scene is named"
            raise OptionError("no-capture", message, remedy="leave it out")
        second, capture = Beside.of((scene, capture), _second_file(capture)), None
    try:
        loaded, data = _opened(scene)
        beside = files_beside(loaded) if isinstance(loaded, Clip) and not isinstance(scene, Clip) else beside
    except FormatError as error:
        compared = capture is not None or second is not None
        if error.code != "not-a-scene" or compared or isinstance(scene, Scene | Clip):
            raise
        log.warning("%s has no eigen textures: it is shown as the plain glTF file that it is", scene)
        data = scene_file(scene).read_bytes()
    else:
        if given and not isinstance(capture, str | os.PathLike):
            message = f"--{next(iter(given)).replace('_', '-')} is for a capture, and no folder of one is named"
            raise OptionError("no-capture", message, remedy="name it behind the scene")
        if capture is not None:
            if isinstance(loaded, Clip) or (isinstance(scene, str | os.PathLike) and stores_clip(scene)):
                message = "a clip has no photographs beside it: they would be of one instant"
                raise OptionError("clip-photographs", message, path=name, remedy="leave the capture out")
            photographs = _photographs(loaded, capture, given)
    server = Server(make_manifest(data, name, photographs, metres_per_unit, beside=beside, second=second), host, port)
    server.start()
    if browser and not webbrowser.open(server.address):
        log.warning("no browser was found: open %s in one", server.address)
    return server


def _opened(scene: Scene | Clip | str | os.PathLike[str]) -> tuple[Scene | Clip, bytes | ByteSource]:
    """A scene or a clip, and its file for the page. That of a clip on disk is read for each answer, and not held."""
    if isinstance(scene, Scene | Clip):
        return scene, without_residual(encode_scene(scene))
    if find_objects(Path(scene)) is None and stores_clip(scene):
        clip = load_clip(scene)
        clip.scene(clip.timeline.first)
        file = scene_file(scene)
        return clip, StoredBytes(file, 0, file.stat().st_size)
    loaded, data = outline(scene)
    return loaded, without_residual(data)


def _is_scene(path: str | os.PathLike[str]) -> bool:
    """Whether a path names a scene, or the folder of a clip, and not photographs."""
    return os.fspath(path).lower().endswith(".glb") or scene_file(path) != Path(path)


def _second_file(scene: Scene | Clip | str | os.PathLike[str]) -> bytes:
    """The file of the scene that another one is compared with."""
    if isinstance(scene, Scene | Clip):
        return without_residual(encode_scene(scene))
    return one_file(scene) if stores_clip(scene) else without_residual(outline(scene)[1])


def _photographs(
    scene: Scene, capture: str | os.PathLike[str] | LightField | PhotoSet, place: dict[str, Any]
) -> Photographs:
    opened = open_any(capture, **place) if isinstance(capture, str | os.PathLike) else capture
    light_field = with_scene_cameras(scene, opened)
    photographs = Photographs(scene, light_field, match_photographs(scene, light_field))
    missing = len(scene.rig.names) - len(photographs.names)
    if missing:
        log.warning("%d of %d cameras have no photograph in %s", missing, len(scene.rig.names), opened.root)
    return photographs
