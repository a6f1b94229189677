"""Validate the error estimates at random points of all kinds, each against a reference.

    python benchmarks/error_estimates.py [--points N] [--first K] [--seed S] [--workers W]
                                         [--output FILE] [--markdown FILE] [--again] [--keep]
                                         [--start F] [--safety S] [--smallest S]

The points are those of `blind_points.py`. The quantities are the friction or, under a force, the
velocity, and the dissipated energy. The tolerance of a velocity above 1 is relative. The energy has
no tolerance, only an error estimate. A point fails if it is converged and the error of a quantity
exceeds the error estimate by more than the reference's uncertainty. Every twentieth point has a
reference for its energy.

The first reference is the same point, solved to a tenth of the tolerance. For tolerances of 1e-4
and below, it is solved to a quarter. It follows the same rules as the result. Therefore every
twentieth point, and every point whose error may exceed its estimate, also has a second reference,
which shares no run with the result. For one contact at a prescribed velocity, `finer.py` computes
the second reference. Otherwise, it is computed from two runs with more cells and steps than the
first reference. The second reference is also used if the first reference would take too much work,
for example for rotations at 1e-4. The reference with the smallest uncertainty judges the point.
References that contradict each other are listed.

Results are written to a file of JSON lines, point by point, and an interrupted run can be
continued. The run ends if changed sources give different values. --again solves all points again
and uses the existing references, including those in `docs/measured/references-SEED.csv`. The
previous file is renamed to FILE.before. --keep writes all references to that table.

--start multiplies the first level of every ladder. --safety replaces the safety factor. --smallest
replaces the smallest ratio of estimate to tolerance. With seed 3, these options calibrate the
estimate.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import time
from dataclasses import replace
from pathlib import Path

import blind_points
import finer
import known_references
import numpy as np
import resumable
import tables
from scipy.stats import beta

import microslip
from microslip.answer import ladder
from microslip.answer import refine as refinement
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.problem import Problem

TIGHTER, TIGHTER_AT_1E_4 = 0.1, 0.25
"""Ratio of the first reference's tolerance to the point's. 1e-5 is too expensive for rotations."""
TWICE = 20
"""Every point whose number is a multiple of TWICE has a second reference."""
MOST_WORK = 3e7
"""Largest work of a first reference and of other runs (about 10 s), except for `finer.py`."""
NOT_FINER = {"force", "stiffness", "contacts"}
"""Arguments of points that `finer.py` cannot solve."""
DENSER = 1.25, 1.75
"""Cells and steps in the two runs of a second reference, divided by those of the first reference.
No such run is also a level."""
EXACT = 1e-7
"""Largest uncertainty of a closed form. Runs cannot improve a closed form."""
CONFIDENCE = 0.95
"""Probability that the rate of failures is below its limit."""
AGAIN = 24
"""Number of points solved again when a run is continued, to detect changed sources."""
CHANGED = 0.1
"""The sources count as changed if a value changes by this fraction of its error estimate. Last
digits differ between processors."""
EVERY = 500
"""Number of points between two summaries."""
DOCS = Path(__file__).parents[1] / "docs/measured"
LADDER_FOR = ladder.ladder_for
"""The package's unmodified function."""
ENERGY = "energy_reference"
"""Key of the reference for the energy in a line."""
ALL_REFERENCES = "all_references"
"""Key of the list of all references in a line."""
SOURCES = ("resolution", "periodicity", "solver", "model")
"""Sources of the error estimate."""


def arguments_of(point: dict) -> dict:
    """Return the arguments of `microslip.solve` for a point."""
    return {name: value for name, value in point.items() if name != "stratum"}


def quantity(result: microslip.Result) -> tuple[float, float]:
    """Return the friction (under a force, the velocity) and its error estimate."""
    return result.answer.value, result.answer.error


def allowed(line: dict) -> float:
    """Return the tolerance of a line's quantity."""
    return line["tolerance"] * (max(1.0, abs(line["reference"])) if "force" in line else 1.0)


def off(line: dict) -> float:
    """Return the distance of a line's value from its reference."""
    return abs(line["value"] - line["reference"])


def ratio(line: dict) -> float:
    """Return (error of a line minus uncertainty of the reference) divided by the error estimate."""
    beyond = off(line) - line["uncertainty"]
    return beyond / max(line["error"], 1e-12) if beyond > 0.0 else 0.0


def is_judged(line: dict) -> bool:
    """Return True if a line is converged and has a reference."""
    return line["converged"] and bool(line["by"])


