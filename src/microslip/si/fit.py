"""Fit mu, and u_lim or the shear modulus, to friction measured under vibration.

The model is: measured value = mu * weight * mu_macro + error.  The ratio of velocity to amplitude
does not depend on u_lim, so mu_macro of a row is a function of ln u_lim alone, and the model is
linear in mu.  For each u_lim, mu follows by linear least squares.

The confidence region contains the pairs (u_lim, mu) whose sum of squares is at most a threshold.
The threshold is the least sum plus a quantile. If the rows have errors, this is a quantile of the
chi-square distribution. Otherwise, it is a quantile of the F distribution times the mean square
residual.  For each u_lim, the region is an interval of mu, because the sum is quadratic in mu.  The
interval of a parameter is its range in the region, as in a profile likelihood.  It does not depend
on the parametrisation, and may be infinite on one side.

Without a map, the solver computes a coarse map first.  It gives the change of friction between two
guesses.  The rows are then solved at the best guess, which corrects the map there.  At the end, the
remaining error of the coarse map is of second order.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.answer.point import solve
from microslip.foundation.arguments import LARGEST, SMALLEST_TOLERANCE
from microslip.foundation.csv_table import LABELS, source_name, table_of
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import prefixed, prefixed_text
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, Input, read_input, read_inputs, read_quantity
from microslip.si.map import FrictionMap
from microslip.si.output import column, line
from microslip.si.warnings import broken_rules, warnings_of

if TYPE_CHECKING:
    import xarray as xr

MOTIONS = ("transverse", "longitudinal", "zigzag")
CONDITIONS = ("speed", "amplitude", "load", "frequency")
COLUMNS = {name: INPUTS[name]._replace(exact=True) for name in CONDITIONS}
for _name, _unit in (("friction", "N"), ("mu", "")):
    COLUMNS[_name] = Input("", _unit, "", -math.inf, exact=True)
    COLUMNS[f"{_name}_error"] = Input("", _unit, "", exact=True)
UNITS = {name: one.unit or "" for name, one in COLUMNS.items()}
"""SI units of the allowed columns."""
PARAMETERS = {"mu": "", "u_lim": "m", "shear_modulus": "Pa"}
"""SI units of the parameters."""
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
REGION = 801
"""Number of values of ln u_lim in the confidence region."""
PIECES = 60
"""Number of linearly and of logarithmically spaced points on a curve of the figure."""
ROW_UNITS = {"_Pa": "Pa", "_m_s": "m s-1", "_Hz": "Hz", "_N": "N", "_m": "m", "_si": "m"}
"""Units in a dataset, by the end of a name."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Coefficient of friction and u_lim of a contact, from measured friction.

    An interval includes the scatter of the rows at a confidence level, and the model's error
    estimate, which is not random.  Ends that the rows do not determine are None.  The names in
    `values` and `rows` are attributes of the fit, too: `fit.mu`, `fit.residual`.

    Attributes
    ----------
    values : dict
        Numbers and texts by name, in the order of `to_dict`; the page docs/reference/fields.md
        explains them.  u_lim_m, for example, is u_lim in m, and `told` contains the names of the
        parameters that the rows determine.
    rows : dict of np.ndarray, shape (n,)
        Conditions, measured and fitted values of each row.
    curve : dict of np.ndarray
        Conditions, friction of the model and error estimate between the rows, for the figure.
    labels : dict of list
        Text columns of the table, by name.
    """

    values: dict[str, Any]
    rows: dict[str, np.ndarray] = field(repr=False)
    curve: dict[str, np.ndarray] = field(repr=False)
    labels: dict[str, list] = field(repr=False)

    def __getattr__(self, name: str) -> Any:
        tables = self.__dict__.get("values", {}) | self.__dict__.get("rows", {})
        if name not in tables:
            raise AttributeError(name)
        return tables[name]

    def __str__(self) -> str:
        """The lines that `microslip fit` prints."""
        kind = (
            "the friction force" if self.quantity == "friction" else "the coefficient of friction"
        )
        lines = [line(name.replace("_", " "), text) for name, text in self.understood.items()]
        load = prefixed_text(self.load_N, "N")
        lines += [line("rows", f"{len(self.measured)}, of {kind}; mean load {load}"), ""]
        for name, unit in PARAMETERS.items():
            ends = [self.values[column(name, unit, part)] for part in ("value", "low", "high")]
            if ends[0] is not None:
                value, low, high = (_digits(end, unit, 4) for end in ends)
                lines.append(line(_title(name), f"{value}, from {low} to {high}"))
        shares = zip(self.told, (self.mu_model_share, self.scale_model_share), strict=False)
        model = ", ".join(f"of {_title(n)} {_digits(100.0 * x, '', 2)} %" for n, x in shares)
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
        """Return the values, labels and rows of the fit. Arrays and tuples become lists."""
        values = {n: list(x) if isinstance(x, tuple) else x for n, x in self.values.items()}
        rows = {name: array.tolist() for name, array in self.rows.items()}
        return values | {"labels": self.labels} | rows

    def to_xarray(self) -> xr.Dataset:
        """The fit as a dataset.  Row data have the dimension `row`, the curve `curve_point`, and
        numbers no dimension.  Texts are attributes."""
        import xarray as xr

        values = dict(self.values)
        texts = {"understood": "; ".join(f"{n}: {x}" for n, x in values.pop("understood").items())}
        texts |= {n: x for n, x in values.items() if isinstance(x, str)}
        texts |= {n: "; ".join(x) for n, x in values.items() if isinstance(x, tuple)}
        variables: dict[str, tuple] = {n: ("row", cells) for n, cells in self.labels.items()}
        numbers = {n: x for n, x in values.items() if n not in texts}
        variables |= {n: ((), np.nan if x is None else x) for n, x in numbers.items()}
        variables |= {name: ("row", x) for name, x in self.rows.items()}
        variables |= {f"curve_{name}": ("curve_point", x) for name, x in self.curve.items()}
        friction = dict.fromkeys(("measured", "fitted", "d_error"), UNITS[self.quantity] or "1")
        dataset = xr.Dataset(variables, attrs=texts)
        for name in variables.keys() - self.labels.keys():
            units = (one for end, one in (ROW_UNITS | friction).items() if name.endswith(end))
            dataset[name].attrs["units"] = next(units, "1")
        return dataset


def _title(name: str) -> str:
    return name.replace("shear_m", "shear m")


def _digits(value: float | None, unit: str, count: int) -> str:
    """Format a number with `count` significant digits and a metric prefix of the unit."""
    if not value:
        return "open" if value is None else f"0 {unit}".strip()
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
    shared = {"speed": speed, "amplitude": amplitude, "load": load, "frequency": frequency}
    rows = _read_rows(measured, shared, decimal=decimal, encoding=encoding)
    bodies, texts = _read_bodies(nu, radius, counterbody)
    level = CONFIDENCE
    if confidence is not None:
        level = read_quantity("confidence", confidence, Input("", "", "", exact=True)).si
    if level >= 1.0:
        allowed = "allowed is a number above 0 and below 1, such as 0.95 or '95 %'"
        raise InputError("confidence", confidence, allowed)
    if map is not None:
        model = _map_model(map, motion, bodies.poisson)
    else:
        limits = Input("", "", "", SMALLEST_TOLERANCE, LARGEST_TOLERANCE, True, True)
        accepted = TOLERANCE if tolerance is None else tolerance
        accuracy = read_quantity("tolerance", accepted, limits).si
        model = _solver_model(rows, motion, bodies.poisson or 0.0, accuracy)
    return _fitted(rows, model, bodies, level, {"motion": motion} | texts)


# Rows and bodies


@dataclass(eq=False)
class Rows:
    """Measurements.

    Attributes
    ----------
    conditions : dict of str to np.ndarray, shape (n,)
        Speed, amplitude, load and frequency in SI units.
    value, error : np.ndarray, shape (n,)
        Measured values and standard errors, N or dimensionless.  An unknown error is NaN.
    quantity : str
        "friction" or "mu".
    texts, labels, left_out, name
        Common conditions as text, columns of labels, messages about unreadable lines, and the name
        of the table.
    """

    conditions: dict[str, np.ndarray]
    value: np.ndarray
    error: np.ndarray
    quantity: str
    texts: dict
    labels: dict
    left_out: tuple
    name: str | list

    def __post_init__(self) -> None:
        self.has_errors = bool(np.isfinite(self.error).all())
        self.mean_load = float(self.conditions["load"].mean())
        self.ratio, self.sizes = self.groups(self.conditions)
        self.weight = self.factor(self.conditions["load"])

    def factor(self, load: np.ndarray) -> np.ndarray:
        """Factor that converts a coefficient of friction to the measured quantity."""
        return load if self.quantity == "friction" else np.ones_like(load)

    def groups(self, conditions: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Ratio of velocity to amplitude, dimensionless, and the amplitude in m divided by (load /
        mean load)^(2/3)."""
        speed, amplitude, load, frequency = (conditions[name] for name in CONDITIONS)
        travel = 2.0 * math.pi * frequency * amplitude
        fast = np.full_like(travel, FASTEST)  # without vibration, the velocity has no effect
        ratio = np.divide(speed, travel, out=fast, where=travel > 0.0)
        return ratio, amplitude / (load / self.mean_load) ** (2.0 / 3.0)


