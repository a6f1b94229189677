"""Do the errors of certified maps hold?  Random points solved, and uniform grids compared.

    python benchmarks/certified.py [--results FOLDER] [--maps NAME ...] [--calibration N] [--test N]
                                   [--seed S] [--output FILE] [--markdown FILE]

Needs the certified maps of a run (snakemake certified).  Random points on each, uniform in the
logarithm of the velocity, in the amplitude and, where the map is over it, in Poisson's ratio, are
solved more strictly and compared with what the
map says: the first N tell which share of a cell's surplus is missed at most (map_cells.SHARE is no
less than what 99.9 % of them need), the others whether the promise holds.  A point is covered if
the map misses by no more than it claims and the error of what it is compared with.  Points are kept
in the output file: the next run goes on from there.

How many points a uniform grid takes for the same claim is seen by taking its nodes from the
certified map, as exact, and asking how far friction.at then says that it may be off.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import json
from pathlib import Path

import numpy as np
import tables
import xarray as xr
from tqdm import tqdm

import microslip
from microslip.datasets.query.cells import cells_of
from microslip.sweeps.map_cells import surpluses_of

TOLERANCES = {"transverse": 1e-4, "bore": 2e-4}
UNIFORM = (25, 49, 97, 193)
"""Nodes along each axis of the grids that a map is compared with."""


def random_points(dataset, number, seed):
    """(velocity, amplitude, Poisson's ratio) of random points on a map, in their order."""
    motion = list(TOLERANCES).index(dataset.scene)
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


def solved(dataset, points, path):
    """(friction, error) at the points, shape (n, 2); those in the file are not solved again."""
    scene = dataset.scene
    lines = [line for line in tables.parsed(path) if line["scene"] == scene]
    names = ("velocity", "amplitude", "poisson")
    known = {tuple(line.get(name, 0.0) for name in names): line for line in lines}
    with path.open("a") as file:
        for point in tqdm([point for point in points if point not in known], desc=scene):
            place = dict(zip(names, point, strict=True))
            found = microslip.solve(scene, **place, tolerance=TOLERANCES[scene])
            line = {"scene": scene} | place
            line |= {"mu_macro": found.mu_macro, "mu_macro_error": found.mu_macro_error}
            known[point] = line
            file.write(json.dumps(line) + "\n")
            file.flush()
    return np.array([[known[point][k] for k in ("mu_macro", "mu_macro_error")] for point in points])


def surpluses_at(dataset, points):
    """The surplus of the cell that answers at each point, and the largest error of its nodes."""
    found = cells_of(dataset)
    coordinates = found.cells.coordinates
    scaled = coordinates.scaled(*np.array(points).T[: len(coordinates.directions)])
    surplus, node_error = np.full((2, len(scaled)), np.nan)
    picked = dataset["cell_node"].values
    for ends, nodes, index in zip(found.cells.borders, found.cells.nodes, picked, strict=True):
        here = ((scaled >= ends[:, 0]) & (scaled <= ends[:, 1])).all(axis=1)
        surplus[here], node_error[here] = sum(surpluses_of(nodes)), found.errors[index].max()
    return surplus, node_error


def judged(dataset, points, truth, label):
    """A line of the table of promises."""
    answers = [dataset.friction.at(v, a, poisson=nu) for v, a, nu in points]
    mu, claim = (np.array([float(x[n]) for x in answers]) for n in ("mu_macro", "mu_macro_error"))
    miss = abs(mu - truth[:, 0])
    surplus, node_error = surpluses_at(dataset, points)
    share = np.clip(miss - truth[:, 1] - node_error, 0.0, None) / surplus
    return {
        "map": dataset.scene,
        "error": f"{dataset.error:g}",
        "points of the map": dataset.points,
        "random points": f"{len(points)}, {label}",
        "covered, %": f"{100 * np.mean(miss <= claim + truth[:, 1]):.2f}",
        "within the error, %": f"{100 * np.mean(miss <= dataset.error + truth[:, 1]):.2f}",
        "median miss": f"{np.median(miss):.1e}",
        "largest miss": f"{miss.max():.1e}",
        "median claim": f"{np.median(claim):.1e}",
        "largest claim": f"{dataset.cell_error.values.max():.1e}",
        "share needed by 99.9 %": f"{np.quantile(share, 0.999):.3f}",
        "by all": f"{share.max():.3f}",
    }


def of_uniform_grid(dataset, count):
    """A line of the table of grids: what a uniform one claims at the middles of its meshes."""
    grid = dataset.friction.on_grid(count, count)
    grid["mu_macro_error"] = xr.zeros_like(grid.mu_macro_error) + dataset.tolerance
    grid["converged"] = xr.ones_like(grid.mu_macro, bool)
    middles = {
        "velocity": np.sqrt(grid.velocity.values[1:] * grid.velocity.values[:-1]),
        "amplitude": 0.5 * (grid.amplitude.values[1:] + grid.amplitude.values[:-1]),
    }
    claim = grid.drop_vars("source").friction.at(**middles).mu_macro_error.values
    return {
        "map": dataset.scene,
        "grid": f"{count} x {count}, uniform",
        "points": count * count,
        "largest claim": f"{claim.max():.1e}",
        "median claim": f"{np.median(claim):.1e}",
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--maps", nargs="+", choices=TOLERANCES, default=list(TOLERANCES))
    parser.add_argument("--calibration", type=int, default=1000)
    parser.add_argument("--test", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=21)
    parser.add_argument("--output", type=Path, default=Path("results/certified_points.jsonl"))
    tables.add_markdown(parser)
    options = parser.parse_args()
    promises, grids = [], []
    for scene in options.maps:
        dataset = microslip.open_map(f"certified_{scene}", options.results).load()
        points = random_points(dataset, options.calibration + options.test, options.seed)
        truth = solved(dataset, points, options.output)
        cut = options.calibration
        promises.append(judged(dataset, points[:cut], truth[:cut], "calibration"))
        promises.append(judged(dataset, points[cut:], truth[cut:], "test"))
        certified = {"map": scene, "grid": "certified", "points": dataset.points}
        bounds = dataset.cell_error.values
        certified |= {"largest claim": f"{bounds.max():.1e}"}
        grids += [certified | {"median claim": f"{np.median(bounds):.1e}"}]
        if not dataset["poisson"].ndim:
            grids += [of_uniform_grid(dataset, count) for count in UNIFORM]
    text = f"{tables.markdown(promises)}\n\n{tables.markdown(grids)}"
    tables.publish(text, options)


if __name__ == "__main__":
    main()
