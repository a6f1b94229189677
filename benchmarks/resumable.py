"""Compute many points in several processes, and write them to a resumable JSON lines file."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path


def add_lines(
    output: Path, lines: dict[int, dict], numbers: Iterable[int], jobs_of: Callable, workers: int
) -> None:
    """Compute the missing lines and add them to a file and to `lines`.

    Parameters
    ----------
    output : Path
        File to append to. An incomplete last line stays in it.
    lines : dict
        Existing lines, keyed by the number k of the point.
    numbers : iterable of int
        Numbers of the points.
    jobs_of : callable
        jobs_of(k) returns a module-level function and its arguments. That function returns line k.
    workers : int
        Number of processes.
    """
    with ProcessPoolExecutor(workers) as pool, output.open("a") as file:
        jobs = [pool.submit(*jobs_of(k)) for k in numbers if k not in lines]
        for number, job in enumerate(as_completed(jobs), start=1):
            line = job.result()
            lines[line["k"]] = line
            file.write("\n" * (number == 1) + json.dumps(line) + "\n")
            file.flush()
            print(f"\r{number} of {len(jobs)} points", end="", flush=True)
    print()
