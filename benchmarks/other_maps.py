"""Validate certified maps of other motions, pressures and drives at random points.

    python benchmarks/other_maps.py [NAME ...] [--errors E ...] [--places N] [--seed S]
                                    [--results FOLDER] [--markdown FILE]

NAME is a sweep under `extended` or `drives` of the configuration. Its map is made for each error,
round by round, and compared with the solver at random points. The points are uniform in the
logarithm of the velocity (or in the force) and in the amplitude. The tolerance of the solver is a
tenth of the error. A point is covered if the map's error is at most the map's error estimate plus
the solver's error estimate. The folder's store holds all points, so that the next run can reuse
them.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import tables
from tqdm import tqdm

from microslip.config import load
from microslip.datasets import certified_map
from microslip.datasets.accessor import Map
from microslip.sweeps import batches, evaluate, map_refinement
from microslip.sweeps.batches import answer
from microslip.sweeps.store import Store

CONFIGURATION = Path(__file__).parents[1] / "config" / "config.yaml"
NAMES = (
    *("longitudinal", "normal_load", "normal_indentation"),
    *("flat_end", "punch", "ring", "cone", "ellipse", "figure_of_eight"),
)
ERRORS = (1e-2, 3e-3)
HEAD = """# Certified maps of other motions and pressures

Made by `benchmarks/other_maps.py`: maps of sweeps in `config/config.yaml` at random points that
were not used to make them. The tolerance of the solver is a tenth of the error. A point is covered
if the error of the map is at most its estimate plus the error estimate of the solver.
"""
TIMED = 20
"""Number of map points at which the time for a point is measured."""


def map_of(name, error):
    """The certified map for a sweep in the configuration and an error."""
    whole = load.read_yaml(CONFIGURATION)
    sweeps = {name: whole["extended"][name] | {"adaptive": {"error": error}}}
    one = {"sweeps": {"transverse": whole["sweeps"]["transverse"]}, "extended": sweeps}
    return load.from_mapping(one, folders=[CONFIGURATION.parent]).certified[f"certified_{name}"]


def records_of(map_, store):
    """The records of all points of a map."""
    records = []

    def ask(requests):
        for request in tqdm(requests, desc=map_.name, leave=False):
            records.append(answer(request, store)[0])
            yield records[-1]

    map_refinement.refine(map_, ask)
    return records


def points_of(map_, number, seed):
    """Requests at random points of a map, with a tenth of the map's error as tolerance."""
    rng = np.random.default_rng([seed, *map_.name.encode()])
    tolerance = float(f"{map_.error / 10:.6g}")
    requests = []
    for share, row in rng.uniform(size=(number, 2)):
        velocity = 10.0 ** _digits(*np.log10(map_.velocity), share)
        point = {"amplitude": (_digits(map_.amplitude[0], map_.amplitude[1], row),)}
        point["velocity"] = (float(f"{velocity:.6g}"),)
        requests += batches.points_of(replace(map_.sweep, tolerance=tolerance, **point)).requests
    return requests


def _digits(low, high, share):
    return float(f"{low + (high - low) * share:.6g}")


def judged(name, error, options, store):
    """A line of the table."""
    map_ = map_of(name, error)
    records = records_of(map_, store)
    data = certified_map.build(map_, records)
    friction = Map(data)
    rows = []
    for request in tqdm(points_of(map_, options.places, options.seed), desc=map_.name, leave=False):
        true = answer(request, store)[0]["result"]
        answer_at = friction.at(float(request["velocity"]), float(request["amplitude"]))
        pair = [float(answer_at[part]) for part in ("mu_macro", "mu_macro_error")]
        rows.append([*pair, true["mu_macro"], true["mu_macro_error"]])
    value_on_map, estimate, true, own = np.array(rows).T
    away = abs(value_on_map - true)
    return {
        "map": name,
        "error": f"{error:g}",
        "points": data.points,
        "not converged": int(data["mu_macro"].isnull().sum()),
        "largest bound": f"{data.cell_error.values.max():.1e}",
        "random points": len(rows),
        "covered": int((away <= estimate + own).sum()),
        "within the error": int((away <= error + own).sum()),
        "median error": f"{np.median(away):.1e}",
        "largest error": f"{away.max():.1e}",
        "CPU seconds, all points": f"{_seconds(records):.0f}",
    }


def _seconds(records):
    """CPU time of the solver for all points, extrapolated from a few points."""
    few = records[:: max(1, len(records) // TIMED)]
    evaluate.computed(few[0]["request"])  # compiles
    begun = time.process_time()
    for record in few:
        evaluate.computed(record["request"])
    return (time.process_time() - begun) * len(records) / len(few)


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("names", nargs="*", default=NAMES)
    parser.add_argument("--errors", nargs="+", type=float, default=ERRORS)
    parser.add_argument("--places", type=int, default=150)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--results", type=Path, default=Path("results"))
    options = parser.parse_args()
    store = Store(options.results)
    maps = [(name, error) for name in options.names for error in options.errors]
    rows = [judged(*one, options, store) for one in maps]
    tables.publish(f"{HEAD}\n{tables.markdown(rows)}", options)


if __name__ == "__main__":
    main()
