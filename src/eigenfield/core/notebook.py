"""Progress in a notebook."""

from __future__ import annotations

import html
import importlib
import sys
import time
from typing import Any

NOTEBOOK_UPDATE_SECONDS = 0.1  # between two updates of a bar

_bars: dict[str, tuple[Any, float]] = {}  # by stage: where it is displayed, and when it was last updated


def is_notebook() -> bool:
    """Whether this is the kernel of a Jupyter notebook, which displays HTML."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return shell is not None and getattr(shell, "kernel", None) is not None


def notebook_progress(stage: str, done: int, total: int) -> None:
    """The `Progress` of work that was given none: one bar a stage in a notebook, nothing anywhere else."""
    if not is_notebook():
        return
    display = importlib.import_module("IPython.display")
    text = f"{html.escape(stage)} <progress value='{done}' max='{max(total, 1)}'></progress> {done} of {total}"
    if done == 0 or stage not in _bars:
        _bars[stage] = display.display(display.HTML(text), display_id=True), time.monotonic()
    elif done >= total or time.monotonic() - _bars[stage][1] >= NOTEBOOK_UPDATE_SECONDS:
        _bars[stage][0].update(display.HTML(text))
        _bars[stage] = _bars[stage][0], time.monotonic()
    if done >= total:
        del _bars[stage]
