"""Validate the error estimates of certified maps at random points, and compare them with grids.

    python benchmarks/certified.py [--results FOLDER ...] [--maps NAME ...] [--points N] [--seed S]
                                   [--output FILE] [--markdown FILE]

Each folder contains the certified maps of a run (config/certified.yaml). Random points are uniform
in log velocity and in amplitude and, for a map over Poisson's ratio, also in this ratio. The points
were not used to make a map or to choose map_refinement.SHARE. Their references have a smaller
tolerance than the motion's most accurate map. A point is covered if the map's error is at most its
error estimate plus the reference's error estimate. The output file stores the references, so that
the next run can reuse them.

The error estimate of a uniform grid is computed by dataset.microslip.at. The grid's nodes are
taken from the certified map and count as exact. To measure the cost of a point, some points of the
grid and of the map are solved to the map's tolerance.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import json
import time
from pathlib import Path

import numpy as np
import tables
import xarray as xr
from tqdm import tqdm

import microslip
from microslip.datasets.interpolation import cells_of
from microslip.sweeps.map_refinement import surpluses_of

TRUTH = {"transverse": 0.1, "bore": 0.2}
"""Tolerance of a motion's references, divided by the smallest error of the motion's maps."""
TIMED = 40
"""Number of points of a grid that are solved to measure their cost."""
UNIFORM = (25, 97, 193)
"""Numbers of nodes along each axis of the uniform grids."""

JUDGEMENTS = """\
The first table tests certified maps at random points, uniformly distributed in the logarithm of the
velocity and in the amplitude. The points were used neither to make a map nor to choose a constant.
A point is covered if the error of the map is at most the sum of the error estimates of the map and
the reference. The last column is the smallest fraction of the surplus that would cover all
points."""
GRIDS = """\
The second table compares the maps with uniform grids whose nodes are as accurate as the points of
the map. Between the nodes, the error estimate is that of `dataset.microslip.at`."""


def random_points(dataset, number, seed):
    """Return (velocity, amplitude, Poisson's ratio) of random points on a map."""
    motion = list(TRUTH).index(dataset.motion)
    rng = np.random.default_rng([seed, motion])
    velocity, amplitude, poisson = (
        dataset[name].values for name in ("velocity", "amplitude", "poisson")
    )
    ranges = [np.log10([velocity.min(), velocity.max()]), [amplitude.min(), amplitude.max()]]
    shares = rng.uniform(size=(number, 2 + poisson.ndim))
    ranges += [[poisson.min(), poisson.max()]] * poisson.ndim
    low, high = np.array(ranges).T
    places = low + (high - low) * shares
    places[:, 0] = 10 ** places[:, 0]
    if not poisson.ndim:
        places = np.column_stack([places, np.full(number, float(poisson))])
    return [tuple(float(f"{value:.6g}") for value in place) for place in places]


def solved(motion, points, tolerance, path):
    """Return friction and error at each point, shape (n, 2). Points in the file are reused."""
    names = ("velocity", "amplitude", "poisson")
    lines = [line for line in tables.parsed(path) if line["motion"] == motion]
    by_point = {tuple(line[n] for n in names): line for line in lines if line["asked"] == tolerance}
    with path.open("a") as file:
        for point in tqdm([point for point in points if point not in by_point], desc=motion):
            place = dict(zip(names, point, strict=True))
            result = microslip.solve(motion, **place, tolerance=tolerance)
            line = {"motion": motion, "asked": tolerance} | place
            line |= {"mu_macro": result.mu_macro, "mu_macro_error": result.mu_macro_error}
            by_point[point] = line
            file.write(json.dumps(line) + "\n")
            file.flush()
    return np.array(
        [[by_point[point][k] for k in ("mu_macro", "mu_macro_error")] for point in points]
    )


def cost(dataset, velocity, amplitude, poisson):
    """Return the mean CPU time (s) of some of the points. The arguments have the shape (n,)."""
    chosen = np.random.default_rng(0).permutation(len(velocity))[:TIMED]
    begun = time.process_time()
    for k in chosen:
        place = float(velocity[k]), float(amplitude[k])
        settings = {"poisson": float(poisson[k]), "tolerance": dataset.tolerance}
        microslip.solve(dataset.motion, *place, **settings)
    return (time.process_time() - begun) / len(chosen)


def surpluses_at(dataset, points):
    """Return the surplus of the cell at each point, and the largest error estimate of its nodes."""
    table = cells_of(dataset)
    coordinates = table.coordinates
    scaled = coordinates.scaled(*np.array(points).T[: len(coordinates.directions)])
    surplus, node_error = np.full((2, len(scaled)), np.nan)
    picked, errors = dataset["cell_node"].values, dataset["mu_macro_error"].values
    for ends, nodes, index in zip(table.borders, table.nodes, picked, strict=True):
        here = ((scaled >= ends[:, 0]) & (scaled <= ends[:, 1])).all(axis=1)
        surplus[here], node_error[here] = sum(surpluses_of(nodes)), errors[index].max()
    return surplus, node_error


def judged(dataset, points, truth):
    """Return a row of the table of error estimates."""
    answers = [dataset.microslip.at(v, a, poisson=nu) for v, a, nu in points]
    mu, estimate = (
        np.array([float(x[n]) for x in answers]) for n in ("mu_macro", "mu_macro_error")
    )
    miss = abs(mu - truth[:, 0])
    surplus, node_error = surpluses_at(dataset, points)
    share = np.clip(miss - truth[:, 1] - node_error, 0.0, None) / surplus
    return named(dataset) | {
        "points of the map": dataset.points,
        "random points": len(points),
        "covered, %": f"{100 * np.mean(miss <= estimate + truth[:, 1]):.2f}",
        "largest error": f"{miss.max():.1e}",
        "largest estimate": f"{dataset.cell_error.values.max():.1e}",
        "fraction of the surplus": f"{share.max():.3f}",
    }


def named(dataset):
    """Return the first columns of a row: the map and its error."""
    over = dataset["poisson"]
    ratio = ", Poisson's ratio {:g} to {:g}".format(*over.values[[0, -1]]) if over.ndim else ""
    return {"map": dataset.motion + ratio, "error": f"{dataset.error:g}"}


def of_map(dataset):
    """Return the row of the map in the table of grids."""
    bounds = dataset.cell_error.values
    nodes = [dataset[name].values for name in ("velocity", "amplitude", "poisson")]
    seconds = cost(dataset, *np.broadcast_arrays(*nodes))
    return of_grid(dataset, "certified", dataset.points, bounds, seconds)


def of_uniform_grid(dataset, count):
    """Return the row of a uniform grid, with error estimates at the centres of its cells."""
    ends = [(float(dataset[n].min()), float(dataset[n].max())) for n in ("velocity", "amplitude")]
    grid = dataset.microslip.at(np.geomspace(*ends[0], count), np.linspace(*ends[1], count))
    grid["mu_macro_error"] = xr.zeros_like(grid.mu_macro_error) + dataset.tolerance
    grid["converged"] = xr.ones_like(grid.mu_macro, bool)
    middles = {
        "velocity": np.sqrt(grid.velocity.values[1:] * grid.velocity.values[:-1]),
        "amplitude": 0.5 * (grid.amplitude.values[1:] + grid.amplitude.values[:-1]),
    }
    estimate = grid.microslip.at(**middles).mu_macro_error.values
    nodes = [axis.ravel() for axis in np.meshgrid(grid.velocity.values, grid.amplitude.values)]
    seconds = cost(dataset, *nodes, np.full(count * count, float(dataset["poisson"])))
    return of_grid(dataset, f"{count} x {count}, uniform", count * count, estimate, seconds)


def of_grid(dataset, grid, points, estimate, seconds):
    """Return the row of a grid with these error estimates and this CPU time (s) per point."""
    return named(dataset) | {
        "grid": grid,
        "points": points,
        "largest estimate": f"{estimate.max():.1e}",
        "CPU s, all points": f"{seconds * points:.0f}",
    }


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--results", type=Path, nargs="+", default=[Path("results/certified")])
    parser.add_argument("--maps", nargs="+", default=["transverse", "bore"])
    parser.add_argument("--points", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=31)
    parser.add_argument("--output", type=Path, default=Path("results/certified_points.jsonl"))
    options = parser.parse_args()
    judgements, grids = [], []
    for name in options.maps:
        maps = [microslip.open_map(name, path).load() for path in options.results]
        least = min(dataset.error for dataset in maps)
        motion = maps[0].motion
        points = random_points(maps[0], options.points, options.seed)
        truth = solved(motion, points, TRUTH[motion] * least, options.output)
        for dataset in maps:
            judgements.append(judged(dataset, points, truth))
            grids.append(of_map(dataset))
            if dataset.error == least and not dataset["poisson"].ndim:
                grids += [of_uniform_grid(dataset, count) for count in UNIFORM]
    text = (JUDGEMENTS, tables.markdown(judgements), GRIDS, tables.markdown(grids))
    tables.publish("\n\n".join(text), options)


if __name__ == "__main__":
    main()
