"""A scene as flat Gaussians on its proxy ("splats"), for the viewers of these."""

from __future__ import annotations

from eigenfield.viewer.exports.splats.write import check_splats, write_splats

__all__ = ["check_splats", "write_splats"]
