"""The table of capture formats, and which of them a folder is. A new reader is one file and one row."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.calibration import Calibration
from eigenfield.capture.locate import is_photograph_file
from eigenfield.capture.messages import list_names
from eigenfield.capture.passed_over import describe_passed_over, refuse_foreign
from eigenfield.capture.photographs.kinds import MESH_KIND, OTHER_KINDS, VIDEO_EXTENSIONS
from eigenfield.capture.readers import colmap, transforms
from eigenfield.capture.readers.array5d import ARRAY_ENDINGS, find_array, read_array
from eigenfield.capture.readers.bundler import find_bundler, find_unlisted, read_bundler
from eigenfield.capture.readers.deepview import DEEPVIEW_FILE, find_deepview, read_deepview
from eigenfield.capture.readers.eslf import find_eslf, is_eslf, read_eslf
from eigenfield.capture.readers.folder import find_photographs, read_photographs
from eigenfield.capture.readers.grid_names import find_grid_names, read_grid_names
from eigenfield.capture.readers.hci import find_hci, read_hci
from eigenfield.capture.readers.llff import find_llff, read_llff
from eigenfield.capture.readers.metashape import find_metashape, read_metashape
from eigenfield.capture.readers.middlebury import find_middlebury, read_middlebury
from eigenfield.capture.readers.numbered import read_numbered
from eigenfield.capture.readers.nvm import find_nvm, read_nvm
from eigenfield.capture.readers.opencv import find_opencv, opencv_content, read_opencv
from eigenfield.capture.readers.positions import find_positions, read_positions
from eigenfield.capture.readers.projections import find_projections, read_projections
from eigenfield.capture.readers.quilt import find_quilt, parse_quilt_name, read_quilt
from eigenfield.capture.readers.realitycapture import find_realitycapture, read_realitycapture
from eigenfield.capture.readers.stanford import find_stanford, read_stanford
from eigenfield.capture.readers.strecha import find_strecha, read_strecha
from eigenfield.capture.readers.video import find_videos, read_videos
from eigenfield.capture.readers.walk import find_walk, read_walk
from eigenfield.coding.limits import EXTENSION
from eigenfield.core.errors import CaptureError, OptionError, one_line
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.recognise import SPLAT, read_head, recognise
from eigenfield.core.shell import shell_word

# of the formats that claim a folder, the one of lowest rank is read; two of one rank are ambiguous
RANK_FIRST, RANK_SECOND, RANK_CAMERAS, RANK_NAMES, RANK_ON_REQUEST, RANK_ANY = range(6)


@dataclass(frozen=True)
class Format:
    """One row of the table.

    Attributes:
        name: For --format.
        title: One phrase for people.
        rank: The claim of the lowest rank is taken.
        find: From a folder to what is to be read in it, or None. It looks at names and first bytes only.
        read_cameras: From what `find` returned and the folder of the photographs to the calibration.
        read_names: From what `find` returned and the caller's options to the arrangement.
        endings: Of file names that may be named directly as a calibration of this format.
        uses: Those of "grid", "quilt", "frame", "walk_frames" and "pattern" that the reader uses.
        cameras: Whether it may yield cameras at all.
    """

    name: str
    title: str
    rank: int
    find: Callable[[Path], Path | None]
    read_cameras: Callable[[Path, Path], Calibration] | None = None
    read_names: Callable[[Path, OpenOptions], Arrangement] | None = None
    endings: tuple[str, ...] = ()
    uses: tuple[str, ...] = ()
    cameras: bool = True


def _ignore_root(read: Callable[[Path], Calibration]) -> Callable[[Path, Path], Calibration]:
    """A reader of calibrations that name their photographs."""
    return lambda found, root: read(found)


def _camera_format(
    name: str,
    title: str,
    find: Callable[[Path], Path | None],
    read: Callable[[Path, Path], Calibration],
    *endings: str,
    rank: int = RANK_CAMERAS,
) -> Format:
    return Format(name, title, rank, find, read_cameras=read, endings=endings)


def _name_format(
    name: str,
    title: str,
    find: Callable[[Path], Path | None],
    read: Callable[[Path, OpenOptions], Arrangement],
    *uses: str,
    rank: int = RANK_NAMES,
    cameras: bool = False,
    endings: tuple[str, ...] = (),
) -> Format:
    return Format(name, title, rank, find, read_names=read, uses=uses, cameras=cameras, endings=endings)


FORMATS = (
    _camera_format("transforms", "nerfstudio or instant-ngp transforms.json", transforms.find_transforms,
                   _ignore_root(transforms.read_transforms), ".json", rank=RANK_FIRST),
    _camera_format("colmap", "COLMAP model", colmap.find_colmap, _ignore_root(colmap.read_colmap), rank=RANK_SECOND),
    _camera_format("llff", "LLFF poses_bounds.npy", find_llff, read_llff, ".npy"),
    _camera_format("middlebury", "Middlebury *_par.txt", find_middlebury, _ignore_root(read_middlebury), "_par.txt"),
    _camera_format("strecha", "Strecha *.camera", find_strecha, _ignore_root(read_strecha), ".camera"),
    _camera_format("bundler", "Bundler bundle.out", find_bundler, _ignore_root(read_bundler), ".out"),
    _camera_format("nvm", "VisualSFM NVM", find_nvm, read_nvm, ".nvm"),
    _camera_format("metashape", "Agisoft Metashape XML", find_metashape, _ignore_root(read_metashape), ".xml"),
    _camera_format("opencv", "OpenCV YAML, XML, JSON or TOML", find_opencv, read_opencv, ".yml", ".yaml", ".toml",
                   ".xml"),
    _camera_format("realitycapture", "RealityCapture CSV", find_realitycapture, read_realitycapture, ".csv"),
    _camera_format("deepview", "DeepView models.json", find_deepview, _ignore_root(read_deepview)),
    _camera_format("projections", "3x4 projection matrices", find_projections, _ignore_root(read_projections), "_p.txt",
                   ".p"),
    _name_format("positions", "parallel cameras in names (_RR_CC_A_B_LENS_SENSOR)", find_positions, read_positions,
                 "grid", cameras=True),
    _name_format("hci", "HCI 4D benchmark (input_CamNNN, row-major)", find_hci, read_hci, "grid", cameras=True),
    _name_format("stanford", "Stanford archive (out_RR_CC_V_U: row, column)", find_stanford, read_stanford, "grid"),
    _name_format("grid", "grid names (*_RR_CC: row, column)", find_grid_names, read_grid_names, "grid", "pattern"),
    _name_format("numbered", "numbered frames with --grid", lambda folder: None, read_numbered, "grid",
                 rank=RANK_ON_REQUEST),  # it must be asked for
    _name_format("quilt", "quilt: a row of views in one picture", find_quilt, read_quilt, "quilt"),
    _name_format("eslf", "lenslet picture of a plenoptic camera", find_eslf, read_eslf, "grid"),
    _name_format("array", "array of row, column, y, x and channel (.mat, HDF5)", find_array, read_array, "grid",
                 endings=ARRAY_ENDINGS),
    _name_format("video", "one video a camera", find_videos, read_videos, "frame", rank=RANK_ANY),
    _name_format("walk", "one video of a walk", find_walk, read_walk, "walk_frames", rank=RANK_ANY),
    _name_format("folder", "plain folder of photographs", find_photographs, read_photographs, rank=RANK_ANY),
)  # fmt: skip
# files that a folder does not hold by chance: if no reader claims one of these, it is damaged or incomplete
CALIBRATION_PATTERNS = (
    "transforms.json", "poses_bounds.npy", "*_par.txt", "*.camera", "bundle.out", "bundle/bundle.out", "*.nvm",
    "cameras.xml", "sparse/[0-9]*/images.*", "sparse/[0-9]*/cameras.*", "sparse/images.*", "sparse/cameras.*",
    "*_P.txt",
)  # fmt: skip
FORMATS_BY_NAME = {row.name: row for row in FORMATS}


@dataclass(frozen=True)
class Claim:
    """A format that a folder has."""

    format: Format
    found: Path
    problems: tuple[str, ...] = ()


def format_by_name(name: str) -> Format:
    """The row of a name; OptionError `format-unknown`."""
    if name not in FORMATS_BY_NAME:
        raise OptionError(
            "format-unknown", f"--format {name} is none", remedy=f"say one of {', '.join(FORMATS_BY_NAME)}"
        )
    return FORMATS_BY_NAME[name]


def detect_format(folder: Path, formats: tuple[Format, ...], options: OpenOptions) -> Claim | None:
    """The format of a folder among `formats`: every row is asked, cameras go before names, and names before nothing.

    None where nothing claims it. Raises CaptureError `format-ambiguous` where two claims weigh the same.
    """
    if options.grid is not None and FORMATS_BY_NAME["numbered"] in formats:
        claims = _find_claims(folder, tuple(row for row in formats if row.rank < RANK_ON_REQUEST))
        if not claims and find_photographs(folder):
            claims = [Claim(FORMATS_BY_NAME["numbered"], folder)]
    else:
        claims = _find_claims(folder, formats)
    if not claims:
        return None
    rank = min(claim.format.rank for claim in claims)
    best = [claim for claim in claims if claim.format.rank == rank]
    if len(best) > 1:
        titles = " or ".join(f"{claim.format.name}: {claim.format.title}" for claim in best)
        raise _ambiguous_error(folder, titles, [claim.format for claim in best])
    also = [claim for claim in claims if rank < claim.format.rank < RANK_NAMES]
    lines = tuple(
        f"{_relative_name(c.found, folder)} is there too, not read; --format {c.format.name} reads it" for c in also
    )
    if rank >= RANK_NAMES and any(row.read_cameras for row in formats):
        lines += tuple(_describe_unread(folder))
    return Claim(best[0].format, best[0].found, lines)


def _ambiguous_error(path: Path, titles: str, rows: list[Format]) -> CaptureError:
    remedy = "say " + " or ".join(f"--format {row.name}" for row in rows)
    return CaptureError("format-ambiguous", f"may be read as {titles}", path=path, remedy=remedy)


def _describe_unread(folder: Path) -> list[str]:
    unlisted = find_unlisted(folder)
    paths = [path for pattern in CALIBRATION_PATTERNS for path in sorted(folder.glob(pattern)) if path != unlisted]
    found = [_relative_name(path, folder) for path in paths]
    lines = [f"{list_names(found)}: named as a calibration, but damaged or incomplete, and not read"] if found else []
    if unlisted is not None:
        name = _relative_name(unlisted, folder)
        lines.append(
            f"{name}: a Bundler file without the list of its photographs, and not read; put list.txt beside it"
        )
    return lines + describe_passed_over(folder, {*paths, unlisted})


def _find_claims(folder: Path, formats: tuple[Format, ...]) -> list[Claim]:
    """Each row's claim; where cameras claim the folder, names are not asked, and where names do, nothing else is."""
    for ranks in ((RANK_FIRST, RANK_SECOND, RANK_CAMERAS), (RANK_NAMES,), (RANK_ON_REQUEST,), (RANK_ANY,)):
        found = [(row, row.find(folder)) for row in formats if row.rank in ranks]
        if claims := [Claim(row, place) for row, place in found if place is not None]:
            return claims
    return []


