"""One video a camera, all started together: one frame of each makes the set of photographs.

Frames are taken out once, into lossless PNG in a work folder; masks and everything else then treat them as photographs.
Colours are converted here for 4:2:0 of 8 bit and of HDR, which nearly all cameras write (swscale repeats chroma instead
of interpolating it).
"""

from __future__ import annotations

import contextlib
import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import av
import av.error
import av.stream
import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.capture.arrangement import Arrangement, require_photographs
from eigenfield.capture.locate import IMAGES_FOLDER, files_named, photographs_in
from eigenfield.capture.messages import Note, natural_key
from eigenfield.capture.photographs.colour import COLOUR_HDR_CURVES, Profile, read_code_points
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import Stages, stage_key

VIDEO_FOLDER = "videos"
VIDEO_MIN_FILES = 2  # of a rig
VIDEO_TIME_PATTERN = re.compile(r"(\d{1,9}(?:\.\d*)?|\.\d+)s")
# red and blue of Y' by AVColorSpace: BT.709, FCC, BT.601 (two numbers), SMPTE 240M, BT.2020; others are not converted
VIDEO_LUMA_WEIGHTS = {
    1: (0.2126, 0.0722), 4: (0.30, 0.11), 5: (0.299, 0.114), 6: (0.299, 0.114), 7: (0.212, 0.087), 9: (0.2627, 0.0593)
}  # fmt: skip
VIDEO_MAX_PIXELS = 80_000_000  # of a frame
VIDEO_FULL_RANGE = 2  # AVColorRange
VIDEO_UNMARKED_MATRICES = (0, 2, 3)  # AVColorSpace: RGB's, which no Y'CbCr has, unspecified and reserved
VIDEO_MAX_SD_ROWS = 576  # an unmarked video of more rows is BT.709, as players take it
VIDEO_WIDE_PRIMARIES = (9, 11, 12)  # those of SD are shown as BT.709's by most players, and differ by a few grey levels
VIDEO_DOLBY_TAGS = ("dvh1", "dvhe", "dav1", "dva1", "dvav")  # sample entries, of colours that only Dolby Vision knows
VIDEO_420_BITS = {"yuv420p": 8, "yuvj420p": 8, "yuv420p10le": 10}

_temporary: list[Stages] = []  # frames without a work folder: deleted with the process


class Shown(NamedTuple):
    """A decoded frame.

    Attributes:
        damaged: Whether something was made up, in it or in one before it that it may be built on.
        matrix: The AVColorSpace of its values, of an unmarked one by the rule.
        colours: The profile of its values; None for sRGB, by which SDR video is shown.
    """

    frame: av.VideoFrame
    damaged: bool
    matrix: int
    colours: Profile | None


def videos_in(folder: Path) -> list[Path]:
    """The files of one folder that are named like videos, in natural order."""
    return sorted(files_named(folder, VIDEO_EXTENSIONS), key=lambda path: natural_key(path.name))


def videos_of(folder: Path) -> list[Path]:
    """The videos of a rig: those in the folder, or in its `videos/`, whichever are more. The film of a live photograph,
    which lies beside it under its name, is none."""
    stems = {name_key(path.stem) for path in photographs_in(folder)}
    here = [path for path in videos_in(folder) if name_key(path.stem) not in stems]
    inner = videos_in(folder / VIDEO_FOLDER)
    return here if len(here) >= len(inner) else inner


def find_videos(folder: Path) -> Path | None:
    """The folder, if it or its `videos/` holds at least two videos."""
    return folder if len(videos_of(folder)) >= VIDEO_MIN_FILES else None


def is_video_rig(folder: Path) -> bool:
    """Whether a folder holds videos where other captures have photographs."""
    if find_videos(folder) is None:  # sooner said than that there are no photographs
        return False
    return not photographs_in(folder) and not photographs_in(folder / IMAGES_FOLDER)


def parse_frame(frame: int | str | None) -> int | float:
    """An index (int) or a time in seconds (float) from the option's text; OptionError `frame-unknown`."""
    if frame is None:
        return 0
    word = str(frame).strip()
    seconds = VIDEO_TIME_PATTERN.fullmatch(word)
    if seconds:
        return float(seconds[1])
    if word.isascii() and word.isdecimal() and len(word) < 10:
        return int(word)
    raise OptionError(
        "frame-unknown", f"--frame {word!r} is no frame", remedy="say an index from 0 (12), or seconds (2.5s)"
    )


def read_videos(folder: Path, options: OpenOptions) -> Arrangement:
    """One frame of each video as PNG, in `options.work` (reused if it is there) or in a temporary folder.

    Raises CaptureError: `names-unknown`, `video-unreadable`, `video-short`; OptionError `frame-unknown`.
    """
    videos = videos_of(folder)
    require_photographs(videos, folder, f"like a video ({', '.join(VIDEO_EXTENSIONS[:4])})")
    frame = parse_frame(options.frame)
    times = Counter(path.stem for path in videos)
    names = [f"{path.stem if times[path.stem] == 1 else path.name}.png" for path in videos]
    described = [video_identity(path) for path in videos]

    def build(place: Path) -> None:
        def extract(index: int) -> None:
            Image.fromarray(read_frame(videos[index], frame)).save(place / names[index], compress_level=3)

        parallel_map(extract, range(len(videos)))

    place = frames_stage(options.work).run("frames", stage_key([described, frame]), build)
    shown = f"{frame:g} s" if isinstance(frame, float) else f"frame {frame}"
    problems = [] if options.frame is not None else [Note(f"{shown} of each video is used; --frame names another")]
    return Arrangement("video", tuple(place / name for name in names), None, tuple(problems))


