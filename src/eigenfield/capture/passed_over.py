"""Lines about calibrations that lie beside photographs and that no reader takes: cameras that a user has are named.

Files are told by their content: by the marks of a program, or by keys of intrinsics and of a pose. Nothing is parsed
but what the reader of OpenCV's terms may read.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from eigenfield.capture.messages import list_names
from eigenfield.capture.readers.opencv import OPENCV_FOLDERS, opencv_content
from eigenfield.capture.readers.text import files_in, read_head
from eigenfield.capture.readers.transforms import is_transforms
from eigenfield.core.errors import CaptureError

PASSED_OVER_FOLDERS = (*OPENCV_FOLDERS, "cams", "pose", "poses", "images")
PASSED_OVER_MAX_FILES = 200  # of a folder that are looked into
PASSED_OVER_HEAD_BYTES = 64 * 1024
PASSED_OVER_TEXTS = (".json", ".yml", ".yaml", ".toml")
PASSED_OVER_NAMED = (".json", ".yml", ".yaml", ".npz", ".xmp", ".log")  # by which a file of no reader may be named
PASSED_OVER_ENDINGS = (*PASSED_OVER_TEXTS, ".xml", ".txt", ".log", ".npz", ".xmp", ".tum")


@dataclass(frozen=True)
class ForeignCalibration:
    """Calibrations of a program whose files are not read.

    Attributes:
        what: One of them is, with its article.
        remedy: What to do about it, an imperative.
        endings: Of their names.
        marks: Each is in the first bytes.
    """

    what: str
    remedy: str
    endings: tuple[str, ...]
    marks: tuple[str, ...]


NUMBER, ZERO, ONE = r"[-+]?\d[\d.]*(?:e[-+]?\d+)?", r"-?0[0.]*(?:e[-+]?0+)?", r"1(?:\.0*)?(?:e[-+]?0+)?"
WRITE_TRANSFORMS = "write the cameras as a transforms.json"
FOREIGN_CALIBRATIONS = (
    ForeignCalibration("an OpenMVG sfm_data", "convert {it} with `openMVG_main_openMVG2Colmap`", (".json",),
                       (r'"sfm_data_version"',)),
    ForeignCalibration("an OpenSfM reconstruction", "convert {it} with `opensfm export_colmap`", (".json",),
                       (r'"shots"', r'"rotation"')),
    ForeignCalibration("cameras of a Gaussian splatting", "name the COLMAP model that it was trained on", (".json",),
                       (r'"img_name"', r'"rotation"')),
    ForeignCalibration("a list of poses as SDFStudio has it", WRITE_TRANSFORMS, (".json",), (r'"camtoworld"',)),
    ForeignCalibration("a camera chain of Kalibr", "write each camera's pose from the first as R and T beside its "
                       "intrinsics", (".yml", ".yaml"), (r"\bT_(cn_cnm1|cam_imu)\b",)),
    ForeignCalibration("a camera of MVSNet", WRITE_TRANSFORMS, (".txt",), (r"\A\s*extrinsic\b",)),
    ForeignCalibration("a calibration of Middlebury's stereo sets", WRITE_TRANSFORMS, (".txt",), (r"\A\s*cam0\s*=",)),
    ForeignCalibration("a trajectory of poses", WRITE_TRANSFORMS, (".log", ".txt"),
                       (rf"\A\s*\d+[ \t]+\d+[ \t]+\d+[ \t\r]*\n\s*{NUMBER}(\s+{NUMBER}){{15}}\s",)),
    ForeignCalibration("a trajectory of poses", WRITE_TRANSFORMS, (".txt", ".tum"),
                       (rf"\A(#[^\n]*\n)*({NUMBER}([ \t]+{NUMBER}){{7}}[ \t]*\r?\n){{3}}",)),
    ForeignCalibration("a pose", WRITE_TRANSFORMS, (".txt",),
                       (rf"\A\s*{NUMBER}(\s+{NUMBER}){{11}}(\s+{ZERO}){{3}}\s+{ONE}\s*\Z",)),
    ForeignCalibration("cameras of NeuS or IDR", WRITE_TRANSFORMS, (".npz",), (r"world_mat_0",)),
    ForeignCalibration("a BlocksExchange", "export the cameras as Agisoft XML, or for Bundler", (".xml",),
                       (r"<BlocksExchange",)),
    ForeignCalibration("RealityCapture's metadata of a photograph", "export Internal/External camera parameters as CSV",
                       (".xmp",), (r"xcr:",)),
)  # fmt: skip
# words of a bounded length, so that a search takes no more than its text
KEY, W = r"""(?:^|[\s"'{,\[-])(%s)["']?\s{0,9}[:=]""", r"\w{0,24}"
INTRINSICS_KEY = KEY % (
    rf"k|k_{W}|k\d|m\d|mtx{W}|{W}matrix{W}|intrinsic{W}|f[xy]|fl_[xy]|focal{W}|camera_angle_{W}|{W}fov{W}"
)
POSE_KEY = KEY % (
    rf"r|rvecs?|rot{W}|extrinsic{W}|transform{W}|cam{W}world|c2w|w2c|world{W}cam{W}|pose{W}|tvecs?|trans{W}|position|"
    rf"quat{W}|q[wxyz]|t_{W}"
)


def describe_passed_over(folder: Path, named: Collection[Path | None] = ()) -> list[str]:
    """A line for each remedy, such as "camchain.yaml looks like a calibration and is not read (a camera chain of
    Kalibr): ...".

    Args:
        folder: Of the photographs; usual folders of calibrations in it are looked into as well.
        named: Files of which other lines speak.
    """
    found: dict[str, list[str]] = defaultdict(list)
    for name in dict.fromkeys(PASSED_OVER_FOLDERS):
        paths = [path for path in files_in(folder / name) if path.name.lower().endswith(PASSED_OVER_ENDINGS)]
        for path in paths[:PASSED_OVER_MAX_FILES]:
            if path not in named and (why := _recognise(path)) is not None:
                found[why].append(path.relative_to(folder).as_posix())
    return [
        f"{list_names(names)} {_looks(names)} ({why.format(it='it' if len(names) == 1 else 'one')}"
        for why, names in found.items()
    ]


def refuse_foreign(path: Path) -> None:
    """CaptureError `calibration-foreign` for a calibration that is named, of a program whose files are not read."""
    if path.suffix.lower() in PASSED_OVER_NAMED and not is_transforms(path) and opencv_content(path) != "poses":
        kind = _foreign_kind(path, _head(path))
        if kind is not None:
            remedy = kind.remedy.format(it="it")
            raise CaptureError("calibration-foreign", f"is not read ({kind.what})", path=path, remedy=remedy)


def _looks(names: list[str]) -> str:
    return "looks like a calibration and is not read" if len(names) == 1 else "look like calibrations and are not read"


def _head(path: Path) -> str:
    return read_head(path, PASSED_OVER_HEAD_BYTES).decode("latin-1")


def _foreign_kind(path: Path, head: str) -> ForeignCalibration | None:
    kinds = (kind for kind in FOREIGN_CALIBRATIONS if path.name.lower().endswith(kind.endings))
    return next((kind for kind in kinds if all(re.search(mark, head) for mark in kind.marks)), None)


def _recognise(path: Path) -> str | None:
    """What a calibration is, and the remedy; None for another file."""
    head, lower = _head(path), path.name.lower()
    kind = _foreign_kind(path, head)
    if kind is not None:
        return f"{kind.what}): {kind.remedy}"
    if lower.endswith(".json") and is_transforms(path):
        return "a transforms.json): name {it} with --calibration"
    flags = re.IGNORECASE | re.MULTILINE
    if not lower.endswith(PASSED_OVER_TEXTS) or not re.search(INTRINSICS_KEY, head, flags):
        return None
    content = opencv_content(path)
    if content == "poses":
        return "in OpenCV's terms): name {it} with --calibration"
    if content == "intrinsics":
        return "intrinsics without poses): name {it} with --intrinsics of `eigenfield calibrate CAPTURE`"
    return f"of no known program): {WRITE_TRANSFORMS}" if re.search(POSE_KEY, head, flags) else None
