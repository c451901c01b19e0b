"""Files are whole or absent; a full disk, a lost folder and an interruption leave nothing behind."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
import time
import weakref
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np
import pytest

from eigenfield.core.errors import EigenfieldError, OptionError, OutputError
from eigenfield.runtime import files
from eigenfield.runtime.files import (
    atomic_writer,
    read_arrays,
    refuse_existing,
    scratch_array,
    scratch_arrays,
    scratch_rows,
    write_bytes,
)
from eigenfield.runtime.parallel import parallel_map, parallel_stream, set_threads


def test_a_file_appears_whole(tmp_path):
    path = tmp_path / "with space.glb"
    write_bytes(path, b"abc")
    assert path.read_bytes() == b"abc"
    assert list(tmp_path.iterdir()) == [path]


def test_an_existing_file_is_kept_unless_asked(tmp_path):
    path = tmp_path / "a"
    write_bytes(path, b"old")
    with pytest.raises(OutputError, match="--overwrite") as caught:
        write_bytes(path, b"new")
    assert caught.value.code == "output-exists"
    assert path.read_bytes() == b"old"
    write_bytes(path, b"new", overwrite=True)
    assert path.read_bytes() == b"new"


@pytest.mark.parametrize("error", [KeyboardInterrupt(), RuntimeError("bug")])
def test_an_interrupted_write_leaves_the_old_file_and_no_debris(tmp_path, error):
    path = tmp_path / "a"
    write_bytes(path, b"old")
    with pytest.raises(type(error)), atomic_writer(path, overwrite=True) as file:
        file.write(b"half")
        raise error
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_is_said(tmp_path, monkeypatch):
    def full(descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match="no room left") as caught:
        write_bytes(tmp_path / "a", b"abc")
    assert caught.value.code == "disk-full"
    assert list(tmp_path.iterdir()) == []


def test_of_files_that_appear_together_none_stays_if_one_cannot(tmp_path, monkeypatch):
    """Files that were there are as before, files that were not are gone."""
    targets = [tmp_path / name for name in ("old", "new", "last", "never")]
    for target in (targets[0], targets[3]):
        target.write_text("before")

    def rename(place, target):
        if target.name == "last":
            raise OSError(errno.ENOSPC, "No space left on device")
        place.replace(target)

    monkeypatch.setattr(files, "rename", rename)
    with pytest.raises(OutputError), files.atomic_files(targets, overwrite=True) as places:
        for place in places:
            place.write_text("after")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"old": "before", "never": "before"}


@pytest.mark.skipif(sys.platform == "win32", reason="limits on file sizes are POSIX")
def test_a_file_that_outgrows_the_limit_is_said(tmp_path):
    """A real refusal of the operating system, not a simulated one."""
    code = (
        "import resource, signal, sys; from pathlib import Path;"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000));"
        "from eigenfield.core.errors import OutputError\n"
        "from eigenfield.runtime.files import write_bytes, scratch_array\n"
        "for work in (lambda: write_bytes(Path(sys.argv[1]) / 'a', bytes(5000)),"
        "             lambda: scratch_array((5000,), 'f4', Path(sys.argv[1])).__enter__()):\n"
        "    try: work()\n"
        "    except OutputError as error: assert error.code == 'disk-full', error\n"
        "    else: raise SystemExit('no error')"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=True)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_folder_and_a_folder_as_output_are_said(tmp_path):
    with pytest.raises(OutputError, match="does not exist"):
        refuse_existing(tmp_path / "no" / "a", False)
    with pytest.raises(OutputError, match="is a folder"):
        refuse_existing(tmp_path, True)
    with pytest.raises(OutputError), scratch_array((3,), np.float32, tmp_path / "no"):
        pass
    with pytest.raises(OutputError, match=r"too long|cannot"):
        refuse_existing(tmp_path / ("a" * 256), False)
    write_bytes(tmp_path / ("a" * 255), b"abc")  # the temporary name beside it is shorter


def test_an_error_inside_a_scratch_arrays_block_stays_what_it_is(tmp_path):
    with pytest.raises(FileNotFoundError), scratch_array((3,), np.float32, tmp_path):
        (tmp_path / "nothing").read_bytes()
    assert list(tmp_path.iterdir()) == []


def test_memory_has_only_those_scratch_arrays_that_are_held(tmp_path):
    with scratch_arrays(3, (1000, 3), np.uint8, tmp_path) as array:
        for number in range(3):
            one = array(number)
            assert one.shape == (1000, 3) and not one.any()
            one[:] = number + 1
            held = weakref.ref(one)
            del one
            assert held() is None
        assert [int(array(number).min()) for number in (2, 0, 1)] == [3, 1, 2]
    assert list(tmp_path.iterdir()) == []


def test_scratch_rows_grow(tmp_path):
    with scratch_rows((2,), np.float32, tmp_path) as rows, scratch_rows((), np.uint16, tmp_path) as none:
        for count in (3, 0, 4):
            rows.append(np.full((count, 2), count, np.float64))
        array = rows.mapped()
        assert array.shape == (7, 2) and array.dtype == np.float32 and array[:, 1].tolist() == [3] * 3 + [4] * 4
        array[0] = 1
        assert none.mapped().shape == (0,)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OutputError), scratch_rows((3,), np.float32, tmp_path / "no"):
        pass


@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="where the system cannot, free space is checked")
def test_a_scratch_arrays_room_is_taken_at_once(tmp_path, monkeypatch):
    def allocate(descriptor, offset, length):
        assert (os.fstat(descriptor).st_size, offset, length) == (0, 0, 80)
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", allocate)
    with pytest.raises(OutputError) as caught, scratch_array((4, 5), np.float32, tmp_path):
        pass
    assert caught.value.code == "disk-full"


def test_scratch_arrays_leave_nothing(tmp_path):
    with scratch_array((4, 5), np.float32, tmp_path) as array:
        array[2] = 7
        assert array.sum() == 35
    assert list(tmp_path.iterdir()) == []
    with scratch_array((0, 5), np.float32, tmp_path) as array:
        assert array.shape == (0, 5)


def test_errors_are_one_line_with_file_and_remedy():
    error = EigenfieldError("code", "is broken", path="a.png", remedy="mend it")
    assert str(error) == "a.png: is broken; mend it"
    error = EigenfieldError("code", "is broken", path="a\nb\x1b[2J\udcff.png")
    assert str(error) == r"a\nb\x1b[2J\udcff.png: is broken"


@pytest.mark.parametrize("count", [1, 2, 5])
def test_work_is_shared_in_order_and_nests(count):
    set_threads(count)
    try:
        assert parallel_map(lambda i: sum(parallel_map(lambda j: i * j, range(10))), range(20)) == [
            45 * i for i in range(20)
        ]
        with pytest.raises(ZeroDivisionError):
            list(parallel_stream(lambda i: 1 // (i - 5), range(100)))
    finally:
        set_threads(None)


def test_streams_stay_close_to_their_consumer():
    """Memory does not grow with the number of cameras: only a few results wait."""
    set_threads(2)
    started = []
    try:
        stream = parallel_stream(started.append, range(1000))
        for _ in range(3):
            next(stream)
        assert len(started) <= 3 + 2 + 2 + 1
    finally:
        stream.close()
        set_threads(None)


def test_zero_threads_are_refused():
    with pytest.raises(OptionError):
        set_threads(0)


@pytest.mark.slow
def test_scratch_beyond_4_gib_keeps_what_is_written_at_its_end(tmp_path):
    if shutil.disk_usage(tmp_path).free < 8 << 30:
        pytest.skip("needs 8 GiB of free disk")
    rows = (5 << 30) // 4096
    with scratch_array((rows, 1024), np.float32, tmp_path) as array:
        array[-1], array[0] = 2.0, 1.0
        array.flush()
        assert array[-1].sum() == 2048 and array[0].sum() == 1024 and not array[rows // 2].any()


def test_threads_read_arrays_in_turns(tmp_path, monkeypatch):
    path, inside, most = tmp_path / "a.npz", 0, 0
    np.savez(path, one=np.arange(6).reshape(2, 3), other=np.float32(7))
    load = np.load

    @contextmanager
    def slow_load(place):
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        time.sleep(0.01)
        with load(place) as found:
            yield found
        inside -= 1

    monkeypatch.setattr(files.np, "load", slow_load)
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(read_arrays, [path] * 8):
            assert found["one"].tolist() == [[0, 1, 2], [3, 4, 5]] and found["other"] == 7
    assert most == 1
