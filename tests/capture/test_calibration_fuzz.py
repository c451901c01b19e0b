"""Valid calibrations of any make are read as the cameras that were written into them: none differs silently.

The cameras are directions (`Station`), and pixels are what each format's own words say of them; those of COLMAP's
models come from COLMAP.
"""

from __future__ import annotations

import json
import math
import shutil
import struct
from pathlib import Path

import numpy as np
import pycolmap
from hypothesis import assume
from hypothesis import strategies as st

from eigenfield.capture.readers.bundler import read_bundler
from eigenfield.capture.readers.colmap import COLMAP_ALL_MODELS, COLMAP_MODELS, COLMAP_UNREAD_MODELS, read_colmap
from eigenfield.capture.readers.deepview import read_deepview
from eigenfield.capture.readers.llff import read_llff
from eigenfield.capture.readers.metashape import METASHAPE_LENS_MODELS, read_metashape
from eigenfield.capture.readers.middlebury import read_middlebury
from eigenfield.capture.readers.opencv import read_opencv
from eigenfield.capture.readers.projections import read_projections
from eigenfield.capture.readers.realitycapture import read_realitycapture
from eigenfield.capture.readers.strecha import read_strecha
from eigenfield.capture.readers.transforms import read_transforms
from support import calibrations as write
from support.calibrations import HEIGHT, WIDTH, Station, bundler_pixels, metashape_pixels, world_to_camera
from support.fuzzed import fuzzed
from support.readers import check_lens, stem

NAMES = ("a0", "b 1", "ü2", "IMG_0003", "x.y", "7", "long name (4)")
ASCII_NAMES = ("a0", "b-1", "IMG_0003", "x.y", "7", "c_4")
SMALL = st.integers(-100, 100)
COEFFICIENT = SMALL.map(lambda n: n / 1000)


def turned(quaternion):
    """Rows right, down and forward of a camera, from a quaternion w, x, y, z: v + 2 w (u x v) + 2 u x (u x v)."""
    w, u = quaternion[0], np.array(quaternion[1:])
    axes = [v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v)) for v in np.eye(3)]
    return np.array(axes).T


def draw_quaternion(data):
    q = np.array(data.draw(st.lists(st.integers(-9, 9), min_size=4, max_size=4)), float)
    assume(np.any(q))
    return q / np.linalg.norm(q)


def draw_stations(data, *, square=False, centred=False, names=NAMES, one_lens=False):
    """Three to five cameras anywhere, and the quaternion of each: world to camera."""
    draw = data.draw
    count = draw(st.integers(3, 5))
    far = draw(st.sampled_from([1, 1, 1000, 1e-3]))
    files = draw(st.permutations(names))[:count]
    found, quaternions, optics = [], [], None
    for name in files:
        q = draw_quaternion(data)
        if optics is None or not one_lens:
            fx = draw(st.integers(40, 400)) * 0.75
            fy = fx if square else fx * draw(st.integers(80, 120)) / 100
            cx, cy = WIDTH / 2, HEIGHT / 2
            if not centred:
                cx, cy = cx + draw(st.integers(-80, 80)) / 8, cy + draw(st.integers(-80, 80)) / 8
            optics = fx, fy, cx, cy
        eye = np.array(draw(st.lists(SMALL, min_size=3, max_size=3))) / 8 * far
        found.append(Station(f"{name}.png", eye, *turned(q), *optics))
        quaternions.append(q)
    return found, quaternions


def points_before(s):
    """Points that a camera sees in its picture, at several depths."""
    columns, rows = np.meshgrid([3.25, WIDTH / 2, WIDTH - 1.5], [0.75, HEIGHT / 2, HEIGHT - 4])
    depth = np.array([0.5, 3, 40])[np.arange(columns.size) % 3]
    rays = [(columns.ravel() - s.cx) / s.fx, (rows.ravel() - s.cy) / s.fy, np.ones(columns.size)]
    x, y, z = np.array(rays) * depth
    return s.eye + x[:, None] * s.right + y[:, None] * s.down + z[:, None] * s.forward


