"""eigenfield: photographs from a camera array in, one small .glb to look around in out.

    import eigenfield as ef

    scene = ef.encode("photos/")
    scene.save("scene.glb")
    picture = ef.load("scene.glb").render(at=(0.3, -0.2))

Everything is loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from eigenfield.core.version import __version__

if TYPE_CHECKING:
    from eigenfield.api import Clip as Clip
    from eigenfield.api import Scene as Scene
    from eigenfield.api import encode as encode
    from eigenfield.api import load as load
    from eigenfield.api import load_clip as load_clip
    from eigenfield.batches import BatchResult as BatchResult
    from eigenfield.batches import batch as batch
    from eigenfield.calibration import calibrate as calibrate
    from eigenfield.capture import Footage as Footage
    from eigenfield.capture import LightField as LightField
    from eigenfield.capture import PhotoSet as PhotoSet
    from eigenfield.capture import opening as _opening
    from eigenfield.core.camera import Camera as Camera
    from eigenfield.core.errors import CaptureError as CaptureError
    from eigenfield.core.errors import EigenfieldError as EigenfieldError
    from eigenfield.core.errors import FormatError as FormatError
    from eigenfield.core.errors import OptionError as OptionError
    from eigenfield.core.errors import OutputError as OutputError
    from eigenfield.core.errors import ProxyError as ProxyError
    from eigenfield.core.errors import WorkerError as WorkerError
    from eigenfield.core.mesh import Mesh as Mesh
    from eigenfield.core.open_options import OpenOptions as OpenOptions
    from eigenfield.core.progress import Progress as Progress
    from eigenfield.core.rights import Rights as Rights
    from eigenfield.encoding import EncodeOptions as EncodeOptions
    from eigenfield.encoding import Target as Target
    from eigenfield.evaluation import evaluate as evaluate
    from eigenfield.evaluation import evaluate_clip as evaluate_clip
    from eigenfield.gltf import save as save
    from eigenfield.gltf import validate as validate
    from eigenfield.reconstruction import SurfaceOptions as SurfaceOptions
    from eigenfield.reconstruction.whole import Reconstruction as Reconstruction
    from eigenfield.reconstruction.whole import reconstruct as reconstruct
    from eigenfield.rendering import render as render
    from eigenfield.rendering import render_many as render_many
    from eigenfield.runtime.parallel import set_threads as set_threads
    from eigenfield.viewer import view as view
    from eigenfield.viewer.exports import export as export

    open = _opening.open_path

_HOME = {  # a room, or a name in a room where that is another
    "BatchResult": "batches",
    "Camera": "core.camera",
    "CaptureError": "core.errors",
    "Clip": "api",
    "EigenfieldError": "core.errors",
    "EncodeOptions": "encoding",
    "Footage": "capture",
    "FormatError": "core.errors",
    "LightField": "capture",
    "Mesh": "core.mesh",
    "OpenOptions": "core.open_options",
    "OptionError": "core.errors",
    "OutputError": "core.errors",
    "PhotoSet": "capture",
    "Progress": "core.progress",
    "ProxyError": "core.errors",
    "Reconstruction": "reconstruction.whole",
    "Rights": "core.rights",
    "Scene": "api",
    "SurfaceOptions": "reconstruction",
    "Target": "encoding",
    "WorkerError": "core.errors",
    "batch": "batches",
    "calibrate": "calibration",
    "encode": "api",
    "evaluate": "evaluation",
    "evaluate_clip": "evaluation",
    "export": "viewer.exports",
    "load": "api",
    "load_clip": "api",
    "open": "capture:open_path",
    "reconstruct": "reconstruction.whole",
    "render": "rendering",
    "render_many": "rendering",
    "save": "gltf",
    "set_threads": "runtime.parallel",
    "validate": "gltf",
    "view": "viewer",
}
__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'eigenfield' has no attribute {name!r}")
    room, _, inner = _HOME[name].partition(":")
    value = getattr(importlib.import_module(f"eigenfield.{room}"), inner or name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
