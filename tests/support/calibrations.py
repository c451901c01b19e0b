"""A cube, cameras that look at it, and every calibration format written by hand, each in its own words.

A station is an eye and three orthonormal directions; what a camera sees is dot products with them. No matrix of the
library and no reader's inverse takes part: a writer composes its format's numbers from the directions.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from PIL import Image

WIDTH, HEIGHT = 96, 64
CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
EYES = ((4.0, 0.5, -6.0), (-3.0, 2.0, -7.0), (0.3, -2.5, -5.5), (6.0, 1.0, 4.0))
NAMES = ("a0.png", "b1.png", "c2.png", "d3.png")


@dataclass(frozen=True)
class Station:
    name: str
    eye: np.ndarray
    right: np.ndarray
    down: np.ndarray
    forward: np.ndarray
    fx: float
    fy: float
    cx: float  # pixels, the centre of the top-left pixel at 0.5
    cy: float

    def along(self, points):
        """Distances of points to the right, down and forward, (n, 3)."""
        offset = np.asarray(points) - self.eye
        return np.stack([offset @ self.right, offset @ self.down, offset @ self.forward], axis=1)

    def pixels(self, points):
        x, y, z = self.along(points).T
        return np.stack([self.fx * x / z + self.cx, self.fy * y / z + self.cy], axis=1)


def stations(square: bool = False, centred: bool = False) -> list[Station]:
    """Four cameras around the cube, none level. square: fx = fy. centred: no shift of the principal point."""
    found = []
    for i, (name, eye) in enumerate(zip(NAMES, EYES, strict=True)):
        eye = np.array(eye)
        forward = -eye / np.linalg.norm(eye)
        down = np.array([0.1 * i, 1.0, 0.05])
        right = np.cross(down, forward)
        right /= np.linalg.norm(right)
        down = np.cross(forward, right)
        fx = 90.0 + i
        cx, cy = (WIDTH / 2, HEIGHT / 2) if centred else (WIDTH / 2 + 3.25 - i, HEIGHT / 2 - 2.5 + i)
        found.append(Station(name, eye, right, down, forward, fx, fx if square else fx + 1.5, cx, cy))
    return found


def photographs(folder: Path, names=NAMES, size=(WIDTH, HEIGHT)) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for i, name in enumerate(names):
        Image.new("RGB", size, (40 * i % 256, 80, 120)).save(folder / name)


def words(values) -> str:
    return " ".join(repr(float(v)) for v in np.ravel(values))


def world_to_camera(s: Station):
    """Rows right, down, forward, and the shift."""
    rows = [list(s.right), list(s.down), list(s.forward)]
    return rows, [-float(np.dot(row, s.eye)) for row in rows]


def llff(folder: Path, all_stations, full=8, bounds=(2.0, 20.0), dtype="<f8", fortran=False) -> Path:
    rows = []
    for s in all_stations:
        columns = [s.down, s.right, -s.forward, s.eye, (HEIGHT * full, WIDTH * full, s.fx * full)]
        rows.append([*np.ravel(np.stack(columns, axis=1)), *bounds])
    body = np.array(rows, dtype)
    head = f"{{'descr': '{dtype}', 'fortran_order': {fortran}, 'shape': ({len(rows)}, 17), }}"
    head += " " * (-(10 + len(head) + 1) % 64) + "\n"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "poses_bounds.npy"
    data = body.T.tobytes() if fortran else body.tobytes()
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + data)
    return path


def middlebury(folder: Path, all_stations) -> Path:
    lines = [str(len(all_stations))]
    for s in all_stations:
        rows, t = world_to_camera(s)
        lines.append(f"{s.name} {words([s.fx, 0, s.cx, 0, s.fy, s.cy, 0, 0, 1])} {words(rows)} {words(t)}")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "cube_par.txt"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def strecha(folder: Path, all_stations, scale=1) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for s in all_stations:
        axes = np.stack([s.right, s.down, s.forward], axis=1)  # columns
        lines = [words([s.fx * scale, 0, s.cx * scale]), words([0, s.fy * scale, s.cy * scale]), "0 0 1 ", "0 0 0 "]
        lines += [words(row) + " " for row in axes] + [words(s.eye), f"{WIDTH * scale} {HEIGHT * scale}"]
        (folder / f"{s.name}.camera").write_text("\n".join(lines) + " \n", encoding="utf-8")
    return folder


BUNDLER_LENS = (-0.05, 0.02)


def bundler(folder: Path, all_stations, lens=(0.0, 0.0), unregistered=(), list_name="list.txt") -> Path:
    lines = ["# Bundle file v0.3", f"{len(all_stations)} 2"]
    for i, s in enumerate(all_stations):
        if i in unregistered:
            lines += ["0 0 0"] * 5
            continue
        rows = [s.right, -s.down, -s.forward]
        lines += [f"{s.fx!r} {lens[0]!r} {lens[1]!r}", *map(words, rows), words([-np.dot(row, s.eye) for row in rows])]
    lines += ["0 0 5", "255 0 0", "1 0 12 3.5 -2.5"] * 2
    folder.mkdir(parents=True, exist_ok=True)
    (folder / list_name).write_text("".join(f"images/{s.name} 0 {s.fx}\n" for s in all_stations), encoding="utf-8")
    path = folder / "bundle.out"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def bundler_pixels(s: Station, lens, points):
    x, y, z = s.along(points).T
    p = -np.stack([x, -y], axis=1) / -z[:, None]  # y up, z backwards
    r2 = (p**2).sum(axis=1, keepdims=True)
    p = s.fx * (1 + lens[0] * r2 + lens[1] * r2**2) * p
    return np.stack([WIDTH / 2 + p[:, 0], HEIGHT / 2 - p[:, 1]], axis=1)


def quaternion(rows) -> np.ndarray:
    """w x y z of a rotation, by its trace and the differences across its diagonal."""
    R = np.array(rows)
    w = np.sqrt(max(1 + np.trace(R), 1e-12)) / 2
    return np.array([w, *(np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4 * w))])


def nvm(folder: Path, all_stations, radial=0.0, fixed="", more="") -> Path:
    """Names with their blanks as quotation marks; points whose lines are long."""
    lines = [f"NVM_V3 {fixed}".strip(), "", str(len(all_stations))]
    for s in all_stations:
        rows, _ = world_to_camera(s)
        name = f"images/{s.name}".replace(" ", '"')
        lines.append(f"{name}\t{s.fx!r} {words(quaternion(rows))} {words(s.eye)} {radial!r} 0 ")
    lines += ["", "2", *["1 2 3 255 0 0 700 " + "0 12 3.5 -2.5 " * 300] * 2, more or "0", "", "#the last part"]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "model.nvm"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def nvm_pixels(s: Station, radial, points):
    """The measured point whose m (1 + r |m|^2) is the ideal one, by fixed-point iteration."""
    x, y, z = s.along(points).T
    ideal = np.stack([x / z, y / z], axis=1)
    m = ideal
    for _ in range(200):
        m = ideal / (1 + radial * (m**2).sum(axis=1, keepdims=True))
    return np.array([WIDTH / 2, HEIGHT / 2]) + s.fx * m


METASHAPE_LENS = {
    "k1": -0.05, "k2": 0.03, "k3": -0.01, "k4": 0.004, "p1": 0.002, "p2": -0.003, "b1": 1.5, "b2": 0.75
}  # fmt: skip
SPIN = np.array([[0.0, -1, 0], [0.6, 0, -0.8], [0.8, 0, 0.6]])
SHIFT, SCALE = np.array([5.0, -2.0, 1.0]), 2.5


def metashape_sensor(s: Station, number: int, lens, kind: str) -> str:
    inner = "".join(f"<{key}>{value!r}</{key}>" for key, value in lens.items())
    return (
        f'<sensor id="{number}" label="unknown" type="{kind}"><resolution width="{WIDTH}" height="{HEIGHT}"/>'
        f'<calibration type="{kind}" class="initial"><f>7</f></calibration>'
        f'<calibration type="{kind}" class="adjusted"><resolution width="{WIDTH}" height="{HEIGHT}"/><f>{s.fy!r}</f>'
        f"<cx>{s.cx - WIDTH / 2!r}</cx><cy>{s.cy - HEIGHT / 2!r}</cy>{inner}</calibration></sensor>"
    )


def metashape(folder: Path, all_stations, lens=None, kind="frame", place="component", extra="", shift=SHIFT) -> Path:
    """Cameras in a chunk whose frame is turned, scaled and shifted against the world. place: what has the transform."""
    lens = {"b1": -1.5} if lens is None else lens  # fx - fy
    sensors, cameras = "", ""
    for i, s in enumerate(all_stations):
        sensors += metashape_sensor(s, i, lens, kind)
        inside = [SPIN.T @ axis for axis in (s.right, s.down, s.forward)]
        pose = np.eye(4)
        for column, axis in enumerate(inside):
            pose[:3, column] = axis
        pose[:3, 3] = SPIN.T @ (s.eye - SHIFT) / SCALE
        label = s.name.removesuffix(".png")
        cameras += (
            f'<camera id="{i}" sensor_id="{i}" component_id="0" label="{label}"><transform>{words(pose)}</transform>'
            "<orientation>1</orientation></camera>"
        )
    cameras = f'<camera id="70" sensor_id="0" label="lost"/>{cameras}{extra}'
    transform = (
        f'<transform><rotation locked="true">{words(SPIN)}</rotation><translation>{words(shift)}</translation>'
        f"<scale>{SCALE}</scale></transform>"
    )
    component = f'<component id="0">{transform if place == "component" else ""}</component>'
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "cameras.xml"
    path.write_text(
        f'<?xml version="1.0" encoding="UTF-8"?>\n<document version="2.0.0"><chunk label="Chunk 1" enabled="true">'
        f"<sensors>{sensors}</sensors><components>{component}</components>"
        f'<cameras><group id="0" label="g">{cameras}</group></cameras>{transform if place == "chunk" else ""}'
        "</chunk></document>",
        encoding="utf-8",
    )
    return path


def metashape_pixels(s: Station, lens, kind, points):
    """The manual's equations as printed."""
    x, y, z = s.along(points).T
    x, y = x / z, y / z
    if kind != "frame":
        r0 = np.hypot(x, y)
        theta = np.arctan(r0)
        length = 2 * np.sin(theta / 2) if kind == "equisolid_fisheye" else theta
        x, y = x * length / r0, y * length / r0
    get = lambda key: lens.get(key, 0.0)  # noqa: E731
    r2 = x**2 + y**2
    radial = 1 + get("k1") * r2 + get("k2") * r2**2 + get("k3") * r2**3 + get("k4") * r2**4
    u = x * radial + get("p1") * (r2 + 2 * x**2) + 2 * get("p2") * x * y
    v = y * radial + get("p2") * (r2 + 2 * y**2) + 2 * get("p1") * x * y
    return np.stack([s.cx + u * s.fy + u * get("b1") + v * get("b2"), s.cy + v * s.fy], axis=1)


