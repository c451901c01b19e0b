"""Install a wheel into an environment of its own, away from its source tree, and use it.

python packaging/try_wheel.py dist [BILL.json]: with it, the environment's bill of materials (CycloneDX) is written.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import venv
from pathlib import Path

USE = """
from pathlib import Path
import eigenfield as ef
from eigenfield.demo.capture import draw_demo_capture

assert "site-packages" in ef.__file__, ef.__file__
draw_demo_capture(Path("capture"), rows=3, columns=3, size=96)
scene = ef.encode("capture", proxy="capture/proxy.ply")
ef.save(scene, "scene.glb")
assert not [finding for finding in ef.validate("scene.glb") if finding.severity == "error"]
ef.export("scene.glb", "scene.html", kind="html")
"""


REQUIREMENTS = Path(__file__).with_name("requirements-run.txt")


def main(folder: Path, bill: Path | None) -> None:
    """Raise CalledProcessError where anything fails."""
    (wheel,) = folder.resolve().glob("*.whl")
    with tempfile.TemporaryDirectory() as place:
        venv.create(Path(place) / "venv", with_pip=True)
        programs = Path(place) / "venv" / ("Scripts" if sys.platform == "win32" else "bin")

        def run(program: str, *words: object) -> None:
            subprocess.run([programs / program, *map(str, words)], check=True, cwd=place)

        run("python", "-m", "pip", "install", "--quiet", "--require-hashes", "-r", REQUIREMENTS.resolve())
        run("python", "-m", "pip", "install", "--quiet", "--no-deps", wheel)
        run("python", "-m", "pip", "check")
        run("eigenfield", "--version")
        run("eigenfield", "help", "format")
        run("python", "-I", "-c", USE)
        run("eigenfield", "info", "scene.glb")
        if bill is not None:
            run("python", "-m", "pip", "uninstall", "--quiet", "--yes", "pip", "setuptools")
            words = ["environment", "--output-reproducible", "--spec-version", "1.6", "--output-file", bill.resolve()]
            subprocess.run([sys.executable, "-m", "cyclonedx_py", *words, programs / "python"], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
