"""OpenCV's FileStorage files as plain trees: YAML, XML and JSON, and ROS's camera_info YAML, which looks alike.

Parsed here and not by cv2.FileStorage, which is no match for damaged files. Of YAML what OpenCV writes: block
mappings and sequences, flow collections, quoted strings, tags (passed over), comments; no anchors, no folded text.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from eigenfield.capture.readers.text import damaged, shown, text
from eigenfield.capture.readers.xml_tree import load_xml

Tree = dict[str, Any]
EXTENSIONS = (".yml", ".yaml", ".xml", ".json")
DEPTH_LIMIT = 32
STORAGE_LIMIT = 8 * 2**20  # bytes: the points of a thousand charts fit
COLON = re.compile(r":(?=\s|$)")
KEY_LIMIT = 200  # characters
FLOW_KEY = re.compile(r"""("[^"]*"|'[^']*'|[^\s:,\[\]{}"']+)\s*:\s*""")
TAG = re.compile(r"!!?[^\s\[\]{},]*\s*")
QUOTED = re.compile(r"""("(?:[^"\\]|\\.)*("|$))|('[^']*('|$))""", re.DOTALL)  # to the end where it is not closed
SPECIAL = {".nan": math.nan, ".inf": math.inf, "+.inf": math.inf, "-.inf": -math.inf}
TYPE = re.compile(r"\(?(\d*)[ucswifdhnblI]\)?")


class _BadStorageError(Exception):
    """What is wrong with the text, in words."""


def load_storage(path: Path) -> Tree:
    """The file's top mapping: dict, list, str, float, and (rows, columns[, channels]) float64 arrays for matrices.

    Raises CaptureError: `calibration-missing`, `calibration-too-large`, `xml-doctype`, `calibration-damaged`.
    """
    suffix = path.suffix.lower()
    try:
        if suffix == ".xml":
            tree = _from_xml(load_xml(path, STORAGE_LIMIT))
        elif suffix == ".json":
            tree = _from_json(text(path, STORAGE_LIMIT), path)
        else:
            tree = _from_yaml(text(path, STORAGE_LIMIT))
        found = _matrices(tree, 0)
    except _BadStorageError as error:
        raise damaged(path, f"is no OpenCV storage: {error}") from None
    if not isinstance(found, dict):
        raise damaged(path, "is no OpenCV storage: it has no names at the top")
    return found


def is_storage(path: Path) -> bool:
    """Whether a file begins as OpenCV begins its files."""
    try:
        with path.open("rb") as file:
            head = file.read(512)
    except OSError:
        return False
    return head.removeprefix(b"\xef\xbb\xbf").startswith(b"%YAML") or b"<opencv_storage" in head


def _matrices(node: Any, depth: int) -> Any:
    """The tree with every mapping of rows, cols and data as an array."""
    if depth > DEPTH_LIMIT:
        raise _BadStorageError("nested too deep")
    if isinstance(node, list):
        return node if all(isinstance(v, float) for v in node) else [_matrices(v, depth + 1) for v in node]
    if not isinstance(node, dict):
        return node
    if not {"rows", "cols", "data"} <= node.keys():
        return {key: _matrices(value, depth + 1) for key, value in node.items()}
    rows, cols, data = node["rows"], node["cols"], node["data"]
    data = [data] if isinstance(data, float) else [] if data in (None, "") else data
    kind = TYPE.fullmatch(str(node.get("dt", "d")).strip("\"'"))
    channels = int(kind[1] or 1) if kind and len(kind[1]) < 4 else 1
    if not (isinstance(data, list) and all(isinstance(v, float) for v in data)):
        raise _BadStorageError("a matrix holds something that is no number")
    if not all(isinstance(v, float) and 0 <= v < 2**31 and v == round(v) for v in (rows, cols)):
        raise _BadStorageError(f"a matrix of {shown(rows)} x {shown(cols)}")
    if rows * cols * channels != len(data):
        raise _BadStorageError(f"a matrix of {rows:.0f} x {cols:.0f} x {channels} with {len(data)} numbers")
    shape = (int(rows), int(cols), channels) if channels > 1 else (int(rows), int(cols))
    return np.array(data, np.float64).reshape(shape)


def _scalar(word: str) -> Any:
    """A number, a quoted string without its quotes, or the word itself; None for nothing."""
    if not word or word in ("~", "null"):
        return None
    if word[0] in "\"'":
        match = QUOTED.fullmatch(word)
        if match is None or len(word) < 2 or word[-1] != word[0]:
            raise _BadStorageError(f"no end to {shown(word)}")
        return word[1:-1]
    if word.lower() in SPECIAL:
        return SPECIAL[word.lower()]
    try:
        return float(word)
    except ValueError:
        return word


