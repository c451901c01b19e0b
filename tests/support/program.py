"""The command line in this process."""

from __future__ import annotations

import logging
import signal
import sys
from typing import NamedTuple
from unittest import mock

from eigenfield.runtime.signals import STOP_SIGNALS


class Ran(NamedTuple):
    """What a call of the program left."""

    code: int
    out: str
    err: str


def call(*words: object) -> int:
    """Call the program as the shell does, and give its exit code.

    With --traceback among the words, an EigenfieldError is raised and not printed.
    """
    from eigenfield.cli import main

    before, log = {number: signal.getsignal(number) for number in STOP_SIGNALS}, logging.getLogger("eigenfield")
    level = log.level  # which -v changes
    try:
        with mock.patch.object(sys, "argv", ["eigenfield", *map(str, words)]):
            main()
    except SystemExit as stop:
        return int(stop.code or 0)
    finally:
        log.setLevel(level)
        for number, handler in before.items():
            signal.signal(number, handler)
    return 0