def check_cameras(calibration, truth, lenses=None, tolerance=2e-6, left_out=()):
    """Every entry is the camera that its name says.

    lenses: of each name, what its photograph shows of points; None where there is no distortion.
    """
    by_name = {stem_of(s.name): s for s in truth if s.name not in left_out}
    assert sorted(map(stem, calibration.entries)) == sorted(by_name)
    for entry in calibration.entries:
        s = by_name[stem(entry)]
        width, height = entry.intrinsics.width or WIDTH, entry.intrinsics.height or HEIGHT
        camera = entry.camera(width, height, calibration.path)
        scale, away = WIDTH / width, 1 + np.abs(s.eye).max()
        assert np.abs(camera.centre - s.eye).max() < tolerance * away
        assert camera.K[0, 1] == 0
        points = points_before(s)
        pixels, depth = camera.project(points)
        assert (depth > 0).all()
        assert np.abs(pixels * scale - s.pixels(points)).max() < 50 * tolerance * away
        shown = (lenses or {}).get(s.name)
        if shown is None:
            assert entry.lens is None or entry.lens.is_identity
        else:
            check_lens(entry, shown, tolerance=1e-3 * away)


def stem_of(name):
    return name.removesuffix(".png")


def emptied(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


# COLMAP


def colmap_camera(data, model, number):
    """A camera of COLMAP's own, which projects as COLMAP does."""
    names = pycolmap.Camera(model=model, width=WIDTH, height=HEIGHT, params=[1.0] * COLMAP_ALL_MODELS[model][1])
    params = []
    for name in (word.strip() for word in names.params_info.split(",")):
        if name in ("f", "fx", "fy"):
            params.append(data.draw(st.integers(60, 400)) * 0.75)
        elif name in ("cx", "cy"):
            params.append((WIDTH if name == "cx" else HEIGHT) / 2 + data.draw(st.integers(-80, 80)) / 8)
        else:
            params.append(data.draw(COEFFICIENT))
    return pycolmap.Camera(model=model, width=WIDTH, height=HEIGHT, params=params, camera_id=number)


def check_colmap(folder, data):
    """Every model, of one camera or several, binary and text, by COLMAP itself or by hand; with points or without."""
    draw = data.draw
    stations, quaternions = draw_stations(data)
    kinds = [*COLMAP_MODELS] * 3 + [*COLMAP_UNREAD_MODELS]
    numbers = draw(st.lists(st.integers(1, 2**31 - 1), min_size=1, max_size=3, unique=True))
    cameras = [colmap_camera(data, draw(st.sampled_from(kinds)), number) for number in numbers]
    owner = [draw(st.sampled_from(cameras)) for _ in stations]
    truth, lenses, foreign = [], {}, []
    for s, camera in zip(stations, owner, strict=True):
        one = camera.params_info.split(",")[0].strip() == "f"
        f, rest = camera.params[0], camera.params[1:] if one else camera.params[2:]
        if "cx" not in camera.params_info:  # EQUIRECTANGULAR
            rest = [0.0, 0.0]
        truth.append(Station(s.name, s.eye, s.right, s.down, s.forward, f, f if one else camera.params[1], *rest[:2]))
        if camera.model.name in COLMAP_UNREAD_MODELS:
            foreign.append(s.name)
        elif camera.model.name == "PINHOLE" or (not np.any(rest[2:]) and "FISHEYE" not in camera.model.name):
            continue
        else:
            lenses[s.name] = lambda points, s=truth[-1], camera=camera: camera.img_from_cam(s.along(points))
    folder = emptied(folder / "model")
    if draw(st.booleans()):
        by_colmap(folder, draw, stations, quaternions, owner, cameras)
    else:
        by_hand(folder, draw, stations, quaternions, owner, cameras)
    assume(len(foreign) < len(stations))
    read = read_colmap(folder)
    check_cameras(read, truth, lenses, left_out=foreign)
    assert {error.code for error in read.errors} == ({"camera-model"} if foreign else set())


def by_colmap(folder, draw, stations, quaternions, owner, cameras):
    model = pycolmap.Reconstruction()
    for camera in cameras:
        model.add_camera_with_trivial_rig(camera)
    for number, (s, q, camera) in enumerate(zip(stations, quaternions, owner, strict=True), start=1):
        _, t = world_to_camera(s)
        image = pycolmap.Image(name=s.name, camera_id=camera.camera_id, image_id=number)
        pose = pycolmap.Rigid3d(pycolmap.Rotation3d([*q[1:], q[0]]), t)
        model.add_image_with_trivial_frame(image, pose)
    (model.write_text if draw(st.booleans()) else model.write_binary)(str(folder))


def by_hand(folder, draw, stations, quaternions, owner, cameras):
    """As the format's page says it, with whatever it allows."""
    images = list(enumerate(zip(stations, quaternions, owner, strict=True), start=draw(st.integers(1, 9))))
    images = draw(st.permutations(images))
    counts = [draw(st.integers(0, 3)) for _ in images]
    if draw(st.booleans()):
        out = struct.pack("<Q", len(cameras))
        for c in cameras:
            number = COLMAP_ALL_MODELS[c.model.name][0]
            out += struct.pack(f"<IiQQ{len(c.params)}d", c.camera_id, number, c.width, c.height, *c.params)
        (folder / "cameras.bin").write_bytes(out)
        out = struct.pack("<Q", len(images))
        for (number, (s, q, c)), count in zip(images, counts, strict=True):
            out += struct.pack("<I7dI", number, *q, *world_to_camera(s)[1], c.camera_id) + s.name.encode() + b"\0"
            out += struct.pack("<Q", count) + struct.pack("<ddQ", 1.5, -2.5, 2**64 - 1) * count
        (folder / "images.bin").write_bytes(out)
        return
    line_end, comment = draw(st.sampled_from(["\n", "\r\n"])), draw(st.sampled_from(["", "# a line", "#"]))
    lines = [comment] if comment else []
    lines += [f"{c.camera_id} {c.model.name} {c.width} {c.height} {write.words(c.params)}" for c in cameras]
    (folder / "cameras.txt").write_bytes((line_end.join(lines) + line_end).encode())
    lines = [comment] if comment else []
    for (number, (s, q, c)), count in zip(images, counts, strict=True):
        sign = draw(st.sampled_from([1, -1]))  # the same rotation
        lines.append(f"{number} {write.words([*(sign * q), *world_to_camera(s)[1]])} {c.camera_id} {s.name}")
        lines.append(" ".join(["1.5 -2.5 -1"] * count))
    (folder / "images.txt").write_bytes((line_end.join(lines) + line_end * draw(st.integers(0, 1))).encode())


# transforms.json


def brown(s, k, points):
    """OpenCV's model as its page prints it. k: k1 k2 p1 p2 k3 k4 k5 k6."""
    k1, k2, p1, p2, k3, k4, k5, k6 = (*k, 0, 0, 0, 0, 0, 0, 0, 0)[:8]
    x, y, z = s.along(points).T
    x, y = x / z, y / z
    r2 = x**2 + y**2
    radial = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2)
    v = y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y
    return np.stack([s.fx * u + s.cx, s.fy * v + s.cy], axis=1)


