"""One video a camera, all started together: one frame of each makes the set of photographs.

Frames are taken out once, into lossless PNG in a work folder; masks and everything else then treat them as photographs.
Colours are converted here for 8-bit 4:2:0, which nearly all cameras write (swscale repeats chroma instead of
interpolating it).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import av
import av.error
import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.capture.arrangement import Arrangement, OpenOptions, require_photographs
from eigenfield.capture.locate import IMAGES_FOLDER, files_named, photographs_in
from eigenfield.capture.messages import natural_key
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import Stages, stage_key

VIDEO_FOLDER = "videos"
VIDEO_MIN_FILES = 2  # of a rig
VIDEO_TIME_PATTERN = re.compile(r"(\d{1,9}(?:\.\d*)?|\.\d+)s")
# red and blue of Y' by AVColorSpace: BT.709, BT.601 (three numbers), BT.2020
VIDEO_LUMA_WEIGHTS = {1: (0.2126, 0.0722), 4: (0.30, 0.11), 5: (0.299, 0.114), 6: (0.299, 0.114), 9: (0.2627, 0.0593)}
VIDEO_MAX_PIXELS = 80_000_000  # of a frame
VIDEO_FULL_RANGE = 2  # AVColorRange
VIDEO_MAX_SD_ROWS = 576  # an unmarked video of more rows is BT.709, as players take it

_temporary: list[Stages] = []  # frames without a work folder: deleted with the process


def videos_in(folder: Path) -> list[Path]:
    """The files of one folder that are named like videos, in natural order."""
    return sorted(files_named(folder, VIDEO_EXTENSIONS), key=lambda path: natural_key(path.name))


def videos_of(folder: Path) -> list[Path]:
    """The videos of a rig: those in the folder, or in its `videos/`, whichever are more. The film of a live photograph,
    which lies beside it under its name, is none."""
    stems = {path.stem.casefold() for path in photographs_in(folder)}
    here = [path for path in videos_in(folder) if path.stem.casefold() not in stems]
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
    problems = [] if options.frame is not None else [f"{shown} of each video is used; --frame names another"]
    return Arrangement("video", tuple(place / name for name in names), None, tuple(problems))


def video_identity(path: Path) -> list[Any]:
    """What the frames of a video depend on."""
    return [str(path.resolve()), path.stat().st_size, path.stat().st_mtime_ns]


def frames_stage(work: Path | None) -> Stages:
    """Where frames are kept: a folder, or a temporary one that goes with the process, in which they are found again."""
    if work is not None:
        return Stages(work)
    if not _temporary or not _temporary[-1].folder.is_dir():
        _temporary.append(Stages(None))
    return _temporary[-1]


def read_frame(path: Path, frame: int | float) -> NDArray[np.uint8]:
    """One frame of a video, upright.

    Args:
        path: The video.
        frame: Its index (int), or a time in seconds at which it is shown (float).

    Returns:
        (H, W, 3) uint8 sRGB-coded.

    Raises:
        CaptureError: `video-unreadable`, `video-short`.
    """
    last, number = None, -1
    for number, shown in enumerate(decode_video(path, frame)):
        if isinstance(frame, int):
            if number == frame:
                return to_rgb(shown)
        elif last is not None and shown.time is not None and shown.time > frame + 1e-9:
            return to_rgb(last)
        last = shown
    if last is None:
        raise CaptureError("video-unreadable", "holds no frame", path=path, remedy="take it out of the folder")
    end = (last.time or 0.0) + (float(last.duration * last.time_base) if last.duration and last.time_base else 0.0)
    if isinstance(frame, float) and frame <= end:
        return to_rgb(last)
    length = f"{number + 1} frames" if isinstance(frame, int) else f"{end:.3g} s"
    raise CaptureError(
        "video-short",
        f"ends after {length}, --frame {frame if isinstance(frame, int) else f'{frame:g}s'} lies beyond",
        path=path,
        remedy="name an earlier --frame (indices begin at 0)",
    )


def decode_video(path: Path, frame: int | float = 0) -> Iterator[av.VideoFrame]:
    """Decoded frames: all of them for an index, from the key frame before it for a time.

    Raises CaptureError: `video-unreadable`, `video-large`.
    """
    try:
        yield from _decode_frames(path, frame)
    except (av.error.FFmpegError, OSError) as error:
        raise CaptureError(
            "video-unreadable",
            f"is damaged or no video ({str(error).splitlines()[0][:120]})",
            path=path,
            remedy="copy it again, or take it out of the folder",
        ) from error


def _decode_frames(path: Path, frame: int | float) -> Iterator[av.VideoFrame]:
    with av.open(str(path)) as container:
        if not container.streams.video:
            return
        stream = container.streams.video[0]
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
        for shown in container.decode(stream):
            if offset and shown.pts is not None:
                shown.pts -= start
            yield shown


def to_rgb(frame: av.VideoFrame) -> NDArray[np.uint8]:
    """A frame as (H, W, 3) uint8 sRGB-coded values, upright."""
    pixels = _yuv420_to_rgb(frame) if frame.format.name in ("yuv420p", "yuvj420p") else frame.to_ndarray(format="rgb24")
    return np.ascontiguousarray(_upright(pixels, frame))


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


def _yuv420_to_rgb(frame: av.VideoFrame) -> NDArray[np.uint8]:
    """Y'CbCr 4:2:0 to R'G'B'; chroma, level with the left of two columns, between two rows, interpolated cubically."""
    y, cb, cr = (_plane_array(plane) for plane in frame.planes)
    height, width = y.shape
    place = np.array([[0.5, 0, 0], [0, 0.5, -0.25]])  # luma pixel to chroma pixel
    cubic = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
    edges = cv2.BORDER_REPLICATE
    warped = (cv2.warpAffine(c - 128, place, (width, height), flags=cubic, borderMode=edges) for c in (cb, cr))
    cb, cr = (np.asarray(c, np.float32) for c in warped)
    unmarked = 1 if height > VIDEO_MAX_SD_ROWS else 6
    red, blue = VIDEO_LUMA_WEIGHTS.get(int(frame.colorspace), VIDEO_LUMA_WEIGHTS[unmarked])
    if int(frame.color_range) != VIDEO_FULL_RANGE and frame.format.name != "yuvj420p":
        y, cb, cr = (y - 16) * (255 / 219), cb * (255 / 224), cr * (255 / 224)
    r, b = y + 2 * (1 - red) * cr, y + 2 * (1 - blue) * cb
    g = (y - red * r - blue * b) / (1 - red - blue)
    return np.clip(np.rint(np.stack([r, g, b], axis=-1)), 0, 255).astype(np.uint8)


def _plane_array(plane: av.video.plane.VideoPlane) -> NDArray[np.float32]:
    rows = np.frombuffer(plane, np.uint8).reshape(plane.height, plane.line_size)
    return rows[:, : plane.width].astype(np.float32)
