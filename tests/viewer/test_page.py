"""The viewer's page as one file and in a notebook: whole, the same every time, and unmoved by hostile names."""

from __future__ import annotations

import base64
import gc
import hashlib
import json
import re
import weakref
import zlib
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.core.errors import OutputError
from eigenfield.gltf import encode_scene, outline, save
from eigenfield.viewer import notebook, page, page_html, scene_html, single_file
from eigenfield.viewer.page import page_title
from support.http_client import write_build
from support.scenes import tiny_scene

HOSTILE = [
    "</script><img src=x onerror=alert(1)>",
    "<!--<script>",
    "]]></SCRIPT >",
    "\"'`&amp;</title><svg onload=alert(1)>",
    "\u2028\u2029\ufeff",
    "\0\r\n\t\x7f",
    "\ud800 half a character",
    "__proto__",
    "{{}} {} %s ${x} \\u003c \\",
    "日本語 🎴",
]
GLB = bytes(range(256)) * 5


@pytest.fixture(autouse=True)
def build(tmp_path, monkeypatch):
    monkeypatch.setattr(page, "STATIC_FOLDER", write_build(tmp_path / "static"))


class Elements(HTMLParser):
    """Every element with its attributes, and the text of scripts, styles and titles."""

    def __init__(self, data: bytes) -> None:
        super().__init__(convert_charrefs=False)
        self.found: list[tuple[str, dict[str, str | None], str]] = []
        self.inside = False
        self.feed(data.decode("utf-8"))
        self.close()

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs), ""))
        self.inside = True

    def handle_endtag(self, tag):
        self.inside = False

    def handle_data(self, data):
        if self.inside:
            tag, attributes, text = self.found[-1]
            self.found[-1] = tag, attributes, text + data

    def handle_entityref(self, name):
        self.handle_data(f"&{name};")

    def handle_charref(self, name):
        self.handle_data(f"&#{name};")

    def one(self, tag, **attributes):
        (element,) = [e for e in self.found if e[0] == tag and attributes.items() <= e[1].items()]
        return element

    def config(self):
        return json.loads(self.one("script", id="eigenfield-config")[2])


def test_the_served_page_holds_its_configuration():
    config = {"title": "scene.glb", "scene": "scene.glb", "bytes": 5, "photographs": {"a": "photographs/0"}}
    elements = Elements(page_html(config))
    assert elements.config() == config
    assert [tag for tag, *_ in elements.found] == [
        "html", "head", "meta", "title", "link", "script", "link", "body", "script"
    ]  # fmt: skip
    assert page_html({}).decode().count("<title>eigenfield</title>") == 1


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_titles_and_names_stay_text(text):
    for made, same in (
        (single_file(GLB, title=text), Elements(single_file(GLB, title="x"))),
        (page_html({"title": text, "photographs": {text: "photographs/0"}}), Elements(page_html({}))),
    ):
        elements = Elements(made)
        assert [(tag, list(attributes)) for tag, attributes, _ in elements.found] == [
            (tag, list(attributes)) for tag, attributes, _ in same.found
        ]
        config = elements.config()
        assert config["title"] == text and list(config.get("photographs", [text])) == [text]
        raw = elements.one("script", id="eigenfield-config")[2]
        assert raw.isascii() and not set("<>&\u2028") & set(raw)
        assert "<" not in elements.one("title")[2]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text() | st.text(alphabet="<>/!-scriptSCRIPT&\"'", max_size=30))
def test_any_title_comes_back(text):
    elements = Elements(single_file(b"", title=text))
    assert elements.config()["title"] == text
    assert [tag for tag, *_ in elements.found].count("script") == 4


def test_one_file_has_everything_and_asks_for_nothing():
    elements = Elements(single_file(GLB, title="t", metres_per_unit=0.25))
    assert base64.b64decode(elements.one("script", id="eigenfield-scene")[2]) == GLB
    config = elements.config()
    assert config["embedded"] is True and config["bytes"] == len(GLB) and config["metresPerUnit"] == 0.25
    assert not {"scene", "photographs"} & set(config)
    urls = [a for _, attributes, _ in elements.found for a in (attributes.get("src"), attributes.get("href")) if a]
    assert urls == ["data:,"]


def test_the_policy_of_one_file_allows_what_is_in_it_and_no_more():
    made = single_file(GLB, title="t")
    elements = Elements(made)
    meta = elements.one("meta", **{"http-equiv": "Content-Security-Policy"})[1]["content"]
    policy = dict(part.strip().split(" ", 1) for part in meta.split(";"))
    assert policy == {
        "default-src": "'none'",
        "script-src": f"'{digest(elements.one('script', type='module')[2])}' '{digest(packed_script(elements))}'",
        "style-src": f"'{digest(elements.one('style')[2])}'", "img-src": "blob: data:", "connect-src": "blob: data:",
        "media-src": "blob:", "base-uri": "'none'", "form-action": "'none'",
    }  # fmt: skip
    order = [tag for tag, *_ in elements.found]
    assert order.index("meta") < order.index("script") and made.index(b"http-equiv") < 1024