OPENCV_LENSES = {
    4: (-0.05, 0.02, 0.003, -0.002),
    5: (-0.05, 0.02, 0.003, -0.002, 0.01),
    8: (-0.05, 0.02, 0.003, -0.002, 0.01, 0.02, -0.01, 0.005),
    14: (-0.05, 0.02, 0.003, -0.002, 0.01, 0.02, -0.01, 0.005, 0.002, -0.001, 0.003, 0.001, 0.01, -0.02),
}


def yaml_matrix(name: str, values, indent: str = "") -> str:
    a = np.atleast_2d(np.asarray(values, float))
    numbers = [repr(float(v)) for v in a.ravel()]
    lines = [", ".join(numbers[i : i + 4]) for i in range(0, len(numbers), 4)]
    data = f",\n{indent}       ".join(lines)
    return (
        f"{indent}{name}: !!opencv-matrix\n{indent}   rows: {a.shape[0]}\n{indent}   cols: {a.shape[1]}\n"
        f"{indent}   dt: d\n{indent}   data: [ {data} ]\n"
    )


def xml_matrix(name: str, values) -> str:
    a = np.atleast_2d(np.asarray(values, float))
    return (
        f'<{name} type_id="opencv-matrix">\n  <rows>{a.shape[0]}</rows>\n  <cols>{a.shape[1]}</cols>\n  <dt>d</dt>\n'
        f"  <data>\n    {words(a)}</data></{name}>\n"
    )