def _read_rows(source: Any, shared: dict[str, Any], **form: str) -> Rows:
    """Read and check the rows of a file or of a table of columns.  Raises InputError."""
    table = table_of("measured", source, UNITS, need_units=True, **form)
    name, errors = source_name(source), dict(table.errors)

    def refuse(wrong: object, text: str) -> None:
        if wrong:
            raise InputError("measured", name, text)

    names = [one for one in table.cells if one not in LABELS]
    unknown = [repr(one) for one in names if one not in UNITS] or ["nothing"] * (not names)
    what, other = ("friction", "mu") if "friction" in names else ("mu", "friction")
    refuse(unknown, f"a column {''.join(unknown[:1])}; allowed are some of {', '.join(UNITS)}")
    refuse(len({*map(len, table.cells.values())}) > 1, "columns of several lengths; allowed is one")
    refuse(what not in names, "has neither friction nor mu; allowed is one of them")
    refuse(other in names, "has both friction and mu; allowed is one of them")
    refuse(f"{other}_error" in names, f"has {other}_error without {other}")
    columns, kept = table.columns, {}
    for k, cells in enumerate(zip(*(columns[one] for one in names), strict=True)):
        if k in errors or all(cell is None for cell in cells):
            continue
        try:
            kept[k] = [_number(*pair) for pair in zip(names, cells, strict=True)]
        except InputError as error:
            if not table.lines:
                allowed = f"{error.allowed}, in row {k + 1}"
                raise InputError(error.argument, error.value, allowed) from None
            problem = f"{error.argument} is {error.allowed}" if error.value is None else error
            errors[k] = f"line {table.lines[k]}: {problem}"
    count, left_out = len(kept), tuple(errors[k] for k in sorted(errors))
    refuse(not kept, (*left_out, "no rows; allowed is a row for each measurement")[0])
    numbers, texts = dict(zip(names, np.array(list(kept.values())).T, strict=True)), {}
    for one, value in shared.items():
        if (one in names) == (value is not None):
            where = "both a column and an argument" if one in names else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(one, value, allowed)
        if one not in names:
            quantity = read_input(one, value)
            numbers[one], texts[one] = np.full(count, quantity.si), quantity.text
    conditions, value = {one: numbers[one] for one in CONDITIONS}, numbers[what]
    sigma = numbers.get(f"{what}_error", np.full(count, np.nan))
    least = 2 if f"{what}_error" in names else 3
    more = ", or two with errors of their own" if least == 3 else ""
    negative, positive = (value < 0.0).sum(), (value > 0.0).any()
    sign = f"{what} is negative in {negative} of {count} rows, and above 0 in none; allowed is a "
    still, same = (
        not conditions["amplitude"].any(),
        len(np.unique([*conditions.values()], axis=1).T),
    )
    refuse(count > MOST_ROWS, f"{count} rows; allowed are at most {MOST_ROWS} rows")
    refuse(still, "no row with an amplitude above 0, so that nothing vibrates")
    refuse(count < least, f"{count} rows; two numbers take at least {least}{more}")
    refuse(negative and not positive, f"{sign}positive sign for a force against the motion")
    refuse(not positive, f"the rows determine neither number: {what} is 0 in all rows")
    refuse(same < 2, "all rows are of one condition; allowed: two or more conditions")
    labels = {n: [cells[k] for k in kept] for n, cells in table.labels.items()}
    return Rows(conditions, value, sigma, what, texts, labels, left_out, name)


