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
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.answer.point import solve
from microslip.foundation.arguments import LARGEST, SMALLEST_TOLERANCE
from microslip.foundation.csv_table import LABELS, table_of
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
CONDITIONS = ("speed", "amplitude", "load", "frequency")
UNITS = {"speed": "m/s", "amplitude": "m", "frequency": "Hz", "load": "N"}
UNITS |= {"friction": "N", "friction_error": "N", "mu": "", "mu_error": ""}
"""SI units of the allowed columns."""
PARAMETERS = {"mu": ("", ""), "u_lim": ("_m", "m"), "shear_modulus": ("_Pa", "Pa")}
"""For each parameter: the suffix of its name in a Fit, and its SI unit."""
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
REGION, SIDES = 801, np.array([0.0, -1.0, 1.0])
"""Number of values of ln u_lim in the confidence region, and the signs by which errors of the model
shift the value and the ends of an interval."""
PIECES = 60
"""Number of linearly and of logarithmically spaced points on a curve of the figure."""


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
        for table in (self.__dict__.get("values", {}), self.__dict__.get("rows", {})):
            if name in table:
                return table[name]
        raise AttributeError(name)

    def __str__(self) -> str:
        """The lines that `microslip fit` prints."""
        kinds = {"friction": "the friction force", "mu": "the coefficient of friction"}
        unit = UNITS[self.quantity]
        load = prefixed_text(self.load_N, "N")
        lines = [line(name.replace("_", " "), text) for name, text in self.understood.items()]
        text = f"{len(self.measured)}, of {kinds[self.quantity]}; mean load {load}"
        lines += [line("rows", text), ""]
        for name, (suffix, si) in PARAMETERS.items():
            if self.values[f"{name}{suffix}"] is not None:
                ends = [self.values[f"{name}{part}{suffix}"] for part in ("", "_low", "_high")]
                value, low, high = (_digits(end, si, 4) for end in ends)
                lines.append(line(_title(name), f"{value}, from {low} to {high}"))
        shares = zip(self.told, (self.mu_model_share, self.scale_model_share), strict=False)
        model = ", ".join(f"of {_title(n)} {_digits(100.0 * x, '', 2)} %" for n, x in shares)
        text = f"{100.0 * self.confidence:g} %, plus the model error: {model}"
        lines.append(line("intervals", text))
        if self.standard_error is not None:
            lines.append(line("scatter", f"{_digits(self.standard_error, unit, 4)} a row"))
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

        texts = {"understood": "; ".join(f"{n}: {text}" for n, text in self.understood.items())}
        variables: dict[str, tuple] = {n: ("row", cells) for n, cells in self.labels.items()}
        for name, value in self.values.items():
            if isinstance(value, str | tuple):
                texts[name] = value if isinstance(value, str) else "; ".join(value)
            elif name != "understood":
                variables[name] = (), np.nan if value is None else value
        variables |= {name: ("row", values) for name, values in self.rows.items()}
        variables |= {f"curve_{name}": ("curve_point", x) for name, x in self.curve.items()}
        friction = UNITS[self.quantity] or "1"
        units = {"_Pa": "Pa", "_m_s": "m s-1", "_Hz": "Hz", "_N": "N", "_m": "m", "_si": "m"}
        units |= dict.fromkeys(("measured", "fitted", "d_error"), friction)
        dataset = xr.Dataset(variables, attrs=texts)
        for name in dataset.variables.keys() - self.labels.keys():
            unit = (one for end, one in units.items() if str(name).endswith(end))
            dataset[name].attrs["units"] = next(unit, "1")
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
    shared = {"speed": speed, "amplitude": amplitude, "frequency": frequency, "load": load}
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
    return _fitted(rows, model, bodies, {"motion": motion, "confidence": level}, texts)


# Rows and bodies


