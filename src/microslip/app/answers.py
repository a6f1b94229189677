"""Functions that compute the answers of the commands; see the table in commands.py.

Each function imports other modules only when it is called, so that help texts and error messages
appear fast.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import product
from typing import TYPE_CHECKING, Any

from microslip.app.answer import Answer, csv_text
from microslip.app.parser import message, option, with_options
from microslip.app.progress import progress
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError

if TYPE_CHECKING:
    from microslip.si.output import Prediction
    from microslip.si.table import Cases

MOST_COMPLAINTS = 10
"""Largest number of error messages about contacts without a prediction."""
MOST_LINES = 8
"""Largest number of curves in a figure."""
NEEDS = {"output": "--table or a range", "figure": "a range"}
NEEDS |= dict.fromkeys(("decimal", "encoding"), "--table")
"""Options of `predict` that are allowed only with another option."""
FRICTION = ["mu_apparent", "mu_apparent_error", "friction_force_N", "friction_force_error_N"]
"""Columns of a table of friction.  The table also has one column for each axis."""


def point(motion: str, **arguments: Any) -> Answer:
    """Compute macroscopic friction for one velocity and amplitude, in dimensionless quantities.

    The result is mu_macro, the mean forward friction force divided by mu F_z, with an error
    estimate.  This ratio is 1 if the vibration has no effect, and 0 if no friction remains.  The
    apparent coefficient of friction is mu_apparent = mu mu_macro.  F_z is the load without
    oscillation (the reference load), and u_lim is the tangential displacement at which the whole
    contact slides.  Here, a is the contact radius, and phi_lk(a/2) is the angle at which the stick
    radius is a/2.  Bore means spin: rotation about the contact normal.
    """
    import microslip

    with progress("microslip point") as step:

        def show(runs: Any) -> None:
            step(f"{runs.cells} cells, {runs.angles} angles, {runs.steps} steps")

        result = microslip.solve(motion, **arguments, progress=show)
    return Answer({"amplitude": None} | result.to_dict(), str(result), result.converged)


def point_motions() -> dict[str, str]:
    """Return the description of each motion that `point` accepts, with the units of velocity and
    amplitude."""
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


def predict(motion: str, table: str | None = None, **arguments: Any) -> Answer:
    """Predict the friction of a real contact in SI units.

    The command can also predict many contacts: the rows of a table, or the values of a range.

    The result has error estimates, and warnings if the theory does not apply.  Every quantity has a
    unit.  mu_macro is the mean forward force divided by mu times the mean load.  mu_apparent is the
    coefficient of friction with vibration.  If a quantity has a standard
    uncertainty, such as '0.15 +- 0.05' or '10 N +- 5 %', the result contains intervals and, under a
    force, the probability of each outcome.  A quantity can be a range: '0..2 um' gives 11 equally
    spaced values, '0..2 um, 21' gives 21, and '0.1..10 mm/s, 21, log' gives 21 logarithmically
    spaced values.  The result for a range is a table.  If the normal load oscillates, there are two
    reference loads.  The reference load of the dimensionless stiffness, mass and damping is the
    load without oscillation.  The reference load of the dimensionless force and of mu_macro is the
    mean load.
    """
    from microslip.si.inputs import is_range, read_inputs

    files = {name: arguments.pop(name) for name in NEEDS if name in arguments}
    ranges = [name for name, value in arguments.items() if is_range(name, value)]
    source = "--table" if table is not None else "a range" if ranges else "nothing"
    for name, value in files.items():
        if source not in NEEDS[name]:
            raise InputError(name, value, f"allowed only with {NEEDS[name]}")
    if motion.startswith("file:"):
        from microslip.si.strokes import read_stroke

        if hint := read_stroke(motion).hint:
            complain(f"microslip predict: MOTION = {motion!r}: {hint}")
    if table is not None:
        if ranges:
            raise InputError(ranges[0], arguments[ranges[0]], "a range; allowed without --table")
        from microslip.si.table import read_cases

        form = {name: files[name] for name in ("decimal", "encoding") if name in files}
        return _predictions(read_cases(motion, table, arguments, **form), table)
    if ranges:
        from microslip.si.table import grid_of

        cases = grid_of(motion, arguments)
        sizes = sorted(len(values) for _, _, values in cases.axes.values())
        if "figure" in files and (len(sizes) > 2 or sizes[:-1] > [MOST_LINES]):
            allowed = f"one range, or with a second one of at most {MOST_LINES} values"
            raise InputError("figure", files["figure"], f"allowed with {allowed}")
        return _predictions(cases)
    read_inputs(motion, **arguments)  # refuses most invalid input before the solver is imported
    from microslip.si.predict import checked_contact, predict_contact

    contact = checked_contact(motion, **arguments)
    with progress("microslip predict"):
        one = predict_contact(contact)
    return Answer(one.to_dict(), str(one), one.converged)


def real_motions() -> dict[str, str]:
    """Return the description of each motion that `predict` accepts."""
    from microslip.si.inputs import MOTIONS

    texts = {name: f"it {kind.description}" for name, kind in MOTIONS.items()}
    return texts | {"file:FILE": "it follows one period of samples with units"}


def _predictions(cases: Cases, table: str | None = None) -> Answer:
    """Return the answer with the predictions of many contacts.  Messages about contacts without a
    prediction go to standard error.

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
    shown = [one if hasattr(one, "values") else _problem(one, cases, columns) for one in answers]
    texts = [
        f"{name}: {text}" if isinstance(one, InputError) else text
        for name, one, text in zip(cases.names, answers, shown, strict=True)
        if isinstance(text, str)
    ]
    more = len(texts) - MOST_COMPLAINTS
    for text in texts[:MOST_COMPLAINTS] + [f"{more} more without a prediction"] * (more > 0):
        complain(f"microslip predict: {text}")
    dataset = dataset_of(cases, shown)
    if table is None:
        places = list(product(*(values for _, _, values in cases.axes.values())))
    else:
        places = list(zip(*cases.starts.values(), strict=True))
        about = {"long_name": "line of the file"}
        dataset = dataset.assign_coords(line=("case", cases.starts["line"], about))
    rows = []
    for values, one in zip(places, shown, strict=True):
        place = dict(zip(cases.axes or cases.starts, values, strict=True))
        plain = {"error": one} if isinstance(one, str) else {"error": None, **one.to_dict()}
        rows.append(place | plain | place)
    return Answer(
        *(rows, table_text(cases, answers)),
        all(getattr(one, "converged", False) for one in answers),
        csv=lambda: csv_text(dataset.to_dataframe().reset_index()),
        dataset=lambda: dataset,
        figure="curve",
    )


