"""CPU time for a configuration's points, in one process on one core, without compilation.

    python benchmarks/sweep_cost.py [--config FILE] [--markdown FILE]

Solves every point of every sweep once, as well as the single runs and some of the explorer's
periods, and sums up the CPU time spent in the solver. The datasets do not contain this time,
because it differs from run to run. The mean over all requests is TYPICAL in
microslip/app/dry_run.py.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import time
from itertools import groupby, product
from pathlib import Path

import numpy as np
import tables
from tqdm import tqdm

import microslip
from microslip.config import load
from microslip.report.explorer import explorer
from microslip.sweeps import batches, evaluate


def cost(sweep):
    """One row of the table."""
    axes = (sweep.velocity, sweep.amplitude or (None,), sweep.poisson)
    answers, seconds = [], []
    for velocity, amplitude, poisson in tqdm(list(product(*axes)), desc=sweep.name, leave=False):
        began = time.process_time()
        answers.append(
            microslip.solve(
                sweep.motion,
                velocity,
                amplitude,
                poisson=poisson,
                model=sweep.model,
                tolerance=sweep.tolerance,
                cells=sweep.cells,
                steps=sweep.steps,
            )
        )
        seconds.append(time.process_time() - began)
    return {
        "sweep": sweep.name,
        "points": len(answers),
        "converged": sum(answer.converged for answer in answers),
        "tolerance": f"{sweep.tolerance:g}",
        "largest error": f"{max(answer.mu_macro_error for answer in answers):.1e}",
        **columns_of(seconds),
    }


def cost_beside(configuration, name):
    """Rows of the single runs of a sweep, and of every 20th period of its map."""
    requests = batches.history_requests(configuration, name)
    if name in explorer.maps_of(configuration):
        requests += explorer.period_requests(configuration, name)[::20]
    for kind, group in groupby(requests, key=lambda request: request["kind"]):
        seconds = []
        for request in group:
            began = time.process_time()
            evaluate.computed(request)
            seconds.append(time.process_time() - began)
        yield {
            "sweep": f"{name}: {kind}",
            "points": len(seconds),
            **dict.fromkeys(("converged", "tolerance", "largest error"), "-"),
            **columns_of(seconds),
        }


def columns_of(seconds):
    """Columns with times. seconds: CPU time of each point, shape (n,)."""
    return {
        "solver time, s": f"{np.sum(seconds):.1f}",
        "mean, ms": f"{1e3 * np.mean(seconds):.1f}",
        "median, ms": f"{1e3 * np.median(seconds):.1f}",
        "slowest, ms": f"{1e3 * np.max(seconds):.0f}",
    }


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--config", type=Path, default=Path("config/config.yaml"))
    options = parser.parse_args()
    microslip.warm_up()
    configuration = load.load(options.config)
    rows = [cost(sweep) for sweep in configuration.sweeps.values()]
    rows += [row for name in configuration.sweeps for row in cost_beside(configuration, name)]
    tables.publish(tables.markdown(rows), options)


if __name__ == "__main__":
    main()
