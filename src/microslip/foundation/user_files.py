"""Content of the files that users name, with a limit on their size.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

import os

from microslip.foundation.named_files import MOST_BYTES


def content_of(path: str | os.PathLike, most: int = MOST_BYTES) -> bytes:
    """Content of a file, of which no more than `most` bytes are read.

    Raises
    ------
    OSError
        Where it cannot be read.
    ValueError
        Where it is larger, also if it is a device without an end.
    """
    with open(path, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ValueError(f"larger than {most / 1e6:g} MB; allowed: at most that")
    return content
