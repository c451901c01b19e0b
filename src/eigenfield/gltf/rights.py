"""Title, author, licence and source in a file: `asset.copyright`, and a packet of KHR_xmp_json_ld for the whole file.

The packet uses the Dublin Core as XMP does. Other programs write it, too: what of it cannot be read is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.rights import Rights, fault_of
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings

XMP = "KHR_xmp_json_ld"
CONTEXT = {"dc": "http://purl.org/dc/elements/1.1/", "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#"}
KEYS = {"title": "dc:title", "author": "dc:creator", "licence": "dc:rights", "source": "dc:source"}


def with_rights(gltf: dict[str, Any], rights: Rights) -> dict[str, Any]:
    """The JSON of a file without rights, with these; itself where nothing is said."""
    forms: dict[str, Callable[[str], Any]] = {
        "title": _in_any_language,
        "author": _listed,
        "licence": _in_any_language,
        "source": str,
    }
    said = {KEYS[name]: form(text) for name, form in forms.items() if (text := getattr(rights, name))}
    if not said:
        return gltf
    asset = gltf["asset"] | ({"copyright": rights.copyright} if rights.copyright else {})
    return gltf | {
        "asset": asset | {"extensions": {XMP: {"packet": 0}}},
        "extensionsUsed": [*gltf["extensionsUsed"], XMP],
        "extensions": {**gltf.get("extensions", {}), XMP: {"packets": [{"@context": CONTEXT, **said}]}},
    }


def read_rights(document: Document, findings: Findings) -> Rights:
    """What the packet of the whole file says; a text that cannot be shown in a line is noted and left out."""
    index = _at(document.glb.json, "asset", "extensions", XMP, "packet")
    packets = _at(document.glb.json, "extensions", XMP, "packets")
    if not isinstance(packets, list) or not isinstance(index, int) or not 0 <= index < len(packets):
        return Rights()
    found = {}
    for name, key in KEYS.items():
        value = _at(packets[index], key)
        text = _text(value)
        if text is not None and fault_of(text) is None:
            found[name] = text
        elif value is not None:
            message = f"is no text of one line with at most {limits.MAX_RIGHTS} characters, and is ignored"
            findings.note("warning", "rights", f"/extensions/{XMP}/packets/{index}/{key}", message)
    return Rights(**found)


def _in_any_language(text: str) -> dict[str, Any]:
    return {"@type": "rdf:Alt", "rdf:_1": {"@language": "x-default", "@value": text}}


def _listed(text: str) -> dict[str, Any]:
    return {"@list": [text]}


def _text(value: Any) -> str | None:
    """The text of a property in any of the forms of XMP: plain, the first language of several, a list; None: none."""
    several = _at(value, "@list") or _at(value, "@set")
    if isinstance(several, list) and all(isinstance(one, str) for one in several):
        return ", ".join(several)
    text = _at(value, "rdf:_1", "@value") if isinstance(value, dict) else value
    return text if isinstance(text, str) else None


def _at(value: Any, *keys: str) -> Any:
    """A member of objects within each other; None: there is none."""
    for key in keys:
        value = value.get(key) if isinstance(value, dict) else None
    return value