# JSON and XML


def _from_json(source: str, path: Path) -> Any:
    try:
        return _floats(json.loads(source), 0)
    except (ValueError, RecursionError) as error:
        raise damaged(path, f"is no valid JSON ({str(error)[:80]})") from error


def _floats(node: Any, depth: int) -> Any:
    if depth > DEPTH_LIMIT:
        raise _BadStorageError("nested too deep")
    if isinstance(node, dict):
        return {key: _floats(value, depth + 1) for key, value in node.items()}
    if isinstance(node, list):
        return [_floats(value, depth + 1) for value in node]
    if isinstance(node, int):
        try:
            return float(node)
        except OverflowError:
            return math.inf
    return node


def _from_xml(root: Element) -> Any:
    if root.tag != "opencv_storage":
        raise _BadStorageError(f"its root is <{shown(root.tag)}> and not <opencv_storage>")
    return _from_element(root)


def _from_element(element: Element) -> Any:
    children = list(element)
    if children and all(child.tag == "_" for child in children):  # a sequence: scalars stand between the elements
        items = _words(element.text)
        for child in children:
            items += [_from_element(child), *_words(child.tail)]
        return items
    if children:
        return {child.tag: _from_element(child) for child in children}
    words = _words(element.text)
    return words if len(words) > 1 else words[0] if words else None


def _words(source: str | None) -> list[Any]:
    """Numbers, or quoted strings, or one string without quotes."""
    source = (source or "").strip()
    if '"' in source:
        return [_scalar(match[0]) for match in QUOTED.finditer(source)]
    words = [_scalar(word) for word in source.split()]
    return [source] if len(words) > 1 and not all(isinstance(word, float) for word in words) else words


# YAML


def _from_yaml(source: str) -> Any:
    lines = _logical_lines(source)
    node, end = _block(lines, 0, lines[0][0], 0) if lines else (None, 0)
    if end != len(lines):
        raise _BadStorageError(f"line {lines[end][2]} stands further left than what it belongs to")
    return node


def _logical_lines(source: str) -> list[tuple[int, str, int]]:
    """(indent, text, line number) without comments and empty lines; collections that go over lines joined."""
    lines: list[tuple[int, str, int]] = []
    parts: list[str] = []
    open_brackets = start = 0
    for number, raw in enumerate(source.split("\n"), 1):
        line = _without_comment(raw.expandtabs(4))
        bare = line.strip()
        if not bare or (not parts and (bare[0] == "%" or bare in ("---", "..."))):
            continue
        if not parts:
            start, indent = number, len(line) - len(line.lstrip())
        parts.append(bare)
        plain = QUOTED.sub("", bare) if '"' in bare or "'" in bare else bare
        open_brackets += sum(map(plain.count, "[{")) - sum(map(plain.count, "]}"))
        if open_brackets < 0:
            raise _BadStorageError(f"line {number} closes a bracket that was not opened")
        if open_brackets == 0:
            lines.append((indent, " ".join(parts), start))
            parts = []
    if parts:
        raise _BadStorageError(f"the bracket of line {start} is not closed")
    return lines


def _without_comment(line: str) -> str:
    if "#" not in line:
        return line
    at = 0
    while at < len(line):
        if line[at] == "#" and (at == 0 or line[at - 1] in " \t"):
            return line[:at]
        quoted = QUOTED.match(line, at)
        at = quoted.end() if quoted else at + 1
    return line


def _block(lines: list[tuple[int, str, int]], at: int, indent: int, depth: int) -> tuple[Any, int]:
    """The mapping or sequence whose lines stand at `indent`, from line `at` on, and the line after it."""
    if depth > DEPTH_LIMIT:
        raise _BadStorageError("nested too deep")
    if _is_item(lines[at][1]):
        return _sequence(lines, at, indent, depth)
    if _split(lines[at][1]) is not None:
        return _mapping(lines, at, indent, depth)
    return _value(lines[at][1], lines[at][2]), at + 1


def _is_item(line: str) -> bool:
    return line == "-" or line.startswith("- ")