def opencv_numbers(s: Station, lens):
    """K with pixel centres from 0, the coefficients, R, and T as a column."""
    rows, t = world_to_camera(s)
    K = [[s.fx, 0, s.cx - 0.5], [0, s.fy, s.cy - 0.5], [0, 0, 1]]
    return K, [lens], rows, np.array(t)[:, None]


def opencv_files(folder: Path, all_stations, lens=(0.0,) * 5, kind="yml") -> Path:
    """One file a camera, named as its photograph."""
    folder.mkdir(parents=True, exist_ok=True)
    for s in all_stations:
        matrix = yaml_matrix if kind == "yml" else xml_matrix
        K, D, R, T = opencv_numbers(s, lens)
        body = matrix("camera_matrix", K) + matrix("distortion_coefficients", D) + matrix("R", R) + matrix("T", T)
        if kind == "yml":
            body = f'%YAML:1.0\n---\ncalibration_time: "Thu 21 Nov 2024 # not a comment"\nimage_width: {WIDTH}\n' + (
                f"image_height: {HEIGHT} # pixels\nflags: 0\n{body}avg_reprojection_error: 3.2e-01\n"
            )
        else:
            body = (
                f'<?xml version="1.0"?>\n<opencv_storage>\n<calibration_time>"Thu 21 Nov"</calibration_time>\n'
                f"<image_width>{WIDTH}</image_width><image_height>{HEIGHT}</image_height>{body}</opencv_storage>\n"
            )
        (folder / f"{s.name.removesuffix('.png')}.{kind}").write_text(body, encoding="utf-8")
    return folder


