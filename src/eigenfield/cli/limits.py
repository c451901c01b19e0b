"""Limits of a machine as they come out of libraries, in words for a person: no bug, and not a file's fault."""

from __future__ import annotations

import errno
import re

_MEMORY = "not enough memory", "use fewer or smaller photographs, fewer --threads, or a machine with more memory"
_FILES = "too many files are open", "raise the limit (`ulimit -n`)"
_THREADS = "no further thread or process can be started", "use fewer --threads, or raise the limit (`ulimit -u`)"
_DISK = "no room left on the disk", "free some, also in the folder for temporary files (TMPDIR)"
_ERRNOS = {
    errno.ENOMEM: _MEMORY, errno.EMFILE: _FILES, errno.ENFILE: _FILES, errno.EAGAIN: _THREADS,
    errno.ENOSPC: _DISK, errno.EDQUOT: _DISK, errno.EFBIG: _DISK,
}  # fmt: skip
_WORDS = {  # of RuntimeError, ImportError and cv2.error
    r"can't start new thread|Resource temporarily unavailable": _THREADS,
    r"failed to map segment|[Cc]annot allocate memory|Insufficient memory|[Oo]ut of memory|bad_alloc": _MEMORY,
    r"Too many open files": _FILES,
    r"No space left on device|File too large": _DISK,
}


def limit_of(error: BaseException) -> tuple[str, str] | None:
    """What the machine lacked or refused and a remedy, where that is why an error was raised, or what it came from."""
    if isinstance(error, MemoryError):
        return _MEMORY
    if isinstance(error, OSError):
        if error.errno in (errno.ENAMETOOLONG, errno.ELOOP, errno.EIO):
            return f"{error.filename or 'a file'}: {error.strerror}", "name another"
        if error.errno in _ERRNOS:
            return _ERRNOS[error.errno]
    found = next((words for pattern, words in _WORDS.items() if re.search(pattern, str(error))), None)
    cause = error.__cause__ or error.__context__
    return found if found is not None or cause is None else limit_of(cause)
