"""Looking around in a scene from Python: a server that stays while it is held, and a browser."""

from __future__ import annotations

import os
import webbrowser
from pathlib import Path

from eigenfield.core.arguments import checked
from eigenfield.core.scene import Scene, check_scale
from eigenfield.gltf import encode_scene, outline, without_residual
from eigenfield.viewer.manifest import make_manifest
from eigenfield.viewer.server import LOOPBACK, Server


@checked
def view(
    scene: Scene | str | os.PathLike[str],
    *,
    host: str = LOOPBACK,
    port: int = 0,
    browser: bool = True,
    metres_per_unit: float | None = None,
) -> Server:
    """Look around in a scene, in a browser, until the server is closed or the program ends.

        with ef.view("scene.glb"):
            input("Enter ends it")

    Args:
        scene: The scene, or its file.
        host: Name or address to listen on; any other than this machine's own lets the network see the scene.
        port: To listen on; 0: one that is free.
        browser: Whether a browser is opened; `address` of the result is where the page is.
        metres_per_unit: Metres in one unit of the capture, for headsets.

    Raises:
        OptionError: `host-unknown`, `port-busy`, `port-refused`, `metres`.
        FormatError: The file is no scene.
    """
    check_scale(metres_per_unit)
    if isinstance(scene, Scene):
        data, name = encode_scene(scene), "scene.glb"
    else:
        data, name = outline(scene)[1], Path(scene).name
    server = Server(make_manifest(without_residual(data), name, None, metres_per_unit), host, port)
    server.start()
    if browser:
        webbrowser.open(server.address)
    return server