def _number(name: str, cell: object) -> float:
    if cell is None:
        allowed = "empty; allowed: a number in every row; leave out the row, or fill the cell"
        raise InputError(name, None, allowed)
    return read_quantity(name, cell, COLUMNS[name]).si


class Bodies(NamedTuple):
    """Poisson's ratio, and the radius and the counterbody of a fit of the shear modulus; None if
    they are unknown."""

    poisson: float | None
    radius: float | None = None
    counterbody: object = None

    def contact(
        self, mu: float, modulus: float, load: float, motion: str | None = None, **moving: float
    ) -> Contact:
        """The contact of bodies with this shear modulus, Pa, at rest or in a motion."""
        assert self.poisson is not None
        young = 2.0 * modulus * (1.0 + self.poisson)
        other = (young, self.poisson) if self.counterbody == "same" else None
        bodies = {"young": young, "nu": self.poisson, "counterbody": other, "radius": self.radius}
        inputs = read_inputs(motion, load=load, mu=mu, **bodies, **moving)
        return contact_of(inputs) if motion else Contact(inputs)


def _read_bodies(nu: object, radius: object, counterbody: object) -> tuple[Bodies, dict[str, str]]:
    """The bodies, and their properties as text.  Raises InputError."""
    ratio = None if nu is None else read_input("nu", nu)
    texts = {} if ratio is None else {"nu": ratio.text}
    if radius is None:
        if counterbody is not None:
            raise InputError("counterbody", counterbody, "allowed with a radius")
        return Bodies(None if ratio is None else ratio.si), texts
    if ratio is None:
        raise InputError("nu", None, "needed with a radius")
    if counterbody not in (None, "rigid", "same"):
        raise InputError("counterbody", counterbody, "allowed is rigid or same")
    size = read_input("radius", radius)
    texts |= {"counterbody": str(counterbody or "rigid (default)"), "radius": size.text}
    return Bodies(ratio.si, size.si, counterbody), texts