def packed_script(elements):
    return zlib.decompress(base64.b64decode(elements.one("script", id="eigenfield-viewer")[2])).decode()


def digest(text):
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def test_scripts_and_styles_cannot_end_their_elements():
    elements = Elements(single_file(GLB, title="t"))
    style = elements.one("style")[2]
    assert packed_script(elements) == 'document.title += "</script><!--"; const pattern = /<\\/SCRIPT>/;\n'
    assert style == "body::after { content: '<\\/style>' }\n"


def test_the_same_input_gives_the_same_bytes():
    assert single_file(GLB, title="t") == single_file(GLB, title="t")
    assert page_html({"a": 1, "b": 2}) == page_html({"a": 1, "b": 2})


def test_numbers_that_json_lacks_are_a_bug():
    with pytest.raises(ValueError):
        page_html({"metresPerUnit": float("nan")})


@pytest.mark.parametrize(
    "damage",
    [
        lambda static: (static / "viewer.js").unlink(),
        lambda static: (static / "index.html").unlink(),
        lambda static: (static / "index.html").write_text("<html><head></head></html>"),
        lambda static: (static / "index.html").write_text(
            (static / "index.html").read_text().replace('src="./viewer.js"', 'src="/other.js"')
        ),
    ],
)
def test_a_page_that_was_not_built_is_said_in_one_line(damage):
    damage(page.STATIC_FOLDER)
    with pytest.raises(OutputError) as caught:
        single_file(GLB, title="t")
    assert caught.value.code == "viewer-build" and "npm run build" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_committed_build_takes_its_configuration(monkeypatch):
    monkeypatch.undo()
    elements = Elements(single_file(GLB, title="</script>"))
    assert elements.config()["title"] == "</script>"
    assert base64.b64decode(elements.one("script", id="eigenfield-scene")[2]) == GLB
    assert len(packed_script(elements)) > 100_000
    assert Elements(page_html({"title": "t"})).config() == {"title": "t"}
    assert not re.search(rb'(?:src|href)="(?:https?:)?//', page_html({}))


# notebooks


def frame(html):
    (element,) = Elements(html.encode()).found
    assert element[0] == "iframe"
    return element[1]


def test_a_loaded_scene_shows_its_file(tmp_path):
    path = tmp_path / "scene.glb"
    save(tiny_scene(), path)
    scene = ef.load(path)
    data = path.read_bytes()
    path.write_bytes(b"replaced")
    attributes = frame(scene._repr_html_())
    inner = Elements(attributes["srcdoc"].encode())
    assert base64.b64decode(inner.one("script", id="eigenfield-scene")[2]) == data
    assert attributes["sandbox"] == "allow-scripts allow-downloads"  # an origin of its own
    assert "xr-spatial-tracking" in attributes["allow"] and "allowfullscreen" in attributes
    assert attributes["height"] == "480" and attributes["title"]


def test_a_scene_from_elsewhere_is_coded_once(monkeypatch):
    scene, coded = tiny_scene(), []
    monkeypatch.setattr(notebook, "encode_scene", lambda scene: coded.append(scene) or encode_scene(scene))
    assert scene_html(scene) == scene_html(scene)
    inner = Elements(frame(scene_html(scene))["srcdoc"].encode())
    assert base64.b64decode(inner.one("script", id="eigenfield-scene")[2]) == encode_scene(scene)
    assert len(coded) == 1


def test_what_cannot_be_shown_says_so(monkeypatch):
    scene = tiny_scene()
    with monkeypatch.context() as patch:
        patch.setattr(notebook, "NOTEBOOK_MAX_BYTES", 100)
        assert scene_html(scene).startswith("<pre>") and "eigenfield view" in scene_html(scene)
    monkeypatch.setattr(page, "STATIC_FOLDER", page.STATIC_FOLDER / "<none>")
    assert "npm run build" in scene_html(scene) and "<none>" not in scene_html(scene)


def test_what_is_shown_of_a_scene_lives_as_long_as_the_scene():
    scene = tiny_scene()
    assert scene_html(scene) is not None
    gone = weakref.ref(scene)
    del scene
    gc.collect()
    assert gone() is None


def test_an_outline_is_the_scene_without_its_planes(tmp_path):
    path = tmp_path / "scene.glb"
    save(tiny_scene(), path)
    whole, (part, data) = ef.load(path), outline(path)
    assert part.appearance.planes == () and part.rig.names == whole.rig.names and part.settings == whole.settings
    assert np.array_equal(part.proxy.mesh.vertices, whole.proxy.mesh.vertices)
    assert data == path.read_bytes()


@pytest.mark.parametrize(
    ("path", "title"),
    [
        ("my_page.html", "my page"),
        ("tarot/scene.html", "tarot"),
        ("old_fern/index.html", "old fern"),
        ("/scene.html", "scene"),
    ],
)
def test_a_page_is_called_by_what_says_something(path, title):
    assert page_title(Path(path)) == title
