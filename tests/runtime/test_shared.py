"""Values that workers share: read once, by any user, and gone with the block."""

from __future__ import annotations

import os
import re

import pytest

from eigenfield.runtime.executor import open_executor, spread
from eigenfield.runtime.shared import share
from eigenfield.runtime.stages import PACKAGE_FOLDER


def test_a_worker_reads_each_value_once(tmp_path):
    with open_executor(1) as workers, share(["one", "two"], tmp_path) as shared:
        assert list(spread(workers, ((each.value,) for each in (*shared, *shared)))) == ["one", "two", "one", "two"]
        shared[0].file.write_bytes(b"not read again")
        assert workers.submit(shared[0].value).result() == "one"
    assert not list(tmp_path.iterdir())


def test_values_of_a_block_that_has_ended_are_not_kept(tmp_path):
    with share([["first"]], tmp_path) as (first,), share([["second"]], tmp_path) as (second,):
        kept = first.value()
        assert first.value() is kept
        assert second.value() == ["second"] and first.value() == kept and first.value() is not kept
    with pytest.raises(FileNotFoundError):
        first.value()


@pytest.mark.skipif(os.name != "posix", reason="permissions")
@pytest.mark.parametrize("umask", [0o022, 0o002, 0o077])
def test_a_worker_of_another_user_can_read(tmp_path, umask):
    before = os.umask(umask)
    try:
        with share([1, 2], tmp_path) as shared:
            folder = shared[0].file.parent
            assert folder.stat().st_mode & 0o755 == 0o755 and all(each.file.parent == folder for each in shared)
            assert all(each.file.stat().st_mode & 0o777 == 0o644 for each in shared)
            assert (folder.stat().st_mode & 0o020 > 0) == (umask == 0o002)
    finally:
        os.umask(before)


def test_nothing_else_hands_values_to_workers():
    """Every place that shares values does it by `share`, and so with its permissions."""
    files = {
        path.relative_to(PACKAGE_FOLDER).as_posix(): path.read_text("utf-8") for path in PACKAGE_FOLDER.rglob("*.py")
    }
    assert {name for name, text in files.items() if "import pickle" in text} == {
        "runtime/shared.py",
        "runtime/tasks.py",
    }
    users = {name for name, text in files.items() if re.search(r"\bwith share\(", text)}
    assert users == {
        "calibration/motion/on_workers.py",
        "encoding/clip/groups.py",
        "encoding/projected/maps_on_workers.py",
        "evaluation/spread.py",
        "proxy/surface/depth_maps.py",
    }