def fisheye(s, k, points):
    """The polynomial of the angle to the axis."""
    x, y, z = s.along(points).T
    length = np.hypot(x, y)
    theta = np.arctan2(length, z)
    r = theta * sum(c * theta ** (2 * i) for i, c in enumerate((1.0, *k)))
    with np.errstate(invalid="ignore"):
        scale = np.where(length > 0, r / length, 1 / z)
    return np.stack([s.fx * x * scale + s.cx, s.fy * y * scale + s.cy], axis=1)


def check_transforms(folder, data):
    """Intrinsics and lens of a frame or of the file, in all words; three or four rows; an applied transform."""
    draw = data.draw
    shared = draw(st.booleans())
    square, centred = draw(st.booleans()), draw(st.booleans())
    stations, _ = draw_stations(data, square=square, centred=centred, one_lens=shared)
    top, frames, lenses = {"aabb_scale": 16, "ply_file_path": "points.ply"}, [], {}
    words = lens = None
    turn, shift, scale = np.eye(3), np.zeros(3), 1.0
    if draw(st.booleans()):
        turn, shift = turned(draw_quaternion(data)), np.array(draw(st.lists(SMALL, min_size=3, max_size=3))) / 4
        scale = draw(st.sampled_from([1.0, 0.25, 3.0]))
        rows = [[*row, s] for row, s in zip(turn.tolist(), shift.tolist(), strict=True)]
        top["applied_transform"] = rows + [[0, 0, 0, 1]] * draw(st.integers(0, 1))
        if scale != 1 or draw(st.booleans()):
            top["applied_scale"] = scale
    for s in stations:
        if words is None or not shared:
            words, lens = draw_intrinsics(data, s), draw_lens(data)
        matrix = np.eye(4)
        matrix[:3, :3] = turn @ np.stack([s.right, -s.down, -s.forward], axis=1)
        matrix[:3, 3] = scale * (turn @ s.eye + shift)
        path = draw(st.sampled_from(["{}.png", "images/{}.png", "./images/{}.png", "images\\{}.png", "../c/{}.png"]))
        frame = {
            "file_path": path.format(stem_of(s.name)),
            "transform_matrix": matrix[: draw(st.integers(3, 4))].tolist(),
        }
        frame |= {"sharpness": 1.5} if draw(st.booleans()) else {}
        if shared:
            top |= words | lens[0]
        else:
            frame |= words | lens[0]
        frames.append(dict(draw(st.permutations(list(frame.items())))))
        if lens[1] is not None:
            kind, k = lens[1], lens[2]
            lenses[s.name] = lambda points, s=s, kind=kind, k=k: kind(s, k, points)
    top["frames"] = frames
    text = json.dumps(top, indent=draw(st.sampled_from([None, 1])), ensure_ascii=draw(st.booleans()))
    path = emptied(folder / "json") / "transforms.json"
    path.write_bytes(draw(st.sampled_from([b"", b"\xef\xbb\xbf"])) + text.encode())
    read = read_transforms(path)
    assert read.errors == ()
    check_cameras(read, stations, lenses, tolerance=5e-6 * (1 + np.abs(shift).max()))


