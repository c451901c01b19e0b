"""The Blender add-on as a zip, of equal bytes each time: python packaging/addon.py OUTPUT.zip [1.2.3]"""

from __future__ import annotations

import re
import sys
import zipfile
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "addons/blender/eigenfield"
DATE = (1980, 1, 1, 0, 0, 0)


def pack(path: Path, version: str | None = None) -> None:
    """Write the files of the add-on.

    Args:
        path: Of the zip.
        version: Of a release; None: as the manifest says.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted([*SOURCE.glob("*.py"), *SOURCE.glob("*.toml"), SOURCE.parents[2] / "LICENSE"]):
            data = file.read_bytes()
            if version and file.suffix == ".toml":
                data = re.sub(rb'(?m)^version = ".*"$', f'version = "{version}"'.encode(), data)
            archive.writestr(zipfile.ZipInfo(file.name, DATE), data, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    pack(Path(sys.argv[1]), *sys.argv[2:])