def _solved(cases: Cases, **options: Any) -> list[Any]:
    """Return the Prediction for each contact, or the reason why there is no prediction."""
    from microslip.si.table import predictions

    answers = []
    with progress("contacts", len(cases.names)) as step:
        for one in predictions(cases, **options):
            answers.append(one)
            step("")
    return answers


def _problem(error: InputError | str, cases: Cases, columns: Collection[str] = ()) -> str:
    """Return the error message about a contact, with columns and options in place of Python
    arguments.

    For an empty cell or a missing column, the message contains no value.
    """
    from microslip.si.inputs import INPUTS

    if not isinstance(error, InputError):
        return with_options(error)
    name = error.argument if error.argument in columns else option(error.argument)
    source = getattr(cases.shared.get("map"), "encoding", {}).get("source")
    value = source if error.argument == "map" else error.value
    return message(name, value, error.allowed, [one for one in INPUTS if one not in columns])


def fit(
    motion: str, measured: str, output: object = None, figure: object = None, **arguments: Any
) -> Answer:
    """Fit the coefficient of friction and u_lim to measured friction.

    The result contains the coefficient of friction without vibration, and either the shear modulus
    or the displacement u_lim at which the whole contact slides.  Each row of the CSV file is a
    measurement of friction under vibration.  The heading names the columns and their units.  One
    column contains the measured values.  The heading of this column is `friction [N]` or `mu`.  The
    other columns are `speed [mm/s]`, `amplitude [um]`, `frequency [kHz]` and `load [N]`.  If one of
    these four columns is missing, an option can give its value for all rows.  A column with
    standard errors is optional.  Its heading is `friction_error [N]` or `mu_error`.  Exit codes: 0
    if both parameters are determined; 1 if only mu is determined, or if unreadable lines are left
    out; 2 for bad input, or if neither parameter is determined.
    """
    import microslip

    with progress("microslip fit"):
        result = microslip.fit(motion, measured, **arguments)
    for text in result.left_out:
        complain(f"microslip fit: {with_options(text)}; left out")
    complete = not (result.reason or result.left_out)
    values = result.to_dict()
    return Answer(values, str(result), complete, dataset=result.to_xarray, figure="fit")


