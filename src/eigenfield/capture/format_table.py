"""What `docs/capture-formats.md` says of each format, made from the readers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from eigenfield.capture.formats import FORMATS
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.capture.readers import colmap, transforms
from eigenfield.capture.readers.bundler import BUNDLER_LISTS
from eigenfield.capture.readers.grid_names import GRID_MAX_NODE_NUMBER, GRID_WORDS
from eigenfield.capture.readers.metashape import METASHAPE_LENS_MODELS, METASHAPE_PARAMETERS
from eigenfield.capture.readers.walk import WALK_MAX_FRAMES


@dataclass(frozen=True)
class FormatNotes:
    """What is said of a format.

    Attributes:
        found: What a folder of the format holds.
        cameras: Whether it has cameras.
        writers: Programs and data sets that write it; in brackets what was tried.
        reads: What is read of it.
        refuses: What is refused or left out, with a line that names it.
        traps: What people get wrong.
    """

    found: str
    cameras: str
    writers: str
    reads: str
    refuses: str
    traps: str


def _codes(words: Iterable[str]) -> str:
    return " ".join(f"`{word}`" for word in words)


FORMAT_NOTES = {
    "transforms": FormatNotes(
        "`transforms.json`; else `transforms_train.json`, `_val` and `_test` together; any other `.json` that is named",
        "yes",
        "nerfstudio, instant-ngp (its fox), the original NeRF, eigenfield",
        f"models {', '.join((*transforms.TRANSFORMS_PERSPECTIVE_MODELS, *transforms.TRANSFORMS_FISHEYE_MODELS))}; "
        f"{_codes(transforms.TRANSFORMS_LENS_KEYS)} `k5` `k6` or `distortion_params`, `is_fisheye`, angles, "
        "`mask_path`, `applied_transform`; of a frame or of the file",
        "other models; other keys that look like a lens and are not 0 (`s1`, `K1`, `distortion`); `k4` of no model",
        "camera axes OpenGL; `applied_transform` ([which frame](#conventions)); `fl_x` goes before an angle that "
        "contradicts it, with a line",
    ),
    "colmap": FormatNotes(
        "`cameras` and `images`, `.bin` or `.txt`, in `sparse/N`, `sparse`, the folder, `colmap/sparse/N`",
        "yes",
        "COLMAP (pycolmap 4.2), and programs that export its models",
        f"models {', '.join(colmap.COLMAP_MODELS)}; of several `sparse/N` the one of most images, with a line",
        f"cameras of the models {', '.join(colmap.COLMAP_UNREAD_MODELS)}, and the views of these alone",
        "world-to-camera; photographs undistorted or not: the model must be of the same ones",
    ),
    "llff": FormatNotes(
        "`poses_bounds.npy`",
        "yes",
        "LLFF (its fern), Neural 3D Video beside `cam00.mp4` ...",
        "float arrays of n x 17, either byte and row order; depth bounds",
        "other arrays; another number of photographs or videos than rows",
        "no names: row i is the i-th photograph by name; axes are (down, right, backwards); sizes are of the unreduced "
        "photographs",
    ),
    "middlebury": FormatNotes(
        "`*_par.txt` that begins with a count",
        "yes",
        "the Middlebury multi-view benchmark (its temple)",
        "K with skew, R, t",
        "lines of other lengths",
        "no sizes; the position of pixel centres is not documented",
    ),
    "strecha": FormatNotes(
        "`NAME.jpg.camera` in the folder or one inside",
        "yes",
        "Strecha's benchmark (its fountain)",
        "K with skew, R, centre, size",
        "radial coefficients that are not 0",
        "R is camera-to-world, although P = K [R^T, -R^T C]",
    ),
    "bundler": FormatNotes(
        "`bundle.out` or another `*.out` that begins as one, and its list: "
        f"{_codes(BUNDLER_LISTS)}, `NAME.list.txt`, or any text of as many "
        "photographs, beside it, above or in `prepare/`",
        "yes",
        "Bundler, COLMAP, VisualSFM, Metashape",
        "f, k1, k2; quoted and absolute paths",
        "cameras that were not registered; a list of another length",
        "y up, looking along -z; the principal point is the middle; f = 0 is a camera that was not registered",
    ),
    "nvm": FormatNotes(
        "`*.nvm` that begins with NVM_V3",
        "yes",
        "VisualSFM (its description)",
        "f, pose, the radial coefficient; `FixedK`; the first model, with a line about others",
        "other heads; a radial coefficient whose inverse misses a photograph's corner by a quarter of a pixel",
        "the radial coefficient is of the measured point, not of the ideal one; the principal point is the middle",
    ),
    "metashape": FormatNotes(
        "an Agisoft Metashape or PhotoScan `*.xml`",
        "yes",
        "Metashape, PhotoScan",
        f"camera types {', '.join(METASHAPE_LENS_MODELS)}; {_codes(sorted(METASHAPE_PARAMETERS))}; components, "
        "multi-camera systems (`master_id`)",
        "other camera types, and the views of these alone; disabled and unaligned cameras; files with a DTD",
        "cx, cy count from the middle; p1 and p2 are exchanged against OpenCV's",
    ),
    "opencv": FormatNotes(
        "YAML, TOML, or OpenCV's XML *with poses*; JSON if it is named",
        "yes",
        "OpenCV, EasyMocap, CMU Panoptic, Caliscope, Anipose, ROS and others",
        "K or `fx` `fy` `cx` `cy`; 1, 2, 4, 5, 8, 12 or 14 coefficients, or `k1` `k2` `p1` ... by name; fisheye; one "
        "file a camera or one for all; aliases of YAML",
        "other lens models; keys that look like a lens and are not known; rotations in degrees; 3 or 6 coefficients, "
        "whose order is not certain",
        "pixel centres count from 0 (half a pixel is added); key names are not fixed: those in common use are known; a "
        "file that numbers its cameras means `cam_0`, `camera_0` or `port_0`",
    ),
    "realitycapture": FormatNotes(
        "a `*.csv` with the columns `#name` ... `heading` `pitch` `roll` `f`",
        "yes",
        "RealityCapture, RealityScan: Internal/External camera parameters",
        "f, px, py, k1 to k4, t1, t2; commas or semicolons",
        "geographic coordinates (no columns `x` `y`)",
        "no sizes; lengths are fractions of the longer side; z is up; the division model looks as Brown's",
    ),
    "deepview": FormatNotes(
        "`models.json` of cameras",
        "yes",
        "DeepView's light-field videos (the example of their description)",
        "fisheye and perspective, up to four and three radial coefficients",
        "other projections; rotations in degrees",
        "names are those of the videos; the position of pixel centres is not documented",
    ),
    "projections": FormatNotes(
        "`NAME_P.txt`, `NAME.P`, or `NAME.txt` in `txt/` and the like",
        "yes",
        "PMVS, CMVS, many data sets",
        "3x4 matrices, with or without the word CONTOUR",
        "matrices without a camera",
        "3x4 up to scale and sign; the position of pixel centres is not documented",
    ),
    "positions": FormatNotes(
        "`NAME_RR_CC_A_B_LENS_SENSOR.jpg`",
        "yes, from the names",
        "Blender with light-field-renderer's names",
        "positions, focal length",
        "other names",
        "A is *minus* the height, B the position to the right, millimetres; columns may run left; parallel, no zero "
        "plane",
    ),
    "hci": FormatNotes(
        "`input_CamNNN.*`; `parameters.cfg`",
        "with the cfg",
        "the HCI 4D benchmark (its boxes)",
        "the grid; focal length, baseline and focus of the cfg",
        "a cfg of another grid, which leaves a grid without cameras",
        "NNN counts *row by row*, rows run down; without the cfg the grid must be square, or `--grid` says it",
    ),
    "stanford": FormatNotes(
        "`out_RR_CC.*`, `out_RR_CC_V_U.*`, `jpg_out_...`",
        "no",
        "the Stanford light field archive (tarot, jelly beans)",
        "row, column, positions",
        "positions that do not follow the grid",
        "*row, column*; V before U, +U right, +V down; the directions of rows and columns differ from set to set",
    ),
    "grid": FormatNotes(
        "`*_RR_CC*.*`, also with `-`, `x`, a comma or a space between: the two numbers that vary; or words before "
        f"them, {', '.join(f'`{row}` `{column}`' for row, column in sorted(GRID_WORDS))}; or as "
        "`--pattern 'view_{row}_{col}.png'` says",
        "no",
        "people",
        "row, column",
        f"numbers beyond {GRID_MAX_NODE_NUMBER}, and grids of which less than half is there, unless they are asked for",
        "the directions of rows and columns are unknown; a single row or column must be asked for; if the photographs "
        "move as if the column came first, the two are exchanged with a warning",
    ),
    "numbered": FormatNotes(
        "`--grid RxC` and names with one number that varies",
        "no",
        "people, scripts",
        "row by row; as many as nodes, or the numbers say which are missing",
        "other counts",
        "it must be asked for",
    ),
    "video": FormatNotes(
        f"two or more videos ({_codes(VIDEO_EXTENSIONS)}), in the folder or in `videos/`",
        "no",
        "cameras, phones",
        "one frame of each (`--frame 12`, `--frame 2.5s`), turned and mirrored as the display matrix says",
        "videos that are shorter",
        "they must start together; beside a calibration they take the photographs' place",
    ),
    "walk": FormatNotes(
        "one video that is named, or alone in a folder",
        "no",
        "phones, cameras",
        "sharp frames, evenly spread by how far the picture moves (`--frames N`)",
        f"more than {WALK_MAX_FRAMES} frames, cameras that stand still",
        "turning on the spot moves the picture too, and gives no depth: walk",
    ),
    "folder": FormatNotes(
        "photographs, any names",
        "no",
        "people",
        "EXIF's focal length",
        "less than three photographs",
        "nothing is known of the array; structure from motion is used, which fails on rectified grids",
    ),
}  # fmt: skip


def sections_of_formats() -> str:
    """A table of all `FORMATS` and a section for each, in Markdown: `docs/capture-formats.md` has them."""
    lines = ["| `--format` | what is found |", "|---|---|"]
    lines += [f"| [`{row.name}`](#{row.name}) | {FORMAT_NOTES[row.name].found} |" for row in FORMATS]
    for row in FORMATS:
        notes = FORMAT_NOTES[row.name]
        lines += ["", f"### {row.name}", "", f"- **Written by:** {notes.writers}.", f"- **Cameras:** {notes.cameras}."]
        lines += [f"- **Read:** {notes.reads}."]
        lines += [f"- **Refused or left out, by name:** {notes.refuses}.", f"- **Traps:** {notes.traps}."]
    return "\n".join(lines)
