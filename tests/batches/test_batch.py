"""Many captures: the same bytes wherever they are encoded, what is finished stays, what fails is a line."""

from __future__ import annotations

import codecs
import csv
import io
import json
import multiprocessing
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path, PurePosixPath, PureWindowsPath

import pytest
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.batches.jobs import ALL_KEYS, captures_in, read_jobs
from eigenfield.batches.sheet import sheet_html
from eigenfield.batches.table import as_csv, as_markdown
from eigenfield.core.errors import one_line
from eigenfield.core.open_options import OpenOptions
from eigenfield.demo import draw_demo_capture, draw_demo_clip
from eigenfield.runtime import executor
from support import tasks
from support.fuzzed import fuzzed

FAST = 'fit = "none"\ntextures = 3\natlas = 64\nhold_out = "every:4"\n'


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo") / "jar"
    draw_demo_capture(folder, rows=3, columns=3, size=48)
    return folder


@pytest.fixture
def listed(capture, tmp_path):
    """A list of two captures that can be encoded in a moment, and one that cannot at all."""
    shutil.copytree(capture, tmp_path / "second")
    (tmp_path / "empty").mkdir()
    (tmp_path / "captures.toml").write_text(
        f'[options]\n{FAST}\n[[capture]]\npath = "{capture}"\nproxy = "{capture}/proxy.ply"\n'
        f'[[capture]]\npath = "second"\nproxy = "second/proxy.ply"\nname = "the <other>"\ntextures = 2\n'
        '[[capture]]\npath = "empty"\n'
    )
    return tmp_path / "captures.toml"


@pytest.mark.slow
def test_clips_lie_beside_scenes_and_are_taken_up_again(capture, tmp_path):
    draw_demo_clip(tmp_path / "footage", rows=2, columns=3, size=48, frames=2)
    (tmp_path / "captures.toml").write_text(
        f'[[capture]]\npath = "{capture}"\nproxy = "{capture}/proxy.ply"\n{FAST}'
        '[[capture]]\npath = "footage"\nclip = ":"\nproxy = "footage/mesh_%04d.ply"\nquality = 60\ngroup = "2"\n'
    )
    result = ef.batch(tmp_path / "captures.toml", tmp_path / "out", progress=None)
    assert [record["name"] for record in result.records if "error" not in record] == ["jar", "footage"]
    still, clip = result.records
    assert (clip["photographs"], still["photographs"]) == (12, 9) and clip["psnr"] > 20
    file = result.folder / clip["folder"] / clip["scene"]
    assert ef.load_clip(file).timeline.frames == 2
    assert (file.parent / clip["page"]).stat().st_size > file.stat().st_size and (file.parent / clip["poster"]).exists()
    again = ef.batch(tmp_path / "captures.toml", tmp_path / "out", progress=None)
    assert [record["seconds"] for record in again.records] == [record["seconds"] for record in result.records]
    with pytest.raises(ef.OptionError, match="--group is about clips"):
        read_jobs([capture], {"group": "2"})


def scenes_of(result):
    return {
        record["name"]: (result.folder / record["folder"] / record["scene"]).read_bytes()
        for record in result.records
        if "error" not in record
    }


def test_a_batch_from_its_list_to_its_page(listed):
    result = ef.batch(listed, progress=None)
    assert result.folder == listed.with_name("captures-scenes") and result.taken_up == 0
    first, other, failed = result.records
    assert first["name"] == "jar" and other["name"] == "the _other_" and failed["name"] == "empty"
    assert first["held_out_psnr"] > 10 and first["psnr"] > 10 and first["bytes"] > 1000
    assert (first["textures"], other["textures"]) == (3, 2)
    assert failed["code"] == "photographs-missing" and failed["error"].endswith("name a folder of photographs")
    assert failed["error"] in (result.folder / failed["log"]).read_text()
    assert result.failed == (failed,)
    with (result.folder / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["bytes"] for row in rows] == [str(first["bytes"]), str(other["bytes"]), ""]
    assert json.loads((result.folder / "table.json").read_text())["captures"] == list(result.records)
    assert (result.folder / "table.md").read_text().count("\n") == 5
    page = result.page.read_text("utf-8")
    for record in (first, other):
        assert f'href="{record["folder"].replace(" ", "%20")}/' in page
        assert ef.load(result.folder / record["folder"] / record["scene"]).scores["image"]["held_out"]
        assert b"<iframe" not in (result.folder / record["folder"] / record["page"]).read_bytes()[:9]
    assert failed["error"] in page


