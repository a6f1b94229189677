"""Measured friction as CSV: one measurement a line, under a heading with names and units.

speed [mm/s],amplitude [um],friction [N]
1,0.5,1.93
"""

from __future__ import annotations

from microslip.foundation import csv_text
from microslip.foundation.errors import InputError
from microslip.si.quantities import read

COLUMNS = {
    "speed": "m/s",
    "amplitude": "m",
    "frequency": "Hz",
    "load": "N",
    "friction": "N",
    "friction_error": "N",
    "mu": "",
    "mu_error": "",
}
"""Columns that a table may have, and their units in the SI; the amplitude of a bore is in rad."""
MOST_ROWS = 10_000


def read_table(content: bytes, unit_of_amplitude: str) -> dict[str, list[float]]:
    """Columns of a table in the SI, by their names.

    Columns are parted by commas, semicolons or tabs.  Lines that are empty or begin with # do not
    count.

    Parameters
    ----------
    content : bytes
        The file.
    unit_of_amplitude : str
        "m" or "rad".

    Raises
    ------
    ValueError
        For anything else; the message begins with the line.
    """
    lines = csv_text.lines(content)
    where, heading = next(lines, (1, ""))
    separator, names, units = _columns(where, heading)
    table = {name: [] for name in names}
    thousands = csv_text.Thousands(separator, names)
    for where, line in lines:
        cells = csv_text.row(where, line, separator, range(len(names)))
        if "" in cells:
            allowed = "allowed: a number in every row; leave out the row, or fill the cell"
            raise ValueError(f"line {where}: {names[cells.index('')]} is empty; {allowed}")
        for name, unit, cell in zip(names, units, cells, strict=True):
            wanted = unit_of_amplitude if name == "amplitude" else COLUMNS[name]
            table[name].append(_value(where, name, f"{cell} {unit}".strip(), wanted))
        thousands.see(where, cells)
        if len(table[names[0]]) > MOST_ROWS:
            raise ValueError(f"line {where}: more than {MOST_ROWS} rows; allowed: at most that")
    thousands.refuse()
    return table


def _columns(where, heading):
    """Separator, names and units of the columns."""
    allowed = f"allowed: some of {', '.join(COLUMNS)}, each with its unit, as in speed [mm/s]"
    separator, columns = csv_text.columns(where, heading, COLUMNS, allowed)
    for name, unit in columns:
        if COLUMNS[name] and not unit:
            raise ValueError(f"line {where}: {name} has no unit; {allowed}")
    names, units = zip(*((name, unit or "") for name, unit in columns), strict=True)
    return separator, list(names), ["" if unit in csv_text.PURE else unit for unit in units]


def _value(where, name, text, unit):
    low = -float("inf") if name in ("friction", "mu") else 0.0
    open_below = name not in ("speed", "amplitude", "friction", "mu")
    try:
        return read(name, text, unit, low=low, low_open=open_below).si
    except InputError as error:
        raise ValueError(f"line {where}: {error}") from None
