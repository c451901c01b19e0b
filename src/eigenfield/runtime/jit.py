"""The one way to compile a kernel: serial, without the GIL, cached in the user's cache folder.

numba caches beside the source by default, which fails where the package is installed read-only and leaves every new
process to compile again. It also notices changes only in a kernel's own file, not in those it calls. Here each file
has a folder, whose name follows the text of the file and of all that it imports from the package. Another copy of the
package, such as a new clone, finds the kernels of the first, and a change compiles only what depends on it.
"""

from __future__ import annotations

import glob
import hashlib
import logging
import os
import re
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs
from numba.core import event
from numba.core.caching import FunctionCache, UserProvidedCacheLocator
from numba.core.compiler_lock import global_compiler_lock

log = logging.getLogger("eigenfield.kernels")

Kernel = Callable[..., Any]
_IMPORTS = re.compile(r"^from eigenfield\.(\S+) import", re.MULTILINE)


@cache
def _text(path: Path) -> str:
    """Of a module's file, or of its folder's `__init__.py`."""
    return (path if path.is_file() else path.with_suffix("") / "__init__.py").read_text(encoding="utf-8")


def _cache_folder() -> Path:
    """Of all kernels."""
    return Path(numba.config.CACHE_DIR or Path(platformdirs.user_cache_dir("eigenfield")) / "kernels")


@cache
def _version(source: Path) -> str:
    """A name for the kernels of a file in its present state and that of all that it imports."""
    root = Path(__file__).parents[1]
    waiting, counted = [source], set[Path]()
    while waiting:
        path = waiting.pop()
        if path not in counted:
            counted.add(path)
            waiting += [(root / name.replace(".", "/")).with_suffix(".py") for name in _IMPORTS.findall(_text(path))]
    digest = hashlib.sha256()
    for path in sorted(counted):
        digest.update(_text(path).encode() + b"\0")
    return f"{source.stem}-{digest.hexdigest()[:16]}"


class _Locator(UserProvidedCacheLocator):  # type: ignore[misc]
    """The folder that numba is told, whose name says what its kernels were compiled from."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        return ""  # numba's differs with the place of the source

    def get_source_stamp(self) -> str:
        return ""


class _Place(FunctionCache._impl_class):  # type: ignore[misc]
    """That folder, and none of the others that numba would try, such as the one of the source."""

    _locator_classes = (_Locator,)


class _Cache(FunctionCache):  # type: ignore[misc]
    """numba's cache of one function, which is not needed: its disk may be full, and its files damaged."""

    _impl_class = _Place

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # unpickling what is damaged may raise anything
            self._remove()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError:
            self._remove()  # the index may name a file that was not written, or an older one
            _say_not_kept()

    def _remove(self) -> None:
        for path in Path(self.cache_path).glob(f"{glob.escape(self._impl.filename_base)}.*"):
            with suppress(OSError):
                path.unlink()


@cache
def _say_not_kept() -> None:
    """Once in a process."""
    log.warning(
        "%s: compiled kernels cannot be kept there, so each run compiles them again; make room, or name another folder "
        "as NUMBA_CACHE_DIR",
        _cache_folder(),
    )


def _compiled(function: Kernel, folder: Path, options: dict[str, Any]) -> Any:
    """numba's dispatcher of a function, with a cache where one can be written."""
    dispatcher = numba.njit(**options)(function)
    theirs, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder)
    try:
        dispatcher._cache = _Cache(function)
    except (RuntimeError, OSError):  # RuntimeError: numba has tried to write there
        _say_not_kept()
    finally:
        numba.config.CACHE_DIR = theirs
    return dispatcher


def _share_calls(compiled: Any, function: Kernel, folder: Path, options: dict[str, Any]) -> None:
    """Let other kernels call a compilation of their own, which takes a fifth less time to make.

    It has no wrapper for calls from Python, which unpacks every array of every argument; numba makes one for each
    compilation otherwise. Kernels that pass constants share one: otherwise numba compiles a kernel for each constant
    with which another kernel calls it. LLVM still folds the constants of inlined kernels.
    """
    widen = numba.types.unliteral

    @cache
    def inner() -> Any:
        return _compiled(function, folder / "inner", {**options, "no_cpython_wrapper": True})

    compiled.get_call_template = lambda args, kws: inner().get_call_template(
        tuple(widen(kind) for kind in args), {name: widen(kind) for name, kind in kws.items()}
    )
    compiled.get_overload = lambda signature: inner().get_overload(signature)


def kernel(*, fastmath: bool | set[str] = False, inline: bool = False) -> Callable[[Kernel], Kernel]:
    """Decorator: compile with numba (nopython, nogil), keep the machine code between processes.

    Args:
        fastmath: Allow sums to be re-ordered; for drawing only, never where bytes of a file depend on it.
        inline: For small functions that other kernels call in their inner loops.
    """

    def decorate(function: Kernel) -> Kernel:
        options: dict[str, Any] = {"nogil": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
        options["fastmath"] = fastmath
        if inline:
            options["inline"] = "always"
        folder = _cache_folder() / _version(Path(function.__code__.co_filename))
        compiled: Kernel = _compiled(function, folder, options)
        _share_calls(compiled, function, folder, options)
        return compiled

    return decorate


if sys.platform != "win32":  # no process is forked in the middle of a compilation: its child could compile no more
    os.register_at_fork(
        before=global_compiler_lock.acquire,
        after_in_parent=global_compiler_lock.release,
        after_in_child=global_compiler_lock.release,
    )


class _Compilations(event.Listener):  # type: ignore[misc]
    """Counts the kernels that are being compiled, in any thread."""

    def __init__(self, changed: Callable[[bool], None]) -> None:
        self._changed, self._running, self._gate = changed, 0, threading.Lock()

    def on_start(self, event: Any) -> None:
        self._count(1)

    def on_end(self, event: Any) -> None:
        self._count(-1)

    def _count(self, more: int) -> None:
        with self._gate:
            before, self._running = self._running, self._running + more
            if (before > 0) != (self._running > 0):
                self._changed(self._running > 0)


@contextmanager
def watch_compilation(changed: Callable[[bool], None]) -> Iterator[None]:
    """Tell when kernels begin to be compiled, and when none is any longer. What the cache has is not compiled.

    Args:
        changed: Called with True and False in turns, from any thread.
    """
    with event.install_listener("numba:compile", _Compilations(changed)):
        yield
