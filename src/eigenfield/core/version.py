"""The version, in a place of its own: files name it, and `eigenfield` itself imports everything."""

__version__ = "0.1.0"