def _sequence(lines: list[tuple[int, str, int]], at: int, indent: int, depth: int) -> tuple[list[Any], int]:
    items = []
    while at < len(lines) and lines[at][0] == indent and _is_item(lines[at][1]):
        rest = lines[at][1][1:].lstrip()
        if rest.startswith("!"):
            rest = TAG.sub("", rest, count=1)
        if not rest:
            if at + 1 < len(lines) and lines[at + 1][0] > indent:
                item, at = _block(lines, at + 1, lines[at + 1][0], depth + 1)
            else:
                item, at = None, at + 1
        elif rest[0] not in "[{" and _split(rest) is not None:  # a mapping that begins on the dash's own line
            inner = indent + len(lines[at][1]) - len(rest)
            lines[at] = (inner, rest, lines[at][2])
            item, at = _block(lines, at, inner, depth + 1)
        else:
            item, at = _value(rest, lines[at][2]), at + 1
        items.append(item)
    return items, at


def _mapping(lines: list[tuple[int, str, int]], at: int, indent: int, depth: int) -> tuple[Tree, int]:
    found: Tree = {}
    while at < len(lines) and lines[at][0] == indent:
        _, line, number = lines[at]
        pair = _split(line)
        if pair is None:
            raise _BadStorageError(f"line {number} is no `name: value` ({shown(line)})")
        key, rest = pair
        if rest.startswith("!"):
            rest = TAG.sub("", rest, count=1)
        at += 1
        if rest:
            found[key] = _value(rest, number)
        elif at < len(lines) and (lines[at][0] > indent or (lines[at][0] == indent and _is_item(lines[at][1]))):
            found[key], at = _block(lines, at, lines[at][0], depth + 1)
        else:
            found[key] = None
    return found, at


def _split(line: str) -> tuple[str, str] | None:
    """Name and value of a line `name: value`, the value may be empty; None where it is none."""
    quoted = QUOTED.match(line)
    colon = COLON.search(line, quoted.end() if quoted else 0)
    if colon is None or not 0 < colon.start() <= KEY_LIMIT:
        return None
    name = line[: colon.start()].rstrip()
    if quoted:
        return (name[1:-1], line[colon.end() :].lstrip()) if len(name) == quoted.end() else None
    return None if any(c in name for c in "[]{},\"'") else (name, line[colon.end() :].lstrip())


def _value(source: str, number: int) -> Any:
    if source[0] in "[{":
        node, end = _flow(source, 0, 0)
        if source[end:].strip():
            raise _BadStorageError(f"line {number} goes on after its collection")
        return node
    return _scalar(source.strip())


def _flow(source: str, at: int, depth: int) -> tuple[Any, int]:
    """The flow collection that begins at `at`, and where it ends."""
    if depth > DEPTH_LIMIT:
        raise _BadStorageError("nested too deep")
    close = "]" if source[at] == "[" else "}"
    end = source.find(close, at)
    inside = source[at + 1 : end]
    if close == "]" and end > 0 and not any(c in inside for c in "[{\"'"):  # plain numbers, thousands of them
        words = [word.strip() for word in inside.split(",")]
        return [_scalar(word) for word in (words[:-1] if not words[-1] else words)], end + 1
    items: list[Any] = []
    found: Tree = {}
    at += 1
    while True:
        at = _skip(source, at)
        if at >= len(source):
            raise _BadStorageError("a collection without end")
        if source[at] == close:
            return (items if close == "]" else found), at + 1
        if source[at] in "]}":
            raise _BadStorageError(f"a collection that ends in the other kind of bracket at {shown(source[at:])}")
        if close == "}":
            match = FLOW_KEY.match(source, at)
            if match is None:
                raise _BadStorageError(f"no `name: value` at {shown(source[at:])}")
            at = match.end()
        item, at = _flow_item(source, at, depth)
        if close == "}":
            assert match is not None
            found[match[1].strip("\"'")] = item
        else:
            items.append(item)


def _skip(source: str, at: int) -> int:
    while at < len(source) and source[at] in " ,\t":
        at += 1
    return at


def _flow_item(source: str, at: int, depth: int) -> tuple[Any, int]:
    tag = TAG.match(source, at)
    at = tag.end() if tag else at
    if at < len(source) and source[at] in "[{":
        return _flow(source, at, depth + 1)
    quoted = QUOTED.match(source, at)
    if quoted:
        return _scalar(quoted[0]), quoted.end()
    end = at
    while end < len(source) and source[end] not in ",]}[{":
        end += 1
    if end == at and (end >= len(source) or source[end] not in ",]}"):
        raise _BadStorageError(f"nothing to read at {shown(source[at:])}")
    return _scalar(source[at:end].strip()), end
