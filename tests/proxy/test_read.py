"""Reading meshes: each format's conventions with a file written by hand, and what cannot be used."""

from __future__ import annotations

import base64
import json
import logging
import struct

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import read_mesh, write_ply

VERTICES = [(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0)]
UV_DOWN = {(0, 0, 0): (0.1, 0.9), (1, 0, 0): (0.6, 0.9), (1, 2, 0): (0.6, 0.2), (0, 2, 0): (0.1, 0.2)}  # v down

OBJ = """
mtllib missing.mtl
vn 0 0 1
v 0 0 0
v 1 0 0 0.5 0.5 0.5
v 1 2 0
v 0 2 0
v 9 9 9
vt 0.1 0.1
vt 0.6 0.1
vt 0.6 0.8 0
vt 0.1 0.8
usemtl nothing
"""


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def ply(names, rows, faces, face_properties="property list uchar int vertex_indices"):
    header = ["ply", "format ascii 1.0", f"element vertex {len(rows)}", *(f"property float {n}" for n in names)]
    header += [f"element face {len(faces)}", face_properties, "end_header"]
    return "\n".join([*header, *(" ".join(map(str, r)) for r in [*rows, *faces])]) + "\n"


def binary_ply(vertices, faces, index="i4"):
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
    )
    kind = {"i4": "int", "u4": "uint"}[index]
    header += f"property float z\nelement face {len(faces)}\nproperty list uchar {kind} vertex_indices\nend_header\n"
    body = np.asarray(vertices, "<f4").tobytes()
    return header.encode() + body + b"".join(b"\x03" + np.asarray(f, "<" + index).tobytes() for f in faces)


def code_of(path):
    with pytest.raises(ProxyError) as caught:
        read_mesh(path)
    assert caught.value.path == str(path)
    assert caught.value.remedy
    assert "\n" not in str(caught.value)
    return caught.value.code


def assert_is_the_square(mesh):
    """Every corner has the UV that belongs to its position, and the two triangles cover the square."""
    for position, uv in zip(mesh.vertices.tolist(), mesh.uv.tolist(), strict=True):
        assert uv == pytest.approx(UV_DOWN[tuple(int(x) for x in position)], abs=1e-6)
    p = mesh.vertices[mesh.faces]
    assert np.abs(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])).sum() / 2 == pytest.approx(2)


@pytest.mark.parametrize("names", [("s", "t"), ("u", "v"), ("texture_u", "texture_v")])
def test_ply_uvs_a_vertex_have_v_up(tmp_path, names):
    rows = [(*v, UV_DOWN[v][0], 1 - UV_DOWN[v][1]) for v in VERTICES]
    mesh = read_mesh(written(tmp_path, "a.ply", ply(["x", "y", "z", *names], rows, [(3, 0, 1, 2), (3, 0, 2, 3)])))
    np.testing.assert_array_equal(mesh.vertices, np.array(VERTICES, np.float32))
    np.testing.assert_array_equal(mesh.faces, [(0, 1, 2), (0, 2, 3)])
    assert_is_the_square(mesh)


def test_ply_uvs_a_corner_split_seams(tmp_path):
    """MeshLab's list `texcoord`: the second triangle is laid out elsewhere, so two vertices are doubled."""
    faces = [(3, 0, 1, 2, 6, 0.1, 0.1, 0.4, 0.1, 0.4, 0.4), (3, 0, 2, 3, 6, 0.6, 0.6, 0.9, 0.9, 0.6, 0.9)]
    properties = "property list uchar int vertex_indices\nproperty list uchar float texcoord"
    mesh = read_mesh(written(tmp_path, "a.ply", ply("xyz", VERTICES, faces, properties)))
    assert len(mesh.vertices) == 6
    np.testing.assert_allclose(mesh.vertices[mesh.faces[1]], np.array(VERTICES)[[0, 2, 3]])
    np.testing.assert_allclose(mesh.uv[mesh.faces[1]], [(0.6, 0.4), (0.9, 0.1), (0.6, 0.1)], atol=1e-6)


