"""Output of a dry run: the number of points to solve, and an estimate of the computing time."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from microslip.sweeps import batches
from microslip.sweeps.batches import Batch
from microslip.sweeps.store import Store

TYPICAL = 0.025
"""Mean CPU seconds of a request on one core, measured by benchmarks/sweep_cost.py with the default
configuration and a tolerance of 1e-3."""
QUICK = ("point", "history", "field", "period")
"""Kinds of requests to which TYPICAL applies."""
START = 1.3
"""CPU seconds that a job takes to import its libraries, as the first point of a Python process
does: `python -c 'import microslip; microslip.solve("bore", 0.5, 1.0)'`."""
COMPILE = 30.0
"""CPU seconds that two jobs take to compile the solver, measured by benchmarks/first_run.py."""
SOLVED = re.compile(r"^\d+ points, (\d+) computed in ([\d.]+) s of CPU time", re.MULTILINE)
"""Pattern of the line with the CPU time in the log of a batch."""


def summary(
    jobs: Iterable[tuple[str, Batch | None]], folder: str | Path, cores: int, *, compiles: bool
) -> list[str]:
    """Return the lines that describe the work of a run.

    jobs: group and batch of each job that solves points; the batch is None for a certified map.
    folder: folder of results, with the store and the logs of earlier batches.  cores: number of
    jobs at the same time.  compiles: whether the run compiles the solver.
    """
    store, mean_time = Store(folder), cache(lambda group: _mean_time(Path(folder), group))
    count, slow, maps, seconds = Counter(points=0), 0, False, [0.0]
    for group, batch in jobs:
        maps = maps or batch is None
        kinds = Counter(
            request["kind"]
            for request in (batch.requests if batch else ())
            if not store.path(batches.group(request), batches.key_of(request)).exists()
        )
        count.update({"points": kinds["point"], "other runs": kinds.total() - kinds["point"]})
        mean = mean_time(group)
        quick = kinds.total() if mean else sum(kinds[kind] for kind in QUICK)
        slow += kinds.total() - quick
        seconds.append(START + quick * (mean or TYPICAL))
    parts = [f"{number:,} {_noun(what, number)}" for what, number in count.items() if number]
    lines = [f"To solve: {' and '.join(parts) or 'no points'}."]
    if parts:
        time = _words(max(sum(seconds) / cores, *seconds))
        bound = "at least" if slow else "about"
        lines = [f"{lines[0][:-1]}, {bound} {time} on {cores} {_noun('cores', cores)}."]
    if maps:
        lines = lines if parts else []
        lines.append("To solve: the points of certified maps. Their number depends on the results.")
    if compiles:
        time = _words(COMPILE / min(cores, 2))
        lines.append(
            f"Compiling the solver comes first: about {time}, unless it is already compiled."
        )
    return lines


def _mean_time(folder: Path, group: str) -> float | None:
    """Mean CPU seconds per request in a group, from the logs of its batches, or None without
    logs."""
    logs = (folder / "logs" / "solve" / group).glob("*.log")
    texts = [path.read_text("utf-8", errors="replace") for path in logs]
    times = [(int(count), float(time)) for text in texts for count, time in SOLVED.findall(text)]
    points, seconds = map(sum, zip((0, 0.0), *times, strict=True))
    return seconds / points if points else None


def _noun(plural: str, count: int) -> str:
    return plural.removesuffix("s") if count == 1 else plural


def _words(seconds: float) -> str:
    """Format a duration with one or two significant digits: "40 seconds", "3 minutes", "2.5
    hours"."""
    if seconds < 90.0:
        return f"{max(10 * math.ceil(seconds / 10.0), 10)} seconds"
    if seconds < 5400.0:
        return f"{math.ceil(seconds / 60.0)} minutes"
    return f"{seconds / 3600.0:.1f} hours"