@pytest.mark.slow
def test_what_is_finished_is_taken_up_and_what_changed_is_made_again(listed, capture):
    first = ef.batch(listed, progress=None)
    places = {path: path.stat().st_mtime_ns for path in first.folder.glob("scenes/*/*.glb")}
    seen = []
    again = ef.batch(listed, progress=lambda stage, done, total: seen.append((stage, done, total)))
    assert again.taken_up == 2 and again.records == first.records
    assert {path: path.stat().st_mtime_ns for path in first.folder.glob("scenes/*/*.glb")} == places
    assert seen[0] == ("captures looked at", 0, 3) and seen[-1] == ("captures", 3, 3)
    time.sleep(0.01)
    photograph = next((listed.parent / "second" / "images").iterdir())
    photograph.write_bytes(photograph.read_bytes())
    assert ef.batch(listed, progress=None).taken_up == 1


@pytest.mark.slow
@pytest.mark.parametrize("way", ["processes", "cluster"])
def test_the_bytes_are_the_same_wherever_they_are_made(listed, tmp_path, way):
    here = ef.batch(listed, tmp_path / "here", progress=None)
    if way == "processes":
        there = ef.batch(listed, tmp_path / "there", workers=2, progress=None)
    else:
        from distributed import LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as cluster:
            there = ef.batch(listed, tmp_path / "there", cluster=cluster.scheduler_address, progress=None)
    assert len(scenes_of(here)) == 2 and scenes_of(there) == scenes_of(here)
    assert there.failed[0]["error"] == here.failed[0]["error"] and there.failed[0]["worker"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[capture]]\npath = "a"\n[[capture]]\npath = "b/A"\n', "two captures are called A"),
        ('[[capture]]\npath = "a"\npreste = "small"\n', "a: no option is called preste; did you mean preset?"),
        ('[[capture]]\npath = "a"\nframes = 60\n', "a: frames is now called walk_frames; say walk_frames"),
        ('[options]\npreset = "huge"\n[[capture]]\npath = "a"\n', "no preset is called huge"),
        ('[[capture]]\nname = "a"\n', "a [[capture]] has no path"),
        ("captures = 3\n", "has captures where only [options] and [[capture]] are known"),
        ("[[capture\n", "is no TOML"),
        ('[[capture]]\npath = "a"\ntarget_size = "300kg"\n', "a: '300kg' is no size"),
        ("", "holds no captures"),
        ('[[capture]]\npath = "a"\nproxy = "m.ply"\nlayers = 3\n', "layers is for making a proxy"),
        ('[[capture]]\npath = "a"\nname = 1979-05-27\n', "name is a date; give a text"),
        ('[[capture]]\npath = "a"\nalso = 3\n', "a: also is an int; give a sequence"),
        ('[[capture]]\npath = "a"\nblind = "no"\n', "a: blind is a str; give True or False"),
        (
            '[[capture]]\npath = "a"\ndensity = 1' + "0" * 400,
            "capture 1: density is a table, a list of lists or a number",
        ),
        ('[[capture]]\npath = "a"\ndensity = 1' + "0" * 5000, "is no TOML: Exceeds the limit"),
        ('[[capture]]\npath = "a"\natlas' + ".a" * 1500 + " = 1", "capture 1: atlas is a table"),
        ("a = " + "[" * 9000, "is no TOML: "),
        ('[[capture]]\npath = "a"\nhold-out = "odd"\nhold_out = "odd"\n', "capture 1: an option is there twice"),
        ('[[capture]]\npath = "a"\npath = "b"\n', "is no TOML: Cannot overwrite a value"),
        ('[[capture]]\npath = "a"\n"x\\ny" = 1\n', "a: no option is called x\\ny"),
        ('[[capture]]\npath = "a"\nname = "x\\ny"\n[[capture]]\npath = "b"\nname = "x/y"\n', "are called x_y"),
    ],
)
def test_what_a_list_cannot_say(tmp_path, text, words):
    (tmp_path / "list.toml").write_text(text)
    with pytest.raises(ef.OptionError) as caught:
        ef.batch(tmp_path / "list.toml", progress=None)
    assert words in str(caught.value) and "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == [tmp_path / "list.toml"]  # nothing is made