def test_ply_polygons_are_cut_into_triangles(tmp_path):
    assert len(read_mesh(written(tmp_path, "a.ply", ply("xyz", VERTICES, [(4, 0, 1, 2, 3)]))).faces) == 2
    mixed = ply("xyz", [*VERTICES, (2, 1, 0)], [(4, 0, 1, 2, 3), (3, 1, 4, 2)])
    assert len(read_mesh(written(tmp_path, "b.ply", mixed)).faces) == 3


@pytest.mark.parametrize("offset", [0, 1 << 20])
def test_ply_written_comes_back_to_the_bit(tmp_path, offset):
    random = np.random.default_rng(3)
    vertices = (random.normal(size=(60, 3)) * 7 + offset).astype(np.float32)
    uv = (random.integers(0, 1 << 16, (60, 2)) / 65536).astype(np.float32)
    mesh = Mesh(vertices, random.permutation(60).reshape(20, 3).astype(np.int32), uv)
    write_ply(mesh, tmp_path / "a mesh.ply")
    read = read_mesh(tmp_path / "a mesh.ply")
    np.testing.assert_array_equal(read.vertices, mesh.vertices)
    np.testing.assert_array_equal(read.faces, mesh.faces)
    np.testing.assert_array_equal(read.uv, mesh.uv)
    assert read.vertices.dtype == read.uv.dtype == np.float32 and read.faces.dtype == np.int32


@pytest.mark.parametrize(
    "faces",
    ["f 1/1 2/2 3/3\nf 1/1 3/3 4/4", "f 1/1/1 2/2/1 3/3/1 4/4/1", "f -5/-4 -4/-3 -3/-2\nf -5/1 \\\n3/3 -2/-1 # end"],
)
def test_obj_uvs_have_v_up(tmp_path, faces):
    mesh = read_mesh(written(tmp_path, "a.obj", OBJ + faces))
    assert len(mesh.vertices) == 4  # the unused one is gone
    assert len(mesh.faces) == 2
    assert_is_the_square(mesh)


def test_obj_relative_indices_count_from_where_they_stand(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 2 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 6 2 0\nf -3 -2 -1\n"
    mesh = read_mesh(written(tmp_path, "a.obj", text))
    np.testing.assert_array_equal(mesh.vertices[mesh.faces[0]][:, 0], [0, 1, 1])
    np.testing.assert_array_equal(mesh.vertices[mesh.faces[1]][:, 0], [5, 6, 6])


def test_obj_seams_double_vertices_and_equal_uvs_do_not(tmp_path):
    """Six `vt` for six corners, four of them equal in pairs, then one that differs."""
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES)
    text += "vt 0.1 0.1\nvt 0.6 0.1\nvt 0.6 0.8\nvt 0.1 0.1\nvt 0.6 0.8\nvt 0.1 0.8\nvt 0.9 0.9\n"
    whole = read_mesh(written(tmp_path, "a.obj", text + "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n"))
    split = read_mesh(written(tmp_path, "b.obj", text + "f 1/1 2/2 3/3\nf 1/7 3/5 4/6\n"))
    assert (len(whole.vertices), len(split.vertices)) == (4, 5)


@pytest.mark.parametrize("faces", ["f 1//1 2//1 3//1 4//1", "f 1 2 3 4", "f 1/1 2/2 3/3\nf 1 3 4"])
def test_obj_without_all_uvs_has_none(tmp_path, faces):
    mesh = read_mesh(written(tmp_path, "a.obj", OBJ + faces))
    assert mesh.uv is None
    assert len(mesh.faces) == 2


def test_obj_groups_and_materials_do_not_cut_the_mesh(tmp_path):
    text = "usemtl a\n".join(
        ["".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES), "g one\nf 1 2 3\n", "g two\nf 1 3 4\n"]
    )
    assert len(read_mesh(written(tmp_path, "a.obj", text)).vertices) == 4


