"""Plans: which batch answers a request.  What was planned stays as it is, whatever is added.

A batch is named by what it answers.  If batches were cut from the list of requests anew whenever
that list grows, one more velocity would put a request into every row of the map, nearly all batches
would be others, and a machine without the store of points would solve all of it again.  No rule
that looks at the requests alone avoids this: a point that is asked for alone is a batch, so that
points of any grid that can grow out of it would have to be batches of one.  So what was planned is
kept, a file for each group of batches, and only requests that are in no batch are cut into new
ones.

A file of batches lists them, one a line, then comes a checksum of all that.  It lies among the
batches of its group and is named by the sources that they come from, so that it is never stale.
Who starts a run reads and writes it; a job that is handed nothing but its name finds its
requests there, and need not plan.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json
from microslip.sweeps import batch_files, batches
from microslip.sweeps.sealed_files import CacheError, advice, write_atomically


class Folder:
    """Plans in a folder of results that every process sees.

    Attributes
    ----------
    folder : Path
    forgets : bool
        Whether batches that were planned and not made are cut anew, perhaps in another size.
        Whoever begins a run does; a job of that run is to find what was planned.
    """

    def __init__(self, folder: str | Path, forgets: bool = True):
        self.folder, self.forgets = Path(folder), forgets

    def read(self, file: str) -> bytes:
        """Content of a file, empty if it does not exist; raises CacheError."""
        try:
            return (self.folder / file).read_bytes()
        except FileNotFoundError:
            return b""
        except OSError as error:
            raise CacheError(advice("read", self.folder / file, error)) from error

    def counts(self, file: str) -> bool:
        """Whether the batch that this file is to hold stays as it was planned."""
        return not self.forgets or (self.folder / file).exists()

    def write(self, file: str, content: bytes) -> None:
        """Put a plan in its place; raises CacheError."""
        write_atomically(self.folder / file, content)


def file_of(group: str, requests: Sequence[dict]) -> str:
    """Path, inside the folder of results, of what is planned for a group.

    requests: of the group, all of one kind, motion and pressure.
    """
    return f"batches/{group}/{source_digest.of_request(requests[0])[:16]}.plan"


def cut(
    requests: Sequence[dict], size: int, planned: Mapping[str, list[dict]]
) -> dict[str, Sequence[dict]]:
    """Batches, requests by name, that answer all requests: those planned, then new ones.

    size: requests in a new batch.  planned: batches by name; those that answer nothing of this are
    left out.
    """
    missing = {_identity(request): request for request in requests}
    found = {}
    for name, answered in planned.items():
        answers = [key for key in map(_identity, answered) if key in missing]
        if answers:
            found[name] = answered
            for key in answers:
                del missing[key]
    return found | batches.batches(list(missing.values()), size)


def _identity(request: dict) -> tuple:
    return tuple(sorted(request.items()))


def text_of(planned: Mapping[str, list[dict]]) -> bytes:
    """Content of the file of a plan."""
    lines = (canonical_json({"batch": name, **packed(cut)}) for name, cut in planned.items())
    return batch_files.with_checksum("".join(f"{line}\n" for line in lines).encode())


def batches_in(content: bytes) -> dict[str, list[dict]]:
    """Batches, requests by name, in what a file of batches holds; none if it is damaged."""
    lines, _ = batch_files.without_checksum(content)
    read = map(json.loads, lines.splitlines())
    return {line["batch"]: _unpacked(line) for line in read}


def requests_of(content: bytes, name: str) -> list[dict] | None:
    """Requests of one of these batches; None if it is not there.  Other lines are not parsed."""
    lines, _ = batch_files.without_checksum(content)
    begins = f'{{"batch":"{name}",'.encode()
    line = next((line for line in lines.splitlines() if line.startswith(begins)), None)
    return None if line is None else _unpacked(json.loads(line))


def packed(requests: Sequence[dict]) -> dict:
    """Requests with the same keys in little room: what they share, and lists of what differs."""
    first = requests[0]
    columns = {key: [request[key] for request in requests] for key in first}
    differs = [key for key, column in columns.items() if any(v != first[key] for v in column)]
    return {
        "count": len(requests),
        "same": {key: first[key] for key in first if key not in differs},
        "each": {key: columns[key] for key in differs},
    }


def _unpacked(line: dict) -> list[dict]:
    rows = zip(*line["each"].values(), strict=True) if line["each"] else [()] * line["count"]
    return [line["same"] | dict(zip(line["each"], row, strict=True)) for row in rows]
