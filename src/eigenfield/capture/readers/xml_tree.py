"""XML from outside, by defusedxml: no document type, so no entities that grow or fetch; limits of size and depth."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, ParseError, TreeBuilder

from defusedxml import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from eigenfield.capture.readers.text import damaged_error, read_contents
from eigenfield.core.errors import CaptureError

XML_MAX_BYTES = 64 * 2**20
XML_MAX_DEPTH = 64
XML_MAX_ELEMENTS = 1_000_000


class _BoundedBuilder(TreeBuilder):
    """Raises ValueError for a tree that is nested or long beyond reason."""

    depth = elements = 0

    def start(self, tag: str, attributes: dict[str, str], /) -> Element:
        self.depth += 1
        self.elements += 1
        if self.depth > XML_MAX_DEPTH or self.elements > XML_MAX_ELEMENTS:
            raise ValueError(f"more than {XML_MAX_DEPTH} levels or {XML_MAX_ELEMENTS} elements")
        return super().start(tag, attributes)

    def end(self, tag: str, /) -> Element:
        self.depth -= 1
        return super().end(tag)


def load_xml(path: Path, limit: int = XML_MAX_BYTES) -> Element:
    """The root of an XML file. CaptureError: `calibration-missing`, `calibration-too-large`, `xml-doctype` (there is a
    document type), `calibration-damaged` (no well-formed XML, nested or long beyond reason)."""
    parser = DefusedXMLParser(target=_BoundedBuilder(), forbid_dtd=True)
    try:
        parser.feed(read_contents(path, limit))
        return parser.close()
    except DefusedXmlException as error:
        raise CaptureError(
            "xml-doctype",
            "is XML with a document type (DOCTYPE), which no calibration needs and which could hide entities",
            path=path,
            remedy="remove the DOCTYPE",
        ) from error
    except (ParseError, LookupError, ValueError, AssertionError) as error:
        raise damaged_error(path, f"is no well-formed XML ({str(error)[:80]})") from error
