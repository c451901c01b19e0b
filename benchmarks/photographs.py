"""Bare photographs to a scene at `balanced`: seconds, bytes and PSNR, beside SVT-AV1 preset 6 on the same views in the
same run; with --before also those of an earlier version, one run of each in turns.

    EIGENFIELD_DATA=captures python benchmarks/photographs.py [tarot-9x9 shop fern] [--before CHECKOUT] [--store]
    EIGENFIELD_DATA=captures python benchmarks/photographs.py --hand-held [--store]    # the README's rows: no seconds

Each measurement is a process of its own with its own work folder. Kernels are compiled before, which a first run does.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import measure

CRF = 40
HAND_HELD = {"cube": "cube_colmap_mesh/images", "fern": "llff_fern/images"}  # photographs, and nothing beside them


def photographs(name: str, folder: Path) -> tuple[Path, list[str]]:
    """A folder of photographs, and the arguments of `encode` that it needs."""
    data = measure.data()
    if name == "shop":
        return data / "shop_9x9", []
    if name == "fern":
        return data / "llff_fern", []
    if name != "tarot-9x9":
        raise SystemExit(f"no capture is called {name}: tarot-9x9, shop or fern")
    place = folder / name
    place.mkdir()
    for row in range(0, 17, 2):
        for column in range(0, 17, 2):
            file = f"out_{row:02d}_{column:02d}.jpg"
            (place / file).symlink_to(data / "tarot_17x17_512" / "images" / file)
    return place, ["--grid", "9x9"]


def video(capture: str) -> None:
    """Child: SVT-AV1 preset 6, one key frame, 4:2:0 10 bit, on the photographs in the order of their names."""
    import av
    import numpy as np

    from eigenfield.capture import open_any
    from eigenfield.runtime.parallel import ordinary_scheduling

    opened = open_any(capture)
    pictures = [np.rint(opened.photograph(i).pixels * 255).astype(np.uint8) for i in range(len(opened))]
    height, width = (side // 2 * 2 for side in pictures[0].shape[:2])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "views.mkv"
        started = time.perf_counter()
        with av.open(str(path), "w") as container:
            stream = container.add_stream("libsvtav1", rate=30, options={"preset": "6", "crf": str(CRF), "g": "999"})
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p10le"
            with ordinary_scheduling():
                stream.codec_context.open()
            for picture in pictures:
                frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture[:height, :width]), format="rgb24")
                container.mux(stream.encode(frame))
            container.mux(stream.encode())
        print(json.dumps({"seconds": round(time.perf_counter() - started, 2), "bytes": path.stat().st_size}))


def encode(capture: Path, arguments: list[str], tree: Path | None = None) -> dict[str, Any]:
    """One whole encode: seconds, peak memory, bytes, and dB of the captured views as this version draws them."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "scene.glb"
        command = ["-m", "eigenfield", "encode", str(capture), *arguments, "-o", str(output), "--quiet"]
        found = measure.run(command, tree)
        measured = measure.run(["-m", "eigenfield", "evaluate", str(output), str(capture), *arguments, "--json", "-q"])
        image = json.loads(measured["output"])["image"]["encoded"]
        return {
            "seconds": found["seconds"], "peak_mb": found["peak_anonymous_mb"], "bytes": output.stat().st_size,
            **{key: round(image[key], 4) for key in ("psnr", "psnr_luma", "ssim")},
        }  # fmt: skip


def hand_held() -> dict[str, Any]:
    """Bytes and quality of hand-held captures, whatever else the machine does."""
    captures = {}
    for name, place in HAND_HELD.items():
        with tempfile.TemporaryDirectory() as folder:
            for file in (measure.data() / place).iterdir():
                (Path(folder) / file.name).symlink_to(file)
            case = encode(Path(folder), [])
        captures[name] = {key: case[key] for key in case if key not in ("seconds", "peak_mb")}
    return captures


def main() -> None:
    if sys.argv[1:2] == ["av1"]:
        video(sys.argv[2])
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", default=["tarot-9x9", "shop", "fern"])
    parser.add_argument("--before", type=Path, help="checkout of an earlier version")
    parser.add_argument("--hand-held", action="store_true", help="bare photographs of hand-held captures")
    parser.add_argument("--store", action="store_true")
    options = parser.parse_args()
    if options.hand_held:
        found = {"captures": hand_held()}
        print(json.dumps(found, indent=1))
        if options.store:
            print(f"stored as {measure.store('hand-held', found)}")
        return
    figures: dict[str, Any] = {"crf": CRF, "captures": {}}
    if options.before is not None:
        figures["before"] = measure.commit(options.before)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.captures:
            capture, arguments = photographs(name, Path(folder))
            peer = json.loads(measure.run([str(Path(__file__).resolve()), "av1", str(capture)])["output"])
            case: dict[str, Any] = {"encode": encode(capture, arguments), "svt_av1_preset_6": peer}
            ratio = {"seconds_to_svt_av1": round(case["encode"]["seconds"] / peer["seconds"], 1)}
            if options.before is not None:
                case["before"] = encode(capture, arguments, options.before)
                ratio["seconds_to_before"] = round(case["encode"]["seconds"] / case["before"]["seconds"], 3)
                ratio["bytes_to_before"] = round(case["encode"]["bytes"] / case["before"]["bytes"], 3)
            figures["captures"][name] = {**case, "ratio": ratio}
            print(name, json.dumps(figures["captures"][name], indent=1), flush=True)
    if options.store:
        print(f"stored as {measure.store('photographs', figures)}")


if __name__ == "__main__":
    main()
