"""Search for points whose error exceeds the error estimate, with local optimisation.

    python benchmarks/attacks.py [--chains N] [--first K] [--seed S] [--workers W] [--output FILE]
                                 [--markdown FILE]

A chain begins at a random point and takes STEPS random steps of decreasing length. A step is kept
if it increases the ratio of the error to the error estimate. Every evaluated point is an attack.
Its ratio is the largest over all quantities of the result. Each quantity is compared with a second
solution at a tenth of the tolerance, or at a hundredth if the ratio exceeds 1. An attack succeeds
if the error exceeds the estimate by more than the error estimate of the second solution.

The scenes are springs with a mass, energies of motions at a prescribed velocity, and imposed
resolutions. Results are written to a file of JSON lines, and an interrupted run can be continued.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import resumable
import tables

import microslip

STEPS = 7
"""Number of local steps after the random point."""
LENGTH, SHORTER = 0.3, 0.8
"""Standard deviation of the first step, in logarithms, and its ratio from step to step."""
MOTIONS = ("transverse", "zigzag", "transverse", "bore")
SCENES = {
    "spring with a mass": {
        "amplitude": (0.3, 3.0),
        "velocity": (0.01, 1.0),
        "stiffness": (0.1, 10.0),
        "mass": (0.02, 5.0),
    },
    "energy": {"amplitude": (0.1, 5.0), "velocity": (0.003, 2.0)},
    "imposed resolution": {
        "amplitude": (0.2, 3.0),
        "velocity": (0.01, 1.0),
        "cells": (4, 48),
        "steps": (8, 160),
    },
}
"""Ranges of the parameters of each scene, log-uniform. Cells and steps are even numbers."""
EVEN = ("cells", "steps")
TOLERANCES = (1e-2, 5e-3)
FINE = 1e-3
"""Tolerance of the reference of an imposed resolution."""
QUANTITIES = ("friction", "dissipation")
MOST_WORK = 1e8


def attacked(seed: int, k: int) -> dict:
    """Return line k of the output: the points of a chain and the ratio of each."""
    draw = np.random.default_rng([seed, k])
    scene = list(SCENES)[k % len(SCENES)]
    ranges = SCENES[scene]
    fixed = {"motion": str(draw.choice(MOTIONS))}
    if scene != "imposed resolution":
        fixed["tolerance"] = float(draw.choice(TOLERANCES))
    low, high = (np.log([ends[side] for ends in ranges.values()]) for side in (0, 1))
    place, length, largest, points = draw.uniform(low, high), LENGTH, -1.0, []
    for step in range(1 + STEPS):
        trial = np.clip(place + (length * draw.normal(size=len(low)) if step else 0.0), low, high)
        numbers = dict(zip(ranges, map(math.exp, trial), strict=True))
        counts = {name: 2 * round(numbers[name] / 2) for name in EVEN if name in numbers}
        point = fixed | numbers | counts
        ratio, beyond, quantity = judged(point)
        points.append(point | {"ratio": ratio, "beyond": beyond, "quantity": quantity})
        if ratio > largest:
            place, largest = trial, ratio
        length *= SHORTER
    return {"k": k, "scene": scene, "points": points}


def judged(point: dict) -> tuple[float, float, str]:
    """Return the largest ratio of error to estimate, the same ratio without the reference's
    uncertainty, and the quantity, or (0, 0, "") if the point or its reference is not converged."""
    result = microslip.solve(**{"tolerance": None} | point, most_work=MOST_WORK)
    if not result.converged:
        return 0.0, 0.0, ""
    best = compared(result, point, 0.1)
    finer = compared(result, point, 0.01) if best[0] > 1.0 else best
    return finer if finer[2] else best


def compared(result: microslip.Result, point: dict, factor: float) -> tuple[float, float, str]:
    """Return the result of `judged` for a reference at `factor` times the tolerance."""
    plain = {name: value for name, value in point.items() if name not in EVEN}
    tolerance = factor * point["tolerance"] if "tolerance" in point else 10.0 * factor * FINE
    reference = microslip.solve(**plain | {"tolerance": tolerance}, most_work=MOST_WORK)
    if not reference.converged:
        return 0.0, 0.0, ""
    ratios = {}
    for quantity in QUANTITIES:
        one, other = getattr(result, quantity), getattr(reference, quantity)
        off = abs(one.value - other.value)
        ratios[quantity] = max(off - other.error, 0.0) / one.error, off / one.error
    largest = max(ratios, key=ratios.__getitem__)
    return max(ratio for _, ratio in ratios.values()), ratios[largest][0], largest


def summary(lines: list[dict]) -> str:
    """Return Markdown with the number of attacks and misses of each scene, and every miss."""
    rows, misses = [], []
    for scene in [*SCENES, "all"]:
        points = [p for line in lines if scene in (line["scene"], "all") for p in line["points"]]
        judged_points = [p for p in points if p["quantity"] in QUANTITIES]
        ratios = [p["beyond"] for p in judged_points] or [0.0]
        rows.append(
            {
                "scene": scene,
                "attacks": len(points),
                "with a reference": len(judged_points),
                "too small": sum(ratio > 1.0 for ratio in ratios),
                "largest error / estimate": f"{max(ratios):.2f}",
            }
        )
        if scene == "all":
            misses = [p for p in judged_points if p["beyond"] > 1.0]
    texts = [f"\nFails by {p['beyond']:.2f} ({p['quantity']}): {p}." for p in misses]
    return "\n".join([tables.markdown(rows), *texts]) + "\n"


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--chains", type=int, default=250)
    parser.add_argument("--first", type=int, default=0, help="number of the first chain")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--output", type=Path, help="default: results/attacks-SEED.jsonl")
    options = parser.parse_args()
    output = options.output or Path(f"results/attacks-{options.seed}.jsonl")
    output.parent.mkdir(parents=True, exist_ok=True)
    lines = {line["k"]: line for line in tables.parsed(output)}
    numbers = range(options.first, options.chains)
    resumable.add_lines(
        output, lines, numbers, lambda k: (attacked, options.seed, k), options.workers
    )
    tables.publish(summary([lines[k] for k in numbers]), options)


if __name__ == "__main__":
    main()
