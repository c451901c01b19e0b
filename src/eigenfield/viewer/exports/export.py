"""A scene for other programs, by the name of what is written or by its kind."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeGuard
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.readers.quilt import parse_quilt_name
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Scene, check_scale
from eigenfield.gltf import (
    as_scene,
    clip_in_one_file,
    encode_scene,
    has_group_files,
    load_any,
    one_file,
    without_residual,
)
from eigenfield.gltf.source import scene_file
from eigenfield.rendering import FLIGHT_FRAMES, RenderJob, path_points
from eigenfield.rendering.render_jobs import refuse_flight, write_flight
from eigenfield.runtime.files import atomic_writer, is_numbered, refuse_existing
from eigenfield.runtime.objects import find_objects
from eigenfield.viewer.exports.app import Sample, draw_thumbnail, write_app
from eigenfield.viewer.exports.clip_folder import write_clip_folder
from eigenfield.viewer.exports.colmap import write_colmap
from eigenfield.viewer.exports.folder import refuse_folder
from eigenfield.viewer.exports.glb import check_image, write_glb
from eigenfield.viewer.exports.guests import guests_files, write_guests_page
from eigenfield.viewer.exports.maps import write_maps
from eigenfield.viewer.exports.obj import obj_files, write_obj, write_obj_folder
from eigenfield.viewer.exports.quilt import quilt_of, write_quilt
from eigenfield.viewer.exports.quilt_film import write_quilt_clip, write_quilt_film
from eigenfield.viewer.exports.splats import check_splats, write_splats
from eigenfield.viewer.exports.usdz import check_usd, write_usdz
from eigenfield.viewer.exports.views import write_views
from eigenfield.viewer.page import Beside, shown_names, write_page

PICTURE_OPTIONS = {"resolution", "background", "weights", "filter", "textures", "samples", "renderer"}
FILM_OPTIONS = "path", "frames", "fps"
OPTIONS = {  # of each kind, beside the options of all
    "html": {"title", "metres_per_unit", "at", "laboratory", "url", "no_download"},
    "mp4": PICTURE_OPTIONS | {*FILM_OPTIONS},
    "png": PICTURE_OPTIONS | {"path", "frames"},
    "glb": {"at", "image", "draco", "metres_per_unit"},
    "obj": {"textures"},
    "maps": {"textures"},
    "quilt": PICTURE_OPTIONS | {"quilt", "spread", *FILM_OPTIONS},
    "views": PICTURE_OPTIONS | {"grid"},
    "colmap": PICTURE_OPTIONS | {"path", "frames", "residual"},
    "splats": {"splats", "metres_per_unit"},
    "usdz": {"metres_per_unit"},
    "folder": set(),
    "app": {"title"},
}
ENDINGS = {
    "html": (".html", ".htm"), "mp4": (".mp4",), "png": (".png",), "glb": (".glb",), "quilt": (".png", ".mp4"),
    "splats": (".glb", ".spz"), "usdz": (".usdz",),
}  # fmt: skip
FILE_ENDINGS = (".html", ".htm", ".mp4", ".png", ".jpg", ".jpeg", ".glb", ".gltf", ".ply", ".zip", ".spz", ".usdz")
FLIGHT_DEFAULT_PATH, FLIGHT_FPS = "circle", 30


@checked
def export(
    scene: Scene | Clip | str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    kind: str | None = None,
    *,
    time: float | None = None,
    overwrite: bool = False,
    progress: Progress | None = notebook_progress,
    **options: Any,
) -> tuple[Path, str]:
    """Write a scene for other programs, as `eigenfield export` does.

    Args:
        scene: The scene or the clip, or its file; for "html" up to two of them, which the page compares; for "app" the
            files of as many scenes as it offers, or none.
        output: A file or a folder.
        kind: "html", "mp4", "png" (single pictures), "glb", "obj", "maps", "quilt", "views", "colmap", "splats",
            "usdz", "folder" (a clip whose groups are files) or "app"; None: by the output's name.
        time: Seconds, of a clip, of which the nearest frame is exported; None: a page plays it, a glb of a clip whose
            groups are files is the clip as one file, and other kinds refuse it.
        overwrite: Whether existing files, and folders that an export wrote, are replaced.
        progress: Reports each picture; by default a bar in a notebook.
        options: Of the kind (`OPTIONS`): fields of `RenderJob` for pictures; `path` and `frames` (`path_points`) and
            `fps` of a flight; `title`, `metres_per_unit`, `at`, `laboratory`, `url` and `no_download` of a page
            (`write_guests_page`); `at`, `image`, `draco` and `metres_per_unit` of a glb (`write_glb`); `quilt`
            (columns and rows, or a display) and `spread` (`quilt_of`); `grid` of views (`write_views`); `splats`
            (`write_splats`); `residual`.

    Returns:
        The file or folder that was written, and what it holds, for people.

    Raises:
        OptionError: `output-kind`, `unused-option`, `scenes`; an option is impossible.
        OutputError: Something exists already, or cannot be written.
        FormatError: The file is no scene.
    """
    output = Path(output)
    chosen = _chosen_kind(output, kind, is_numbered(output))
    _check(chosen, output, options)
    scenes = [scene] if isinstance(scene, Scene | Clip | str | os.PathLike) else list(scene)
    if overwrite:
        _refuse_own(scenes, output, chosen)
    if chosen in ("app", "folder") and time is not None:
        raise OptionError("unused-option", f"--time is not for {chosen}", remedy="leave it out")
    if chosen == "app":
        return _write_app(scenes, output, overwrite, progress, **options)
    if len(scenes) != 1 and not (chosen == "html" and len(scenes) == 2):
        remedy = "name one; --as html takes two, to compare them, and --as app several"
        raise OptionError("scenes", f"{len(scenes)} scenes for {chosen}", remedy=remedy)
    scene = scenes[0]
    points = None
    if chosen in ("mp4", "png") or "path" in options or (chosen == "quilt" and _is_film(output)):
        points = path_points(options.get("path", FLIGHT_DEFAULT_PATH), options.get("frames", FLIGHT_FRAMES))
    files = guests_files(output) if chosen == "html" and not options.get("laboratory") else [output]
    _refuse(chosen, obj_files(output) if _is_obj(output) else files, points, overwrite)
    if chosen == "folder":
        return _write_clip_folder(scene, output, overwrite)
    if chosen == "glb" and time is None and not options and _is_in_files(scene):
        return _write_one_file(scene, output, overwrite)
    drawn = {name: value for name, value in options.items() if name in PICTURE_OPTIONS}
    loaded = scene if isinstance(scene, Scene | Clip) else load_any(scene)
    if len(scenes) == 2:
        options["beside"] = Beside.of(scenes, _page_file(scenes[1], time))
    if chosen == "html" and time is None and isinstance(loaded, Clip):  # the page plays it
        options["glb"] = _page_file(scene, time)
        time = loaded.timeline.first
    if chosen == "quilt" and time is None and isinstance(loaded, Clip) and _is_film(output):
        if "frames" in options:
            raise OptionError("frames", "a clip says how many pictures there are", remedy="leave --frames out")
        return write_quilt_clip(loaded, output, overwrite=overwrite, progress=progress, **options)
    job = RenderJob(as_scene(loaded, time), **drawn)
    return _write(chosen, job, points, output, options, overwrite, progress)


def _write_app(
    scenes: Sequence[Scene | Clip | str | os.PathLike[str]], output: Path, overwrite: bool,
    progress: Progress | None, **options: Any,
) -> tuple[Path, str]:  # fmt: skip
    """Write the page that opens files, with its samples; where, and what was written."""
    refuse_folder(output, overwrite)
    samples = []
    for scene, name in zip(scenes, shown_names(scenes, ["scene"] * len(scenes)), strict=True):
        if isinstance(scene, Scene | Clip):
            loaded, data = scene, encode_scene(scene)
        else:
            loaded, data = load_any(scene), one_file(scene)
        shown = as_scene(loaded, loaded.timeline.first if isinstance(loaded, Clip) else None)
        samples.append(Sample(name, without_residual(data), draw_thumbnail(shown)))
    write_app(samples, output, overwrite=overwrite, progress=progress, **options)
    offered = f", with {', '.join(sample.name for sample in samples)} to choose from" if samples else ""
    return output, f"a page that opens files{offered}; put it on a web server"


def _page_file(scene: Scene | Clip | str | os.PathLike[str], time: float | None) -> bytes:
    """The file that a page holds: a scene without its residual; of a clip all of it, or its frame at a time."""
    loaded = scene if isinstance(scene, Scene | Clip) else load_any(scene)
    if time is None and isinstance(loaded, Clip):
        return encode_scene(scene) if isinstance(scene, Scene | Clip) else one_file(scene)
    return encode_scene(replace(as_scene(loaded, time), residual=None))


def _is_in_files(scene: Scene | Clip | str | os.PathLike[str]) -> TypeGuard[str | os.PathLike[str]]:
    """Whether it is the file of a clip whose groups are files."""
    return not isinstance(scene, Scene | Clip) and has_group_files(scene)


def _write_one_file(path: str | os.PathLike[str], output: Path, overwrite: bool) -> tuple[Path, str]:
    """Write a clip whose groups are files as one; where, and what was written."""
    blocks = clip_in_one_file(path)
    with atomic_writer(output, overwrite=overwrite) as file:
        file.writelines(blocks)
    return output, f"{output.stat().st_size / 1e6:.1f} MB, the clip as one file"


def _write_clip_folder(scene: Scene | Clip | str | os.PathLike[str], output: Path, overwrite: bool) -> tuple[Path, str]:
    """Write a clip as files; where, and what was written."""
    if isinstance(scene, Scene):
        message = "a scene of one instant has no groups for a folder"
        raise OptionError("output-kind", message, remedy="name a clip")
    write_clip_folder(scene, output, overwrite=overwrite)
    count = len(list((output / "groups").iterdir()))
    return output, f"scene.glb, and a file for each of {count} groups; put it on a web server"


def _refuse_own(scenes: Sequence[Scene | Clip | str | os.PathLike[str]], output: Path, kind: str) -> None:
    """Refuse to replace the file of a scene, or a folder that holds it, but for the same clip as a folder."""
    place = Path(os.path.realpath(output))
    for scene in scenes:
        if isinstance(scene, Scene | Clip) or find_objects(scene) is not None:
            continue
        file = Path(os.path.realpath(scene_file(scene)))
        if place == file or (place in file.parents and kind not in ENDINGS and kind != "folder"):
            what = "is" if place == file else "holds"
            raise OptionError("output-kind", f"{output} {what} the scene itself", remedy="name another place")


def _is_film(output: Path) -> bool:
    return output.suffix.lower() == ".mp4"


def _refuse(kind: str, files: Sequence[Path], points: NDArray[np.float64] | None, overwrite: bool) -> None:
    """Refuse existing outputs, before any work; a quilt's name is known only with its scene."""
    output = files[-1]
    if kind not in ENDINGS and not _is_obj(output):
        refuse_folder(output, overwrite)
    elif kind == "quilt":
        return
    elif points is not None:
        refuse_flight(output, len(points), overwrite)
    else:
        for file in files:
            refuse_existing(file, overwrite)


