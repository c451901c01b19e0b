"""Results of an evaluation, made up, as the report hands them to its page."""

from __future__ import annotations

import math

import numpy as np
from PIL import Image


def image(psnr, cameras, coverage=1.0):
    worst = {
        key: {"value": value, "camera": "07_11.jpg"}
        for key, value in (("psnr", psnr - 3), ("ssim", 0.9), ("flip", 0.2))
    }
    return {
        "cameras": cameras, "psnr": psnr, "ssim": 0.931, "psnr_full": psnr - 0.5, "ssim_full": 0.925,
        "psnr_luma": psnr + 2,
        "psnr_luma_full": psnr + 1.4, "flip": 0.071, "coverage": coverage, "worst": worst,
    }  # fmt: skip


def curve(key, name, kind, chroma, factor, top):
    points = [
        {
            "parameter": 30 + 10 * i, "bytes": int(factor * 2.0e6 / 2.3**i), "psnr": top - 2.1 * i,
            "psnr_luma": top + 1.6 - 2 * i,
            "ssim": 0.97 - 0.02 * i, "psnr_full": top - 2.2 * i, "psnr_luma_full": top + 1.2 - 2 * i,
            "ssim_full": 0.965 - 0.02 * i,
            "worst": {"psnr": {"value": top - 5, "camera": "00_00"}}, "encode_seconds": 40.0 / (i + 1),
            "access_seconds": {"first": 0.48, "next": 0.02} if kind == "ours" else {"middle": 0.8 * factor,
            "last": 1.7 * factor},
        }
        for i in range(4)
    ]  # fmt: skip
    return {"name": name, "key": key, "kind": kind, "chroma": chroma, "points": points}


