"""Chart pictures on disk: which camera took each, and which were taken at the same time.

left01.jpg right01.jpg ..      one folder: the camera is the name without its last number, the number is the moment
left/01.jpg right/01.jpg ..    a folder a camera: the last number in the name is the moment
left.mp4 right.mp4             a video a camera: frame i of every video is moment i
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import av
import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.locate import files_named, photographs_in
from eigenfield.capture.messages import natural_key
from eigenfield.capture.photographs.read import decode, read_header
from eigenfield.capture.readers.video import find_film
from eigenfield.core.errors import CaptureError, one_line
from eigenfield.core.spread import spread_indices

CHART_VIDEO_SUFFIXES = (".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v")
CHART_MAX_VIDEO_FRAMES = 300  # evenly spread over the video
CHART_MAX_LISTED_NAMES = 5  # in one line


@dataclass(frozen=True)
class ChartCamera:
    """The chart pictures of one camera.

    Attributes:
        name: The name that this camera's photographs of a scene will have.
        paths: Its pictures, one a moment, or its one video.
        moments: Index into `ChartPictures.moments` of each picture (of each frame that is used).
        size: (width, height) pixels.
        frames: Frames of the video that are used; None for pictures.
    """

    name: str
    paths: tuple[Path, ...]
    moments: tuple[int, ...]
    size: tuple[int, int]
    frames: tuple[int, ...] | None = None

    @property
    def is_video(self) -> bool:
        """Whether the pictures are frames of a video."""
        return self.frames is not None

    def sample(self, count: int) -> ChartCamera:
        """The same camera with fewer pictures, evenly spread.

        Args:
            count: How many at most.
        """
        if len(self.moments) <= count:
            return self
        chosen = spread_indices(len(self.moments), count)
        return replace(
            self,
            paths=self.paths if self.is_video else tuple(self.paths[i] for i in chosen),
            moments=tuple(self.moments[i] for i in chosen),
            frames=None if self.frames is None else tuple(self.frames[i] for i in chosen),
        )


@dataclass(frozen=True)
class ChartPictures:
    """All chart pictures of a rig.

    Attributes:
        cameras: In natural order of their names.
        moments: Names of the moments at which the pictures were taken, in order.
    """

    root: Path
    cameras: tuple[ChartCamera, ...]
    moments: tuple[str, ...]
    problems: tuple[str, ...]


def find_charts(root: Path) -> ChartPictures:
    """The chart pictures or videos below a folder; only headers are read.

    A folder that holds nothing but one folder stands for that one. Pictures that cannot be read, differ in size from
    the rest of their camera, or share a moment with another are listed in `problems` and left out.

    Raises:
        CaptureError: `capture-missing`: no such folder. `charts-empty`: it holds no readable pictures.
    """
    if not root.is_dir():
        raise CaptureError("capture-missing", "is no folder of chart pictures", path=root, remedy="check the path")
    root = _descend_folders(root)
    videos = _videos_by_camera(root)
    if videos:
        return _from_videos(root, videos)
    by_camera = _pictures_by_camera(root)
    if not by_camera:
        raise CaptureError(
            "charts-empty",
            "holds no pictures and no videos of a chart",
            path=root,
            remedy="name the folder with left01.jpg, right01.jpg .., with a folder a camera, or with a video a camera",
        )
    return _from_pictures(root, by_camera)


def decode_frames(camera: ChartCamera) -> Iterator[tuple[int, NDArray[np.uint8]]]:
    """The moment and the (H, W) grey picture of each used frame of a video, decoded one after the other.

    Args:
        camera: A camera with a video.

    Raises:
        CaptureError: `video-unreadable`: the video is damaged before its last used frame.
    """
    assert camera.frames is not None
    wanted = dict(zip(camera.frames, camera.moments, strict=True))
    path = camera.paths[0]
    try:
        with av.open(str(path), metadata_errors="replace") as container:
            for index, frame in enumerate(container.decode(find_film(container))):
                if index in wanted:
                    yield wanted[index], frame.to_ndarray(format="gray")
                if index >= camera.frames[-1]:
                    return
    except (av.FFmpegError, IndexError) as error:
        raise _unreadable_video(path, error) from error


def read_grey_picture(path: Path) -> NDArray[np.uint8]:
    """A photograph as (H, W) uint8 grey levels, upright.

    Raises:
        CaptureError: As `decode`.
    """
    colours, _ = decode(path)
    return np.asarray(np.rint(cv2.cvtColor(colours, cv2.COLOR_RGB2GRAY) * 255), np.uint8)


def _descend_folders(root: Path) -> Path:
    """Down through folders that hold nothing of ours but one other folder."""
    while not photographs_in(root) and not _videos_in(root):
        inner = [folder for folder in _folders(root) if photographs_in(folder) or _videos_in(folder)]
        below = [folder for folder in _folders(root) if folder not in inner]
        if len(inner) == 1:
            root = inner[0]
        elif not inner and len(below) == 1:
            root = below[0]
        else:
            break
    return root


def _folders(root: Path) -> list[Path]:
    folders = (path for path in root.iterdir() if path.is_dir() and not path.name.startswith("."))
    return sorted(folders, key=lambda path: natural_key(path.name))


def _videos_in(folder: Path) -> list[Path]:
    return sorted(files_named(folder, CHART_VIDEO_SUFFIXES), key=lambda path: natural_key(path.name))


def _videos_by_camera(root: Path) -> dict[str, Path]:
    """Videos of a folder by their names, or the one video of each folder by the folder's name."""
    here = _videos_in(root)
    if here:
        return {one_line(path.stem): path for path in here}
    below = {folder: _videos_in(folder) for folder in _folders(root)}
    return {one_line(folder.name): videos[0] for folder, videos in below.items() if len(videos) == 1}


