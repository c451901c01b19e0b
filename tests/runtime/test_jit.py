"""Compiled kernels are kept in the user's cache folder, and do without one."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

MODULE = """
from eigenfield.runtime.jit import kernel

@kernel()
def double(x):
    return 2 * x

assert double(21) == 42
print(sum(double.stats.cache_hits.values()), sum(double.stats.cache_misses.values()))
"""


@pytest.fixture
def counts(tmp_path):
    (tmp_path / "module.py").write_text(MODULE)

    def call(cache):
        environment = os.environ | {"XDG_CACHE_HOME": str(cache)}
        environment.pop("NUMBA_CACHE_DIR", None)
        command = [sys.executable, "-B", str(tmp_path / "module.py")]
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stderr
        return tuple(map(int, done.stdout.split()))

    return call


@pytest.mark.skipif(sys.platform != "linux", reason="XDG_CACHE_HOME names the cache on Linux")
def test_the_second_process_compiles_nothing(counts, tmp_path):
    assert counts(tmp_path / "cache") == (0, 1)
    assert counts(tmp_path / "cache") == (1, 0)
    assert list((tmp_path / "cache" / "eigenfield").rglob("*.nbi"))
    assert not (tmp_path / "__pycache__").exists()  # nothing beside the source, which may be read-only


@pytest.mark.skipif(sys.platform != "linux", reason="XDG_CACHE_HOME names the cache on Linux")
def test_without_a_place_for_a_cache_it_still_runs(counts):
    counts("/dev/null/nowhere")
