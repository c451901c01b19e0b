"""Video codecs as peers: all views as one film in serpentine order, with one key frame, and one view out of it again.

A file is counted whole, in the smallest container there is: AV1 as an OBU stream (2 bytes a frame; IVF takes 12 more,
3.5 kB for 17x17 views), HEVC and VVC as their bare byte streams without the encoder's note on its settings.
"""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal

import av
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.runtime.parallel import ordinary_scheduling
from evidence import rates
from evidence.colour import Chroma, Picture, Planes, even, pad, to_planes, to_rgb

RATE = 25  # frames a second: means nothing here, but a film has one
FOREVER = 99999  # frames between key frames
DOUBLING = 2.0  # dB of luma for twice the bytes, by which orders of views are compared: they differ in both
PIXELS: dict[Chroma, str] = {"420": "yuv420p10le", "444": "yuv444p10le"}


@dataclass(frozen=True)
class VideoCodec:
    """One way to code a film.

    Attributes:
        name: Key in results.
        label: For people.
        encoder: ffmpeg's name.
        chroma: Sampling of the colours.
        options: Of the encoder.
        rates: Values of `parameter`, from large files to small ones.
        container: ffmpeg's muxer, also the file's suffix.
        how: Through PyAV or the ffmpeg program.
        parameter: The encoder's option for the rate.
        steps: Values of `parameter` that the encoder tells apart between two whole numbers.
        patient: Whether the encoder takes so long that views are tried in one order alone.
    """

    name: str
    label: str
    encoder: str
    chroma: Chroma
    options: tuple[tuple[str, str], ...]
    rates: tuple[int, int, int, int]
    container: str
    how: Literal["pyav", "ffmpeg"] = "pyav"
    parameter: str = "crf"
    steps: int = 1
    patient: bool = False


def _svt(preset: int) -> VideoCodec:
    # tune 1 is PSNR, the encoder's default up to now, said in case that changes
    options = (("preset", str(preset)), ("svtav1-params", "keyint=-1:scd=0:tune=1"))
    return VideoCodec(
        f"svt-av1-{preset}", f"SVT-AV1 preset {preset}, 4:2:0", "libsvtav1", "420", options, (30, 40, 50, 60), "obu",
        steps=4,
    )  # fmt: skip


def _x265(chroma: Chroma) -> VideoCodec:
    # tune psnr: without it x265 spends bits on grain that PSNR and SSIM both count as an error
    options = (("preset", "medium"), ("tune", "psnr"), ("x265-params", "keyint=-1:scenecut=0:info=0:log-level=error"))
    label = f"x265 medium, {':'.join(chroma)}"
    return VideoCodec(f"x265-{chroma}", label, "libx265", chroma, options, (22, 28, 34, 40), "hevc")


AOM = (
    ("usage", "good"), ("cpu-used", "6"), ("row-mt", "1"), ("lag-in-frames", "35"), ("tune", "psnr"), ("b:v", "0"),
    ("g", str(FOREVER)), ("keyint_min", str(FOREVER)),
)  # fmt: skip

# qpa 0: without the perceptual quantiser, as the others are tuned for PSNR
VVENC = (("preset", "medium"), ("qpa", "0"), ("vvenc-params", "intraperiod=-1"))

VIDEO = (
    _svt(2),
    _svt(6),
    _x265("420"),
    _x265("444"),
    VideoCodec(
        "vvenc", "VVenC medium, 4:2:0", "libvvenc", "420", VVENC, (19, 25, 31, 37), "vvc", "ffmpeg", "qp", patient=True
    ),
    VideoCodec("libaom-444", "libaom cpu 6, 4:4:4", "libaom-av1", "444", AOM, (30, 40, 50, 60), "obu", "ffmpeg"),
)


def asked_for(names: str) -> list[VideoCodec]:
    """The codecs of some names, commas between; a line is printed for each that cannot run here."""
    asked = [codec for codec in VIDEO if codec.name in names.split(",")]
    for codec in asked:
        if missing(codec):
            print(f"left out: {codec.label}: {missing(codec)}", flush=True)
    return asked


@functools.cache
def missing(codec: VideoCodec) -> str | None:
    """Why the codec cannot run here, in words; None when it can."""
    if codec.how == "pyav":
        try:
            av.codec.Codec(codec.encoder, "w")
        except av.codec.codec.UnknownCodecError:
            return f"PyAV was built without {codec.encoder}"
        return None
    program = shutil.which("ffmpeg")
    if program is None:
        return "the ffmpeg program is not installed"
    command = [program, "-hide_banner", "-h", f"encoder={codec.encoder}"]
    said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return None if said.startswith("Encoder ") else f"the ffmpeg program was built without {codec.encoder}"


def serpentine(rows: int, columns: int) -> list[int]:
    """The places row * columns + column of a grid, to and fro: neighbours on the way are neighbours in the grid."""
    places = np.arange(rows * columns).reshape(rows, columns)
    places[1::2] = places[1::2, ::-1]
    return [int(place) for place in places.ravel()]


