"""Errors that a person can correct.

    EigenfieldError
    ├── CaptureError   photographs, calibrations, masks
    ├── ProxyError     the mesh and its atlas
    ├── FormatError    a scene file that is damaged, newer or not ours
    ├── OutputError    output: exists already, disk full, not writable
    ├── WorkerError    processes and machines that do the work
    └── OptionError    an impossible option or combination of options

Each is one line: the file, what is wrong, the remedy. `code` is stable and meant for scripts. A bug is never one
of these and is never caught: it keeps its traceback.
"""

from __future__ import annotations

import os
import unicodedata


def one_line(text: str) -> str:
    """A name from a file as one line that every terminal and JSON can hold: control characters, separators of lines and
    lone surrogates (bytes that are no UTF-8) are written as escapes."""
    if text.isprintable():
        return text
    escaped = ("Cc", "Cs", "Zl", "Zp")
    return "".join(c.encode("unicode_escape").decode() if unicodedata.category(c) in escaped else c for c in text)


class EigenfieldError(Exception):
    """One line for a person, and a stable `code` for a script.

    Attributes:
        code: Short, stable, kebab-case ("image-truncated").
        message: What is wrong, without a full stop.
        path: The file or folder in question.
        remedy: What to do about it, an imperative without a full stop.
    """

    def __init__(
        self, code: str, message: str, *, path: str | os.PathLike[str] | None = None, remedy: str | None = None
    ) -> None:
        self.code = code
        self.message = message
        self.path = None if path is None else os.fspath(path)
        self.remedy = remedy
        super().__init__(code, message)

    def __reduce__(self) -> tuple[object, ...]:
        return _restored, (type(self), self.args, self.__dict__)  # subclasses may need more arguments

    def __str__(self) -> str:
        text = self.message if self.path is None else f"{self.path}: {self.message}"
        return one_line(text if self.remedy is None else f"{text}; {self.remedy}")


class CaptureError(EigenfieldError):
    """Photographs, calibrations or masks that cannot be used."""


class ProxyError(EigenfieldError):
    """A mesh or an atlas that cannot be used."""


class FormatError(EigenfieldError):
    """A scene file that is damaged, newer or not ours.

    Attributes:
        where: A byte offset ("byte 20") or a JSON pointer ("/extensions/EIGENFIELD_eigen_textures/planes/0");
            "byte 0" of what is wrong with the whole file, whose message names no place.
    """

    def __init__(
        self,
        code: str,
        message: str,
        *,
        where: str | None = None,
        path: str | os.PathLike[str] | None = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(code, message if where is None else f"{message} (at {where})", path=path, remedy=remedy)
        self.where = where or "byte 0"


class OutputError(EigenfieldError):
    """Something that cannot be written."""


class WorkerError(EigenfieldError):
    """A process or a machine that cannot do its part of the work."""


class OptionError(EigenfieldError):
    """An impossible option or combination of options."""


def _restored(cls: type[EigenfieldError], args: tuple[str, str], attributes: dict[str, object]) -> EigenfieldError:
    """An error as it was in another process."""
    error = cls.__new__(cls)
    error.args = args
    error.__dict__.update(attributes)
    return error
