"""Do the errors of certified maps of other motions, pressures and drives hold at blind places?

    python benchmarks/other_maps.py [NAME ...] [--errors E ...] [--places N] [--seed S]
                                    [--results FOLDER] [--markdown FILE]

For sweeps of the configuration, of those under `extended` or `drives` by their names, the map
within each error is made, round by round, and asked at random places: uniform in the logarithm of
the velocity, or in the force, and in the amplitude.  The solver is asked there for a tenth of the
error.  A place is covered if the map misses by no more than it claims and the solver's own error.
Points lie in the store of the folder, so that the next run goes on from there.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import tables
from tqdm import tqdm

from microslip.config import load
from microslip.datasets import certified_map
from microslip.datasets.query.accessor import Friction
from microslip.datasets.query.drift import Drift
from microslip.sweeps import evaluate, map_refinement
from microslip.sweeps.batches import PointRequests, answer
from microslip.sweeps.store import Store

CONFIGURATION = Path(__file__).parents[1] / "config" / "config.yaml"
NAMES = (
    *("longitudinal", "normal_load", "normal_indentation", "drift_transverse"),
    *("flat_end", "punch", "ring", "cone", "ellipse", "figure_of_eight"),
)
ERRORS = (1e-2, 3e-3)
HEAD = """# Certified maps of other motions, pressures and drives

Made by `benchmarks/other_maps.py`: maps of sweeps in `config/config.yaml` at random places that
they have not used, where the solver was asked for a tenth of the error. A place is covered if the
map misses by no more than it claims and the solver's own error. Errors of drift are over the root
of 1 + velocity squared; some of its places stay where they are.
"""
TIMED = 20
"""Points of a map from which the time of all is told."""


def map_of(name, error):
    """The certified map of a sweep of the configuration within an error."""
    given = load.read_yaml(CONFIGURATION)
    part = "drives" if name in given["drives"] else "extended"
    sweeps = {name: given[part][name] | {"adaptive": {"error": error}}}
    one = {"sweeps": {"transverse": given["sweeps"]["transverse"]}, part: sweeps}
    return load.from_mapping(one, folders=[CONFIGURATION.parent]).certified[f"certified_{name}"]


def made(map_, store):
    """The records of all its points."""
    records = []

    def ask(requests):
        for request in tqdm(requests, desc=map_.name, leave=False):
            records.append(answer(request, store)[0])
            yield records[-1]

    map_refinement.refine(map_, ask)
    return records


def places_of(map_, number, seed):
    """Requests at random places of a map, for a tenth of its error."""
    rng = np.random.default_rng([seed, *map_.name.encode()])
    tolerance = float(f"{map_.error / 10:.6g}")
    found = []
    for share, row in rng.uniform(size=(number, 2)):
        point = {"amplitude": (_digits(map_.amplitude[0], map_.amplitude[1], row),)}
        if map_.force is None:
            velocity = 10.0 ** _digits(*np.log10(map_.velocity), share)
            point["velocity"] = (float(f"{velocity:.6g}"),)
        else:
            point["drives"] = (("force", (_digits(0.0, map_.force, share),), True),)
        found += PointRequests(replace(map_.sweep, tolerance=tolerance, **point))
    return found


def _digits(low, high, share):
    return float(f"{low + (high - low) * share:.6g}")


def judged(name, error, options, store):
    """A line of the table."""
    map_ = map_of(name, error)
    records = made(map_, store)
    data = certified_map.build(map_, records)
    drifts = map_.force is not None
    question = Drift(data) if drifts else Friction(data)
    value, across = ("velocity", "force") if drifts else ("mu_macro", "velocity")
    rows = []
    for request in tqdm(places_of(map_, options.places, options.seed), desc=map_.name, leave=False):
        true = answer(request, store)[0]["result"]
        said = question.at(float(request[across]), float(request["amplitude"]))
        pair = [float(said[part]) for part in (value, f"{value}_error")]
        rows.append([*pair, true[value], true[f"{value}_error"]])
    said, claim, true, own = np.array(rows).T
    miss, scale = abs(said - true), np.hypot(1.0, true) if drifts else 1.0
    return {
        "map": name,
        "error": f"{error:g}",
        "points": data.points,
        "not converged": int(data[value].isnull().sum()),
        "largest bound": f"{data.cell_error.values.max():.1e}",
        "places": len(rows),
        "covered": int((miss <= claim + own).sum()),
        "within the error": int((miss <= error * scale + own).sum()),
        "median miss": f"{np.median(miss):.1e}",
        "largest miss": f"{(miss / scale).max():.1e}",
        "CPU seconds, all points": f"{_seconds(records):.0f}",
    }


def _seconds(records):
    """CPU time of the solver for all points, from a few of them."""
    few = records[:: max(1, len(records) // TIMED)]
    evaluate.computed(few[0]["request"])  # compiled
    begun = time.process_time()
    for record in few:
        evaluate.computed(record["request"])
    return (time.process_time() - begun) * len(records) / len(few)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", default=NAMES)
    parser.add_argument("--errors", nargs="+", type=float, default=ERRORS)
    parser.add_argument("--places", type=int, default=150)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--results", type=Path, default=Path("results"))
    tables.add_markdown(parser)
    options = parser.parse_args()
    store = Store(options.results)
    asked = [(name, error) for name in options.names for error in options.errors]
    rows = [judged(*one, options, store) for one in asked]
    tables.publish(f"{HEAD}\n{tables.markdown(rows)}", options)


if __name__ == "__main__":
    main()