def _pictures_by_camera(root: Path) -> dict[str, list[tuple[str, Path]]]:
    """Pictures with their moments, by camera."""
    cameras: dict[str, list[tuple[str, Path]]] = {}
    here = photographs_in(root)
    if here:
        for path in here:
            name, moment = split_name(path.stem)
            cameras.setdefault(one_line(name or root.name), []).append((moment, path))
        return cameras
    for folder in _folders(root):
        pictures = photographs_in(folder)
        if pictures:
            numbers = [split_name(path.stem)[1] for path in pictures]
            by_number = all(numbers) and len(set(numbers)) == len(numbers)
            moments = numbers if by_number else [path.stem for path in pictures]
            cameras[one_line(folder.name)] = list(zip(moments, pictures, strict=True))
    return cameras


def split_name(stem: str) -> tuple[str, str]:
    """The camera and the number in a file name: ("left", "1") of left01, left_01 or 01_left.

    Returns:
        The rest of the name, and the number without leading zeros, "" if there is none.
    """
    if match := re.fullmatch(r"(.*?)[\s_.-]*([0-9]+)", stem):
        return match[1], str(int(match[2]))
    if match := re.fullmatch(r"([0-9]+)[\s_.-]*(.*)", stem):
        return match[2], str(int(match[1]))
    return stem, ""


def _from_pictures(root: Path, by_camera: dict[str, list[tuple[str, Path]]]) -> ChartPictures:
    problems: list[str] = []
    kept = {name: _usable_pictures(name, pictures, problems) for name, pictures in by_camera.items()}
    moments = sorted({moment for pictures in kept.values() for moment in pictures}, key=natural_key)
    index = {moment: i for i, moment in enumerate(moments)}
    cameras = []
    for name in sorted(kept, key=natural_key):
        pictures = sorted(kept[name].items(), key=lambda item: index[item[0]])
        if pictures:
            size = pictures[0][1][1]
            paths = tuple(path for _, (path, _) in pictures)
            cameras.append(ChartCamera(name, paths, tuple(index[moment] for moment, _ in pictures), size))
        else:
            problems.append(f"camera {name}: none of its {len(by_camera[name])} pictures can be read")
    if not cameras:
        raise CaptureError(
            "charts-empty", f"none of its pictures can be read ({problems[0]})", path=root, remedy="copy them again"
        )
    return ChartPictures(root, tuple(cameras), tuple(moments), tuple(problems))


