"""The one way to compile a kernel: serial, without the GIL, cached in the user's cache folder.

numba caches beside the source by default, which fails where the package is installed read-only and leaves every new
process to compile again. It also notices changes only in a kernel's own file, not in those it calls: the folder's
name therefore carries a digest of all sources of the package.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs

Kernel = Callable[..., Any]
_IMPORTS = re.compile(r"^from eigenfield\.(\S+) import", re.MULTILINE)


@cache
def _cache_folder() -> str:
    """A folder for this state of all kernels and of their imports. Numba notices a change of a kernel's own file, but
    not of a kernel or a constant from another one. A change elsewhere recompiles nothing."""
    root = Path(__file__).parents[1]
    texts = {path: path.read_text(encoding="utf-8") for path in root.rglob("*.py")}
    waiting = [path for path, text in texts.items() if "from eigenfield.runtime.jit import" in text]
    counted: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in counted and path in texts:
            counted.add(path)
            waiting += [(root / name.replace(".", "/")).with_suffix(".py") for name in _IMPORTS.findall(texts[path])]
    digest = hashlib.sha256()
    for path in sorted(counted):
        digest.update(f"{path.relative_to(root)} {path.stat().st_size} {path.stat().st_mtime_ns}\n".encode())
    return str(Path(platformdirs.user_cache_dir("eigenfield")) / "kernels" / digest.hexdigest()[:16])


def _widen_literals(compiled: Any) -> None:
    """Let kernels that pass constants share one compilation: otherwise numba compiles a kernel for each constant with
    which another kernel calls it. LLVM still folds the constants of inlined kernels."""
    resolve, widen = compiled.get_call_template, numba.types.unliteral
    compiled.get_call_template = lambda args, kws: resolve(
        tuple(widen(kind) for kind in args), {name: widen(kind) for name, kind in kws.items()}
    )


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
        theirs = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = theirs or _cache_folder()
        try:
            compiled: Kernel = numba.njit(cache=True, **options)(function)
        except (RuntimeError, OSError):  # nowhere to write a cache
            compiled = numba.njit(**options)(function)
        finally:
            numba.config.CACHE_DIR = theirs
        _widen_literals(compiled)
        return compiled

    return decorate
