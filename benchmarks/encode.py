"""Encoding Tarot: seconds, memory and bytes, beside scikit-learn's PCA and SVT-AV1 in the same run.

    EIGENFIELD_DATA=captures python benchmarks/encode.py

Each measurement is a process of its own; kernels are compiled before (the first run is not counted).
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import measure

TEXTURES, SIDE = 15, 1024


def tarot() -> Path:
    return measure.data() / "tarot_17x17_512"


def encode_arguments(output: Path, *more: str) -> list[str]:
    capture = tarot()
    return [
        "-m", "eigenfield", "encode", str(capture), "--calibration", str(capture / "calibration" / "refined.json"),
        "--proxy", str(capture / "calibration" / "proxy.ply"), "--atlas", str(SIDE), "-n", str(TEXTURES),
        "--fit", "none", "-o", str(output), "--overwrite", "--quiet", *more,
    ]  # fmt: skip


def every_second_row() -> str:
    """Names of the odd rows, to be held out: half the cameras."""
    return ",".join(f"out_{row:02d}_{column:02d}.jpg" for row in range(1, 17, 2) for column in range(17))


def principal_components() -> None:
    """Child: scikit-learn's randomised PCA on the matrix that `encode` decomposes, made beforehand and not counted."""
    import numpy as np
    from sklearn.decomposition import PCA

    from eigenfield.capture import open_capture
    from eigenfield.encoding.atlas import make_atlas
    from eigenfield.encoding.projected.mean import mean_map
    from eigenfield.encoding.projected.project import texture_maps
    from eigenfield.proxy import prepare_proxy

    capture = open_capture(tarot(), calibration=tarot() / "calibration" / "refined.json")
    cameras = [view.camera for view in capture.views]
    mesh = prepare_proxy(tarot() / "calibration" / "proxy.ply", cameras)
    with texture_maps(make_atlas(mesh, SIDE, SIDE), cameras, capture) as maps:
        mean = mean_map(maps)
        matrix = np.where(maps.seen[..., None] > 0, maps.values, mean.values).reshape(len(cameras), -1)
    started = time.perf_counter()
    PCA(TEXTURES, svd_solver="randomized", random_state=0).fit(matrix)
    print(json.dumps({"fit_seconds": round(time.perf_counter() - started, 2), "matrix": list(matrix.shape)}))


def video() -> None:
    """Child: SVT-AV1 preset 6, one key frame, serpentine order, 4:2:0 10 bit, on the same photographs."""
    import av
    import numpy as np

    from eigenfield.capture import open_capture
    from eigenfield.runtime.parallel import ordinary_scheduling

    capture = open_capture(tarot(), calibration=tarot() / "calibration" / "refined.json")
    order = [17 * row + (column if row % 2 == 0 else 16 - column) for row in range(17) for column in range(17)]
    pictures = [np.rint(capture.photograph(i).pixels * 255).astype(np.uint8) for i in order]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "views.mkv"
        started = time.perf_counter()
        with av.open(str(path), "w") as container:
            stream = container.add_stream("libsvtav1", rate=30, options={"preset": "6", "crf": "40", "g": "999"})
            stream.width, stream.height, stream.pix_fmt = 512, 512, "yuv420p10le"
            with ordinary_scheduling():
                stream.codec_context.open()
            for picture in pictures:
                container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            container.mux(stream.encode())
        seconds = time.perf_counter() - started
        print(json.dumps({"encode_seconds": round(seconds, 2), "bytes": path.stat().st_size, "crf": 40}))


def main() -> None:
    own = str(Path(__file__).resolve())
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "tarot.glb"
        measure.run(encode_arguments(output))
        whole = measure.run(encode_arguments(output))
        size = output.stat().st_size
        half = measure.run(encode_arguments(output, "--hold-out", every_second_row()))
    pca = measure.run([own, "pca"])
    av1 = measure.run([own, "av1"])
    pca_figures, av1_figures = json.loads(pca["output"]), json.loads(av1["output"])
    figures: dict[str, Any] = {
        "capture": "tarot_17x17_512", "atlas": SIDE, "textures": TEXTURES,
        "encode": {"seconds": whole["seconds"], "peak_anonymous_mb": whole["peak_anonymous_mb"], "bytes": size},
        "encode_every_second_row": {key: half[key] for key in ("seconds", "peak_anonymous_mb")},
        "scikit_learn_pca": {**pca_figures, "peak_anonymous_mb": pca["peak_anonymous_mb"]},
        "svt_av1_preset_6": {**av1_figures, "peak_anonymous_mb": av1["peak_anonymous_mb"]},
        "ratio": {
            "memory_all_to_every_second_row": round(whole["peak_anonymous_mb"] / half["peak_anonymous_mb"], 3),
            "memory_to_scikit_learn": round(whole["peak_anonymous_mb"] / pca["peak_anonymous_mb"], 3),
            "whole_encode_seconds_to_pca_fit": round(whole["seconds"] / pca_figures["fit_seconds"], 2),
            "whole_encode_seconds_to_svt_av1": round(whole["seconds"] / av1_figures["encode_seconds"], 2),
        },
    }  # fmt: skip
    print(json.dumps(figures, indent=1))
    print(f"stored as {measure.store('encode', figures)}")


if __name__ == "__main__":
    {"pca": principal_components, "av1": video}.get(sys.argv[-1], main)()
