"""Pictures into an .mp4: H.264, 4:2:0, BT.709, the same bytes for the same pictures."""

from __future__ import annotations

import io
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.rendering.spherical import with_boxes
from eigenfield.runtime.files import atomic_writer

if TYPE_CHECKING:
    from av.container import OutputContainer

VIDEO_CRF = 16  # x264's constant rate factor: visually lossless
VIDEO_ENCODER_THREADS = 2  # fixed: x264's bytes depend on it
# With x264's mbtree, bytes vary between runs
VIDEO_ENCODER_OPTIONS = {"crf": str(VIDEO_CRF), "preset": "medium", "x264-params": "mbtree=0"}
VIDEO_BT709, VIDEO_LIMITED_RANGE = 1, 1  # as libavutil numbers them


def write_video(
    path: Path,
    pictures: Iterable[NDArray[np.uint8]],
    fps: Fraction,
    *,
    sound: tuple[bytes, float] | None = None,
    boxes: bytes = b"",
    overwrite: bool = False,
) -> None:
    """Write pictures as H.264 in an .mp4, which appears whole or not at all.

    Odd sizes gain a row or column, a copy of the last: 4:2:0 needs even ones.

    Args:
        pictures: (H, W, 3) uint8, of one size.
        fps: Pictures a second.
        sound: An Ogg file of Opus, kept as it is, and the second of it with which the first picture is shown.
        boxes: What the description of the pictures ends with (`spherical.vr_boxes`).

    Raises:
        OutputError: The file cannot be written.
    """
    import av

    with atomic_writer(path, overwrite=overwrite) as file:
        film = io.BytesIO() if boxes else file
        with av.open(film, "w", format="mp4") as container:
            _encode(container, pictures, fps, sound)
        if isinstance(film, io.BytesIO):
            file.write(with_boxes(film.getvalue(), boxes))


def _encode(
    container: OutputContainer, pictures: Iterable[NDArray[np.uint8]], fps: Fraction, sound: tuple[bytes, float] | None
) -> None:
    import av

    stream, heard, number = None, None, -1
    for number, picture in enumerate(pictures):
        planes = yuv420(picture)
        if stream is None:
            height, width = planes[0].shape
            stream = container.add_stream("libx264", rate=fps, options=VIDEO_ENCODER_OPTIONS)
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
            context = stream.codec_context
            context.thread_count = VIDEO_ENCODER_THREADS
            context.color_primaries = context.color_trc = context.colorspace = VIDEO_BT709
            context.color_range = VIDEO_LIMITED_RANGE
            heard = None if sound is None else _Sound(container, *sound)  # its track comes after that of the pictures
        stacked = np.concatenate([plane.reshape(-1) for plane in planes])
        frame = av.VideoFrame.from_ndarray(stacked.reshape(-1, planes[0].shape[1]), format="yuv420p")
        frame.color_primaries = frame.color_trc = frame.colorspace = VIDEO_BT709
        frame.color_range = VIDEO_LIMITED_RANGE
        frame.pts, frame.time_base = number, 1 / fps
        container.mux(stream.encode(frame))
        if heard is not None:
            heard.mux((number + 1) / fps)
    if stream is not None:
        container.mux(stream.encode(None))


class _Sound:
    """The sound of a film: packets of a file, moved in time."""

    def __init__(self, container: OutputContainer, data: bytes, start: float) -> None:
        import av

        self._container, self._start = container, start
        self._source = av.open(io.BytesIO(data))
        (given, *_) = self._source.streams.audio
        self._stream = container.add_stream_from_template(given)
        self._packets = self._source.demux(given)
        self._next = next(self._packets, None)

    def mux(self, until: Fraction) -> None:
        """Write the packets that are heard before a time of the film in seconds."""
        while (packet := self._next) is not None and packet.pts is not None:
            assert packet.time_base is not None
            time = packet.pts * packet.time_base - Fraction(self._start)
            if time >= until:
                return
            if time >= 0:
                packet.pts = packet.dts = round(time / packet.time_base)
                packet.stream = self._stream
                self._container.mux(packet)
            self._next = next(self._packets, None)


def yuv420(picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.uint8]]:
    """BT.709 Y' (H, W), Cb and Cr (H / 2, W / 2) in limited range.

    Chroma samples lie where H.264 expects them: level with the left of two columns, between two rows.

    Args:
        picture: (H, W, 3) uint8 RGB; odd sizes are padded.
    """
    height, width = picture.shape[:2]
    padded = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    rgb = padded.astype(np.float32) / np.float32(255)
    luma = rgb @ np.array(LUMA_BT709, np.float32)
    cb, cr = (rgb[..., 2] - luma) / np.float32(1.8556), (rgb[..., 0] - luma) / np.float32(1.5748)
    blue, red = (_to_bytes(128 + 224 * _halve_chroma(plane)) for plane in (cb, cr))
    return _to_bytes(16 + 219 * luma), blue, red


def _halve_chroma(plane: NDArray[np.floating]) -> NDArray[np.floating]:
    """(H, W) to (H / 2, W / 2): means of two rows, and (1 2 1) / 4 around every second column."""
    rows = (plane[0::2] + plane[1::2]) / 2
    left = np.concatenate([rows[:, :1], rows[:, 1:-1:2]], axis=1)
    return (left + 2 * rows[:, 0::2] + rows[:, 1::2]) / 4


def _to_bytes(plane: NDArray[np.floating]) -> NDArray[np.uint8]:
    return np.clip(np.rint(plane), 0, 255).astype(np.uint8)
