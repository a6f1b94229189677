"""Fit mu, and either u_lim or the shear modulus, to friction measured under vibration.

The model is: measured value = mu * weight * mu_macro + error.  The weight is the load if friction
forces were measured, and 1 if coefficients of friction were measured.  In each row of the table,
the ratio of velocity to amplitude does not depend on u_lim.  The only unknown on which mu_macro
depends is therefore ln u_lim.  Since the model is linear in mu, the best mu for a given u_lim
follows by linear least squares.

The confidence region contains the pairs (u_lim, mu) for which the sum of squared residuals is at
most a threshold. The threshold is the smallest sum of squares plus a margin.  If the rows have
standard errors, the margin is a quantile of the chi-square distribution.  Otherwise, the margin is
a quantile of the F distribution times the mean square residual.  For each u_lim, the region is an
interval of mu, because the sum of squares is quadratic in mu.  The interval of a parameter is the
range of the parameter's values in the confidence region, as in a profile likelihood.  This interval
does not depend on the parametrisation, and may be infinite on one side.

If no map is given, the solver first computes a coarse map.  The coarse map is used only to compute
how friction changes between two guesses of u_lim.  Then the solver computes the friction of every
row at the best guess of u_lim, and the coarse map is corrected to agree with these values.  Guess
and correction are repeated.  At the end, the remaining error due to the coarse map is of second
order.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy  # loads its modules on first use, so that invalid input is refused fast

from microslip.answer.point import solve
from microslip.foundation.arguments import LARGEST
from microslip.foundation.csv_table import LABELS, source_name, table_of
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import prefixed, prefixed_text
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, Input, read_input, read_inputs, read_quantity
from microslip.si.output import column, line
from microslip.si.solve import FrictionMap
from microslip.si.warnings import broken_rules, warnings_of

if TYPE_CHECKING:
    import xarray as xr

Rows = dict[str, np.ndarray]
"""Arrays of shape (n,) for the n rows, keyed by name: the conditions (see KEYS), the measured
values and their errors."""
Friction = Callable[..., np.ndarray]
"""friction(velocity, amplitude, rough=False) returns mu_macro and its error estimate as an array of
shape (2, n).  If `rough` is true, the arguments can have any shape.  The first item of the result
is then an approximation of mu_macro.  The error of this approximation is nearly the same at all
points."""

MOTIONS = ("transverse", "longitudinal", "zigzag")
CONDITIONS = ("speed", "amplitude", "load", "frequency")
KEYS = ("speed_m_s", "amplitude_si", "row_load_N", "frequency_Hz")
"""Names of the conditions in the rows of a Fit."""
COLUMNS = {name: INPUTS[name]._replace(exact=True) for name in CONDITIONS}
for _name, _unit in (("friction", "N"), ("mu", "")):
    COLUMNS[_name] = Input("", _unit, "", -math.inf, exact=True)
    COLUMNS[f"{_name}_error"] = Input("", _unit, "", exact=True)
UNITS = {name: one.unit or "" for name, one in COLUMNS.items()}
"""SI unit of each allowed column, keyed by name."""
PARAMETERS = {"mu": "", "u_lim": "m", "shear_modulus": "Pa"}
"""SI unit of each fitted parameter."""
LISTS = "understood", "warnings", "left_out"
"""Fields of a Fit with several strings, which are joined to one string in a dataset."""
PARTS = "value", "low", "high"
OPEN = "open"
"""Text that is printed instead of a bound that the rows do not determine."""
MORE_ROWS = "add rows without vibration, or rows where vibration reduces friction more"
EMPTY = "empty; allowed: a number in every row; leave out the row, or fill the cell"
MOST_ROWS, MOST_SOLVED = 10_000, 200
"""Largest number of rows of a fit.  The first value applies if friction is interpolated in a map.
The second value applies if the solver computes the friction of every row."""
TOLERANCE, CONFIDENCE = 1e-3, 0.95
TOLERANCES = INPUTS["tolerance"]._replace(high=0.02)
CONFIDENCES = Input("", "", "", high=0.999999, exact=True)
"""Allowed tolerances and confidence levels."""
LEAST, MOST = 0.03, 20.0
"""Smallest and largest dimensionless amplitude that a fit resolves.  At smaller amplitudes, nearly
the whole contact sticks.  At larger amplitudes, nearly the whole contact slides all the time."""
SLOWEST, FASTEST = 1e-3, 20.0
"""Smallest and largest ratio of velocity to amplitude in the coarse map."""
SIZES, RATIOS = 16, 4
"""Number of amplitudes in the coarse map, and number of ratios per decade."""
COARSE = {"poisson": 0.0, "tolerance": 5e-3}
"""Settings of the coarse map.  Poisson's ratio is set to 0, because Poisson's ratio hardly changes
the slopes of the map."""
NODES = 161
"""Number of values of ln u_lim for which the friction of each row is tabulated."""
MOST_PASSES, SETTLED = 6, 5e-4
"""MOST_PASSES: largest number of corrections of the coarse map.  SETTLED: no further correction is
made if the relative change of both unknowns is below this value."""
SMALLEST_MU = 1e-5
"""Smallest mu of a fit.  A smaller mu is due to wrong units."""
WIDEST_MU = 2.0
"""Largest allowed ratio of the upper to the lower bound of the interval for mu."""
UNLIKELY = 0.01
"""A warning is given if the probability (p-value) of the sum of squares is below this value."""
REGION = 801
"""Number of values of ln u_lim at which the confidence region is computed."""
PIECES = 60
"""Each curve of the figure has this number of linearly spaced points, and the same number of
logarithmically spaced points."""
ROW_UNITS = {"_Pa": "Pa", "_m_s": "m/s", "_Hz": "Hz", "_N": "N", "_m": "m", "_si": "m"}
"""Units of the variables in a dataset, keyed by the last part of the name."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Fit:
    """Result of `fit`: the coefficient of friction and u_lim that were fitted to measured friction.

    Each interval covers the scatter of the rows at the confidence level.  The interval is then
    widened by the error estimate of the model, because this error is not random.  A bound is None
    if the rows do not determine it.  The page docs/reference/fields.md explains all fields and all
    names in `rows`.

    Attributes
    ----------
    mu, u_lim_m, shear_modulus_Pa : float or None
        The fitted parameters.  The bounds of their intervals have names such as u_lim_low_m and
        u_lim_high_m.
    labels : dict of list
        Text columns of the measured table, keyed by name.
    rows : dict of np.ndarray, shape (n,)
        Conditions, measured values and fitted values of the rows, keyed by name.
    curve : dict of np.ndarray
        Model curves between the rows, for the figure: the conditions, the friction and its error
        estimate, keyed by name.
    """

    motion: str
    quantity: str
    mu: float
    mu_low: float
    mu_high: float
    u_lim_m: float | None
    u_lim_low_m: float | None
    u_lim_high_m: float | None
    shear_modulus_Pa: float | None = None
    shear_modulus_low_Pa: float | None = None
    shear_modulus_high_Pa: float | None = None
    load_N: float
    confidence: float
    mu_model_share: float
    scale_model_share: float
    standard_error: float | None
    chi_square: float | None
    p_value: float | None
    degrees_of_freedom: int
    reason: str
    warnings: tuple[str, ...]
    understood: dict[str, str]
    left_out: tuple[str, ...]
    labels: dict[str, list] = field(repr=False)
    rows: Rows = field(repr=False)
    curve: Rows = field(repr=False)

    def __str__(self) -> str:
        """Return the lines that `microslip fit` prints."""
        lines = [line(name.replace("_", " "), text) for name, text in self.understood.items()]
        kind = {"friction": "the friction force", "mu": "the coefficient of friction"}
        rows = f"{len(self.rows['measured'])}, of {kind[self.quantity]}"
        lines += [line("rows", f"{rows}; mean load {prefixed_text(self.load_N, 'N')}"), ""]
        for name, unit in PARAMETERS.items():
            ends = (_digits(getattr(self, column(name, unit, part)), unit, 4) for part in PARTS)
            value, low, high = ends
            lines += [line(_title(name), f"{value}, from {low} to {high}")] * (value != OPEN)
        shares = {"mu": self.mu_model_share}
        if not self.reason:
            scale = "u_lim" if self.shear_modulus_Pa is None else "shear modulus"
            shares[scale] = self.scale_model_share
        model = ", ".join(f"of {n} {_digits(100.0 * x, '', 2)} %" for n, x in shares.items())
        level = f"{100.0 * self.confidence:g} %, plus the model error: {model}"
        lines.append(line("intervals", level))
        if self.standard_error is not None:
            scatter = _digits(self.standard_error, UNITS[self.quantity], 4)
            lines.append(line("scatter", f"{scatter} a row"))
        else:
            chance = "" if self.p_value is None else f", p = {self.p_value:.2g}"
            text = f"{self.chi_square:.3g} for {self.degrees_of_freedom} degrees of freedom{chance}"
            lines.append(line("chi square", text))
        lines += [f"NOT DETERMINED: {self.reason}"] if self.reason else []
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def to_dict(self) -> dict:
        """Return the fields and the rows of the fit as a dict.  Arrays and tuples are converted to
        lists."""
        values = {n: x for n, x in vars(self).items() if n not in ("rows", "curve")}
        values |= {"warnings": list(self.warnings), "left_out": list(self.left_out)}
        return values | {name: array.tolist() for name, array in self.rows.items()}

    def to_xarray(self) -> xr.Dataset:
        """Return the fit as a dataset.  Variables of the rows have the dimension `row`, variables
        of the curves have the dimension `curve_point`, and single numbers have no dimension.
        Strings are attributes."""
        import xarray as xr

        values = vars(self) | {"understood": (f"{n}: {x}" for n, x in self.understood.items())}
        values = {n: "; ".join(x) if n in LISTS else x for n, x in values.items()}
        texts = {n: x for n, x in values.items() if isinstance(x, str)}
        numbers = {n: x for n, x in values.items() if not isinstance(x, str | dict)}
        variables: dict[str, tuple] = {
            n: ((), np.nan if x is None else x) for n, x in numbers.items()
        }
        variables |= {name: ("row", x) for name, x in self.rows.items()}
        variables |= {f"curve_{name}": ("curve_point", x) for name, x in self.curve.items()}
        friction = dict.fromkeys(("measured", "fitted", "d_error"), UNITS[self.quantity] or "1")
        for name, variable in variables.items():
            units = (one for end, one in (ROW_UNITS | friction).items() if name.endswith(end))
            variables[name] = *variable, {"units": next(units, "1")}
        variables |= {name: ("row", cells) for name, cells in self.labels.items()}
        return xr.Dataset(variables, attrs=texts)


