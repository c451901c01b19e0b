"""Valid mesh files of any make read as the same mesh written plainly: none differs silently."""

from __future__ import annotations

import itertools
import struct
from urllib.parse import quote

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st

from eigenfield.proxy import read_mesh
from eigenfield.proxy.meshes.formats import RawMesh
from eigenfield.proxy.meshes.read import check_mesh
from support.fuzzed import fuzzed
from support.mesh_files import GltfFile, ply_file

NEWLINES = st.sampled_from(["\n", "\r\n", "\r"])
SPACES = st.sampled_from([" ", "  ", "\t"])
WORDS = st.sampled_from(["", "plain", "two words", "v 1 2 3", "Straße", "C:\\folder\\", "vertex 1 2 3", "ends\\"])


def assert_same(path, data, positions, faces, uv=None, atol=0.0):
    """The file reads as the mesh does that was written into it: corner by corner."""
    path.write_bytes(data)
    wanted = check_mesh(RawMesh(np.asarray(positions, np.float64), np.asarray(faces, np.int64), uv), None)
    mesh = read_mesh(path)
    np.testing.assert_allclose(mesh.vertices[mesh.faces], wanted.vertices[wanted.faces], rtol=1e-6, atol=atol + 1e-7)
    assert (mesh.uv is None) == (uv is None)
    if uv is not None:
        np.testing.assert_allclose(mesh.uv[mesh.faces], wanted.uv[wanted.faces], atol=atol + 1e-6)


def draw_points(data, low, high):
    """(n, 3) whole numbers, and their smallest multiple of which they all are."""
    count = data.draw(st.integers(3, 12))
    flat = data.draw(st.lists(st.integers(low, high), min_size=3 * count, max_size=3 * count))
    return np.array(flat, np.float64).reshape(count, 3)


def has_area(positions, faces):
    p = positions[np.asarray(faces, np.int64).reshape(-1, 3)]
    return bool((np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) > 1e-3).any())


def draw_polygons(data):
    """Polygons in planes of their own, of any number of corners, and the triangles that they stand for.

    All are convex: a fan from the first corner is what a reader must find.
    """
    positions, polygons, faces = [], [], []
    for k in range(data.draw(st.integers(1, 4))):
        size = data.draw(st.integers(3, 7))
        gaps = np.array(data.draw(st.lists(st.integers(3, 5), min_size=size, max_size=size)))
        turn = 2 * np.pi * np.cumsum(gaps) / gaps.sum()  # no gap is half a turn
        ring = np.rint(200 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1))
        ring = np.roll(ring, data.draw(st.integers(0, 2)), axis=1) + np.array([1000 * k, 0, 0])
        row = np.arange(size) + len(positions)
        positions += ring.tolist()
        polygons.append(row.tolist())
        faces += [(row[0], row[i], row[i + 1]) for i in range(1, size - 1)]
    order = np.array(data.draw(st.permutations(range(len(positions)))))
    place = np.argsort(order)
    return np.array(positions)[order], [place[row].tolist() for row in polygons], place[np.array(faces)]