@dataclass(frozen=True, eq=False)
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
    mean_load : float
        Mean load, N.
    texts, labels, left_out, name
        Common conditions as text, columns of labels, messages about unreadable lines, and the name
        of the table.
    """

    conditions: dict[str, np.ndarray]
    value: np.ndarray
    error: np.ndarray
    quantity: str
    mean_load: float
    texts: dict
    labels: dict
    left_out: tuple
    name: str | list

    @property
    def has_errors(self) -> bool:
        return bool(np.isfinite(self.error).all())

    @property
    def moving(self) -> np.ndarray:
        """Whether each row vibrates, shape (n,)."""
        return self.conditions["amplitude"] > 0.0

    @property
    def weight(self) -> np.ndarray:
        """Factor that converts a coefficient of friction to the measured quantity."""
        load = self.conditions["load"]
        return load if self.quantity == "friction" else np.ones_like(load)

    def groups(self, conditions: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Ratio of velocity to amplitude, dimensionless, and the amplitude in m divided by (load /
        mean load)^(2/3)."""
        speed, amplitude, load, frequency = (conditions[name] for name in CONDITIONS)
        travel = 2.0 * math.pi * frequency * amplitude
        fast = np.full_like(travel, FASTEST)  # without vibration, the velocity has no effect
        ratio = np.divide(speed, travel, out=fast, where=travel > 0.0)
        return ratio, amplitude / (load / self.mean_load) ** (2.0 / 3.0)


def _read_rows(source: Any, shared: Mapping[str, Any], **form: str) -> Rows:
    """Read and check the rows of a file or of a table of columns.  Raises InputError."""
    table = table_of("measured", source, UNITS, need_units=True, **form)
    name = str(source) if isinstance(source, str | os.PathLike) else list(source)

    def refuse(*problems: tuple[object, str]) -> None:
        for wrong, text in problems:
            if wrong:
                raise InputError("measured", name, text)

    names = [one for one in table.cells if one not in LABELS]
    unknown = [repr(one) for one in names if one not in UNITS] or ["nothing"] * (not names)
    what, other = ("friction", "mu") if "friction" in names else ("mu", "friction")
    refuse(
        (unknown, f"a column {''.join(unknown[:1])}; allowed are some of {', '.join(UNITS)}"),
        (len({*map(len, table.cells.values())}) > 1, "columns of several lengths; allowed is one"),
        (what not in names, "has neither friction nor mu; allowed is one of them"),
        (other in names, "has both friction and mu; allowed is one of them"),
        (f"{other}_error" in names, f"has {other}_error without {other}"),
    )
    columns, rows, kept, left_out = table.columns, [], [], []
    for k, cells in enumerate(zip(*(columns[one] for one in names), strict=True)):
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
    count, texts = len(kept), {}
    refuse((not kept, (left_out or ["no rows; allowed is a row for each measurement"])[0]))
    numbers = dict(zip(names, np.array(rows).T, strict=True))
    for one in CONDITIONS:
        if (one in names) == (shared[one] is not None):
            where = "both a column and an argument" if one in names else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(one, shared[one], allowed)
        if one not in names:
            quantity = read_input(one, shared[one])
            numbers[one], texts[one] = np.full(count, quantity.si), quantity.text
    conditions, value = {one: numbers[one] for one in CONDITIONS}, numbers[what]
    errors = numbers.get(f"{what}_error", np.full(count, np.nan))
    least = 2 if f"{what}_error" in names else 3
    more = ", or two with errors of their own" if least == 3 else ""
    negative, positive = (value < 0.0).sum(), (value > 0.0).sum()
    against = "allowed is a positive sign for a force against the motion"
    sign = f"{what} is negative in {negative} of {count} rows, and above 0 in none; {against}"
    refuse(
        (count > MOST_ROWS, f"{count} rows; allowed are at most {MOST_ROWS} rows"),
        (
            not (numbers["amplitude"] > 0.0).any(),
            "no row with an amplitude above 0, so that nothing vibrates",
        ),
        (count < least, f"{count} rows; two numbers take at least {least}{more}"),
        (not positive and negative, sign),
        (not positive, f"the rows determine neither number: {what} is 0 in all rows"),
        (
            len(np.unique(np.stack(list(conditions.values())), axis=1).T) < 2,
            "all rows are of one condition; allowed: two or more conditions",
        ),
    )
    labels = {n: [cells[k] for k in kept] for n, cells in table.labels.items()}
    mean = float(numbers["load"].mean())
    return Rows(conditions, value, errors, what, mean, texts, labels, tuple(left_out), name)


