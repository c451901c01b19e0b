"""Arguments of public functions, checked against their annotations: a wrong one is an OptionError that names it.

Messages name the options of the command line. Whoever calls a public function reads its arguments instead.
"""

from __future__ import annotations

import contextlib
import errno
import functools
import inspect
import os
import re
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from numbers import Integral, Real
from typing import Any, Never, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

from eigenfield.core.errors import EigenfieldError, OptionError

P = ParamSpec("P")
R = TypeVar("R")
_OPTION = re.compile(r"`[^`]*`|(?<![\w-])--(?P<no>no-)?(?P<option>[a-z][a-z0-9]*(-[a-z0-9]+)*)(?P<value> [\w.]+)?")
_ARGUMENTS = {"as": "kind", "primitive": "primitives", "fit-sphere": "fit_spheres", "fill-background": "background"}
_on_command_line: ContextVar[bool] = ContextVar("on_command_line", default=False)
_BAD_NAMES = errno.ENAMETOOLONG, errno.ELOOP  # which even asking whether there is such a file raises
_NUMBERS = {int: Integral, float: Real}  # NumPy's numbers too
_WORDS = {int: "a whole number", float: "a number", str: "a text", bool: "True or False", type(None): "None",
          os.PathLike: "a path"}  # fmt: skip


def public_name(function: Callable[..., Any]) -> str:
    """What users call a function: `eigenfield.open` has a longer name within."""
    return "open" if function.__name__ in ("open_any", "open_path") else function.__name__


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which raises OptionError `argument` for arguments of another type than it says, and unknown ones,
    and `path` for a path that no file can have.

    A NumPy array or a list stands for a tuple, and a whole number for a number.

    Args:
        function: What its annotations name only under TYPE_CHECKING is left to it to check.
    """
    signature = inspect.signature(function)

    @functools.cache
    def hint(name: str) -> Any:
        holder = types.SimpleNamespace(__annotations__={name: signature.parameters[name].annotation})
        try:
            return get_type_hints(holder, inspect.unwrap(function).__globals__)[name]
        except NameError:
            return object

    @functools.wraps(function)
    def call(*args: P.args, **named: P.kwargs) -> R:
        try:
            given = signature.bind(*args, **named).arguments
        except TypeError as error:
            remedy = f"it takes {', '.join(signature.parameters)}"
            raise OptionError("argument", f"{public_name(function)}: {error}", remedy=remedy) from None
        for name, value in given.items():
            kind = signature.parameters[name].kind
            if kind is not inspect.Parameter.VAR_KEYWORD and not matches(value, hint(name)):
                message = f"{name} of {public_name(function)} is {_shown(value)}"
                raise OptionError("argument", message, remedy=f"give {in_words(hint(name))}")
        try:
            return function(*args, **named)
        except OSError as error:
            if error.errno not in _BAD_NAMES:
                raise
            raise OptionError("path", os.strerror(error.errno), path=error.filename, remedy="name another") from error
        except EigenfieldError as error:
            if not _on_command_line.get():
                _name_arguments(error, signature)
            raise

    return call


@contextlib.contextmanager
def on_command_line() -> Iterator[None]:
    """Within the block errors name options, not arguments."""
    token = _on_command_line.set(True)
    try:
        yield
    finally:
        _on_command_line.reset(token)


def _name_arguments(error: EigenfieldError, signature: inspect.Signature) -> None:
    """Write overwrite=True for --overwrite, fit="none" for "say --fit none", and hold_out for other uses of --hold-out,
    where the function has such an argument."""
    parameters = signature.parameters
    takes_more = any(
        parameter.kind is inspect.Parameter.VAR_KEYWORD and parameter.annotation is not Never
        for parameter in parameters.values()
    )

    def argument(found: re.Match[str]) -> str:
        if found["option"] is None:  # a command
            return found[0]
        name = _ARGUMENTS.get(found["option"], found["option"].replace("-", "_"))
        if name not in parameters and not takes_more:
            return found[0]
        value = found["value"] or ""
        if found["no"] or (name in parameters and "bool" in str(parameters[name].annotation)):
            return f"{name}={not found['no']}{value}"
        is_said = found.string[: found.start()].endswith(("say ", "or ")) and value not in ("", " or", " and")
        if not is_said:
            return f"{name}{value}"
        is_pair = name in parameters and "tuple" in str(parameters[name].annotation)  # ROWSxCOLUMNS
        return f"{name}=({value[1:].replace('x', ', ')})" if is_pair else f'{name}="{value[1:]}"'

    error.message = _OPTION.sub(argument, error.message)
    error.remedy = None if error.remedy is None else _OPTION.sub(argument, error.remedy)
    error.args = error.code, error.message


def matches(value: Any, hint: Any) -> bool:
    """Whether a value is of an evaluated annotation's type; what is none of the types that options have is taken."""
    origin, inner = get_origin(hint) or hint, get_args(hint)
    if origin in (Union, types.UnionType):
        return any(matches(value, each) for each in inner)
    if origin is tuple or origin is Sequence:
        if isinstance(value, str | bytes | Mapping) or not (isinstance(value, Sequence) or hasattr(value, "__array__")):
            return False
        if origin is tuple and inner[-1:] != (...,):
            return len(value) == len(inner) and all(map(matches, value, inner))
        return all(matches(each, inner[0]) for each in value)
    if getattr(origin, "_is_protocol", False):
        return callable(value) if "__call__" in vars(origin) else True
    if not isinstance(origin, type) or origin is object:
        return True
    return isinstance(value, _NUMBERS.get(origin, origin)) and not (isinstance(value, bool) and origin in _NUMBERS)


def in_words(hint: Any) -> str:
    """What an evaluated annotation takes, for a message."""
    origin, inner = get_origin(hint) or hint, get_args(hint)
    if origin in (Union, types.UnionType):
        is_path = any(get_origin(each) is os.PathLike for each in inner)
        kinds = (each for each in inner if not (is_path and each is str))  # which is a path, too
        return " or ".join(dict.fromkeys(map(in_words, kinds)))
    if origin is tuple and inner[-1:] != (...,):
        return f"({', '.join(map(in_words, inner))})"
    if origin in (tuple, Sequence):
        return f"a sequence, each {in_words(inner[0])}"
    return _WORDS.get(origin) or _with_article(getattr(origin, "__name__", str(origin)))


def _shown(value: object) -> str:
    text = repr(value) if value is None or isinstance(value, str | int | float | Iterable) else ""
    return text if 0 < len(text) <= 40 else kind_in_words(value)


def kind_in_words(value: object) -> str:
    """The name of a value's type with its article, for a message."""
    return _with_article(type(value).__name__)


def _with_article(name: str) -> str:
    return f"{'an' if name[0] in 'AEIOaeio' else 'a'} {name}"
