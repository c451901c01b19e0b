"""Hook by which a notebook shows a scene, set from above, so that plain data imports no viewer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

show: Callable[[Any], str] | None = None  # from a scene to HTML; set by `eigenfield/__init__.py`
