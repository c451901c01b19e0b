"""Sound for clips: an Ogg file of Opus whose pitch says the second."""

from __future__ import annotations

import io

import av
import numpy as np

RATE = 48_000  # samples a second


def opus(seconds: float = 1.0) -> bytes:
    """A tone of 200 Hz in the first second, of 400 Hz in the second one, and so on."""
    time = np.arange(round(RATE * seconds)) / RATE
    samples = (0.3 * np.sin(2 * np.pi * 200 * (1 + np.floor(time)) * time)).astype(np.float32)
    data = io.BytesIO()
    with av.open(data, "w", format="ogg") as container:
        stream = container.add_stream("libopus", rate=RATE, layout="mono")
        frame = av.AudioFrame.from_ndarray(samples[None], format="fltp", layout="mono")
        frame.sample_rate, frame.pts = RATE, 0
        resampler = av.AudioResampler(format=stream.codec_context.format, layout="mono", rate=RATE, frame_size=960)
        for part in [*resampler.resample(frame), *resampler.resample(None)]:
            container.mux(stream.encode(part))
        container.mux(stream.encode(None))
    return data.getvalue()