def capture(name, seed, picture):
    """All steps of one capture, in the shape that the runner writes."""
    top = 31.0 + seed % 5
    curves = [
        curve(None, "eigenfield", "ours", None, 0.6, top),
        curve("svt-av1-2", "SVT-AV1 preset 2, 4:2:0", "video", "420", 0.5 if seed % 3 else 0.9, top + 3),
        curve("svt-av1-6", "SVT-AV1 preset 6, 4:2:0", "video", "420", 0.8, top + 2.8),
        curve("x265-420", "x265 slow, 4:2:0", "video", "420", 1.0, top + 2),
        curve("x265-444", "x265 slow, 4:4:4", "video", "444", 1.1, top + 3),
        curve("libaom-444", "libaom cpu 6, 4:4:4", "video", "444", 0.7, top + 3.4),
        curve("avif", "AVIF a view, 4:4:4", "still", "444", 4.0, top + 1),
        curve("jpeg-xl", "JPEG XL a view", "still", "444", 6.0, top + 1.5),
    ]
    steps = {
        "scene": {
            "encode": {"seconds": 128.4, "peak_mb": 1685, "command": f"eigenfield encode {name} --density 1"},
            "bytes": {"total": 980_000, "mean": 90_000, "textures": 800_000, "weights": 20_000, "mesh": 65_000,
            "other": 5_000},
            "textures": 15, "density": 1.0, "atlas": [1024, 1024], "encoded": image(top, 289),
            "hold_out_rule": "views with an odd row or an odd column",
            "held_scene": {"bytes": 940_000, "encoded": image(top, 81), "held_out": image(top - 0.7, 208)},
            "uv": {"ssim": 0.97, "psnr": 36.2}, "ratio": {"photographs": 9.9, "raw": 231.6, "texture_maps_png": 418.0},
        },
        "paper": {
            "curve": [
                {"textures": n, **{way: {"uv_ssim": 1 - 0.09 * math.exp(-n / scale),
                "uv_psnr": 30 + 3 * math.log(1 + n), "bytes": 60_000 * (n + 1),
                                         "saving": 0.99 - 0.0011 * n} for way, scale in (("plain", 12), ("aligned",
                                         9))}}
                for n in (0, 1, 2, 4, 7, 10, 15, 20, 25, 30)
            ],
            "table": {
                "photographs_bytes": 9_700_000, "raw_bytes": 227_000_000, "maps_png_bytes": 410_000_000,
                "rows": [{"label": f"{n} textures", "textures": n, "aligned": True, "uv_ssim": 0.96 + n / 1000,
                "bytes": 60_000 * n,
                          "percent_of_maps": 0.31, "saving": 0.9969} for n in (7, 15)],
            },
            "fps": [{"textures": n, "bilinear": 900 / (4 + n), "bicubic": 600 / (4 + n)} for n in (1, 5, 15, 40)],
            "view": [1024, 768],
            "figure6": [{"camera": "08_08.jpg", "photograph": picture, "proxy": picture, "own_map": picture,
            "eigen": picture, "error": picture,
                         "psnr_own": 34.1, "psnr_eigen": 31.9}],
        },
        "losses": {
            "cameras": 25, "words": "What stays in the last row is visibility, coverage and 8 bits.",
            "rows": [
                {"key": key, "title": title, "psnr": top + i, "psnr_luma": top + 2 + i, "psnr_of_mse": top + i - 0.3,
                "mse": 60.0 / (i + 1),
                 **({} if key == "file" else {"share": share}), **({} if key in ("file",
                 "left") else {"gain": 0.4 * i})}
                for i, (key, title, share) in enumerate((
                    ("file", "the file", None), ("codec", "without the codec", 0.11), ("quantisation",
                    "without quantisation", 0.004),
                    ("truncation", "without truncation", 0.41), ("resampling", "without resampling", 0.19), ("left",
                    "what stays", 0.286)))
            ],
            "displacement": {"psnr": top + 1.9, "mse": 30.0, "gain": 1.7, "share": 0.32, "median_px": 0.31,
            "p95_px": 1.1,
                             "control": {"psnr": top + 4, "gain": 0.2, "share": 0.05, "median_px": 0.05,
                             "p95_px": 0.2}},
            "alone": [{"key": "quantisation", "title": "float textures", "psnr": top, "psnr_luma": top, "mse": 9.0,
            "gain": 0.01, "share": 0.002},
                      {"key": "resampling", "title": "denser", "left_out": "too large to encode again"}],
        },
        "rates": {
            "ceiling": {"psnr": top + 3.4, "psnr_luma": top + 30, "ssim": 0.99},
            "curves": curves, "coverage": 0.997, "views": 81, "of": 289, "order": "serpentine",
            "bd": {
                c["name"]: {
                    "psnr": None if c["key"] == "jpeg-xl" else (c["key"] == "svt-av1-2") * 53.8 - 20.0 + seed,
                    "psnr_luma": 12.0 - 2 * seed, "ssim": -3.0, "psnr_gain": 0.4, "psnr_luma_gain": None,
                }
                for c in curves[1:]
            },
            "left_out": ["VP9: not asked for"],
            "crops": [{"label": label, "bytes": 240_000, "psnr": 31.2, "picture": picture} for label in ("photograph",
            "ours", "SVT-AV1 preset 2")],
        },
        "between": {
            "cameras": 25, "rule": "odd rows and columns", "held_out": 208, "encoded": 81, "holes": 0.001,
            "words": "All ways over the same pixels.",
            "bytes": {"photographs": 2_700_000, "avif_50": 700_000, "avif_counted": "12 of 81, scaled up",
            "scene": 940_000, "mesh": 65_000},
            "methods": [
                {"key": key, "title": title, "psnr": value, "psnr_luma": value + 2, "psnr_full": value - 0.1,
                "ssim": 0.9, "flip": 0.1, "coverage": 1.0,
                 "worst": {"psnr": {"value": value - 2, "camera": "01_01"}}, "seconds": 0.02}
                for key, title, value in (
                    ("nearest", "photograph of the nearest encoded camera", 21.0), ("blend",
                    "photographs of the neighbours, blended", 22.3),
                    ("lumigraph", "unstructured lumigraph, 4 photographs", top - 0.6 + (seed == 1)), ("nearest3",
                    "our scene, nearest3 view weights", top - 0.9),
                    ("bilinear", "our scene, bilinear view weights", top - 0.7))
            ],
            "pictures": [{"label": "photograph", "picture": picture}],
        },
        "studies": {
            "title": "One parameter at a time, the others as by default.",
            "tables": [{"title": "Atlas density", "columns": ["density", "MB", "PSNR dB", "words"],
                        "rows": [[0.5, 0.41, 28.113, "coarse"], [1.0, 0.98, 29.9, ""], [3, 4.2, None, None]],
                        "words": "Held-out views."}],
        },
    }  # fmt: skip
    frame = {
        "commit": "abc1234",
        "command": f"python benchmarks/report.py {name}",
        "date": "2025-11-21T23:10:00Z",
        "seconds": 75.0,
    }
    return {
        "title": f"{name.capitalize()}, 17 x 17", "folder": f"{name}_17x17_512", "views": 289, "size": [512, 512],
        "note": "resized from 1024 x 1024",
        "licence": "Stanford Light Field Archive",
        "geometry": {**frame, "figures": {"reconstructed": True, "seconds": 612.0, "peak_mb": 2100}},
        "steps": {key: {**frame, "figures": value} for key, value in steps.items()},
    }  # fmt: skip


PAPER = {
    "ssim_098_textures": 15, "views": 289, "saving_percent": [96, 97], "megabytes": [9.5, 14.8], "fps": 60,
    "fps_textures": 40,
    "gpu": "GTX 1080", "abstract_saving": 95, "note": "Only Tarot is among our captures, and resized.",
}  # fmt: skip


def full(folder, names=("tarot", "fern", "cube"), picture=None):
    """Results with every part, and the pictures they name."""
    if picture is None:
        picture = "pictures/tiny.webp"
        (folder / "pictures").mkdir(parents=True, exist_ok=True)
        Image.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(folder / picture, lossless=True)
    return {
        "schema": "eigenfield.report/1", "command": "python benchmarks/report.py", "quick": False,
        "started": "2025-11-21T22:00:00Z",
        "seconds": 9000.0, "commit": "abc1234", "machine": {"processor": "Some CPU", "cores": 2, "memory_gb": 8,
        "python": "3.13"},
        "left_out": ["VP9"], "paper": PAPER, "captures": {name: capture(name, i, picture) for i,
        name in enumerate(names)},
    }  # fmt: skip
