"""Dataclass fields that are options: the command line's help, letters and choices stand beside each field, once."""

from __future__ import annotations

import difflib
import functools
import inspect
import textwrap
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Never, Self, TypeVar, get_type_hints

from eigenfield.core.arguments import in_words, kind_in_words, matches, public_name
from eigenfield.core.errors import OptionError

T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Option:
    """How the command line offers a field.

    Attributes:
        help: What the option does and, in brackets at the end, what happens without it.
        name: Its name on the command line, for example "primitive"; None: that of the field.
        letter: Its short form, for example "-n".
        metavar: What stands for its value in `--help`.
        choices: The values that it may have; empty for any.
        limits: Its least and its greatest value.
        bare: Its value where it is written without one; None where it needs one.
        parts: A dataclass of whose fields each is an option: `target` has `--target-size` and others.
        deniable: Whether there is `--no-NAME`, too.
        offered: Whether the command line has it.
    """

    help: str
    name: str | None = None
    letter: str | None = None
    metavar: str | None = None
    choices: tuple[str, ...] = ()
    limits: tuple[int, int] | None = None
    bare: str | None = None
    parts: type | None = None
    deniable: bool = False
    offered: bool = True


class Options:
    """A base of dataclasses of options: arguments that they do not have raise OptionError `option-unknown`."""

    renamed: ClassVar[Mapping[str, str]] = {}  # names that were given up, with those that took their place

    def __new__(cls, *values: object, **named: object) -> Self:
        """Check the arguments' names; values by their place are for those that take them."""
        names = list(inspect.signature(cls.__init__).parameters)[1:]
        refuse_unknown(named, names, cls.__name__, cls.renamed)
        try:
            inspect.signature(cls.__init__).bind(None, *values, **named)
        except TypeError as error:
            remedy = f"there are {', '.join(names)}"
            raise OptionError("option-unknown", f"{cls.__name__}: {error}", remedy=remedy) from None
        return super().__new__(cls)

    def changed(self) -> dict[str, Any]:
        """The options that differ from their defaults, by name."""
        return {one.name: getattr(self, one.name) for one in fields(self) if getattr(self, one.name) != one.default}  # type: ignore[arg-type]

    def check_types(self) -> None:
        """Raise OptionError `option-type` for values of another type; whole numbers stand for any number."""
        for name, kind in get_type_hints(type(self)).items():
            value = getattr(self, name)
            if name != "renamed" and not matches(value, kind):
                raise OptionError("option-type", f"{name} is {kind_in_words(value)}", remedy=f"give {in_words(kind)}")


def refuse_unknown(
    given: Iterable[str], names: Collection[str], owner: str, renamed: Mapping[str, str] | None = None
) -> None:
    """Raise OptionError for a name that is not among the names of options, with the nearest of them.

    Args:
        given: Names that were given.
        names: All that there are.
        owner: What has them, for the message.
        renamed: Names that were given up, with those that took their place.

    Raises:
        OptionError: `option-unknown`, `option-renamed`.
    """
    for name in given:
        if name in names:
            continue
        if renamed and name in renamed:
            raise OptionError("option-renamed", f"{name} is now called {renamed[name]}", remedy=f"say {renamed[name]}")
        near = difflib.get_close_matches(name, names, n=1)
        remedy = f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}"
        raise OptionError("option-unknown", f"{owner} has no option {name}", remedy=remedy)


def option(help: str, default: Any = None, **how: Any) -> Any:
    """A dataclass field that carries an `Option`.

    Args:
        help: As in `Option`.
        default: Of the field.
        how: Other attributes of `Option`.
    """
    return field(default=default, metadata={"option": Option(help, **how)})


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


def takes_options(cls: type[Any], without: Collection[str] = (), *, others: bool = False) -> Callable[[F], F]:
    """Decorator: a function's `**changes` are fields of a class of options, which its signature and docstring show.

    Args:
        cls: The class of options. Other names raise OptionError `option-unknown` or `option-renamed`.
        without: Fields that are none of its arguments.
        others: Whether `changes` has more than these fields, of which the function refuses what is unknown.
    """

    def show(function: F) -> F:
        signature, kinds = inspect.signature(function), get_type_hints(cls)
        *before_them, changes = signature.parameters.values()
        rest = changes if others else changes.replace(annotation=Never)
        shown = [(name, one) for name, one in options_of(cls) if name not in without]
        defaults = {one.name: one.default for one in fields(cls)}
        known = [*(one.name for one in before_them), *defaults]
        added = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=defaults[name], annotation=kinds[name])
            for name, _ in shown
        ]

        @functools.wraps(function)
        def call(*args: Any, **named: Any) -> Any:
            if not others:
                refuse_unknown(named, known, public_name(function), cls.renamed)
            return function(*args, **named)

        call.__signature__ = signature.replace(parameters=[*before_them, *added, rest])  # type: ignore[attr-defined]
        before, last, after = (function.__doc__ or "").partition(f"        {changes.name}:")
        filler = textwrap.TextWrapper(120, initial_indent=" " * 8, subsequent_indent=" " * 12)
        lines = "".join(filler.fill(f"{name}: {' '.join(one.help.split())}") + "\n" for name, one in shown)
        call.__doc__ = f"{before}{lines}{last}{after}"
        return call  # type: ignore[return-value]

    return show
