"""What was read off sources is kept beside their compiled code, so that they are parsed once.

To parse all that a point depends on takes half a second, which every job and every command would
spend before it knows what its results are called.  What is kept is named by the content that it was
read off, and lies in a file named by the code that reads it and by the version of Python.

Imports nothing but the standard library.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sys
import uuid
from collections.abc import Callable
from pathlib import Path

MOST = 4000
"""Answers in a file; beyond that those that nobody has asked for lately are forgotten."""
READ_BY = ("source_digest.py", "syntax_digest.py")


class Answers:
    """Answers to questions about texts, kept in a folder if that can be written to.

    Attributes
    ----------
    path : Path
        The file; one that is damaged counts as empty.
    """

    def __init__(self, folder: Path):
        code = hashlib.sha256()
        for name in READ_BY:
            with contextlib.suppress(OSError):
                code.update(Path(__file__).with_name(name).read_bytes())
        name = f"sources.{sys.implementation.cache_tag}.{code.hexdigest()[:16]}.json"
        self.path = Path(folder, name)
        self._known, self._asked = None, {}

    def of(self, question: str, content: bytes, answer: Callable) -> object:
        """The answer to a question about a text: what JSON can hold, by `answer()` if not known."""
        if self._known is None:
            self._known = self._read()
        key = hashlib.sha256(question.encode() + b"\0" + content).hexdigest()[:32]
        if key not in self._asked:
            self._asked[key] = self._known[key] if key in self._known else answer()
        return self._asked[key]

    def keep(self) -> None:
        """Write what is new; where that is refused, whoever asks next has to parse again."""
        if self._known is None or self._asked.keys() <= self._known.keys():
            return
        known = self._known | self._asked
        self._known = known if len(known) <= MOST else dict(self._asked)
        text = json.dumps(self._known, separators=(",", ":"))
        beside = self.path.with_name(f"{self.path.name}.{uuid.uuid4().hex}")
        try:
            self.path.parent.mkdir(exist_ok=True)
            beside.write_text(f"{_checksum(text)}\n{text}")
            os.replace(beside, self.path)
        except OSError:
            with contextlib.suppress(OSError):
                beside.unlink()

    def _read(self):
        try:
            checksum, _, text = self.path.read_text().partition("\n")
        except (OSError, ValueError):
            return {}
        return json.loads(text) if checksum == _checksum(text) else {}


def _checksum(text):
    return hashlib.sha256(text.encode()).hexdigest()
