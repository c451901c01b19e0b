"""What a release needs: bundled parts and licences by name, locked versions, workflows, packages of equal bytes."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tarfile
import zipfile
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
import yaml
from packaging.utils import canonicalize_name

from eigenfield.cli.help import TOPICS

ROOT = Path(__file__).parents[1]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
WHEEL_MAX_BYTES = 2_000_000
SDIST_FILES = (
    "CHANGELOG.md",
    "constraints.txt",
    "docs/format.md",
    "docs/decisions/030-small-files.md",
    "tests/reference.py",
    "web/package.json",
    "NOTICE",
)


def text(name: str) -> str:
    return (ROOT / name).read_text("utf-8")


def test_what_the_viewer_bundles_is_named():
    sources = [*(ROOT / "web/viewer/src").glob("*.ts"), *(ROOT / "web/eigenfield-three/src").glob("*.ts")]
    taken = {name for path in sources for name in re.findall(r'from "([^."][^"]*)"', path.read_text("utf-8"))}
    assert {name.split("/")[0] for name in taken} == {"three", "eigenfield-three"}
    version = json.loads(text("web/package-lock.json"))["packages"]["node_modules/three"]["version"]
    assert f"three.js {version} " in text("NOTICE") and "Permission is hereby granted" in text("NOTICE")
    (bundled,) = json.loads(text("packaging/bundled.cdx.json"))["components"]
    assert (bundled["name"], bundled["version"]) == ("three", version)
    revision = version.split(".")[1]
    assert re.search(f"[`\"']{revision}[`\"']", text("src/eigenfield/viewer/static/viewer.js"))


def licences():
    sys.path.insert(0, str(ROOT / "packaging"))
    try:
        import licences
    finally:
        sys.path.pop(0)
    return licences


def test_licences_are_permitted_and_on_the_page():
    module, page = licences(), text("docs/licences.md")
    try:
        packages = module.brought()
    except PackageNotFoundError as error:
        pytest.skip(f"{error.name} is not installed")
    said = {name: module.licence(distribution(name)) for name in packages}
    assert [name for name, expression in said.items() if module.refused(name, expression)] == []
    if sys.platform == "linux":  # elsewhere other packages come along, and other libraries are in the wheels
        missing = [f"| {name} | {said[name]} | {group} |" for name, group in packages.items()]
        assert [row for row in missing if row not in page] == [], "python packaging/licences.py --write"


def test_a_licence_that_is_not_permitted_is_refused():
    module = licences()
    assert module.refused("other", "GPL-3.0-or-later") and module.refused("other", "MIT AND AGPL-3.0-only")
    assert module.refused("other", "") and not module.refused("other", "MIT OR Apache-2.0")


def pins(name: str) -> dict[str, str]:
    found = re.findall(r"^([A-Za-z0-9._-]+)==([^\s;]+)", text(name), re.MULTILINE)
    return {canonicalize_name(package): version for package, version in found}


@pytest.mark.parametrize("name", ["run", "test"])
def test_the_locked_versions_are_those_of_the_constraints(name):
    locked = text(f"packaging/requirements-{name}.txt")
    versions = pins(f"packaging/requirements-{name}.txt")
    assert versions and versions.items() <= pins("constraints.txt").items(), "packaging/lock.sh"
    entries = re.split(r"\n(?=\S)", locked.strip())
    assert len(entries) == len(versions) and all("--hash=sha256:" in entry for entry in entries)
    if name == "test":
        assert set(versions) == set(pins("constraints.txt"))


def test_one_action_has_one_version():
    used = {name for path in WORKFLOWS for name in re.findall(r"uses: (\S+ # v\S+)", path.read_text("utf-8"))}
    assert len(used) == len({name.partition("@")[0] for name in used})


def test_files_that_the_workflows_name_are_there():
    names = {
        name
        for path in WORKFLOWS
        for name in re.findall(r"(?<![\w/])(?:packaging|tests)/[\w./-]+", path.read_text("utf-8"))
    }
    assert names and [name for name in names if not (ROOT / name).exists()] == []


def test_the_recipe_has_the_dependencies():
    recipe = yaml.safe_load(text("packaging/conda/recipe.yaml"))
    renamed = {"matplotlib": "matplotlib-base", "opencv-python-headless": "py-opencv"}
    project = text("pyproject.toml").partition("dependencies = [")[2].partition("\n]")[0]
    ours = {tuple(entry.split(">=")) for entry in re.findall(r'"([^"]+)"', project)}
    theirs = {tuple(entry.split(" >=")) for entry in recipe["requirements"]["run"] if not entry.startswith("python ")}
    assert theirs == {(renamed.get(name, name), ".".join(version.split(".")[:3])) for name, version in ours}


def test_the_citation_is_that_of_the_readme():
    citation, readme = yaml.safe_load(text("CITATION.cff")), text("README.md")
    (paper,) = citation["references"]
    names = " and ".join(f"{author['family-names']}, {author['given-names']}" for author in paper["authors"])
    for said in (citation["title"], paper["title"], names, str(paper["year"])):
        assert said in readme


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Wheel and sdist, built twice from two clones at different times."""
    places = []
    for number in range(2):
        place = tmp_path_factory.mktemp(f"build-{number}")
        source = place / f"source-{number}"
        subprocess.run(["git", "clone", "-q", ROOT, source], check=True)
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1767225600"}
        command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", place, source]
        subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
        places.append(place)
    return places


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["whl", "tar.gz"])
def test_two_builds_have_equal_bytes(built, ending):
    one, two = (next(place.glob(f"*.{ending}")) for place in built)
    assert one.name == two.name and one.read_bytes() == two.read_bytes()


@pytest.mark.slow
def test_the_wheel_is_small_and_names_what_it_bundles(built):
    path = next(built[0].glob("*.whl"))
    assert path.stat().st_size < WHEEL_MAX_BYTES
    with zipfile.ZipFile(path) as wheel:
        names = set(wheel.namelist())
        info = next(name for name in names if name.endswith("/METADATA")).partition("/")[0]
        assert {name.split("/")[0] for name in names} == {"eigenfield", info}
        assert {f"eigenfield/docs/{topic}.md" for topic in TOPICS} <= names
        assert {"eigenfield/py.typed", "eigenfield/viewer/static/viewer.js"} <= names
        assert {f"{info}/licenses/{name}" for name in ("LICENSE", "NOTICE")} <= names
        bill = json.loads(wheel.read(f"{info}/sboms/bundled.cdx.json"))
    assert bill["bomFormat"] == "CycloneDX"


@pytest.mark.slow
def test_the_sdist_holds_what_a_distributor_needs_and_builds_without_git(built, tmp_path):
    path = next(built[0].glob("*.tar.gz"))
    with tarfile.open(path) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.iterdir()
    assert [name for name in SDIST_FILES if not (folder / name).is_file()] == []
    command = [sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", tmp_path / "again", folder]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    assert [wheel.name for wheel in (tmp_path / "again").iterdir()] == [next(built[0].glob("*.whl")).name]
