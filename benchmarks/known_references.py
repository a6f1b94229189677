"""References of the random points that are known: what judges a claim, kept apart from the claims.

A reference costs far more than what it judges and does not depend on how estimates are made, so
that those of `docs/measured/references-SEED.csv` serve every later state of the sources, and
whoever has another code for the same contact.  A row says which point it is of in full.
"""

from __future__ import annotations

import csv

import blind_points

DRAWN = ("motion", "pressure", "poisson", "velocity", "amplitude", "tolerance")
"""Columns that say which point it is: what `blind_points.point` has drawn."""
FOUND = ("reference", "uncertainty", "by")
"""Columns of what is known of it: mu_macro, what that may be off by, and what it was found by."""
DIGITS = {"reference": ".12f", "uncertainty": ".2e"}


def read(path, seed: int) -> dict[int, dict]:
    """What is known of each point, by its number; a row of another point ends the run."""
    found = {}
    if not path.exists():
        return found
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            k = int(row["k"])
            point = blind_points.point(seed, k)
            if any(row[name] != str(point[name]) for name in DRAWN):
                raise SystemExit(f"{path}: point {k} is not that of seed {seed}: {row}")
            numbers = {name: float(row[name]) for name in FOUND[:2]}
            found[k] = {**numbers, "by": row["by"]}
    return found


def write(path, known: dict[int, dict], seed: int) -> None:
    """All that is known, in the order of the points, but what is less certain than its claim."""
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("k", *DRAWN, *FOUND))
        for k in sorted(known):
            point = blind_points.point(seed, k)
            if known[k]["uncertainty"] > point["tolerance"]:
                continue
            values = (format(known[k][name], DIGITS.get(name, "")) for name in FOUND)
            rows.writerow((k, *(point[name] for name in DRAWN), *values))
