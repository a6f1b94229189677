"""Validate the error bounds of interpolation at omitted lines of maps and at random points.

    python benchmarks/interpolation.py [--results FOLDER] [--points N] [--seed S] [--markdown FILE]

The folder contains the maps of a run (transverse.nc, bore.nc). Each inner line of a map, along each
axis, is omitted in turn and interpolated from the other lines. Then N random points on each map are
solved to 2e-4 and compared with the map. An interpolated value is covered if its error is at most
its error bound plus the error estimate of the reference.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

from pathlib import Path

import numpy as np
import tables
import xarray as xr
from tqdm import tqdm

import microslip

TOLERANCE = 2e-4


def omitted(dataset):
    """Return (error, bound) at every point of every inner line, from the other lines."""
    errors, bounds = [], []
    for dim in ("amplitude", "velocity"):
        for i in range(1, dataset.sizes[dim] - 1):
            rest = dataset.isel({dim: np.delete(np.arange(dataset.sizes[dim]), i)})
            line = dataset.isel({dim: [i]})
            answer = rest.microslip.at(line["velocity"].values, line["amplitude"].values)
            errors.append(abs(answer.mu_macro.values - line.mu_macro.values).ravel())
            bounds.append((answer.mu_macro_error.values + line.mu_macro_error.values).ravel())
    return np.concatenate(errors), np.concatenate(bounds)


def places(dataset, points, rng):
    """Return random velocities (log-uniform) and amplitudes on the map."""
    v, a = dataset["velocity"].values, dataset["amplitude"].values
    ends = np.log10(v[[0, -1]])
    return 10 ** rng.uniform(*ends, points), rng.uniform(0, a[-1], points)


def solved(dataset, velocity, amplitude, label):
    """Return (error, bound) of interpolated values at points, with the solver as reference."""
    pairs = list(zip(velocity, amplitude, strict=True))
    answer = dataset.microslip.at(*(xr.DataArray(x, dims="n") for x in (velocity, amplitude)))
    results = [
        microslip.solve(dataset.motion, v, a, tolerance=TOLERANCE)
        for v, a in tqdm(pairs, desc=label, leave=False)
    ]
    truth, error = (
        np.array([getattr(r, k) for r in results]) for k in ("mu_macro", "mu_macro_error")
    )
    return abs(answer.mu_macro.values - truth), answer.mu_macro_error.values + error


def row(motion, where, error, bound):
    """Return one row of the table."""
    return {
        "map": motion,
        "points": where,
        "number": len(error),
        "covered, %": f"{100 * np.mean(error <= bound):.1f}",
        "median error": f"{np.median(error):.1e}",
        "largest error": f"{error.max():.1e}",
        "median bound": f"{np.median(bound):.1e}",
        "95 % of bounds": f"{np.quantile(bound, 0.95):.1e}",
    }


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng, rows = np.random.default_rng(options.seed), []
    for motion in ("transverse", "bore"):
        dataset = microslip.open_map(motion, options.results).load()
        rows.append(row(motion, "omitted lines", *omitted(dataset)))
        where = places(dataset, options.points, rng)
        rows.append(row(motion, "on the map", *solved(dataset, *where, motion)))
    tables.publish(tables.markdown(rows), options)


if __name__ == "__main__":
    main()