def _write(
    kind: str, job: RenderJob, points: NDArray[np.float64] | None, output: Path, options: dict[str, Any],
    overwrite: bool, progress: Progress | None,
) -> tuple[Path, str]:  # fmt: skip
    """Write the export; where, and what was written."""
    scene = job.scene
    how: dict[str, Any] = {"overwrite": overwrite, "progress": progress}
    fps = Fraction(options.get("fps", FLIGHT_FPS))
    if kind == "html":
        laboratory = options.pop("laboratory", False)
        if laboratory:
            write_page(scene, output, overwrite=overwrite, **options)
            return output, f"{output.stat().st_size / 1e6:.1f} MB; guests get {output.name}?ui=plain"
        frame = write_guests_page(scene, output, overwrite=overwrite, **options)
        what = f"{output.stat().st_size / 1e6:.1f} MB, and {guests_files(output)[0].name}, its poster"
        return output, f"{what}; in a page of yours:\n{frame}"
    if kind == "glb":
        write_glb(scene, output, overwrite=overwrite, **options)
        return output, f"{output.stat().st_size / 1e6:.1f} MB, for any viewer"
    if _is_obj(output):
        write_obj(scene, output, overwrite=overwrite)
        return output, "with its material and the mean; a folder of the kind obj holds the eigen textures too"
    if kind == "obj":
        write_obj_folder(scene, output, textures=job.textures, **how)
        return output, "mesh, mean and eigen textures"
    if kind == "maps":
        write_maps(scene, output, textures=job.textures, **how)
        return output, f"{len(scene.rig.encoded)} texture maps"
    if kind == "quilt":
        quilt = quilt_of(scene, options.get("quilt"), job.resolution, options.get("spread", 1.0))
        if points is not None:
            frames = ((job, (float(x), float(y))) for x, y in points)
            path = write_quilt_film(frames, len(points), quilt, output, fps, **how)
            return path, f"{len(points)} quilts of {quilt.columns * quilt.rows} views"
        path = write_quilt(job, quilt, output, **how)
        return path, f"{quilt.columns * quilt.rows} views of {quilt.width}x{quilt.height}"
    if kind == "views":
        rows, columns = write_views(job, output, grid=options.get("grid"), **how)
        return output, f"{rows}x{columns} views with HCI's names, and parameters.cfg"
    if kind == "splats":
        count, decibels = write_splats(scene, output, **how, **options)
        size = f"{count:,} Gaussians, {output.stat().st_size / 1e6:.1f} MB"
        return output, f"{size}; PSNR {decibels:.1f} dB beside what the scene draws"
    if kind == "usdz":
        write_usdz(scene, output, overwrite=overwrite, **options)
        return output, f"{output.stat().st_size / 1e6:.1f} MB, for Quick Look"
    if kind == "colmap":
        write_colmap(job, output, points=points, residual=options.get("residual", False), **how)
        return output, f"{len(scene.rig.names) if points is None else len(points)} pictures and a COLMAP model"
    assert points is not None
    write_flight(job, points, output, fps, **how)
    return output, f"{len(points)} pictures"


