"""Do the certificates hold?  Random points, each against a reference four times as fine.

    python benchmarks/certificates.py [--points N] [--seed S] [--workers W] [--output FILE]
                                  [--markdown FILE] [--extended]

Velocity log-uniform in 1e-4..1e2, amplitude log-uniform in 1e-2..1e2, both oscillating scenes,
nu one of 0, 0.3, 0.5; tolerances 1e-2, 1e-3 and 1e-4 in turn.  With --extended other motions and
pressures take their turns, with velocity in 1e-3..10, amplitude in 0.05..5, nu 0, tolerances 1e-2
and 1e-3; and the static limit of loops, at velocity 0.  A point is covered if

    |mu_macro - reference| <= mu_macro_error <= tolerance.

The reference has four times the rings, angles and steps that the point was certified with (no more
than 192 rings or squares, 64 angles and 2048 steps in half a period), each refined by itself from a
base that is finer than any certificate starts from, every periodic state searched for from scratch,
to a tenth of the tolerance.  What is left of its own error is estimated from the run with half of
the refinement.  Results go to a file of JSON lines, point by point; an interrupted run goes on
where it stopped.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import json
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import replace
from pathlib import Path

import numpy as np
import tables

import microslip
from microslip.adaptive.choice import choose_model
from microslip.motions.by_name import motion_named
from microslip.solver.problem import Problem, Resolution
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static

TOLERANCES = (1e-2, 1e-3, 1e-4)
POISSON = (0.0, 0.3, 0.5)
VELOCITIES, AMPLITUDES = (-4.0, 2.0), (-2.0, 2.0)
"""Decimal logarithms of the ranges."""
EXTENDED = [
    *(
        (scene, pressure)
        for pressure in ("power:exponent=1", "power:exponent=8", "punch", "ring", "ellipse")
        for scene in ("transverse", "bore")
    ),
    ("elliptic", "hertz"),
    ("elliptic:forward=0.5,phase=30", "hertz"),
    ("elliptic:forward=0.5,phase=0,forward_cycles=2", "hertz"),
    ("transverse-bore", "hertz"),
    ("transverse-bore:phase=90", "hertz"),
]
"""Motions and pressures besides the paper's."""
LOADS = [
    ("normal:lateral=1", "hertz"),
    ("normal:lateral=1,normal_cycles=2", "hertz"),
    ("normal:forward=1,phase=90", "hertz"),
]
"""Motions with a normal load that changes, a fifth as many points of them."""
LIMITS = [
    *((scene, "hertz") for scene, _ in EXTENDED[-5:-2]),
    *LOADS,
    ("elliptic", "power:exponent=1"),
    ("elliptic:forward=0.5,phase=30", "punch"),
]
"""Motions whose static limit takes a whole period, as many."""
LIMIT_AMPLITUDES = (-1.3, 0.1)
TURNED = [
    ("normal:angle=1", "hertz"),
    ("normal:angle=1,normal_cycles=2", "hertz"),
    ("normal:indentation=1,angle=0.5,forward=1,phase=30", "hertz"),
]
"""... with a rotation, as many."""
SWEPT = {"radial": ((96, 1), (192, 1)), "polar": ((64, 12), (96, 24))}
SWEPT_STEPS = 4
"""Rings and angles of their reference, and steps in half a period over rings: all are refined
together."""
EXTENDED_VELOCITIES, EXTENDED_AMPLITUDES = (-3.0, 1.0), (-1.3, 0.7)
FINER = 4
BASE = {"radial": Resolution(32, 1, 48), "polar": Resolution(24, 12, 32)}
LEAST = {"radial": Resolution(64, 1, 96), "polar": Resolution(48, 16, 64)}
BASE["cartesian"], LEAST["cartesian"] = Resolution(32, 1, 32), Resolution(96, 1, 64)
MOST = Resolution(192, 64, 2048)
"""Resolutions (steps in half a period) of the reference: its base, and bounds of its finest."""
PERIODICITY = 0.1
"""Distance of the reference from its periodic states, over the tolerance."""


def sample(points, seed):
    """Points as (scene, velocity, amplitude, nu, tolerance)."""
    draw = np.random.default_rng(seed)
    out = []
    for k in range(points):
        velocity = float(f"{10 ** draw.uniform(*VELOCITIES):.4g}")
        amplitude = float(f"{10 ** draw.uniform(*AMPLITUDES):.4g}")
        scene = str(draw.choice(["transverse", "bore"]))
        out.append((scene, velocity, amplitude, float(draw.choice(POISSON)), TOLERANCES[k % 3]))
    return out


def sample_extended(points, seed):
    """The same for other motions and pressures; with the name of the pressure at the end."""
    few = points // 5
    return [
        *_sample_of(EXTENDED, points, seed),
        *_sample_of(LOADS, few, seed + 1),
        *_sample_of(LIMITS, few, seed + 2, None, LIMIT_AMPLITUDES),
        *_sample_of(TURNED, few, seed + 3),
    ]


