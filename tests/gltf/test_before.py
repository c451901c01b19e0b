"""Files that earlier versions wrote load, and hold the same numbers: docs/format.md, Changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenfield.gltf import load, parts, save, validate
from eigenfield.gltf.container import parse_glb

DATA = Path(__file__).parents[1] / "data"
CODED, SHEETS = DATA / "coded-1.7.glb", DATA / "coded-1.9.glb"
EXPECTED = {  # counts, and of the rest the mean of the numbers and of their magnitudes
    "counts": (1600, 3042, 8),
    "vertices": [-4.98264947e-05, 0.353933736],
    "uv": [0.5, 0.5],
    "poses": [1.0, 1.22222222],
    "mean": [0.476621367, 0.476621367],
    "textures": [-0.00157594386, 0.0373939852],
    "weights": [1.78503493e-09, 0.822981111],
}
SHEETS_OPACITY = 0.631875951


def test_a_coded_file_of_1_7_holds_what_it_held():
    """Coded mesh, cameras, weights and triangles, pictures in AVIF files."""
    assert validate(CODED) == []
    scene = load(CODED)
    mesh, rig, (plane,) = scene.proxy.mesh, scene.rig, scene.appearance.planes
    (basis,) = plane.bases
    assert (len(mesh.vertices), len(mesh.faces), len(rig.triangles)) == EXPECTED["counts"]
    assert mesh.uv is not None
    found = {
        "vertices": mesh.vertices, "uv": mesh.uv, "poses": np.array([camera.t for camera in rig.cameras]),
        "mean": plane.mean, "textures": basis.values(), "weights": basis.weights,
    }  # fmt: skip
    for name, numbers in found.items():
        moments = [numbers.mean(dtype=np.float64), np.abs(numbers).mean(dtype=np.float64)]
        assert moments == pytest.approx(EXPECTED[name], rel=1e-6, abs=1e-9), name


def test_sheets_of_1_9_are_what_they_were():
    """Counts, order of the faces and the opacity, in a packed file."""
    assert validate(SHEETS) == []
    proxy = load(SHEETS).proxy
    mesh, sheets = proxy.mesh, proxy.sheets
    assert mesh.uv is not None and sheets is not None and sheets.faces == (242, 128, 98)
    assert (mesh.vertices.shape, sheets.opacity.shape) == ((289, 3), (96, 128))
    first = np.cumsum([0, *sheets.faces[:-1]])
    centres = mesh.uv[mesh.faces].mean(axis=1, dtype=np.float64)
    assert np.add.reduceat(centres, first) / np.array(sheets.faces)[:, None] == pytest.approx(
        np.array([[1 / 6, 0.5], [0.5, 0.5], [5 / 6, 0.5]]), abs=1e-3
    )
    assert sheets.opacity.mean(dtype=np.float64) == pytest.approx(SHEETS_OPACITY, rel=1e-6)
    assert sheets.opacity[:, :40].min() > 0.99 and sheets.opacity[48, 64] > 0.99 and sheets.opacity[2, 64] < 0.01


def test_its_parts_keep_their_bytes_when_it_is_written_again(tmp_path):
    again = tmp_path / "again.glb"
    save(load(CODED), again)
    for kind in ("textures", "weights"):
        assert parts(again)[kind] == parts(CODED)[kind]
    now, before = (parts(path)["mean"] - picture_bytes(path) for path in (again, CODED))
    assert now == before
    needs = parse_glb(CODED.read_bytes()).json["extensions"]["EIGENFIELD_eigen_textures"]["needs"]
    assert "bits" in needs


def picture_bytes(path):
    """Of the picture for other viewers, which is made anew."""
    gltf = parse_glb(path.read_bytes()).json
    return gltf["bufferViews"][gltf["images"][0]["bufferView"]]["byteLength"]