def draw_intrinsics(data, s):
    """Focal length, size and principal point in one of the forms that say the same."""
    draw = data.draw
    angles = [2 * math.atan(side / (2 * f)) for side, f in ((WIDTH, s.fx), (HEIGHT, s.fy))]
    focal = {"fl_x": s.fx, "fl_y": s.fy} if s.fx != s.fy or draw(st.booleans()) else {"fl_x": s.fx}
    both = ["camera_angle_x", "camera_angle_y"]
    forms = [focal, focal | dict(zip(both, angles, strict=True)), dict(zip(both, angles, strict=True))]
    forms.append({"x_fov": math.degrees(angles[0]), "y_fov": math.degrees(angles[1])})
    if s.fx == s.fy:
        forms.append({"camera_angle_x": angles[0]})
    words = dict(draw(st.sampled_from(forms)))
    words |= draw(st.sampled_from([{"w": WIDTH, "h": HEIGHT}, {"w": float(WIDTH), "h": float(HEIGHT)}]))
    if (s.cx, s.cy) != (WIDTH / 2, HEIGHT / 2) or draw(st.booleans()):
        words |= {"cx": s.cx, "cy": s.cy}
    return words


def draw_lens(data):
    """A lens in the words of nerfstudio, instant-ngp or COLMAP: the words, the model, and its coefficients."""
    draw = data.draw
    number = {key: draw(COEFFICIENT) for key in ("k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2")}
    get = number.get
    kind = draw(st.sampled_from(["none", "brown", "list", "rational", "fisheye", "fisheye list", "flag"]))
    if kind == "none":
        return draw(st.sampled_from([{}, {"camera_model": "PINHOLE"}, {"camera_model": "OPENCV", "k1": 0.0}])), None, ()
    flat = [get(key) for key in ("k1", "k2", "p1", "p2", "k3")]
    if kind in ("brown", "list"):
        keys = draw(st.sampled_from([("k1",), ("k1", "k2"), ("k1", "k2", "p1", "p2"), ("k1", "k2", "k3", "p1", "p2")]))
        flat = [get(key) if key in keys else 0.0 for key in ("k1", "k2", "p1", "p2", "k3")]
        model = draw(st.sampled_from([{}, {"camera_model": "OPENCV"}]))
        words = {key: get(key) for key in keys}
        if kind == "list":
            words = {"distortion_params": [flat[0], flat[1], flat[4], 0.0, flat[2], flat[3]]}
        return model | words, brown if any(flat) else None, flat
    if kind == "rational":
        k = [*flat, get("k4"), get("k5"), get("k6")]
        return {"camera_model": "FULL_OPENCV", **number}, brown if any(k) else None, k
    k = [get(key) for key in ("k1", "k2", "k3", "k4")]
    if kind == "fisheye list":
        return {"camera_model": "OPENCV_FISHEYE", "distortion_params": [*k, 0.0, 0.0]}, fisheye, k
    words = dict(zip(("k1", "k2", "k3", "k4"), k, strict=True))
    return ({"is_fisheye": True} if kind == "flag" else {"camera_model": "OPENCV_FISHEYE"}) | words, fisheye, k