def check_gltf(folder, data):
    """Component types, strides, offsets, sparse, modes, node transforms, instances, where the buffer is."""
    draw, file = data.draw, GltfFile()
    kind = draw(st.sampled_from(["i1", "u1", "<i2", "<u2", "<f4"]))
    limits = (-1000, 1000) if kind == "<f4" else (np.iinfo(kind).min, np.iinfo(kind).max)
    stored = draw_points(data, *map(int, limits))
    count, normalised = len(stored), kind != "<f4" and draw(st.booleans())
    packed = 3 * np.dtype(kind).itemsize
    options = {"stride": draw(st.sampled_from([None, packed + -packed % 4, packed + -packed % 4 + 8]))}
    options |= {"offset": 4 * draw(st.integers(0, 3)), "normalized": True} if normalised else {}
    if draw(st.booleans()):
        options["sparse"] = sorted(draw(st.sets(st.integers(0, count - 1), min_size=1)))
        if draw(st.booleans()):
            options["base"] = False
            stored[np.setdiff1d(np.arange(count), options["sparse"])] = 0
    attributes = {"POSITION": file.accessor(stored, kind, **options)}
    values = np.maximum(stored / np.iinfo(kind).max, -1) if normalised else stored
    uv = None
    if draw(st.booleans()):
        texel_kind = draw(st.sampled_from(["u1", "<u2", "<f4"]))
        largest = 1.0 if texel_kind == "<f4" else np.iinfo(texel_kind).max
        texels = np.array(draw(st.lists(st.integers(0, 64), min_size=2 * count, max_size=2 * count))) / 64
        texels = np.rint(texels * largest) if largest > 1 else texels
        more = {"normalized": True} if largest > 1 else {}
        attributes["TEXCOORD_0"] = file.accessor(
            texels.reshape(-1, 2), texel_kind, stride=draw(st.sampled_from([None, 16])), **more
        )
        uv = (texels / largest).reshape(-1, 2)
    mode = draw(st.sampled_from([4, 5, 6]))
    primitive = {"attributes": attributes, **({} if mode == 4 and draw(st.booleans()) else {"mode": mode})}
    if draw(st.booleans()):
        length = 3 * draw(st.integers(1, 6)) if mode == 4 else draw(st.integers(3, 9))
        indices = np.array(draw(st.lists(st.integers(0, count - 1), min_size=length, max_size=length)))
        primitive["indices"] = file.accessor(indices, draw(st.sampled_from(["u1", "<u2", "<u4"])))
    else:
        assume(mode != 4 or count % 3 == 0)
        indices = np.arange(count)
    if mode == 4:
        faces = indices.reshape(-1, 3).tolist()
    elif mode == 5:
        faces = [
            (a, b, c) if i % 2 == 0 else (a, c, b)
            for i, (a, b, c) in enumerate(zip(indices, indices[1:], indices[2:], strict=False))
        ]
        faces = [face for face in faces if len(set(face)) == 3]
    else:
        faces = [(indices[0], b, c) for b, c in itertools.pairwise(indices[1:])]
    lines = {"attributes": {"POSITION": file.accessor(stored, "<f4")}, "mode": draw(st.integers(0, 3))}
    file.mesh(*draw(st.permutations([primitive] + [lines] * draw(st.integers(0, 1)))))
    assume(faces)
    matrix, node = np.eye(4), {"mesh": 0}
    if draw(st.booleans()):
        scale, move = draw(st.sampled_from([(2, 2, 2), (0.5, 1, -1)])), (3, -4, 5)
        node |= {"scale": scale, "translation": move, "rotation": [0, 0, np.sqrt(0.5), np.sqrt(0.5)]}
        matrix[:3] = np.array([(0, -1, 0, 3), (1, 0, 0, -4), (0, 0, 1, 5)]) * (*scale, 1)
    moves = [(0, 0, 0)]
    if draw(st.booleans()):
        moves = [(0, 0, 0), (4000, 0, 0)]
        shift = file.accessor(np.array(moves), "<f4")
        node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": shift}}}
    file.tree["nodes"] = [node]
    points = np.concatenate([(values + move) @ matrix[:3, :3].T + matrix[:3, 3] for move in moves])
    triangles = np.array(faces)[:, ::-1] if np.linalg.det(matrix) < 0 else np.array(faces)
    triangles = np.concatenate([triangles + i * count for i in range(len(moves))])
    assume(has_area(points, triangles))
    if draw(st.booleans()):
        wrote, name = file.glb(), "a.glb"
    else:
        bin_name = draw(st.sampled_from(["a b.bin", "ä%41.bin", None]))
        wrote, name = file.gltf(bin_name and quote(bin_name)), "a.gltf"
        if bin_name:
            (folder / bin_name).write_bytes(file.body)
    assert_same(
        folder / name,
        wrote,
        points,
        triangles,
        None if uv is None else np.tile(uv, (len(moves), 1)),
        1e-5 * np.abs(points).max(),
    )