def video_identity(path: Path) -> list[Any]:
    """What the frames of a video depend on."""
    return [str(path.resolve()), path.stat().st_size, path.stat().st_mtime_ns]


def frames_stage(work: str | os.PathLike[str] | None) -> Stages:
    """Where frames are kept: a folder, or a temporary one that goes with the process, in which they are found again."""
    if work is not None:
        return Stages(Path(work))
    if not _temporary or not _temporary[-1].folder.is_dir():
        _temporary.append(Stages(None))
    return _temporary[-1]


def read_frame(path: Path, frame: int | float) -> NDArray[np.uint8]:
    """One frame of a video, upright.

    Args:
        frame: Its index (int), or a time in seconds at which it is shown (float).

    Returns:
        (H, W, 3) uint8 sRGB-coded.

    Raises:
        CaptureError: `video-unreadable`, `video-short`, `video-colours`.
    """
    last, number = None, -1
    for number, shown in enumerate(decode_video(path, frame)):
        if isinstance(frame, int):
            if number == frame:
                return _sound_rgb(shown, frame, path)
        elif last is not None and shown.frame.time is not None and shown.frame.time > frame + 1e-9:
            return _sound_rgb(last, frame, path)
        last = shown
    if last is None:
        raise CaptureError("video-unreadable", "holds no frame", path=path, remedy="take it out of the folder")
    still = last.frame
    end = (still.time or 0.0) + (float(still.duration * still.time_base) if still.duration and still.time_base else 0.0)
    if isinstance(frame, float) and frame <= end:
        return _sound_rgb(last, frame, path)
    length = f"{number + 1} frames" if isinstance(frame, int) else f"{end:.3g} s"
    raise CaptureError(
        "video-short",
        f"ends after {length}, --frame {frame if isinstance(frame, int) else f'{frame:g}s'} lies beyond",
        path=path,
        remedy="name an earlier --frame (indices begin at 0)",
    )


def _sound_rgb(shown: Shown, frame: int | float, path: Path) -> NDArray[np.uint8]:
    if shown.damaged:
        what = f"frame {frame}" if isinstance(frame, int) else f"the frame at {frame:g} s"
        raise CaptureError(
            "video-unreadable", f"{what} is damaged", path=path, remedy="copy it again, or name another --frame"
        )
    return to_rgb(shown)


def decode_video(path: Path, frame: int | float = 0) -> Iterator[Shown]:
    """Decoded frames: all of them for an index, from the key frame before it for a time.

    Raises CaptureError: `video-unreadable`, `video-large`, `video-colours`.
    """
    with video_errors(path):
        yield from _decode_frames(path, frame)


@contextlib.contextmanager
def video_errors(path: Path) -> Iterator[None]:
    """Turn what a decoder raises on a damaged video into CaptureError `video-unreadable`."""
    try:
        yield
    except (av.error.FFmpegError, OSError) as error:
        raise CaptureError(
            "video-unreadable",
            f"is damaged or no video ({str(error).splitlines()[0][:120]})",
            path=path,
            remedy="copy it again, or take it out of the folder",
        ) from error


def find_film(container: av.container.InputContainer) -> av.VideoStream | None:
    """The video stream of the most pixels, of equal ones the default or the first: others are previews. An attached
    picture is none; None where there is none."""
    picture, default = av.stream.Disposition.attached_pic, av.stream.Disposition.default
    known = (stream for stream in container.streams.video if stream.codec_context is not None)  # there is a decoder
    streams = [stream for stream in known if not stream.disposition & picture]
    return max(streams, key=lambda one: (one.width * one.height, bool(one.disposition & default)), default=None)


def _decode_frames(path: Path, frame: int | float) -> Iterator[Shown]:
    with av.open(str(path), metadata_errors="replace") as container:
        stream = find_film(container)
        if stream is None:
            return
        size = stream.codec_context
        if size.width * size.height > VIDEO_MAX_PIXELS:
            raise CaptureError(
                "video-large",
                f"has frames of {size.width}x{size.height}, more than {VIDEO_MAX_PIXELS // 10**6} million pixels",
                path=path,
                remedy="make it smaller",
            )
        stream.thread_type = "AUTO"
        start = stream.start_time or 0
        if isinstance(frame, float) and stream.time_base:
            try:
                container.seek(int(frame / stream.time_base) + start, stream=stream)
            except av.error.FFmpegError:  # beyond the end, or no index: from the beginning then
                container.seek(start, stream=stream)
        offset = start * stream.time_base if stream.time_base else 0
        damaged = False
        for decoded in container.decode(stream):
            if offset and decoded.pts is not None:
                decoded.pts -= start
            damaged = decoded.is_corrupt or (damaged and not decoded.key_frame)
            yield Shown(decoded, damaged, *_colours_of(decoded, stream.codec_context, path))


