"""One video of a walk around a scene: sharp frames, evenly spread by how far the picture moves.

Between two frames the picture moves by the median length of the sparse optical flow (Lucas and Kanade 1981, in
pyramids). The way that it goes from the first frame to the last is cut into equal steps, and of each the sharpest frame
is taken: the one with the greatest variance of the Laplacian, times 1 - d for a frame d steps from the middle.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.locate import IMAGES_FOLDER, photographs_in
from eigenfield.capture.messages import Note
from eigenfield.capture.readers.video import decode_video, frames_stage, to_rgb, video_identity, videos_in
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.runtime.stages import stage_key

WALK_FRAMES_RANGE = (3, 1000)  # that may be asked for
WALK_DEFAULT_RANGE = (24, 120)  # frames taken by default, one for each WALK_DEFAULT_STEP
WALK_DEFAULT_STEP = 0.05  # of the picture's longer side, by which it moves from frame to frame
WALK_MIN_WAY = 0.05  # of the longer side: a camera that moves it less stands still
WALK_MAX_FRAMES = 20_000  # that are looked at
WALK_DAMAGED_FILE = "damaged"  # beside the frames: how many are left out
WALK_SHARPNESS_SIDE, WALK_FLOW_SIDE = 640, 320  # pixels of the longer side
WALK_MAX_CORNERS, WALK_CORNER_QUALITY, WALK_CORNER_DISTANCE = 200, 0.01, 8
WALK_MIN_CORNERS = 8  # that must be found again; with less the picture counts as not moved


class _Motion(NamedTuple):
    """What is measured of a video.

    Attributes:
        way: (n,) the way that the picture has gone up to each frame, in longer sides.
        sharpness: (n,) variance of the Laplacian.
        damaged: (n,) whether a frame is.
    """

    way: NDArray[np.float64]
    sharpness: NDArray[np.float64]
    damaged: NDArray[np.bool_]


def find_walk(folder: Path) -> Path | None:
    """The video of a folder that holds one, and no photographs."""
    videos = videos_in(folder)
    others = photographs_in(folder) or photographs_in(folder / IMAGES_FOLDER)
    return videos[0] if len(videos) == 1 and not others else None


def parse_walk_frames(frames: int | None) -> int | None:
    """The number of frames that is asked for; OptionError `walk-frames-unknown`."""
    low, high = WALK_FRAMES_RANGE
    if frames is not None and not low <= frames <= high:
        message = f"--walk-frames {frames} is no number of frames"
        raise OptionError("walk-frames-unknown", message, remedy=f"say {low} to {high}")
    return frames


def read_walk(video: Path, options: OpenOptions) -> Arrangement:
    """Frames of a video as PNG, in `options.work` (reused if they are there) or in a temporary folder.

    Raises CaptureError: `names-unknown`, `video-unreadable`, `video-short`, `video-long`, `video-large`, `video-still`,
    `video-colours`.
    """
    found = find_walk(video) if video.is_dir() else video
    if found is None:
        raise CaptureError("names-unknown", "does not hold one video", path=video, remedy="name the video itself")
    count = parse_walk_frames(options.walk_frames)

    def build(place: Path) -> None:
        motion = _measure(found)
        chosen = set(_choose(motion, count, found))
        (place / WALK_DAMAGED_FILE).write_text(str(motion.damaged.sum()))
        for number, shown in enumerate(decode_video(found)):
            if number in chosen:
                Image.fromarray(to_rgb(shown)).save(place / f"frame_{number:05d}.png", compress_level=3)

    place = frames_stage(options.work).run("walk", stage_key([video_identity(found), count]), build)
    files = tuple(sorted(place.glob("*.png")))
    fewer = f", of {count} that were asked for" if count is not None and len(files) < count else ""
    line = f"{len(files)} frames of the video are used{fewer}"
    damaged = int((place / WALK_DAMAGED_FILE).read_text())
    left_out = [f"{damaged} damaged frames of the video are left out"] if damaged else []
    said = Note(line if options.walk_frames else f"{line}; --walk-frames says how many")
    return Arrangement("walk", files, None, (said, *left_out))


def _measure(video: Path) -> _Motion:
    """Raises CaptureError as `read_walk` does."""
    steps, sharpness, damaged = [], [], []
    before: NDArray[np.uint8] | None = None
    for number, (large, small, is_damaged) in enumerate(_small_frames(video)):
        if number >= WALK_MAX_FRAMES:
            raise CaptureError(
                "video-long",
                f"has more than the {WALK_MAX_FRAMES} frames that are looked at",
                path=video,
                remedy="cut it, or lower its frame rate",
            )
        sharpness.append(float(cv2.Laplacian(large, cv2.CV_32F).var()))
        steps.append(0.0 if before is None or is_damaged else _picture_motion(before, small))
        damaged.append(is_damaged)
        if not is_damaged:
            before = small
    low = WALK_FRAMES_RANGE[0]
    if len(steps) < low:
        raise CaptureError(
            "video-short", f"has {len(steps)} frames; {low} are needed", path=video, remedy="film the scene for longer"
        )
    return _Motion(np.cumsum(steps), np.array(sharpness), np.array(damaged))


def _small_frames(video: Path) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.uint8], bool]]:
    """Grey copies of each frame, not turned, for sharpness and for motion, and whether it is damaged."""
    for frame, is_damaged, *_ in decode_video(video):
        scale = min(1.0, WALK_SHARPNESS_SIDE / max(frame.width, frame.height))
        width, height = (max(16, round(side * scale)) for side in (frame.width, frame.height))
        large = frame.reformat(width, height, format="gray", interpolation="AREA").to_ndarray()
        scale = min(1.0, WALK_FLOW_SIDE / max(width, height))
        size = max(16, round(width * scale)), max(16, round(height * scale))
        yield large, np.asarray(cv2.resize(large, size, interpolation=cv2.INTER_AREA), np.uint8), is_damaged


def _picture_motion(before: NDArray[np.uint8], after: NDArray[np.uint8]) -> float:
    """The median distance of corners from one frame to the next, in longer sides."""
    if before.shape != after.shape:
        return 0.0
    corners = cv2.goodFeaturesToTrack(before, WALK_MAX_CORNERS, WALK_CORNER_QUALITY, WALK_CORNER_DISTANCE)
    if corners is None:
        return 0.0
    moved, found, _ = cv2.calcOpticalFlowPyrLK(before, after, corners, np.zeros_like(corners))
    lengths = np.linalg.norm((moved - corners).reshape(-1, 2), axis=1)[np.asarray(found).ravel() == 1]
    return float(np.median(lengths)) / max(before.shape) if len(lengths) >= WALK_MIN_CORNERS else 0.0


def _choose(motion: _Motion, count: int | None, video: Path) -> list[int]:
    """The numbers of the frames that are taken."""
    way, total = motion.way, float(motion.way[-1])
    if total < WALK_MIN_WAY:
        raise CaptureError(
            "video-still",
            "shows a camera that hardly moves",
            path=video,
            remedy="walk around the scene while filming; videos of several cameras go into one folder",
        )
    low, high = WALK_DEFAULT_RANGE
    steps = min(max(round(total / WALK_DEFAULT_STEP), low), high) if count is None else count
    position = way / total * steps
    step = np.minimum(position.astype(np.int64), steps - 1)
    score = motion.sharpness * (1 - np.abs(position - step - 0.5))
    chosen = []
    for number in range(steps):
        inside = np.flatnonzero((step == number) & ~motion.damaged)
        if len(inside):
            chosen.append(int(inside[np.argmax(score[inside])]))
    return chosen