def check_ply(folder, data):
    """Types, orders, other properties and elements, list lengths, comments, line ends, UVs of vertices or corners."""
    draw = data.draw
    positions, polygons, faces = draw_polygons(data)
    order = draw(st.sampled_from(["ascii", "<", ">"]))
    kinds = st.sampled_from(["i2", "i4", "f4", "f8"])
    columns = [(axis, draw(kinds), positions[:, i].astype(int)) for i, axis in enumerate("xyz")]
    uv = None
    if draw(st.booleans()):
        u, v = draw(st.sampled_from([("s", "t"), ("u", "v"), ("texture_u", "texture_v")]))
        uv = np.array(draw(st.lists(st.integers(0, 64), min_size=2 * len(positions), max_size=2 * len(positions))))
        uv = uv.reshape(-1, 2) / 64
        columns += [(u, "f4", uv[:, 0]), (v, "f8", 1 - uv[:, 1])]
    columns += [("red", "u1", np.arange(len(positions)))] * draw(st.integers(0, 1))
    table = [((name, kind), list(column.tolist())) for name, kind, column in columns]
    if draw(st.booleans()):
        table.append(
            (("flags", "u2", draw(st.sampled_from(["u1", "i4"]))), [list(range(i % 3)) for i in range(len(positions))])
        )
    table = draw(st.permutations(table))
    vertex = ("vertex", [head for head, _ in table], list(zip(*(column for _, column in table), strict=True)))
    index = draw(st.sampled_from([("i1", "u1"), ("u1", "i2"), ("u2", "u4"), ("i4", "u1"), ("u4", "i4"), ("i2", "u2")]))
    rows = [((draw(st.sampled_from(["vertex_indices", "vertex_index"])), *index), polygons)]
    if draw(st.booleans()):
        texels = [[] for _ in polygons]
        if uv is None and draw(st.booleans()):
            corner = np.arange(sum(map(len, polygons)) * 2) / 64 % 1
            texels = [part.tolist() for part in np.split(corner, np.cumsum([2 * len(p) for p in polygons])[:-1])]
            positions, faces, uv = split(positions, polygons, texels)
        rows.append((("texcoord", "f4", "u1"), texels))
    rows += [(("material", "i4"), [7] * len(polygons))] * draw(st.integers(0, 1))
    rows = draw(st.permutations(rows))
    face = ("face", [head for head, _ in rows], list(zip(*(column for _, column in rows), strict=True)))
    other = ("camera", [("k", "f8"), ("l", "i2", "u1")], [(0.5, [1, 2, 3])] * draw(st.integers(0, 2)))
    elements = draw(st.permutations([vertex, face, other]))
    newline = draw(NEWLINES).encode()
    comments = [text.encode(draw(st.sampled_from(["utf-8", "latin-1"]))) for text in draw(st.lists(WORDS, max_size=2))]
    trailing = draw(st.sampled_from([b"", b"\0\1" if order != "ascii" else b"5\n"]))
    wrote = ply_file(elements, order, comments, newline, draw(st.booleans()), trailing)
    assert_same(folder / "a.ply", wrote, positions, faces, uv)


def split(positions, polygons, texels):
    """Positions, fans and UVs with a vertex for each corner; `texels` have v up."""
    flat = np.concatenate(polygons)
    uv = np.concatenate(texels).reshape(-1, 2) * np.array([1, -1]) + np.array([0, 1])
    faces, at = [], 0
    for polygon in polygons:
        faces += [(at, at + i, at + i + 1) for i in range(1, len(polygon) - 1)]
        at += len(polygon)
    return positions[flat], np.array(faces), uv


def check_obj(folder, data):
    """Forms of indices, relative ones, continued lines, comments and names of any sort, line ends, byte order marks."""
    draw = data.draw
    positions, polygons, faces = draw_polygons(data)
    texels = draw(st.booleans())
    space, lines = draw(SPACES), []

    def say(*words):
        text = space.join(map(str, words))
        if len(words) > 3 and draw(st.integers(0, 3)) == 0:
            cut = draw(st.integers(2, len(words) - 1))
            text = space.join(map(str, words[:cut])) + " \\\n" + space.join(map(str, words[cut:]))
        lines.append(text + draw(st.sampled_from(["", " ", " # note", " # ends in \\"])))
        if draw(st.integers(0, 4)) == 0:
            lines.append(
                draw(st.sampled_from(["#", "o", "g", "usemtl", "mtllib"])) + " " + draw(WORDS).replace("\n", " ")
            )

    order = draw(st.booleans())
    for position in positions.astype(int).tolist():
        say("v", *position, *([0.5, 0.5, 0.5] if draw(st.booleans()) else []))
    uv = None
    if texels:
        corner = np.arange(2 * sum(map(len, polygons))) / 64 % 1
        uv_rows = np.split(corner, np.cumsum([2 * len(p) for p in polygons])[:-1])
        for u, v in corner.reshape(-1, 2).tolist():
            say("vt", u, v, *([0] if order else []))
        say("vn", 0, 0, 1)
    at = 0
    for polygon in polygons:
        words = []
        for vertex in polygon:
            index = vertex + 1 if draw(st.booleans()) else vertex - len(positions)
            normal = draw(st.sampled_from(["", "/1"])) if texels else draw(st.sampled_from(["", "//1"]))
            words.append(f"{index}/{at + 1}{normal}" if texels else f"{index}{normal}")
            at += 1
        say("f", *words)
    if texels:
        positions, faces, uv = split(positions, polygons, uv_rows)
    wrote = draw(NEWLINES).join("\n".join(lines).split("\n")) + "\n"
    coding = draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "latin-1"]))
    assert_same(folder / "a.obj", wrote.encode(coding), positions, faces, uv)


