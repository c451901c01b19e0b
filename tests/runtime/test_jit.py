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

    def call(cache, module=tmp_path / "module.py"):
        environment = os.environ | {"XDG_CACHE_HOME": str(cache)}
        environment.pop("NUMBA_CACHE_DIR", None)
        command = [sys.executable, "-B", str(module)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stderr
        assert ("NUMBA_CACHE_DIR" in done.stderr) == str(cache).startswith("/dev/null")
        return tuple(map(int, done.stdout.split()))

    return call


@pytest.mark.skipif(sys.platform != "linux", reason="XDG_CACHE_HOME names the cache on Linux")
@pytest.mark.slow
def test_the_second_process_compiles_nothing(counts, tmp_path):
    assert counts(tmp_path / "cache") == (0, 1)
    assert counts(tmp_path / "cache") == (1, 0)
    assert list((tmp_path / "cache" / "eigenfield").rglob("*.nbi"))
    assert not (tmp_path / "__pycache__").exists()  # nothing beside the source, which may be read-only


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="XDG_CACHE_HOME names the cache on Linux")
def test_a_copy_of_the_source_has_its_kernels_and_a_change_has_none(counts, tmp_path):
    assert counts(tmp_path / "cache") == (0, 1)
    copy = tmp_path / "clone" / "module.py"
    copy.parent.mkdir()
    copy.write_text(MODULE)
    assert counts(tmp_path / "cache", copy) == (1, 0)
    copy.write_text(MODULE.replace("2 * x", "x + x"))
    assert counts(tmp_path / "cache", copy) == (0, 1)


def test_kernels_follow_what_their_file_imports(tmp_path, monkeypatch):
    jit = pytest.importorskip("eigenfield.runtime.jit")
    package = tmp_path / "eigenfield"
    sources = {
        "runtime/jit.py": "",
        "rays.py": "from eigenfield.core.scale import UNIT",
        "core/scale.py": "UNIT = 1",
        "other.py": "UNIT = 3",
    }
    monkeypatch.setattr(jit, "__file__", str(package / "runtime" / "jit.py"))

    def version(**changed):
        jit._text.cache_clear()
        for name, text in (sources | changed).items():
            (package / name).parent.mkdir(parents=True, exist_ok=True)
            (package / name).write_text(text)
        return jit._version.__wrapped__(package / "rays.py")

    first = version()
    assert first.startswith("rays-")
    assert version(**{"other.py": "UNIT = 4"}) == first
    assert version(**{"core/scale.py": "UNIT = 2"}) != first


@pytest.mark.skipif(sys.platform != "linux", reason="XDG_CACHE_HOME names the cache on Linux")
def test_without_a_place_for_a_cache_it_still_runs(counts, tmp_path):
    assert counts("/dev/null/nowhere") == (0, 1)
    assert not (tmp_path / "__pycache__").exists()  # where no change of another kernel would be noticed


def twice(x):
    return 2 * x


@pytest.fixture
def hits(tmp_path, monkeypatch, caplog):
    """Make the kernel anew, call it, and say how often its code came from the cache, and how many files that has."""
    numba = pytest.importorskip("numba")
    jit = pytest.importorskip("eigenfield.runtime.jit")
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    jit._say_not_kept.cache_clear()

    def call():
        compiled = jit.kernel()(twice)
        assert compiled(21) == 42
        return sum(compiled.stats.cache_hits.values()), len([path for path in tmp_path.rglob("*") if path.is_file()])

    return call


@pytest.mark.parametrize("ending", [".nbi", ".nbc"])
@pytest.mark.parametrize(
    "damage", [lambda data: b"", lambda data: data[: len(data) // 2], lambda data: bytes(len(data))]
)
def test_a_damaged_cache_is_made_anew(hits, tmp_path, ending, damage, caplog):
    assert hits() == (0, 2)
    (path,) = tmp_path.rglob(f"*{ending}")
    path.write_bytes(damage(path.read_bytes()))
    assert hits() == (0, 2)
    assert hits() == (1, 2)
    assert caplog.messages == []


@pytest.mark.skipif(sys.platform == "win32", reason="limits on file sizes are POSIX")
@pytest.mark.parametrize("size", [10, 1000])
def test_a_cache_on_a_full_disk_is_said_once(hits, caplog, size):
    """With 1000 bytes the index is written, and the code is not."""
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        assert hits() == hits() == (0, 0)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    (said,) = caplog.messages
    assert "NUMBA_CACHE_DIR" in said
    assert hits() == (0, 2)
