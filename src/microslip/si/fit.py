"""Fit mu, and u_lim or the shear modulus, to friction measured under vibration.

The model is: measured value = mu * weight * mu_macro + error.  The ratio of velocity to amplitude
does not depend on u_lim, so mu_macro of a row is a function of ln u_lim alone, and the model is
linear in mu.  For each u_lim, mu follows by linear least squares.

An interval contains the values for which the sum of squares, minimised over the other unknown, is
below a threshold.  The threshold is the least sum plus a quantile: of the chi-square distribution
if the rows have errors, else of the F distribution times the mean square residual.  Such an
interval does not depend on the parametrisation, and may be infinite on one side.

Without a map, the solver computes a coarse map first.  It gives the change of friction between two
guesses.  The rows are then solved at the best guess, which corrects the map there.  At the end, the
remaining error of the coarse map is of second order.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.answer.point import solve
from microslip.foundation.arguments import LARGEST, SMALLEST_TOLERANCE
from microslip.foundation.csv_table import LABELS, Table, table_of
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import prefixed, prefixed_text
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, Input, read_input, read_inputs, read_quantity
from microslip.si.map import FrictionMap
from microslip.si.output import line
from microslip.si.warnings import broken_rules, warnings_of

if TYPE_CHECKING:
    import xarray as xr

MOTIONS = ("transverse", "longitudinal", "zigzag")
CONDITIONS = ("speed", "amplitude", "frequency", "load")
UNITS = {"speed": "m/s", "amplitude": "m", "frequency": "Hz", "load": "N"}
UNITS |= {"friction": "N", "friction_error": "N", "mu": "", "mu_error": ""}
"""SI units of the allowed columns."""
MOST_ROWS, MOST_SOLVED = 10_000, 200
"""Largest number of rows with a map, and without."""
TOLERANCE, LARGEST_TOLERANCE, CONFIDENCE = 1e-3, 0.02, 0.95
LEAST, MOST = 0.03, 20.0
"""Smallest and largest dimensionless amplitude that a fit resolves.  At smaller amplitudes, nearly
the whole contact sticks.  At larger amplitudes, nearly the whole contact slides all the time."""
SLOWEST, FASTEST = 1e-3, 20.0
"""Smallest and largest ratio of velocity to amplitude in the coarse map."""
NODES_A_DECADE = 5, 4
"""Number of nodes of the coarse map per decade of amplitude and of ratio."""
COARSE = {"poisson": 0.0, "tolerance": 5e-3}
"""Settings of the coarse map.  Poisson's ratio hardly changes the slopes."""
NODES = 161
"""Number of values of ln u_lim at which the friction of the rows is tabulated."""
MOST_PASSES, SETTLED = 6, 5e-4
"""Largest number of corrections, and relative change of both unknowns at which they end."""
SMALLEST_MU = 1e-5
WIDEST_MU = 2.0
"""Largest allowed ratio between the upper and the lower end of the interval for mu."""
UNLIKELY = 0.01
"""Probability below which a sum of squares leads to a warning."""
PIECES = 60
"""Number of linearly and of logarithmically spaced points on a curve of the figure."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Fit:
    """Coefficient of friction and u_lim of a contact, from measured friction.

    An interval includes the scatter of the rows at a confidence level, and the model's error
    estimate, which is not random.  Ends that the rows do not determine are None.

    Attributes
    ----------
    motion : str
        The motion.
    quantity : str
        Measured quantity: "friction", a force in N, or "mu", a coefficient.
    mu, mu_low, mu_high : float
        Coefficient of friction without vibration, dimensionless, and the ends of its interval.
    u_lim_m, u_lim_low_m, u_lim_high_m : float or None
        Displacement at which the whole contact slides under the mean load, m, and its interval.
    shear_modulus_Pa, shear_modulus_low_Pa, shear_modulus_high_Pa : float or None
        Shear modulus of the bodies, Pa, and its interval; None in a fit without a radius.
    load_N : float
        The mean load, N.
    confidence : float
        Confidence level of the intervals, 0 to 1.
    mu_model_share, scale_model_share : float
        Largest relative changes in mu, and in u_lim or the shear modulus, due to model errors.
    standard_error : float or None
        Standard error of one row, from the residuals of the fit, in the unit of the rows.  None for
        rows with standard errors.
    chi_square, p_value : float or None
        Weighted sum of squares, and the probability of a larger sum by chance.  None for rows
        without standard errors.
    degrees_of_freedom : int
        Number of rows minus 2.
    told : tuple of str
        Numbers that the rows determine: "mu", and "u_lim" or "shear_modulus".
    reason : str
        The reason why the rows do not determine both numbers; empty if they do.
    warnings : tuple of str
        Reasons to doubt the result.
    understood : dict of str
        Inputs as text.
    labels : dict of list
        Text columns of the table, by name.
    left_out : tuple of str
        Unreadable lines of the table, with the reasons.  The fit ignores these lines.
    speed_m_s, amplitude_si, frequency_Hz, row_load_N : np.ndarray, shape (rows,)
        Conditions of each row.  The amplitude is in m.
    velocity, amplitude : np.ndarray, shape (rows,)
        Dimensionless velocity and amplitude of each row at the best fit, as in microslip.solve.
    measured, measured_error : np.ndarray, shape (rows,)
        Measured values and standard errors, N or dimensionless; NaN for an unknown error.
    fitted, fitted_error : np.ndarray, shape (rows,)
        Values of the model and their error estimates, in the unit of the measured values.
    residual : np.ndarray, shape (rows,)
        Measured minus fitted values, divided by the standard error, dimensionless.
    curve : dict of np.ndarray
        Conditions, friction of the model and error estimate between the rows, for the figure.
    """

    motion: str
    quantity: str
    mu: float
    mu_low: float
    mu_high: float
    u_lim_m: float | None
    u_lim_low_m: float | None
    u_lim_high_m: float | None
    shear_modulus_Pa: float | None
    shear_modulus_low_Pa: float | None
    shear_modulus_high_Pa: float | None
    load_N: float
    confidence: float
    mu_model_share: float
    scale_model_share: float
    standard_error: float | None
    chi_square: float | None
    p_value: float | None
    degrees_of_freedom: int
    told: tuple
    reason: str
    warnings: tuple
    understood: dict = field(repr=False)
    labels: dict = field(repr=False)
    left_out: tuple
    speed_m_s: np.ndarray = field(repr=False)
    amplitude_si: np.ndarray = field(repr=False)
    frequency_Hz: np.ndarray = field(repr=False)
    row_load_N: np.ndarray = field(repr=False)
    velocity: np.ndarray = field(repr=False)
    amplitude: np.ndarray = field(repr=False)
    measured: np.ndarray = field(repr=False)
    measured_error: np.ndarray = field(repr=False)
    fitted: np.ndarray = field(repr=False)
    fitted_error: np.ndarray = field(repr=False)
    residual: np.ndarray = field(repr=False)
    curve: dict = field(repr=False)

    def __str__(self) -> str:
        """The lines that `microslip fit` prints."""
        kind = (
            "the friction force" if self.quantity == "friction" else "the coefficient of friction"
        )
        unit = "N" if self.quantity == "friction" else ""
        load = prefixed_text(self.load_N, "N")
        lines = [line(name.replace("_", " "), text) for name, text in self.understood.items()]
        lines += [line("rows", f"{len(self.measured)}, of {kind}; mean load {load}"), ""]
        for name, suffix, base in (
            ("mu", "", ""),
            ("u_lim", "_m", "m"),
            ("shear_modulus", "_Pa", "Pa"),
        ):
            parts = [getattr(self, f"{name}{part}{suffix}") for part in ("", "_low", "_high")]
            if parts[0] is not None:
                value, low, high = (_digits(part, base, 4) for part in parts)
                lines.append(
                    line(name.replace("shear_m", "shear m"), f"{value}, from {low} to {high}")
                )
        shares = {self.told[-1]: self.scale_model_share, "mu": self.mu_model_share}
        model = ", ".join(
            f"of {n.replace('shear_m', 'shear m')} {_digits(100.0 * shares[n], '', 2)} %"
            for n in self.told
        )
        lines.append(
            line("intervals", f"{100.0 * self.confidence:g} %, plus the model error: {model}")
        )
        if self.standard_error is not None:
            lines.append(line("scatter", f"{_digits(self.standard_error, unit, 4)} a row"))
        else:
            chance = "" if self.p_value is None else f", p = {self.p_value:.2g}"
            text = f"{self.chi_square:.3g} for {self.degrees_of_freedom} degrees of freedom{chance}"
            lines.append(line("chi square", text))
        lines += [f"NOT DETERMINED: {self.reason}"] if self.reason else []
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def to_dict(self) -> dict:
        """All fields except the curve.  Arrays and tuples become lists."""
        names = [one.name for one in fields(self) if one.name != "curve"]
        kinds = (np.ndarray, tuple)
        values = {name: getattr(self, name) for name in names}
        return {n: np.asarray(v).tolist() if isinstance(v, kinds) else v for n, v in values.items()}

    def to_xarray(self) -> xr.Dataset:
        """The fit as a dataset.  Row data have the dimension `row`, the curve `curve_point`, and
        numbers no dimension.  Texts are attributes."""
        import xarray as xr

        measured = "N" if self.quantity == "friction" else "1"
        ends = {
            "_Pa": "Pa",
            "_m_s": "m s-1",
            "_Hz": "Hz",
            "_N": "N",
            "_m": "m",
            "amplitude_si": "m",
        }
        ends |= dict.fromkeys(("measured", "fitted", "standard_error"), measured)
        ends |= {f"{name}_error": measured for name in ("measured", "fitted")}
        variables: dict[str, tuple] = {n: ("row", texts) for n, texts in self.labels.items()}
        attributes: dict[str, str] = {}
        arrays = {f"curve_{name}": values for name, values in self.curve.items()}
        for name, value in (vars(self) | arrays).items():
            unit = next((unit for end, unit in ends.items() if name.endswith(end)), "1")
            about = {"units": unit}
            if isinstance(value, np.ndarray):
                variables[name] = ("curve_point" if name in arrays else "row", value, about)
            elif name == "understood":
                attributes[name] = "; ".join(f"{key}: {text}" for key, text in value.items())
            elif isinstance(value, str | tuple):
                attributes[name] = value if isinstance(value, str) else "; ".join(value)
            elif not isinstance(value, dict):
                variables[name] = ((), np.nan if value is None else value, about)
        return xr.Dataset(variables, attrs=attributes)


def _digits(value: float, unit: str, count: int) -> str:
    """Format a number with `count` significant digits and a metric prefix of the unit."""
    name, size = prefixed(value, unit) if unit and value else (unit, 1.0)
    return f"{f'{value / size:#.{count}g}'.rstrip('.') if value else '0'} {name}".strip()


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
    """Fit mu, and u_lim or the shear modulus, to measured friction.

    Without a radius, the unknowns are mu and u_lim, and Poisson's ratio is the only property of the
    bodies.  With a radius, the unknowns are mu and the shear modulus.  In both cases, Hertz's
    theory gives the dependence on the load.

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal" or "zigzag".
    measured : path, mapping or pandas DataFrame
        A CSV file with a heading line such as `speed [mm/s],amplitude [um],friction [N]`, or
        columns with such names.  Columns without a unit are in SI units.  The columns are speed,
        amplitude, frequency, load; friction (mean forward force) or mu (friction divided by load);
        optionally their standard errors friction_error or mu_error, and texts named label, name,
        id, sample or comment.
    map : xarray.Dataset, optional
        Dataset of a sweep of this motion; see `open_map`.  Interpolation in a map is fast.
        Without a map, the solver computes every point.
    speed, amplitude, frequency, load : quantity, optional
        Common value for all rows.  It replaces a column.
    nu : quantity, optional
        Poisson's ratio of the equivalent half-space.  The default is the map's Poisson's ratio, or
        0 without a map.  With a radius, `nu` is Poisson's ratio of the bodies and is required.
    radius : quantity, optional
        Radius of relative curvature, m.  For a sphere on a flat, this is the sphere's radius.
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
        Both numbers with intervals.  If the rows determine only mu, the fit contains mu, and the
        reason why the other number is missing.

    Raises
    ------
    InputError
        If the table cannot be read, if it has too few rows or a single condition, or if the rows do
        not determine mu.
    """
    if not isinstance(motion, str) or motion not in MOTIONS:
        raise InputError("motion", motion, f"allowed is one of {', '.join(MOTIONS)}")
    shared = {"speed": speed, "amplitude": amplitude, "frequency": frequency, "load": load}
    rows = _read_rows(measured, shared, decimal=decimal, encoding=encoding)
    texts, poisson, bodies = _read_bodies(motion, nu, radius, counterbody)
    level = (
        CONFIDENCE
        if confidence is None
        else read_quantity("confidence", confidence, Input("", "", "", exact=True)).si
    )
    if level >= 1.0:
        allowed = "allowed is a number above 0 and below 1, such as 0.95 or '95 %'"
        raise InputError("confidence", confidence, allowed)
    if map is not None:
        model: Model = _map_model(map, motion, poisson)
    else:
        limits = Input("", "", "", SMALLEST_TOLERANCE, LARGEST_TOLERANCE, True, True)
        accepted = TOLERANCE if tolerance is None else tolerance
        accuracy = read_quantity("tolerance", accepted, limits).si
        model = _solver_model(rows, motion, poisson or 0.0, accuracy)
    profile, at, errors, others = _best(rows, model)
    return _concluded(
        rows,
        model,
        profile,
        at,
        errors,
        others,
        motion=motion,
        level=level,
        bodies=bodies,
        texts=texts | rows.texts,
    )


@dataclass(frozen=True, eq=False)
class Rows:
    """Measurements, shape (n,) each: conditions in SI units, values and errors in N or 1.

    An unknown error is NaN.  `sizes` is the amplitude divided by (load / mean load)^(2/3), m, and
    `ratio` is the velocity divided by the amplitude, dimensionless.
    """

    speed: np.ndarray
    amplitude: np.ndarray
    frequency: np.ndarray
    load: np.ndarray
    value: np.ndarray
    error: np.ndarray
    quantity: str
    texts: dict
    labels: dict
    left_out: tuple
    name: str | list

    @property
    def has_errors(self) -> bool:
        return bool(np.isfinite(self.error).all())

    @property
    def mean_load(self) -> float:
        return float(self.load.mean())

    @property
    def weight(self) -> np.ndarray:
        """Factor that converts a coefficient of friction to the measured quantity."""
        return self.load if self.quantity == "friction" else np.ones_like(self.load)

    @property
    def sizes(self) -> np.ndarray:
        return self.amplitude / (self.load / self.mean_load) ** (2.0 / 3.0)

    @property
    def ratio(self) -> np.ndarray:
        travel = 2.0 * math.pi * self.frequency * self.amplitude
        fast = np.full_like(travel, FASTEST)  # without vibration, the velocity has no effect
        return np.divide(self.speed, travel, out=fast, where=travel > 0.0)


def _read_rows(source: Any, shared: Mapping[str, Any], **form: str) -> Rows:
    """Read and check the rows of a file or of a table of columns.  Raises InputError."""
    table = table_of("measured", source, UNITS, need_units=True, **form)
    name = str(source) if isinstance(source, str | os.PathLike) else list(source)

    def refuse(allowed: str) -> InputError:
        return InputError("measured", name, allowed)

    names = [one for one in table.cells if one not in LABELS]
    unknown = [repr(one) for one in names if one not in UNITS] or ["nothing"] * (not names)
    if unknown:
        raise refuse(f"a column {unknown[0]}; allowed are some of {', '.join(UNITS)}")
    if len({len(column) for column in table.cells.values()}) > 1:
        raise refuse("columns of several lengths; allowed is one length")
    numbers, kept, left_out = _numbers(table, names)
    if not kept:
        raise refuse(left_out[0] if left_out else "no rows; allowed is a row for each measurement")
    if len(kept) > MOST_ROWS:
        raise InputError("measured", len(kept), f"allowed are at most {MOST_ROWS} rows")
    texts = {}
    for one in CONDITIONS:
        if (one in names) == (shared[one] is not None):
            where = "both a column and an argument" if one in names else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(one, shared[one], allowed)
        if one not in names:
            quantity = read_input(one, shared[one])
            numbers[one], texts[one] = np.full(len(kept), quantity.si), quantity.text
    if not (numbers["amplitude"] > 0.0).any():
        raise refuse("no row with an amplitude above 0, so that nothing vibrates")
    values = [one for one in ("friction", "mu") if one in names]
    if len(values) != 1:
        many = "both friction and mu" if values else "neither friction nor mu"
        raise refuse(f"has {many}; allowed is one of them")
    (what,) = values
    for one in ("friction", "mu"):
        if one != what and f"{one}_error" in names:
            raise refuse(f"has {one}_error without {one}")
    conditions = {one: numbers[one] for one in CONDITIONS}
    error = numbers.get(f"{what}_error", np.full(len(kept), np.nan))
    labels = {n: [cells[k] for k in kept] for n, cells in table.labels.items()}
    rows = Rows(
        **conditions,
        value=numbers[what],
        error=error,
        quantity=what,
        texts=texts,
        labels=labels,
        left_out=tuple(left_out),
        name=name,
    )
    least, count, value = 2 if rows.has_errors else 3, len(kept), rows.value
    if count < least:
        more = "" if rows.has_errors else ", or two with errors of their own"
        raise refuse(f"{count} row{'s' * (count > 1)}; two numbers take at least {least}{more}")
    if (value <= 0.0).all() and (value < 0.0).any():
        problem = (
            f"{what} is negative in {(value < 0.0).sum()} of {count} rows, and above 0 in none"
        )
        raise refuse(f"{problem}; allowed is a positive sign for a force against the motion")
    if (value <= 0.0).all():
        raise refuse(f"the rows determine neither number: {what} is 0 in all rows")
    if len(np.unique(np.stack(list(conditions.values())), axis=1).T) < 2:
        raise refuse("all rows are of one condition; allowed: two or more conditions")
    return rows


def _numbers(table: Table, names: list[str]) -> tuple[dict[str, np.ndarray], list[int], list[str]]:
    """Numeric columns in SI units, the indices of their rows, and messages about unreadable lines.

    Empty rows, and unreadable lines of a file, are omitted.  In another table, an unreadable value
    raises InputError.
    """
    rows, kept, left_out = [], [], []
    for k, cells in enumerate(zip(*(table.columns[name] for name in names), strict=True)):
        if k in table.errors:
            left_out.append(table.errors[k])
        elif any(cell is not None for cell in cells):
            try:
                rows.append([_number(*pair) for pair in zip(names, cells, strict=True)])
                kept.append(k)
            except InputError as error:
                if not table.lines:
                    allowed = f"{error.allowed}, in row {k + 1}"
                    raise InputError(error.argument, error.value, allowed) from None
                problem = f"{error.argument} is {error.allowed}" if error.value is None else error
                left_out.append(f"line {table.lines[k]}: {problem}")
    return dict(zip(names, np.array(rows).T, strict=False)), kept, left_out


def _number(name: str, cell: object) -> float:
    if cell is None:
        allowed = "empty; allowed: a number in every row; leave out the row, or fill the cell"
        raise InputError(name, None, allowed)
    if name in CONDITIONS:
        return read_input(name, cell).si
    low = 0.0 if name.endswith("_error") else -math.inf
    return read_quantity(name, cell, Input("", UNITS[name], "", low, exact=True)).si


class Bodies(NamedTuple):
    """Bodies of a fit of the shear modulus."""

    poisson: float
    radius: float
    alike: bool

    def inputs(self, mu: float, modulus: float, load: float) -> dict[str, object]:
        """Inputs of predict for bodies with this shear modulus, Pa."""
        young = 2.0 * modulus * (1.0 + self.poisson)
        other = (young, self.poisson) if self.alike else None
        sphere = {"radius": self.radius, "load": load, "mu": mu}
        return {"young": young, "nu": self.poisson, "counterbody": other, **sphere}

    def contact(self, mu: float, modulus: float, load: float) -> Contact:
        """The contact of bodies with this shear modulus, Pa."""
        return Contact(read_inputs(None, **self.inputs(mu, modulus, load)))


def _read_bodies(
    motion: str, nu: object, radius: object, counterbody: object
) -> tuple[dict[str, str], float | None, Bodies | None]:
    """Inputs as text, Poisson's ratio, and the bodies of a fit of the shear modulus."""
    texts = {"motion": motion}
    ratio = None if nu is None else read_input("nu", nu)
    if ratio is not None:
        texts["nu"] = ratio.text
    if radius is None:
        if counterbody is not None:
            raise InputError("counterbody", counterbody, "allowed with a radius")
        return texts, None if ratio is None else ratio.si, None
    if ratio is None:
        raise InputError("nu", None, "needed with a radius")
    if counterbody not in (None, "rigid", "same"):
        raise InputError("counterbody", counterbody, "allowed is rigid or same")
    size = read_input("radius", radius)
    texts["counterbody"] = "rigid (default)" if counterbody is None else str(counterbody)
    texts["radius"] = size.text
    return texts, ratio.si, Bodies(ratio.si, size.si, counterbody == "same")


