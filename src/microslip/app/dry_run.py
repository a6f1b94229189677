"""Output of a dry run: the number of points to solve, and an estimate of the time."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from microslip.sweeps import batches
from microslip.sweeps.batches import Batch
from microslip.sweeps.store import Store

TYPICAL = {
    ("point", "transverse"): 0.005,
    ("point", "bore"): 0.1,
    ("point", "continuous-bore"): 0.025,
    ("history", "transverse"): 0.02,
    ("history", "continuous-bore"): 0.15,
    ("field", "continuous-bore"): 0.025,
    ("period", "transverse"): 0.02,
    ("period", "bore"): 0.025,
}
"""CPU seconds of a request on one core, by kind and motion: means over the default configuration
(tolerance 1e-3), measured by benchmarks/sweep_cost.py."""
OTHER_MOTION = max(TYPICAL.values())
"""CPU seconds of a point of any other motion: the most expensive of those that were measured."""
START = 2.3
"""CPU seconds that a job takes besides solving, measured by benchmarks/first_run.py."""
COMPILE = 50.0
"""CPU seconds that two jobs take to compile the solver, measured by benchmarks/first_run.py."""
SOLVED = re.compile(r"^\d+ points, (\d+) computed in ([\d.]+) s of CPU time", re.MULTILINE)
"""Line in the log of a batch with the time that it took."""


def summary(
    jobs: Iterable[tuple[str, Batch | None]], folder: str | Path, cores: int, *, compiles: bool
) -> list[str]:
    """Lines about the work of a run.

    Parameters
    ----------
    jobs : iterable of (str, Batch or None)
        Group and batch of each job that solves; None for a certified map.
    folder : path
        Folder of results.  Requests that its store answers are not counted; logs in it say how long
        earlier points of a group took.
    cores : int
        Jobs at a time.
    compiles : bool
        Whether the run compiles the solver.
    """
    store, times, number = Store(folder), _Times(Path(folder)), Counter(points=0)
    seconds: list[float] = []
    unknown: Counter[str] = Counter()
    maps = False
    for group, batch in jobs:
        job = START
        maps = maps or batch is None
        for request in batch.requests if batch else ():
            if store.path(batches.group(request), batches.key_of(request)).exists():
                continue
            number["points" if request["kind"] == "point" else "other runs"] += 1
            took = times.of(group, request)
            if took is None:
                unknown[group] += 1
            else:
                job += took
        seconds.append(job)
    parts = [f"{count:,} {_noun(what, count)}" for what, count in number.items() if count]
    lines = [f"To solve: {' and '.join(parts) or 'no points'}."]
    if number.total() > unknown.total():
        solving = _words(max(sum(seconds) / cores, *seconds))
        cautious = "at least" if unknown else "about"
        lines[0] = f"{lines[0][:-1]}, {cautious} {solving} on {cores} {_noun('cores', cores)}."
        lines.append(f"The time is derived from {times.sources()}.")
    if unknown:
        groups = ", ".join(f"{count:,} of {group}" for group, count in unknown.items())
        lines.append(f"There is no time yet for some other runs: {groups}.")
    if maps:
        found = "To solve besides" if number.total() else "To solve"
        chosen = "round by round, so their number is known at the end"
        lines = lines if number.total() else []
        lines.append(f"{found}: the points of certified maps, which are chosen {chosen}.")
    if compiles:
        compiling = _words(COMPILE / min(cores, 2))
        lines.append(
            f"Compiling the solver comes first: about {compiling}, unless it was compiled."
        )
    return lines


class _Times:
    """CPU seconds of requests: the mean of their group in the logs, else a typical value."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.recorded: dict[str, float | None] = {}
        self.used: set[str] = set()

    def of(self, group: str, request: dict) -> float | None:
        """CPU seconds, None if they are not known."""
        if group not in self.recorded:
            self.recorded[group] = self._in_logs(group)
        if self.recorded[group] is not None:
            self.used.add("earlier batches in this folder")
            return self.recorded[group]
        kind, motion = request["kind"], request.get("motion", "").partition(":")[0]
        found = TYPICAL.get((kind, motion), OTHER_MOTION if kind == "point" else None)
        if found is not None:
            self.used.add("typical values at a tolerance of 1e-3 (benchmarks/sweep_cost.py)")
        return found

    def sources(self) -> str:
        return " and ".join(sorted(self.used))

    def _in_logs(self, group: str) -> float | None:
        points, seconds = 0, 0.0
        for path in (self.folder / "logs" / "solve" / group).glob("*.log"):
            for count, took in SOLVED.findall(path.read_text("utf-8", errors="replace")):
                points, seconds = points + int(count), seconds + float(took)
        return seconds / points if points else None


def _noun(plural: str, count: int) -> str:
    return plural.removesuffix("s") if count == 1 else plural


def _words(seconds: float) -> str:
    """A duration in one or two significant digits: "40 seconds", "3 minutes", "2.5 hours"."""
    if seconds < 90.0:
        return f"{max(10 * math.ceil(seconds / 10.0), 10)} seconds"
    if seconds < 5400.0:
        return f"{math.ceil(seconds / 60.0)} minutes"
    return f"{seconds / 3600.0:.1f} hours"
