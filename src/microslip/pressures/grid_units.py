"""Columns and units of pressure grids in files."""

from __future__ import annotations

COLUMNS = ("forward", "lateral", "pressure")
KINDS = {"forward": "[length]", "lateral": "[length]", "pressure": "[pressure]"}
EXAMPLES = {"forward": "mm", "lateral": "mm", "pressure": "MPa"}
MOST_POINTS = 1_000_000
LONGEST = 24
"""Largest number of characters of a unit."""


def factors(units: list[str | None]) -> list[float]:
    """Factors on each of COLUMNS that bring both coordinates to the same unit.

    The unit of the pressure does not matter, but it must exist.

    Parameters
    ----------
    units : list of str or None
        Unit of each column as text; None or "" where none was given.

    Raises
    ------
    ValueError
        For an unknown unit, one of another kind, or a unit for one coordinate alone.
    """
    given = [(text or "").strip() for text in units]
    if bool(given[0]) != bool(given[1]):
        with_unit = COLUMNS[0] if given[0] else COLUMNS[1]
        raise ValueError(f"{with_unit} alone has a unit; allowed: one for both coordinates or none")
    along, across, _ = (_factor(name, text) for name, text in zip(COLUMNS, given, strict=True))
    if (along is None) != (across is None):
        raise ValueError(
            f"forward [{given[0]}] and lateral [{given[1]}] are not the same kind; allowed: two "
            "lengths, or two numbers"
        )
    if along is None or across is None or given[0] == given[1]:
        return [1.0, 1.0, 1.0]
    return [1.0, across / along, 1.0]


def _factor(name: str, text: str) -> float | None:
    """Unit in SI units; None for a number without one."""
    if text in ("", "1", "-"):
        return None
    import pint  # only here: it takes a while to load

    unit, registry = None, pint.get_application_registry()
    if len(text) <= LONGEST:
        try:
            unit = registry.Quantity(1.0, registry.parse_units(text))
        except Exception:  # pint has many kinds, and its parser those of Python
            unit = None
    if unit is None or not unit.check(KINDS[name]):
        kind = KINDS[name].strip("[]")
        raise ValueError(
            f"{name} [{text[:40]}] is no known unit of {kind}; allowed: one such as "
            f"[{EXAMPLES[name]}], or none"
        )
    return float(unit.to_base_units().magnitude)
