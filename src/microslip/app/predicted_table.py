"""What `microslip predict --table` asks and says: a contact for every line of a CSV file."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from pathlib import Path

from microslip.foundation.errors import InputError
from microslip.si.prediction import Prediction

ENDINGS = (".csv", ".nc")
SHOWN = {
    "mu_apparent": ("mu_apparent", 4),
    "mu_apparent_error": ("+-", 2),
    "friction_force_N": ("force N", 4),
    "speed_m_s": ("speed m/s", 4),
}
"""Fields in the printed table, their headings and digits."""
WIDTH = 13


def ask(
    scene: str, path: str, given: Mapping[str, object], columns: Collection[str]
) -> tuple[dict, list[Prediction]]:
    """The cases of a file and their predictions, with a line of progress; raises InputError.

    given: options by name that all cases share; columns: of predict's arguments.
    """
    from tqdm import tqdm

    from microslip.si.table import number_of, predictions
    from microslip.si.table_csv import cases_of_file

    cases = cases_of_file(path, [name for name in columns if name != "power"])
    count = number_of(cases, given)
    return cases, list(tqdm(predictions(scene, cases, given), "contacts", count, leave=False))


def refuse_output(path: str | None, table: str) -> None:
    """Raise InputError for an output that cannot be, before anything is computed; table: the file
    that is read."""
    if path is None:
        return
    file = Path(path)
    if file.suffix.lower() not in ENDINGS:
        allowed = f"allowed is a name that ends in {' or '.join(ENDINGS)}"
        raise InputError("output", path, allowed)
    if file.is_dir() or not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        raise InputError("output", path, "allowed is a file in a folder that can be written to")
    if file.resolve() == Path(table).resolve():
        raise InputError("output", path, "allowed is another file than the table that is read")


def write(path: str, scene: str, cases: Mapping[str, object], found: list[Prediction]) -> None:
    """All fields of all cases into a .csv or a .nc, whole or not at all."""
    from microslip.si.table import as_dataset
    from microslip.sweeps.sealed_files import writing_beside

    dataset = as_dataset(scene, cases, found)
    with writing_beside(Path(path)) as beside:
        if Path(path).suffix.lower() == ".csv":
            dataset.to_dataframe().to_csv(beside)
        else:
            dataset.to_netcdf(beside, engine="netcdf4")


def as_text(found: list[Prediction]) -> str:
    """A line for each case, and what is said against it below the table."""
    titles = ["case", *(title for title, _ in SHOWN.values())]
    lines = ["".join(f"{title:>{WIDTH}}" for title in titles)]
    remarks = []
    for case, one in enumerate(found):
        numbers = [f"{getattr(one, name):>{WIDTH}.{n}g}" for name, (_, n) in SHOWN.items()]
        lines.append(f"{case:>{WIDTH}}{''.join(numbers)}")
        if not one.converged:
            remarks.append(f"case {case}: NOT CONVERGED: {one.reason}")
        remarks += [f"case {case}: warning: {text}" for text in one.warnings]
    return "\n".join(lines + remarks)