def _relative_name(found: Path, folder: Path) -> str:
    return one_line(found.relative_to(folder).as_posix() if found.is_relative_to(folder) else str(found))


def claim_of_file(path: Path, formats: tuple[Format, ...], options: OpenOptions) -> Claim:
    """The format of a file that is named: a calibration, the video of a walk, or all views in one file.

    Raises CaptureError: `calibration-unknown`, `calibration-foreign`, `format-ambiguous`.
    """
    if FORMATS_BY_NAME["walk"] in formats and path.name.lower().endswith(VIDEO_EXTENSIONS):
        return Claim(FORMATS_BY_NAME["walk"], path)
    if FORMATS_BY_NAME["quilt"] in formats and is_photograph_file(path):
        if options.quilt is not None or parse_quilt_name(path) is not None:
            return Claim(FORMATS_BY_NAME["quilt"], path)
        if is_eslf(path):
            return Claim(FORMATS_BY_NAME["eslf"], path)
    if len(formats) > 1 and path.name == DEEPVIEW_FILE and find_deepview(path.parent) == path:
        return Claim(FORMATS_BY_NAME["deepview"], path)
    if len(formats) > 1:
        refuse_foreign(path)
    if len(formats) > 1 and path.suffix.lower() == ".json":
        in_opencvs_terms = not transforms.is_transforms(path) and opencv_content(path) == "poses"
        return Claim(FORMATS_BY_NAME["opencv" if in_opencvs_terms else "transforms"], path)
    if FORMATS_BY_NAME["colmap"] in formats and path.stem in ("cameras", "images") and colmap.is_model(path.parent):
        return Claim(FORMATS_BY_NAME["colmap"], path.parent)
    if len(formats) == 1:
        return Claim(formats[0], path)
    fitting = [row for row in formats if path.name.lower().endswith(row.endings)]
    certain = [row for row in fitting if row.find(path.parent) == path]
    if len(certain or fitting) > 1:
        raise _ambiguous_error(path, " or ".join(row.name for row in certain or fitting), certain or fitting)
    if not fitting:
        raise _not_a_calibration(path)
    return Claim((certain or fitting)[0], path)


def _not_a_calibration(path: Path) -> CaptureError:
    """The error for a file that is named and of no format, which says what it is as far as its name does."""
    lower = path.name.lower()
    kind = next((kind for kind in (*OTHER_KINDS, MESH_KIND) if lower.endswith(kind.endings)), None)
    message, remedy = (
        "is no calibration",
        "name a transforms.json, a COLMAP model, another that `eigenfield help captures` lists",
    )
    remedy += ", or a folder with one"
    if is_photograph_file(path):
        message = "is one photograph, and no calibration"
        remedy = f"name the folder of all photographs: {shell_word(path.parent)}, or say --quilt COLUMNSxROWS"
    elif kind is not None:
        head = read_head(path)
        what = recognise(head) or kind.what
        message, remedy = f"is {what}, and no calibration", kind.remedy
        if EXTENSION.encode() in head:
            message, remedy = (
                "is a finished scene",
                "look at it with `eigenfield view SCENE`; in Python, `ef.load` opens it",
            )
        elif what == SPLAT:
            remedy = "name the folder of the photographs that it was trained on"
    return CaptureError("calibration-unknown", message, path=path, remedy=remedy)