def _colours_of(frame: av.VideoFrame, context: av.VideoCodecContext, path: Path) -> tuple[int, Profile | None]:
    """The matrix of a frame, by one rule for all pixel formats where it is unmarked, and the profile of its values.

    Raises CaptureError `video-colours` for colours that are not converted.
    """
    matrix = int(frame.colorspace)
    if not frame.format.is_rgb:
        dolby = context.codec_tag in VIDEO_DOLBY_TAGS and int(context.color_trc) not in COLOUR_HDR_CURVES
        if matrix in VIDEO_UNMARKED_MATRICES and not dolby:
            matrix = 1 if frame.height > VIDEO_MAX_SD_ROWS else 6
        elif dolby or matrix not in VIDEO_LUMA_WEIGHTS:
            what = "of Dolby Vision alone" if dolby else f"of a matrix (number {matrix}) of rare use"
            raise CaptureError(
                "video-colours",
                f"has colours {what}, which are not converted",
                path=path,
                remedy="convert it to BT.709 with a video editor, or film in SDR",
            )
    primaries, transfer = int(context.color_primaries), int(context.color_trc)
    primaries = primaries if primaries in VIDEO_WIDE_PRIMARIES else 1
    profile = read_code_points(primaries, transfer if transfer in COLOUR_HDR_CURVES else 1)
    return matrix, None if profile.kind == "none" else profile


def to_rgb(shown: Shown) -> NDArray[np.uint8]:
    """A frame as (H, W, 3) uint8 sRGB-coded values, upright."""
    frame, bits = shown.frame, VIDEO_420_BITS.get(shown.frame.format.name)
    frame.colorspace = shown.matrix
    if shown.colours is not None:
        if bits is None:
            values = frame.to_ndarray(format="rgb48le") / np.float32(65535)
        else:
            values = _yuv420_to_rgb(frame, bits) / np.float32(255)
        pixels = _eight_bit(shown.colours.apply(values) * np.float32(255))
    elif bits == 8:
        pixels = _eight_bit(_yuv420_to_rgb(frame, bits))
    else:
        pixels = frame.to_ndarray(format="rgb24")
    return np.ascontiguousarray(_upright(pixels, frame))


def _eight_bit(values: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def _upright(pixels: NDArray[np.uint8], frame: av.VideoFrame) -> NDArray[np.uint8]:
    """The picture as its display matrix shows it: turned by quarters, mirrored or both.

    A stored point (x, y) is shown at (a x + c y, b x + d y); the matrix begins a b u c d (ISO/IEC 14496-12, 6.2.2).
    """
    found = frame.side_data.get("DISPLAYMATRIX")
    if found is None:
        return pixels
    a, b, _, c, d = np.frombuffer(found, np.int32)[:5].astype(np.int64).tolist()
    if abs(b) + abs(c) > abs(a) + abs(d):  # x is shown along y
        pixels, a, d = pixels.swapaxes(0, 1), c, b
    return pixels[:: -1 if d < 0 else 1, :: -1 if a < 0 else 1]


def _yuv420_to_rgb(frame: av.VideoFrame, bits: int) -> NDArray[np.float32]:
    """Y'CbCr 4:2:0 to R'G'B' of 0..255; chroma, level with the left of two columns, between two rows, interpolated
    cubically."""
    y, cb, cr = (_plane_array(plane, bits) for plane in frame.planes)
    height, width = y.shape
    place = np.array([[0.5, 0, 0], [0, 0.5, -0.25]])  # luma pixel to chroma pixel
    cubic = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
    edges = cv2.BORDER_REPLICATE
    warped = (cv2.warpAffine(c - 128, place, (width, height), flags=cubic, borderMode=edges) for c in (cb, cr))
    cb, cr = (np.asarray(c, np.float32) for c in warped)
    red, blue = VIDEO_LUMA_WEIGHTS[int(frame.colorspace)]
    if int(frame.color_range) != VIDEO_FULL_RANGE and frame.format.name != "yuvj420p":
        y, cb, cr = (y - 16) * (255 / 219), cb * (255 / 224), cr * (255 / 224)
    elif bits > 8:
        y, cb, cr = (part * np.float32(255 * (1 << bits - 8) / ((1 << bits) - 1)) for part in (y, cb, cr))
    r, b = y + 2 * (1 - red) * cr, y + 2 * (1 - blue) * cb
    g = (y - red * r - blue * b) / (1 - red - blue)
    return np.stack([r, g, b], axis=-1)


def _plane_array(plane: av.video.plane.VideoPlane, bits: int) -> NDArray[np.float32]:
    """Values of 0..255, by the most significant eight bits."""
    samples = np.frombuffer(plane, np.uint8 if bits == 8 else "<u2")
    rows = samples.reshape(plane.height, plane.line_size // samples.itemsize)[:, : plane.width].astype(np.float32)
    return rows / np.float32(1 << bits - 8) if bits > 8 else rows
