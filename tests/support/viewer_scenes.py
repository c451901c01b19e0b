"""Small scenes and reference pictures for the tests of the web viewer and of the OpenGL renderer.

    PYTHONPATH=tests python -m support.viewer_scenes FOLDER

writes into FOLDER

    scene.glb           5 x 5 cameras, 6 textures of 128 x 128 as PNG: every decoder reads the same codes
    avif.glb            the same, coded as AVIF
    line.glb            five cameras on a line
    harmonised.glb      with a gain and an offset for every camera, and the common exposure between them
    mixed.glb           the same, mixed between them
    held-out.glb        every third camera held out
    one.glb, four.glb   with that many textures, the first of scene.glb
    grey.glb            one channel, 5 textures
    names.glb           camera names that want to be HTML
    rights.glb          a title, an author, a licence and a source (`RIGHTS`), of which the title wants to be HTML
    plain.glb           a glTF file without eigen textures
    newer.glb, needs.glb, truncated.glb, damaged.glb, no-json.glb, not-ours.bin
    photographed.glb    scene.glb with cameras named as the files of capture/
    around.glb          twelve cameras around a column: no plane, no grid; two held out
    capture/            photographs of scene.glb's cameras (drawn by the software renderer) and transforms.json
    references.json     a list of pictures: {"scene", "file", "filter", "at": [X, Y] | null, "camera": name | null,
                        "free": {"K", "R", "t"} | null, "count": number | null, "snapped": bool, "width", "height"};
                        `free` is drawn with weights by the ray, `count` with the first eigen textures alone,
                        `snapped` of vertices where the browser's rasteriser has them
    weights.json        view weights and novel cameras at places in the array and beyond: a list of {"scene", "places":
                        [{"at": [X, Y], "weights": {mode: one for each encoded camera}, "camera": K, R, t in a row}]}
    *.png               the pictures, drawn with one sample a pixel
"""

from __future__ import annotations

import io
import json
import struct
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

import eigenfield as ef
import reference
from eigenfield.core.appearance import Appearance, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.rights import Rights
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.gltf import save
from eigenfield.rendering import ViewWeights, novel_camera, renderer_of, view_weights, viewpoint
from support.scenes import bumpy_square, encoded_triangles, float_basis, smooth_pictures

WIDTH, HEIGHT = 320, 240
SIDE = 128
PLACES = ((0.0, 0.0), (0.37, -0.21), (-0.93, 0.71))
RIGHTS = Rights(
    title='A "stone" & <img src=x onerror=alert(1)>',
    author="Ada " + "and a long list of others " * 12,
    licence="CC BY 4.0",
    source="https://example.org/stone",
)
SUBPIXELS = 16  # in which Chromium's software GPU places vertices: 4 bits, the fewest that OpenGL ES allows
FREE = ((0.35, -0.2, -1.9), (-0.6, 0.3, -4.5))  # eyes before and behind the view plane z = -3


def cameras(columns: int, rows: int) -> tuple[Camera, ...]:
    """Rectified cameras 0.4 apart on z = -3 that look along +z; the square fills most of their pictures."""
    made = []
    for row in range(rows):
        for column in range(columns):
            x, y = 0.4 * (column - (columns - 1) / 2), 0.4 * (row - (rows - 1) / 2)
            K = np.array([[330.0, 0, WIDTH / 2 + 110 * x], [0, 330, HEIGHT / 2 + 110 * y], [0, 0, 1]])
            made.append(Camera(K, np.eye(3), -np.array([x, y, -3.0]), WIDTH, HEIGHT))
    return tuple(made)


