"""Measure the CPU time of all points, in one process on one core, without compilation.

    python benchmarks/sweep_cost.py [--config FILE] [--markdown FILE]

Solves every point of every sweep of a configuration once, and the single runs of figures, and sums
up the CPU time spent in the solver. The datasets do not contain this time, because it differs from
run to run.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import time
from itertools import groupby
from pathlib import Path

import numpy as np
import tables
from tqdm import tqdm

import microslip
from microslip.config import load
from microslip.sweeps import evaluate
from microslip.sweeps.request import points_of, runs_of


def cost(name, requests):
    """Yield the rows of the table, one for each kind of request of a sweep."""
    for kind, group in groupby(requests, key=lambda request: request["kind"]):
        results, seconds = [], []
        for request in tqdm(list(group), desc=name, leave=False):
            began = time.process_time()
            results.append(evaluate.computed(request))
            seconds.append(time.process_time() - began)
        yield {
            "sweep": f"{name}: {kind}",
            "points": len(results),
            "converged": sum(bool(one.get("converged", True)) for one in results),
            **columns_of(seconds),
        }


def columns_of(seconds):
    """Return the columns with times. seconds: CPU time of each point, an array of shape (n,)."""
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
    rows = []
    for name, sweep in configuration.sweeps.items():
        requests = [*points_of(sweep).requests, *runs_of(configuration, name)]
        rows += cost(name, requests)
    tables.publish(tables.markdown(rows), options)


if __name__ == "__main__":
    main()