def _title(name: str) -> str:
    return name.replace("shear_m", "shear m")


def _digits(value: float | None, unit: str, count: int) -> str:
    """Format a number with `count` significant digits and a metric prefix of the unit."""
    if not value:
        return OPEN if value is None else f"0 {unit}".strip()
    name, size = prefixed(value, unit) if unit else (unit, 1.0)
    return f"{f'{value / size:#.{count}g}'.rstrip('.')} {name}".strip()


def fit(
    motion: str,
    measured: object,
    *,
    map: object = None,
    speed: object = None,
    amplitude: object = None,
    frequency: object = None,
    load: object = None,
    nu: object = None,
    radius: object = None,
    counterbody: object = None,
    confidence: object = None,
    tolerance: object = None,
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Fit:
    """Fit mu, and either u_lim or the shear modulus, to measured friction.

    If no radius is given, the unknowns are mu and u_lim, and the only property of the bodies that
    is needed is Poisson's ratio.  If a radius is given, the unknowns are mu and the shear modulus.
    In both cases, Hertz's theory gives the dependence on the load.

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal" or "zigzag".
    measured : path, mapping or pandas DataFrame
        A CSV file with a heading line such as `speed [mm/s],amplitude [um],friction [N]`, or
        columns with such names.  Columns without a unit are in SI units.  The columns are speed,
        amplitude, frequency, load; friction (mean forward force) or mu (friction divided by load);
        optionally the standard errors friction_error or mu_error of the measured values, and text
        columns named label, name, id, sample or comment.
    map : xarray.Dataset, optional
        Dataset of a sweep of this motion; see `open_map`.  Interpolation in a map is fast.
        Without a map, the solver computes every point.
    speed, amplitude, frequency, load : quantity, optional
        Common value for all rows, in place of a column.
    nu : quantity, optional
        Poisson's ratio of the equivalent half-space.  The default is the map's Poisson's ratio, or
        0 without a map.  With a radius, `nu` is Poisson's ratio of the bodies and is required.
    radius : quantity, optional
        Radius of relative curvature.  For a sphere on a flat, this is the sphere's radius.
    counterbody : str, optional
        Only with a radius.  The counterbody is "rigid" (default), or "same" for the material of
        the first body.
    confidence : quantity, optional
        Confidence level of the intervals, default 0.95.
    tolerance : quantity, optional
        Largest accepted error of mu_macro in the solver, default 1e-3.
    decimal, encoding : str
        The decimal mark of the file, "." or ",", and its encoding, such as "cp1252".

    Returns
    -------
    Fit
        Both parameters with intervals.  If the rows determine only mu, the fit contains mu and the
        reason why the other parameter is missing.

    Raises
    ------
    InputError
        If the table cannot be read, if it has too few rows, if all rows have the same condition, or
        if the rows do not determine mu.
    """
    if not isinstance(motion, str) or motion not in MOTIONS:
        raise InputError("motion", motion, f"allowed is one of {', '.join(MOTIONS)}")
    shared = {"speed": speed, "amplitude": amplitude, "load": load, "frequency": frequency}
    about = _read_rows(measured, shared, decimal=decimal, encoding=encoding)
    bodies, texts = _read_bodies(nu, radius, counterbody)
    level = CONFIDENCE if confidence is None else confidence
    level = read_quantity("confidence", level, CONFIDENCES).si
    if map is not None:
        friction = _of_map(map, motion, bodies.get("nu"))
    else:
        accuracy = TOLERANCE if tolerance is None else tolerance
        accuracy = read_quantity("tolerance", accuracy, TOLERANCES).si
        friction = _of_solver(about["rows"], motion, bodies.get("nu", 0.0), accuracy)
    if nu is None:
        source = "default" if map is None else "map"
        used = np.ravel(getattr(map, "poisson", 0.0))[0]
        texts = {"nu": f"{used:g} ({source})"} | texts
    odd = about.pop("odd")
    about |= {"motion": motion, "understood": {"motion": motion} | texts | about["understood"]}
    with np.errstate(over="ignore"):  # a row of 1e300 N
        result = _fitted(about, friction, bodies, level)
    if result.mu <= SMALLEST_MU:
        problem = f"mu is at most {SMALLEST_MU:g}; check the units of the friction and of the load"
        raise InputError("measured", source_name(measured), problem)
    if not result.mu_high < WIDEST_MU * result.mu_low:
        problem = f"mu from {result.mu_low:.3g} to {result.mu_high:.3g} fits as well with another"
        problem = f"the rows determine neither number: {problem} u_lim; {odd}; {MORE_ROWS}"
        raise InputError("measured", source_name(measured), problem)
    return result


# Rows and bodies


def _read_rows(source: Any, shared: dict[str, Any], **form: str) -> dict[str, Any]:
    """Read the rows of a file or of a mapping of columns.  Returns a dict that contains the rows
    and four fields of a `Fit`: `quantity`, `labels`, `left_out` and `understood`.  Raises
    InputError."""
    table = table_of("measured", source, UNITS, need_units=True, **form)
    columns, errors = table.columns, dict(table.errors)
    good: dict[int, list[float]] = {}

    def refuse(wrong: object, text: str) -> None:
        if wrong:
            raise InputError("measured", source_name(source), text)

    names = [one for one in columns if one not in LABELS]
    unknown = [repr(one) for one in names if one not in UNITS] or [""]
    what, other = ("friction", "mu") if "friction" in names else ("mu", "friction")
    refuse(unknown[0], f"a column {unknown[0]}; allowed are some of {', '.join(UNITS)}")
    refuse(what not in names, "has neither friction nor mu; allowed is one of them")
    refuse(other in names, "has both friction and mu; allowed is one of them")
    refuse(f"{other}_error" in names, f"has {other}_error without {other}")
    for k, cells in enumerate(zip(*(columns[one] for one in names), strict=True)):
        if k in errors or all(cell is None for cell in cells):
            continue
        try:
            pairs = zip(names, cells, strict=True)
            good[k] = [read_quantity(one, cell, COLUMNS[one]).si for one, cell in pairs]
        except InputError as error:
            empty = error.value is None
            if not table.lines:
                allowed = f"{EMPTY if empty else error.allowed}, in row {k + 1}"
                raise InputError(error.argument, error.value, allowed) from None
            problem = f"{error.argument} is {EMPTY}" if empty else error
            errors[k] = f"line {table.lines[k]}: {problem}"
    count, left_out = len(good), tuple(errors[k] for k in sorted(errors))
    refuse(not (good or errors), "no rows; allowed is a row for each measurement")
    refuse(not good, f"{(*left_out, '')[0]}; all {len(left_out)} lines are invalid")
    numbers, texts = dict(zip(names, np.array(list(good.values())).T, strict=True)), {}
    for one, value in shared.items():
        if (one in names) == (value is not None):
            where = "both a column and an argument" if one in names else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(one, value, allowed)
        if value is not None:
            quantity = read_input(one, value)
            numbers[one], texts[one] = np.full(count, quantity.si), quantity.text
    rows = {key: numbers[one] for key, one in zip(KEYS, CONDITIONS, strict=True)}
    value, least = numbers[what], 2 if f"{what}_error" in names else 3
    refuse(count > MOST_ROWS, f"{count} rows; allowed are at most {MOST_ROWS} rows")
    refuse(not numbers["amplitude"].any(), "amplitude is 0 in all rows, so that nothing vibrates")
    refuse(count < least, f"{count} rows; allowed are at least 3, or 2 with errors of their own")
    nothing = f"above 0 in none of {count} rows, and negative in {(value < 0.0).sum()}"
    refuse(not (value > 0.0).any(), f"{what} is {nothing}; a force against the motion is positive")
    same = np.unique([*rows.values()], axis=1).shape[1] == 1
    refuse(same, "all rows are of one condition; allowed: two or more conditions")
    sigma = numbers.get(f"{what}_error", np.full(count, np.nan))
    shares = np.maximum(value / numbers["load"] ** (what == "friction"), 1e-300)
    k = list(good)[int(np.argmax(np.abs(np.log(shares / np.median(shares)))))]
    where = f"line {table.lines[k]}" if table.lines else f"row {k + 1}"
    return {
        "odd": f"farthest from the other rows is {where}, where {what} is {columns[what][k]}",
        "quantity": what,
        "labels": {name: [cells[k] for k in good] for name, cells in table.labels.items()},
        "left_out": left_out,
        "understood": texts,
        "rows": rows | {"measured": value, "measured_error": sigma},
    }


def _read_bodies(nu: Any, radius: Any, counterbody: Any) -> tuple[dict[str, Any], dict[str, str]]:
    """Read the inputs nu, radius and counterbody.  Returns two dicts, keyed by input.  One dict
    contains the values of the inputs, and the other dict contains their descriptions.  Raises
    InputError."""
    if radius is None and counterbody is not None:
        raise InputError("counterbody", counterbody, "allowed with a radius")
    if radius is not None and nu is None:
        raise InputError("nu", None, "needed with a radius")
    if counterbody not in (None, "rigid", "same"):
        raise InputError("counterbody", counterbody, "allowed is rigid or same")
    inputs = {n: read_input(n, x) for n, x in (("nu", nu), ("radius", radius)) if x is not None}
    texts = {name: one.text for name, one in inputs.items()}
    if radius is not None:
        texts = {"nu": "", "counterbody": str(counterbody or "rigid (default)")} | texts
    return {name: one.si for name, one in inputs.items()} | {"counterbody": counterbody}, texts


def _contact(
    bodies: dict[str, Any], mu: float, modulus: float, motion: str | None = None, **moving: float
) -> Contact:
    """Return the contact of a body, whose shear modulus (in Pa) is given, with a counterbody.  If
    `motion` is None, the contact is at rest."""
    young = 2.0 * modulus * (1.0 + bodies["nu"])
    other = (young, bodies["nu"]) if bodies["counterbody"] == "same" else None
    own = bodies | {"young": young, "counterbody": other}
    inputs = read_inputs(motion, mu=mu, **own, **moving)
    return contact_of(inputs) if motion else Contact(inputs)


# Friction


def _of_map(dataset: Any, motion: str, poisson: float | None) -> Friction:
    """Return a function that interpolates friction in the dataset of a sweep; see
    datasets.accessor."""
    source = FrictionMap(dataset, motion)
    from xarray import DataArray

    axes = [dataset[name].values for name in ("velocity", "amplitude")]
    limits = [(axis[axis > 0.0].min(), axis.max()) for axis in axes]

    def friction(*point: np.ndarray, rough: bool = False) -> np.ndarray:
        pairs = zip(point, limits, strict=True)
        parts = [np.clip(part, *ends) if rough else part for part, ends in pairs]
        velocity, amplitude = (DataArray(part, dims=("x", "row")[-part.ndim :]) for part in parts)
        problem = "does not contain the rows at the best fit"
        try:
            values = np.stack(source.at(velocity, amplitude, poisson))
        except ValueError as error:
            if rough:
                raise
            raise InputError("map", motion, f"{problem}: {error}") from None
        if not np.isfinite(values).all():
            raise InputError("map", motion, problem)
        return values

    return friction


def _of_solver(rows: Rows, motion: str, poisson: float, tolerance: float) -> Friction:
    """Return a function that computes friction with the solver.  For rough values, the function
    interpolates in a coarse map.  The axes of this map are the logarithms of the amplitude and of
    the ratio of velocity to amplitude."""
    if len(rows["measured"]) > MOST_SOLVED:
        allowed = f"rows; allowed are at most {MOST_SOLVED}, or any number with a map"
        raise InputError("measured", len(rows["measured"]), allowed)

    @cache
    def point(velocity: float, amplitude: float, **settings: Any) -> tuple[float, float]:
        place = min(velocity, LARGEST["velocity"]), min(amplitude, LARGEST["amplitude"])
        result = solve(motion, *place, **settings)
        if not np.isfinite(result.mu_macro):
            where = f"velocity {velocity:.3g} and amplitude {amplitude:.3g}"
            problem = f"no answer at {where}: {result.reason}"
            raise InputError("tolerance", settings["tolerance"], problem)
        return result.mu_macro, result.mu_macro_error

    def place(velocity: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ratio = np.clip(velocity / np.maximum(amplitude, 1e-300), SLOWEST, FASTEST)
        return np.log(np.clip(amplitude, LEAST, MOST)), np.log(ratio)

    paces = place(*_lengths(rows))[1]
    low, high = paces.min() - 0.1, paces.max() + 0.1
    sizes = np.linspace(math.log(LEAST) - 0.1, math.log(MOST) + 0.1, SIZES)
    paces = np.linspace(low, high, max(4, math.ceil(1.0 + RATIOS * (high - low) / math.log(10.0))))
    nodes = [[point(r * a, a, **COARSE)[0] for r in np.exp(paces)] for a in np.exp(sizes)]
    spline = scipy.interpolate.RectBivariateSpline(sizes, paces, np.array(nodes), s=0)

    def friction(velocity: np.ndarray, amplitude: np.ndarray, rough: bool = False) -> np.ndarray:
        if rough:
            return spline(*place(velocity, amplitude), grid=False)[None]
        points = zip(velocity, amplitude, strict=True)
        return np.array([point(*one, poisson=poisson, tolerance=tolerance) for one in points]).T

    return friction


def _lengths(rows: Rows, load: float | None = None) -> np.ndarray:
    """Return the dimensionless velocities and amplitudes of the rows, multiplied by u_lim at the
    mean load.  The result is an array of shape (2, n), in m."""
    speed, amplitude, loads, frequency = (rows[key] for key in KEYS)
    share = (loads / (load or loads.mean())) ** (2.0 / 3.0)
    return np.stack([speed / (2.0 * math.pi * frequency), amplitude]) / share


def _curves(friction: Friction, lengths: np.ndarray, x: Any) -> np.ndarray:
    """Return rough values of mu_macro for all rows, and for each value of ln u_lim in the array
    `x`.  This array has the shape (..., 1)."""
    still = lengths[1] == 0.0
    velocity, amplitude = np.where(still, 1.0, lengths)
    rough = friction(velocity / np.exp(x), amplitude / np.exp(x), rough=True)[0]
    return np.where(still, 1.0, rough)


# Sum of squares


class Profile:
    """Sum of squares of the fit as a function of two variables, mu and x.  Here, x is the logarithm
    of u_lim at the mean load.

    Attributes
    ----------
    x : np.ndarray, shape (NODES,)
        Tabulated values of ln u_lim.
    macro : scipy.interpolate.CubicSpline
        mu_macro of the rows as a function of x.
    sigma, errors : np.ndarray, shape (n,)
        Standard errors of the measured values, and error estimates of mu_macro.
    y, weight : np.ndarray, shape (n,)
        Measured values, and values of the model at mu = mu_macro = 1, both divided by `sigma`.
    best : float
        The value of x with the smallest sum of squares.
    """

    def __init__(self, rows: Rows, weight: np.ndarray, friction: Friction):
        measured, known = rows["measured"], np.isfinite(rows["measured_error"])
        self.sigma = np.where(known, rows["measured_error"], np.abs(measured).max())
        self.y, self.weight = measured / self.sigma, weight / self.sigma
        lengths, self.errors = _lengths(rows), np.zeros_like(measured)
        moving = lengths[1] > 0.0
        low, high = lengths[1, moving].min() / MOST, lengths[1].max() / LEAST
        self.x = np.linspace(math.log(low), math.log(high), NODES)
        curves, last = _curves(friction, lengths, self.x[:, None]), np.full(2, np.inf)
        for _ in range(MOST_PASSES + 1):
            self.macro = scipy.interpolate.CubicSpline(self.x, curves)
            k = int(np.argmin(self.squares(self.x)))
            bounds = self.x[max(k - 1, 0)], self.x[min(k + 1, NODES - 1)]
            form = {"method": "bounded", "options": {"xatol": 1e-9}}
            best = scipy.optimize.minimize_scalar(self.squares, bounds=bounds, **form)
            self.best = float(best.x)
            now = np.array([self.best, math.log(self.mu(self.best)[0])])
            if np.abs(now - last).max() <= SETTLED:
                break
            last = now
            macro, self.errors[moving] = friction(*lengths[:, moving] / math.exp(self.best))
            curves[:, moving] += macro - self.macro(self.best)[moving]

    def mu(self, x: Any) -> tuple[Any, Any, Any]:
        """Return the best mu at x, the smallest sum of squares at x, and half of the second
        derivative of this sum with respect to mu."""
        slope = self.weight * self.macro(x)
        norm = np.maximum((slope * slope).sum(axis=-1), np.finfo(float).tiny)
        mu = np.clip(slope @ self.y / norm, SMALLEST_MU, INPUTS["mu"].high)
        return mu, ((self.y - mu[..., None] * slope) ** 2).sum(axis=-1), norm

    def squares(self, x: Any) -> Any:
        return self.mu(x)[1]

    def ends(self, allowed: float) -> tuple[float, float]:
        """Return the bounds of an interval around the best x.  In this interval, the sum of squares
        is at most `allowed`.  A bound is infinite if the interval extends to the end of the
        tabulated range of x."""
        near = self.best + (self.x[-1] - self.x[0]) * np.linspace(-1.0, 1.0, NODES) ** 7
        grid = np.unique(np.clip([self.x, near], self.x[0], self.x[-1]))
        curve = scipy.interpolate.CubicSpline(grid, self.squares(grid) - allowed)
        roots = curve.roots(extrapolate=False)
        low, high = roots[roots < self.best], roots[roots > self.best]
        return max(low, default=-math.inf), min(high, default=math.inf)

    def second(self, allowed: float) -> float | None:
        """Return the value of x at a second minimum of the sum of squares, or None if there is no
        second minimum.  At a second minimum, the sum of squares is at most `allowed`, and u_lim
        differs from the best u_lim by more than a factor of 2."""
        sums = np.pad(self.squares(self.x), 1, constant_values=np.inf)
        lowest = np.flatnonzero(sums[1:-1] <= np.minimum(np.minimum(sums[:-2], sums[2:]), allowed))
        far = [k for k in lowest if abs(self.x[k] - self.best) > math.log(2.0)]
        return self.x[min(far, key=lambda k: sums[k + 1])] if far else None


def _fitted(about: dict[str, Any], friction: Friction, bodies: dict[str, Any], level: float) -> Fit:
    """Return the result of the fit, with intervals at the given confidence level."""
    rows = about["rows"]
    load = float(rows["row_load_N"].mean())
    weight = rows["row_load_N"] ** (about["quantity"] == "friction")
    known = bool(np.isfinite(rows["measured_error"]).all())
    profile = Profile(rows, weight, friction)
    at, free, macro = profile.best, len(weight) - 2, profile.macro(profile.best)
    mu, squares, _ = map(float, profile.mu(at))
    off = mu * profile.weight * profile.errors
    stats = scipy.stats
    noise = stats.chi2.ppf(level, 1) if known else stats.f.ppf(level, 1, free) * squares / free
    rounding = 1e-12 * float(profile.y @ profile.y)
    allowed = squares + max(float(noise), float(np.mean(off**2)), rounding)
    ends = profile.ends(allowed)
    determined = bool(np.isfinite(ends).all())
    low, high = np.clip(ends, profile.x[0], profile.x[-1])
    x = np.linspace(low, high, REGION)
    centre, sums, norm = profile.mu(x)
    half = np.sqrt(np.maximum(allowed - sums, 0.0) / norm)
    mus = np.log(np.clip([centre - half, centre + half], SMALLEST_MU, INPUTS["mu"].high))
    # Largest changes of ln mu and x due to errors of the model, to first order.
    slopes = mu * np.stack([macro, profile.macro(at, 1)], axis=1) * profile.weight[:, None]
    shifts = np.zeros((2, len(off)))
    shifts[: 1 + determined] = np.linalg.pinv(slopes[:, : 1 + determined])
    # The logarithm of a parameter is a ln mu + b x + c; u_lim = mu unit G^(-2/3).
    parameters = {"mu": (1.0, 0.0, 0.0), "u_lim": (0.0, 1.0, 0.0)}
    if "radius" in bodies:
        unit = _contact(bodies, 1.0, 1.0, load=load).u_lim
        parameters["shear_modulus"] = 1.5, -1.5, 1.5 * math.log(unit)
    values: dict[str, Any] = {}
    for name, (a, b, c) in parameters.items():
        region, si = a * mus + b * x + c, PARAMETERS[name]
        share = float(np.abs(a * shifts[0] + b * shifts[1]) @ off)
        logs = [a * math.log(mu) + b * at + c, region.min() - share, region.max() + share]
        opens = [not determined, *np.isinf(ends)[:: 1 if b >= 0.0 else -1]]
        for part, end, is_open in zip(PARTS, logs, opens, strict=True):
            values[column(name, si, part)] = None if b and is_open else math.exp(min(end, 700.0))
        values["scale_model_share" if b else "mu_model_share"] = math.expm1(share)
    size, chance, reason, doubts = math.exp(logs[0]), None, "", []
    if not determined:
        keys = {"below": column(name, si, "high"), "above": column(name, si, "low")}
        sides = [f" {n} {values[x]:.3g} {si}" for n, x in keys.items() if values[x] is not None]
        which = f"any {_title(name)}{''.join(sides)}"
        reason = f"the rows determine mu alone: {which} fits them as well"
    if known and free and (chance := float(scipy.stats.chi2.sf(squares, free))) < UNLIKELY:
        problem = f"the residuals are larger than the errors of the rows allow (p = {chance:.1g})"
        doubt = "the theory does not describe these rows, or the errors are too small"
        doubts.append(f"{problem}: {doubt}")
    doubts += _warnings(about["motion"], rows, bodies, mu, size)
    if determined and (other := profile.second(allowed)) is not None:
        second = float(profile.mu(other)[0])
        text = f"mu {second:.3g} with {math.exp(a * math.log(second) + b * other + c):.3g} {si}"
        doubts.append(f"{text} fits nearly as well: two answers")
    velocity, amplitude = _lengths(rows) / math.exp(at)
    sigma = profile.sigma if known else profile.sigma * math.sqrt(squares / free)
    rest = rows["measured"] - mu * weight * macro
    added = {
        "velocity": velocity,
        "amplitude": amplitude,
        "fitted": mu * weight * macro,
        "fitted_error": mu * weight * profile.errors,
        "residual": np.divide(rest, sigma, out=0.0 * rest, where=sigma > 0.0),
    }
    return Fit(
        **about | values | {"rows": rows | added},
        load_N=load,
        confidence=level,
        standard_error=None if known else float(sigma[0]),
        chi_square=squares if known else None,
        p_value=chance,
        degrees_of_freedom=free,
        reason=reason,
        warnings=tuple(doubts),
        curve=_curve(rows | added, profile, friction, mu),
    )


def _warnings(motion: str, rows: Rows, bodies: dict[str, Any], mu: float, size: float) -> list[str]:
    """Return warnings about assumptions of the theory that are violated at the best fit."""
    if "radius" not in bodies:
        return broken_rules({"mu": mu})
    k = int(np.argmax(rows["amplitude_si"]))
    moving = {one: float(rows[key][k]) for one, key in zip(CONDITIONS, KEYS, strict=True)}
    moving["load"] = float(rows["row_load_N"].mean())
    return warnings_of(_contact(bodies, mu, size, motion, **moving), moving["speed"])


def _curve(rows: Rows, profile: Profile, friction: Friction, mu: float) -> Rows:
    """Compute curves of friction from the fitted model.  Each curve connects rows that differ in
    one condition only.  The returned arrays contain these curves one after another.

    This condition is the one that has the most distinct values in the table.  The corrections of
    the coarse map at the rows are interpolated between the rows.
    """
    along = max(KEYS, key=lambda key: len(np.unique(rows[key])))
    which = np.unique([rows[k] for k in KEYS if k != along], axis=1, return_inverse=True)[1].ravel()
    load, weight = rows["row_load_N"].mean(), profile.weight * profile.sigma
    more = profile.macro(profile.best) - _curves(friction, _lengths(rows), profile.best)
    parts = [np.empty((6, 0))]
    for members in (np.flatnonzero(which == one) for one in np.unique(which)):
        values, first = np.unique(rows[along][members], return_index=True)
        if len(values) < 2:
            continue
        least = values[values > 0.0][0]
        pieces = np.linspace(values[0], values[-1], PIECES), np.geomspace(least, values[-1], PIECES)
        axis = np.unique(np.clip(np.concatenate([values, *pieces]), values[0], values[-1]))
        fine = {key: np.full(len(axis), rows[key][members[0]]) for key in KEYS} | {along: axis}
        rest = [np.interp(axis, values, one[members[first]]) for one in (more, profile.errors)]
        macro = _curves(friction, _lengths(fine, load), profile.best) + rest[0]
        factor = mu * np.interp(axis, values, weight[members[first]])
        parts.append(np.stack([*fine.values(), factor * macro, factor * rest[1]]))
    return dict(zip((*KEYS, "fitted", "fitted_error"), np.concatenate(parts, axis=1), strict=True))
