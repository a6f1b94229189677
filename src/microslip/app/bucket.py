"""Plans of batches in a storage that Snakemake knows, such as a bucket."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from microslip.sweeps.sealed_files import write_atomically


class Bucket:
    """A `sweeps.batch_plans.Folder` for results in a remote storage.

    Planned batches stay as planned, whether or not they were made: to check hundreds of batches one
    by one would take longer than planning.

    Attributes
    ----------
    object_of : callable
        The storage object of a file, by its path inside the folder of results.
    """

    def __init__(self, object_of: Callable):
        self.object_of = object_of

    def read(self, file: str) -> bytes:
        """Content of a file, empty if it does not exist."""
        stored = self.object_of(file)
        if not stored.exists():
            return b""
        local = Path(stored.local_path())
        local.parent.mkdir(parents=True, exist_ok=True)
        stored.retrieve_object()
        return local.read_bytes()

    def counts(self, file: str) -> bool:
        """Whether the batch that this file is to hold stays as it was planned."""
        return True

    def write(self, file: str, content: bytes) -> None:
        """Put a plan in its place."""
        stored = self.object_of(file)
        write_atomically(stored.local_path(), content)
        stored.store_object()
