"""Files that are named by their content, and the links with plain names to them.

The name of such a file contains a hash of all that it is made of, so that a file that exists is
right, unless it is damaged.
"""

from __future__ import annotations

import filecmp
import os
import shutil
from pathlib import Path

from microslip.foundation.files import writing_beside
from microslip.sweeps import batch

GAPS = ".gaps"
"""Ending of a marker file beside a dataset in which points have failed. Each run makes this dataset
again."""


def is_whole(path: Path) -> bool:
    """True unless a file is truncated, or in another format than its ending says.  Batch files are
    compared with their checksum, and must not contain points that failed."""
    if path.suffix == ".jsonl":
        return batch.is_final(path)
    try:
        with open(path, "rb") as file:
            head, size = file.read(64), file.seek(0, os.SEEK_END)
            file.seek(max(size - 12, 0))
            tail = file.read().rstrip()
    except OSError:
        return False
    if path.suffix == ".nc":  # HDF5 stores the size of the file
        place = 28 if head[8:9] >= b"\2" else 40
        stored = int.from_bytes(head[place : place + 8], "little")
        return head.startswith(b"\x89HDF") and stored == size
    return tail.endswith((b"IEND\xaeB`\x82", b"%%EOF", b"</html>"))


def link(file: Path, plain: Path) -> None:
    """Let a plain name refer to a file: by a symbolic link, or by a copy where links are not
    possible.  Another file with this name, which may belong to the user, is renamed."""
    target = os.path.relpath(file, plain.parent)
    if plain.is_symlink():
        if os.readlink(plain) == target:
            return
    elif plain.exists():
        if filecmp.cmp(file, plain):
            return
        copies = file.parent.glob(f"{plain.stem}.*{plain.suffix}")
        if not any(filecmp.cmp(copy, plain) for copy in copies):
            os.replace(plain, plain.with_name(f"{plain.name}.replaced"))
    with writing_beside(plain) as beside:
        try:
            beside.symlink_to(target)
        except (OSError, NotImplementedError):
            shutil.copy2(file, beside)


def remove_others(path: Path) -> None:
    """Remove the damaged files that a new file replaces. Only the number at the end of their names
    differs."""
    stem, ending = path.name.partition("-")[0].removesuffix(path.suffix), path.suffix
    for other in path.parent.glob(f"{stem}*{ending}"):
        same = other.stem.partition("-")[0] == stem
        marker = other.with_suffix(GAPS)
        if same and other != path and (marker.exists() or not is_whole(other)):
            other.unlink(missing_ok=True)
            marker.unlink(missing_ok=True)