class Model(NamedTuple):
    """Friction of points with a ratio of velocity to amplitude, and an amplitude above 0.

    `rough` returns mu_macro of any shape.  `exact` returns mu_macro and its error estimate, shape
    (2, n).
    """

    rough: Callable[[np.ndarray, np.ndarray], np.ndarray]
    exact: Callable[[np.ndarray, np.ndarray], np.ndarray]


def _map_model(dataset: Any, motion: str, poisson: float | None) -> Model:
    """Friction interpolated in the dataset of a sweep; see datasets.accessor."""
    from xarray import DataArray

    source = FrictionMap(dataset, motion)
    axes = [dataset[name].values for name in ("velocity", "amplitude")]
    ends = [(float(axis[axis > 0.0].min()), float(axis.max())) for axis in axes]

    def answer(velocity: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        points = (DataArray(part.ravel(), dims="row") for part in (velocity, amplitude))
        return np.stack(source.at(next(points), next(points), poisson))

    def rough(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        velocity, amplitude = np.broadcast_arrays(ratio * amplitude, amplitude)
        within = [
            np.clip(part, *pair) for part, pair in zip((velocity, amplitude), ends, strict=True)
        ]
        return answer(*within)[0].reshape(amplitude.shape)

    def exact(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        problem = "does not contain the rows at the best fit"
        try:
            values = answer(ratio * amplitude, amplitude)
        except ValueError as error:
            raise InputError("map", motion, f"{problem}: {error}") from None
        if not np.isfinite(values).all():
            raise InputError("map", motion, problem)
        return values

    return Model(rough, exact)


def _solver_model(rows: Rows, motion: str, poisson: float, tolerance: float) -> Model:
    """Friction from the solver, and a coarse map over ln amplitude and ln ratio."""
    from scipy.interpolate import RectBivariateSpline

    if len(rows.value) > MOST_SOLVED:
        allowed = f"rows; allowed are at most {MOST_SOLVED}, or any number with a map"
        raise InputError("measured", len(rows.value), allowed)

    @cache
    def point(ratio: float, amplitude: float) -> tuple[float, float]:
        return _solution(motion, ratio, amplitude, poisson=poisson, tolerance=tolerance)

    moving = np.clip(rows.ratio, SLOWEST, FASTEST)
    spans = (LEAST, MOST), (moving.min(), moving.max())
    axes = []
    for (low, high), a_decade in zip(np.log(spans) + [-0.1, 0.1], NODES_A_DECADE, strict=True):
        count = max(4, 1 + math.ceil((high - low) / math.log(10.0) * a_decade))
        axes.append(np.linspace(low, high, count))
    nodes = [
        [_solution(motion, r, a, **COARSE)[0] for r in np.exp(axes[1])] for a in np.exp(axes[0])
    ]
    spline = RectBivariateSpline(*axes, np.array(nodes), s=0)

    def rough(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        size = np.log(np.clip(amplitude, LEAST, MOST))
        return spline(size, np.log(np.clip(ratio, SLOWEST, FASTEST)), grid=False)

    def exact(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        return np.array([point(*pair) for pair in zip(ratio, amplitude, strict=True)]).T

    return Model(rough, exact)


def _solution(motion: str, ratio: float, amplitude: float, **settings: Any) -> tuple[float, float]:
    """mu_macro and its error estimate from the solver."""
    velocity = min(ratio * amplitude, LARGEST["velocity"])
    result = solve(motion, velocity, min(amplitude, LARGEST["amplitude"]), **settings)
    if not np.isfinite(result.mu_macro):
        where = f"velocity {velocity:.3g} and amplitude {amplitude:.3g}"
        problem = f"no answer at {where}: {result.reason}"
        raise InputError("tolerance", settings["tolerance"], problem)
    return result.mu_macro, result.mu_macro_error


class Profile:
    """Sum of squares as a function of x = ln u_lim at the mean load.

    Attributes
    ----------
    x : np.ndarray, shape (NODES,)
        Tabulated values of ln u_lim.
    macro : scipy.interpolate.CubicSpline
        mu_macro of the rows as a function of x.
    y, weight : np.ndarray, shape (n,)
        Measured values, and values of the model at mu = mu_macro = 1, divided by the errors.
    """

    def __init__(self, rows: Rows, x: np.ndarray, ratios: np.ndarray):
        from scipy.interpolate import CubicSpline

        self.error = (
            rows.error if rows.has_errors else np.full_like(rows.value, np.abs(rows.value).max())
        )
        self.x, self.ratios, self.macro = x, ratios, CubicSpline(x, ratios)
        self.y, self.weight = rows.value / self.error, rows.weight / self.error

    def mu(self, macro: np.ndarray) -> Any:
        """The best mu for mu_macro of the rows, shape (..., n)."""
        slope = self.weight * macro
        tiny = np.finfo(float).tiny
        mu = slope @ self.y / np.maximum((slope * slope).sum(axis=-1), tiny)
        return np.clip(mu, SMALLEST_MU, INPUTS["mu"].high)

    def squares(self, macro: np.ndarray, mu: Any) -> Any:
        return ((self.y - np.asarray(mu)[..., None] * self.weight * macro) ** 2).sum(axis=-1)

    def at(self, x: float) -> float:
        """Least sum of squares for this ln u_lim."""
        macro = self.macro(x)
        return float(self.squares(macro, self.mu(macro)))

    def minima(self, mu_of: Callable[[Any], Any] | None = None) -> list[tuple[float, float]]:
        """Local minima (sum of squares, x), the least one first.

        mu_of: mu as a function of x; by default the best one.
        """
        from scipy.optimize import minimize_scalar

        def squares(x: Any, macro: np.ndarray) -> Any:
            return self.squares(macro, self.mu(macro) if mu_of is None else mu_of(x))

        sums = squares(self.x, self.ratios)
        padded = np.pad(sums, 1, constant_values=np.inf)
        lowest = np.flatnonzero((sums <= padded[:-2]) & (sums <= padded[2:]))
        order = lowest[np.argsort(sums[lowest], kind="stable")]
        out = []
        for k in map(int, order[: 3 if mu_of is None else 1]):
            bounds = self.x[max(k - 1, 0)], self.x[min(k + 1, len(self.x) - 1)]
            best = minimize_scalar(
                lambda x: float(squares(x, self.macro(x))),
                bounds=bounds,
                method="bounded",
                options={"xatol": 1e-9},
            )
            out.append(min((float(best.fun), float(best.x)), (float(sums[k]), float(self.x[k]))))
        return sorted(out)


def _best(rows: Rows, model: Model) -> tuple[Profile, float, np.ndarray, list[tuple[float, float]]]:
    """The profile, ln u_lim of the best fit, errors of mu_macro, and other minima."""
    moving = rows.amplitude > 0.0
    sizes, ratio = rows.sizes[moving], rows.ratio[moving]
    x = np.linspace(math.log(sizes.min() / MOST), math.log(sizes.max() / LEAST), NODES)
    ratios, errors = np.ones((NODES, len(moving))), np.zeros(len(moving))
    ratios[:, moving] = model.rough(ratio, sizes / np.exp(x[:, None]))
    profile = Profile(rows, x, ratios)
    (_, at), *others = profile.minima()
    for _ in range(MOST_PASSES):
        last = at, profile.mu(profile.macro(at))
        macro, errors[moving] = model.exact(ratio, sizes / math.exp(at))
        ratios = profile.ratios.copy()
        ratios[:, moving] += macro - profile.macro(at)[moving]
        profile = Profile(rows, x, ratios)
        at = profile.minima()[0][1]
        change = at - last[0], math.log(profile.mu(profile.macro(at)) / last[1])
        if max(map(abs, change)) <= SETTLED:
            break
    return profile, at, errors, others


def _end(excess: Callable[[float], float], start: float, bound: float) -> float:
    """The end of an interval between its inside and a bound; infinite if the bound is inside."""
    from scipy.optimize import brentq

    inner = start
    for outer in start + (bound - start) * np.geomspace(1e-3, 1.0, 25):
        if excess(outer) > 0.0:
            return float(brentq(excess, inner, outer, xtol=1e-7))
        inner = outer
    return math.copysign(math.inf, bound - start)


def _concluded(
    rows: Rows,
    model: Model,
    profile: Profile,
    at: float,
    errors: np.ndarray,
    others: list[tuple[float, float]],
    *,
    motion: str,
    level: float,
    bodies: Bodies | None,
    texts: dict[str, str],
) -> Fit:
    """Intervals, warnings and the rows of a fit.  Raises InputError if the rows do not determine
    mu."""
    from scipy.stats import chi2, f

    macro, free = profile.macro(at), len(rows.value) - 2
    mu, squares = float(profile.mu(macro)), profile.at(at)
    off = mu * profile.weight * errors
    noise = chi2.ppf(level, 1) if rows.has_errors else f.ppf(level, 1, free) * squares / free
    least = 1e-12 * float(profile.y @ profile.y)  # rounding errors
    allowed = max(float(noise), float(np.mean(off**2)), least) + squares
    unit = 1.0 if bodies is None else bodies.contact(1.0, 1.0, rows.mean_load).u_lim
    modulus = 1.5 * (math.log(mu * unit) - at)  # ln G: u_lim = mu unit G^(-2/3)
    x = profile.x
    excesses = {
        "mu": lambda t: profile.minima(lambda x: np.full_like(x, math.exp(t)))[0][0] - allowed,
        "u_lim": lambda t: profile.at(t) - allowed,
        "shear_modulus": lambda t: (
            profile.minima(
                lambda x: np.clip(np.exp(x + t / 1.5) / unit, SMALLEST_MU, INPUTS["mu"].high)
            )[0][0]
            - allowed
        ),
    }
    reach = {
        "mu": (math.log(mu), math.log(SMALLEST_MU), math.log(INPUTS["mu"].high)),
        "u_lim": (at, x[0], x[-1]),
        "shear_modulus": (
            modulus,
            modulus - 1.5 * (x[-1] - at) - 3.0,
            modulus + 1.5 * (at - x[0]) + 3.0,
        ),
    }
    scale = "u_lim" if bodies is None else "shear_modulus"
    names = dict.fromkeys(("mu", "u_lim", scale))
    ends = {n: [_end(excesses[n], reach[n][0], bound) for bound in reach[n][1:]] for n in names}
    if bodies is not None:  # an open end of u_lim is one of the shear modulus
        opposite = (-one if math.isinf(one) else None for one in ends["u_lim"][::-1])
        pairs = zip(ends[scale], opposite, strict=True)
        ends[scale] = [own if other is None else other for own, other in pairs]
    determined = np.isfinite(ends["u_lim"]).all()
    told = ("mu", scale) if determined else ("mu",)
    slopes = mu * np.stack([macro, profile.macro(at, 1)], axis=1) * profile.weight[:, None]
    shift = {"mu": np.zeros(len(off)), "u_lim": np.zeros(len(off))}
    shift |= zip(told, np.linalg.pinv(slopes[:, : len(told)]), strict=False)
    if determined:
        shift["u_lim"] = np.linalg.pinv(slopes)[1]
    shift["shear_modulus"] = 1.5 * (shift["mu"] - shift["u_lim"]) if determined else 0.0 * off
    shares = {name: float(np.abs(one) @ off) for name, one in shift.items()}
    intervals = {n: (low - shares[n], high + shares[n]) for n, (low, high) in ends.items()}
    low, high = (math.exp(min(end, 700.0)) for end in intervals["mu"])
    if not high < WIDEST_MU * low:
        problem = f"mu from {low:.3g} to {high:.3g} fits as well with another u_lim"
        hint = "add rows without vibration, or rows where vibration reduces friction more"
        message = f"the rows determine neither number: {problem}; {hint}"
        raise InputError("measured", rows.name, message)
    numbers: dict[str, float | None] = {}
    for name, end in (("mu", ""), ("u_lim", "_m"), ("shear_modulus", "_Pa")):
        value = name in intervals and (name == "mu" or determined)
        numbers[f"{name}{end}"] = math.exp(reach[name][0]) if value else None
        for side, one in zip(("low", "high"), intervals.get(name, (math.inf,) * 2), strict=True):
            numbers[f"{name}_{side}{end}"] = math.exp(one) if math.isfinite(one) else None
    chance = float(chi2.sf(squares, free)) if rows.has_errors and free else None
    sigma = profile.error if rows.has_errors else profile.error * math.sqrt(squares / free)
    fitted = mu * rows.weight * macro
    share = (rows.load / rows.mean_load) ** (2.0 / 3.0)
    warnings = _warnings(rows, motion, bodies, mu, modulus)
    if chance is not None and chance < UNLIKELY:
        problem = f"the residuals are larger than the errors of the rows allow (p = {chance:.1g})"
        doubt = "the theory does not describe these rows, or the errors are too small"
        warnings.insert(0, f"{problem}: {doubt}")
    for one, other in others if determined else ():
        if one < allowed and abs(other - at) > math.log(2.0):
            second = float(profile.mu(profile.macro(other)))
            text = f"{math.exp(other):.3g} m"
            if bodies is not None:
                text = f"{(second * unit / math.exp(other)) ** 1.5:.3g} Pa"
            warnings.append(f"mu {second:.3g} with {text} fits nearly as well: two answers")
    return Fit(
        motion=motion,
        quantity=rows.quantity,
        **numbers,  # type: ignore[arg-type]
        load_N=rows.mean_load,
        confidence=level,
        mu_model_share=math.expm1(shares["mu"]),
        scale_model_share=math.expm1(shares[scale]),
        standard_error=None if rows.has_errors else float(sigma[0]),
        chi_square=squares if rows.has_errors else None,
        p_value=chance,
        degrees_of_freedom=free,
        told=told,
        reason="" if determined else _open(scale, intervals[scale]),
        warnings=tuple(warnings),
        understood=texts,
        labels=rows.labels,
        left_out=rows.left_out,
        speed_m_s=rows.speed,
        amplitude_si=rows.amplitude,
        frequency_Hz=rows.frequency,
        row_load_N=rows.load,
        velocity=rows.speed / (2.0 * math.pi * rows.frequency * math.exp(at) * share),
        amplitude=rows.sizes / math.exp(at),
        measured=rows.value,
        measured_error=rows.error,
        fitted=fitted,
        fitted_error=mu * rows.weight * errors,
        residual=np.divide(rows.value - fitted, sigma, out=0.0 * fitted, where=sigma > 0.0),
        curve=_curve(rows, model, mu, at, macro, errors),
    )


def _open(scale: str, interval: tuple[float, float]) -> str:
    """The reason why the rows do not determine the second unknown."""
    low, high = interval
    unit, which = {"u_lim": "m", "shear_modulus": "Pa"}[scale], f"any {scale.replace('_m', ' m')}"
    if math.isfinite(low):
        which += f" above {math.exp(low):.3g} {unit}"
    elif math.isfinite(high):
        which += f" below {math.exp(high):.3g} {unit}"
    return f"the rows determine mu alone: {which} fits them as well"


def _warnings(
    rows: Rows, motion: str, bodies: Bodies | None, mu: float, modulus: float
) -> list[str]:
    """Assumptions of the theory that do not hold at the best fit."""
    if bodies is None:
        return broken_rules({"mu": mu})
    k = int(np.argmax(rows.amplitude))
    speed, amplitude, frequency = (
        float(one[k]) for one in (rows.speed, rows.amplitude, rows.frequency)
    )
    moving = {"speed": speed, "amplitude": amplitude, "frequency": frequency}
    given = bodies.inputs(mu, math.exp(modulus), rows.mean_load)
    return warnings_of(contact_of(read_inputs(motion, **given, **moving)), speed)


def abscissa(conditions: Mapping[str, np.ndarray]) -> str:
    """Name of the condition with the most distinct values; the first one of several."""
    return max(conditions, key=lambda name: len(np.unique(conditions[name])))


def _curve(
    rows: Rows, model: Model, mu: float, at: float, macro: np.ndarray, errors: np.ndarray
) -> dict[str, np.ndarray]:
    """Friction of the model between rows that differ in the abscissa only, one curve after another.

    The correction of the coarse map at the rows is interpolated.
    """
    names = ("speed", "amplitude", "load", "frequency")
    columns = {name: getattr(rows, name) for name in names}
    along = abscissa(columns)
    others = np.stack([values for name, values in columns.items() if name != along], axis=1)
    _, which = np.unique(others, axis=0, return_inverse=True)

    def rough(part: Rows) -> np.ndarray:
        moving, out = part.amplitude > 0.0, np.ones(len(part.amplitude))
        sizes = part.amplitude / (part.load / rows.mean_load) ** (2.0 / 3.0) / math.exp(at)
        out[moving] = model.rough(part.ratio[moving], sizes[moving])
        return out

    correction, parts = macro - rough(rows), [np.empty((6, 0))]
    for curve in np.unique(which):
        members = np.flatnonzero(which.reshape(-1) == curve)
        values, first = np.unique(columns[along][members], return_index=True)
        if len(values) < 2:
            continue
        least = values[values > 0.0][0]
        pieces = np.linspace(values[0], values[-1], PIECES), np.geomspace(least, values[-1], PIECES)
        axis = np.unique(np.clip(np.concatenate([values, *pieces]), values[0], values[-1]))
        fine = {name: np.full(len(axis), one[members[0]]) for name, one in columns.items()}
        part = replace(rows, **fine | {along: axis})
        more, error = (np.interp(axis, values, one[members[first]]) for one in (correction, errors))
        factor = mu * (part.load if rows.quantity == "friction" else 1.0)
        friction = [factor * (rough(part) + more), factor * error]
        parts.append(np.stack([part.speed, part.amplitude, part.frequency, part.load, *friction]))
    titles = ("speed_m_s", "amplitude_si", "frequency_Hz", "row_load_N", "fitted", "fitted_error")
    return dict(zip(titles, np.concatenate(parts, axis=1), strict=True))