# programs with a lens of their own


def check_metashape(folder, data):
    """Camera types, any of the lens parameters, where the transform stands."""
    draw = data.draw
    kind = draw(st.sampled_from([*METASHAPE_LENS_MODELS]))
    stations, _ = draw_stations(data, names=ASCII_NAMES)
    lens = {
        key: draw(COEFFICIENT) for key in sorted(draw(st.sets(st.sampled_from(["k1", "k2", "k3", "k4", "p1", "p2"]))))
    }
    lens |= {"b1": stations[0].fx - stations[0].fy}
    stations = [
        Station(s.name, s.eye, s.right, s.down, s.forward, s.fy + lens["b1"], s.fy, s.cx, s.cy) for s in stations
    ]
    assume(all(s.fx > 30 for s in stations))
    if draw(st.booleans()):
        lens["b2"] = draw(SMALL) / 50
    place = draw(st.sampled_from(["component", "chunk"]))
    path = write.metashape(emptied(folder / "metashape"), stations, lens, kind, place)
    lenses = {}
    bent = kind not in ("frame",) or any(value for key, value in lens.items() if key != "b1")
    if bent:
        lenses = {s.name: lambda points, s=s: metashape_pixels(s, lens, kind, points) for s in stations}
    read = read_metashape(path)
    assert read.errors == ()
    check_cameras(read, stations, lenses)


def check_bundler(folder, data):
    """Two radial coefficients, cameras that were not registered, names of the list, quoted names."""
    draw = data.draw
    stations, _ = draw_stations(data, square=True, centred=True, names=ASCII_NAMES)
    lens = (draw(COEFFICIENT), draw(COEFFICIENT))
    lost = draw(st.sets(st.integers(0, len(stations) - 1), max_size=len(stations) - 1))
    name = draw(st.sampled_from(["list.txt", "list_imgs.txt", "bundle.list.txt", "pictures of today.txt"]))
    path = write.bundler(emptied(folder / "bundler"), stations, lens, lost, name)
    if draw(st.booleans()):
        listed = path.parent / name
        listed.write_text("".join(f'"images/{s.name}"\n' for s in stations))
    text = path.read_text().replace("v0.3", draw(st.sampled_from(["v0.3", "v0.4"])))
    path.write_bytes(text.replace("\n", draw(st.sampled_from(["\n", "\r\n"]))).encode())
    lenses = {s.name: lambda points, s=s: bundler_pixels(s, lens, points) for s in stations} if any(lens) else {}
    check_cameras(read_bundler(path), stations, lenses, left_out={stations[i].name for i in lost})


def check_realitycapture(folder, data):
    """Six lens parameters, commas or semicolons, with the line of counts and without."""
    draw = data.draw
    stations, _ = draw_stations(data, square=True, names=[name.replace(".", "_") for name in ASCII_NAMES])
    assume(all(abs(s.down[2]) < 0.999 for s in stations))  # where heading and roll turn about one axis
    keys = ("k1", "k2", "k3", "k4", "t1", "t2")
    lens = {key: draw(COEFFICIENT) for key in draw(st.sets(st.sampled_from(keys)))}
    head, separator = draw(st.sampled_from(["", f"#cameras {len(stations)}\n"])), draw(st.sampled_from([",", ";"]))
    place = emptied(folder / "csv")
    write.photographs(place, [s.name for s in stations])
    path = write.realitycapture(place, stations, lens, head, separator)
    k = {"k1": "k1", "k2": "k2", "k3": "k3", "k4": "k4", "p1": "t2", "p2": "t1"}
    own = {ours: lens.get(theirs, 0.0) for ours, theirs in k.items()}
    lenses = {}
    if any(own.values()):
        lenses = {s.name: lambda points, s=s: metashape_pixels(s, own, "frame", points) for s in stations}
    read = read_realitycapture(path)
    assert read.errors == ()
    check_cameras(read, stations, lenses)


