"""The site: its references are whole, its scene opens; built, its links lead somewhere and its first page is light."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

import pytest

import eigenfield as ef
from eigenfield.gltf import stores_clip
from support.browsers import CHROMIUM, OTHERS, lacks

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
WEB = ROOT / "web"
SPHINX = all(importlib.util.find_spec(name) for name in ("sphinx", "furo", "myst_parser"))
BROWSER = shutil.which("node") and CHROMIUM and (WEB / "node_modules" / "axe-core").is_dir()


class Links(HTMLParser):
    """The anchors of a page, and the addresses that it fetches or leads to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: set[str] = set()
        self.targets: list[str] = []
        self.fetched: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = dict(attributes)
        self.ids |= {found[key] for key in ("id", "name") if found.get(key)}
        for key in ("href", "src"):
            if found.get(key):
                self.targets.append(found[key])
                if tag != "a":
                    self.fetched.append(found[key])


def test_the_scene_of_the_first_page_opens():
    assert (DOCS / "scene.glb").stat().st_size <= 200_000
    scene = ef.load(DOCS / "scene.glb")
    assert ef.validate(DOCS / "scene.glb") == [] and len(scene.rig.cameras) == 81


def test_encoded_captures_are_small_and_say_what_they_were_made_from(monkeypatch):
    monkeypatch.syspath_prepend(DOCS / "_ext")
    import scene_page

    found = scene_page.captures(DOCS)
    assert {path.stem for path in (DOCS / "scenes").iterdir()} == {path.stem for path in found}
    clips = {path for path in found if stores_clip(path)}
    assert {path.stem for path in clips} == {"in-motion"}
    for path, about in found.items():
        assert path.stat().st_size <= (400_000 if path in clips else 200_000) and ef.validate(path) == []
        assert about["title"] and re.search(r"licence|CC0", about["from"])
        assert f'href="scenes/{path.stem}.html"' in scene_page.card(path, about)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The built site: the one that EIGENFIELD_SITE names, which `make docs` has just made, or one of its own."""
    if built := os.environ.get("EIGENFIELD_SITE"):
        return Path(built).resolve()
    if not SPHINX:
        pytest.skip("needs Sphinx, furo and MyST: pip install -e '.[docs]'")
    out = tmp_path_factory.mktemp("site")
    words = ["-W", "--keep-going", "-q", "-d", str(out / "trees"), str(DOCS), str(out / "html")]
    done = subprocess.run([sys.executable, "-m", "sphinx", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return out / "html"


@pytest.mark.slow
def test_links_of_the_built_site_lead_somewhere(site):
    pages = {path.resolve(): Links(path.read_text("utf-8")) for path in site.rglob("*.html")}
    assert len(pages) > 50
    lost = []
    for path, page in pages.items():
        assert [to for to in page.fetched if urlsplit(to).netloc] == [], path  # no page asks another host
        for target in page.targets:
            if urlsplit(target).scheme:
                continue
            place, anchor = urldefrag(target)
            to = (path.parent / unquote(urlsplit(place).path)).resolve() if place else path
            if not to.exists() or (anchor and to in pages and unquote(anchor) not in pages[to].ids | {""}):
                lost.append((path.relative_to(site).as_posix(), target))
    assert lost == []


@pytest.mark.slow
def test_programs_find_every_page_as_markdown(site):
    listed = re.findall(r"^- \[[^]]+\]\(([^)]+)\)", (site / "llms.txt").read_text("utf-8"), re.MULTILINE)
    assert len(listed) > 25 and all((site / page).is_file() for page in listed)
    written = {path.relative_to(site).with_suffix("") for path in site.rglob("*.md")}
    made_by_sphinx = {"genindex", "py-modindex", "search"}
    shown = {path.relative_to(site).with_suffix("") for path in site.rglob("*.html") if path.stem not in made_by_sphinx}
    captures = {Path("scenes") / path.stem for path in DOCS.glob("scenes/*.glb")}
    assert shown - written == {Path("scene"), Path("open/index"), *captures}
    reference = (site / "reference/python.md").read_text("utf-8")
    assert all(f"### {name}\n" in reference for name in set(ef.__all__) - {"__version__"})


@pytest.mark.slow
@pytest.mark.skipif(not BROWSER, reason="needs Node.js, Chromium, and npm ci in web/")
@pytest.mark.parametrize("engine", ["chromium", *OTHERS])
def test_the_site_in_a_browser(site, engine):
    if engine in OTHERS and (remedy := lacks(engine)):
        pytest.skip(remedy)
    file = "tests/site.mjs" if engine == "chromium" else "tests/site-engine.mjs"
    more = {"EIGENFIELD_SITE": str(site), "EIGENFIELD_CHROMIUM": str(CHROMIUM), "EIGENFIELD_ENGINE": engine}
    done = subprocess.run(
        ["node", "--test", "--test-force-exit", "--test-reporter=spec", file],
        cwd=WEB, env=os.environ | more,
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
