"""Propagate the uncertainty of the inputs to the outputs by quasi-random draws, and compute the
probability of each outcome under a prescribed force.

The uncertain inputs are independent and normally distributed.  The draws form a low-discrepancy
sequence, so that the same inputs always have the same draws.  A draw outside the range of its input
is replaced by the closest value of the range.  Outputs in closed form are evaluated for each draw.
The result of the solver depends only on a few dimensionless groups of each draw.  If the groups of
all draws lie on a line, the solver computes the result at a few points of this line.  The results
of the draws are interpolated between these points.  In general, there are several lines.  The
changes of the result along the lines are added.  The lines are the principal axes of the groups.
If the number of inputs does not exceed the number of principal axes, the lines are drawn along the
axes of the inputs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import ROUNDING
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, Inputs
from microslip.si.output import INTERVAL, Prediction, Value
from microslip.si.solve import NoSolutionError, answer_of, find_reduction, static_limit

DRAWS = 2**15
"""Number of draws.  The error of a probability is about 1e-3."""
LEVELS = (-3.0, -1.5, 1.5, 3.0)
"""Positions of points along a line, in standard deviations.  The solver computes the result at
these points.  Draws beyond the outermost points are replaced by these points.  This replacement
makes a standard uncertainty 0.25 % too small.  If the outermost points were at 2.5 standard
deviations, the standard uncertainty would be 1.1 % too small."""
STATIC_LEVELS = (-3.0, -1.96, -1.3, -0.65, 0.65, 1.3, 1.96, 3.0)
"""Positions of points along a line, in standard deviations.  The solver computes the static limit
at these points.  The bounds of a 95 % interval are at -1.96 and 1.96."""
NEARER = (1.0, 0.75, 0.5, 0.25)
"""Factors of a level.  The level is multiplied by each factor in turn, until the inputs are within
the range of the theory."""
REFINEMENTS = 3
"""Number of bisections in the search for the smallest amplitude with a static limit of 0.  The same
number of points is added where the static limit is close to the force."""
VANISHING = 1e-3
"""Largest static limit that counts as 0 in the bisection."""
CLOSEST = 64
"""The number of draws that count as close to the force is the number of all draws divided by this
value.  For these draws, the static limit is closest to the force."""
NEGLIGIBLE = 1e-3
"""An axis is ignored if the standard deviation of the groups along this axis, divided by the
standard deviation along the first axis, is at most this value.  A standard uncertainty is infinite
if the fraction of draws without a finite value is above this value."""
SMALLEST = 5e-324
"""Smallest positive number.  If an input must be above 0, this number replaces 0."""
DRIVEN = ("velocity", "force", "stiffness", "mass", "damping")
"""Dimensionless groups on which the static limit does not depend."""


class _Line(NamedTuple):
    """A line through the draws.  Values are interpolated along this line.

    Attributes
    ----------
    places, levels : np.ndarray, shape (DRAWS,)
        Coordinate of each draw along the line, and its distance from the centre in standard
        deviations.
    at : callable
        at(level) returns the Inputs and the coordinate at a level.
    nodes : list
        Level, coordinate, and values (keyed by name) of each node.
    """

    places: np.ndarray
    levels: np.ndarray
    at: Callable[[float], tuple[Inputs, float]]
    nodes: list[tuple[float, float, dict[str, float]]]

    def add(self, solve: Callable[[Inputs], dict[str, float]], *levels: float) -> None:
        """Add nodes at the given levels.  If no values can be computed at a level, a level nearer
        to the centre is used."""
        for level in levels:
            for one in (factor * level for factor in NEARER):
                try:
                    inputs, place = self.at(one)
                    self.nodes.append((one, place, solve(inputs)))
                    break
                except (InputError, ArithmeticError):  # outside the range of the theory
                    continue

    def values(self, name: str) -> np.ndarray:
        """Return the values of all draws.  Between the nodes, the values are interpolated.  Beyond
        the outermost nodes, the values are constant.  If the nearest node of a draw has no value,
        the value of the draw is NaN."""
        from scipy.interpolate import PchipInterpolator

        pairs = {place: values.get(name, math.nan) for _, place, values in self.nodes}
        places, values = np.array(sorted(pairs.items())).T
        good = np.isfinite(values)
        x, y = places[good], values[good]
        if len(x) < 2:
            result = np.full(self.places.shape, y[0] if len(y) else math.nan)
        else:
            result = PchipInterpolator(x, y)(np.clip(self.places, x[0], x[-1]))
        nearest = np.searchsorted(0.5 * (places[1:] + places[:-1]), self.places)
        return np.where(good[nearest], result, math.nan)


class Draws:
    """Draws of uncertain inputs, with the contact and the prediction for each draw.

    Parameters
    ----------
    inputs : Inputs
        The inputs.  At least one of them is uncertain.
    contact, answer : Contact, Prediction
        The contact and the prediction for the central values.

    Attributes
    ----------
    contact, answer : Contact, Prediction
        The contact and the prediction for all draws, with arrays of shape (DRAWS,).
    """

    def __init__(self, inputs: Inputs, contact: Contact, answer: Prediction):
        self._inputs, self._centre, search = inputs, contact, inputs.search
        self._normal = normal_numbers(len(inputs.uncertain))
        drawn, central = self._drawn(self._normal), answer.values
        self.contact = Contact(contact.inputs.at(**drawn))
        middle = _numbers(contact, answer, search)
        limit = None if search else middle.pop("static", None)
        lines = self._lines(middle)
        for line in lines:
            line.add(_solution, *LEVELS)
        known = _total(middle, lines)
        if limit is not None:
            known["static"] = self._static(limit)
        if search is not None:
            drawn[search] = np.exp(known.pop("root"))
            self.contact = Contact(inputs.at(**drawn))
        elif central.get("threshold") == central.get("static", 0.0):
            known["threshold"] = known["static"]
        if inputs.force is not None:  # draws that stay or run away
            force = self.contact.drive(known["mean_load"])["force"]
            velocity = np.maximum(known["velocity"], 0.0)
            velocity = np.where(force < known.get("threshold", -math.inf), 0.0, velocity)
            known["velocity"] = np.where(force >= known["largest_force"], math.inf, velocity)
            known["friction"] = np.minimum(force, 1.0)
        values = {name: Value(numbers) for name, numbers in known.items()}
        if "threshold" in known:
            values["threshold"] = Value(known["threshold"], central["threshold"].error)
        self.answer = replace(answer, values=values)

    def _drawn(self, normal: np.ndarray) -> dict[str, Any]:
        """Return draws of the uncertain inputs, limited to the allowed ranges.  `normal` is an
        array of shape (..., inputs) with standard normal numbers."""
        drawn = {}
        for k, (name, one) in enumerate(self._inputs.uncertain.items()):
            low, high = INPUTS[name].low, INPUTS[name].high
            low = low if INPUTS[name].zero else SMALLEST
            if INPUTS[name].low == -math.inf:  # a radius keeps its sign
                low, high = sorted((math.copysign(SMALLEST, one.si), math.copysign(high, one.si)))
            drawn[name] = np.clip(one.si + normal[..., k] * one.deviation, low, high)
        return drawn

    def _static(self, central: float) -> np.ndarray:
        """Compute the static limit for all draws.  Nodes are added where the static limit becomes
        0, and where the static limit is close to the prescribed force."""
        lines = self._lines({"static": central}, static=True)
        force = self.contact.drive().get("force") if len(lines) == 1 else None

        def limit(inputs: Inputs) -> dict[str, float]:
            contact = Contact(inputs)
            if 0.0 < contact.amplitude < math.inf:
                return {"static": static_limit(contact).mu_macro}
            return {"static": 1.0 if contact.amplitude <= 0.0 else 0.0}

        for line in lines:
            line.add(limit, *STATIC_LEVELS)
            for _ in range(REFINEMENTS):
                sizes = sorted((level, values["static"]) for level, _, values in line.nodes)
                pairs = pairwise(sizes)
                ends = [(a, b) for (a, x), (b, y) in pairs if (x > VANISHING) != (y > VANISHING)]
                if ends:
                    line.add(limit, 0.5 * sum(ends[0]))
            for _ in range(0 if force is None else REFINEMENTS):
                distance = np.abs(line.values("static") - force)
                closest = np.argpartition(distance, DRAWS // CLOSEST)[: DRAWS // CLOSEST]
                line.add(limit, float(np.median(line.levels[closest])))
        return np.clip(_total({"static": central}, lines)["static"], 0.0, 1.0)

    def _groups(self, contact: Contact, static: bool) -> np.ndarray:
        """Return the groups of a contact relative to the centre, as an array of shape
        (draws, groups)."""
        central, columns = self._centre.coordinates, []
        for name, value in contact.coordinates.items():
            if static and name in DRIVEN:
                continue
            change, reference = value - central[name], central[name]
            if name not in ("poisson", "phase") and reference:  # smooth at 0 and at infinity
                change = 1.0 / (1.0 + reference / np.asarray(value)) - 0.5
            columns.append(np.atleast_1d(change))
        return np.nan_to_num(np.stack(np.broadcast_arrays(*columns), axis=-1))

    def _lines(self, central: dict[str, float], static: bool = False) -> list[_Line]:
        """Return the lines, in the space of the inputs, along which the result varies.  If `static`
        is true, these are the lines along which the static limit varies.  The lines follow the
        principal axes of the groups.  If the number of inputs does not exceed the number of
        principal axes, the lines are drawn along the axes of the inputs.  The first node of each
        line is at the centre."""
        normal, count = self._normal, len(self._inputs.uncertain)
        groups = self._groups(self.contact, static)
        if len(groups) == 1:
            return []
        middle = groups.mean(axis=0)
        _, sizes, axes = np.linalg.svd(groups[::8] - middle, full_matrices=False)
        axes = axes[: int(np.sum(sizes > NEGLIGIBLE * sizes[0])) if sizes[0] > 0.0 else 0]
        by_inputs = len(axes) >= max(count, 2)
        scores = normal if by_inputs else (groups - middle) @ axes.T
        deviations = scores.std(axis=0)
        slopes = np.linalg.lstsq(scores, normal, rcond=None)[0] * deviations[:, None]
        levels = scores / deviations
        if count == 1:
            slopes, levels = np.ones((1, 1)), normal

        def at(axis: int, level: float) -> tuple[Inputs, float]:
            drawn = self._drawn(level * slopes[axis][None, :])
            inputs = self._inputs.at(**{name: np.float64(one[0]) for name, one in drawn.items()})
            if by_inputs:
                return inputs, level
            place = self._groups(Contact(self._centre.inputs.at(**drawn)), static)[0] - middle
            return inputs, float(place @ axes[axis])

        lines = []
        for axis in range(scores.shape[1]):
            along = partial(at, axis)
            nodes = [(0.0, along(0.0)[1], central)]
            lines.append(_Line(scores[:, axis], levels[:, axis], along, nodes))
        return lines


def _total(central: dict[str, float], lines: list[_Line]) -> dict[str, np.ndarray]:
    """Return the central values plus the sum of their changes along all lines."""
    return {
        name: np.full(DRAWS, value) + sum(line.values(name) - value for line in lines)
        for name, value in central.items()
    }


def _numbers(contact: Contact, answer: Prediction, search: str | None) -> dict[str, float]:
    """Return the values of a prediction.  After a search, the dict also contains "root", the
    logarithm of the quantity that the search found."""
    values = {name: one.value for name, one in answer.values.items()}
    return values | ({"root": math.log(getattr(contact.inputs, search))} if search else {})


def _solution(inputs: Inputs) -> dict[str, float]:
    """Solve a contact and return its values, or an empty dict if a search has no solution.  Raises
    InputError."""
    try:
        contact = find_reduction(inputs)[0] if inputs.search else contact_of(inputs)
    except NoSolutionError:
        return {}
    return _numbers(contact, answer_of(contact), inputs.search)


def normal_numbers(count: int) -> np.ndarray:
    """Return draws of independent standard normal numbers with mean 0 and variance 1, as an array
    of shape (DRAWS, count).

    The draws form a Kronecker sequence.  The sequence is generated by irrational numbers, which are
    powers of the root of x^(count + 1) = x + 1.
    """
    from scipy.special import ndtri

    root = 2.0
    for _ in range(60):  # each step reduces the error by at least a factor of 2
        root = (1.0 + root) ** (1.0 / (count + 1.0))
    steps = root ** -np.arange(1.0, count + 1.0)
    draws = ndtri(np.mod(0.5 + np.arange(1.0, DRAWS + 1.0)[:, None] * steps, 1.0))
    return (draws - draws.mean(axis=0)) / draws.std(axis=0)


def with_interval(one: Value, draws: Any) -> Value:
    """Return a copy of a `Value` that also contains the standard uncertainty and the 95 % interval
    of the draws.  A missing value of a draw counts as infinite."""
    drawn = np.broadcast_to(np.asarray(draws, dtype=float), (DRAWS,))
    drawn = np.where(np.isnan(drawn), math.inf, drawn)
    low, high = np.quantile(drawn, INTERVAL, method="nearest")
    finite = drawn[np.isfinite(drawn)]
    spread = float(np.std(finite)) if len(finite) else 0.0
    if len(finite) < (1.0 - NEGLIGIBLE) * DRAWS:
        spread = math.inf
    elif len(finite) and np.ptp(finite) <= ROUNDING * np.abs(finite).max():
        spread, low, high = 0.0, one.value, one.value
    return replace(one, spread=spread, low=float(low), high=float(high))


def probabilities(contact: Contact, answer: Prediction) -> dict[str, Value]:
    """Return the probability of each outcome under a prescribed force, with its error estimate.
    If no force is prescribed, the result is empty.

    The error estimate is the largest of three values.  The first value is the change of the
    probability due to the error of the threshold.  The second value is the difference between two
    probabilities.  One probability is computed from the even draws, and the other probability from
    the odd draws.  The third value, log(DRAWS) / DRAWS, is of the order of the discrepancy of the
    sequence.

    contact, answer: the attributes of Draws.
    """
    if contact.inputs.force is None:
        return {}
    known = answer.values
    force = np.broadcast_to(contact.drive(known["mean_load"].value)["force"], (DRAWS,))
    away, threshold = force >= known["largest_force"].value, known.get("threshold")
    outcomes, shift = {"runs_away": away}, 0.0
    if threshold is not None:
        ends = (threshold.value + k * threshold.error for k in (0.0, -1.0, 1.0))
        stays, at_least, at_most = (~away & (force < end) for end in ends)
        shift = max(abs(np.mean(end) - np.mean(stays)) for end in (at_least, at_most))
        outcomes |= {"stays": stays, "moves": ~away & ~stays}
    values = {}
    for name, draws in outcomes.items():
        halves = abs(np.mean(draws[::2]) - np.mean(draws[1::2]))
        error = max(0.0 if name == "runs_away" else shift, halves, math.log(DRAWS) / DRAWS)
        values[f"probability_{name}"] = Value(float(np.mean(draws)), float(error))
    return values
