"""Whose a scene is: title, author, licence and source, which files keep and pages show."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass

from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Options, document_options, option

RIGHTS_MAX_CHARACTERS = 1000  # of each text
NO_TEXT = {"Cc", "Cs", "Zl", "Zp"}  # categories: controls, halves of characters, ends of lines and paragraphs
TURNING = {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"}  # what follows may read as something else


@document_options
@dataclass(frozen=True, kw_only=True)
class Rights(Options):
    """What a file says of its title, author, licence and source; what is empty it does not say.

    A text that is longer than `RIGHTS_MAX_CHARACTERS`, or holds control characters, raises OptionError `rights`.
    """

    title: str = option("Title of the scene, kept in the file.", "", name="title", metavar="TEXT")
    author: str = option("Who made it, kept in the file.", "", name="author", metavar="TEXT")
    licence: str = option(
        "What others may do with it, a name or an address, kept in the file: CC BY 4.0.", "", name="licence",
        metavar="TEXT",
    )  # fmt: skip
    source: str = option("Where it comes from, often an address, kept in the file.", "", name="source", metavar="TEXT")

    def __post_init__(self) -> None:
        self.check_types()
        for name, text in vars(self).items():
            fault = fault_of(text)
            if fault is not None:
                remedy = f"give one line of at most {RIGHTS_MAX_CHARACTERS} characters"
                raise OptionError("rights", f"the {name} {fault}", remedy=remedy)

    @property
    def said(self) -> dict[str, str]:
        """The texts that are not empty, by name."""
        return {name: text for name, text in vars(self).items() if text}

    @property
    def copyright(self) -> str:
        """One line that credits the author and names the licence; empty where neither is said."""
        return ", ".join(text for text in (self.author, self.licence) if text)


def fault_of(text: str) -> str | None:
    """What is wrong with a text of `Rights`, behind its name; None: nothing."""
    if len(text) > RIGHTS_MAX_CHARACTERS:
        return f"has {len(text):,} characters"
    bad = next((one for one in text if _is_bad(one)), "")
    return f"holds the control character U+{ord(bad):04X}" if bad else None


def _is_bad(character: str) -> bool:
    return unicodedata.category(character) in NO_TEXT or unicodedata.bidirectional(character) in TURNING
