"""Files that other programs write are read rightly, or refused by the name of what they need."""

from __future__ import annotations

import json
import logging
import struct
import sys
from pathlib import Path
from urllib.parse import quote

import numpy as np
import pytest

from eigenfield.core.errors import ProxyError
from eigenfield.proxy import read_mesh
from eigenfield.proxy.meshes.formats import RawMesh, list_of_formats
from eigenfield.proxy.meshes.polygons import Polygons, triangulate_polygons
from eigenfield.proxy.meshes.read import MESH_FORMATS, check_mesh
from support.mesh_files import GltfFile, ply_file

# A roof: two squares that share an edge; all numbers are multiples of 1/128
POSITIONS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 1), (2, 1, 1)], np.float64)
FACES = np.array([(0, 1, 2), (0, 2, 3), (1, 4, 5), (1, 5, 2)])
UV = np.array([(0, 0), (0.5, 0), (0.5, 0.5), (0, 0.5), (1, 0), (1, 0.5)], np.float64)
AREA = 1 + np.sqrt(2)
U_PLATE = np.array([(0, 0, 0), (3, 0, 0), (3, 3, 0), (2, 3, 0), (2, 1, 0), (1, 1, 0), (1, 3, 0), (0, 3, 0)], float)


def written(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def corners(mesh):
    return mesh.vertices[mesh.faces].astype(np.float64)


def assert_is_the_roof(mesh, atol=1e-6, uv=False):
    np.testing.assert_allclose(corners(mesh), POSITIONS[FACES], atol=atol)
    if uv:
        np.testing.assert_allclose(mesh.uv[mesh.faces], UV[FACES], atol=atol)


def roof(kind="<f4", **members):
    """The roof as a glTF file with indices, positions of a type, and the file to add to."""
    file = GltfFile()
    attributes = {"POSITION": file.accessor(POSITIONS, kind, **members), "TEXCOORD_0": file.accessor(UV, "<f4")}
    return file, {"attributes": attributes, "indices": file.accessor(FACES.reshape(-1), "<u2")}


@pytest.mark.parametrize("kind", ["i1", "u1", "<i2", "<u2"])
def test_normalised_positions(tmp_path, kind):
    """KHR_mesh_quantization: c / (2^b - 1) unsigned, c / (2^(b - 1) - 1) signed, then the node's scale."""
    largest = np.iinfo(kind).max
    file, primitive = GltfFile(), {}
    attributes = {
        "POSITION": file.accessor(POSITIONS / 2 * largest, kind, stride=4 if "1" in kind else 8, normalized=True)
    }
    primitive |= {"attributes": attributes, "indices": file.accessor(FACES.reshape(-1), "u1")}
    file.mesh(primitive)
    file.tree |= {"nodes": [{"mesh": 0, "scale": [2, 2, 2]}], "extensionsRequired": ["KHR_mesh_quantization"]}
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), 2 / largest)


def test_integers_that_are_not_normalised(tmp_path):
    file = GltfFile()
    position = file.accessor(POSITIONS * 100, "<i2", stride=8)
    file.mesh({"attributes": {"POSITION": position}, "indices": file.accessor(FACES.reshape(-1), "<u4")})
    file.tree["nodes"] = [{"mesh": 0, "scale": [0.01, 0.01, 0.01]}]
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())))


def test_the_most_negative_integer_is_minus_one(tmp_path):
    file = GltfFile()
    points = np.array([(-128, 0, 0), (127, 0, 0), (0, 127, 0)])
    file.mesh({"attributes": {"POSITION": file.accessor(points, "i1", stride=4, normalized=True)}})
    mesh = read_mesh(written(tmp_path, "a.glb", file.glb()))
    np.testing.assert_array_equal(corners(mesh)[0], [(-1, 0, 0), (1, 0, 0), (0, 1, 0)])


@pytest.mark.parametrize("kind", ["u1", "<u2"])
def test_normalised_uv_are_an_atlas(tmp_path, caplog, kind):
    file, primitive = roof()
    uv = np.rint(UV * np.iinfo(kind).max)
    primitive["attributes"]["TEXCOORD_0"] = file.accessor(uv, kind, stride=4, normalized=True)
    file.mesh(primitive)
    mesh = read_mesh(written(tmp_path, "a.glb", file.glb()))
    np.testing.assert_allclose(mesh.uv[mesh.faces], (uv / np.iinfo(kind).max)[FACES], atol=1e-7)
    assert not caplog.records