def test_a_list_in_another_encoding(tmp_path):
    text = '[[capture]]\npath = "ä"\n'
    (tmp_path / "list.toml").write_text(text, "utf-8-sig")
    assert [job.name for job in read_jobs(tmp_path / "list.toml", {})] == ["ä"]
    for encoding in ("utf-16", "latin-1"):
        (tmp_path / "list.toml").write_text(text, encoding)
        with pytest.raises(ef.OptionError, match=r"is no TOML: 'utf-8' codec can't decode byte") as caught:
            read_jobs(tmp_path / "list.toml", {})
        assert caught.value.code == "batch-file"


def is_one_part(name):
    return (
        name == PurePosixPath(name).name == PureWindowsPath(name).name.rstrip(". ")
        and not PureWindowsPath(name).drive
        and not PureWindowsPath(name).is_reserved()
        and name.isprintable()
    )


NAMES = (
    "day1/left", "day1\\left", "../../outside/x", "..", ".", "/etc/x", "\\\\host\\x", "C:", "C:\\x", "nul", "CON .txt",
    "a\0b", "a\rb\n", "x. ", "CONOUT$", "\u202ex", "/",
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_one_part_of_a_path(tmp_path, name):
    """Given in a list, as an option, or taken from a path."""
    (tmp_path / "list.toml").write_text(f'[[capture]]\npath = "a"\nname = {json.dumps(name)}\n')
    named = [*read_jobs(tmp_path / "list.toml", {}), *read_jobs([Path("a")], {"name": name})]
    for job in [*named, *read_jobs([Path(name)], {}), *read_jobs([Path("memory://lab", name)], {})]:
        assert is_one_part(job.name), job.name


def test_a_capture_with_a_path_for_a_name_stays_within_the_folder(tmp_path):
    (tmp_path / "list.toml").write_text(f'[[capture]]\npath = "none"\nname = "{tmp_path}/outside/x"\n')
    result = ef.batch(tmp_path / "list.toml", progress=None)
    assert {path.name for path in tmp_path.iterdir()} == {"list.toml", "list-scenes"}
    assert (result.folder / result.records[0]["log"]).exists() and len(result.records) == 1


@st.composite
def lists(draw):
    """Lists of captures, most of which something is wrong with."""
    keys = st.sampled_from([*ALL_KEYS, "name", "path", "hold-out", '"a\\nb"', "atlas.a", "'='"])
    texts = st.one_of(st.sampled_from(["odd", "auto", "memory://b/a", "300kB", *NAMES]), st.text(max_size=6)).map(
        json.dumps
    )
    plain = st.one_of(
        texts, st.integers(-(10**30), 10**30), st.floats(), st.sampled_from(["true", "1979-05-27", "{a=1}"])
    )
    values = st.one_of(plain.map(str), st.lists(plain.map(str), max_size=3).map(lambda items: f"[{', '.join(items)}]"))
    lines = st.tuples(keys, values).map(" = ".join)
    heads = st.sampled_from(["[[capture]]", '[[capture]]\npath = "a"', "[options]", "[capture]", "[[options]]", "[[x"])
    return "\n".join(draw(st.lists(st.one_of(lines, heads, heads), max_size=6)))


def check_list(folder, data):
    path = folder / "list.toml"
    text = data.draw(lists()).encode("utf-8", "surrogatepass")
    path.write_bytes(data.draw(st.sampled_from([text, text, codecs.BOM_UTF8 + text, text[:-1], b"\xff" + text])))
    try:
        assert all(is_one_part(job.name) for job in read_jobs(path, {}))
    except ef.EigenfieldError as error:
        assert str(error).startswith(str(path)) and len(str(error).splitlines()) == 1


test_any_list_is_read_or_refused, test_many_lists_are_read_or_refused = fuzzed(check_list)


def test_a_list_says_sizes_as_the_command_line_does(tmp_path):
    (tmp_path / "list.toml").write_text('[options]\ntarget_size = "0.3 MB"\n[[capture]]\npath = "a"\n')
    (job,) = read_jobs(tmp_path / "list.toml", {})
    assert job.options.target == ef.Target(size=300_000)


def test_a_list_says_whose_the_scenes_are(tmp_path):
    (tmp_path / "list.toml").write_text('[options]\nauthor = "Ada"\n[[capture]]\npath = "a"\ntitle = "A jar"\n')
    (job,) = read_jobs(tmp_path / "list.toml", {"licence": "CC0"})
    assert job.options.rights == ef.Rights(title="A jar", author="Ada", licence="CC0")


def test_a_folder_of_captures(tmp_path):
    for name in ("b10", "b9", ".hidden", "b-scenes", "²"):
        (tmp_path / name).mkdir()
    (tmp_path / "walk.mp4").touch()
    (tmp_path / "notes.txt").touch()
    assert [path.name for path in captures_in(tmp_path)] == ["b9", "b10", "walk.mp4", "²"]
    assert [job.name for job in read_jobs(tmp_path, {}, tmp_path / "b10")] == ["b9", "walk", "²"]  # where scenes go
    jobs = read_jobs(tmp_path, {"preset": "small", "grid": (3, 3)})
    assert [job.name for job in jobs] == ["b9", "b10", "walk", "²"]
    assert jobs[0].options.preset == "small" and jobs[0].place == OpenOptions(grid=(3, 3))
    assert {"hold_out", "surface", "calibration", "target_size"} <= set(ALL_KEYS)


@pytest.mark.slow
def test_a_hundred_thousand_captures_are_planned_in_seconds(tmp_path):
    rows = "".join(f'[[capture]]\npath = "c{number}"\n' for number in range(100_000))
    (tmp_path / "list.toml").write_text(rows)
    began = time.monotonic()
    assert len(read_jobs(tmp_path / "list.toml", {"preset": "small"})) == 100_000
    assert time.monotonic() - began < 10


@pytest.mark.slow
def test_a_capture_too_large_for_every_worker_is_a_line(listed, tmp_path, monkeypatch):
    monkeypatch.setattr(executor, "machine_memory", lambda: 0.5e9)
    result = ef.batch(listed, tmp_path / "out", workers=1, progress=None)
    assert [record.get("code") for record in result.records] == ["task-memory", "task-memory", "photographs-missing"]
    assert "no worker has more than 0.5 GB" in result.records[0]["error"]


def test_the_command_says_what_failed_and_goes_on(run, listed, monkeypatch):
    from eigenfield.runtime import cluster

    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.5)
    done = run("batch", listed)
    assert done.code == 2 and done.out.count("\n") == 5 and "| jar |" in done.out
    assert "eigenfield: empty: " in done.err and "2 scenes, " in done.err
    again = run("batch", listed, "--quiet")
    assert again.code == 2 and again.out == done.out and len(again.err.splitlines()) == 1
    assert "2 of them finished before" in run("batch", listed).err
    bad = run("batch", listed, "--cluster", "tcp://127.0.0.1:9")
    assert bad.code == 2 and "cannot be reached" in bad.err and len(bad.err.splitlines()) == 1