def failed(line: dict) -> bool:
    """Return True if the error estimate of a converged point is too small."""
    return is_judged(line) and ratio(line) > 1.0


def has_energy(line: dict) -> bool:
    """Return True if a line is converged and has a reference for its energy."""
    return line["converged"] and ENERGY in line and line.get("energy") is not None


def energy_ratio(line: dict) -> float:
    """Return `ratio` for the dissipated energy."""
    beyond = abs(line["energy"] - line[ENERGY]) - line["energy_uncertainty"]
    return beyond / max(line["energy_error"], 1e-12) if beyond > 0.0 else 0.0


def energy_failed(line: dict) -> bool:
    """Return True if the error estimate of the energy is too small."""
    return has_energy(line) and energy_ratio(line) > 1.0


def calibrate(
    start: float = 1.0,
    safety: float = refinement.SAFETY,
    smallest: float = refinement.SMALLEST_SHARE,
) -> None:
    """Set the constants of the error estimate in this process; the defaults reset them."""

    def scaled(*arguments) -> ladder.Ladder:
        plain = LADDER_FOR(*arguments)
        return plain if plain.imposed else replace(plain, start=start * plain.start)

    ladder.ladder_for = scaled
    refinement.SAFETY, refinement.SMALLEST_SHARE = safety, smallest


def examine(seed: int, k: int, reference: dict | None, constants: dict) -> dict:
    """Return a line of the output: point k, result, reference. A reference of None is computed."""
    point = blind_points.point(seed, k)
    calibrate(**constants)
    began = time.process_time()
    result = microslip.solve(**arguments_of(point))
    seconds = time.process_time() - began
    value, error = quantity(result)
    line = {
        "k": k,
        **point,
        "value": value,
        "error": error,
        "parts": [result.answer.by_source.get(source, 0.0) for source in SOURCES],
        "converged": result.converged,
        "reason": result.reason,
        "seconds": round(seconds, 3),
        "energy": result.dissipated_energy,
        "energy_error": result.dissipated_energy_error,
    }
    calibrate()
    if k % TWICE == 0 and result.dissipation is not None and ENERGY not in (reference or {}):
        line |= energy_of(point)
    if reference is not None and ALL_REFERENCES not in reference:
        return reference | line  # the reference may be a whole line of an earlier run
    return line | judged(k, point, line, result, reference)


def energy_of(point: dict) -> dict:
    """Return the energy reference of a point and its uncertainty, or {} if there is none."""
    _, result = tighter(point, MOST_WORK)
    if not result.converged or result.dissipation is None:
        return {}
    return {ENERGY: result.dissipation.value, "energy_uncertainty": result.dissipation.error}


def judged(k: int, point: dict, line: dict, result: microslip.Result, before: dict | None) -> dict:
    """Return the best reference of point k, all of its references, and the CPU seconds.

    The best reference has the smallest uncertainty. The argument `line` contains the value and the
    error of the point, `result` its microslip.Result, and `before` references of an earlier run.
    """
    began = time.process_time()
    every, spent = (
        (list(before[ALL_REFERENCES]), before["reference_seconds"]) if before else ([], 0.0)
    )
    first_result = None

    def best():
        return min(every, key=lambda one: (not one["by"], one["uncertainty"]))

    def clear():
        away = abs(line["value"] - best()["reference"]) + best()["uncertainty"]
        return best()["by"] and (away <= line["error"] or best()["uncertainty"] <= EXACT)

    def add_independent():
        if all(one["by"] != "finer" for one in every):
            every.append(independent(point, result, first_result))

    if not every or not clear():
        others = bool(point.keys() & NOT_FINER)
        first, first_result = tighter(point, MOST_WORK)
        every += [] if every else [first]
        if not clear() or (k % TWICE == 0 and first["uncertainty"] > EXACT):
            add_independent()
        if not clear() and not first["by"] and not others:
            every.append(tighter(point)[0])
    return best() | {
        ALL_REFERENCES: [one for one in every if one["by"]],
        "reference_seconds": round(spent + time.process_time() - began, 3),
    }


def tighter(point: dict, most_work: float | None = None) -> tuple[dict, microslip.Result]:
    """Return a reference at a tighter tolerance, and its Result. `by` is "" if not converged."""
    tolerance = point["tolerance"] * (TIGHTER if point["tolerance"] > 1e-4 else TIGHTER_AT_1E_4)
    arguments = arguments_of(point) | {"tolerance": tolerance}
    result = microslip.solve(**arguments, most_work=most_work)
    value, error = quantity(result)
    by = "tighter" if result.converged else ""
    return {"reference": value, "uncertainty": error, "by": by}, result


