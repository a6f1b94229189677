"""Do the claimed errors hold?  Random points of all kinds, each against a finer reference.

    python benchmarks/certificates.py [--points N] [--first K] [--seed S] [--workers W]
                                      [--output FILE] [--markdown FILE] [--again] [--keep]

The points are those of `blind_points.py`.  The reference is the same point at a tenth of the
tolerance (at 1e-4 a quarter), which begins with finer runs.  What it leaves open, since it is not
certain enough for that, did not converge or took long, is decided by `finer.py`, and what that
leaves open by the tighter tolerance again, with more time.  A claim holds if

    |mu_macro - reference| <= mu_macro_error <= tolerance.

The table is that of the points from --first on: those of which nothing was chosen.  References that
`docs/measured/references-SEED.csv` has are not computed again; --keep adds those that are new.

Results go to a file of JSON lines, point by point, and an interrupted run goes on where it stopped.
One that goes on under other sources first solves some of its points again, and ends if these have
changed in any bit.  --again then solves all points anew and keeps the references, which are no
result of the sources that they judge; what was there stays in FILE.before.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import math
import time
from pathlib import Path

import blind_points
import finer
import known_references
import numpy as np
import resumable
import tables
from scipy.stats import beta

import microslip
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named

REFERRED = {1e-2: 0.1, 1e-3: 0.1, 1e-4: 0.25}
"""Tolerance of the reference, over that of the point: by that, since 1e-5 is out of reach of most
rotations."""
AGAIN = 24
"""Points solved again where the sources have changed."""
COVERED = 0.999
"""Share of the claims that are to hold, and that `factor_for` is for."""
CONFIDENCE = 0.95
"""Of the bound on the share of those that do not."""
DOCS = Path(__file__).parents[1] / "docs/measured"
SOURCES = ("resolution", "periodicity", "solver", "model")
"""Of what is claimed, kept to see which is to blame."""
LONGEST = 4.0
"""Seconds for a reference by a tighter tolerance; what takes longer is decided by `finer.py`, which
takes about as long for a slow rotation at 1e-3."""
UNDECIDED = 200.0
"""Seconds for a reference by a tighter tolerance where `finer.py` has not decided either."""
EXACT = 1e-7
"""Uncertainty up to which a reference is a closed form, which no run could decide any better."""


def examine(seed: int, k: int, known: dict | None = None) -> dict:
    """One line of the output: the point, its certificate, the reference, which may be known."""
    point = blind_points.point(seed, k)
    given = {name: value for name, value in point.items() if name != "stratum"}
    begun = time.process_time()
    result = microslip.solve(**given)
    seconds = time.process_time() - begun

    def decides(known):
        off = abs(result.mu_macro - known["reference"])
        left = abs(off - result.mu_macro_error)
        return known["by"] and (left >= known["uncertainty"] or known["uncertainty"] <= EXACT)

    if known is None:
        known = tighter(given, LONGEST)
    if known["by"] != "finer" and not decides(known):
        pressure = pressure_named(point["pressure"])
        place = (point["velocity"], point["amplitude"], point["poisson"])
        problem = Problem(motion_named(point["motion"]), *place, pressure)
        mu, uncertainty = finer.reference(problem, point["tolerance"], result)
        known = {"reference": mu, "uncertainty": uncertainty, "by": "finer"}
        if not decides(known):
            other = tighter(given, UNDECIDED)
            known = other if other["by"] and other["uncertainty"] < uncertainty else known
    return {
        "k": k,
        **point,
        "mu": result.mu_macro,
        "error": result.mu_macro_error,
        "parts": [getattr(result, f"error_{source}") for source in SOURCES],
        "converged": result.converged,
        "seconds": round(seconds, 3),
        **{name: known[name] for name in known_references.FOUND},
    }


def tighter(given: dict, time_limit: float) -> dict:
    """What arguments of `microslip.solve` give at a tighter tolerance; by: empty if it failed."""
    tolerance = given["tolerance"] * REFERRED[given["tolerance"]]
    found = microslip.solve(**given | {"tolerance": tolerance}, time_limit=time_limit)
    by = "tighter" if found.converged else ""
    return {"reference": found.mu_macro, "uncertainty": found.mu_macro_error, "by": by}


def ratio(line: dict) -> float:
    """Error of a line over what was claimed of it."""
    off = abs(line["mu"] - line["reference"])
    return 0.0 if off == 0.0 else off / max(line["error"], 1e-12)


def failed(line: dict) -> bool:
    """Whether a claim was made that does not hold."""
    return line["converged"] and ratio(line) > 1.0


def factor_for(ratios: list[float], covered: float = COVERED) -> float:
    """The factor on claims with which one more point of the kind is covered with that probability
    (split conformal calibration); infinite where there are too few points to tell."""
    rank = math.ceil((len(ratios) + 1) * covered)
    return sorted(ratios)[rank - 1] if rank <= len(ratios) else math.inf


def summary(lines: list[dict]) -> str:
    """Markdown table of what was covered, by kind and tolerance, and what was not."""
    rows = []
    for tolerance in blind_points.TOLERANCES:
        at = [line for line in lines if line["tolerance"] == tolerance]
        for stratum in blind_points.STRATA:
            of = [line for line in at if line["stratum"] == stratum.name]
            rows += [_row(stratum.name, f"{tolerance:g}", of)] if of else []
        rows += [_row("all", f"{tolerance:g}", at)] if at else []
    rows.append(_row("all", "all", lines))
    claimed = [line for line in lines if line["converged"]]
    misses = [line for line in claimed if failed(line)]
    n, x = len(claimed), len(misses)
    bound = beta.ppf(CONFIDENCE, x + 1, n - x) if x < n else 1.0
    factor = factor_for([ratio(line) for line in claimed])
    calibrated = f"Claims times {factor:.2f} would cover {COVERED:.1%} of them."
    if math.isinf(factor):
        calibrated = f"They are too few to tell what would cover {COVERED:.1%} of them."
    text = [
        tables.markdown(rows),
        "",
        f"{n} claims, {x} of which do not hold: with {CONFIDENCE:.0%} confidence no more than"
        f" {bound:.2%} of such points fail. {calibrated}",
    ]
    for line in sorted(misses, key=ratio, reverse=True):
        text.append(
            f"\nDoes not hold: {_named(line)}: error {abs(line['mu'] - line['reference']):.1e}"
            f" (+- {line['uncertainty']:.0e}), claimed {line['error']:.1e}."
        )
    for line in lines:
        if not line["converged"]:
            text.append(f"\nNot converged, and says so: {_named(line)}.")
    return "\n".join(text) + "\n"


def _row(stratum, tolerance, lines):
    ratios = np.array([ratio(line) for line in lines if line["converged"]] or [0.0])
    off = [abs(ln["mu"] - ln["reference"]) / ln["tolerance"] for ln in lines if ln["converged"]]
    return {
        "points": stratum,
        "tolerance": tolerance,
        "number": len(lines),
        "converged": sum(line["converged"] for line in lines),
        "do not hold": sum(failed(line) for line in lines),
        "error / claim: median": f"{np.median(ratios):.2f}",
        "99 %": f"{np.quantile(ratios, 0.99):.2f}",
        "largest": f"{ratios.max():.2f}",
        "largest error / tolerance": f"{max(off, default=0.0):.2f}",
        "median seconds": f"{np.median([line['seconds'] for line in lines]):.2f}",
    }


def _named(line):
    return (
        f"{line['motion']} under {line['pressure']}, velocity {line['velocity']:g}, amplitude"
        f" {line['amplitude']:g}, nu {line['poisson']:g} at {line['tolerance']:g}"
    )


def refuse_changed(seed: int, lines: list[dict]) -> None:
    """End the run if lines that are there would not come out so again."""
    spread = np.linspace(0, len(lines) - 1, min(AGAIN, len(lines))).astype(int)
    for line in (lines[i] for i in spread):
        point = blind_points.point(seed, line["k"])
        found = microslip.solve(**{n: v for n, v in point.items() if n != "stratum"})
        if (found.mu_macro, found.mu_macro_error) != (line["mu"], line["error"]):
            raise SystemExit(f"{_named(line)} comes out otherwise now: see --again")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--first", type=int, default=0, help="of the points, by its number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, help="results/certificates-SEED.jsonl unless given")
    parser.add_argument("--again", action="store_true", help="solve anew, keep the references")
    parser.add_argument("--keep", action="store_true", help="add to the references in docs")
    tables.add_markdown(parser)
    options = parser.parse_args()
    output = options.output or Path(f"results/certificates-{options.seed}.jsonl")
    output.parent.mkdir(parents=True, exist_ok=True)
    lines = {line["k"]: line for line in tables.parsed(output)}
    kept = DOCS / f"references-{options.seed}.csv"
    references = known_references.read(kept, options.seed)
    if options.again:
        references, lines = {**references, **lines}, {}
        output.replace(output.with_name(output.name + ".before"))
    refuse_changed(options.seed, list(lines.values()))
    asked = range(options.first, options.points)
    resumable.add_lines(
        output,
        lines,
        asked,
        lambda k: (examine, options.seed, k, references.get(k)),
        options.workers,
    )
    if options.keep:
        known_references.write(kept, {**references, **lines}, options.seed)
    tables.publish(summary([lines[k] for k in asked]), options)


if __name__ == "__main__":
    main()