def test_a_mistyped_path_is_one_line_each(capture, tmp_path):
    (tmp_path / "list.toml").write_text(
        f'[[capture]]\npath = "day2/one"\n[[capture]]\npath = "{capture}"\nproxy = "nosuch.ply"\n'
    )
    result = ef.batch(tmp_path / "list.toml", progress=None)
    assert [record["code"] for record in result.records] == ["capture-missing", "proxy-missing"]


@pytest.mark.slow
def test_a_target_of_bytes_holds_in_a_batch(capture, tmp_path):
    head = f'[options]\nproxy = "{capture}/proxy.ply"\ntarget_size = 6000\ntextures = 2\n'
    (tmp_path / "list.toml").write_text(f'{head}[[capture]]\npath = "{capture}"\n')
    (record,) = ef.batch(tmp_path / "list.toml", progress=None).records
    assert 4000 < record["bytes"] <= 6000 and record["psnr"] > 10


def test_a_table_shows_text_and_runs_nothing():
    texts = [
        "=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", " =1", "＝1", "a;=1", '"=1', 'a;"=1"', "a\n=1",
        "a|b", "`a`", "<script>", "[a](javascript:b)", "![a](http://b/c)", "a\n\n# b", "\\|", "\u2028",
    ]  # fmt: skip
    records = [{"name": text, "error": text, "psnr": -1.5} for text in texts]
    written = list(csv.reader(io.StringIO(as_csv(records)), delimiter=";"))  # as some countries have it
    assert len(written) == 1 + len(texts) and not any(
        cell.lstrip().startswith(("=", "+", "-", "@", "＝")) for row in written for cell in row
    )
    rows = list(csv.DictReader(io.StringIO(as_csv(records))))
    assert [row["name"].replace("'", "") for row in rows] == [one_line(text) for text in texts]
    assert {row["psnr"] for row in rows} == {"-1.5"}
    lines = as_markdown(records).splitlines()
    assert len(lines) == 2 + len(texts) and "<" not in "".join(lines)
    for line in lines:
        left = re.sub(r"\\.", "", line)  # without what is escaped
        assert left.count("|") == 11 and not set(left) & set("`[]")


