"""What a batch is to do: captures with their options, from a TOML file, a folder, or a list."""

from __future__ import annotations

import difflib
import os
import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from eigenfield.capture.readers.text import excerpt
from eigenfield.core.arguments import in_words, kind_in_words, matches
from eigenfield.core.errors import EigenfieldError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.rights import Rights
from eigenfield.encoding import SURFACE_NAMES, EncodeOptions, Target
from eigenfield.encoding.estimated import surface_to_make
from eigenfield.encoding.target import parse_bitrate, parse_size
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.runtime.objects import absolute_place, address_of, find_objects, local_copy
from eigenfield.runtime.temporary import is_temporary
from eigenfield.viewer.exports.names import file_name

PLACE_KEYS = tuple(one.name for one in fields(OpenOptions) if one.name not in ("strict", "work"))
PATH_KEYS = ("calibration", "masks")  # of PLACE_KEYS
RIGHTS_KEYS = tuple(one.name for one in fields(Rights))
TARGET_KEYS = tuple(f"target_{one.name}" for one in fields(Target))
OPTION_KEYS = tuple(one.name for one in fields(EncodeOptions) if one.name not in ("target", "rights", "keep_maps"))
ALL_KEYS = (*PLACE_KEYS, "proxy", *SURFACE_NAMES, "blind", *TARGET_KEYS, *RIGHTS_KEYS, *OPTION_KEYS)
TYPES = {"name": str, "proxy": str | os.PathLike[str], "blind": bool}  # of what no value of options checks
WHOLE_NUMBER_LIMIT = 2**63  # of TOML
ERROR_MAX_CHARACTERS = 160
VIDEO_AND_ZIP = (".zip", ".mp4", ".mov", ".mkv", ".avi")


@dataclass(frozen=True)
class CaptureJob:
    """One capture of a batch, in plain values that travel to a worker.

    Attributes:
        path: Absolute, or an address of an object store.
        proxy: Likewise of a mesh, if it is given.
        surface: Of the proxy that is made; None: the proxy is given.
    """

    name: str
    path: str
    place: OpenOptions
    proxy: str | None
    options: EncodeOptions
    surface: SurfaceOptions | None

    @property
    def sources(self) -> list[str]:
        """All that is read, but the mesh."""
        named = [self.place.calibration, self.place.masks, *(self.place.also or ())]
        return [self.path, *(os.fspath(path) for path in named if path is not None)]


def read_jobs(source: Path | Sequence[Path], shared: Mapping[str, Any], output: Path | None = None) -> list[CaptureJob]:
    """The captures of a batch, whose names differ.

    Args:
        source: A TOML file, a folder of captures, or captures; each may lie in an object store.
        shared: Options of all captures by name; they go before those in a file, and a capture's own before both.
        output: A folder that holds no captures, though it may lie among them.

    Raises:
        OptionError: `batch-file`, `batch-empty`, `batch-names`, `batch-option`, or of a capture's options.
    """
    if not isinstance(source, Path):
        rows, base, first = [{"path": str(path)} for path in source], Path(), None
    elif source.suffix.lower() == ".toml":
        rows, file_options = _read_toml(source)
        base, first, shared = absolute_place(source).parent, source, {**file_options, **shared}
    elif source.is_dir() or find_objects(source):
        found = [path for path in captures_in(source) if absolute_place(path) != output]
        rows, base, first = [{"path": str(path)} for path in found], Path(), source
    else:
        message = "is no folder of captures and no .toml" if source.exists() else "does not exist"
        raise OptionError(
            "batch-file", message, path=source, remedy="name a folder that holds captures, or a list of them"
        )
    if not rows:
        remedy = "name a folder of which each folder is a capture"
        raise OptionError("batch-empty", "holds no captures", path=first, remedy=remedy)
    jobs = list(_jobs(rows, base, shared, first))
    _refuse_same_names(jobs, first)
    return jobs


def captures_in(folder: Path) -> list[Path]:
    """What may be a capture in a folder: folders, zips and videos, by their names with numbers as numbers."""

    def is_capture(name: str, is_folder: bool) -> bool:
        hidden = name.startswith(".") or is_temporary(Path(name)) or name.endswith("-scenes")
        return not hidden and (is_folder or name.lower().endswith(VIDEO_AND_ZIP))

    objects = find_objects(folder)
    if objects is not None:
        found = objects.names()
    else:
        with os.scandir(folder) as entries:
            found = [(entry.name, entry.is_dir()) for entry in entries]
    return [folder / name for name in sorted((one[0] for one in found if is_capture(*one)), key=_by_number)]


def _by_number(name: str) -> list[Any]:
    return [int(part) if part.isdecimal() else part for part in re.split(r"(\d+)", name)]