def scene(columns: int = 5, rows: int = 5, textures: int = 6, held_out: int = 0) -> Scene:
    """A bumpy square with a fine pattern; `held_out` n: every n-th camera takes no part."""
    views = cameras(columns, rows)
    held = np.zeros(len(views), bool)
    if held_out:
        held[1::held_out] = True
    plane = fit_view_plane(views)
    places = plane.coordinates([view.centre for view in views])
    random = np.random.default_rng(5)
    grain = random.uniform(-0.15, 0.15, (SIDE // 4, SIDE // 4, 3)).repeat(4, axis=0).repeat(4, axis=1)
    mean = np.clip(0.5 + 0.3 * smooth_pictures(1, SIDE, SIDE, 3)[0] + grain, 0, 1).astype(np.float32)
    basis = float_basis(int((~held).sum()), textures, SIDE, SIDE, 3)
    # weights that go smoothly over the plane, as those of real scenes do
    x, y = places[~held].T
    waves = np.stack([np.cos(np.pi * (k % 3 + 1) * x / 2 + k) + np.sin(k * y) for k in range(textures)], axis=1)
    spread = waves.std(axis=0)
    waves = (waves - waves.mean(axis=0)) / np.where(spread > 0, spread, 1)
    return Scene(
        proxy=Proxy(mesh=bumpy_square(24)),
        rig=Rig(
            names=tuple(f"view_{row}_{column}" for row in range(rows) for column in range(columns)),
            cameras=views,
            held_out=held,
            reference=len(views) // 2,
            view_plane=plane,
            triangles=encoded_triangles(places[~held]),
        ),
        appearance=Appearance(planes=(Plane(mean, (replace(basis, weights=waves.astype(np.float32)),)),)),
        settings={"textures": textures, "metresPerUnit": 0.5},
        scores={
            "uv": {"ssim": 0.91, "psnr": 30.5},
            "image": {"encoded": {"psnr": 33.25, "ssim": 0.951}, "held_out": None},
            "curve": [{"textures": n, "uv_ssim": round(0.7 + 0.035 * n, 3), "uv_psnr": 24.0 + n} for n in range(7)],
        },
        generator="eigenfield test",
    )


def grey_scene() -> Scene:
    """The first channel of a scene of 5 textures."""
    coloured = scene(textures=5)
    plane = coloured.appearance.planes[0]
    (basis,) = plane.bases
    alone = replace(basis, textures=basis.textures[..., :1], scale=basis.scale[:, :1], zero=basis.zero[:, :1])
    return replace(
        coloured,
        appearance=replace(coloured.appearance, planes=(Plane(np.ascontiguousarray(plane.mean[..., :1]), (alone,)),)),
    )


def around(count: int = 12) -> Scene:
    """A column of radius 1, seen by level cameras on a circle of radius 4 around it; the fourth and eighth held out.
    Up is -y, as in captures by COLMAP."""
    views = []
    for angle in 2 * np.pi * np.arange(count) / count:
        forward = np.array([-np.sin(angle), 0.0, np.cos(angle)])
        R = np.stack([np.cross([0.0, 1.0, 0.0], forward), [0.0, 1.0, 0.0], forward])
        K = np.array([[300.0, 0, WIDTH / 2], [0, 300, HEIGHT / 2], [0, 0, 1]])
        views.append(Camera(K, R, R @ forward * 4.0, WIDTH, HEIGHT))
    held = np.zeros(count, bool)
    held[[3, 7]] = True
    plane = fit_view_plane(views)
    encoded = count - int(held.sum())
    plain = scene(textures=4)
    mean, basis = plain.appearance.planes[0].mean, float_basis(encoded, 4, SIDE, SIDE, 3)
    return replace(
        plain,
        proxy=Proxy(_column()),
        rig=replace(
            plain.rig,
            names=tuple(f"round{number}.png" for number in range(1, count + 1)),
            cameras=tuple(views),
            held_out=held,
            reference=0,
            view_plane=plane,
            triangles=encoded_triangles(plane.coordinates([view.centre for view in views])[~held]),
        ),
        appearance=replace(plain.appearance, planes=(Plane(mean, (basis,)),)),
    )


def _column(steps: int = 24) -> Mesh:
    """A cylinder around y, open at both ends."""
    turn, height = np.meshgrid(np.linspace(0, 1, steps + 1), np.linspace(0, 1, 5))
    angle = 2 * np.pi * turn.ravel()
    vertices = np.stack([np.sin(angle), 2 * height.ravel() - 1, -np.cos(angle)], axis=1)
    corner = (np.arange(4)[:, None] * (steps + 1) + np.arange(steps)).ravel()
    right, below = corner + 1, corner + steps + 1
    triangles = np.concatenate([np.stack([corner, right, below], 1), np.stack([right, below + 1, below], 1)])
    uv = np.stack([0.02 + 0.96 * turn.ravel(), 0.02 + 0.96 * height.ravel()], axis=1)
    return Mesh(vertices.astype(np.float32), triangles.astype(np.int32), uv.astype(np.float32))


def write(folder: Path) -> None:
    """Write everything into `folder`, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    plain = scene()
    save(plain, folder / "scene.glb", codec="png", overwrite=True)
    save(plain, folder / "avif.glb", overwrite=True)
    save(scene(columns=5, rows=1), folder / "line.glb", codec="png", overwrite=True)
    save(scene(held_out=3), folder / "held-out.glb", codec="png", overwrite=True)
    for name, mixed in (("harmonised", False), ("mixed", True)):
        coloured = replace(plain.appearance, colours=_colours(25), mixed_colours=mixed)
        save(replace(plain, appearance=coloured), folder / f"{name}.glb", codec="png", overwrite=True)
    for name, textures in (("one", 1), ("four", 4)):
        save(scene(textures=textures), folder / f"{name}.glb", codec="png", overwrite=True)
    save(grey_scene(), folder / "grey.glb", codec="png", overwrite=True)
    photographed = tuple(f"{name}.png" for name in plain.rig.names)
    save(
        replace(plain, rig=replace(plain.rig, names=photographed)),
        folder / "photographed.glb",
        codec="png",
        overwrite=True,
    )
    save(around(), folder / "around.glb", codec="png", overwrite=True)
    hostile = ("</script><img src=x onerror=alert(1)>", '"><svg onload=alert(2)>', "a&b<c>'d'", "é中 x")
    save(
        replace(plain, rig=replace(plain.rig, names=hostile + plain.rig.names[4:])),
        folder / "names.glb",
        codec="png",
        overwrite=True,
    )
    save(replace(plain, rights=RIGHTS), folder / "rights.glb", codec="png", overwrite=True)
    _bad_files(folder)
    _capture(folder / "capture", ef.load(folder / "scene.glb"))
    pictures = [*references(folder, "scene.glb"), *references(folder, "line.glb", PLACES[:2])]
    pictures += [*references(folder, "one.glb", PLACES[1:2]), *references(folder, "four.glb", PLACES[1:2])]
    pictures += [*references(folder, "grey.glb", PLACES[1:2]), *references(folder, "mixed.glb", PLACES[1:2])]
    pictures += [*_counted_references(folder, "scene.glb"), *_free_references(folder, "scene.glb")]
    (folder / "references.json").write_text(json.dumps(pictures, indent=1), encoding="utf-8")
    weights = [{"scene": name, "places": _weights(folder / name)} for name in ("scene.glb", "line.glb", "held-out.glb")]
    (folder / "weights.json").write_text(json.dumps(weights), encoding="utf-8")


def _weights(path: Path) -> list[dict]:
    loaded = ef.load(path)
    grid = find_grid(loaded.rig.view_plane.coordinates([loaded.rig.cameras[i].centre for i in loaded.rig.encoded]))
    modes = ("delaunay", "nearest3", "bilinear") if grid is not None else ("delaunay", "nearest3")
    listed = []
    for x, y in np.random.default_rng(11).uniform(-1.2, 1.2, (40, 2)):
        camera = novel_camera(loaded, (x, y))
        numbers = np.concatenate([camera.K.ravel(), camera.R.ravel(), camera.t])
        rows = {mode: view_weights(loaded, (x, y), mode).dense(loaded.observations).tolist() for mode in modes}
        listed.append({"at": [x, y], "weights": rows, "camera": numbers.tolist()})
    return listed


def _colours(count: int) -> np.ndarray:
    random = np.random.default_rng(3)
    gains, offsets = random.uniform(0.8, 1.25, (count, 1, 3)), random.uniform(-0.05, 0.05, (count, 1, 3))
    return np.concatenate([gains, offsets], axis=1).astype(np.float32)


def references(
    folder: Path, name: str, places: tuple[tuple[float, float], ...] = PLACES, snapped: bool = False
) -> list[dict]:
    """snapped: see `snapped_scene`."""
    loaded, listed = ef.load(folder / name), []
    views = [(str(number), {"at": at}) for number, at in enumerate(places)] + [
        ("camera", {"camera": loaded.rig.names[0]})
    ]
    for filter in ("bilinear", "bicubic"):
        for label, view in views:
            drawn = snapped_scene(loaded, viewpoint(loaded, **view)[0]) if snapped else loaded
            picture = ef.render(drawn, **view, filter=filter, samples=1).to_uint8()
            file = f"{Path(name).stem}-{filter}-{label}.png"
            listed.append(_keep(folder, file, picture, name, filter, snapped=snapped, **view))
    return listed


def snapped_scene(made: Scene, camera: Camera) -> Scene:
    """The scene with its vertices where a rasteriser that keeps SUBPIXELS of a pixel draws them from a camera."""
    flat, depth = camera.project(made.proxy.mesh.vertices)
    flat = np.rint(flat * SUBPIXELS) / SUBPIXELS
    rays = np.concatenate([flat, np.ones((len(flat), 1))], axis=1) @ np.linalg.inv(camera.K).T
    vertices = (rays * depth[:, None] - camera.t) @ camera.R
    return replace(made, proxy=Proxy(replace(made.proxy.mesh, vertices=vertices.astype(np.float32))))


def _counted_references(folder: Path, name: str) -> list[dict]:
    """With fewer textures than the scene has."""
    loaded, listed = ef.load(folder / name), []
    for count in (0, 1, 3, 4, 5):
        picture = ef.render(loaded, at=PLACES[1], filter="bilinear", samples=1, textures=count).to_uint8()
        file = f"{Path(name).stem}-first-{count}.png"
        listed.append(_keep(folder, file, picture, name, "bilinear", at=PLACES[1], count=count))
    return listed


def _free_references(folder: Path, name: str) -> list[dict]:
    loaded = ef.load(folder / name)
    listed = []
    for number, eye in enumerate(FREE):
        view = free_camera(np.array(eye))
        picture = np.clip(np.rint(255 * reference.free_view(loaded, view)), 0, 255).astype(np.uint8)
        free = {"K": view.K.tolist(), "R": view.R.tolist(), "t": view.t.tolist()}
        listed.append(_keep(folder, f"free-{number}.png", picture, name, "bilinear", free=free))
    return listed


def free_camera(eye: np.ndarray) -> Camera:
    """A camera at `eye` that looks at the middle of the square, slightly turned."""
    forward = -eye / np.linalg.norm(eye)
    right = np.cross([0.05, 1.0, 0.0], forward)
    right /= np.linalg.norm(right)
    R = np.stack([right, np.cross(forward, right), forward])
    f = 105.0 * np.linalg.norm(eye)
    return Camera(np.array([[f, 0, WIDTH / 2], [0, f, HEIGHT / 2], [0, 0, 1]]), R, -R @ eye, WIDTH, HEIGHT)


def _keep(folder: Path, file: str, picture: np.ndarray, name: str, filter: str, **what: object) -> dict:
    Image.fromarray(np.broadcast_to(picture, (*picture.shape[:2], 3))).save(folder / file)
    size = {"width": picture.shape[1], "height": picture.shape[0]}
    others = {**dict.fromkeys(("at", "camera", "free", "count")), "snapped": False}
    return {"scene": name, "file": file, "filter": filter, **others, **what, **size}


def _capture(folder: Path, loaded: Scene) -> None:
    """Photographs as the software renderer draws them, each a little brighter at its left: an error to see."""
    folder.mkdir(exist_ok=True)
    frames = []
    for index, (name, camera) in enumerate(zip(loaded.rig.names, loaded.rig.cameras, strict=True)):
        picture = renderer_of(loaded).draw(camera, ViewWeights.one(index), samples=1).to_uint8().astype(int)
        picture[:, : WIDTH // 4] += 10
        Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8)).save(folder / f"{name}.png")
        to_world = np.eye(4)
        to_world[:3, :3], to_world[:3, 3] = camera.R.T @ np.diag([1.0, -1, -1]), camera.centre
        K = camera.K
        frames.append(
            {"file_path": f"{name}.png", "w": WIDTH, "h": HEIGHT, "fl_x": K[0, 0], "fl_y": K[1, 1], "cx": K[0, 2],
             "cy": K[1, 2], "transform_matrix": to_world.tolist()}
        )  # fmt: skip
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}), encoding="utf-8")


def _bad_files(folder: Path) -> None:
    data = (folder / "scene.glb").read_bytes()
    text, rest = glb_parts(data)
    (folder / "truncated.glb").write_bytes(data[: len(data) * 2 // 3])
    (folder / "no-json.glb").write_bytes(join_glb(b'{"asset": {"version": "2.0"', rest))
    (folder / "not-ours.bin").write_bytes(b"PK\x03\x04" + bytes(2000))
    broken = bytearray(data)
    images = [at for at in range(len(data)) if data[at : at + 8] == b"\x89PNG\r\n\x1a\n"]
    broken[images[3] + 40 : images[3] + 400] = bytes(360)  # within an eigen texture
    (folder / "damaged.glb").write_bytes(bytes(broken))
    root = json.loads(text)
    for file, key, value in (("newer.glb", "version", "2.0"), ("needs.glb", "needs", ["holograms"])):
        changed = json.loads(text)
        changed["extensions"]["EIGENFIELD_eigen_textures"][key] = value
        (folder / file).write_bytes(join_glb(json.dumps(changed).encode(), rest))
    del root["extensions"], root["extensionsUsed"][root["extensionsUsed"].index("EIGENFIELD_eigen_textures")]
    (folder / "plain.glb").write_bytes(join_glb(json.dumps(root).encode(), rest))


def glb_parts(data: bytes) -> tuple[bytes, bytes]:
    """The JSON text of a GLB, and all chunks after it as they are."""
    length = struct.unpack_from("<I", data, 12)[0]
    return data[20 : 20 + length], data[20 + length :]


def join_glb(text: bytes, rest: bytes) -> bytes:
    """A GLB of JSON text and the chunks after it."""
    text += b" " * (-len(text) % 4)
    out = io.BytesIO()
    out.write(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text + rest)
    return out.getvalue()


if __name__ == "__main__":
    write(Path(sys.argv[1]))
