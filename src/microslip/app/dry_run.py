"""Output of a dry run: the number of points to solve."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from microslip.sweeps import batches
from microslip.sweeps.batches import Batch
from microslip.sweeps.store import Store


def summary(batches_to_solve: Iterable[Batch | None], folder: str | Path) -> list[str]:
    """Return the lines that describe the work of a run.

    batches_to_solve: batch of each job that solves points; None for a certified map.  folder:
    folder of results with the store.
    """
    store, maps = Store(folder), False
    count = Counter(points=0)
    for batch in batches_to_solve:
        maps = maps or batch is None
        for request in batch.requests if batch else ():
            if not store.path(batches.group(request), batches.key_of(request)).exists():
                count["points" if request["kind"] == "point" else "other runs"] += 1
    parts = [
        f"{number:,} {what.removesuffix('s') if number == 1 else what}"
        for what, number in count.items()
        if number
    ]
    lines = [f"To solve: {' and '.join(parts) or 'no points'}."] if parts or not maps else []
    if maps:
        lines.append("To solve: the points of certified maps. Their number depends on the results.")
    return lines
