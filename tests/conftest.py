"""Shared by all tests."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from hypothesis import settings

from eigenfield.runtime.signals import STOP_SIGNALS
from support.printed import check_printed
from support.program import Ran, call

EXAMPLES = int(os.environ.get("EIGENFIELD_EXAMPLES", "40"))  # of a property; each night as many as this says
settings.register_profile("eigenfield", deadline=None, max_examples=EXAMPLES)  # times of a busy machine say nothing
settings.load_profile("eigenfield")

# Tests that run in the background, or under nohup, inherit signals that are ignored. The program leaves them so.
for number in STOP_SIGNALS:
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)


@pytest.fixture(scope="session", autouse=True)
def every_file_keeps_to_the_schema():
    """Whatever a test writes as a .glb has its JSON checked; files that a test damages afterwards are not."""
    from eigenfield.gltf import write, write_clip
    from support.schema import check_file

    def checking(check_readable):
        def checked(text: bytes, binary: bytes, *groups: int) -> None:
            check_readable(text, binary, *groups)
            check_file(text, binary)

        return checked

    with pytest.MonkeyPatch.context() as patch:
        for module in (write, write_clip):
            patch.setattr(module, "check_readable", checking(module.check_readable))
        yield


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real captures; tests that need it are skipped where EIGENFIELD_DATA does not name one."""
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder or not Path(folder).is_dir():
        pytest.skip("EIGENFIELD_DATA names no folder of captures")
    return Path(folder)


@pytest.fixture
def run(capfd):
    """Call the program as the shell does, in this process: exit code, standard output and standard error, with what
    goes past Python to either. JSON keeps to the verb's schema."""

    def ran(*words: object) -> Ran:
        capfd.readouterr()
        result = Ran(call(*words), *capfd.readouterr())
        check_printed(words, result)
        return result

    return ran


@pytest.fixture(scope="session")
def good() -> dict[str, bytes]:
    """A scene file of each codec, with everything in it."""
    from eigenfield.gltf import encode_scene
    from support.glb_surgery import CODECS
    from support.scenes import tiny_scene

    scene = tiny_scene(3, 3, cameras=6, held_out=(1,))
    return {codec: encode_scene(scene, codec=codec) for codec in CODECS}


@pytest.fixture(scope="session")
def fitted(tmp_path_factory) -> tuple[Path, Path]:
    """A folder of nine photographs and their proxy, and the file that they were fitted to."""
    from support.captures import write_capture

    folder = write_capture(tmp_path_factory.mktemp("fit") / "nine")
    output = folder.parent / "fitted.glb"
    words = ["--proxy", folder / "proxy.ply", "-n", "4", "-q", "-o", output, "--quality", "92"]
    assert call("encode", folder, *words) == 0
    return folder, output


@pytest.fixture(scope="module")
def context():
    """An OpenGL context; tests that need it are skipped where there is none."""
    pytest.importorskip("moderngl", reason="needs moderngl: pip install 'eigenfield[gpu]'")
    from eigenfield.core.errors import OptionError
    from eigenfield.rendering.opengl import renderer as opengl

    try:
        made = opengl.make_context()
    except OptionError as error:
        pytest.skip(f"needs an OpenGL driver: {error}")
    yield made
    made.release()