@pytest.mark.parametrize("base", [True, False])
def test_sparse_positions(tmp_path, base):
    """Without a base view all elements are 0 but those that are replaced: here all but the first."""
    file, primitive = roof(sparse=[1, 2, 3, 4, 5], base=base)
    file.mesh(primitive)
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), uv=True)


def test_sparse_elements_that_are_not_there(tmp_path):
    file, primitive = roof(sparse=[1, 5])
    file.mesh(primitive)
    file.tree["accessors"][0]["count"] = 5
    with pytest.raises(ProxyError, match="element 5 of 5"):
        read_mesh(written(tmp_path, "a.glb", file.glb()))


def test_strips_and_fans(tmp_path):
    """A strip turns every second triangle; points and lines are left out with a word."""
    file = GltfFile()
    position = {"POSITION": file.accessor(POSITIONS, "<f4")}
    indices = {mode: file.accessor(np.array(order), "u1") for mode, order in
               ((6, [0, 1, 2, 3]), (5, [1, 4, 2, 5]), (1, [0, 1]), (0, [0]))}  # fmt: skip
    file.mesh(*({"attributes": position, "indices": at, "mode": mode} for mode, at in indices.items()))
    mesh = read_mesh(written(tmp_path, "a.glb", file.glb()))
    wanted = POSITIONS[[(0, 1, 2), (0, 2, 3), (1, 4, 2), (4, 5, 2)]]
    assert {frozenset(map(tuple, face)) for face in corners(mesh)} == {frozenset(map(tuple, face)) for face in wanted}
    assert mesh.face_areas().sum() == pytest.approx(AREA)
    assert (mesh.face_normals()[:, 2] > 0).all()


def test_points_and_lines_are_left_out_with_a_word(tmp_path, caplog):
    file, primitive = roof()
    file.mesh(primitive, {"attributes": primitive["attributes"], "mode": 3})
    with caplog.at_level(logging.INFO, "eigenfield.proxy"):
        assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), uv=True)
    assert "1 primitives of points or lines are ignored" in caplog.text


@pytest.mark.parametrize("name", ["my mesh.bin", "mäsh.bin", "100%.bin", "sub/mesh.bin", "a+b#c.bin"])
def test_uris_are_percent_encoded(tmp_path, name):
    file, primitive = roof()
    file.mesh(primitive)
    (tmp_path / "sub").mkdir()
    written(tmp_path, name, file.body)
    assert_is_the_roof(read_mesh(written(tmp_path, "a.gltf", file.gltf(quote(name)))), uv=True)
    assert_is_the_roof(read_mesh(written(tmp_path, "b.gltf", file.gltf(name.replace("%", "%25")))), uv=True)


@pytest.mark.parametrize("head", ["data:application/octet-stream,", "data:,", "DATA:application/gltf-buffer,"])
def test_data_uris_without_base64(tmp_path, head):
    file, primitive = roof()
    file.mesh(primitive)
    assert_is_the_roof(read_mesh(written(tmp_path, "a.gltf", file.gltf(head + quote(file.body)))), uv=True)
    assert_is_the_roof(read_mesh(written(tmp_path, "b.gltf", b"\xef\xbb\xbf" + file.gltf())), uv=True)


