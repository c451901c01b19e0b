"""The version, in a place of its own: files name it, and `eigenfield` itself imports everything."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("eigenfield")
except PackageNotFoundError:  # a source tree that was not installed
    __version__ = "0.0.0"
