"""Shared by all tests."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real captures; tests that need it are skipped where EIGENFIELD_DATA does not name one."""
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder or not Path(folder).is_dir():
        pytest.skip("EIGENFIELD_DATA names no folder of captures")
    return Path(folder)


@pytest.fixture(scope="session")
def good() -> dict[str, bytes]:
    """A scene file of each codec, with everything in it."""
    from glb_surgery import CODECS
    from scenes import tiny_scene

    from eigenfield.format import encode_scene

    scene = tiny_scene(3, 3, cameras=6, held_out=(1,))
    return {codec: encode_scene(scene, codec=codec) for codec in CODECS}


@pytest.fixture(scope="module")
def context():
    """An OpenGL context; tests that need it are skipped where there is none."""
    pytest.importorskip("moderngl", reason="needs moderngl: pip install 'eigenfield[gpu]'")
    from eigenfield.errors import OptionError
    from eigenfield.rendering import opengl

    try:
        made = opengl.make_context()
    except OptionError as error:
        pytest.skip(f"needs an OpenGL driver: {error}")
    yield made
    made.release()