def response(path: str, output: str | None = None, **arguments: Any) -> Answer:
    """Compute the forces of a contact that follows a path from a file.

    The result contains forces, torque, dissipated energy and stick fraction, with error estimates.
    The file can have the columns `forward`, `lateral` and `angle`.  The file can also have one of
    the columns `load` and `indentation`.  Each heading contains the unit, as in `forward [um]`.
    `load` is the load of the reference state.
    """
    import microslip

    with progress("microslip response"):
        result = microslip.predict_response(path, **arguments)
    plain = {name: values.tolist() for name, (_, values) in result.columns.items()}
    plain |= result.attributes | {"converged": result.converged}
    return Answer(
        *(plain, str(result), result.converged),
        csv=lambda: csv_text(result.columns),
        dataset=result.to_xarray,
        is_table=True,
    )


def fold(record: str, output: str = "", rows: int = 32, **arguments: str) -> Answer:
    """Average a long record of a motion, such as one measured by a vibrometer, to one period.

    The slow drift is removed, and the periods are averaged.  The standard error accounts for the
    scatter between the periods and for a slow drift of the frequency.  The record must have the
    column `time`.  The record can have the columns `forward`, `lateral` and `angle`, and one of the
    columns `load` and `indentation`.  Each heading contains the unit, as in
    `time [s],lateral [um]`.
    """
    from microslip.foundation.number_text import number_text
    from microslip.si.fold import fold as fold_record
    from microslip.si.inputs import read_input
    from microslip.si.strokes import read_record

    if not output:
        raise InputError("output", None, "needed: a .csv file for the period")
    frequency = arguments.pop("frequency", None)
    hz = None if frequency is None else read_input("frequency", frequency).si
    time, columns, units = read_record(record, **arguments)
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
    plain: dict[str, Any] = {"periods": result.periods, "columns": {}, "output": output}
    plain |= {"frequency_Hz": result.frequency, "frequency_error_Hz": result.frequency_error}
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
    """Export an Iwan model of a contact: parallel springs with sliders.

    The model describes a contact that moves along a line.  The model consists of parallel Jenkins
    elements.  Each element is a spring in series with a slider.  The table contains the stiffness
    and the limit force of each element.  If nu = 0, the model with many elements is exact for every
    load path.  If nu > 0, the model is compared with the full contact, and the difference is part
    of the error.
    """
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
    """Export a table of friction over speed, amplitude, load or other quantities.

    At least one quantity is given as a range: --speed '0.1..10 mm/s, 21, log' gives 21
    logarithmically spaced values, and '0..2 um' gives 11 equally spaced values.
    """
    from microslip.si.table import dataset_of, grid_of, interpolation_errors

    grid = grid_of(motion, arguments)
    answers: list[Prediction] = _solved(grid, need_all=True)
    for where, one in zip(grid.names, answers, strict=True):
        if not getattr(one, "converged", False):
            reason = _problem(one, grid) if isinstance(one, InputError) else one.reason
            complain(f"microslip export table: not converged at {where}: {reason}; no table")
            return Answer({"converged": False}, "", False)
    dataset = dataset_of(grid, answers)[FRICTION]
    frame = dataset.to_dataframe().reset_index()
    axis_names = {key: name for key, (name, _, _) in grid.axes.items()}
    errors = interpolation_errors(dataset.mu_apparent.rename(axis_names))
    texts = [f"{'unknown' if x is None else f'{x:.2g}'} along {n}" for n, x in errors.items()]
    largest = frame.mu_apparent_error.max(), frame.friction_force_error_N.max()
    comments = [
        f"friction of a contact, motion {motion}, from microslip predict",
        f"largest errors of the values: {largest[0]:.2g} of mu_apparent, {largest[1]:.2g} N",
        "largest difference of mu_apparent from the linear interpolation of the neighbouring "
        f"values: {', '.join(texts)}",
    ]
    return _exported(frame.to_dict("records"), frame, comments)


def _exported(plain: Any, columns: Any, comments: list[str]) -> Answer:
    """Return an answer that consists of comments and a table.  Numbers are printed with six
    digits."""
    text = csv_text(columns, comments, digits=6).rstrip("\n")
    return Answer(plain, text, True, csv=lambda: csv_text(columns, comments), is_table=True)
