"""Lines of JSON that many points are computed into, one after the other, by several processes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path


def add_lines(
    output: Path, lines: dict[int, dict], asked: Iterable[int], jobs_of: Callable, workers: int
) -> None:
    """Compute what is asked for and not there, and add it to a file and to its lines.

    Parameters
    ----------
    output : Path
        File to append to; a line that an interruption cut short there is left alone.
    lines : dict
        By the number k of their points.
    asked : iterable of int
        Numbers of the points wanted.
    jobs_of : callable
        jobs_of(k) -> a function of a module, and what to call it with, for the line of point k.
    workers : int
        Processes.
    """
    with ProcessPoolExecutor(workers) as pool, output.open("a") as file:
        jobs = [pool.submit(*jobs_of(k)) for k in asked if k not in lines]
        for done, job in enumerate(as_completed(jobs), start=1):
            line = job.result()
            lines[line["k"]] = line
            file.write("\n" * (done == 1) + json.dumps(line) + "\n")
            file.flush()
            print(f"\r{done} of {len(jobs)} points", end="", flush=True)
    print()