def glb(nodes, uv=True, indices=(0, 1, 2, 0, 2, 3), extra=None):
    """The square once a node of `nodes`, without materials."""
    position = np.array(VERTICES, "<f4").tobytes()
    texel = np.array([UV_DOWN[v] for v in VERTICES], "<f4").tobytes()
    corner = np.array(indices, "<u4").tobytes()
    body = position + texel + corner
    views, at = [], 0
    for part in (position, texel, corner):
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        at += len(part)
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5125, "count": len(indices), "type": "SCALAR"},
    ]
    attributes = {"POSITION": 0, "TEXCOORD_0": 1} if uv else {"POSITION": 0}
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(body)}],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 2}]}],
        "nodes": [{"mesh": 0, **node} for node in nodes],
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "scene": 0,
        **(extra or {}),
    }
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<IIIII", 0x46546C67, 2, 12 + 8 + len(text) + 8 + len(body), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(body), 0x004E4942) + body, tree, body


def test_glb_uvs_have_v_down_without_a_material_too(tmp_path):
    mesh = read_mesh(written(tmp_path, "a.glb", glb([{}])[0]))
    assert_is_the_square(mesh)


def test_glb_pictures_are_not_needed(tmp_path):
    extra = {
        "images": [{"uri": "missing.png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    }
    assert_is_the_square(read_mesh(written(tmp_path, "a.glb", glb([{}], extra=extra)[0])))


def test_gltf_with_a_buffer_beside_it(tmp_path):
    _, tree, body = glb([{}])
    tree["buffers"][0]["uri"] = "some data.bin"
    (tmp_path / "some data.bin").write_bytes(body)
    assert_is_the_square(read_mesh(written(tmp_path, "a.gltf", json.dumps(tree))))
    tree["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(body).decode()
    assert_is_the_square(read_mesh(written(tmp_path, "b.gltf", json.dumps(tree))))


def test_glb_node_transforms_are_applied_and_all_meshes_merged(tmp_path):
    nodes = [{"translation": [10, 0, 0]}, {"scale": [2, 2, -2], "translation": [0, 0, 5]}]
    mesh = read_mesh(written(tmp_path, "a.glb", glb(nodes)[0]))
    assert (len(mesh.vertices), len(mesh.faces)) == (8, 4)
    assert mesh.vertices[:, 0].max() == 11
    np.testing.assert_allclose(sorted({float(z) for z in mesh.vertices[:, 2]}), [0, 5])
    mirrored = mesh.vertices[mesh.faces][:, 0, 2] == 5
    np.testing.assert_allclose(mesh.face_normals()[~mirrored][:, 2], 1)
    np.testing.assert_allclose(mesh.face_normals()[mirrored][:, 2], -1)  # as glTF wants it after a mirror


def test_glb_that_trimesh_writes_agrees(tmp_path):
    uv = np.array([UV_DOWN[v] for v in VERTICES]) * (1, -1) + (0, 1)  # trimesh has v up
    square = trimesh.Trimesh(
        VERTICES, [(0, 1, 2), (0, 2, 3)], visual=trimesh.visual.TextureVisuals(uv=uv), process=False
    )
    for suffix in ("glb", "ply", "obj"):
        square.export(tmp_path / f"a.{suffix}")
        assert_is_the_square(read_mesh(tmp_path / f"a.{suffix}"))


def test_compressed_glb_is_refused_in_words(tmp_path):
    path = written(tmp_path, "a.glb", glb([{}], extra={"extensionsRequired": ["EXT_meshopt_compression"]})[0])
    with pytest.raises(ProxyError, match="compressed"):
        read_mesh(path)
    assert code_of(path) == "proxy-extension"


def test_stl_corners_are_joined(tmp_path):
    trimesh.creation.box().export(tmp_path / "a.stl")
    mesh = read_mesh(tmp_path / "a.stl")
    assert (len(mesh.vertices), len(mesh.faces)) == (8, 12)
    trimesh.creation.box().export(tmp_path / "a.off")
    assert len(read_mesh(tmp_path / "a.off").faces) == 12


def test_a_missing_file_and_a_folder(tmp_path):
    assert code_of(tmp_path / "no.ply") == "proxy-missing"
    (tmp_path / "folder.ply").mkdir()
    assert code_of(tmp_path / "folder.ply") == "proxy-missing"


@pytest.mark.parametrize("name", ["a.fbx", "a", "a.png"])
def test_an_unknown_extension(tmp_path, name):
    assert code_of(written(tmp_path, name, b"x")) == "proxy-format"


@pytest.mark.parametrize("suffix", ["ply", "obj", "glb", "gltf", "stl", "off"])
def test_rubbish(tmp_path, suffix):
    assert code_of(written(tmp_path, f"a.{suffix}", bytes(range(256)) * 4)) == "proxy-unreadable"
    assert code_of(written(tmp_path, f"b.{suffix}", b"")) in ("proxy-unreadable", "proxy-empty")


def test_no_faces(tmp_path):
    assert code_of(written(tmp_path, "a.ply", ply("xyz", VERTICES, []))) == "proxy-no-faces"
    assert code_of(written(tmp_path, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")) == "proxy-no-faces"


def test_empty(tmp_path):
    assert code_of(written(tmp_path, "a.ply", ply("xyz", [], []))) == "proxy-empty"
    assert code_of(written(tmp_path, "a.obj", "# nothing\n")) == "proxy-empty"


def test_triangles_without_area(tmp_path, caplog):
    flat = [(0, 0, 0), (1, 1, 1), (2, 2, 2)]
    assert code_of(written(tmp_path, "a.ply", ply("xyz", flat, [(3, 0, 1, 2), (3, 0, 0, 1)]))) == "proxy-degenerate"
    some = written(tmp_path, "b.ply", ply("xyz", [*VERTICES, (5, 5, 5)], [(3, 0, 1, 2), (3, 4, 4, 1)]))
    with caplog.at_level(logging.WARNING, "eigenfield.proxy"):
        mesh = read_mesh(some)
    assert (len(mesh.vertices), len(mesh.faces)) == (3, 1)
    assert "1 of 2 triangles have no area" in caplog.text


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 1e39])
def test_positions_that_are_no_numbers(tmp_path, bad):
    vertices = [*VERTICES[:3], (bad, 0, 0)]
    with np.errstate(over="ignore"):
        data = binary_ply(vertices, [(0, 1, 2), (0, 2, 3)])
    assert code_of(written(tmp_path, "a.ply", data)) == "proxy-not-finite"
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices)
    assert code_of(written(tmp_path, "a.obj", text + "f 1 2 3\nf 1 3 4\n")) == "proxy-not-finite"
    assert len(read_mesh(written(tmp_path, "b.obj", text + "f 1 2 3\n")).faces) == 1  # unused: no harm


@pytest.mark.parametrize("index", [-1, 4, 2**31 - 1, -(2**31)])
def test_face_indices_out_of_range(tmp_path, index):
    assert code_of(written(tmp_path, "a.ply", binary_ply(VERTICES, [(0, 1, 2), (0, 2, index)]))) == "proxy-index-range"
    rows = [(*v, *UV_DOWN[v]) for v in VERTICES]
    text = ply(["x", "y", "z", "s", "t"], rows, [(3, 0, 1, 2), (3, 0, 2, index)])
    assert code_of(written(tmp_path, "b.ply", text)) == "proxy-index-range"


def test_face_indices_out_of_range_unsigned_and_in_glb(tmp_path):
    data = binary_ply(VERTICES, [(0, 1, 2), (0, 2, 2**32 - 1)], "u4")
    assert code_of(written(tmp_path, "a.ply", data)) == "proxy-index-range"
    assert code_of(written(tmp_path, "a.glb", glb([{}], indices=(0, 1, 2, 0, 2, 4))[0])) == "proxy-index-range"


@pytest.mark.parametrize("face", ["f 0 1 2", "f 1 2 6", "f 1 2 -6", "f 1/1 2/2 3/5", "f 1/0 2/1 3/2", "f 1/-5 2/1 3/2"])
def test_obj_indices_out_of_range(tmp_path, face):
    path = written(tmp_path, "a.obj", OBJ + face)
    assert code_of(path) == "proxy-index-range"
    with pytest.raises(ProxyError, match="line "):
        read_mesh(path)


@pytest.mark.parametrize("line", ["v 1 2", "v 1 2 x", "f 1 2 x", "vt"])
def test_obj_lines_that_make_no_sense_are_named(tmp_path, line):
    path = written(tmp_path, "a.obj", OBJ.strip() + "\n" + line + "\nf 1 2 3\n")
    with pytest.raises(ProxyError, match=f"line {len(OBJ.strip().splitlines()) + 1}:"):
        read_mesh(path)


def test_far_from_the_origin_is_warned_of(tmp_path, caplog):
    text = "".join(f"v {x + 5e6} {y + 4e5} {z}\n" for x, y, z in VERTICES) + "f 1 2 3 4\n"
    with caplog.at_level(logging.WARNING, "eigenfield.proxy"):
        read_mesh(written(tmp_path, "a.obj", text))
    assert "far from the origin" in caplog.text


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    box = trimesh.creation.icosphere(1)
    files = {}
    for suffix in ("ply", "obj", "glb", "stl", "off"):
        box.export(folder / f"whole.{suffix}")
        files[suffix] = (folder / f"whole.{suffix}").read_bytes()
    files["ascii"] = trimesh.exchange.ply.export_ply(box, encoding="ascii")
    return folder, files


@settings(max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(kind=st.sampled_from(["ply", "ascii", "obj", "glb", "stl", "off"]), at=st.floats(0, 1), damage=st.data())
def test_truncated_and_altered_files_raise_nothing_but_proxy_errors(whole, kind, at, damage):
    folder, files = whole
    data = files[kind]
    cut = int(at * len(data))
    if damage.draw(st.booleans()):
        data = data[:cut]
    else:
        flipped = damage.draw(st.binary(min_size=1, max_size=6))
        data = data[:cut] + flipped + data[cut + len(flipped) :]
    path = folder / f"damaged.{'ply' if kind == 'ascii' else kind}"
    path.write_bytes(data)
    try:
        mesh = read_mesh(path)
    except ProxyError as error:
        assert error.path == str(path)
    else:
        assert np.isfinite(mesh.vertices).all()
        assert mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices)


@pytest.mark.parametrize("kind", ["ply", "ascii", "glb", "stl"])
def test_a_file_cut_in_the_middle_is_noticed(whole, kind):
    folder, files = whole
    path = folder / f"half.{'ply' if kind == 'ascii' else kind}"
    for part in (0.5, 0.9):
        path.write_bytes(files[kind][: int(part * len(files[kind]))])
        assert code_of(path) == "proxy-unreadable"


def test_tarot_comes_as_it_is(data):
    mesh = read_mesh(data / "tarot_17x17_512/calibration/proxy.ply")
    assert (len(mesh.vertices), len(mesh.faces)) == (35_649, 66_208)
    raw = (data / "tarot_17x17_512/calibration/proxy.ply").read_bytes()
    start = raw.index(b"end_header\n") + 11
    rows = np.frombuffer(raw, "<f4", 35_649 * 5, start).reshape(-1, 5)
    np.testing.assert_array_equal(mesh.vertices, rows[:, :3])
    np.testing.assert_allclose(mesh.uv, rows[:, 3:] * (1, -1) + (0, 1), atol=1e-7)