def independent(point: dict, result: microslip.Result, first: microslip.Result) -> dict:
    """Return a reference that shares no run with a point's result and first reference."""
    if not NOT_FINER & point.keys():
        pressure = pressure_named(point["pressure"])
        place = (point["velocity"], point["amplitude"], point["poisson"])
        problem = Problem(motion_named(point["motion"]), *place, pressure)
        value, uncertainty = finer.reference(problem, point["tolerance"], result)
        return {"reference": float(value), "uncertainty": float(uncertainty), "by": "finer"}
    expected = first.effort.work * DENSER[1] ** 3 if first.converged else np.inf
    ran = first if expected < MOST_WORK else result
    if not ran.cells:  # a closed form
        return {"reference": np.nan, "uncertainty": np.inf, "by": ""}
    arguments = arguments_of(point) | {"tolerance": point["tolerance"] * TIGHTER}
    values, rest = [], 0.0
    for factor in DENSER:
        imposed = {"cells": 2 * round(0.5 * factor * ran.cells)}  # squares need an even number
        if ran.steps_per_period:
            imposed["steps"] = 2 * round(0.5 * factor * ran.steps_per_period)
        run = microslip.solve(**arguments, **imposed, most_work=MOST_WORK)
        if not run.periodic:
            return {"reference": np.nan, "uncertainty": np.inf, "by": ""}
        values.append(quantity(run)[0])
        rest = max(rest, run.answer.error - run.answer.by_source["resolution"])
    coarse, fine = values
    beyond = (fine - coarse) / ((DENSER[1] / DENSER[0]) ** 2 - 1.0)  # second order
    return {"reference": fine + beyond, "uncertainty": abs(beyond) + rest, "by": "finer"}


def contradict(line: dict) -> bool:
    """Return True if two references differ by more than the sum of their uncertainties."""
    every = line.get(ALL_REFERENCES, ())
    return any(
        abs(one["reference"] - other["reference"]) > one["uncertainty"] + other["uncertainty"]
        for one in every
        for other in every
    )


def summary(seed: int, lines: list[dict]) -> str:
    """Return Markdown: error/estimate ratios by stratum and by tolerance, and all failures."""
    rows = []
    for stratum in blind_points.strata_of(seed):
        of = [line for line in lines if line["stratum"] == stratum.name]
        rows += [_row(stratum.name, of)] if of else []
    for tolerance in sorted({line["tolerance"] for line in lines}, reverse=True):
        rows.append(
            _row(
                f"tolerance {tolerance:g}", [one for one in lines if one["tolerance"] == tolerance]
            )
        )
    rows.append(_row("all", lines))
    return "\n".join([_verdict(lines), "", tables.markdown(rows), *_exceptions(lines)]) + "\n"


def _verdict(lines):
    """Return sentences about the number of estimates that are too small, and the largest errors."""
    converged = [line for line in lines if is_judged(line)]
    failures = [line for line in converged if failed(line)]
    n, x = len(converged), len(failures)
    limit = beta.ppf(CONFIDENCE, x + 1, n - x) if x < n else 1.0
    largest = max((ratio(line) for line in converged), default=0.0)
    farthest = max((_over_tolerance(line) for line in converged), default=0.0)
    twice = [line for line in lines if len(line.get(ALL_REFERENCES, ())) > 1]
    plain = [off(line) / max(line["error"], 1e-12) for line in converged] or [0.0]
    text = (
        f"Of {len(lines)} points, {n} converged and have a reference. At {x} of these points, the"
        " error exceeds its estimate by more than the uncertainty of the reference. The"
        f" {CONFIDENCE:.0%} confidence limit of this rate is {1e3 * limit:.2f} in 1,000."
        f" The largest ratio of error to tolerance is {farthest:.2f}. The largest ratio of error to"
        " estimate is"
        f" {largest:.2f}, the median is {np.median(plain):.2f}, and 99 % of these ratios are below"
        f" {np.quantile(plain, 0.99):.2f}."
    )
    with_energy = [energy_ratio(line) for line in lines if has_energy(line)]
    if with_energy:
        text += (
            f" {len(with_energy)} points have a reference for the energy:"
            f" {sum(one > 1.0 for one in with_energy)} estimates of the energy are too small, and"
            f" the largest ratio of error to estimate is {max(with_energy):.2f}."
        )
    if twice:
        text += f" Points with two or more references: {len(twice)}."
        text += f" Points whose references contradict each other: {sum(map(contradict, twice))}."
    return text


def _over_tolerance(line):
    """Return (error minus uncertainty of the reference) divided by the tolerance."""
    return max(off(line) - line["uncertainty"], 0.0) / allowed(line)


