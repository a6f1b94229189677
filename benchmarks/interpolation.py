"""Do the bounds of interpolated answers hold?  Points left out of the maps, and random ones solved.

    python benchmarks/interpolation.py [--results FOLDER] [--points N] [--seed S] [--markdown FILE]

Needs the maps of a run (transverse.nc, bore.nc).  Lines of each map are left out one
by one, along both axes, ends excepted, and all their points asked for.  Then N random points on
each map, and N/4 each beyond every side of it, are solved to 2e-4 and compared with what the map
says.  An answer is covered if it misses by no more than its bound and the error of what it is
compared with.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
from pathlib import Path

import numpy as np
import tables
import xarray as xr
from tqdm import tqdm

import microslip

TOLERANCE = 2e-4


def left_out(dataset):
    """(miss, bound) of every point on a line that the rest of the map has to make up for."""
    misses, bounds = [], []
    for dim in ("amplitude", "velocity"):
        for i in range(1, dataset.sizes[dim] - 1):
            rest = dataset.isel({dim: np.delete(np.arange(dataset.sizes[dim]), i)})
            line = dataset.isel({dim: [i]})
            answer = rest.friction.at(line["velocity"].values, line["amplitude"].values)
            misses.append(abs(answer.mu_macro.values - line.mu_macro.values).ravel())
            bounds.append((answer.mu_macro_error.values + line.mu_macro_error.values).ravel())
    return np.concatenate(misses), np.concatenate(bounds)


def places(dataset, points, rng):
    """Random (velocities, amplitudes) by region: on the map, and beyond each of its sides."""
    v, a = dataset["velocity"].values, dataset["amplitude"].values
    first, last, top, few = np.log10(v[0]), np.log10(v[-1]), a[-1], points // 4
    spread = rng.uniform
    return {
        "on the map": (10 ** spread(first, last, points), spread(0, top, points)),
        "slower": (10 ** spread(first - 2, first, few), spread(0, top, few)),
        "faster": (10 ** spread(last, last + 1, few), spread(0, top, few)),
        "larger amplitudes": (10 ** spread(first, last, few), top * 10 ** spread(0, 1, few)),
    }


def solved(dataset, velocity, amplitude, label):
    """(miss, bound) of answers at points that the solver is asked for, too."""
    pairs = list(zip(velocity, amplitude, strict=True))
    answer = dataset.friction.at(*(xr.DataArray(x, dims="n") for x in (velocity, amplitude)))
    found = [
        microslip.solve(dataset.motion, v, a, tolerance=TOLERANCE)
        for v, a in tqdm(pairs, desc=label, leave=False)
    ]
    truth, error = (
        np.array([getattr(r, k) for r in found]) for k in ("mu_macro", "mu_macro_error")
    )
    return abs(answer.mu_macro.values - truth), answer.mu_macro_error.values + error


def row(motion, where, miss, bound):
    """One line of the table."""
    return {
        "map": motion,
        "points": where,
        "number": len(miss),
        "covered, %": f"{100 * np.mean(miss <= bound):.1f}",
        "median miss": f"{np.median(miss):.1e}",
        "largest miss": f"{miss.max():.1e}",
        "median bound": f"{np.median(bound):.1e}",
        "95 % of bounds": f"{np.quantile(bound, 0.95):.1e}",
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    tables.add_markdown(parser)
    options = parser.parse_args()
    rng, rows = np.random.default_rng(options.seed), []
    for motion in ("transverse", "bore"):
        dataset = microslip.open_map(motion, options.results).load()
        rows.append(row(motion, "lines left out", *left_out(dataset)))
        for where, place in places(dataset, options.points, rng).items():
            rows.append(row(motion, where, *solved(dataset, *place, f"{motion}, {where}")))
    tables.publish(tables.markdown(rows), options)


if __name__ == "__main__":
    main()
