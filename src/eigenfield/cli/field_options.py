"""Command-line options made from the fields of a dataclass, and the dataclass from what was given for them."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

import click

from eigenfield.cli.common import PATH, Decorator, together
from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Option, Options, options_of

T = TypeVar("T", bound=Options)


def field_options(
    cls: type[Options], prefix: str = "", only: Collection[str] | None = None, **parsers: Callable[..., Any]
) -> Decorator:
    """Add an option for each field of a dataclass that carries one (`core.fields`), named as the field.

    A name that was given up raises OptionError `option-renamed`, which says the new one.

    Args:
        only: Names of the fields that are meant; None: all that are offered.
        parsers: Click callbacks by name, for values that are more than a word or a number.
    """
    kinds, decorators = get_type_hints(cls), []
    shown = {name: one for name, one in options_of(cls) if (one.offered if only is None else name in only)}
    for field, one in shown.items():
        name = prefix + field
        if one.parts is not None:
            decorators.append(field_options(one.parts, f"{name}_", None, **parsers))
            continue
        how: dict[str, Any] = {"help": one.help, "metavar": one.metavar, "callback": parsers.get(name)}
        if name not in parsers:
            how["type"] = _click_type(one, get_args(kinds[field]) or (kinds[field],))
        how["multiple"] = get_origin(kinds[field]) is Sequence
        words = f"--{one.name or name.replace('_', '-')}"
        if one.deniable:
            words += f"/--no-{words.removeprefix('--')}"
            how["default"] = None
        elif how.get("type") is bool:
            how |= {"is_flag": True, "default": None}
        if one.bare is not None:
            how |= {"is_flag": False, "flag_value": one.bare}
        letters = [] if one.letter is None else [one.letter]
        decorators.append(click.option(words, *letters, name, **how))
    decorators += [_renamed(old, new) for old, new in cls.renamed.items() if new in shown]
    return together(*decorators)


def from_fields(cls: type[T], values: dict[str, Any], prefix: str = "") -> T:
    """The dataclass with the values of `field_options`.

    Args:
        values: By name; those of its fields are removed.
    """
    given: dict[str, Any] = {}
    for name, one in options_of(cls):
        if one.parts is None:
            given[name] = values.pop(prefix + name, None)
        else:
            parts: Any = from_fields(one.parts, values, f"{prefix}{name}_")
            given[name] = None if parts == one.parts() else parts
    return cls(**{name: value for name, value in given.items() if value is not None})


def _renamed(old: str, new: str) -> Decorator:
    before, after = (f"--{name.replace('_', '-')}" for name in (old, new))

    def refuse(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
        if value is not None:
            raise OptionError("option-renamed", f"{before} is now called {after}", remedy=f"say {after} {value}")

    return click.option(before, hidden=True, expose_value=False, callback=refuse)


def _click_type(option: Option, kinds: tuple[Any, ...]) -> Any:
    """The click type of an option whose field has one of these types."""
    if option.choices:
        return click.Choice(option.choices)
    if option.limits is not None:
        return click.IntRange(*option.limits)
    if os.PathLike[str] in kinds:
        return PATH
    return str if str in kinds else kinds[0]