def check_deepview(folder, data):
    """Fisheye and perspective, of any number of radial coefficients; orientations are a vector."""
    draw = data.draw
    stations, quaternions = draw_stations(data)
    kind = draw(st.sampled_from(["fisheye", "perspective"]))
    radial = draw(st.lists(COEFFICIENT, max_size=4 if kind == "fisheye" else 3))
    cameras = []
    for s, q in zip(stations, quaternions, strict=True):
        angle, length = 2 * math.atan2(np.linalg.norm(q[1:]), q[0]), np.linalg.norm(q[1:])
        vector = q[1:] / length * angle if length > 0 else np.zeros(3)
        camera = {
            "name": draw(st.sampled_from(["{}", "{}.png"])).format(stem_of(s.name)), "position": s.eye.tolist(),
            "orientation": vector.tolist(), "focal_length": s.fx, "pixel_aspect_ratio": s.fy / s.fx,
            "principal_point": [s.cx, s.cy], "width": draw(st.sampled_from([WIDTH, float(WIDTH)])), "height": HEIGHT,
            "radial_distortion": radial, "projection_type": kind,
        }  # fmt: skip
        cameras.append(dict(draw(st.permutations(list(camera.items())))))
    path = emptied(folder / "rig") / "models.json"
    path.write_text(json.dumps(cameras, indent=draw(st.sampled_from([None, 2]))), encoding="utf-8")
    lenses = {}
    if kind == "fisheye":
        lenses = {s.name: lambda points, s=s: fisheye(s, radial, points) for s in stations}
    elif any(radial):
        k1, k2, k3 = (*radial, 0.0, 0.0, 0.0)[:3]
        lenses = {s.name: lambda points, s=s: brown(s, [k1, k2, 0, 0, k3], points) for s in stations}
    read = read_deepview(path)
    assert read.errors == ()
    check_cameras(read, stations, lenses)


def check_llff(folder, data):
    """Types, byte orders, either order of the array, photographs reduced or not."""
    draw = data.draw
    stations, _ = draw_stations(data, square=True, centred=True, one_lens=draw(st.booleans()))
    stations = sorted(stations, key=lambda s: s.name)
    place = emptied(folder / "llff")
    names = [f"{i:03d}.png" for i in range(len(stations))]  # rows have none
    stations = [Station(name, *list(vars(s).values())[1:]) for name, s in zip(names, stations, strict=True)]
    write.photographs(place / "images", names)
    kind = draw(st.sampled_from(["<f8", ">f8", "<f4"]))
    near = draw(st.integers(1, 50)) / 8
    bounds = near, near + draw(st.integers(1, 900))
    path = write.llff(place, stations, draw(st.sampled_from([1, 4, 8])), bounds, kind, draw(st.booleans()))
    read = read_llff(path)
    assert [entry.bounds for entry in read.entries] == [bounds] * len(stations)
    check_cameras(read, stations, tolerance=2e-6 if kind != "<f4" else 2e-5)


# formats without a choice of words


def check_plain(folder, data):
    """Middlebury, Strecha, 3x4 matrices and OpenCV's files."""
    draw = data.draw
    kind = draw(st.sampled_from(["middlebury", "strecha", "projections", "opencv", "xml"]))
    stations, _ = draw_stations(data, names=ASCII_NAMES)
    place, lenses = emptied(folder / "plain"), {}
    if kind == "middlebury":
        read = read_middlebury(write.middlebury(place, stations))
    elif kind == "strecha":
        read = read_strecha(write.strecha(place, stations))
    elif kind == "projections":
        factors = draw(st.lists(st.sampled_from([1.0, -1.0, 1e-5, -3e4]), min_size=5, max_size=5))
        read = read_projections(
            write.projections(place, stations, draw(st.sampled_from(["_P.txt", ".P"])), factors=factors)
        )
    else:
        count = draw(st.sampled_from([4, 5, 8]))
        k = [draw(COEFFICIENT) for _ in range(count)]
        read = read_opencv(write.opencv_files(place, stations, k, kind="yml" if kind == "opencv" else "xml"))
        if any(k):
            lenses = {s.name: lambda points, s=s: brown(s, k, points) for s in stations}
    assert read.errors == ()
    check_cameras(read, stations, lenses, tolerance=2e-5 if kind == "projections" else 2e-6)


test_colmap, test_many_colmap = fuzzed(check_colmap)
test_transforms, test_many_transforms = fuzzed(check_transforms)
test_metashape, test_many_metashape = fuzzed(check_metashape)
test_bundler, test_many_bundler = fuzzed(check_bundler)
test_realitycapture, test_many_realitycapture = fuzzed(check_realitycapture)
test_deepview, test_many_deepview = fuzzed(check_deepview)
test_llff, test_many_llff = fuzzed(check_llff)
test_plain, test_many_plain = fuzzed(check_plain)