def opencv_mapping(s: Station, lens=(0.0,) * 5) -> dict:
    K, _, R, T = opencv_numbers(s, lens)
    return {
        "size": [WIDTH, HEIGHT], "matrix": np.array(K).tolist(), "distortions": list(lens),
        "rotation": np.array(R).tolist(), "translation": np.ravel(T).tolist(),
    }  # fmt: skip


def plain_yaml(folder: Path, all_stations) -> Path:
    """As PyYAML writes a dict: no head, and lists that are shared as aliases."""
    size, lens = [WIDTH, HEIGHT], [0.0] * 5
    cameras = {s.name[:-4]: opencv_mapping(s) | {"size": size, "distortions": lens} for s in all_stations}
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "rig.yaml"
    path.write_text(yaml.safe_dump(cameras))
    assert "*id001" in path.read_text()
    return path


def toml(folder: Path, all_stations) -> Path:
    """As Caliscope and Anipose write it: numbers, and names where there are any; rotations as vectors."""
    lines = []
    for i, s in enumerate(all_stations):
        values = opencv_mapping(s) | {
            "name": s.name[:-4],
            "rotation": axis_angle(world_to_camera(s)[0]).ravel().tolist(),
        }
        lines += [f"[cam_{i}]", *(f"{key} = {json.dumps(value)}" for key, value in values.items()), ""]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "calibration.toml"
    path.write_text("\n".join([*lines, "[metadata]", "adjusted = false", "error = 0.57"]))
    return path