# Friction


class Model(NamedTuple):
    """Friction of points with a ratio of velocity to amplitude, and an amplitude above 0.

    `rough` returns mu_macro of any shape.  `exact` returns mu_macro and its error estimate, shape
    (2, n).
    """

    rough: Callable[[np.ndarray, np.ndarray], np.ndarray]
    exact: Callable[[np.ndarray, np.ndarray], np.ndarray]

    def row_curves(self, ratio: np.ndarray, sizes: np.ndarray, x: Any) -> np.ndarray:
        """mu_macro of rows at values x of ln u_lim, which have a shape (..., 1)."""
        still = sizes == 0.0
        return np.where(still, 1.0, self.rough(ratio, np.where(still, 1.0, sizes) / np.exp(x)))


def _map_model(dataset: Any, motion: str, poisson: float | None) -> Model:
    """Friction interpolated in the dataset of a sweep; see datasets.accessor."""
    source = FrictionMap(dataset, motion)
    from xarray import DataArray

    axes = [dataset[name].values for name in ("velocity", "amplitude")]
    ends = [(float(axis[axis > 0.0].min()), float(axis.max())) for axis in axes]

    def answer(*point: np.ndarray) -> np.ndarray:
        velocity, amplitude = (DataArray(part.ravel(), dims="row") for part in point)
        return np.stack(source.at(velocity, amplitude, poisson))

    def rough(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        point = np.broadcast_arrays(ratio * amplitude, amplitude)
        within = [np.clip(part, *pair) for part, pair in zip(point, ends, strict=True)]
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
    if len(rows.value) > MOST_SOLVED:
        allowed = f"rows; allowed are at most {MOST_SOLVED}, or any number with a map"
        raise InputError("measured", len(rows.value), allowed)
    from scipy.interpolate import RectBivariateSpline

    @cache
    def point(ratio: float, amplitude: float, **settings: Any) -> tuple[float, float]:
        velocity = min(ratio * amplitude, LARGEST["velocity"])
        result = solve(motion, velocity, min(amplitude, LARGEST["amplitude"]), **settings)
        if not np.isfinite(result.mu_macro):
            where = f"velocity {velocity:.3g} and amplitude {amplitude:.3g}"
            problem = f"no answer at {where}: {result.reason}"
            raise InputError("tolerance", settings["tolerance"], problem)
        return result.mu_macro, result.mu_macro_error

    ratio = np.clip(rows.ratio, SLOWEST, FASTEST)
    spans, axes = np.log([(LEAST, MOST), (ratio.min(), ratio.max())]) + [-0.1, 0.1], []
    for (low, high), a_decade in zip(spans, NODES_A_DECADE, strict=True):
        count = max(4, 1 + math.ceil((high - low) / math.log(10.0) * a_decade))
        axes.append(np.linspace(low, high, count))
    nodes = [[point(r, a, **COARSE)[0] for r in np.exp(axes[1])] for a in np.exp(axes[0])]
    spline = RectBivariateSpline(*axes, np.array(nodes), s=0)

    def rough(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        size = np.log(np.clip(amplitude, LEAST, MOST))
        return spline(size, np.log(np.clip(ratio, SLOWEST, FASTEST)), grid=False)

    def exact(ratio: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        settings = {"poisson": poisson, "tolerance": tolerance}
        return np.array([point(*one, **settings) for one in zip(ratio, amplitude, strict=True)]).T

    return Model(rough, exact)


# Sum of squares


class Profile:
    """Sum of squares as a function of mu and x = ln u_lim at the mean load.

    Attributes
    ----------
    x, sums : np.ndarray, shape (NODES,)
        Tabulated values of ln u_lim, and the least sums of squares there.
    macro : scipy.interpolate.CubicSpline
        mu_macro of the rows as a function of x.
    error, y, weight : np.ndarray, shape (n,)
        Errors of the rows; measured values, and values of the model at mu = mu_macro = 1, both
        divided by the errors.
    best : float
        x with the least sum of squares.
    """

    def __init__(self, rows: Rows, x: np.ndarray, ratios: np.ndarray):
        from scipy.interpolate import CubicSpline
        from scipy.optimize import minimize_scalar

        scale = np.full_like(rows.value, np.abs(rows.value).max())
        self.error = rows.error if rows.has_errors else scale
        self.x, self.macro = x, CubicSpline(x, ratios)
        self.y, self.weight = rows.value / self.error, rows.weight / self.error
        self.sums = self.mu(x)[1]
        k = int(np.argmin(self.sums))
        bounds = x[max(k - 1, 0)], x[min(k + 1, NODES - 1)]
        least = minimize_scalar(
            lambda one: self.mu(one)[1], bounds=bounds, method="bounded", options={"xatol": 1e-9}
        )
        self.best = float(least.x if least.fun < self.sums[k] else x[k])

    def mu(self, x: Any) -> tuple[Any, Any, Any]:
        """The best mu at x, the least sum of squares, and half of its second derivative by mu."""
        slope = self.weight * self.macro(x)
        norm = np.maximum((slope * slope).sum(axis=-1), np.finfo(float).tiny)
        mu = np.clip(slope @ self.y / norm, SMALLEST_MU, INPUTS["mu"].high)
        return mu, ((self.y - mu[..., None] * slope) ** 2).sum(axis=-1), norm

    def ends(self, allowed: float) -> list[float]:
        """Ends of the interval around the best x in which the sum of squares is at most `allowed`.
        An end is infinite if the interval reaches the end of the table."""
        from scipy.optimize import brentq

        ends = []
        for side in (-1.0, 1.0):
            beyond = side * (self.x - self.best) > 0.0
            nodes, sums = ((one[beyond])[:: int(side)] for one in (self.x, self.sums))
            end, above = side * math.inf, np.flatnonzero(sums > allowed)
            if len(above):
                inner = nodes[above[0] - 1] if above[0] else self.best
                excess = lambda one: float(self.mu(one)[1]) - allowed  # noqa: E731
                end = float(brentq(excess, inner, nodes[above[0]], xtol=1e-7))
            ends.append(end)
        return ends

    def second(self, allowed: float) -> float | None:
        """x of a minimum of at most `allowed` that differs from the best by more than a factor of
        2."""
        sums = np.pad(self.sums, 1, constant_values=np.inf)
        lowest = (self.sums <= sums[:-2]) & (self.sums <= sums[2:]) & (self.sums < allowed)
        lowest &= np.abs(self.x - self.best) > math.log(2.0)
        places = np.flatnonzero(lowest)
        return float(self.x[min(places, key=lambda k: self.sums[k])]) if len(places) else None


def _profile(rows: Rows, model: Model) -> tuple[Profile, np.ndarray]:
    """The profile, and errors of mu_macro."""
    moving = rows.sizes > 0.0
    least, most = rows.sizes[moving].min(), rows.sizes.max()
    x = np.linspace(math.log(least / MOST), math.log(most / LEAST), NODES)
    ratios, errors = model.row_curves(rows.ratio, rows.sizes, x[:, None]), np.zeros(len(moving))
    profile = Profile(rows, x, ratios)
    for _ in range(MOST_PASSES):
        last = profile
        at, mu = last.best, last.mu(last.best)[0]
        macro, errors[moving] = model.exact(rows.ratio[moving], rows.sizes[moving] / math.exp(at))
        ratios[:, moving] += macro - last.macro(at)[moving]
        profile = Profile(rows, x, ratios)
        change = profile.best - at, math.log(profile.mu(profile.best)[0] / mu)
        if max(map(abs, change)) <= SETTLED:
            break
    return profile, errors


def _fitted(rows: Rows, model: Model, bodies: Bodies, level: float, texts: dict[str, str]) -> Fit:
    """The fit at a confidence level.  Raises InputError if the rows do not determine mu."""
    from scipy.stats import chi2, f

    profile, errors = _profile(rows, model)
    at, free = profile.best, len(rows.value) - 2
    macro, weight, errors_known = profile.macro(at), profile.weight, rows.has_errors
    mu, squares = (float(one) for one in profile.mu(at)[:2])
    off = mu * weight * errors
    noise = chi2.ppf(level, 1) if errors_known else f.ppf(level, 1, free) * squares / free
    least = 1e-12 * float(profile.y @ profile.y)  # rounding errors
    allowed = max(float(noise), float(np.mean(off**2)), least) + squares
    # Logarithms of the parameters at the best fit and in the confidence region.  The shear modulus
    # G follows from u_lim = mu unit G^(-2/3).
    u_lim = profile.ends(allowed)
    determined = bool(np.isfinite(u_lim).all())
    x = np.linspace(max(u_lim[0], profile.x[0]), min(u_lim[1], profile.x[-1]), REGION)
    centre, sums, norm = profile.mu(x)
    half = np.sqrt(np.maximum(allowed - sums, 0.0) / norm)
    mus = np.log(np.clip([centre - half, centre + half], SMALLEST_MU, INPUTS["mu"].high))
    logs = {"mu": [math.log(mu), mus.min(), mus.max()], "u_lim": [at, *u_lim]}
    scale, unit = "u_lim", 0.0
    if bodies.radius is not None:
        scale, unit = "shear_modulus", math.log(bodies.contact(1.0, 1.0, rows.mean_load).u_lim)
        moduli = 1.5 * (mus + unit - x)
        low = moduli.min() if u_lim[1] < math.inf else -math.inf
        high = moduli.max() if u_lim[0] > -math.inf else math.inf
        logs[scale] = [1.5 * (math.log(mu) + unit - at), low, high]
    # Largest changes of the logarithms due to errors of the model, to first order.
    told = ("mu", scale) if determined else ("mu",)
    slopes = mu * np.stack([macro, profile.macro(at, 1)], axis=1) * weight[:, None]
    shifts = np.zeros((2, len(off)))
    shifts[: len(told)] = np.linalg.pinv(slopes[:, : len(told)])
    changes = zip(PARAMETERS, (*shifts, 1.5 * (shifts[0] - shifts[1])), strict=True)
    shares = {name: float(np.abs(one) @ off) for name, one in changes}
    ends: dict[str, Any] = {}
    for name, si in PARAMETERS.items():
        middle, low, high = logs.get(name, [math.nan] * 3)
        middle = middle if determined or name == "mu" else math.nan
        parts = {"value": middle, "low": low - shares[name], "high": high + shares[name]}
        for part, end in parts.items():
            known = math.isfinite(end)
            ends[column(name, si, part)] = math.exp(min(end, 700.0)) if known else None
    if not ends["mu_high"] < WIDEST_MU * ends["mu_low"]:
        problem = (
            f"mu from {ends['mu_low']:.3g} to {ends['mu_high']:.3g} fits as well with another "
        )
        problem += (
            "u_lim; add rows without vibration, or rows where vibration reduces friction more"
        )
        raise InputError("measured", rows.name, f"the rows determine neither number: {problem}")
    sigma = profile.error if errors_known else profile.error * math.sqrt(squares / free)
    chance = float(chi2.sf(squares, free)) if errors_known and free else None
    reason, si, doubts = "", PARAMETERS[scale], []
    if not determined:
        which = f"any {_title(scale)}"
        for part, word in (("high", "below"), ("low", "above")):
            if (end := ends[column(scale, si, part)]) is not None:
                which = f"any {_title(scale)} {word} {end:.3g} {si}"
        reason = f"the rows determine mu alone: {which} fits them as well"
    if chance is not None and chance < UNLIKELY:
        problem = f"the residuals are larger than the errors of the rows allow (p = {chance:.1g})"
        doubt = "the theory does not describe these rows, or the errors are too small"
        doubts.append(f"{problem}: {doubt}")
    doubts += _warnings(rows, texts["motion"], bodies, mu, math.exp(logs[scale][0]))
    if determined and (other := profile.second(allowed)) is not None:
        second = float(profile.mu(other)[0])
        size = other if scale == "u_lim" else 1.5 * (math.log(second) + unit - other)
        text = f"mu {second:.3g} with {math.exp(size):.3g} {si}"
        doubts.append(f"{text} fits nearly as well: two answers")
    values = {
        **{"motion": texts["motion"], "quantity": rows.quantity},
        **ends,
        **{"load_N": rows.mean_load, "confidence": level},
        "mu_model_share": math.expm1(shares["mu"]),
        "scale_model_share": math.expm1(shares[scale]),
        "standard_error": None if errors_known else float(sigma[0]),
        "chi_square": squares if errors_known else None,
        **{"p_value": chance, "degrees_of_freedom": free, "told": told, "reason": reason},
        **{"warnings": tuple(doubts), "understood": texts | rows.texts, "left_out": rows.left_out},
    }
    speed, amplitude, load, frequency = rows.conditions.values()
    local = math.exp(at) * (load / rows.mean_load) ** (2.0 / 3.0)
    friction = mu * rows.weight * macro
    rest = rows.value - friction
    columns = {
        **{"speed_m_s": speed, "amplitude_si": amplitude},
        **{"frequency_Hz": frequency, "row_load_N": load},
        "velocity": speed / (2.0 * math.pi * frequency * local),
        "amplitude": amplitude / local,
        **{"measured": rows.value, "measured_error": rows.error},
        **{"fitted": friction, "fitted_error": mu * rows.weight * errors},
        "residual": np.divide(rest, sigma, out=0.0 * rest, where=sigma > 0.0),
    }
    return Fit(values, columns, _curve(rows, model, mu, at, macro, errors), rows.labels)


def _warnings(rows: Rows, motion: str, bodies: Bodies, mu: float, modulus: float) -> list[str]:
    """Assumptions of the theory that do not hold at the best fit."""
    if bodies.radius is None:
        return broken_rules({"mu": mu})
    k = int(np.argmax(rows.conditions["amplitude"]))
    moving = {name: float(rows.conditions[name][k]) for name in CONDITIONS if name != "load"}
    contact = bodies.contact(mu, modulus, rows.mean_load, motion, **moving)
    return warnings_of(contact, moving["speed"])


def _curve(
    rows: Rows, model: Model, mu: float, at: float, macro: np.ndarray, errors: np.ndarray
) -> dict[str, np.ndarray]:
    """Friction of the model between rows that differ in one condition, one curve after another.

    The condition is that with the most distinct values.  The correction of the coarse map at the
    rows is interpolated.
    """
    conditions = rows.conditions
    distinct = {name: len(np.unique(conditions[name])) for name in conditions}
    along = max(distinct, key=lambda name: distinct[name])
    others = np.stack([conditions[name] for name in CONDITIONS if name != along])
    _, which = np.unique(others, axis=1, return_inverse=True)
    correction = macro - model.row_curves(rows.ratio, rows.sizes, at)
    parts = [np.empty((6, 0))]
    for members in (np.flatnonzero(which.ravel() == one) for one in np.unique(which)):
        values, first = np.unique(conditions[along][members], return_index=True)
        if len(values) < 2:
            continue
        least = values[values > 0.0][0]
        pieces = np.linspace(values[0], values[-1], PIECES), np.geomspace(least, values[-1], PIECES)
        axis = np.unique(np.clip(np.concatenate([values, *pieces]), values[0], values[-1]))
        fine = {n: np.full(len(axis), one[members[0]]) for n, one in conditions.items()}
        fine[along] = axis
        more, error = (np.interp(axis, values, one[members[first]]) for one in (correction, errors))
        factor = mu * rows.factor(fine["load"])
        friction = model.row_curves(*rows.groups(fine), at) + more
        parts.append(np.stack([*fine.values(), factor * friction, factor * error]))
    titles = ("speed_m_s", "amplitude_si", "row_load_N", "frequency_Hz", "fitted", "fitted_error")
    return dict(zip(titles, np.concatenate(parts, axis=1), strict=True))