def test_a_buffer_that_is_missing_is_named(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    with pytest.raises(ProxyError, match=r'"no such.bin" are not beside it; put that file'):
        read_mesh(written(tmp_path, "a.gltf", file.gltf("no%20such.bin")))
    with pytest.raises(ProxyError, match="bytes of buffer 0 announced, 9 found"):
        written(tmp_path, "short.bin", b"123456789")
        read_mesh(written(tmp_path, "b.gltf", file.gltf("short.bin")))


@pytest.mark.parametrize(
    "uri",
    [
        "../mesh.bin", "sub/../../mesh.bin", "%2e%2e/mesh.bin", "..%2Fmesh.bin", "..\\mesh.bin", "%2E.%5cmesh.bin",
        "sub/..", "{folder}/mesh.bin", "/{folder}/mesh.bin", "%2F{folder}/mesh.bin", "\\\\host\\mesh.bin",
        "C:\\mesh.bin", "C:/mesh.bin", "link.bin", "linked/mesh.bin", "sub/link.bin", "./link.bin",
    ],
)  # fmt: skip
def test_a_buffer_outside_of_the_folder_is_not_read(tmp_path, uri):
    """By its name, or by a link; what lies in the folder by a link is read."""
    file, primitive = roof()
    file.mesh(primitive)
    written(tmp_path, "mesh.bin", file.body)
    folder = tmp_path / "mesh"
    (folder / "sub").mkdir(parents=True)
    for place, target in (
        ("link.bin", tmp_path / "mesh.bin"),
        ("sub/link.bin", "../../mesh.bin"),
        ("linked", tmp_path),
    ):
        (folder / place).symlink_to(target)
    with pytest.raises(ProxyError, match="lie outside of its folder, and are not read") as caught:
        read_mesh(written(folder, "a.gltf", file.gltf(uri.format(folder=tmp_path))))
    assert caught.value.code == "proxy-outside"
    written(folder, "sub/mesh.bin", file.body)
    (folder / "inner.bin").symlink_to("sub/mesh.bin")
    (tmp_path / "seen").symlink_to(folder)
    assert_is_the_roof(read_mesh(written(tmp_path / "seen", "b.gltf", file.gltf("./inner.bin"))), uv=True)


@pytest.mark.parametrize("name", ["KHR_meshopt_compression", "EXT_meshopt_compression", "MAKER_holograms", "KHR_a\nb"])
def test_extensions_that_are_required_and_not_read_are_named(tmp_path, name):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["extensionsRequired"] = ["KHR_mesh_quantization", name]
    with pytest.raises(ProxyError) as caught:
        read_mesh(written(tmp_path, "a.glb", file.glb()))
    shown = json.dumps(name)[1:-1]
    assert caught.value.code == "proxy-extension"
    assert f"{shown}" in caught.value.message and "KHR_mesh" not in caught.value.message.replace(shown, "")
    assert caught.value.remedy == f"export it without {shown}"


def test_extensions_that_change_no_geometry_are_no_hindrance(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["extensionsRequired"] = ["KHR_texture_basisu", "KHR_materials_unlit", "EXT_texture_webp"]
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), uv=True)


def test_instances(tmp_path):
    """EXT_mesh_gpu_instancing: T R S of each, within the node."""
    file, primitive = roof()
    attributes = {
        "TRANSLATION": file.accessor(np.array([(0, 0, 0), (0, 0, 5)]), "<f4"),
        "ROTATION": file.accessor(np.array([(0, 0, 0, 127), (0, 0, 90, 90)]), "i1", normalized=True),
        "SCALE": file.accessor(np.array([(1, 1, 1), (2, 2, 2)]), "<f4"),
    }
    file.mesh(primitive)
    extension = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    file.tree |= {"nodes": [{"mesh": 0, "translation": [10, 0, 0], "extensions": extension}]}
    file.tree["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    found = corners(read_mesh(written(tmp_path, "a.glb", file.glb())))
    np.testing.assert_allclose(found[:4], POSITIONS[FACES] + (10, 0, 0), atol=1e-6)
    x, y, z = np.moveaxis(POSITIONS[FACES], 2, 0)
    np.testing.assert_allclose(found[4:], np.stack([10 - 2 * y, 2 * x, 5 + 2 * z], axis=2), atol=1e-5)


@pytest.mark.parametrize("angle", [0.0, np.pi / 2])
def test_the_transform_of_texture_coordinates(tmp_path, angle):
    """KHR_texture_transform, at the base colour's set of coordinates: counter-clockwise, with v down."""
    file, primitive = roof()
    primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"].pop("TEXCOORD_0")
    transform = {"offset": [0.25, 0.75], "rotation": angle, "scale": [0.5, 0.25]}
    info = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": transform}}
    file.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": info}}]
    file.mesh({**primitive, "material": 0})
    mesh = read_mesh(written(tmp_path, "a.glb", file.glb()))
    u, v = np.moveaxis(UV[FACES] * (0.5, 0.25), 2, 0)
    wanted = np.stack([u, v] if angle == 0 else [v, -u], axis=2) + np.array([0.25, 0.75])
    np.testing.assert_allclose(mesh.uv[mesh.faces], wanted, atol=1e-6)


def test_morph_targets_have_their_weights(tmp_path):
    file, primitive = roof()
    primitive["targets"] = [{"POSITION": file.accessor(np.full((6, 3), 4.0), "<f4")}]
    file.mesh(primitive, weights=[0.5])
    np.testing.assert_allclose(corners(read_mesh(written(tmp_path, "a.glb", file.glb()))), POSITIONS[FACES] + 2)


def test_draco(tmp_path):
    draco = pytest.importorskip("DracoPy")
    file = GltfFile()
    packed = draco.encode(POSITIONS.astype(np.float32), FACES.astype(np.uint32), quantization_bits=14)
    accessors = [
        {"componentType": 5126, "count": 6, "type": "VEC3"},
        {"componentType": 5125, "count": 12, "type": "SCALAR"},
    ]
    file.tree |= {"accessors": accessors, "extensionsRequired": ["KHR_draco_mesh_compression"]}
    extension = {"bufferView": file.view(packed), "attributes": {"POSITION": 0}}
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "extensions": {"KHR_draco_mesh_compression": extension}}
    file.mesh(primitive)
    mesh = read_mesh(written(tmp_path, "a.glb", file.glb()))
    assert len(mesh.faces) == 4
    assert mesh.face_areas().sum() == pytest.approx(AREA, abs=1e-3)


