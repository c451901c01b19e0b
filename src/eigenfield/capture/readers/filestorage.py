"""OpenCV's FileStorage files as plain trees: YAML, XML and JSON, and any YAML (ROS, PyYAML) and TOML that looks alike.

Not by cv2.FileStorage, which is no match for damaged files. YAML comes as events of PyYAML, without its resolvers:
`no`, `1:30` and dates are words here, `1e-5` is a number, and tags make nothing. What an alias repeats counts each time
against a limit, so that a small file cannot grow without end. OpenCV's YAML is none in two places, which are corrected
first: `%YAML:1.0` and `{ x:1 }`.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
import yaml

from eigenfield.capture.readers.text import damaged_error, excerpt, read_head, read_text
from eigenfield.capture.readers.xml_tree import load_xml
from eigenfield.core.errors import one_line

Tree = dict[str, Any]
STORAGE_PLAIN_EXTENSIONS = (".yml", ".yaml", ".toml")  # which have no head that tells
STORAGE_EXTENSIONS = (*STORAGE_PLAIN_EXTENSIONS, ".xml", ".json")
STORAGE_MAX_NODES = 2**20  # of a YAML with aliases, what they repeat counted each time
STORAGE_MAX_DEPTH = 32
STORAGE_MAX_BYTES = 8 * 2**20  # the points of a thousand charts fit
# dots between the parts of a key, and not in a number: tomllib takes the square of their number
STORAGE_KEY_DOT = re.compile(r"(?<![0-9])\.|\.(?![0-9eE\s,\]])|\.[\d_-]+\s*\.")
STORAGE_MAX_KEY_DOTS = 100
STORAGE_MAX_INTEGER = 2**1000  # beyond, it may be no float
STORAGE_YAML_HEAD = re.compile(r"\A%YAML[^\n]*")  # OpenCV writes %YAML:1.0, which is no directive of YAML
STORAGE_FLOW_KEY = re.compile(r"(?<=[{,])(\s*\w+:)(?=\S)")
STORAGE_QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)
STORAGE_SPECIAL_NUMBERS = {".nan": math.nan, ".inf": math.inf, "+.inf": math.inf, "-.inf": -math.inf}
STORAGE_MATRIX_TYPE = re.compile(r"\(?(\d*)[ucswifdhnblI]\)?")
STORAGE_YAML_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the same by libyaml, ten times as fast


class _BadStorageError(Exception):
    """What is wrong with the text, in words."""


def load_storage(path: Path) -> Tree:
    """The file's top mapping: dict, list, str, float, and (rows, columns[, channels]) float64 arrays for matrices.

    Raises CaptureError: `calibration-missing`, `calibration-too-large`, `xml-doctype`, `calibration-damaged`.
    """
    suffix = path.suffix.lower()
    try:
        if suffix == ".xml":
            tree = _from_xml(load_xml(path, STORAGE_MAX_BYTES))
        elif suffix == ".json":
            tree = _from_json(read_text(path, STORAGE_MAX_BYTES), path)
        elif suffix == ".toml":
            tree = _from_toml(read_text(path, STORAGE_MAX_BYTES), path)
        else:
            tree = _from_yaml(read_text(path, STORAGE_MAX_BYTES))
        found = _with_matrices(tree, 0)
    except _BadStorageError as error:
        raise damaged_error(path, f"is no OpenCV storage: {error}") from None
    if not isinstance(found, dict):
        raise damaged_error(path, "is no OpenCV storage: it has no names at the top")
    return found


def is_storage(path: Path) -> bool:
    """Whether a file is named as YAML or TOML, or begins as OpenCV begins its files."""
    if path.suffix.lower() in STORAGE_PLAIN_EXTENSIONS:
        return True
    head = read_head(path, 512)
    return head.startswith(b"%YAML") or b"<opencv_storage" in head


def _with_matrices(node: Any, depth: int) -> Any:
    """The tree with every mapping of rows, cols and data as an array."""
    if depth > STORAGE_MAX_DEPTH:
        raise _BadStorageError("nested too deep")
    if isinstance(node, list):
        return node if all(isinstance(v, float) for v in node) else [_with_matrices(v, depth + 1) for v in node]
    if not isinstance(node, dict):
        return node
    if not {"rows", "cols", "data"} <= node.keys():
        return {key: _with_matrices(value, depth + 1) for key, value in node.items()}
    rows, cols, data = node["rows"], node["cols"], node["data"]
    data = [data] if isinstance(data, float) else [] if data in (None, "") else data
    kind = STORAGE_MATRIX_TYPE.fullmatch(str(node.get("dt", "d")).strip("\"'"))
    channels = int(kind[1] or 1) if kind and len(kind[1]) < 4 else 1
    if not (isinstance(data, list) and all(isinstance(v, float) for v in data)):
        raise _BadStorageError("a matrix holds something that is no number")
    if not all(isinstance(v, float) and 0 <= v < 2**31 and v == round(v) for v in (rows, cols)):
        raise _BadStorageError(f"a matrix of {excerpt(rows)} x {excerpt(cols)}")
    if rows * cols * channels != len(data):
        raise _BadStorageError(f"a matrix of {rows:.0f} x {cols:.0f} x {channels} with {len(data)} numbers")
    shape = (int(rows), int(cols), channels) if channels > 1 else (int(rows), int(cols))
    return np.array(data, np.float64).reshape(shape)


def _parse_scalar(word: str) -> Any:
    """A number, or the word itself; None for nothing."""
    if word in ("", "~", "null"):
        return None
    if word.lower() in STORAGE_SPECIAL_NUMBERS:
        return STORAGE_SPECIAL_NUMBERS[word.lower()]
    try:
        return float(word)
    except ValueError:
        return word


def _from_json(source: str, path: Path) -> Any:
    try:
        return json.loads(source, parse_int=float)
    except (ValueError, RecursionError) as error:
        raise damaged_error(path, f"is no valid JSON ({str(error)[:80]})") from error


def _from_toml(source: str, path: Path) -> Any:
    if any(len(STORAGE_KEY_DOT.findall(line)) > STORAGE_MAX_KEY_DOTS for line in source.split("\n")):
        raise _BadStorageError(f"a line with more than {STORAGE_MAX_KEY_DOTS} dots of a key")
    try:
        return _with_floats(tomllib.loads(source), 0)
    except (ValueError, RecursionError) as error:
        raise damaged_error(path, f"is no valid TOML ({one_line(str(error)[:80])})") from error


def _with_floats(node: Any, depth: int) -> Any:
    if depth > STORAGE_MAX_DEPTH:
        raise _BadStorageError("nested too deep")
    if isinstance(node, dict):
        return {key: _with_floats(value, depth + 1) for key, value in node.items()}
    if isinstance(node, list):
        return [_with_floats(value, depth + 1) for value in node]
    if isinstance(node, int) and not isinstance(node, bool):
        return float(node) if abs(node) < STORAGE_MAX_INTEGER else math.inf
    return node


def _from_xml(root: Element) -> Any:
    if root.tag != "opencv_storage":
        raise _BadStorageError(f"its root is <{excerpt(root.tag)}> and not <opencv_storage>")
    return _from_element(root)


def _from_element(element: Element) -> Any:
    children = list(element)
    if children and all(child.tag == "_" for child in children):  # a sequence: scalars stand between the elements
        items = _parse_words(element.text)
        for child in children:
            items += [_from_element(child), *_parse_words(child.tail)]
        return items
    if children:
        return {child.tag: _from_element(child) for child in children}
    words = _parse_words(element.text)
    return words if len(words) > 1 else words[0] if words else None


def _parse_words(source: str | None) -> list[Any]:
    """Numbers, or quoted strings, or one string without quotes."""
    source = (source or "").strip()
    if '"' in source:
        return STORAGE_QUOTED.findall(source)
    words = [_parse_scalar(word) for word in source.split()]
    return [source] if len(words) > 1 and not all(isinstance(word, float) for word in words) else words


def _from_yaml(source: str) -> Any:
    """The documents of a stream as one: OpenCV appends another to a file that is there."""
    source = STORAGE_YAML_HEAD.sub("", source).encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    source = source.expandtabs(4)
    try:
        try:
            documents = _parse_documents(STORAGE_FLOW_KEY.sub(r"\1 ", source))
        except yaml.YAMLError:
            documents = _parse_documents(source)  # a list of words outside braces may look the same
    except yaml.YAMLError as error:
        mark, problem = getattr(error, "problem_mark", None), getattr(error, "problem", None)
        place = f"line {mark.line + 1}: " if mark else ""
        raise _BadStorageError(place + one_line(str(problem or "characters that no YAML has"))) from None
    if len(documents) > 1 and all(isinstance(document, dict) for document in documents):
        return {key: value for document in documents for key, value in document.items()}
    return documents[0] if documents else None


def _merged(mapping: dict[str, Any]) -> dict[str, Any]:
    """A mapping with those that its key `<<` names, whose values count where it has none."""
    others = mapping.pop("<<", None)
    for other in others if isinstance(others, list) else [others]:
        if isinstance(other, dict):
            mapping = {**other, **mapping}
    return mapping


def _parse_documents(source: str) -> list[Any]:
    """Every document of a YAML stream. Raises yaml.YAMLError and _BadStorageError."""
    documents: list[Any] = []
    anchors: dict[str, tuple[Any, int]] = {}  # with the number of nodes in each
    total, repeated = 0, 0
    begun: list[tuple[str | None, int]] = []  # the anchor of each open node, and the total at its beginning
    open_nodes = [documents]  # a mapping's keys and values alternate in its list
    kinds: list[type[list[Any] | dict[str, Any]]] = [list]
    for event in yaml.parse(source, Loader=STORAGE_YAML_LOADER):
        is_key = kinds[-1] is dict and len(open_nodes[-1]) % 2 == 0
        if isinstance(event, yaml.ScalarEvent):
            is_word = is_key or event.style not in ("", None)
            open_nodes[-1].append(event.value if is_word else _parse_scalar(event.value))
            total += 1
            if event.anchor:
                anchors[event.anchor] = open_nodes[-1][-1], 1
        elif isinstance(event, yaml.CollectionStartEvent):
            if is_key or len(kinds) > STORAGE_MAX_DEPTH:
                raise _BadStorageError("a collection for a name" if is_key else "nested too deep")
            open_nodes.append([])
            begun.append((event.anchor, total))
            kinds.append(dict if isinstance(event, yaml.MappingStartEvent) else list)
        elif isinstance(event, yaml.CollectionEndEvent):
            items, kind = open_nodes.pop(), kinds.pop()
            anchor, before = begun.pop()
            node = items if kind is list else _merged(dict(zip(items[::2], items[1::2], strict=True)))
            open_nodes[-1].append(node)
            total += 1
            if anchor:
                anchors[anchor] = node, total - before
        elif isinstance(event, yaml.AliasEvent):
            if event.anchor not in anchors or is_key:
                raise _BadStorageError(f"an alias of nothing that is finished before it, *{excerpt(event.anchor)}")
            node, size = anchors[event.anchor]
            open_nodes[-1].append(node)
            total, repeated = total + size, repeated + size
            if repeated > STORAGE_MAX_NODES:
                raise _BadStorageError("its aliases repeat too much")
    return documents
