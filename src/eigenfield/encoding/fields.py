"""Dataclass fields that are options: the command line's help, letters and choices stand beside each field, once."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, Self, TypeVar

from eigenfield.core.errors import OptionError

T = TypeVar("T")


@dataclass(frozen=True)
class Option:
    """How the command line offers a field.

    Attributes:
        help: What the option does and, in brackets at the end, what happens without it.
        letter: Its short form, for example "-n".
        metavar: What stands for its value in `--help`.
        choices: The values that it may have; empty for any.
        limits: Its least and its greatest value.
        bare: Its value where it is written without one; None where it needs one.
        parts: A dataclass of whose fields each is an option: `target` has `--target-size` and others.
    """

    help: str
    letter: str | None = None
    metavar: str | None = None
    choices: tuple[str, ...] = ()
    limits: tuple[int, int] | None = None
    bare: str | None = None
    parts: type | None = None


class Options:
    """A base of dataclasses of options: arguments that they do not have raise OptionError `option-unknown`."""

    def __new__(cls, *values: object, **named: object) -> Self:
        """Check the arguments' names; values by their place are for those that take them."""
        try:
            inspect.signature(cls.__init__).bind(None, *values, **named)
        except TypeError as error:
            names = list(inspect.signature(cls.__init__).parameters)[1:]
            unknown = next((name for name in named if name not in names), None)
            near = difflib.get_close_matches(unknown or "", names, n=1)
            message = f"{cls.__name__}: {error}" if unknown is None else f"{cls.__name__} has no option {unknown}"
            remedy = f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}"
            raise OptionError("option-unknown", message, remedy=remedy) from None
        return super().__new__(cls)


def option(help: str, **how: Any) -> Any:
    """A dataclass field of default None that carries an `Option`.

    Args:
        help: As in `Option`.
        how: Its other attributes.
    """
    return field(default=None, metadata={"option": Option(help, **how)})


def options_of(cls: type) -> Iterator[tuple[str, Option]]:
    """The fields of a dataclass made by `option`, in their order, by name."""
    for one in fields(cls):
        if "option" in one.metadata:
            yield one.name, one.metadata["option"]


def document_options(cls: type[T]) -> type[T]:
    """Decorator: put the help of a dataclass's options into its docstring, as `Attributes:`."""
    lines = [f"    {name}: {' '.join(one.help.split())}" for name, one in options_of(cls)]
    cls.__doc__ = "\n".join([inspect.cleandoc(cls.__doc__ or ""), "", "Attributes:", *lines])
    return cls