def test_draco_without_its_decoder(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    file, primitive = roof()
    del file.tree["accessors"][0]["bufferView"]
    primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    file.mesh(primitive)
    with pytest.raises(ProxyError, match=r"KHR_draco_mesh_compression.*pip install 'eigenfield\[meshes\]'"):
        read_mesh(written(tmp_path, "a.glb", file.glb()))


def test_nodes_that_form_a_circle(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["nodes"] = [{"children": [1]}, {"mesh": 0, "children": [2]}, {"children": [1]}]
    with pytest.raises(ProxyError, match="nodes form a circle: node 1 is among its own descendants") as caught:
        read_mesh(written(tmp_path, "a.glb", file.glb()))
    assert caught.value.code == "proxy-nodes"
    file.tree["nodes"] = [{"mesh": 0, "children": [0]}]
    with pytest.raises(ProxyError, match="node 0 is among its own"):
        read_mesh(written(tmp_path, "b.glb", file.glb()))


def test_nodes_that_double_at_every_level(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["nodes"] = [*({"children": [i + 1, i + 1]} for i in range(60)), {"mesh": 0}]
    file.tree["scenes"] = [{"nodes": [0]}]
    with pytest.raises(ProxyError, match="share children so that they stand for more than 1048576") as caught:
        read_mesh(written(tmp_path, "a.glb", file.glb()))
    assert caught.value.code == "proxy-nodes"
    file.tree["nodes"] = [
        {"children": [1, 2]},
        *({"translation": [t, 0, 0], "children": [3]} for t in (0, 9)),
        {"mesh": 0},
    ]
    assert len(read_mesh(written(tmp_path, "b.glb", file.glb())).faces) == 8


def test_a_chain_of_nodes_may_be_long(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["nodes"] = [*({"children": [i + 1]} for i in range(5000)), {"mesh": 0}]
    file.tree["scenes"] = [{"nodes": [0]}]
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), uv=True)


def test_only_the_scene_that_is_shown_is_read(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree |= {"nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 7]}], "scene": 1}
    file.tree["scenes"] = [{"nodes": [1]}, {"nodes": [0]}]
    assert_is_the_roof(read_mesh(written(tmp_path, "a.glb", file.glb())), uv=True)


def test_a_bomb_of_zeros(tmp_path):
    file, primitive = roof()
    file.mesh(primitive)
    file.tree["accessors"][0] = {"componentType": 5126, "count": 2**26, "type": "VEC3"}
    with pytest.raises(ProxyError, match="without a buffer view"):
        read_mesh(written(tmp_path, "a.glb", file.glb()))


def u_plate(suffix, shift):
    """The U plate, area 7, with its corners begun anywhere."""
    order = np.roll(np.arange(8), shift)
    lines = [" ".join(map(str, p)) for p in U_PLATE.tolist()]
    if suffix == "obj":
        return "".join(f"v {line}\n" for line in lines) + "f " + " ".join(str(i + 1) for i in order) + "\n"
    if suffix == "off":
        return "\n".join(["OFF", "8 1 0", *lines, "8 " + " ".join(map(str, order))]) + "\n"
    points = ("vertex", [("x", "f4"), ("y", "f4"), ("z", "f4")], U_PLATE.tolist())
    return ply_file([points, ("face", [("vertex_indices", "i4", "u1")], [[order.tolist()]])], "<")


@pytest.mark.parametrize("suffix", ["obj", "off", "ply"])
@pytest.mark.parametrize("shift", range(8))
def test_concave_polygons_cover_their_area_once(tmp_path, suffix, shift):
    mesh = read_mesh(written(tmp_path, f"a.{suffix}", u_plate(suffix, shift)))
    assert len(mesh.faces) == 6
    assert mesh.face_areas().sum() == pytest.approx(7)
    np.testing.assert_allclose(mesh.face_normals(), [(0, 0, 1)] * 6)
    middle = corners(mesh).mean(axis=1)
    assert not ((middle[:, 0] > 1) & (middle[:, 0] < 2) & (middle[:, 1] > 1)).any()


def test_a_concave_quad_and_its_uv(tmp_path):
    text = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt .25 .25\nvt 0 1\nf 2/2 3/3 4/4 1/1\n"
    mesh = read_mesh(written(tmp_path, "a.obj", text))
    assert mesh.face_areas().sum() == pytest.approx(4)
    np.testing.assert_allclose(mesh.uv[mesh.faces], corners(mesh)[..., :2] / (4, -4) + (0, 1), atol=1e-6)


def test_a_star_in_space(tmp_path):
    """Sixty corners, every second one reflex, in a plane that lies askew."""
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    flat = np.stack([np.cos(angle), np.sin(angle)], axis=1) * np.where(np.arange(60) % 2, 1.0, 3.0)[:, None]
    points = flat @ np.array([(0.6, 0.0, 0.8), (0.0, 1.0, 0.0)])
    text = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
    mesh = read_mesh(written(tmp_path, "a.obj", text + "f " + " ".join(map(str, range(1, 61))) + "\n"))
    x, y = flat.T
    assert mesh.face_areas().sum() == pytest.approx((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)
    assert np.ptp(mesh.face_normals(), axis=0).max() < 1e-5


def test_a_polygon_with_a_bridge_to_its_hole(tmp_path):
    """A square of 4 with a hole of 2, joined by an edge that is run twice: area 12."""
    outer, inner = [(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (1, 3), (3, 3), (3, 1)]
    text = "".join(f"v {x} {y} 0\n" for x, y in outer + inner) + "f 1 2 3 4 1 5 6 7 8 5\n"
    assert read_mesh(written(tmp_path, "a.obj", text)).face_areas().sum() == pytest.approx(12)


def test_a_huge_concave_polygon_is_refused(tmp_path):
    count = 20_002
    text = "".join(f"v {i} {i % 2} 0\n" for i in range(count)) + "v 0 -9 0\n"
    with pytest.raises(ProxyError, match="is not convex has 20003 corners, 10000 are allowed; export it as triangles"):
        read_mesh(written(tmp_path, "a.obj", text + "f " + " ".join(map(str, range(1, count + 2))) + "\n"))


def test_the_page_has_the_list_of_formats():
    formats = list_of_formats(MESH_FORMATS)
    page = Path(__file__).parents[2] / "docs/meshes.md"
    assert formats in page.read_text(encoding="utf-8"), f"docs/meshes.md needs this list:\n{formats}"


OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in POSITIONS) + "".join(
    f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES
)


@pytest.mark.parametrize("mark", [b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff"])
def test_byte_order_marks(tmp_path, mark):
    coding = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}.get(mark, "utf-8")
    off = "OFF\n6 4 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in POSITIONS)
    off += "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES)
    assert_is_the_roof(read_mesh(written(tmp_path, "a.obj", mark + OBJ.encode(coding))))
    assert_is_the_roof(read_mesh(written(tmp_path, "a.off", mark + off.encode(coding))))
    assert_is_the_roof(read_mesh(written(tmp_path, "a.ply", mark + roof_ply("ascii").decode().encode(coding))))


@pytest.mark.parametrize(
    "line", ["# made in C:\\", "mtllib textures\\", "usemtl \\", "o \\ ", "# end \\\r", "vn 0 0 1 \\"]
)
def test_backslashes_that_continue_nothing(tmp_path, line):
    assert_is_the_roof(read_mesh(written(tmp_path, "a.obj", f"{line}\n{OBJ}")))
    lines = OBJ.splitlines()
    assert_is_the_roof(read_mesh(written(tmp_path, "b.obj", "\n".join([*lines[:2], line, *lines[2:]]))))


def test_statements_that_continue(tmp_path):
    text = OBJ.replace("f 1 2 3", "f 1 \\\n 2 \\\r\n3 # a comment \\").replace("v 1.0 0.0", "v 1.0 \\ \n0.0")
    assert_is_the_roof(read_mesh(written(tmp_path, "a.obj", text)))
    assert_is_the_roof(read_mesh(written(tmp_path, "b.obj", OBJ.replace("0.0\nv", "0.0 \\\nv"))))


def test_separators_that_are_no_line_ends(tmp_path):
    assert_is_the_roof(read_mesh(written(tmp_path, "a.obj", "o a\u2028v 9 9 9\n# b\x0bv 9 9 9\n" + OBJ)))


def roof_ply(order, extra=(), **options):
    points = ("vertex", [("x", "f4"), ("y", "f4"), ("z", "f4")], POSITIONS.tolist())
    return ply_file(
        [points, ("face", [("vertex_indices", "i4", "u1")], [[f] for f in FACES.tolist()]), *extra], order, **options
    )


@pytest.mark.parametrize("order", ["ascii", "<", ">"])
def test_ply_lists_of_any_length(tmp_path, order):
    """A quad among triangles; lists of lengths and types of their own beside the one that counts; other elements."""
    points = ("vertex", [("x", "f8"), ("flags", "i2", "u4"), ("y", "f4"), ("z", "i4")],
              [[x, list(range(i)), y, z] for i, (x, y, z) in enumerate(POSITIONS.tolist())])  # fmt: skip
    faces = [[7, [0, 1, 2, 3], [0.5]], [8, [1, 4, 5], []], [9, [1, 5, 2], [1.0, 2.0]]]
    faces = ("face", [("c", "u1"), ("vertex_index", "u2", "i4"), ("w", "f4", "u2")], faces)
    camera = ("camera", [("k", "f8"), ("note", "u1", "u1")], [[1.0, [1, 2, 3]]])
    data = ply_file([camera, points, ("edge", [("a", "i4")], [[1], [2]]), faces, camera], order)
    assert_is_the_roof(read_mesh(written(tmp_path, "a.ply", data)))


@pytest.mark.parametrize("order", ["ascii", "<", ">"])
def test_ply_comments_line_ends_and_what_is_left_over(tmp_path, order):
    for newline in (b"\n", b"\r\n", b"\r"):
        data = roof_ply(order, comments=[b"Stra\xdfe", "Straße".encode(), b"element vertex 3"], newline=newline)
        assert_is_the_roof(read_mesh(written(tmp_path, "a.ply", data)))
    trailing = b"7 7\n" if order == "ascii" else b"\0"
    assert_is_the_roof(read_mesh(written(tmp_path, "b.ply", roof_ply(order, trailing=trailing))))


def test_ply_blank_lines(tmp_path):
    assert_is_the_roof(read_mesh(written(tmp_path, "a.ply", roof_ply("ascii", blank=True))))


@pytest.mark.parametrize("order", ["ascii", "<"])
def test_ply_strips(tmp_path, order):
    strips = ("tristrips", [("vertex_indices", "i4", "i4")], [[[0, 1, 3, 2, -1, 1, 4, 2, 5]]])
    points = ("vertex", [("x", "f4"), ("y", "f4"), ("z", "f4")], POSITIONS.tolist())
    mesh = read_mesh(written(tmp_path, "a.ply", ply_file([points, strips], order)))
    assert (len(mesh.faces), mesh.face_areas().sum()) == (4, pytest.approx(AREA))
    assert (mesh.face_normals()[:, 2] > 0).all()


@pytest.mark.parametrize(
    "old, new, words",
    [
        (b"1.0 0.0 0.0\n", b"1.0 0.0 0.0 0.5\n", "line 11 holds more numbers than a row of its element"),
        (b"1.0 0.0 0.0\n", b"1.0 0.0 zero\n", "line 11 does not consist of numbers"),
        (b"3 1 5 2\n", b"3 1 5\n", "4 rows of its element face announced, 3 found"),
        (b"property float z\n", b"", "x, y and z"),
        (b"property float z\n", b"property float\n", "line 6 of the header"),
        (b"format ascii 1.0\n", b"format ebcdic 1.0\n", "an unknown format"),
        (b"end_header\n", b"", "line"),
    ],
)
def test_ply_messages(tmp_path, old, new, words):
    data = roof_ply("ascii")
    assert old in data
    with pytest.raises(ProxyError, match=words):
        read_mesh(written(tmp_path, "a.ply", data.replace(old, new, 1)))


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("names", [("a", "b"), ("", "two words"), ("facet", "vertex 1 2 3")])
def test_stl_solids(tmp_path, newline, names):
    text = []
    for name, faces in zip(names, (FACES[:2], FACES[2:]), strict=True):
        text.append(f"solid {name}".strip())
        for face in faces:
            rows = [f"  vertex {x:e} {y} {z}" for x, y, z in POSITIONS[face]]
            text += [" facet normal 0 0 1", "  outer loop", *rows, "  endloop", " endfacet"]
        text.append(f"endsolid {name}".strip())
    mesh = read_mesh(written(tmp_path, "a.stl", newline.join([*text, ""])))
    assert_is_the_roof(mesh)
    assert len(mesh.vertices) == 6
    with pytest.raises(ProxyError, match="solids begin and 1 end"):
        read_mesh(written(tmp_path, "b.stl", newline.join(text[:-1])))
    with pytest.raises(ProxyError, match="4 triangles have 11 corners"):
        read_mesh(written(tmp_path, "c.stl", newline.join([*text[:-4], *text[-3:]])))


@pytest.mark.parametrize("head", [b"made by a test", b"solid but binary"])
@pytest.mark.parametrize("trailing", [b"", b"\0\0\0"])
def test_binary_stl(tmp_path, head, trailing):
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *POSITIONS[face].reshape(-1), 0) for face in FACES)
    data = head.ljust(80, b"\0") + struct.pack("<I", 4) + body + trailing
    assert_is_the_roof(read_mesh(written(tmp_path, "a.stl", data)))


@pytest.mark.parametrize("head", ["OFF\n6 4 0\n", "OFF 6 4 0\n", "# first\n\nCOFF # kind\n6 4\n", "6 4 9\n"])
def test_off(tmp_path, head):
    rows = [f"{x} {y} {z} 255 0 0 255 # a vertex" for x, y, z in POSITIONS]
    rows += ["4 0 1 2 3 0.5 0.5 0.5", "", "3 1 4 5", "3 1 5 2 7"]
    text = head.replace("6 4", "6 3") + "\n".join(rows) + "\n"
    assert_is_the_roof(read_mesh(written(tmp_path, "a.off", text)))


@pytest.mark.parametrize("head", ["OFF BINARY", "4OFF", "nOFF"])
def test_kinds_of_off_that_are_not_read(tmp_path, head):
    with pytest.raises(ProxyError, match=f"{head} is not read"):
        read_mesh(written(tmp_path, "a.off", f"{head}\n6 4 0\n"))


def grid_mesh(n=6):
    """A wavy square of 2 n^2 triangles, wound alike."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    vertices = np.stack([x.ravel(), y.ravel(), np.sin(x).ravel()], axis=1)
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return vertices, np.concatenate([np.stack([i, i + 1, i + n + 2], 1), np.stack([i, i + n + 2, i + n + 1], 1)])


@pytest.mark.parametrize("kind", ["turned", "same", "rolled", "other object"])
def test_faces_that_are_there_twice_are_taken_once(caplog, kind):
    vertices, faces = grid_mesh()
    copies = {"turned": faces[:, ::-1], "same": faces, "rolled": np.roll(faces, 1, axis=1)}
    again = copies.get(kind, faces[::-1] + len(vertices))
    more = np.concatenate([vertices, vertices]) if kind == "other object" else vertices
    mesh = check_mesh(RawMesh(more, np.concatenate([faces, again]), None), None)
    np.testing.assert_array_equal(mesh.faces, faces)
    np.testing.assert_array_equal(mesh.vertices, vertices.astype(np.float32))
    assert caplog.messages == ["mesh: 72 of 144 triangles are there twice: taken once"]


@pytest.mark.parametrize("suffix", ["obj", "off", "ply"])
@pytest.mark.parametrize("again", ["4 3 2 1", "2 3 4 1", "3 2 1 4", "5 6 7 8", "8 7 6 5"])
def test_polygons_that_are_there_twice_are_taken_once(tmp_path, caplog, suffix, again):
    """A fan from another corner has another diagonal: such triangles would not be the same."""
    points = [(0, 0, 0), (2, 0, 0), (3, 2, 0), (0, 1, 0)] * 2
    second = [int(word) - 1 for word in again.split()]
    if suffix == "obj":
        data = "".join(f"v {x} {y} {z}\n" for x, y, z in points) + f"f 1 2 3 4\nf {again}\n"
    elif suffix == "off":
        rows = [f"{x} {y} {z}" for x, y, z in points] + ["4 0 1 2 3", "4 " + " ".join(map(str, second))]
        data = "\n".join(["OFF", "8 2 0", *rows])
    else:
        vertex = ("vertex", [("x", "f4"), ("y", "f4"), ("z", "f4")], points)
        data = ply_file([vertex, ("face", [("vertex_indices", "i4", "u1")], [[[0, 1, 2, 3]], [second]])], "<")
    mesh = read_mesh(written(tmp_path, f"a.{suffix}", data))
    np.testing.assert_array_equal(mesh.faces, [(0, 1, 2), (0, 2, 3)])
    assert "2 of 4 triangles are there twice" in caplog.text


def quad_grid(diagonal, n=5):
    """A wavy square of quads, each cut along one of its diagonals."""
    vertices, _ = grid_mesh(n)
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    a, b, c, d = i, i + 1, i + n + 2, i + n + 1
    cuts = {"a c": ((a, b, c), (a, c, d)), "d b": ((d, c, b), (d, b, a))}[diagonal]
    return vertices * (1, 1, 0.1), np.stack([np.stack(cut, axis=1) for cut in cuts], axis=1).reshape(-1, 3)


def test_quads_that_are_there_twice_are_taken_once_whatever_their_diagonals(caplog):
    vertices, faces = quad_grid("a c")
    _, back = quad_grid("d b")
    mesh = check_mesh(RawMesh(vertices, np.concatenate([faces, back]), None), None)
    np.testing.assert_array_equal(mesh.faces, faces)
    assert caplog.messages == ["mesh: 50 of 100 triangles are there twice: taken once"]


def test_tetrahedra_on_a_common_edge_stay(caplog):
    """Their faces cut four points along both diagonals too, but not a flat quad. Three share an edge of six faces."""
    points = [(0, 0, 0), (0, 0, 1)]
    faces = []
    for k, turn in enumerate(np.radians([0, 120, 240])):
        points += [(np.cos(turn + t), np.sin(turn + t), z) for t, z in ((0, 0.2), (0.8, 0.7))]
        c, d = 2 * k + 2, 2 * k + 3
        faces += [(0, 1, d), (1, 0, c), (0, d, c), (1, c, d)]
    np.testing.assert_array_equal(check_mesh(RawMesh(np.array(points), np.array(faces), None), None).faces, faces)
    assert not caplog.records


def test_half_of_the_faces_turned(caplog):
    vertices, faces = grid_mesh()
    mixed = faces.copy()
    wrong = np.random.default_rng(1).permutation(72)[:30]
    mixed[wrong] = mixed[wrong][:, ::-1]
    mesh = check_mesh(RawMesh(vertices, mixed, None), None)
    assert (mesh.face_normals()[:, 2] > 0).all()
    np.testing.assert_array_equal(np.sort(mesh.faces, axis=1), np.sort(faces, axis=1))
    assert caplog.messages == ["mesh: 30 of 72 triangles are wound against their neighbours: turned"]


def test_each_patch_is_turned_for_itself():
    vertices, faces = grid_mesh()
    two = np.concatenate([faces, faces[:, ::-1] + len(vertices)])
    apart = np.concatenate([vertices, vertices + np.array([20, 0, 0])])
    np.testing.assert_array_equal(check_mesh(RawMesh(apart, two, None), None).faces, two)


def test_sound_meshes_stay_as_they_are(caplog):
    """Seams, borders, several patches, an edge of three faces, a Möbius strip: to the bit, without a word."""
    vertices, faces = grid_mesh()
    uv = (vertices[:, :2] / 8).astype(np.float32)
    fin = np.concatenate([faces, [(8, 9, len(vertices))]])
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    strip = [((2 + w * np.cos(a / 2)) * np.cos(a), (2 + w * np.cos(a / 2)) * np.sin(a), w * np.sin(a / 2) + 9)
             for a in angle for w in (-1, 1)]  # fmt: skip
    ring = [quad for i in range(23) for quad in ((2 * i, 2 * i + 2, 2 * i + 3), (2 * i, 2 * i + 3, 2 * i + 1))]
    ring += [(46, 1, 0), (46, 0, 47)]
    points = np.concatenate([vertices, [(0, 0, 5)], strip])
    whole = np.concatenate([fin, np.array(ring) + len(vertices) + 1])
    mesh = check_mesh(RawMesh(points, whole, None), None)
    np.testing.assert_array_equal(mesh.faces, whole)
    np.testing.assert_array_equal(mesh.vertices, points.astype(np.float32))
    seams = check_mesh(
        RawMesh(vertices[faces].reshape(-1, 3), np.arange(216).reshape(-1, 3), uv[faces].reshape(-1, 2)), None
    )
    np.testing.assert_array_equal(seams.faces, np.arange(216).reshape(-1, 3))
    np.testing.assert_array_equal(seams.uv, uv[faces].reshape(-1, 2))
    assert not caplog.records


def test_a_corner_on_the_border_of_an_ear_is_in_it_however_it_is_rounded():
    low, high = -np.array([6, 4, 2, 2, 1, 1, 1]), np.array([0, 0, 0, 0, 0, 0, 1])  # many corners on one line
    outline = np.stack([np.r_[:7, 6:-1:-1], np.r_[high, low[::-1]]], axis=1).astype(np.float64)
    turn = np.linalg.qr(3 * np.eye(3) + np.array([[0, 0.5, 0], [2**-52, 0.25, 0], [1, -0.509765625, 0]]))[0]
    points = outline @ turn[:, :2].T
    faces, _ = triangulate_polygons(Polygons(np.arange(14), np.array([14])), None, points)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(normals, axis=1).sum() / 2 == pytest.approx(14)
