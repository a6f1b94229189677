"""Do the errors of certified maps hold?  Random points solved, and uniform grids compared.

    python benchmarks/certified.py [--results FOLDER] [--maps NAME ...] [--calibration N] [--test N]
                                   [--seed S] [--output FILE] [--markdown FILE]

Needs the certified maps of a run (snakemake certified).  Random points on each, uniform in the
logarithm of the velocity and in the amplitude, are solved more strictly and compared with what the
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
    """(velocity, amplitude) of random points on a map, in their order."""
    motion = list(TOLERANCES).index(dataset.scene)
    shares = np.random.default_rng([seed, motion]).uniform(size=(number, 2))
    velocity, amplitude = dataset["velocity"].values, dataset["amplitude"].values
    slow, fast = np.log10([velocity.min(), velocity.max()])
    low, high = amplitude.min(), amplitude.max()
    return [
        (float(f"{10 ** (slow + (fast - slow) * s):.6g}"), float(f"{low + (high - low) * t:.6g}"))
        for s, t in shares
    ]


def solved(dataset, points, path):
    """(friction, error) at the points, shape (n, 2); those in the file are not solved again."""
    scene = dataset.scene
    lines = [line for line in tables.parsed(path) if line["scene"] == scene]
    known = {(line["velocity"], line["amplitude"]): line for line in lines}
    with path.open("a") as file:
        for v, a in tqdm([point for point in points if point not in known], desc=scene):
            found = microslip.solve(scene, v, a, tolerance=TOLERANCES[scene])
            line = {"scene": scene, "velocity": v, "amplitude": a}
            line |= {"mu_macro": found.mu_macro, "mu_macro_error": found.mu_macro_error}
            known[v, a] = line
            file.write(json.dumps(line) + "\n")
            file.flush()
    return np.array([[known[point][k] for k in ("mu_macro", "mu_macro_error")] for point in points])


def surpluses_at(dataset, velocity, amplitude):
    """The surplus of the cell that answers at each point, and the largest error of its nodes."""
    found = cells_of(dataset)
    x, y = found.cells.coordinates.scaled(velocity, amplitude)
    surplus, node_error = np.full(len(x), np.nan), np.full(len(x), np.nan)
    picked = dataset["cell_node"].values
    for border, nodes, index in zip(found.cells.borders, found.cells.nodes, picked, strict=True):
        left, right, low, high = border
        here = (x >= left) & (x <= right) & (y >= low) & (y <= high)
        surplus[here], node_error[here] = sum(surpluses_of(nodes)), found.errors[index].max()
    return surplus, node_error


def judged(dataset, points, truth, label):
    """A line of the table of promises."""
    velocity, amplitude = np.array(points).T
    answer = dataset.friction.at(*(xr.DataArray(x, dims="n") for x in (velocity, amplitude)))
    miss = abs(answer.mu_macro.values - truth[:, 0])
    claim = answer.mu_macro_error.values
    surplus, node_error = surpluses_at(dataset, velocity, amplitude)
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
        grids += [of_uniform_grid(dataset, count) for count in UNIFORM]
    text = f"{tables.markdown(promises)}\n\n{tables.markdown(grids)}"
    tables.publish(text, options)


if __name__ == "__main__":
    main()
