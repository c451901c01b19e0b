"""XML from outside, by expat: no document type, hence no entities that grow or fetch; a limit on size and depth."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, ParseError, TreeBuilder
from xml.parsers import expat

from eigenfield.capture.readers.text import contents, damaged
from eigenfield.core.errors import CaptureError

XML_LIMIT = 64 * 2**20  # bytes
DEPTH_LIMIT = 64
ELEMENT_LIMIT = 1_000_000


def load_xml(path: Path, limit: int = XML_LIMIT) -> Element:
    """The root of an XML file. CaptureError: `calibration-missing`, `calibration-too-large`, `xml-doctype` (there is a
    document type), `calibration-damaged` (no well-formed XML, nested or long beyond reason)."""
    data = contents(path, limit)
    parser = expat.ParserCreate()
    builder = TreeBuilder()
    depth = elements = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, elements
        depth += 1
        elements += 1
        if depth > DEPTH_LIMIT or elements > ELEMENT_LIMIT:
            raise damaged(path, f"is XML of more than {DEPTH_LIMIT} levels or {ELEMENT_LIMIT} elements")
        builder.start(name, attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name)

    def refuse(*_: object) -> int:
        raise CaptureError(
            "xml-doctype",
            "is XML with a document type (DOCTYPE), which no calibration needs and which could hide entities",
            path=path,
            remedy="remove the DOCTYPE",
        )

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    parser.ExternalEntityRefHandler = refuse
    parser.buffer_text = True
    try:
        parser.Parse(data, True)
        return builder.close()
    except (expat.ExpatError, ParseError, LookupError, ValueError, AssertionError) as error:
        raise damaged(path, f"is no well-formed XML ({str(error)[:80]})") from error
