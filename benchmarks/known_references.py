"""Read and write a table of references for random points.

A reference is far more expensive than the result that it judges, and does not depend on the error
estimate. Therefore the references in `docs/measured/references-SEED.csv` can also judge later
versions of this package, and other codes for the same contact. A row contains all arguments of its
point.
"""

from __future__ import annotations

import csv

import blind_points

COLUMNS = (
    *("motion", "pressure", "poisson", "velocity", "amplitude", "tolerance"),
    *("force", "stiffness", "mass", "contacts"),
)
"""Possible arguments of a point."""
REFERENCE = ("reference", "uncertainty", "by")
"""Friction (or velocity under a force), its uncertainty, and the method of the reference."""
ENERGY = ("energy_reference", "energy_uncertainty")
"""Energy dissipated in a period, and its uncertainty, for a part of the points."""
DIGITS = dict.fromkeys(("reference", ENERGY[0]), ".12f")
DIGITS |= dict.fromkeys(("uncertainty", ENERGY[1]), ".2e")


def read(path, seed: int) -> dict[int, dict]:
    """Return references keyed by point number. End the run if a row belongs to another point."""
    references = {}
    if not path.exists():
        return references
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            k = int(row["k"])
            point = blind_points.point(seed, k)
            if any(row.get(name, "") != str(point.get(name, "")) for name in COLUMNS):
                raise SystemExit(f"{path}: point {k} is not that of seed {seed}: {row}")
            names = [name for name in (*REFERENCE[:2], *ENERGY) if row.get(name)]
            numbers = {name: float(row[name]) for name in names}
            references[k] = {**numbers, "by": row["by"]}
    return references


def write(path, references: dict[int, dict], seed: int) -> None:
    """Write references whose uncertainty is at most the tolerance, in the order of the points."""
    points = {k: blind_points.point(seed, k) for k in sorted(references)}
    columns = [name for name in COLUMNS if any(name in point for point in points.values())]
    energies = ENERGY if any(ENERGY[0] in one for one in references.values()) else ()
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("k", *columns, *REFERENCE, *energies))
        for k, point in points.items():
            if not references[k]["by"] or not _is_certain(references[k], point):
                continue
            values = (
                format(references[k][name], DIGITS.get(name, "")) if name in references[k] else ""
                for name in (*REFERENCE, *energies)
            )
            rows.writerow((k, *(point.get(name, "") for name in columns), *values))


def _is_certain(reference, point):
    size = max(1.0, abs(reference["reference"])) if "force" in point else 1.0
    return reference["uncertainty"] <= point["tolerance"] * size
