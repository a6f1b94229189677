"""How coarse may the levels of the error estimate be?  Its rule, replayed on stored runs.

    python benchmarks/ladders.py [--points N] [--skip M] [--tolerances 1e-2,1e-3] [--start F]
                                 [--safety S] [--smallest F] [--seed S] [--store FILE]
                                 [--markdown FILE]

The points are those with a reference in docs/measured/references-SEED.csv, up to N of a stratum at
a tolerance after the first M of them, without closed forms.  Every run is done once and stored by
point and resolution, so that other starts (times F), safety factors and floors (shares of the
tolerance) cost no runs but those at new resolutions.  An interrupted run goes on where it stopped.

A point fails if the error of its value is above the estimate by more than the uncertainty of the
reference.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import math
import pickle
import sqlite3
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import blind_points
import known_references
import numpy as np
import tables

from microslip.adaptive.choice import choose_model
from microslip.adaptive.closed_forms import closed_form
from microslip.adaptive.moved import marched
from microslip.adaptive.request import Request, budget_for
from microslip.estimate import refine as refinement
from microslip.estimate import richardson
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named

DOCS = Path(__file__).parents[1] / "docs/measured"


class Store:
    """Runs by point and resolutions, on disk."""

    def __init__(self, path):
        self.file = sqlite3.connect(path)
        self.file.execute(
            "create table if not exists runs (key text primary key, run blob, seconds real)"
        )

    def run(self, key, run):
        """The run of a key and its CPU seconds; run() where it is not stored."""
        query = "select run, seconds from runs where key = ?"
        found = self.file.execute(query, (key,)).fetchone()
        if found is None:
            began = time.thread_time()
            found = pickle.dumps(run()), time.thread_time() - began
            self.file.execute("insert into runs values (?, ?, ?)", (key, *found))
            self.file.commit()
        return pickle.loads(found[0]), found[1]


def sample(references: dict, seed: int, numbers: range, tolerances: list[float]):
    """(k, point, Problem) of the points with these numbers in each stratum at each tolerance."""
    count = Counter()
    for k in sorted(references):
        point = blind_points.point(seed, k)
        kind = point["stratum"], point["tolerance"]
        if point["tolerance"] not in tolerances or count[kind] == numbers.stop:
            continue
        place = (point["velocity"], point["amplitude"], point["poisson"])
        pressure = pressure_named(point["pressure"])
        problem = Problem(motion_named(point["motion"]), *place, pressure)
        if closed_form(problem, point["tolerance"]) is None:
            count[kind] += 1
            if count[kind] > numbers.start:
                yield k, point, problem


def examine(store: Store, k: int, point: dict, problem: Problem, start: float) -> dict:
    """What the rule makes of a point."""
    model = choose_model(problem)
    plan = marched(
        Request(
            problem=problem,
            model=model,
            tolerance=point["tolerance"],
            budget=budget_for(model),
            started=time.perf_counter(),
        )
    )
    seconds, resolutions = [], {}

    def run(resolution, guess):
        key = f"{k}: {resolution} from {resolutions.get(id(guess))}"
        found, took = store.run(key, lambda: plan.run(resolution, guess))
        resolutions[id(found)] = resolution
        seconds.append(took)
        return found

    ladder = replace(plan.ladder, start=round(start * plan.ladder.start))
    found = refinement.refine(run, ladder, point["tolerance"])
    return {"found": found, "seconds": sum(seconds), "runs": len(seconds)}


def row(stratum: str, tolerance: float, lines: list[dict]) -> dict:
    """Row of the table."""
    ratios = np.array([line["ratio"] for line in lines])
    off = max(line["off"] for line in lines)
    return {
        "points": stratum,
        "tolerance": f"{tolerance:g}",
        "number": len(lines),
        "converged": sum(line["found"].converged for line in lines),
        "fail": int(np.sum(ratios > 1.0)),
        "largest error / estimate": f"{ratios.max():.2f}",
        "largest error / tolerance": f"{off:.2f}",
        "runs": f"{np.mean([line['runs'] for line in lines]):.1f}",
        "mean CPU seconds": f"{np.mean([line['seconds'] for line in lines]):.3f}",
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--skip", type=int, default=0, help="of these, from the first one on")
    parser.add_argument("--tolerances", default="1e-2,1e-3")
    parser.add_argument("--start", type=float, default=1.0)
    parser.add_argument("--safety", type=float, default=richardson.SAFETY)
    parser.add_argument("--smallest", type=float, default=refinement.SMALLEST_SHARE)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--store", type=Path, default=Path("results/ladders.sqlite"))
    tables.add_markdown(parser)
    options = parser.parse_args()
    richardson.SAFETY, refinement.SMALLEST_SHARE = options.safety, options.smallest
    options.store.parent.mkdir(parents=True, exist_ok=True)
    store = Store(options.store)
    references = known_references.read(DOCS / f"references-{options.seed}.csv", options.seed)
    tolerances = [float(one) for one in options.tolerances.split(",")]
    lines, failed = {}, []
    numbers = range(options.skip, options.points)
    for k, point, problem in sample(references, options.seed, numbers, tolerances):
        line = examine(store, k, point, problem, options.start)
        found, known = line["found"], references[k]
        off = abs(found.value - known["reference"])
        beyond = max(off - known["uncertainty"], 0.0) / max(found.error, 1e-15)
        line |= {"off": off / point["tolerance"], "ratio": beyond if found.converged else 0.0}
        lines.setdefault((point["stratum"], point["tolerance"]), []).append(line)
        if line["ratio"] > 1.0:
            failed.append((line["ratio"], point))
    rows = [row(*kind, lines[kind]) for kind in sorted(lines)]
    every = [line for one in lines.values() for line in one]
    rows.append(row("all", math.nan, every) | {"tolerance": "all"})
    text = [tables.markdown(rows), ""]
    for ratio, point in sorted(failed, key=lambda one: -one[0]):
        text.append(f"Fails by {ratio:.2f}: {', '.join(f'{k} {v}' for k, v in point.items())}.\n")
    tables.publish("\n".join(text), options)


if __name__ == "__main__":
    main()