def check_off(folder, data):
    """Headers, comments, colours, blank lines, polygons of any size."""
    draw = data.draw
    positions, polygons, faces = draw_polygons(data)
    space, newline = draw(SPACES), draw(NEWLINES)
    head = draw(st.sampled_from(["OFF\n", "OFF ", "COFF\n", "off\n", "# kind\nOFF\n", ""]))
    lines = [f"{head}{len(positions)} {len(polygons)}{draw(st.sampled_from(['', ' 0', ' 9']))}"]
    rows = [list(p) for p in positions.astype(int).tolist()] + [[len(p), *p] for p in polygons]
    colour = draw(st.booleans())
    for row in rows:
        lines.append(space.join(map(str, row + ([0.5, 1, 0] if colour and draw(st.booleans()) else []))))
        lines[-1] += draw(st.sampled_from(["", " ", " # note", "\n", "\n# 3 0 1 2"]))
    wrote = newline.join("\n".join(lines).split("\n")) + draw(st.sampled_from(["", newline]))
    assert_same(folder / "a.off", wrote.encode(), positions, faces)


def check_stl(folder, data):
    """Binary with any header and bytes left over; ASCII with any number and names of solids, case and line ends."""
    draw = data.draw
    positions, _, faces = draw_polygons(data)
    if draw(st.booleans()):
        head = draw(st.sampled_from([b"", b"solid x", b"COLOR=abcd"])).ljust(80, draw(st.sampled_from([b" ", b"\0"])))
        body = b"".join(struct.pack("<12fH", 0, 0, 0, *positions[f].reshape(-1), 7) for f in faces)
        wrote = head + struct.pack("<I", len(faces)) + body + draw(st.sampled_from([b"", b"\0" * 3]))
    else:
        newline, space, upper = draw(NEWLINES), draw(SPACES), draw(st.booleans())
        cut = draw(st.integers(0, len(faces)))
        lines = []
        for part in (faces[:cut], faces[cut:]):
            name = draw(WORDS)
            lines.append(f"solid {name}".strip())
            for face in part:
                rows = [f"{space}vertex {' '.join(f'{x:e}' for x in positions[v])}" for v in face]
                block = ["facet normal 0 0 0", "outer loop", *rows, "endloop", "endfacet"]
                lines += [line.upper() if upper else line for line in block]
            lines.append(draw(st.sampled_from(["endsolid", f"endsolid {name}".strip(), "end solid"])))
        wrote = newline.join(lines).encode()
    assert_same(folder / "a.stl", wrote, positions, faces)


def check_concave(folder, data):
    """A polygon between two random polylines, in any plane and begun at any corner, has its area and no more."""
    draw = data.draw
    count = draw(st.integers(2, 12))
    heights = st.lists(st.integers(0, 9), min_size=count, max_size=count)
    low, high = -np.array(draw(heights)) - 1, np.array(draw(heights)) + draw(st.integers(0, 1))
    x = np.arange(count)
    outline = np.concatenate([np.stack([x, low], axis=1), np.stack([x, high], axis=1)[::-1]])
    area = float((high - low)[1:-1].sum() + (high - low)[[0, -1]].sum() / 2)
    outline = np.roll(outline[:: draw(st.sampled_from([1, -1]))], draw(st.integers(0, 2 * count)), axis=0)
    turn = np.linalg.qr(
        np.array(draw(st.lists(st.floats(-1, 1), min_size=9, max_size=9))).reshape(3, 3) + 3 * np.eye(3)
    )
    points, corners = (outline @ turn[0][:, :2].T).tolist(), list(range(2 * count))
    suffix = draw(st.sampled_from(["ply", "obj", "off"]))
    if suffix == "ply":
        vertex = ("vertex", [(axis, "f8") for axis in "xyz"], points)
        wrote = ply_file([vertex, ("face", [("vertex_indices", "i4", "u1")], [[corners]])], "<")
    elif suffix == "obj":
        rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + ["f " + " ".join(str(i + 1) for i in corners)]
        wrote = "\n".join(rows).encode()
    else:
        rows = [f"{x!r} {y!r} {z!r}" for x, y, z in points] + [" ".join(map(str, [len(corners), *corners]))]
        wrote = "\n".join([f"OFF {len(points)} 1 0", *rows]).encode()
    path = folder / f"a.{suffix}"
    path.write_bytes(wrote)
    mesh = read_mesh(path)
    assert mesh.face_areas().sum() == pytest.approx(area, rel=1e-5)
    large = mesh.face_normals()[mesh.face_areas() > 1e-3]
    np.testing.assert_allclose(large, np.tile(large[:1], (len(large), 1)), atol=1e-3)


test_concave, test_concave_many = fuzzed(check_concave)
test_gltf, test_gltf_many = fuzzed(check_gltf)
test_ply, test_ply_many = fuzzed(check_ply)
test_obj, test_obj_many = fuzzed(check_obj)
test_off, test_off_many = fuzzed(check_off)
test_stl, test_stl_many = fuzzed(check_stl)