def spiral(rows: int, columns: int) -> list[int]:
    """The places of a grid from its middle outwards, round and round."""
    middle = np.array([(rows - 1) / 2, (columns - 1) / 2])
    places = np.stack(np.divmod(np.arange(rows * columns), columns), axis=1) - middle
    ring = np.abs(places / np.maximum([rows, columns], 1)).max(axis=1)
    turn = np.arctan2(places[:, 0], places[:, 1])
    return [int(place) for place in np.lexsort([turn, np.round(ring, 6)])]


def orders(cameras: Sequence[Camera]) -> dict[str, list[int]]:
    """The ways in which a codec may be led through an array's views, as positions in `cameras`.

    A grid is walked row by row, to and fro, or from its middle. Elsewhere the way is from each camera to the nearest
    not yet visited, from the first camera for which that way is shortest.
    """
    centres = np.array([camera.centre for camera in cameras])
    grid = find_grid(fit_view_plane(cameras).coordinates(centres))
    if grid is None:
        distances = np.linalg.norm(centres[:, None] - centres, axis=2)
        greedy = [_greedy(distances, first) for first in range(len(centres))]
        return {"nearest": min(greedy, key=lambda way: float(distances[way[:-1], way[1:]].sum()))}
    ways = {
        "rows": range(grid.rows * grid.columns), "serpentine": serpentine(grid.rows, grid.columns),
        "spiral": spiral(grid.rows, grid.columns),
    }  # fmt: skip
    return {name: [int(grid.index.flat[place]) for place in way] for name, way in ways.items()}


def usual(ways: Mapping[str, Any]) -> str:
    """The one of `orders` that is not tried but taken: to and fro where there is a grid."""
    return "serpentine" if "serpentine" in ways else "nearest"


def order(cameras: Sequence[Camera]) -> list[int]:
    """The usual one of `orders`."""
    ways = orders(cameras)
    return ways[usual(ways)]


def orders_of(codec: VideoCodec, cameras: Sequence[Camera]) -> dict[str, list[int]]:
    """Those of `orders` that are tried with a codec: the usual one alone where the codec is patient."""
    ways = orders(cameras)
    return {usual(ways): ways[usual(ways)]} if codec.patient else ways


def best_order(tried: Mapping[str, Mapping[str, Any]]) -> str:
    """The order whose point has the most luma PSNR for its bytes."""
    return max(tried, key=lambda name: tried[name]["psnr_luma"] - DOUBLING * np.log2(tried[name]["bytes"]))


def _greedy(distances: NDArray[np.float64], first: int) -> list[int]:
    way, left = [first], np.ones(len(distances), bool)
    left[first] = False
    while left.any():
        way.append(int(np.argmin(np.where(left, distances[way[-1]], np.inf))))
        left[way[-1]] = False
    return way


def film_size(pictures: Sequence[Picture]) -> tuple[int, int]:
    """Height and width of the film: the largest of the pictures', made even."""
    return even(max(p.shape[0] for p in pictures), max(p.shape[1] for p in pictures))


def encode(pictures: Sequence[Picture], codec: VideoCodec, rate: float, path: Path) -> float:
    """Write the pictures, in the order given, as a film; the seconds that the encoder took.

    The conversion to Y'CbCr comes first and is not in the seconds.

    Args:
        pictures: (H, W, 3) uint8, of any sizes: smaller ones are padded by their edges.
        codec: The codec.
        rate: Value of the codec's `parameter`, in 1 / `steps`.
        path: Of the film.

    Raises:
        RuntimeError: The ffmpeg program fails; with its words.
    """
    height, width = film_size(pictures)
    film = [to_planes(pad(picture, height, width), codec.chroma) for picture in pictures]
    run = _encode_pyav if codec.how == "pyav" else _encode_program
    return run(film, codec, rate, path)


def _encode_pyav(film: Sequence[Planes], codec: VideoCodec, rate: float, path: Path) -> float:
    os.environ.setdefault("SVT_LOG", "1")  # errors alone: SVT-AV1 writes its settings to stderr otherwise
    frames = [_frame(planes, codec, number) for number, planes in enumerate(film)]
    start = time.perf_counter()
    with av.open(str(path), "w", format=codec.container) as container:
        stream: Any = container.add_stream(codec.encoder, rate=RATE, options=_options(codec, rate))
        stream.width, stream.height = frames[0].width, frames[0].height
        stream.pix_fmt = PIXELS[codec.chroma]
        context = stream.codec_context
        context.gop_size = FOREVER
        context.color_range, context.colorspace = 2, 1  # full range, BT.709
        context.thread_count = 0
        with ordinary_scheduling():
            context.open()
        for frame in frames:
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return time.perf_counter() - start


def _options(codec: VideoCodec, rate: float) -> dict[str, str]:
    """Of the encoder, the rate among them. ffmpeg's crf is a whole number; SVT-AV1's own parameter takes quarters."""
    options = dict(codec.options) | {codec.parameter: f"{rate:g}"}
    if codec.encoder == "libsvtav1":
        options["svtav1-params"] += f":crf={rate:g}"
    return options


