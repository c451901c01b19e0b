"""Shared by all tests."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real captures; tests that need it are skipped where EIGENFIELD_DATA does not name one."""
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder or not Path(folder).is_dir():
        pytest.skip("EIGENFIELD_DATA names no folder of captures")
    return Path(folder)