def test_what_a_page_shows_is_text():
    record = {
        "name": "<b>", "folder": "scenes/a b-1", "page": "x.html", "poster": "x.jpg", "scene": "x.glb", "bytes": 5000,
        "psnr": 30.0, "held_out_psnr": None, "between_psnr_luma": 24.56, "warnings": ['"'],
    }  # fmt: skip
    failed = {"name": "c", "error": "<script>"}
    assert "views between at least 24.6 dB of luma" in sheet_html("sizes", [record])
    dense = {**record, "between_psnr_luma": None, "between_psnr": 31.24}
    assert "views between about 31.2 dB" in sheet_html("sizes", [dense])
    page = sheet_html("<i>", [record, failed])
    assert "<b></b>" not in page and "<i>" not in page and "&lt;script&gt;" in page
    assert "scenes/a%20b-1/x.html" in page


@pytest.fixture(params=["processes", "cluster"])
def unlucky(request, tmp_path):
    """Where a batch runs, what kills a worker there, and what makes one exceed its memory."""
    if request.param == "processes":
        yield {"workers": 2}, lambda: os.kill(multiprocessing.active_children()[0].pid, signal.SIGKILL), lambda: None
        return
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=2, threads_per_worker=2, memory_limit="1.5GB", dashboard_address=":0", silence_logs=50
        ) as small,
        Client(small.scheduler_address, set_as_default=False) as client,
    ):
        started = [*client.run(os.getpid).values()]
        eaten = []
        yield (
            {"cluster": small.scheduler_address},
            lambda: os.kill(started[0], signal.SIGKILL),
            lambda: eaten.append(client.submit(tasks.hungry, tmp_path, 2_000_000_000)),  # beside a capture
        )
        assert eaten[0].result(timeout=60) == "done" and (tmp_path / "full").exists()
        assert started[0] not in client.run(os.getpid).values()


@pytest.mark.slow
def test_ten_captures_a_killed_worker_and_one_without_memory(capture, tmp_path, unlucky):
    """All scenes are there, and what was finished when a worker ended is not made again."""
    where, kill, starve = unlucky
    rows = "".join(
        f'[[capture]]\npath = "{capture}"\nname = "c{number}"\ntextures = {2 + number % 4}\n' for number in range(10)
    )
    head = f'[options]\nproxy = "{capture}/proxy.ply"\nfit = "none"\natlas = 64\nhold_out = "every:4"\n'
    (tmp_path / "list.toml").write_text(head + rows)
    before: dict[Path, int] = {}
    shown = []

    def disturb(stage, done, total):
        shown.append((stage, done))
        if stage == "captures" and done in (3, 7):
            before.update({path: path.stat().st_mtime_ns for path in tmp_path.glob("out/scenes/[!.]*/record.json")})
            (kill if done == 3 else starve)()

    result = ef.batch(tmp_path / "list.toml", tmp_path / "out", progress=disturb, **where)
    assert len(result.records) == 10 and not result.failed
    assert len(before) >= 7 and all(path.stat().st_mtime_ns == time for path, time in before.items())
    assert len(list((tmp_path / "out/scenes").iterdir())) == 10  # and nothing half written
    assert [done for stage, done in shown if stage == "captures"] == list(range(11))
    again = ef.batch(tmp_path / "list.toml", tmp_path / "out", progress=None, **where)
    assert again.taken_up == 10 and again.records == result.records


@pytest.mark.slow
def test_an_interrupted_batch_goes_on(capture, tmp_path):
    listed = tmp_path / "list.toml"
    rows = "".join(f'[[capture]]\npath = "{capture}"\nname = "c{number}"\n' for number in range(12))
    listed.write_text(f'[options]\nproxy = "{capture}/proxy.ply"\n{FAST}{rows}')
    words = [sys.executable, "-m", "eigenfield", "batch", str(listed), "--workers", "2"]
    running = subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    until = time.monotonic() + 120
    while len(list(tmp_path.glob("list-scenes/scenes/*/record.json"))) < 3 and time.monotonic() < until:
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=20)
    assert running.returncode == 130 and "Traceback" not in said and "the same command goes on" in said
    left = list(tmp_path.glob("list-scenes/scenes/*/record.json"))
    assert 3 <= len(left) < 12
    assert "to come: the same command" in (tmp_path / "list-scenes/index.html").read_text("utf-8")
    result = ef.batch(listed, workers=2, progress=None)
    assert result.taken_up == len(left) and len(result.records) == 12 and not result.failed
    assert len(list(tmp_path.glob("list-scenes/scenes/*"))) == 12
