"""Columns of pressure grids in files, and conversion of their units."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from microslip.foundation.csv_table import PURE
from microslip.foundation.units import read

COLUMNS = ("forward", "lateral", "pressure")
KINDS = {"forward": ("length", "m"), "lateral": ("length", "m"), "pressure": ("pressure", "Pa")}
"""Kind and SI unit of each column."""
EXAMPLES = {"forward": "mm", "lateral": "mm", "pressure": "MPa"}
MOST_POINTS = 1_000_000
PITCH = re.compile(r"(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+)\s*(.*)", re.A)
"""Pattern of a number with or without a unit."""
ALLOWED_PITCH = "allowed: a length such as 0.5 mm, or forward x lateral as in 0.5 mm x 0.6 mm"


Units = tuple[float | None, float | None]
"""Unit of the coordinates in m, and unit of the pressure in Pa; None for dimensionless values."""
NO_UNITS: Units = None, None


def read_units(units: Sequence[str | None]) -> tuple[float, Units]:
    """Return the ratio of the lateral to the forward unit of length, and the Units.

    Parameters
    ----------
    units : sequence of str or None
        Unit of each of COLUMNS; None or "" if a column has no unit.

    Raises
    ------
    ValueError
        If a unit is unknown or is not a length or a pressure, or if only one coordinate has a unit.
    """
    texts = [(text or "").strip() for text in units]
    if bool(texts[0]) != bool(texts[1]):
        with_unit = COLUMNS[0] if texts[0] else COLUMNS[1]
        raise ValueError(f"{with_unit} alone has a unit; allowed: one for both coordinates or none")
    along, across, size = (_factor(name, text) for name, text in zip(COLUMNS, texts, strict=True))
    if (along is None) != (across is None):
        raise ValueError(
            f"forward [{texts[0]}] and lateral [{texts[1]}] are not the same kind; allowed: two "
            "lengths, or two numbers"
        )
    if along is None or across is None or texts[0] == texts[1]:
        return 1.0, (along, size)
    return across / along, (along, size)


def read_pitch(text: str) -> tuple[float, float, Units]:
    """Return the forward and the lateral distance between matrix cells, both in the same unit, and
    the Units.

    text: a length such as "0.5 mm" for both distances, or "0.5 mm x 0.6 mm".

    Raises ValueError if the text has another form, or if a distance is not above 0.
    """
    matches = [PITCH.fullmatch(part.strip()) for part in text.split(" x ")]
    lengths = [(float(one[1]), one[2]) for one in matches if one]
    if not len(lengths) == len(matches) <= 2 or not all(0.0 < one < math.inf for one, _ in lengths):
        raise ValueError(f"pitch is {text[:40]!r}; {ALLOWED_PITCH}")
    (forward, unit), (lateral, other) = lengths[0], lengths[-1]
    ratio, units = read_units([unit, other, None])
    return forward, lateral * ratio, units


def _factor(name: str, text: str) -> float | None:
    """Return the factor that converts a unit to SI units, or None if the column is
    dimensionless."""
    if text in PURE:
        return None
    kind, si = KINDS[name]
    try:
        return float(read(f"1 {text}", si).si)
    except ValueError:
        raise ValueError(
            f"{name} [{text[:40]}] is no known unit of {kind}; allowed: one such as "
            f"[{EXAMPLES[name]}], or none"
        ) from None