def _frame(planes: Planes, codec: VideoCodec, number: int) -> Any:
    height, width = planes[0].shape
    frame = av.VideoFrame(width, height, PIXELS[codec.chroma])
    for target, plane in zip(frame.planes, planes, strict=True):
        _samples(target)[:, : plane.shape[1]] = plane
    frame.pts, frame.time_base = number, Fraction(1, RATE)
    frame.color_range, frame.colorspace = 2, 1
    return frame


def _samples(plane: Any) -> NDArray[np.uint16]:
    """(height, line) 10-bit samples of a frame's plane, the unused end of each line included."""
    return np.frombuffer(plane, np.uint16).reshape(-1, plane.line_size // 2)[: plane.height]


def _encode_program(film: Sequence[Planes], codec: VideoCodec, rate: float, path: Path) -> float:
    height, width = film[0][0].shape
    full = ["-color_range", "pc", "-colorspace", "bt709"]
    command = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"]
    command += ["-pix_fmt", PIXELS[codec.chroma], "-s", f"{width}x{height}", "-r", str(RATE), *full, "-i", "pipe:0"]
    options = (word for key, value in _options(codec, rate).items() for word in (f"-{key}", value))
    command += ["-c:v", codec.encoder, *options]
    command += [*full, "-threads", str(os.cpu_count() or 1), "-f", codec.container, str(path)]
    start = time.perf_counter()
    with tempfile.TemporaryFile() as words:  # a file, not a pipe: nobody reads while frames are being written
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=words) as process:
            assert process.stdin is not None
            try:
                for planes in film:
                    for plane in planes:
                        process.stdin.write(plane.astype("<u2", copy=False).tobytes())
                process.stdin.close()
            except BrokenPipeError:
                pass  # it has ended early, and its words say why
        if process.returncode != 0:
            words.seek(0)
            raise RuntimeError(f"ffmpeg could not write {path.name}: {words.read().decode(errors='replace').strip()}")
    return time.perf_counter() - start


def decode(path: Path, codec: VideoCodec, sizes: Sequence[tuple[int, int]]) -> Iterator[Picture]:
    """The pictures of a film in the order in which they were given to `encode`, cut to their own (height, width).

    Decoders hand frames on in the order in which they are shown, whatever order they are coded in. ValueError where
    the film has fewer or more frames than there are sizes.
    """
    count = 0
    for frame in _frames(path, codec):
        if count == len(sizes):
            raise ValueError(f"{path.name} has more than {count} frames")
        yield _picture(frame, sizes[count])
        count += 1
    if count < len(sizes):
        raise ValueError(f"{path.name} has {count} frames, not {len(sizes)}")


def access(path: Path, codec: VideoCodec, position: int, size: tuple[int, int]) -> tuple[float, Picture]:
    """Seconds from a closed, cold file to the one RGB picture at `position`, and that picture.

    With one key frame that is the first of all, every frame before it has to be decoded.
    """
    evict(path)
    start = time.perf_counter()
    frames = _frames(path, codec)
    for number, frame in enumerate(frames):
        if number == position:
            picture = _picture(frame, size)
            seconds = time.perf_counter() - start
            frames.close()
            return seconds, picture
    raise ValueError(f"{path.name} has no frame {position}")


def _frames(path: Path, codec: VideoCodec) -> Any:
    with av.open(str(path), format=codec.container) as container:
        stream: Any = container.streams.video[0]
        stream.thread_type = "AUTO"
        yield from container.decode(stream)


def _picture(frame: Any, size: tuple[int, int]) -> Picture:
    y, u, v = (_samples(plane)[:, : plane.width] for plane in frame.planes)
    return to_rgb((y, u, v), *size)


def evict(path: Path) -> None:
    """Have the system forget a file's contents, so that the next read comes from the disk; nothing where it cannot."""
    if not hasattr(os, "posix_fadvise"):
        return
    with path.open("rb") as file:
        os.fsync(file.fileno())  # what is not written yet is not forgotten
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def measure_video(
    codec: VideoCodec,
    rate: float,
    pictures: Sequence[Picture],
    names: Sequence[str],
    covered: Sequence[NDArray[np.bool_]],
    folder: Path,
) -> dict[str, Any]:
    """One point of a codec's curve.

    pictures, names, covered: of the views, in the order in which they are to be coded; (H, W, 3) uint8 and (H, W). The
    film is written to `folder`, which must exist, and left there. Returns `rates.point`'s figures with "parameter" (the
    rate), "bytes", "encode_seconds" (of the encoder alone) and "access_seconds" of the "middle" and the "last" view.
    """
    path = folder / f"{codec.name}-{rate}.{codec.container}"
    seconds = encode(pictures, codec, rate, path)
    sizes = [(picture.shape[0], picture.shape[1]) for picture in pictures]
    last = len(pictures) - 1
    reached = {
        place: round(access(path, codec, position, sizes[position])[0], 4)
        for place, position in (("middle", last // 2), ("last", last))
    }
    return {
        "parameter": rate,
        "bytes": path.stat().st_size,
        "encode_seconds": round(seconds, 2),
        "access_seconds": reached,
        **rates.point(decode(path, codec, sizes), pictures, covered, names),
    }
