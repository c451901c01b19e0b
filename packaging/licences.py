"""The licences of all that `pip install eigenfield` and its extras bring: checked, and written to docs/licences.md.

python packaging/licences.py --write, where all extras are installed. A licence that is not in PERMITTED needs a row in
EXCEPTIONS, which says why it is there.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections import deque
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "licences.md"
EXTRAS = "arrays", "cluster", "gpu", "meshes", "photos", "raw", "renders", "s3", "splats", "usd"  # those of users
PERMITTED = {
    "0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "CC0-1.0", "MIT", "MIT-0",
    "MIT-CMU", "PSF-2.0", "Zlib",
}  # fmt: skip
EXCEPTIONS = {
    "asyncssh": "EPL-2.0 or GPL-2.0-or-later: it comes only by the extra `cluster`, and is loaded only for `ssh:HOST`",
    "pillow-jxl-plugin": "GPL-3.0-or-later: it comes only by the extra `photos`, and is loaded only to read JPEG XL",
    "usd-core": "LicenseRef-TOST-1.0, Apache-2.0 with other words on trademarks: it comes only by the extra `usd`",
}
# what metadata say in words, or not at all
WORDS = {
    "Apache Software License": "Apache-2.0",
    "BSD License": "BSD-3-Clause",
    "MIT License": "MIT",
    "Python Software Foundation License": "PSF-2.0",
    "GNU Lesser General Public License v3 (LGPLv3)": "BSD-3-Clause",  # pi_heif means the libheif in its wheel
}
UNSAID = {"dask-jobqueue": "BSD-3-Clause", "openexr": "BSD-3-Clause", "partd": "BSD-3-Clause", "xatlas": "MIT"}
# libraries in wheels for Linux whose licence asks for more than a notice
COPYLEFT = {
    "asound": "LGPL-2.1-or-later", "avcodec": "LGPL-2.1-or-later, with x264 GPL-2.0-or-later",
    "de265": "LGPL-3.0-or-later", "gmp": "LGPL-3.0-or-later", "gnutls": "LGPL-2.1-or-later",
    "heif": "LGPL-3.0-or-later", "mp3lame": "LGPL-2.0-or-later", "nettle": "LGPL-3.0-or-later",
    "unistring": "LGPL-3.0-or-later", "x264": "GPL-2.0-or-later", "x265": "GPL-2.0-or-later",
}  # fmt: skip
LINKED = {"rawpy": ["LibRaw (LGPL-2.1 or CDDL-1.0)"]}  # in no file of its own
HEAD = """# Licences

eigenfield is under the MIT licence, and so is [three.js](../NOTICE), which the viewer holds.
`packaging/licences.py` writes this page, and tests compare it with what is installed. It lists what
`pip install eigenfield` brings, and what extras such as `eigenfield[photos]` bring.

{exceptions}

| package | licence | comes with |
|---|---|---|
{rows}

Some wheels hold libraries of others under licences that ask for more than a notice. Whoever passes these wheels on,
in a container for example, keeps to them:

| package | libraries in its wheel for Linux |
|---|---|
{libraries}
"""


def brought() -> dict[str, str]:
    """Each package by its canonical name, and what it comes with: "eigenfield", or the extras that bring it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    groups = {"eigenfield": project["dependencies"]}
    groups |= {f"`{extra}`": project["optional-dependencies"][extra] for extra in EXTRAS}
    found: dict[str, list[str]] = {}
    for group, requirements in groups.items():
        waiting = deque(Requirement(text) for text in requirements)
        while waiting:
            wanted = waiting.popleft()
            name = canonicalize_name(wanted.name)
            if group in found.get(name, []) or "eigenfield" in found.get(name, []):
                continue
            if wanted.marker is not None and not wanted.marker.evaluate({"extra": ""}):
                continue
            found.setdefault(name, []).append(group)
            waiting += [Requirement(text) for text in distribution(name).requires or []]
    return {name: ", ".join(with_) for name, with_ in sorted(found.items())}


def licence(package: Distribution) -> str:
    """The SPDX expression of an installed package's licence."""
    said = package.metadata.json
    if expression := said.get("license_expression"):
        return str(expression)
    names = [line.rpartition(" :: ")[2] for line in said.get("classifier", []) if line.startswith("License :: ")]
    known = [WORDS[name] for name in names if name in WORDS]
    return " AND ".join(known) or UNSAID.get(canonicalize_name(package.name)) or str(said.get("license", ""))


def libraries(package: Distribution) -> list[str]:
    """The libraries of COPYLEFT that the package's wheel holds, with their licences."""
    names = {match[1] for file in package.files or [] if (match := re.match(r"lib([a-z0-9]+)[-.]", file.name))}
    linked = LINKED.get(canonicalize_name(package.name), [])
    return [*(f"{name} ({COPYLEFT[name]})" for name in sorted(names & set(COPYLEFT))), *linked]


def refused(name: str, expression: str) -> bool:
    """Whether a licence is neither permitted nor among the exceptions."""
    return name not in EXCEPTIONS and not set(re.split(r" AND | OR ", expression)) <= PERMITTED


def write() -> str:
    """The page; SystemExit names what is not installed, or has a licence that is not permitted."""
    try:
        packages = {name: (distribution(name), group) for name, group in brought().items()}
    except PackageNotFoundError as error:
        raise SystemExit(f"{error.name} is not installed: pip install -c constraints.txt -e '.[test]'") from error
    licences = {name: licence(package) for name, (package, _) in packages.items()}
    if bad := [f"{name} ({expression})" for name, expression in licences.items() if refused(name, expression)]:
        raise SystemExit(f"not permitted: {', '.join(bad)}")
    held = {name: libraries(package) for name, (package, _) in packages.items()}
    return HEAD.format(
        exceptions="\n".join(f"- `{name}` is under {why}." for name, why in EXCEPTIONS.items()),
        rows="\n".join(f"| {name} | {licences[name]} | {group} |" for name, (_, group) in packages.items()),
        libraries="\n".join(f"| {name} | {', '.join(files)} |" for name, files in held.items() if files),
    )


if __name__ == "__main__":
    page = write()
    if "--write" in sys.argv:
        PAGE.write_text(page, encoding="utf-8", newline="\n")
    elif page != PAGE.read_text("utf-8"):
        raise SystemExit("docs/licences.md is not what is installed: python packaging/licences.py --write")
