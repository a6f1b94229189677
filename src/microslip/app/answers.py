"""The answers of the commands, see the table in commands.py.

Each function imports what it needs when it is called, so that help and refusals are fast.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import product
from typing import TYPE_CHECKING, Any

from microslip.app.answer import Answer, csv_text
from microslip.app.parser import option, with_options
from microslip.app.progress import progress
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError, shown

if TYPE_CHECKING:
    from microslip.si.output import Prediction
    from microslip.si.table import Cases

MOST_COMPLAINTS = 10
"""Largest number of error messages about contacts without a prediction."""
MOST_LINES = 8
"""Largest number of lines in a figure."""


def point(motion: str, **arguments: Any) -> Answer:
    """Friction at one point, in dimensionless quantities."""
    import microslip

    with progress("microslip point") as step:

        def show(runs: Any) -> None:
            step(f"{runs.cells} cells, {runs.angles} angles, {runs.steps} steps")

        result = microslip.solve(motion, **arguments, progress=show)
    return Answer({"amplitude": None} | result.to_dict(), str(result), result.converged)


def point_motions() -> dict[str, str]:
    """Description of each motion of `point`, with the units of velocity and amplitude."""
    from dataclasses import fields

    from microslip.scene.by_name import MOTIONS

    texts = {}
    for name, one in MOTIONS.items():
        units = f"V = {one.velocity_label}" + f", A = {one.amplitude_label}" * one.periodic
        numbers = one.numbers or ", ".join(field.name for field in fields(one))
        more = f". Numbers follow the name after a colon: {numbers}" if fields(one) else ""
        texts[name] = f"{one.summary} ({units}){more}"
    texts["file:FILE"] = "one period of equally spaced rows: forward, lateral, angle, load"
    return texts | {"FILE.py": "a class of your own, as in mine/soft_square.py:share=0.5"}


def predict(
    motion: str,
    table: str | None = None,
    output: str | None = None,
    figure: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
    **arguments: Any,
) -> Answer:
    """Friction of a contact, of each contact in a table, or of each contact in a grid of ranges."""
    from microslip.foundation.named_files import speaks_of_file
    from microslip.si.predict import checked_inputs, predict_inputs
    from microslip.si.table import grid_of, is_range, read_cases

    ranges = {name: value for name, value in arguments.items() if is_range(name, value)}
    for name, value, fits, needed in (
        ("output", output, table or ranges, "--table or a range"),
        ("figure", figure, ranges, "a range"),
        ("decimal", decimal, table, "--table"),
        ("encoding", encoding, table, "--table"),
    ):
        if value is not None and not fits:
            raise InputError(name, value, f"allowed only with {needed}")
    if speaks_of_file(motion):
        from microslip.si.strokes import read_stroke

        if hint := read_stroke(motion).hint:
            complain(f"microslip predict: MOTION = {motion!r}: {hint}")
    if table is not None:
        if ranges:
            raise InputError(*next(iter(ranges.items())), "a range; allowed without --table")
        form = {"decimal": decimal or ".", "encoding": encoding or "utf-8"}
        return _predictions(read_cases(motion, table, arguments, **form), table)
    if ranges:
        cases = grid_of(motion, arguments)
        sizes = sorted(len(values) for _, _, values in cases.axes.values())
        if figure is not None and (len(sizes) > 2 or sizes[:-1] > [MOST_LINES]):
            allowed = "allowed with one range, or with a second one of at most"
            raise InputError("figure", figure, f"{allowed} {MOST_LINES} values")
        return _predictions(cases)
    inputs = checked_inputs(motion, **arguments)
    with progress("microslip predict"):
        one = predict_inputs(inputs)
    return Answer(one.to_dict(), str(one), one.converged)


def real_motions() -> dict[str, str]:
    """Description of each motion of `predict`."""
    from microslip.si.inputs import MOTIONS

    texts = {name: f"it {kind.description}" for name, kind in MOTIONS.items()}
    return texts | {"file:FILE": "it follows one period of samples with units"}


def _predictions(cases: Cases, table: str | None = None) -> Answer:
    """The predictions of many contacts.  Messages about those without one go to standard error.

    Raises InputError if no contact is valid.
    """
    from microslip.si.table import dataset_of, table_text

    columns = cases.columns if table is not None else ()  # not shown as options
    try:
        answers = _solved(cases)
    except InputError as error:
        if error.argument not in columns:
            raise
        raise InputError("table", table, _problem(error, cases, columns)) from None
    problems = {
        k: _problem(one, cases, columns)
        for k, one in enumerate(answers)
        if not hasattr(one, "values")
    }
    texts = [
        f"{cases.names[k]}: {text}" if isinstance(answers[k], InputError) else text
        for k, text in problems.items()
    ]
    more = len(texts) - MOST_COMPLAINTS
    for text in texts[:MOST_COMPLAINTS] + [f"{more} more without a prediction"] * (more > 0):
        complain(f"microslip predict: {text}")
    dataset = dataset_of(cases, [problems.get(k, one) for k, one in enumerate(answers)])
    if table is None:
        points = product(*(values for _, _, values in cases.axes.values()))
        places = [dict(zip(cases.axes, one, strict=True)) for one in points]
    else:
        starts = zip(*cases.starts.values(), strict=True)
        places = [dict(zip(cases.starts, one, strict=True)) for one in starts]
        about = {"long_name": "line of the file"}
        dataset = dataset.assign_coords(line=("case", cases.starts["line"], about))
    rows = [
        {**place, "error": problems.get(k), **({} if k in problems else one.to_dict()), **place}
        for k, (place, one) in enumerate(zip(places, answers, strict=True))
    ]
    return Answer(
        rows,
        table_text(cases, answers),
        all(getattr(one, "converged", False) for one in answers),
        csv=lambda: csv_text(dataset.to_dataframe().reset_index()),
        dataset=dataset,
        figure="curve",
    )


def _solved(cases: Cases, **options: Any) -> list[Any]:
    """The Prediction of each contact, or the reason why it has none."""
    from microslip.si.table import predictions

    answers = []
    with progress("contacts", len(cases.names)) as step:
        for one in predictions(cases, **options):
            answers.append(one)
            step("")
    return answers


def _problem(error: InputError | str, cases: Cases, columns: Collection[str] = ()) -> str:
    """Error message of a contact, with columns and options in place of Python arguments.

    For an empty cell or a missing column, the message contains no value.
    """
    from microslip.si.inputs import INPUTS

    if not isinstance(error, InputError):
        return with_options(error)
    name = error.argument if error.argument in columns else option(error.argument)
    source = getattr(cases.shared.get("map"), "encoding", {}).get("source")
    wrong = source if error.argument == "map" else error.value
    value = "" if wrong is None else f" = {shown(wrong)}"
    allowed = with_options(error.allowed, [one for one in INPUTS if one not in columns])
    return " ".join(f"{name}{value}: {allowed}".split())


def fit(
    motion: str,
    measured: str,
    output: str | None = None,
    figure: str | None = None,
    **arguments: Any,
) -> Answer:
    """Coefficient of friction and u_lim from measured friction."""
    import microslip

    with progress("microslip fit"):
        result = microslip.fit(motion, measured, **arguments)
    for text in result.left_out:
        complain(f"microslip fit: {with_options(text)}; left out")
    complete = len(result.told) == 2 and not result.left_out
    dataset = result.to_xarray() if output or figure else None
    return Answer(result.to_dict(), str(result), complete, dataset=dataset, figure="fit")


def response(path: str, output: str | None = None, **arguments: Any) -> Answer:
    """Forces of a contact along a path."""
    import microslip

    with progress("microslip response"):
        result = microslip.predict_response(path, **arguments)
    plain = {name: values.tolist() for name, (_, values) in result.columns.items()}
    plain |= result.attributes | {"converged": result.converged}
    dataset = result.to_xarray() if output else None
    return Answer(
        *(plain, str(result), result.converged),
        csv=lambda: csv_text(result.columns),
        dataset=dataset,
        is_table=True,
    )


def fold(
    record: str,
    output: str | None = None,
    rows: int = 32,
    frequency: str | None = None,
    **form: str,
) -> Answer:
    """One period of a motion from a record of many periods."""
    from microslip.foundation.number_text import number_text
    from microslip.si.fold import fold as fold_record
    from microslip.si.inputs import read_input
    from microslip.si.strokes import read_record

    if output is None:
        raise InputError("output", None, "needed: a .csv file for the period")
    hz = None if frequency is None else read_input("frequency", frequency).si
    time, columns, units = read_record(record, **form)
    try:
        result = fold_record(time, columns, frequency=hz, rows=rows)
    except InputError as error:
        if error.argument in ("rows", "frequency"):
            raise
        problem = str(error)
        if error.argument in units and isinstance(error.value, float):
            value = f"{error.value:.9g} {units[error.argument]}"
            problem = f"{error.argument} = {value}: {error.allowed}"
        raise InputError("record", record, problem) from None
    plain: dict[str, Any] = {
        "frequency_Hz": result.frequency,
        "frequency_error_Hz": result.frequency_error,
        "periods": result.periods,
        "columns": {},
        "output": output,
    }
    hertz = number_text(result.frequency, result.frequency_error, "Hz")
    lines = [f"frequency    {hertz}", f"periods      {result.periods}"]
    errors = []
    for name, unit in ((name, units[name]) for name in result.columns):
        size, drift = result.peak_to_peak(name), result.drift[name]
        scatter = float(result.errors[name].max())
        keys = ("unit", "peak_to_peak", "peak_to_peak_error", "sample_error", "drift_per_second")
        plain["columns"][name] = dict(zip(keys, (unit, *size, scatter, drift), strict=True))
        size_text = number_text(*size, unit)
        lines.append(f"{name:<12} {size_text} from peak to peak, drift {drift:.3g} {unit}/s")
        lines.append(f"{'':<12} standard error of a sample {scatter:.2g} {unit}")
        errors.append(f"{name} {scatter:.2g} {unit}")
    comment = f"mean of {result.periods} periods; standard error of a sample: {', '.join(errors)}"
    table = {n: (units[n], x) for n, x in {"time": result.time, **result.columns}.items()}
    lines.append(f"written to   {output}: the motion file:{output}")
    return Answer(plain, "\n".join(lines), True, csv=lambda: csv_text(table, [comment], digits=9))


def iwan(output: str | None = None, **arguments: Any) -> Answer:
    """Iwan model of a contact."""
    import microslip

    with progress("microslip export iwan"):
        model = microslip.predict_iwan(**arguments)
    comments = [
        "Iwan model: parallel springs (stiffness), each in series with a slider (limit_force)",
        "error of the force on a first loading and on loops between two displacements: "
        f"{model.error:.3g} N",
        f"error of the force on any path: {model.error_on_any_path:.3g} N",
    ]
    units = {"stiffness": "N/m", "limit_force": "N", "force_error": "N"}
    columns = {name: (unit, getattr(model, name)) for name, unit in units.items()}
    plain = {name: values.tolist() for name, (_, values) in columns.items()}
    plain |= {"error": model.error, "error_on_any_path": model.error_on_any_path}
    return _exported(plain, columns, comments)


def table(motion: str, output: str | None = None, **arguments: Any) -> Answer:
    """Friction over ranges of quantities."""
    from microslip.si.table import dataset_of, grid_of, interpolation_errors

    if "speed" not in arguments:
        raise InputError("speed", None, "needed")
    if "mass" in arguments and "drive_stiffness" not in arguments:
        raise InputError("mass", arguments["mass"], "allowed only with a drive_stiffness")
    grid = grid_of(motion, arguments)
    answers: list[Prediction] = _solved(grid, need_all=True)
    points = list(product(*(values for _, _, values in grid.axes.values())))
    for where, one in zip(grid.names, answers, strict=True):
        if not getattr(one, "converged", False):
            reason = _problem(one, grid) if isinstance(one, InputError) else one.reason
            complain(f"microslip export table: not converged at {where}: {reason}; no table")
            return Answer({"converged": False}, "", False)
    axes = zip(grid.axes.values(), zip(*points, strict=True), strict=True)
    columns: dict[str, tuple[str, Any]] = {name: (unit or "1", x) for (name, unit, _), x in axes}
    for name, unit in {"mu_apparent": "1", "friction_force": "N"}.items():
        values = [one.values[name] for one in answers]
        columns[name] = unit, [one.value for one in values]
        columns[f"{name}_error"] = unit, [one.error for one in values]
    axis_names = {key: name for key, (name, _, _) in grid.axes.items()}
    errors = interpolation_errors(dataset_of(grid, answers).mu_apparent.rename(axis_names))
    texts = [f"{'unknown' if x is None else f'{x:.2g}'} along {n}" for n, x in errors.items()]
    largest = [max(columns[f"{name}_error"][1]) for name in ("mu_apparent", "friction_force")]
    comments = [
        f"friction of a contact, motion {motion}, from microslip predict",
        f"largest errors of the values: {largest[0]:.2g} of mu_apparent, {largest[1]:.2g} N",
        "largest difference of mu_apparent from the linear interpolation of the neighbouring "
        f"values: {', '.join(texts)}",
    ]
    rows = zip(*(values for _, values in columns.values()), strict=True)
    return _exported([dict(zip(columns, row, strict=True)) for row in rows], columns, comments)


def _exported(plain: Any, columns: dict[str, tuple[str, Any]], comments: list[str]) -> Answer:
    """The answer for a table with comments, of which six digits are printed."""
    text = csv_text(columns, comments, digits=6).rstrip("\n")
    return Answer(plain, text, True, csv=lambda: csv_text(columns, comments), is_table=True)