def _number(name: str, cell: object) -> float:
    if cell is None:
        allowed = "empty; allowed: a number in every row; leave out the row, or fill the cell"
        raise InputError(name, None, allowed)
    if name in CONDITIONS:
        return read_input(name, cell).si
    low = 0.0 if name.endswith("_error") else -math.inf
    return read_quantity(name, cell, Input("", UNITS[name], "", low, exact=True)).si


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
    from xarray import DataArray

    source = FrictionMap(dataset, motion)
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
    from scipy.interpolate import RectBivariateSpline

    if len(rows.value) > MOST_SOLVED:
        allowed = f"rows; allowed are at most {MOST_SOLVED}, or any number with a map"
        raise InputError("measured", len(rows.value), allowed)

    @cache
    def point(ratio: float, amplitude: float, **settings: Any) -> tuple[float, float]:
        velocity = min(ratio * amplitude, LARGEST["velocity"])
        result = solve(motion, velocity, min(amplitude, LARGEST["amplitude"]), **settings)
        if not np.isfinite(result.mu_macro):
            where = f"velocity {velocity:.3g} and amplitude {amplitude:.3g}"
            problem = f"no answer at {where}: {result.reason}"
            raise InputError("tolerance", settings["tolerance"], problem)
        return result.mu_macro, result.mu_macro_error

    ratio = np.clip(rows.groups(rows.conditions)[0], SLOWEST, FASTEST)
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
    x : np.ndarray, shape (NODES,)
        Tabulated values of ln u_lim.
    macro : scipy.interpolate.CubicSpline
        mu_macro of the rows as a function of x.
    error, y, weight : np.ndarray, shape (n,)
        Errors of the rows; measured values, and values of the model at mu = mu_macro = 1, both
        divided by the errors.
    """

    def __init__(self, rows: Rows, x: np.ndarray, ratios: np.ndarray):
        from scipy.interpolate import CubicSpline

        scale = np.full_like(rows.value, np.abs(rows.value).max())
        self.error = rows.error if rows.has_errors else scale
        self.x, self.macro = x, CubicSpline(x, ratios)
        self.y, self.weight = rows.value / self.error, rows.weight / self.error

    def mu(self, x: Any) -> tuple[Any, Any, Any]:
        """The best mu at x, the least sum of squares, and half of its second derivative by mu."""
        slope = self.weight * self.macro(x)
        norm = np.maximum((slope * slope).sum(axis=-1), np.finfo(float).tiny)
        mu = np.clip(slope @ self.y / norm, SMALLEST_MU, INPUTS["mu"].high)
        return mu, ((self.y - mu[..., None] * slope) ** 2).sum(axis=-1), norm

    def squares(self, x: Any) -> Any:
        """Least sum of squares at x."""
        return self.mu(x)[1]

    def best(self) -> float:
        """x with the least sum of squares."""
        from scipy.optimize import minimize_scalar

        sums = self.squares(self.x)
        k = int(np.argmin(sums))
        bounds = self.x[max(k - 1, 0)], self.x[min(k + 1, NODES - 1)]
        options = {"xatol": 1e-9}
        one = minimize_scalar(self.squares, bounds=bounds, method="bounded", options=options)
        return float(one.x if one.fun < sums[k] else self.x[k])

    def ends(self, x: float, allowed: float) -> list[float]:
        """Ends of the interval around x in which the sum of squares is at most `allowed`. An end is
        infinite if the interval reaches the end of the table."""
        from scipy.optimize import brentq

        ends = []
        for nodes, end in ((self.x[self.x < x][::-1], -math.inf), (self.x[self.x > x], math.inf)):
            above = np.flatnonzero(self.squares(nodes) > allowed) if len(nodes) else nodes
            if len(above):
                inner = nodes[above[0] - 1] if above[0] else x
                excess = lambda one: float(self.squares(one)) - allowed  # noqa: E731
                end = float(brentq(excess, inner, nodes[above[0]], xtol=1e-7))
            ends.append(end)
        return ends

    def second(self, x: float, allowed: float) -> float | None:
        """x of a minimum of at most `allowed` that differs from x by more than a factor of 2."""
        sums = np.pad(self.squares(self.x), 1, constant_values=np.inf)
        lowest = (sums[1:-1] <= sums[:-2]) & (sums[1:-1] <= sums[2:]) & (sums[1:-1] < allowed)
        others = self.x[lowest & (np.abs(self.x - x) > math.log(2.0))]
        return float(min(others, key=self.squares)) if len(others) else None


def _profile(rows: Rows, model: Model) -> tuple[Profile, float, np.ndarray]:
    """The profile, ln u_lim of the best fit, and errors of mu_macro."""
    (ratio, sizes), moving = rows.groups(rows.conditions), rows.moving
    ends = math.log(sizes[moving].min() / MOST), math.log(sizes.max() / LEAST)
    x = np.linspace(*ends, NODES)
    ratios, errors = model.row_curves(ratio, sizes, x[:, None]), np.zeros(len(sizes))
    profile = Profile(rows, x, ratios)
    at = profile.best()
    for _ in range(MOST_PASSES):
        last = at, profile.mu(at)[0]
        macro, errors[moving] = model.exact(ratio[moving], sizes[moving] / math.exp(at))
        ratios[:, moving] += macro - profile.macro(at)[moving]
        profile = Profile(rows, x, ratios)
        at = profile.best()
        if max(abs(at - last[0]), abs(math.log(profile.mu(at)[0] / last[1]))) <= SETTLED:
            break
    return profile, at, errors


def _fitted(
    rows: Rows, model: Model, bodies: Bodies, settings: dict[str, Any], texts: dict[str, str]
) -> Fit:
    """The fit.  settings: motion and confidence.  Raises InputError if the rows do not determine
    mu."""
    from scipy.stats import chi2, f

    profile, at, errors = _profile(rows, model)
    macro, free, level = profile.macro(at), len(rows.value) - 2, settings["confidence"]
    mu, squares = (float(one) for one in profile.mu(at)[:2])
    off = mu * profile.weight * errors
    noise = chi2.ppf(level, 1) if rows.has_errors else f.ppf(level, 1, free) * squares / free
    least = 1e-12 * float(profile.y @ profile.y)  # rounding errors
    allowed = max(float(noise), float(np.mean(off**2)), least) + squares
    # Logarithms of the parameters at the best fit and in the confidence region.  The shear modulus
    # G follows from u_lim = mu unit G^(-2/3).
    u_lim = profile.ends(at, allowed)
    determined = bool(np.isfinite(u_lim).all())
    x = np.linspace(max(u_lim[0], profile.x[0]), min(u_lim[1], profile.x[-1]), REGION)
    centre, sums, norm = profile.mu(x)
    half = np.sqrt(np.maximum(allowed - sums, 0.0) / norm)
    mus = np.log(np.clip([centre - half, centre + half], SMALLEST_MU, INPUTS["mu"].high))
    logs = {"mu": (math.log(mu), mus.min(), mus.max()), "u_lim": (at, *u_lim)}
    scale, unit = "u_lim", 0.0
    if bodies.radius is not None:
        scale, unit = "shear_modulus", math.log(bodies.contact(1.0, 1.0, rows.mean_load).u_lim)
        moduli = 1.5 * (mus + unit - x)
        low = moduli.min() if u_lim[1] < math.inf else -math.inf
        high = moduli.max() if u_lim[0] > -math.inf else math.inf
        logs[scale] = 1.5 * (math.log(mu) + unit - at), low, high
    # Largest changes of the logarithms due to errors of the model, to first order.
    told = ("mu", scale) if determined else ("mu",)
    slopes = mu * np.stack([macro, profile.macro(at, 1)], axis=1) * profile.weight[:, None]
    shifts = np.zeros((2, len(off)))
    shifts[: len(told)] = np.linalg.pinv(slopes[:, : len(told)])
    changes = dict(zip(logs, (*shifts, 1.5 * (shifts[0] - shifts[1])), strict=False))
    shares = {name: float(np.abs(one) @ off) for name, one in changes.items()}
    values: dict[str, Any] = {}
    for name, (suffix, _) in PARAMETERS.items():
        ends = np.array(logs.get(name, [math.nan] * 3)) + shares.get(name, 0.0) * SIDES
        if not (determined or name == "mu"):
            ends[0] = math.nan
        for side, end in zip(("", "_low", "_high"), ends, strict=True):
            number = math.exp(min(end, 700.0)) if math.isfinite(end) else None
            values[f"{name}{side}{suffix}"] = number
    low, high = values["mu_low"], values["mu_high"]
    if not high < WIDEST_MU * low:
        problem = f"mu from {low:.3g} to {high:.3g} fits as well with another u_lim"
        hint = "add rows without vibration, or rows where vibration reduces friction more"
        message = f"the rows determine neither number: {problem}; {hint}"
        raise InputError("measured", rows.name, message)
    chance = float(chi2.sf(squares, free)) if rows.has_errors and free else None
    sigma = profile.error if rows.has_errors else profile.error * math.sqrt(squares / free)
    suffix, si = PARAMETERS[scale]
    reason, which = "", f"any {_title(scale)}"
    if not determined:
        for side, word in (("high", "below"), ("low", "above")):
            if (end := values[f"{scale}_{side}{suffix}"]) is not None:
                which = f"any {_title(scale)} {word} {end:.3g} {si}"
        reason = f"the rows determine mu alone: {which} fits them as well"
    doubts = []
    if chance is not None and chance < UNLIKELY:
        problem = f"the residuals are larger than the errors of the rows allow (p = {chance:.1g})"
        doubt = "the theory does not describe these rows, or the errors are too small"
        doubts.append(f"{problem}: {doubt}")
    modulus = math.exp(logs[scale][0]) if bodies.radius is not None else None
    doubts += _warnings(rows, settings["motion"], bodies, mu, modulus)
    if determined and (other := profile.second(at, allowed)) is not None:
        second = float(profile.mu(other)[0])
        size = other if scale == "u_lim" else 1.5 * (math.log(second) + unit - other)
        text = f"mu {second:.3g} with {math.exp(size):.3g} {si}"
        doubts.append(f"{text} fits nearly as well: two answers")
    values = {
        **{"motion": settings["motion"], "quantity": rows.quantity},
        **values,
        **{"load_N": rows.mean_load, "confidence": level},
        "mu_model_share": math.expm1(shares["mu"]),
        "scale_model_share": math.expm1(shares[scale]),
        "standard_error": None if rows.has_errors else float(sigma[0]),
        "chi_square": squares if rows.has_errors else None,
        **{"p_value": chance, "degrees_of_freedom": free, "told": told, "reason": reason},
        "warnings": tuple(doubts),
        "understood": {"motion": settings["motion"]} | texts | rows.texts,
        "left_out": rows.left_out,
    }
    speed, amplitude, load, frequency = rows.conditions.values()
    local = math.exp(at) * (load / rows.mean_load) ** (2.0 / 3.0)
    rest = rows.value - mu * rows.weight * macro
    columns = {
        **{"speed_m_s": speed, "amplitude_si": amplitude},
        **{"frequency_Hz": frequency, "row_load_N": load},
        "velocity": speed / (2.0 * math.pi * frequency * local),
        "amplitude": amplitude / local,
        **{"measured": rows.value, "measured_error": rows.error},
        "fitted": mu * rows.weight * macro,
        "fitted_error": mu * rows.weight * errors,
        "residual": np.divide(rest, sigma, out=0.0 * rest, where=sigma > 0.0),
    }
    return Fit(values, columns, _curve(rows, model, mu, at, macro, errors), rows.labels)


def _warnings(
    rows: Rows, motion: str, bodies: Bodies, mu: float, modulus: float | None
) -> list[str]:
    """Assumptions of the theory that do not hold at the best fit."""
    if modulus is None:
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
    along = max(conditions, key=lambda name: len(np.unique(conditions[name])))
    others = np.stack([conditions[name] for name in CONDITIONS if name != along])
    _, which = np.unique(others, axis=1, return_inverse=True)
    correction = macro - model.row_curves(*rows.groups(conditions), at)
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
        factor = mu * (fine["load"] if rows.quantity == "friction" else 1.0)
        friction = model.row_curves(*rows.groups(fine), at) + more
        parts.append(np.stack([*(fine[n] for n in CONDITIONS), factor * friction, factor * error]))
    titles = ("speed_m_s", "amplitude_si", "row_load_N", "frequency_Hz", "fitted", "fitted_error")
    return dict(zip(titles, np.concatenate(parts, axis=1), strict=True))
