"""Children by fork, as `multiprocessing` makes them on Linux before Python 3.14: no thread of the parent comes along.

A lock that another thread held stays locked, and nobody takes what is in a queue. Whoever has such things names a
function that makes them anew.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable


def renew_in_child(renew: Callable[[], None]) -> Callable[[], None]:
    """Decorator: call `renew` first thing in every child that this process forks."""
    if sys.platform != "win32":  # which has no fork
        os.register_at_fork(after_in_child=renew)
    return renew
