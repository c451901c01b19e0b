"""Object stores, `s3://bucket/name`: what is there is copied to this machine's disk, and what is made is copied back.

A store has no folders and no rename. The objects of a stage are therefore put first, and then one more, DONE, with
their digests: a stage without it, or with other bytes than it says, is not finished.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from eigenfield.core.errors import EigenfieldError, OptionError, OutputError
from eigenfield.core.recognise import split_address
from eigenfield.runtime.temporary import temporary_folder

# what each store needs
STORES = {"s3": "'eigenfield[s3]'", "gs": "gcsfs", "az": "adlfs", "abfs": "adlfs", "memory": "fsspec"}
DONE = "DONE"
STAMP_KEYS = "ETag", "etag", "LastModified", "last_modified", "mtime", "created"  # of which each store has one
_LIBRARIES = "botocore", "aiobotocore", "aiohttp", "gcsfs", "google", "azure"  # whose errors are about the store

_copied = contextlib.ExitStack()
_copies: dict[tuple[str, str], Path] = {}  # by address and what the store says of it


def find_objects(path: str | os.PathLike[str]) -> Objects | None:
    """What an address of an object store names; None where `path` is none.

    Args:
        path: As it was given. A `Path` of an address has lost a slash, and is an address all the same.

    Raises:
        OptionError: `extra-missing`: the store needs a package. `store`: it cannot be opened.
    """
    found = split_address(path)
    if found is None or found[0] not in STORES:
        return None
    address = f"{found[0]}://{found[1].strip('/')}"
    try:
        import fsspec

        with _store_errors(address):
            fs, root = fsspec.url_to_fs(address, use_listings_cache=False)
    except ImportError as error:
        message = f"{found[0]}:// needs a package that is not installed"
        raise OptionError("extra-missing", message, path=address, remedy=f"pip install {STORES[found[0]]}") from error
    return Objects(fs, root, address)


def absolute_place(path: str | os.PathLike[str], base: str | os.PathLike[str] = "") -> Path:
    """An address as it is, and another path as an absolute one.

    Args:
        base: Folder or address that a relative path is below. Default: the current folder.
    """
    place = Path(path) if find_objects(path) else Path(base, path)
    return place if find_objects(place) else place.absolute()


def address_of(path: str | os.PathLike[str]) -> str:
    """A path as people write it: an address with both of its slashes."""
    objects = find_objects(path)
    return str(path) if objects is None else objects.address


def refuse_objects(path: str | os.PathLike[str]) -> None:
    """Raise OutputError `output-address` for an address where several files are to be written."""
    objects = find_objects(path)
    if objects is not None:
        message, remedy = "only a single file is written to an object store", "name a place on this machine"
        raise OutputError("output-address", message, path=objects.address, remedy=remedy)


@dataclass(frozen=True)
class Objects:
    """An object, or all objects below a name.

    Attributes:
        fs: An `fsspec.AbstractFileSystem`.
        root: The name in it.
        address: As people write it.
    """

    fs: Any
    root: str
    address: str

    @property
    def bucket(self) -> str:
        """The address of its bucket."""
        scheme, _, rest = self.address.partition("://")
        return f"{scheme}://{rest.partition('/')[0]}"

    def exists(self) -> bool:
        """Whether there is an object of this name. Raises OptionError `object-missing` where there is no bucket."""
        self.check_bucket()
        with _store_errors(self.address):
            return bool(self.fs.isfile(self.root))

    def check_bucket(self) -> None:
        """Before any work: raise OptionError where there is no such bucket, or it cannot be listed."""
        with _store_errors(self.address):
            if not self.fs.exists(self.root.strip("/").partition("/")[0]):
                raise FileNotFoundError

    def names(self) -> list[tuple[str, bool]]:
        """What lies directly below the name: each name, and whether there is more below it. Raises as `read`."""
        with _store_errors(self.address):
            entries = self.fs.ls(self.root, detail=True)
        return [(PurePosixPath(one["name"]).name, one["type"] == "directory") for one in entries]

    def stamps(self) -> list[list[Any]]:
        """Name, size, and digest or time of each object below the name, or of the object. Raises as `read`."""
        with _store_errors(self.address):
            found = self.fs.find(self.root, detail=True)
            if not found:
                raise FileNotFoundError(self.root)
        return [
            [name.removeprefix(self.root), entry["size"], str(next(entry[key] for key in STAMP_KEYS if entry.get(key)))]
            for name, entry in sorted(found.items())
        ]

    def read(self) -> bytes:
        """The bytes of the object.

        Raises:
            OptionError: `object-missing`, `store`.
        """
        with _store_errors(self.address):
            return bytes(self.fs.cat_file(self.root))

    @contextlib.contextmanager
    def local_file(self) -> Iterator[Path]:
        """A path on this machine: what the block writes there becomes the object when the block succeeds."""
        with temporary_folder() as folder:
            place = folder / _inside(PurePosixPath(self.root).name)
            yield place
            with _store_errors(self.address):
                self.fs.put_file(str(place), self.root)

    def copy_to(self, place: Path) -> None:
        """Copy the object, or all objects below the name, to a path where nothing is.

        Raises:
            OptionError: `object-missing`: there is none. `store`.
            OutputError: `object-name`: a name would leave the folder.
        """
        with _store_errors(self.address):
            names = [name for name in self.fs.find(self.root) if not name.endswith("/")]
            if not names:
                raise FileNotFoundError(self.root)
            if names == [self.root]:
                place.parent.mkdir(parents=True, exist_ok=True)
            self._get({name: place / _inside(name.removeprefix(self.root)) for name in names})

    def fetch_stage(self, name: str, place: Path) -> bool:
        """Copy a finished stage to a folder; whether it was there, whole and with the digests that DONE says."""
        try:
            with _store_errors(self.address):
                digests = json.loads(self.fs.cat_file(f"{self.root}/{name}/{DONE}"))
                self._get({f"{self.root}/{name}/{file}": place / _inside(file) for file in digests})
        except OptionError as error:
            if error.code == "object-missing":
                return False
            raise
        return digests == _digests(place)

    def put_stage(self, name: str, place: Path) -> None:
        """Copy the folder of a finished stage to the store, DONE last."""
        digests = _digests(place)
        with _store_errors(self.address):
            if digests:
                self.fs.put([str(place / file) for file in digests], [f"{self.root}/{name}/{file}" for file in digests])
            self.fs.pipe_file(f"{self.root}/{name}/{DONE}", json.dumps(digests).encode())

    def remove_stage(self, name: str) -> None:
        """Remove a stage from the store. Raises OptionError `object-missing`, `store`."""
        with _store_errors(self.address):
            self.fs.rm(f"{self.root}/{name}", recursive=True)

    def _get(self, targets: dict[str, Path]) -> None:
        for target in targets.values():
            target.parent.mkdir(parents=True, exist_ok=True)
        if targets:
            self.fs.get(list(targets), [str(target) for target in targets.values()])


def local_copy(path: str | os.PathLike[str]) -> Path:
    """`path` as it is, or for an address a copy on this machine, made once, and again when the store has other objects.

    A copy keeps its name, and lasts until `remove_copies` or the end of the process.

    Raises:
        OptionError, OutputError: As `Objects.copy_to`.
    """
    objects = find_objects(path)
    if objects is None:
        return Path(path)
    name = _inside(PurePosixPath(objects.root).name)
    key = objects.address, repr(objects.stamps())
    if key not in _copies:
        place = _new_folder() / name
        objects.copy_to(place)
        _copies[key] = place
    return _copies[key]


def local_folder(objects: Objects) -> Path:
    """The folder of this machine in which the stages below an address are built, one for each address."""
    key = objects.address, ""
    if key not in _copies:
        _copies[key] = _new_folder()
    return _copies[key]


@contextlib.contextmanager
def own_copies() -> Iterator[None]:
    """Copies that are made within the block go with it."""
    global _copied, _copies
    before = _copied, _copies
    _copied, _copies = contextlib.ExitStack(), {}
    try:
        yield
    except EigenfieldError as error:
        raise name_address(error) from error.__cause__
    finally:
        _copied.close()
        _copied, _copies = before


def name_address(error: EigenfieldError) -> EigenfieldError:
    """The error with an address for its path as people write it, also where that is of a copy on this machine."""
    if error.path is None:
        return error
    for (address, _), place in _copies.items():
        if Path(error.path).is_relative_to(place):
            error.path = f"{address}/{Path(error.path).relative_to(place).as_posix()}".removesuffix("/.")
            break
    found = split_address(error.path)
    if found is not None:
        error.path = "://".join(found)
    return error


def remove_copies() -> None:
    """Remove all that this process has copied from object stores."""
    _copies.clear()
    _copied.close()


def _new_folder() -> Path:
    return _copied.enter_context(temporary_folder())


atexit.register(remove_copies)


def _inside(name: str) -> str:
    """The relative path of an object's name; OutputError where it would leave the folder."""
    parts = PurePosixPath(name.lstrip("/")).parts
    if ".." in parts or "\\" in name or "\0" in name or Path(*parts).drive:
        message = f"holds an object that is named {name!r}, which is no name of a file"
        raise OutputError("object-name", message, remedy="rename it, or name another prefix")
    return "/".join(parts)


