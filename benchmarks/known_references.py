"""References of the random points: values that judge error estimates, kept apart from them.

A reference costs far more than the result that it judges, and does not depend on how estimates are
made.  So the references in `docs/measured/references-SEED.csv` serve every later state of the
sources, and other codes for the same contact.  A row holds its point in full.
"""

from __future__ import annotations

import csv

import blind_points

COLUMNS = (
    *("motion", "pressure", "poisson", "velocity", "amplitude", "tolerance"),
    *("force", "stiffness", "mass", "contacts"),
)
"""Arguments of `microslip.solve` that a point may have."""
REFERENCE = ("reference", "uncertainty", "by")
"""The friction, or the velocity under a force, its uncertainty, and the method that gave it."""
DIGITS = {"reference": ".12f", "uncertainty": ".2e"}


def read(path, seed: int) -> dict[int, dict]:
    """Reference of each point, by its number; a row of another point ends the run."""
    references = {}
    if not path.exists():
        return references
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            k = int(row["k"])
            point = blind_points.point(seed, k)
            if any(row.get(name, "") != str(point.get(name, "")) for name in COLUMNS):
                raise SystemExit(f"{path}: point {k} is not that of seed {seed}: {row}")
            numbers = {name: float(row[name]) for name in REFERENCE[:2]}
            references[k] = {**numbers, "by": row["by"]}
    return references


def write(path, references: dict[int, dict], seed: int) -> None:
    """Write references in the order of the points, except those less certain than a tolerance."""
    points = {k: blind_points.point(seed, k) for k in sorted(references)}
    columns = [name for name in COLUMNS if any(name in point for point in points.values())]
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("k", *columns, *REFERENCE))
        for k, point in points.items():
            if not references[k]["by"] or not _is_certain(references[k], point):
                continue
            values = (format(references[k][name], DIGITS.get(name, "")) for name in REFERENCE)
            rows.writerow((k, *(point.get(name, "") for name in columns), *values))


def _is_certain(reference, point):
    size = max(1.0, abs(reference["reference"])) if "force" in point else 1.0
    return reference["uncertainty"] <= point["tolerance"] * size