def _read_toml(path: Path) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    try:
        document = tomllib.loads(local_copy(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise _file_error(path, str(error.strerror), "name a TOML file with [[capture]] tables") from None
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits, and lists without end
        words = f"is no TOML: {error}".split(";")[0][:ERROR_MAX_CHARACTERS]
        raise _file_error(path, words, "name a TOML file with [[capture]] tables") from None
    rows, shared = document.pop("capture", []), document.pop("options", {})
    if (
        document
        or not isinstance(shared, dict)
        or not isinstance(rows, list)
        or not all(isinstance(r, dict) for r in rows)
    ):
        message = f"has {excerpt(next(iter(document), 'entries'))} where only [options] and [[capture]] are known"
        raise _file_error(path, message, "leave it out, or put it into one of these")
    for row in rows:
        if not isinstance(row.get("path"), str):
            raise _file_error(path, "a [[capture]] has no path", 'say path = "FOLDER" in each')
    named = [_by_name(path, f"capture {number}", row) for number, row in enumerate(rows, 1)]
    return named, _by_name(path, "[options]", shared)


def _by_name(path: Path, where: str, table: dict[str, Any]) -> dict[str, Any]:
    """Options by the names that they have in Python: plain values, and lists of these."""
    for key, value in table.items():
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, dict | list) or (isinstance(each, int) and abs(each) >= WHOLE_NUMBER_LIMIT):
                message = f"{where}: {excerpt(key)} is a table, a list of lists or a number beyond 64 bits"
                raise _file_error(path, message, "options are texts, numbers, true, false, and lists of these")
    named = {key.replace("-", "_"): value for key, value in table.items()}
    if len(named) < len(table):
        raise _file_error(path, f"{where}: an option is there twice, with - and with _", "leave one of them out")
    return named


def _file_error(path: Path, message: str, remedy: str) -> OptionError:
    return OptionError("batch-file", message, path=path, remedy=remedy)


def _jobs(
    rows: Sequence[dict[str, Any]], base: Path, shared: Mapping[str, Any], source: Path | None
) -> Iterator[CaptureJob]:
    jobs: dict[str, CaptureJob] = {}  # by the options: checking them takes longer than all else
    for row in rows:
        options = {**shared, **row}
        path, name = absolute_place(options.pop("path"), base), options.pop("name", None)
        text = repr(options)
        try:
            _check_type("name", name)
            if text not in jobs:
                jobs[text] = _checked(options, base)
        except EigenfieldError as error:
            called = f"{excerpt(name or path.name)}: {error.message}" if set(row) - {"path", "name"} else error.message
            raise OptionError(error.code, called, path=source, remedy=error.remedy) from error
        is_file = path.is_file() or path.name.lower().endswith(VIDEO_AND_ZIP)
        called = path.stem if is_file else path.name
        yield replace(jobs[text], name=file_name(name or called, "capture"), path=address_of(path))


def _checked(given: dict[str, Any], base: Path) -> CaptureJob:
    """A job without a name that has these options."""
    for key in given:
        if key not in ALL_KEYS:
            if key in OpenOptions.renamed:
                OpenOptions(**{key: given[key]})  # says the new name
            near = difflib.get_close_matches(key, ALL_KEYS, n=1)
            remedy = (
                f"did you mean {near[0]}?" if near else "options are named as those of encode: hold_out, preset, ..."
            )
            raise OptionError("batch-option", f"no option is called {excerpt(key)}", remedy=remedy)
        _check_type(key, given[key])
    place = OpenOptions(**_some(given, PLACE_KEYS))
    paths: dict[str, Any] = {
        key: address_of(absolute_place(value, base)) for key, value in _some(vars(place), PATH_KEYS).items()
    }
    if place.also is not None:
        paths["also"] = [address_of(absolute_place(one, base)) for one in place.also]
    proxy = given.get("proxy")
    if isinstance(given.get("target_size"), str):
        given["target_size"] = parse_size(given["target_size"])
    if isinstance(given.get("target_bitrate"), str):
        given["target_bitrate"] = parse_bitrate(given["target_bitrate"])
    target = Target(**{key.removeprefix("target_"): value for key, value in _some(given, TARGET_KEYS).items()})
    rights = Rights(**_some(given, RIGHTS_KEYS))
    named = _some(given, OPTION_KEYS)
    if isinstance(named.get("atlas"), list):
        named["atlas"] = tuple(named["atlas"])
    options = EncodeOptions(
        **named,
        target=None if target == Target() else target,
        rights=None if rights == Rights() else rights,
    )
    if place.clip is None:
        options.refuse_clip_options()
    surface = surface_to_make(
        options, SurfaceOptions(**_some(given, SURFACE_NAMES)), bool(given.get("blind", False)), proxy is not None
    )
    proxy = None if proxy is None else address_of(absolute_place(proxy, base))
    return CaptureJob("", "", replace(place, **paths), proxy, options, surface)


def _some(given: Mapping[str, Any], keys: Collection[str]) -> dict[str, Any]:
    """What is given of some options, by name."""
    return {key: given[key] for key in keys if given.get(key) is not None}


def _check_type(key: str, value: Any) -> None:
    if value is not None and key in TYPES and not matches(value, TYPES[key]):
        raise OptionError("option-type", f"{key} is {kind_in_words(value)}", remedy=f"give {in_words(TYPES[key])}")


def _refuse_same_names(jobs: Sequence[CaptureJob], source: Path | None) -> None:
    found: dict[str, CaptureJob] = {}
    for job in jobs:
        other = found.setdefault(job.name.casefold(), job)
        if other is not job:
            message = f"two captures are called {job.name}: {other.path} and {job.path}"
            raise OptionError(
                "batch-names", message, path=source, remedy='give one of them another name = "..." in a TOML file'
            )