def _digests(folder: Path) -> dict[str, str]:
    """The SHA-256 of every file below a folder, by its relative path."""
    found = {}
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        with path.open("rb") as file:
            found[path.relative_to(folder).as_posix()] = hashlib.file_digest(file, "sha256").hexdigest()
    return found


@contextlib.contextmanager
def _store_errors(address: str) -> Iterator[None]:
    """Turn what a store answers into one line with a remedy; errors of this machine's disk pass through."""
    try:
        yield
    except FileNotFoundError as error:
        message, remedy = "there is no such bucket or object", "check the address"
        raise OptionError("object-missing", message, path=address, remedy=remedy) from error
    except Exception as error:
        name, library = type(error).__name__, type(error).__module__.partition(".")[0]
        refused = isinstance(error, PermissionError)
        if "Credential" in name or (refused and "redential" in str(error)):
            message, remedy = "no credentials for the store are on this machine", "set them as its own tools want"
        elif refused:
            message, remedy = "the store refuses access", "check the credentials and what they allow"
        elif library in _LIBRARIES or (isinstance(error, OSError) and error.errno is None):
            message, remedy = f"the store cannot be used ({_first_line(error)})", "check the address and the network"
        else:
            raise
        raise OptionError("store", message, path=address, remedy=remedy) from error


def _first_line(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0][:160]
