"""Object stores: photographs and meshes are read there, stages kept there, scenes written there."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import eigenfield as ef
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.encoding import EncodeOptions, encode_footage
from eigenfield.runtime.files import write_bytes
from eigenfield.runtime.objects import DONE, find_objects, local_copy, remove_copies
from eigenfield.runtime.stages import Stages
from support.captures import write_array, write_capture
from support.moving_plate import filmed

fsspec = pytest.importorskip("fsspec", reason="pip install 'eigenfield[s3]'")
MemoryFile = pytest.importorskip("fsspec.implementations.memory").MemoryFile


@pytest.fixture
def store():
    """A store in memory, emptied afterwards."""
    fs = fsspec.filesystem("memory")
    fs.mkdir("/lab")
    yield fs
    fs.store.clear()
    fs.pseudo_dirs[:] = [""]
    remove_copies()


@pytest.fixture
def s3(monkeypatch):
    """The address of an empty bucket of an S3 in this process."""
    boto3 = pytest.importorskip("boto3", reason="the tests of S3 need moto, s3fs, flask and flask-cors")
    server_module = pytest.importorskip("moto.server", reason="the tests of S3 need moto, s3fs, flask and flask-cors")
    pytest.importorskip("s3fs", reason="pip install 'eigenfield[s3]'")
    server = server_module.ThreadedMotoServer(port=0)
    server.start()
    host, port = server.get_host_and_port()
    for name, value in {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}", "AWS_ACCESS_KEY_ID": "me", "AWS_SECRET_ACCESS_KEY": "secret",
        "AWS_DEFAULT_REGION": "us-east-1", "AWS_EC2_METADATA_DISABLED": "true",
        "AWS_MAX_ATTEMPTS": "1",
    }.items():  # fmt: skip
        monkeypatch.setenv(name, value)
    fsspec.filesystem("s3").clear_instance_cache()
    boto3.client("s3").create_bucket(Bucket="lab")
    yield "s3://lab"
    server.stop()
    remove_copies()
    fsspec.filesystem("s3").clear_instance_cache()


def put(folder: Path, address: str) -> None:
    fs, root = fsspec.url_to_fs(address)
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    fs.put([str(path) for path in files], [f"{root}/{path.relative_to(folder).as_posix()}" for path in files])


def test_a_path_is_no_address():
    for path in ("photos", "/data/photos", "C:\\photos", Path("s3"), "https://example.com/a", "file:///a", "s3"):
        assert find_objects(path) is None
    assert find_objects(Path("memory://lab/photos")).address == "memory://lab/photos"


def test_a_copy_is_made_again_when_its_object_changes(store):
    store.pipe_file("/lab/p.off", b"one")
    before = local_copy("memory://lab/p.off")
    assert local_copy("memory://lab/p.off") == before
    store.pipe_file("/lab/p.off", b"two, longer")
    assert local_copy("memory://lab/p.off").read_bytes() == b"two, longer" and before.read_bytes() == b"one"
    store.rm_file("/lab/p.off")
    with pytest.raises(OptionError, match="no such bucket or object"):
        local_copy("memory://lab/p.off")


@pytest.mark.parametrize("name", ["../evil.txt", "..", "a/../../evil.txt", "a\\b", "a\0b", "../evil/a.txt"])
def test_an_object_is_copied_to_its_own_folder_alone(store, name):
    """Whatever the names in a bucket are, and where one of them is taken for a capture."""
    store.store[f"/lab/captures/{name}"] = MemoryFile(store, f"/lab/captures/{name}", b"evil")
    for address in ("memory://lab/captures", "memory://lab/captures/.."):
        with pytest.raises(OutputError, match=r"which is no name of a file") as caught:
            local_copy(address)
        assert caught.value.code == "object-name"


def test_a_stage_is_its_objects_and_a_last_one_with_their_digests(store):
    put_order, pipe = [], type(store).pipe_file

    def watched(self, path, value, **options):
        put_order.append(path)
        pipe(self, path, value, **options)

    def build(folder):
        (folder / "inner").mkdir()
        (folder / "inner" / "depth.npz").write_bytes(b"depth")
        (folder / "mesh.ply").write_bytes(b"mesh")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(store), "pipe_file", watched)
        Stages(Path("memory://lab/work")).run("depth", "k", build)
    assert put_order[-1] == f"/lab/work/depth-k/{DONE}"
    assert sorted(json.loads(store.cat_file(put_order[-1]))) == ["inner/depth.npz", "mesh.ply"]

    remove_copies()  # another machine
    place = Stages(Path("memory://lab/work")).run("depth", "k", lambda folder: pytest.fail("built again"))
    assert (place / "inner" / "depth.npz").read_bytes() == b"depth"


@pytest.mark.parametrize("harm", ["without DONE", "an object is missing", "other bytes"])
def test_what_is_not_whole_is_built_again(store, harm):
    calls = []

    def build(folder):
        calls.append(folder)
        (folder / "mesh.ply").write_bytes(b"mesh")

    Stages(Path("memory://lab/work")).run("relief", "k", build)
    remove_copies()
    if harm == "without DONE":
        store.rm(f"/lab/work/relief-k/{DONE}")
    elif harm == "an object is missing":
        store.rm("/lab/work/relief-k/mesh.ply")
    else:
        store.pipe_file("/lab/work/relief-k/mesh.ply", b"half")
    place = Stages(Path("memory://lab/work")).run("relief", "k", build)
    assert len(calls) == 2 and (place / "mesh.ply").read_bytes() == b"mesh"
    assert store.cat_file("/lab/work/relief-k/mesh.ply") == b"mesh" and store.exists(f"/lab/work/relief-k/{DONE}")


def test_a_failed_stage_is_not_put(store):
    def build(folder):
        (folder / "half").write_bytes(b"x")
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        Stages(Path("memory://lab/work")).run("depth", "k", build)
    assert store.find("/lab") == []


def test_a_file_appears_when_it_is_whole(store):
    write_bytes(Path("memory://lab/a.bin"), b"one")
    with pytest.raises(OutputError, match=r"memory://lab/a\.bin: exists already"):
        write_bytes(Path("memory://lab/a.bin"), b"two")
    write_bytes(Path("memory://lab/a.bin"), b"two", overwrite=True)
    assert store.cat_file("/lab/a.bin") == b"two"


def test_names_that_leave_the_folder_are_refused(store):
    store.store["/lab/photos/../../evil.png"] = fsspec.implementations.memory.MemoryFile(
        store, "/lab/photos/../../evil.png", b"x"
    )
    with pytest.raises(OutputError, match=r"no name of a file"):
        find_objects("memory://lab/photos").copy_to(Path("nowhere"))


def encode_words(folder: object, output: object) -> list[object]:
    proxy = Path(folder) / "proxy.ply" if isinstance(folder, Path) else f"{folder}/proxy.ply"
    return ["encode", folder, "--proxy", proxy, "-n", "2", "-q", "-o", output]


def test_encode_reads_and_writes_the_same_bytes_as_on_a_disk(store, run, tmp_path):
    folder = write_capture(tmp_path / "nine")
    put(folder, "memory://lab/nine")
    assert run(*encode_words(folder, tmp_path / "here.glb")).code == 0
    ran = run(*encode_words("memory://lab/nine", "memory://lab/there.glb"))
    assert ran.code == 0 and ran.out.startswith("memory://lab/there.glb: "), ran.err
    assert store.cat_file("/lab/there.glb") == (tmp_path / "here.glb").read_bytes()
    assert ef.load("memory://lab/there.glb").rig.names == ef.load(tmp_path / "here.glb").rig.names
    assert run("evaluate", "memory://lab/there.glb", "memory://lab/nine", "-q", "--store").code == 0
    assert "uv" in ef.load("memory://lab/there.glb").scores
    code, _, err = run(*encode_words("memory://lab/nine", "memory://lab/there.glb"))
    assert code == 2 and "memory://lab/there.glb: exists already" in err


def test_errors_of_a_copy_name_its_address(store, run, tmp_path):
    folder = write_capture(tmp_path / "nine")
    (folder / "images" / "view_03.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    put(folder, "memory://lab/nine")
    code, _, err = run(*encode_words("memory://lab/nine", "memory://lab/there.glb"))
    assert code == 2 and err.startswith("eigenfield: memory://lab/nine/images/view_03.png: "), err


@pytest.mark.parametrize("words", [
    ["encode", "memory://lab/none", "-o", "memory://lab/a.glb"],
    ["info", "memory://lab/none.glb"],
    ["encode", "memory://lab/none", "--proxy", "memory://lab/none.ply", "-o", "memory://lab/a.glb"],
    ["calibrate", "memory://lab/none", "-o", "memory://lab/cameras"],
    ["encode", "nosuch://lab/none", "-o", "a.glb"],
])  # fmt: skip
def test_bad_addresses_are_one_line(store, run, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*words)
    assert code == 2 and out == "" and err.count("\n") == 1 and "://" in err, err
    assert list(tmp_path.iterdir()) == [] and store.find("/lab") == []


def test_without_the_extra_one_line_says_what_to_install(run, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "fsspec", None)
    code, _, err = run("info", "s3://lab/scene.glb")
    assert code == 2 and err == (
        "eigenfield: s3://lab/scene.glb: s3:// needs a package that is not installed; pip install 'eigenfield[s3]'\n"
    )


@pytest.mark.slow
def test_s3_holds_photographs_stages_and_scene(s3, run, tmp_path):
    folder = write_capture(tmp_path / "nine")
    put(folder, f"{s3}/nine")
    work, output = f"{s3}/work", f"{s3}/there.glb"
    assert run(*encode_words(folder, tmp_path / "here.glb")).code == 0
    ran = run(*encode_words(f"{s3}/nine", output), "--work", work)
    assert ran.code == 0, ran.err
    assert find_objects(output).read() == (tmp_path / "here.glb").read_bytes()
    Stages(Path(work)).run("depth", "k", lambda folder: (folder / "a").write_bytes(b"a") and None)
    remove_copies()
    place = Stages(Path(work)).run("depth", "k", lambda folder: pytest.fail("built again"))
    assert (place / "a").read_bytes() == b"a"


def test_s3_answers_are_one_line(s3, run, tmp_path, monkeypatch):
    code, _, err = run("info", "s3://nobucket/scene.glb")
    assert code == 2 and "s3://nobucket/scene.glb: there is no such bucket or object; check the address" in err
    for words in (["-o", "s3://nobucket/a.glb"], ["-o", f"{s3}/a.glb", "--work", "s3://nobucket/work"]):
        code, _, err = run("encode", write_capture(tmp_path / words[-1][-1]), "-q", *words)
        assert code == 2 and err.count("\n") == 1 and "there is no such bucket" in err, err
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.delenv(name)
    monkeypatch.setenv("AWS_SHARED_CREDENTIALS_FILE", "/nonexistent")
    fsspec.filesystem("s3").clear_instance_cache()
    code, _, err = run("info", f"{s3}/scene.glb")
    assert code == 2 and "no credentials" in err and err.count("\n") == 1, err
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:9")
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "me")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "secret")
    fsspec.filesystem("s3").clear_instance_cache()
    code, _, err = run("info", f"{s3}/scene.glb")
    assert code == 2 and "the store cannot be used" in err and err.count("\n") == 1, err


def put_captures(tmp_path: Path, address: str) -> tuple[dict[str, object], Path]:
    """Two small captures and their mesh in a store; options of a batch, and a folder that holds the same."""
    for name in ("one", "two"):
        write_capture(tmp_path / "captures" / name)
    put(tmp_path / "captures", f"{address}/captures")
    proxy = tmp_path / "captures" / "one" / "proxy.ply"
    return {"proxy": str(proxy), "fit": "none", "textures": 2, "atlas": 64}, tmp_path / "captures"


def test_a_clip_goes_on_from_a_store_after_the_last_finished_frame(store):
    meshes, footage = filmed(2)
    options = EncodeOptions(fit="none", textures=2, atlas=64)
    whole = encode_footage(footage, meshes[0], options)

    class StoppedError(Exception):
        pass

    def stop(stage, done, total):
        if stage.endswith("textures") and done == 1:
            raise StoppedError

    with pytest.raises(StoppedError):
        encode_footage(footage, meshes[0], options, work="memory://lab/work", progress=stop)
    assert stages_in(store) == ["inner-products-00000", "inner-products-00001", "textures-00000"]
    remove_copies()  # another machine
    footage.asked.clear()
    made = encode_footage(footage, meshes[0], options, work="memory://lab/work")
    assert footage.asked == [0, 1, 1, 1, 1]  # three that tell it from other footage, the mesh's, and what was not made
    assert made.groups.coded(0).units == whole.groups.coded(0).units
    assert stages_in(store) == ["group-0000"]


def stages_in(store) -> list[str]:
    return sorted({path.split("/")[-2].rpartition("-")[0] for path in store.find("/lab/work/clip")})


def test_a_stage_that_may_not_be_removed_stays(store, monkeypatch):
    stages = Stages(Path("memory://lab/work"))
    folder = stages.run("mean", "k", lambda folder: None)
    with monkeypatch.context() as patch:
        patch.setattr(type(store), "rm", lambda *_, **__: (_ for _ in ()).throw(PermissionError("no")))
        stages.remove(folder)
    assert not folder.exists() and store.exists(f"/lab/work/mean-k/{DONE}")
    stages.remove(stages.find("mean", "k"))
    assert stages.find("mean", "k") is None


@pytest.mark.slow
def test_workers_leave_the_groups_of_a_clip_in_s3(s3, run, tmp_path):
    for number in range(3):
        write_capture(tmp_path / "footage" / f"{number:04d}")
    mesh = tmp_path / "footage" / "0000" / "proxy.ply"
    words = "--clip", "--proxy", mesh, "--fit", "none", "--textures", 2, "--atlas", 64, "--group", 1, "-q"
    ran = run("encode", tmp_path / "footage", *words, "--workers", 2, "-o", f"{s3}/clip.glb")
    assert ran.code == 0, ran.err
    assert len(find_objects(f"{s3}/clip.work/clip").names()) == 3
    assert run("encode", tmp_path / "footage", *words, "-o", tmp_path / "clip.glb").code == 0
    assert find_objects(f"{s3}/clip.glb").read() == (tmp_path / "clip.glb").read_bytes()


@pytest.mark.slow
def test_a_batch_reads_captures_from_a_store_and_writes_scenes_there(store, tmp_path):
    options, captures = put_captures(tmp_path, "memory://lab")
    here = ef.batch(captures, tmp_path / "here", progress=None, **options)
    first = ef.batch("memory://lab/captures", progress=None, **options)
    assert [one["name"] for one in first.records] == ["one", "two"] and not first.failed, first.failed
    for ours, theirs in zip(here.records, first.records, strict=True):
        place = f"memory://lab/captures-scenes/{theirs['folder']}"
        scene = here.folder / ours["folder"] / ours["scene"]
        assert find_objects(f"{place}/{theirs['scene']}").read() == scene.read_bytes()
        assert find_objects(f"{place}/{theirs['page']}").exists()
    assert b"scenes/one-" in find_objects("memory://lab/captures-scenes/index.html").read()
    store.rm(f"/lab/captures-scenes/{first.records[0]['folder']}/{DONE}")  # as after a killed worker
    assert ef.batch("memory://lab/captures", progress=None, **options).taken_up == 1
    assert ef.batch("memory://lab/captures", progress=None, **options).taken_up == 2
    store.pipe_file("/lab/captures/two/transforms.json", store.cat_file("/lab/captures/two/transforms.json"))
    store.pipe_file("/lab/captures/three/readme.txt", b"no photographs")
    third = ef.batch("memory://lab/captures", progress=None, **options)
    assert third.taken_up == 1 and [one["name"] for one in third.failed] == ["three"]
    assert find_objects("memory://lab/captures-scenes/logs/three.log").exists()
    assert third.failed[0]["error"].startswith("memory://lab/captures/three: ")


def test_a_list_names_addresses(store, tmp_path):
    _, captures = put_captures(tmp_path, "memory://lab")
    (tmp_path / "list.toml").write_text(
        '[options]\nfit = "none"\ntextures = 2\natlas = 64\n[[capture]]\npath = "memory://lab/captures/one"\n'
        'proxy = "memory://lab/captures/one/proxy.ply"\n[[capture]]\npath = "captures/two"\n'
        'proxy = "captures/two/proxy.ply"\n'
    )
    result = ef.batch(tmp_path / "list.toml", progress=None)
    assert [one["capture"] for one in result.records] == ["memory://lab/captures/one", str(captures / "two")]
    assert not result.failed and ef.batch(tmp_path / "list.toml", progress=None).taken_up == 2


@pytest.mark.slow
def test_two_workers_share_a_batch_in_s3(s3, run, tmp_path):
    put_captures(tmp_path, s3)
    rows = "".join(f'[[capture]]\npath = "captures/{name}"\n' for name in ("one", "two"))
    options = '[options]\nproxy = "captures/one/proxy.ply"\nfit = "none"\ntextures = 2\natlas = 64\n'
    find_objects(s3).fs.pipe_file(f"{s3}/list.toml", (options + rows).encode())
    words = ["batch", f"{s3}/list.toml", "--workers", 2]
    first = run(*words)
    assert first.code == 0 and f"{s3}/list-scenes/index.html: 2 scenes" in first.err, first.err
    again = run(*words)
    assert again.out == first.out and "2 of them finished before" in again.err
    code, _, err = run(*words, "-o", "s3://nobucket/scenes")
    assert code == 2 and err.count("\n") == 1 and "there is no such bucket" in err, err


@pytest.mark.slow
def test_a_reconstruction_goes_on_from_a_store(s3, run, tmp_path):
    write_array(tmp_path / "photos")
    put(tmp_path / "photos", f"{s3}/photos")
    words = ["--preset", "small", "--layers", 1, "-q", "--work", f"{s3}/work"]
    first = run("encode", f"{s3}/photos", "-o", f"{s3}/a.glb", *words)
    assert first.code == 0, first.err
    remove_copies()
    again = run("encode", f"{s3}/photos", "-o", f"{s3}/b.glb", *words)
    assert again.code == 0 and find_objects(f"{s3}/a.glb").read() == find_objects(f"{s3}/b.glb").read()


def test_errors_of_this_machine_are_not_about_the_store(store):
    store.pipe_file("/lab/a.png", b"x")
    with pytest.raises(NotADirectoryError):
        find_objects("memory://lab").copy_to(Path("/dev/null/a"))
    with pytest.raises(OptionError, match="no such bucket or object"):
        local_copy("memory://lab/b.png")
