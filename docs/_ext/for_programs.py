"""The site for programs that read: each page as Markdown beside it, and llms.txt, which lists them (llmstxt.org)."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING

from docutils import nodes
from sphinx import addnodes

import eigenfield

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.environment import BuildEnvironment

BLOCK = re.compile(r"```\{(?:eval-rst|toctree)\}\n(.*?)```\n?", re.DOTALL)
NAME = re.compile(r"^\.\. auto(?:function|class):: (\w+)$", re.MULTILINE)
FRONT_MATTER = re.compile(r"\A---\n.*?\n---\n+", re.DOTALL)


def texts_of(env: BuildEnvironment) -> dict[str, str]:
    """The Markdown of each page, kept with the other results of reading."""
    if not hasattr(env, "page_texts"):
        env.page_texts = {}
    return env.page_texts


def keep(app: Sphinx, name: str, source: list[str]) -> None:
    """Keep a page as the parser gets it."""
    texts_of(app.env)[name] = source[0]


def reference(block: re.Match[str]) -> str:
    """What Sphinx makes of a block for Python's reference, as signatures and docstrings; nothing for other blocks."""
    parts = []
    for name in NAME.findall(block[1]):
        value = getattr(eigenfield, name)
        signature = "" if inspect.isclass(value) else str(inspect.signature(value))
        parts.append(f"### {name}\n\n```text\n{name}{signature}\n\n{inspect.getdoc(value)}\n```\n")
    return "\n".join(parts)


def write(app: Sphinx, error: Exception | None) -> None:
    """Write the pages and their list."""
    if error is not None or app.builder.format != "html":
        return
    env, out = app.env, Path(app.outdir)
    for name, text in texts_of(env).items():
        if name in env.found_docs:
            to = out / f"{name}.md"
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_text(BLOCK.sub(reference, FRONT_MATTER.sub("", text)), encoding="utf-8")
    start = env.get_doctree("index")
    lines = [f"# {app.config.project}", f"> {first_paragraph(start)}"]
    for tree in start.findall(addnodes.toctree):
        pages = [f"- [{env.titles[name].astext()}]({name}.md){summary(env, name)}" for _, name in tree["entries"]]
        lines += [f"## {tree['caption']}", "\n".join(pages)]
    (out / "llms.txt").write_text("\n\n".join(lines) + "\n", encoding="utf-8")


def summary(env: BuildEnvironment, name: str) -> str:
    """The first sentence of a page after a colon; nothing where it only leads to what follows."""
    sentence = re.split(r"(?<=[.:?])\s", first_paragraph(env.get_doctree(name)))[0]
    return "" if sentence.endswith(":") else f": {sentence}"


def first_paragraph(page: nodes.document) -> str:
    """The text of a page's first paragraph, on one line and without HTML."""
    texts = next(page.findall(nodes.paragraph)).findall(nodes.Text)
    return " ".join("".join(text for text in texts if not isinstance(text.parent, nodes.raw)).split())


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", keep, priority=900)  # after those that change it
    app.connect("build-finished", write)
    return {"parallel_read_safe": False}