def _row(name, lines):
    converged = [line for line in lines if is_judged(line)]
    return {
        "points": name,
        "number": len(lines),
        "converged": sum(line["converged"] for line in lines),
        "fail": sum(map(failed, lines)),
        "largest error / estimate": f"{max(map(ratio, converged), default=0.0):.2f}",
        "largest error / tolerance": f"{max(map(_over_tolerance, converged), default=0.0):.2f}",
    }


def _exceptions(lines):
    """Return sentences on failures, points not converged, and contradicting references."""
    text = []
    for line in sorted(filter(failed, lines), key=ratio, reverse=True):
        text.append(
            f"\nOne estimate is too small by a factor of {ratio(line):.2f}. The error is"
            f" {off(line):.1e} +- {line['uncertainty']:.0e} (from a {line['by']} run), but the"
            f" estimate is {line['error']:.1e}. This is point {_named(line)}."
        )
    for line in filter(energy_failed, lines):
        text.append(
            f"\nThe energy of point {_named(line)} fails by a factor of {energy_ratio(line):.2f}:"
            f" it is {line['energy']:.5g} +- {line['energy_error']:.1e}, but the reference is"
            f" {line[ENERGY]:.5g} +- {line['energy_uncertainty']:.0e}."
        )
    for line in lines:
        if not line["converged"]:
            text.append(f"\nPoint {line['k']} did not converge: `{line['reason']}`.")
    without = sum(not line["by"] for line in lines)
    if without:
        text.append(f"\n{without} points have no reference.")
    for line in lines:
        if contradict(line):
            every = ", ".join(
                f"{one['reference']:.6g} +- {one['uncertainty']:.0e} ({one['by']})"
                for one in line[ALL_REFERENCES]
            )
            text.append(f"\nThe references of point {_named(line)} contradict each other: {every}.")
    return text


def _named(line):
    names = [n for n in known_references.COLUMNS if line.get(n) is not None]
    return f"{line['k']} ({', '.join(f'{name} {line[name]}' for name in names)})"


def refuse_changed(lines: list[dict], constants: dict) -> None:
    """End the run if the present sources give different values for some of the lines."""
    calibrate(**constants)
    for i in np.linspace(0, len(lines) - 1, min(AGAIN, len(lines))).astype(int):
        point = blind_points.point(lines[i]["seed"], lines[i]["k"])
        value, _ = quantity(microslip.solve(**arguments_of(point)))
        if abs(value - lines[i]["value"]) > CHANGED * lines[i]["error"]:
            raise SystemExit(f"{_named(lines[i])} has other values with these sources: see --again")


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--points", type=int, default=6000)
    parser.add_argument("--first", type=int, default=0, help="number of the first point")
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, help="default: results/error-estimates-SEED.jsonl")
    parser.add_argument("--again", action="store_true", help="solve again, use existing references")
    parser.add_argument("--keep", action="store_true", help="write the references to docs")
    parser.add_argument("--start", type=float, default=1.0)
    parser.add_argument("--safety", type=float, default=refinement.SAFETY)
    parser.add_argument("--smallest", type=float, default=refinement.SMALLEST_SHARE)
    options = parser.parse_args()
    constants = {name: getattr(options, name) for name in ("start", "safety", "smallest")}
    output = options.output or Path(f"results/error-estimates-{options.seed}.jsonl")
    output.parent.mkdir(parents=True, exist_ok=True)
    lines = {line["k"]: line for line in tables.parsed(output)}
    table = DOCS / f"references-{options.seed}.csv"
    references = known_references.read(table, options.seed)
    if options.again:
        references, lines = {**references, **lines}, {}
        if output.exists():
            output.replace(output.with_name(output.name + ".before"))
    refuse_changed([line | {"seed": options.seed} for line in lines.values()], constants)

    def jobs_of(k):
        return examine, options.seed, k, references.get(k), constants

    for end in [*range(options.first + EVERY, options.points, EVERY), options.points]:
        numbers = [
            k
            for k in range(options.first, end)
            if "contacts" not in blind_points.point(options.seed, k)
        ]
        resumable.add_lines(output, lines, numbers, jobs_of, options.workers)
        if options.markdown:
            text = summary(options.seed, [lines[k] for k in numbers])
            options.markdown.write_text(text, encoding="utf-8")
    if options.keep:
        known_references.write(table, {**references, **lines}, options.seed)
    tables.publish(summary(options.seed, [lines[k] for k in numbers]), options)


if __name__ == "__main__":
    main()