def _is_obj(output: Path) -> bool:
    return output.suffix.lower() == ".obj"


def _chosen_kind(output: Path, kind: str | None, numbered: bool) -> str:
    """The kind that is asked for, else that of the output's name."""
    ending = output.suffix.lower()
    if kind is not None and kind not in OPTIONS:
        raise OptionError("output-kind", f"no export is called {kind}", remedy=f"use one of {', '.join(OPTIONS)}")
    if kind is None:
        if ending == ".png" and not numbered and parse_quilt_name(output) is None:
            raise OptionError(
                "output-kind",
                f"{output}: one .png may be many things",
                remedy="put %04d into its name for the pictures of a path, or say --as quilt; "
                "`eigenfield render SCENE -o view.png` draws one view",
            )
        film = "mp4" if parse_quilt_name(output) is None else "quilt"
        by_ending = {".html": "html", ".htm": "html", ".mp4": film, ".glb": "glb", ".obj": "obj",
                     ".png": "png" if numbered else "quilt", ".spz": "splats", ".usdz": "usdz"}  # fmt: skip
        if ending not in by_ending:
            raise OptionError(
                "output-kind",
                f"{output}: the name does not tell what to write",
                remedy=f"say --as {', '.join(list(OPTIONS)[:-1])} or {list(OPTIONS)[-1]}",
            )
        return by_ending[ending]
    if kind in ENDINGS and ending not in ENDINGS[kind]:
        raise OptionError("output-kind", f"{output}: {kind} is a file", remedy=f"name it {' or '.join(ENDINGS[kind])}")
    if kind == "png" and not numbered:
        raise OptionError("output-kind", f"{output}: a path makes many pictures", remedy="put %04d into its name")
    if kind == "quilt" and numbered:
        raise OptionError("output-kind", f"{output}: a quilt is one picture", remedy="leave the number out of its name")
    if kind not in ENDINGS and (ending in FILE_ENDINGS or (ending == ".obj" and kind != "obj")):
        raise OptionError("output-kind", f"{output}: {kind} is a folder", remedy="name one")
    return kind


