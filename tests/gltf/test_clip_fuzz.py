"""Files of clips changed at random: refused with a code, or read; never a surprise, and never much memory."""

from __future__ import annotations

import json
import tracemalloc
from copy import deepcopy

import pytest
from hypothesis import strategies as st

from eigenfield.core.errors import FormatError
from eigenfield.gltf import encode_scene, load, stores_clip
from eigenfield.gltf.deflate import deflate, inflate
from eigenfield.gltf.group import HEAD, read_group
from support import glb_surgery
from support.clips import finer_mesh, groups_of, moving_clip, numbered_clip, read_all, with_groups
from support.fuzzed import fuzzed
from support.glb_surgery import outcome

ODD = st.one_of(
    st.none(), st.booleans(), st.integers(-(2**70), 2**70), st.integers(-2, 40), st.floats(allow_nan=True),
    st.text(max_size=5), st.just([]), st.just({}), st.just([[]]), st.lists(st.integers(-1, 9), max_size=4),
)  # fmt: skip
FILES: dict[bool, bytes] = {}


def clip_file(sheets=False) -> bytes:
    if sheets not in FILES:
        still = numbered_clip((2, 1), sheets=sheets)
        own = {} if sheets else {1: finer_mesh(still)}
        FILES[sheets] = encode_scene(moving_clip(still, lambda number, places: places + number, own))
    return FILES[sheets]


def some_file(data) -> bytes:
    """Of a clip with sheets, or of one without."""
    return clip_file(data.draw(st.booleans()))


def mutated(draw, value):
    """A JSON value with up to three of its places removed or replaced."""
    value = deepcopy(value)
    for _ in range(draw(st.integers(1, 3))):
        places = [path for path in pointers(value) if path]
        if not places:
            break
        *way, last = draw(st.sampled_from(places))
        place = value
        for key in way:
            place = place[key]
        if draw(st.booleans()) and isinstance(place, dict):
            del place[last]
        else:
            place[last] = deepcopy(draw(ODD))
    return value


def pointers(value, path=()):
    """Every place in a JSON value."""
    yield path
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield from pointers(child, (*path, key))


def check_flips(folder, data):
    changed = bytearray(some_file(data))
    for place, value in data.draw(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=6)):
        changed[min(int(place * len(changed)), len(changed) - 1)] = value
    outcome(folder / "flipped.glb", bytes(changed), read_it)


def check_json(folder, data):
    whole = some_file(data)
    gltf, binary = glb_surgery.split(whole)
    extension = gltf["extensions"][glb_surgery.EXTENSION]
    key = data.draw(st.sampled_from(["timeline", "planes", "sheets", None]))
    if key not in extension:
        gltf = mutated(data.draw, gltf)
    else:
        extension[key] = mutated(data.draw, extension[key])
    changed = glb_surgery.join(gltf, binary, glb_surgery.behind(whole))
    outcome(folder / "json.glb", changed, read_it)


def read_it(path):
    """Each frame of a clip; a clip without its timeline is a scene."""
    (read_all if stores_clip(path) else load)(path)


def check_heads(folder, data):
    whole = some_file(data)
    groups = groups_of(whole)
    index = data.draw(st.sampled_from(range(len(groups))))
    first = HEAD.size + HEAD.unpack_from(groups[index])[0]
    head = json.loads(inflate(groups[index][HEAD.size : first], 2**20, "here"))
    text = deflate(json.dumps(mutated(data.draw, head)).encode())
    groups[index] = HEAD.pack(len(text)) + text + groups[index][first:]
    outcome(folder / "head.glb", with_groups(whole, groups), read_all)


def check_streams(folder, data):
    """Damage that its writer has signed: digests are right."""
    whole = some_file(data)
    groups = groups_of(whole)
    index = data.draw(st.sampled_from(range(len(groups))))
    group = bytearray(groups[index])
    for place, value in data.draw(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=4)):
        group[min(int(place * len(group)), len(group) - 1)] = value
    groups[index] = bytes(group)
    outcome(folder / "streams.glb", with_groups(whole, groups), read_all)


def check_order(folder, data):
    """Groups cut, empty, doubled or in another order, and the file cut."""
    whole = some_file(data)
    groups = groups_of(whole)
    groups = [data.draw(st.sampled_from(groups)) for _ in groups]
    if data.draw(st.booleans()):
        groups[-1] = groups[-1][: data.draw(st.integers(1, len(groups[-1])))]
    changed = with_groups(whole, groups)
    outcome(folder / "order.glb", changed[: data.draw(st.integers(1, len(changed)))], read_all)


test_flipped_bytes, test_many_flipped_bytes = fuzzed(check_flips)
test_changed_json, test_much_changed_json = fuzzed(check_json)
test_changed_heads, test_many_changed_heads = fuzzed(check_heads)
test_damaged_streams, test_many_damaged_streams = fuzzed(check_streams)
test_groups_in_disorder, test_many_groups_in_disorder = fuzzed(check_order)


def test_announced_sizes_take_no_memory(tmp_path):
    """Whatever is announced: frames of another size than the film's header are not decoded, and long heads not made."""
    group = groups_of(clip_file())[0]
    layout = numbered_clip((1,)).groups.layout
    bomb = deflate(b"[" + b"0," * 50_000_000 + b"0]")
    text = with_groups(clip_file(), [HEAD.pack(len(bomb)) + bomb, group])
    path = tmp_path / "bomb.glb"
    path.write_bytes(text)

    def larger(gltf, extension, binary):
        extension["timeline"]["films"][0]["size"] = [4096, 4096]

    large = tmp_path / "large.glb"
    large.write_bytes(glb_surgery.changed(clip_file(), larger))
    tracemalloc.start()
    for file, code in ((path, "group-damaged"), (large, "film-size")):
        with pytest.raises(FormatError) as caught:
            read_all(file)
        assert caught.value.code == code
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20 * 2**20
    with pytest.raises(FormatError):
        read_group(HEAD.pack(2**32 - 1) + bytes(100), layout, "here")
