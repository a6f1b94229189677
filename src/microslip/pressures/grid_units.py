"""Columns of pressure grids in files, and conversion of their units."""

from __future__ import annotations

COLUMNS = ("forward", "lateral", "pressure")
KINDS = {"forward": "[length]", "lateral": "[length]", "pressure": "[pressure]"}
EXAMPLES = {"forward": "mm", "lateral": "mm", "pressure": "MPa"}
MOST_POINTS = 1_000_000
LONGEST = 24
"""Largest number of characters of a unit."""


def factors(units: list[str | None]) -> list[float]:
    """Factors for each of COLUMNS that convert both coordinates to the same unit.

    The unit of the pressure is checked, but its factor is always 1.

    Parameters
    ----------
    units : list of str or None
        Unit of each column; None or "" if a column has no unit.

    Raises
    ------
    ValueError
        If a unit is unknown or of another kind, or if only one coordinate has a unit.
    """
    texts = [(text or "").strip() for text in units]
    if bool(texts[0]) != bool(texts[1]):
        with_unit = COLUMNS[0] if texts[0] else COLUMNS[1]
        raise ValueError(f"{with_unit} alone has a unit; allowed: one for both coordinates or none")
    along, across, _ = (_factor(name, text) for name, text in zip(COLUMNS, texts, strict=True))
    if (along is None) != (across is None):
        raise ValueError(
            f"forward [{texts[0]}] and lateral [{texts[1]}] are not the same kind; allowed: two "
            "lengths, or two numbers"
        )
    if along is None or across is None or texts[0] == texts[1]:
        return [1.0, 1.0, 1.0]
    return [1.0, across / along, 1.0]


def _factor(name: str, text: str) -> float | None:
    """Return the factor that converts a unit to SI units, or None if the column is
    dimensionless."""
    if text in ("", "1", "-"):
        return None
    import pint  # only here, because it takes a while to load

    unit, registry = None, pint.get_application_registry()
    if len(text) <= LONGEST:
        try:
            unit = registry.Quantity(1.0, registry.parse_units(text))
        except Exception:  # pint raises errors of many types
            unit = None
    if unit is None or not unit.check(KINDS[name]):
        kind = KINDS[name].strip("[]")
        raise ValueError(
            f"{name} [{text[:40]}] is no known unit of {kind}; allowed: one such as "
            f"[{EXAMPLES[name]}], or none"
        )
    return float(unit.to_base_units().magnitude)