def easymocap(folder: Path, all_stations) -> Path:
    """intri.yml and extri.yml as EasyMocap writes them: Windows line ends, a list of names, rotation twice."""
    intri = extri = "%YAML:1.0\n---\nnames:\n" + "".join(f'  - "{s.name[:-4]}"\n' for s in all_stations)
    for s in all_stations:
        K, D, R, T = opencv_numbers(s, (0.0,) * 5)
        key = s.name[:-4]
        intri += yaml_matrix(f"K_{key}", K) + yaml_matrix(f"dist_{key}", D)
        extri += yaml_matrix(f"R_{key}", axis_angle(R)) + yaml_matrix(f"Rot_{key}", R) + yaml_matrix(f"T_{key}", T)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "intri.yml").write_bytes(intri.replace("\n", "\r\n").encode())
    (folder / "extri.yml").write_bytes(extri.replace("\n", "\r\n").encode())
    return folder / "extri.yml"


def axis_angle(R) -> np.ndarray:
    """(3, 1): the axis from the eigenvector of 1, the angle from the trace."""
    R = np.array(R)
    angle = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * np.sin(angle))
    return (axis * angle)[:, None]


def projections(folder: Path, all_stations, ending="_P.txt", skew=0.0, factors=(1.0, -2.0, 1e-4, 3e5)) -> Path:
    """Rows of P are dot products with the directions, times a factor that means nothing."""
    folder.mkdir(parents=True, exist_ok=True)
    for s, factor in zip(all_stations, factors, strict=False):
        rows = [s.fx * s.right + skew * s.down + s.cx * s.forward, s.fy * s.down + s.cy * s.forward, s.forward]
        text = "\n".join(words(factor * np.array([*row, -np.dot(row, s.eye)])) for row in rows)
        head = "CONTOUR\n" if ending == ".txt" else ""
        (folder / f"{s.name.removesuffix('.png')}{ending}").write_text(head + text + "\n", encoding="utf-8")
    return folder


def deepview(folder: Path, all_stations, kind="perspective", radial=(0.0, 0.0, 0.0), ending="") -> Path:
    cameras = []
    for s in all_stations:
        rows, _ = world_to_camera(s)
        cameras.append({
            "name": s.name.removesuffix(".png") + ending, "position": s.eye.tolist(),
            "orientation": axis_angle(rows).ravel().tolist(), "focal_length": s.fx, "pixel_aspect_ratio": s.fy / s.fx,
            "principal_point": [s.cx, s.cy], "width": float(WIDTH), "height": float(HEIGHT),
            "radial_distortion": list(radial), "projection_type": kind,
        })  # fmt: skip
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "models.json"
    path.write_text(json.dumps(cameras), encoding="utf-8")
    return path


def realitycapture(folder: Path, all_stations, lens=None, head="#cameras 4\n", separator=",") -> Path:
    """Heading clockwise from north, pitch up from straight down, roll to the right, of the directions alone."""
    columns = [
        "#name",
        "x",
        "y",
        "alt",
        "heading",
        "pitch",
        "roll",
        "f",
        "px",
        "py",
        "k1",
        "k2",
        "k3",
        "k4",
        "t1",
        "t2",
    ]
    lines = [separator.join(columns)]
    for s in all_stations:
        up = -s.down
        heading, pitch = np.degrees(np.arctan2(up[0], up[1])), np.degrees(np.arcsin(up[2]))
        roll = np.degrees(np.arctan2(-s.right[2], -s.forward[2]))
        side = max(WIDTH, HEIGHT)
        values = [*s.eye, heading, pitch, roll, s.fx * 36 / side, (s.cx - WIDTH / 2) / side, (s.cy - HEIGHT / 2) / side]
        values += [(lens or {}).get(key, 0.0) for key in columns[-6:]]
        lines.append(separator.join([s.name, *(repr(float(v)) for v in values)]))
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "alignment.csv"
    text = "\n".join(lines)
    path.write_text(head + (text.replace(".", ",").replace(",png", ".png") if separator == ";" else text) + "\n")
    return path
