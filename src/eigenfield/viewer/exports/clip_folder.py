"""A clip whose groups are files, for a web server that knows no ranges, and for clips of more than 4 GiB."""

from __future__ import annotations

import os
from pathlib import Path

from eigenfield.core.clip import Clip
from eigenfield.gltf import clip_in_files
from eigenfield.gltf.source import SCENE_FILE
from eigenfield.gltf.write_clip import group_files
from eigenfield.viewer.exports.folder import atomic_folder, write_file, write_listing


def write_clip_folder(clip: Clip | str | os.PathLike[str], folder: Path, *, overwrite: bool = False) -> None:
    """Write a clip, or the one in a file of either form, as `SCENE_FILE` with its groups and its sound beside it.

    The bytes of groups are copied.

    Raises:
        OptionError: `clip-groups`: the clip is of no coded groups.
        OutputError: As `refuse_folder`; the folder cannot be written.
        FormatError: As `load_clip`; a group cannot be read.
    """
    made = clip_in_files(clip)
    with atomic_folder(folder, overwrite) as part:
        with (part / SCENE_FILE).open("wb") as file:
            file.writelines(made.scene)
        for name, data in group_files(made.groups, made.audio):
            write_file(part / name, data)
        write_listing(part, "folder", {})
