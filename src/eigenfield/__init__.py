"""eigenfield: photographs from a camera array in, one small .glb to look around in out.

    import eigenfield as ef

    made = ef.reconstruct(ef.open_any("photos/"))
    scene = ef.encode(made.light_field, made.mesh)
    scene.save("scene.glb")
    picture = ef.render(ef.load("scene.glb"), at=(0.3, -0.2))

Everything is loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from eigenfield.camera import Camera as Camera
    from eigenfield.capture import LightField as LightField
    from eigenfield.capture import PhotoSet as PhotoSet
    from eigenfield.capture import open_any as open_any
    from eigenfield.capture import open_capture as open_capture
    from eigenfield.capture import open_photographs as open_photographs
    from eigenfield.errors import CaptureError as CaptureError
    from eigenfield.errors import EigenfieldError as EigenfieldError
    from eigenfield.errors import FormatError as FormatError
    from eigenfield.errors import OptionError as OptionError
    from eigenfield.errors import OutputError as OutputError
    from eigenfield.errors import ProxyError as ProxyError
    from eigenfield.evaluation import evaluate as evaluate
    from eigenfield.format import load as load
    from eigenfield.mesh import Mesh as Mesh
    from eigenfield.parallel import set_threads as set_threads
    from eigenfield.pipeline import Target as Target
    from eigenfield.pipeline import encode as encode
    from eigenfield.progress import Progress as Progress
    from eigenfield.reconstruction import Reconstruction as Reconstruction
    from eigenfield.reconstruction import reconstruct as reconstruct
    from eigenfield.rendering import render as render
    from eigenfield.scene import Scene as Scene

_HOME = {
    "Camera": "camera",
    "CaptureError": "errors",
    "EigenfieldError": "errors",
    "FormatError": "errors",
    "LightField": "capture",
    "Mesh": "mesh",
    "OptionError": "errors",
    "OutputError": "errors",
    "PhotoSet": "capture",
    "Progress": "progress",
    "ProxyError": "errors",
    "Reconstruction": "reconstruction",
    "Scene": "scene",
    "Target": "pipeline",
    "encode": "pipeline",
    "evaluate": "evaluation",
    "load": "format",
    "open_any": "capture",
    "open_capture": "capture",
    "open_photographs": "capture",
    "reconstruct": "reconstruction",
    "render": "rendering",
    "set_threads": "parallel",
}
__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'eigenfield' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"eigenfield.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
