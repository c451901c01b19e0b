"""Command-line options made from the fields of a dataclass, and the dataclass from what was given for them."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, TypeVar, get_args, get_type_hints

import click

from eigenfield.cli.common import PATH, Decorator, together
from eigenfield.encoding.fields import Option, options_of

T = TypeVar("T")


def field_options(cls: type, prefix: str = "", **parsers: Callable[..., Any]) -> Decorator:
    """Add an option for each field of a dataclass that carries one (`encoding.fields`), named as the field.

    Args:
        cls: The dataclass.
        prefix: Of the names.
        parsers: Click callbacks by name, for values that are more than a word or a number.
    """
    kinds, made = get_type_hints(cls), []
    for field, one in options_of(cls):
        name = prefix + field
        if one.parts is not None:
            made.append(field_options(one.parts, f"{name}_", **parsers))
            continue
        how: dict[str, Any] = {"help": one.help, "metavar": one.metavar, "callback": parsers.get(name)}
        if name not in parsers:
            how["type"] = _click_type(one, get_args(kinds[field]))
        if how.get("type") is bool:
            how |= {"is_flag": True, "default": None}
        if one.bare is not None:
            how |= {"is_flag": False, "flag_value": one.bare}
        letters = [] if one.letter is None else [one.letter]
        made.append(click.option(f"--{name.replace('_', '-')}", *letters, **how))
    return together(*made)


def from_fields(cls: type[T], values: dict[str, Any], prefix: str = "") -> T:
    """The dataclass with the values of `field_options`.

    Args:
        cls: The dataclass.
        values: By name; those of its fields are removed.
        prefix: Of the names.
    """
    given: dict[str, Any] = {}
    for name, one in options_of(cls):
        if one.parts is None:
            given[name] = values.pop(prefix + name)
        else:
            parts: Any = from_fields(one.parts, values, f"{prefix}{name}_")
            given[name] = None if parts == one.parts() else parts
    return cls(**given)


def _click_type(option: Option, kinds: tuple[Any, ...]) -> Any:
    """The click type of an option whose field has one of these types."""
    if option.choices:
        return click.Choice(option.choices)
    if option.limits is not None:
        return click.IntRange(*option.limits)
    return PATH if os.PathLike[str] in kinds else kinds[0]
