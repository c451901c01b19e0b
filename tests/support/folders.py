"""What a folder holds."""

from __future__ import annotations

import hashlib
from pathlib import Path


def folder_digest(folder: Path) -> str:
    """SHA-256 of the names and bytes of all that is in it."""
    total = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        total.update(str(file.relative_to(folder)).encode())
        total.update(file.read_bytes() if file.is_file() else b"")
    return total.hexdigest()
