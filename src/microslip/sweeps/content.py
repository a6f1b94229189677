"""Files whose names depend on their content, and links with plain names to these files.

The name of a file contains a hash of everything that the file is made from.  A file that exists and
is undamaged is therefore up to date.
"""

from __future__ import annotations

import filecmp
import os
import shutil
from pathlib import Path

from microslip.foundation.files import writing_beside
from microslip.sweeps import batch

GAPS = ".gaps"
"""Ending of the marker file beside a dataset with failed points.  Each run of the workflow makes
such a dataset again."""


def is_whole(path: Path) -> bool:
    """Return False if a file is truncated, or if its format does not match its ending.  A batch
    file must also have a correct checksum and no failed points."""
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
    """Make a file available under a plain name, as a symbolic link or, where links are not
    possible, as a copy.  If another file already has this name, it may belong to the user, so it is
    renamed."""
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
    """Remove the damaged files that a new file replaces. The name of a damaged file differs from
    the name of the new file only in the number at the end."""
    stem, ending = path.name.partition("-")[0].removesuffix(path.suffix), path.suffix
    for other in path.parent.glob(f"{stem}*{ending}"):
        same = other.stem.partition("-")[0] == stem
        marker = other.with_suffix(GAPS)
        if same and other != path and other.is_file() and (marker.exists() or not is_whole(other)):
            other.unlink(missing_ok=True)
            marker.unlink(missing_ok=True)