def _sample_of(cases, points, seed, velocities=EXTENDED_VELOCITIES, amplitudes=EXTENDED_AMPLITUDES):
    draw = np.random.default_rng(seed)
    out = []
    for k in range(points):
        velocity = float(f"{10 ** draw.uniform(*velocities):.4g}") if velocities else 0.0
        amplitude = float(f"{10 ** draw.uniform(*amplitudes):.4g}")
        scene, pressure = cases[k % len(cases)]
        tolerance = TOLERANCES[k // len(cases) % 2]
        out.append((scene, velocity, amplitude, 0.0, tolerance, pressure))
    return out


def reference(problem, tolerance, certified):
    """(mu, uncertainty) four times as fine as the ``certified`` Result."""
    kind = problem.motion
    model = choose_model(kind, problem.poisson)
    stroke = min(max(kind.stroke(problem.amplitude, problem.poisson), 1.0), 16.0) ** 0.5
    stroke *= kind.cycles

    def run(resolution):
        if problem.velocity == 0.0:
            share = PERIODICITY * tolerance
            return simulate_static(problem, model, resolution, share)
        return simulate(problem, model, resolution, PERIODICITY * tolerance)

    if kind.depth is not None:
        coarse, fine = (
            run(Resolution(rings, angles, 2 * round(0.5 * SWEPT_STEPS * rings * stroke)))
            for rings, angles in SWEPT[model]
        )
        return fine.mu, abs(fine.mu - coarse.mu)
    base = replace(BASE[model], steps=2 * round(0.5 * BASE[model].steps * stroke))

    left = []  # distances from the periodic states

    def mean(**changes):
        at = replace(base, **changes)
        found = run(at)
        left.append(found.distance)
        return found.mu

    at_base, mu, uncertainty = mean(), 0.0, 0.0
    used = Resolution(certified.cells, certified.angles, certified.steps_per_period // 2)
    for axis in ("cells", "angles", "steps"):
        if axis == "angles" and model != "polar":
            continue
        finest = max(FINER * getattr(used, axis), getattr(LEAST[model], axis))
        finest = min(finest, getattr(MOST, axis))
        coarse, fine = mean(**{axis: finest // 2}), mean(**{axis: finest})
        beyond = (fine - coarse) / 3.0  # second order
        mu += fine + beyond - at_base
        uncertainty += abs(beyond)
    if model == "polar":  # what rings and angles do together
        twice = {"cells": 2 * base.cells, "angles": 2 * base.angles}
        one, other = (mean(**{axis: count}) for axis, count in twice.items())
        mixed = mean(**twice) - one - other + at_base
        mu, uncertainty = mu + mixed, uncertainty + 0.5 * abs(mixed)
    return at_base + mu, uncertainty + max(left)


def examine(point):
    """One line of the output: the point, its certificate, the reference."""
    scene, velocity, amplitude, poisson, tolerance, *pressure = point
    settings = {"poisson": poisson, "tolerance": tolerance}
    settings |= {"pressure": pressure[0]} if pressure else {}
    result = microslip.solve(scene, velocity, amplitude, **settings)
    problem = Problem(motion_named(scene, *pressure), velocity, amplitude, poisson)
    mu, uncertainty = reference(problem, tolerance, result)
    error = abs(result.mu_macro - mu)
    return {
        "point": list(point),
        "certified": result.to_dict(),
        "reference": mu,
        "reference_uncertainty": uncertainty,
        "covered": bool(error <= result.mu_macro_error <= tolerance and result.converged),
    }


def summary(lines):
    """Markdown table of the coverage by tolerance, and what was not covered."""
    out = ["| tolerance | points | covered | converged | median error / certificate | largest |"]
    out.append("|---|---|---|---|---|---|")
    missed = []
    for tolerance in TOLERANCES:
        group = [line for line in lines if line["point"][4] == tolerance]
        if not group:
            continue
        errors = [abs(line["certified"]["mu_macro"] - line["reference"]) for line in group]
        ratios = np.array(errors) / [line["certified"]["mu_macro_error"] for line in group]
        converged = sum(line["certified"]["converged"] for line in group)
        covered = sum(line["covered"] for line in group)
        out.append(
            f"| {tolerance:g} | {len(group)} | {covered} | {converged} "
            f"| {np.median(ratios):.2f} | {ratios.max():.2f} |"
        )
        missed += [line for line in group if not line["covered"]]
    for line in missed:
        scene, velocity, amplitude, poisson, tolerance, *pressure = line["point"]
        scene = " under ".join([scene, *pressure])
        certified = line["certified"]
        error = abs(certified["mu_macro"] - line["reference"])
        out.append(
            f"\nNot covered: {scene}, velocity {velocity:g}, amplitude {amplitude:g},"
            f" nu {poisson:g} at {tolerance:g}: error {error:.1e}"
            f" (+- {line['reference_uncertainty']:.0e}),"
            f" certificate {certified['mu_macro_error']:.1e}."
        )
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path("results/certificates.jsonl"))
    tables.add_markdown(parser)
    parser.add_argument("--extended", action="store_true")
    options = parser.parse_args()
    options.output.parent.mkdir(parents=True, exist_ok=True)
    draw = sample_extended if options.extended else sample
    wanted = draw(options.points, options.seed)
    known = options.output.read_text() if options.output.exists() else ""
    lines = {tuple(line["point"]): line for line in tables.parsed(options.output)}
    with ProcessPoolExecutor(options.workers) as pool, options.output.open("a") as file:
        if known and not known.endswith("\n"):
            file.write("\n")
        jobs = [pool.submit(examine, point) for point in wanted if point not in lines]
        for done, job in enumerate(as_completed(jobs), start=1):
            line = job.result()
            lines[tuple(line["point"])] = line
            file.write(json.dumps(line) + "\n")
            file.flush()
            print(f"\r{done} of {len(jobs)} points", end="", flush=True)
    print()
    tables.publish(summary([lines[point] for point in wanted]), options)


if __name__ == "__main__":
    main()