def _check(kind: str, output: Path, given: dict[str, Any]) -> None:
    """Refuse options that the kind does not take, before anything is read."""
    for name in given:
        if name not in OPTIONS[kind]:
            raise OptionError("unused-option", f"--{name.replace('_', '-')} is not for {kind}", remedy="leave it out")
    if _is_obj(output) and "textures" in given:
        raise OptionError(
            "unused-option", f"{output} has the mean alone", remedy="leave out --textures, or name a folder"
        )
    if kind == "colmap" and "frames" in given and "path" not in given:
        raise OptionError("frames", "--frames needs --path", remedy="give a path, or leave it out")
    if kind == "quilt" and not _is_film(output):
        for name in FILM_OPTIONS:
            if name in given:
                remedy = "name an .mp4, or leave it out"
                raise OptionError("unused-option", f"--{name} is not for one quilt", remedy=remedy)
    if kind in ("mp4", "quilt") and _is_film(output) and given.get("background", ()) is None:
        raise OptionError("background", "a film cannot be transparent", remedy="name a colour, or write .png pictures")
    check_scale(given.get("metres_per_unit"))
    if kind == "glb":
        check_image(given.get("image", "png"), given.get("draco", False))
    if kind == "splats":
        check_splats(output, given.get("splats"))
    if kind == "usdz":
        check_usd()
    if "url" in given and given.get("laboratory"):
        raise OptionError("unused-option", "--url is not for --laboratory", remedy="leave it out")
    if "url" in given and not _is_address(given["url"]):
        raise OptionError("url", f"{given['url']} is no address", remedy="give one that begins with https://")


def _is_address(url: Any) -> bool:
    """Whether it names a page on the web."""
    try:
        parts = urlsplit(str(url))
    except ValueError:  # brackets without an address of version 6
        return False
    return parts.scheme in ("http", "https") and bool(parts.hostname)
