"""What Windows and macOS do otherwise than Linux: each branch for them is forced here, on any system."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

import eigenfield.cli as cli
from eigenfield.capture import open_any, open_photographs
from eigenfield.capture.messages import unique_names
from eigenfield.capture.writers.transforms import relative_path
from eigenfield.core.errors import CaptureError, OptionError, OutputError
from eigenfield.runtime import children, parallel, temporary
from eigenfield.runtime.files import atomic_files, flush_folder, output_errors, scratch_array, write_bytes
from eigenfield.runtime.stages import Stages
from eigenfield.runtime.temporary import temporary_file, temporary_folder
from eigenfield.viewer.exports.folder import LISTING_FILE, write_listing


@pytest.fixture
def windows(monkeypatch):
    """What the program asks of `sys.platform` is answered as on Windows; there are no locks of files."""
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(temporary, "fcntl", None)
    monkeypatch.setattr(time, "sleep", lambda seconds: None)


def shared(path: object, number: int = 32) -> PermissionError:
    """The error of Windows for a file that another program has open."""
    error = PermissionError(errno.EACCES, "The process cannot access the file", str(path))
    error.winerror = number  # type: ignore[attr-defined]  # an attribute on Windows alone
    return error


def refuse_renames(monkeypatch, times: int) -> list[Path]:
    """Let the first renames fail as they do while a virus scanner has a file open; the list has all that were tried."""
    tried: list[Path] = []
    real = Path.replace

    def replace(self, target):
        tried.append(Path(target))
        if len(tried) <= times:
            raise shared(target)
        return real(self, target)

    monkeypatch.setattr(Path, "replace", replace)
    return tried


def test_a_file_that_is_open_for_a_moment_is_replaced_a_little_later(tmp_path, windows, monkeypatch):
    path = tmp_path / "a.glb"
    path.write_bytes(b"old")
    tried = refuse_renames(monkeypatch, 2)
    write_bytes(path, b"new", overwrite=True)
    assert path.read_bytes() == b"new" and tried == [path] * 3
    tried.clear()
    with atomic_files([tmp_path / "b", path], overwrite=True) as places:
        for place in places:
            place.write_bytes(b"newer")
    assert path.read_bytes() == (tmp_path / "b").read_bytes() == b"newer"
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a.glb", "b"]


def test_a_file_that_stays_open_is_said_and_stays(tmp_path, windows, monkeypatch):
    path = tmp_path / "a.glb"
    path.write_bytes(b"old")
    refuse_renames(monkeypatch, 1000)
    with pytest.raises(OutputError, match=r"a\.glb: is open in another program; close it there") as caught:
        write_bytes(path, b"new", overwrite=True)
    assert caught.value.code == "not-writable"
    assert path.read_bytes() == b"old" and list(tmp_path.iterdir()) == [path]


def test_elsewhere_a_rename_is_tried_once(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    tried = refuse_renames(monkeypatch, 1000)
    with pytest.raises(OutputError):
        write_bytes(tmp_path / "a", b"new")
    assert len(tried) == 1


def test_a_refusal_without_another_program_keeps_its_remedy(tmp_path):
    with pytest.raises(OutputError, match="name a place that can be written"), output_errors(tmp_path):
        raise shared(tmp_path, 5)


def test_a_stage_that_another_run_has_finished_is_taken_at_once(tmp_path, windows, monkeypatch):
    """Windows refuses to rename a folder to one that exists; waiting would not help."""
    tried = refuse_renames(monkeypatch, 1000)

    def build(folder):
        (tmp_path / "depth-k").mkdir()
        (folder / "x").write_bytes(b"x")

    assert Stages(tmp_path).run("depth", "k", build) == tmp_path / "depth-k"
    assert len(tried) == 1


def test_what_is_flushed_is_opened_for_writing(tmp_path, windows, monkeypatch):
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "a").write_bytes(b"a")
    modes = []
    real = os.open
    monkeypatch.setattr(os, "open", lambda path, mode, *more: modes.append(mode) or real(path, mode, *more))
    flush_folder(tmp_path)
    assert modes == [os.O_RDWR]


def test_a_folder_that_is_to_be_moved_takes_the_access_of_its_place(tmp_path, windows, monkeypatch):
    """Python 3.12 makes folders of mode 0o700 on Windows with an access list that moved files keep."""
    modes = []
    real = Path.mkdir
    monkeypatch.setattr(Path, "mkdir", lambda self, mode=0o777, **more: modes.append(mode) or real(self, mode, **more))
    with temporary_folder("a", tmp_path), temporary_folder():
        assert modes == [0o777, 0o700]


def test_without_locks_nobody_elses_files_are_removed(tmp_path, windows):
    left = tmp_path / f".scene.glb-{'0' * 16}.part"
    left.write_bytes(b"of a running process, or of a killed one")
    with temporary_file("scene.glb", tmp_path) as file:
        assert file.exists()
    assert list(tmp_path.iterdir()) == [left]


def test_scratch_space_is_checked_where_it_cannot_be_allocated(tmp_path, monkeypatch):
    monkeypatch.delattr(os, "posix_fallocate", raising=False)
    with scratch_array((4, 5), np.float32, tmp_path) as array:
        array[3] = 1
        assert array.sum() == 5
    monkeypatch.setattr(shutil, "disk_usage", lambda place: shutil._ntuple_diskusage(100, 21, 79))
    with pytest.raises(OutputError) as caught, scratch_array((4, 5), np.float32, tmp_path):
        pass
    assert caught.value.code == "disk-full" and list(tmp_path.iterdir()) == []


def test_a_console_that_is_closed_stops_windows(monkeypatch):
    """Its signal is SIGBREAK, which no other system has."""
    code = (
        "import signal; signal.SIGBREAK = signal.SIGUSR1; del signal.SIGHUP\n"
        "from eigenfield.runtime.signals import STOP_SIGNALS; print(*map(int, STOP_SIGNALS))"
    )
    if sys.platform == "win32":
        code = code.splitlines()[1]
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    last = signal.SIGBREAK if sys.platform == "win32" else signal.SIGUSR1
    assert answer.split() == [str(int(n)) for n in (signal.SIGINT, signal.SIGTERM, last)]


def test_the_main_thread_is_woken_without_pthreads(windows, monkeypatch):
    sent = []
    monkeypatch.setattr(cli._thread, "interrupt_main", sent.append)
    cli._signal_main_thread(signal.SIGTERM)
    assert sent == [signal.SIGTERM]


@pytest.mark.parametrize("system", ["win32", "darwin"])
def test_children_start_without_the_launcher_of_linux(monkeypatch, system):
    monkeypatch.setattr(children.sys, "platform", system)
    with children.child_process([sys.executable, "-c", "print(7)"], stdout=subprocess.PIPE) as process:
        assert process.args == [sys.executable, "-c", "print(7)"]
        assert process.communicate()[0].split() == [b"7"]


def test_threads_without_affinity_or_real_time(monkeypatch, tmp_path):
    for name in ("sched_getaffinity", "sched_getscheduler"):
        monkeypatch.delattr(os, name, raising=False)
    monkeypatch.setattr(parallel, "_threads", None)
    monkeypatch.setattr(parallel, "TASKS_FOLDER", tmp_path / "no-proc")
    monkeypatch.setattr(os, "cpu_count", lambda: 3)
    assert parallel.threads() == 3
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert parallel.threads() == 1
    with parallel.ordinary_scheduling():
        assert parallel._real_time_threads() == set()


def drives(monkeypatch) -> None:
    """Let paths below /c and /d lie on two drives of Windows."""

    def refuse(function, paths):
        if len({str(path)[:3] for path in paths}) > 1:
            raise ValueError("Paths don't have the same drive")
        return function

    common, relative = os.path.commonpath, os.path.relpath
    monkeypatch.setattr(os.path, "commonpath", lambda paths: refuse(common, paths)(paths))
    monkeypatch.setattr(os.path, "relpath", lambda path, start: refuse(relative, [path, start])(path, start))


def test_paths_on_two_drives(monkeypatch):
    drives(monkeypatch)
    assert unique_names([Path("/c/a.png"), Path("/d/a.png"), Path("/d/b.png")]) == ["/c/a.png", "/d/a.png", "b.png"]
    assert unique_names([Path("/c/1/a.png"), Path("/c/2/a.png")]) == ["1/a.png", "2/a.png"]
    assert relative_path(Path("/c/a.png"), Path("/d/out")) == Path("/c/a.png").absolute().as_posix()
    with pytest.raises(OptionError, match="on several drives") as caught:
        open_any("/c/left", also=["/d/right"])
    assert caught.value.code == "folders-drives"


def zipped(path: Path, *names: str) -> Path:
    with zipfile.ZipFile(path, "w") as out:
        for name in names:
            out.writestr(name, b"x")
    return path


@pytest.mark.parametrize("name", ["a/CON.png", "a/b:c.png", "dot./a.png", "space /a.png", "why?.png", "lpt1"])
def test_names_that_windows_does_not_allow_are_refused_there(tmp_path, monkeypatch, name):
    path = zipped(tmp_path / "a.zip", name)
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(CaptureError, match="Windows does not allow") as caught:
        open_photographs(path, work=tmp_path / "work")
    assert caught.value.code == "zip-path"


@pytest.mark.parametrize("name", ["a/console.png", "comb.png", "a.b c.png"])
def test_other_names_are_not(tmp_path, monkeypatch, name):
    path = zipped(tmp_path / "a.zip", name)
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(CaptureError) as caught:  # it is no photograph
        open_photographs(path, work=tmp_path / "work")
    assert caught.value.code != "zip-path"


def test_names_that_differ_in_case_alone_are_refused_where_they_are_one_file(tmp_path, monkeypatch):
    path = zipped(tmp_path / "a.zip", "a.png", "A.png")
    real = Path.open

    def fold(self, mode="r", **options):
        return real(self.with_name(self.name.lower()) if mode == "xb" else self, mode, **options)

    monkeypatch.setattr(Path, "open", fold)
    with pytest.raises(CaptureError, match="one file here") as caught:
        open_photographs(path, work=tmp_path / "work")
    assert caught.value.code == "zip-path" and str(path) in str(caught.value)


def test_text_has_the_same_line_ends_everywhere(tmp_path, monkeypatch):
    """Windows writes two characters for a line's end unless it is told not to."""
    ends = []
    real = Path.write_text
    monkeypatch.setattr(Path, "write_text", lambda *args, **how: ends.append(how.get("newline")) or real(*args, **how))
    write_listing(tmp_path, "page", {})
    assert ends == ["\n"] and (tmp_path / LISTING_FILE).read_bytes().endswith(b"]\n}\n")