def _usable_pictures(
    name: str, pictures: Iterable[tuple[str, Path]], problems: list[str]
) -> dict[str, tuple[Path, tuple[int, int]]]:
    """Path and size of each moment's picture, all of one size; the rest is listed in `problems`."""
    found: dict[str, tuple[Path, tuple[int, int]]] = {}
    for moment, path in pictures:
        try:
            size = read_header(path).upright_size
        except CaptureError as error:
            problems.append(f"{error} (left out)")
            continue
        if moment in found:
            problems.append(f"{path}: the same moment as {found[moment][0].name} (left out)")
        else:
            found[moment] = (path, size)
    sizes = Counter(size for _, size in found.values())
    if len(sizes) > 1:
        usual = max(sizes, key=lambda size: (sizes[size], size))
        odd = [moment for moment, (_, size) in found.items() if size != usual]
        shown = ", ".join(one_line(found[m][0].name) for m in odd[:CHART_MAX_LISTED_NAMES])
        shown += " .." if len(odd) > CHART_MAX_LISTED_NAMES else ""
        problems.append(f"camera {name}: {len(odd)} pictures are not {usual[0]}x{usual[1]} (left out): {shown}")
        found = {moment: value for moment, value in found.items() if value[1] == usual}
    return found


def _from_videos(root: Path, videos: dict[str, Path]) -> ChartPictures:
    problems: list[str] = []
    lengths: dict[str, tuple[int, tuple[int, int]]] = {}
    for name, path in videos.items():
        try:
            lengths[name] = _video_length(path)
        except CaptureError as error:
            problems.append(f"{error} (left out)")
    if not lengths:
        raise CaptureError(
            "charts-empty", f"none of its videos can be read ({problems[0]})", path=root, remedy="copy them again"
        )
    counts = {name: count for name, (count, _) in lengths.items()}
    shared = min(counts.values())
    if max(counts.values()) != shared:
        counted = ", ".join(f"{name} {count}" for name, count in counts.items())
        problems.append(f"the videos differ in length ({counted} frames): frame i of each is taken as the same moment")
    step = -(-shared // CHART_MAX_VIDEO_FRAMES)
    chosen = tuple(range(0, shared, step))
    moments = tuple(f"frame {frame}" for frame in chosen)
    every = tuple(range(len(chosen)))
    cameras = tuple(ChartCamera(name, (videos[name],), every, size, chosen) for name, (_, size) in lengths.items())
    return ChartPictures(root, cameras, moments, tuple(problems))


def _video_length(path: Path) -> tuple[int, tuple[int, int]]:
    """Number of frames, by counting packets (headers are often wrong), and size."""
    try:
        with av.open(str(path), metadata_errors="replace") as container:
            stream = find_film(container)
            if stream is None:
                raise _unreadable_video(path, "it has no pictures")
            count = sum(1 for packet in container.demux(stream) if packet.size)
            size = (int(stream.codec_context.width), int(stream.codec_context.height))
    except (av.FFmpegError, OSError) as error:
        raise _unreadable_video(path, error) from error
    if count < 1:
        raise _unreadable_video(path, "it has no frames")
    return count, size


def _unreadable_video(path: Path, why: object) -> CaptureError:
    text = getattr(why, "strerror", None) or str(why)
    message = f"is damaged or no video ({text.splitlines()[0][:120]})"
    return CaptureError("video-unreadable", message, path=path, remedy="copy it again, or take it out")
