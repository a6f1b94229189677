"""What the points of a configuration cost, in one process on one core, compiled beforehand.

    python benchmarks/sweep_cost.py [--config FILE] [--markdown FILE]

Solves every point of every sweep once and sums up the time spent in the solver, which the datasets
leave out because it differs from run to run.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
from itertools import product
from pathlib import Path

import numpy as np
import tables
from tqdm import tqdm

import microslip
from microslip.config import load


def cost(sweep):
    """One row of the table."""
    axes = (sweep.velocity, sweep.amplitude or (None,), sweep.poisson)
    answers = []
    for velocity, amplitude, poisson in tqdm(list(product(*axes)), desc=sweep.name, leave=False):
        answers.append(
            microslip.solve(
                sweep.scene,
                velocity,
                amplitude,
                poisson=poisson,
                model=sweep.model,
                tolerance=sweep.tolerance,
                cells=sweep.cells,
                steps=sweep.steps,
            )
        )
    seconds = np.array([answer.solve_time_s for answer in answers])
    return {
        "sweep": sweep.name,
        "points": len(answers),
        "converged": sum(answer.converged for answer in answers),
        "tolerance": f"{sweep.tolerance:g}",
        "largest error": f"{max(answer.mu_macro_error for answer in answers):.1e}",
        "solver time, s": f"{seconds.sum():.1f}",
        "median, ms": f"{1e3 * np.median(seconds):.1f}",
        "slowest, ms": f"{1e3 * seconds.max():.0f}",
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--config", type=Path, default=Path("config/config.yaml"))
    tables.add_markdown(parser)
    options = parser.parse_args()
    microslip.warm_up()
    rows = [cost(sweep) for sweep in load.load(options.config).sweeps.values()]
    tables.publish(tables.markdown(rows), options)


if __name__ == "__main__":
    main()
