"""Findings in a file: the first error (an exception) for `load`, all of them (a list) for `validate`."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeVar

from eigenfield.core.errors import FormatError

T = TypeVar("T")
Severity = Literal["error", "warning", "information"]


@dataclass(frozen=True)
class Finding:
    """One finding of `validate`.

    Attributes:
        severity: "error" (the file is refused), "warning" (it can be drawn, but is not as specified), "information".
        code: Stable, kebab-case; the table is in docs/format.md.
        where: A byte offset ("byte 20") or a JSON pointer.
        message: Without a full stop.
    """

    severity: Severity
    code: str
    where: str
    message: str


@dataclass
class Findings:
    """Collects findings; the checks themselves raise FormatError and know nothing of it.

    Attributes:
        strict: Whether the first error leaves `part` as an exception (`load`). Otherwise it is noted, the rest of that
            part is skipped and the next part is checked (`validate`).
    """

    strict: bool
    found: list[Finding] = field(default_factory=list)

    @contextlib.contextmanager
    def part(self) -> Iterator[None]:
        """A part of the file that can fail without the next one becoming meaningless."""
        try:
            yield
        except FormatError as error:
            if self.strict:
                raise
            text = error.message.removesuffix(f" (at {error.where})")  # which `where` holds already
            text = text if error.remedy is None else f"{text}; {error.remedy}"
            self.found.append(Finding("error", error.code, error.where, text))

    def attempt(self, read: Callable[[], T]) -> T | None:
        """What `read` returns of a part; None where it fails (only while validating)."""
        with self.part():
            return read()
        return None

    def note(self, severity: Literal["warning", "information"], code: str, where: str, message: str) -> None:
        """Something that does not make the file unreadable."""
        self.found.append(Finding(severity, code, where, message))
