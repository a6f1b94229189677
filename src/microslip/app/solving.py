"""Solve a batch in a job of the workflow."""

from __future__ import annotations

from pathlib import Path

from microslip.foundation import named_files
from microslip.sweeps import batch, content
from microslip.sweeps.request import Batch


def solve(order: dict | str, config: dict, path: str, processes: int) -> str:
    """Write a batch file, and return a line of text with the statistics.

    order: the batch as a dict, or the name of a certified map.  config: the configuration, in
    which files have absolute paths.  processes: number of processes for a map.
    """
    sweeps = config.get("sweeps", {}).values()
    names = (sweep.get(role, "") for sweep in sweeps for role in ("motion", "pressure"))
    named_files.remember(names)  # requests name files by their content
    if isinstance(order, str):
        from microslip.config import load
        from microslip.sweeps import map_refinement

        sweep = load.from_mapping(config).sweeps[order]
        statistics = map_refinement.solve_points(sweep, path, processes)
    else:
        block = Batch(**order)
        if block.name != Path(path).stem.partition("-")[0]:
            raise batch.SourcesEdited("the solver")
        statistics = batch.solve(block.requests, path)
    content.remove_others(Path(path))
    line = "{points} points, {computed} computed in {seconds:.2f} s of CPU time"
    return line.format(**statistics)
