"""Uncertain inputs: draws of all outputs, and the probability of each outcome under a force.

The uncertain inputs are independent and normally distributed.  The draws form a low-discrepancy
sequence, so that equal inputs have equal draws.  A draw outside the range of its input is replaced
by the closest value of the range.  All closed forms are evaluated for each draw.  The answer of the
solver depends on the draw through a few dimensionless groups.  If the groups of all draws lie on a
line, the solver computes the answer at a few of its points, and the answer is interpolated.  In
general, the changes along several lines are added: the principal axes of the groups, or the axes of
the inputs if there are at most as many.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import ROUNDING
from microslip.si.contact import Contact
from microslip.si.inputs import INPUTS, Inputs
from microslip.si.output import INTERVAL, Value
from microslip.si.search import NoSolutionError
from microslip.si.solve import Answer, static_limit

DRAWS = 2**15
"""Number of draws.  The error of a probability is about 1e-3."""
LEVELS = (-3.0, -1.5, 1.5, 3.0)
"""Points along a line at which the solver computes the answer, in standard deviations.  Draws
beyond the ends count as ends, which reduces a standard deviation by 0.25 % (1.1 % with 2.5)."""
STATIC_LEVELS = (-3.0, -1.96, -1.3, -0.65, 0.65, 1.3, 1.96, 3.0)
"""Points along a line at which the static limit is computed.  The ends of a 95 % interval are at
1.96."""
NEARER = (1.0, 0.75, 0.5, 0.25)
"""Factors of a level, tried in this order until the inputs are within the range of the theory."""
REFINEMENTS = 3
"""Number of bisections for the smallest amplitude with a static limit of 0, and number of further
points with a static limit close to the force."""
VANISHING = 1e-3
"""Static limit that counts as 0 in this search."""
CLOSEST = 64
"""One draw in 64 counts as close to the force."""
NEGLIGIBLE = 1e-3
"""Standard deviation of the groups along an axis, relative to that along the first axis, below
which the axis is ignored.  Also the fraction of draws without a finite value from which on a
standard uncertainty is infinite."""
SMALLEST = 5e-324
"""Smallest positive number.  It replaces 0 for an input that must be above 0."""
DRIVEN = ("velocity", "force", "stiffness", "mass", "damping")
"""Groups that have no effect on the static limit."""

Solve = Callable[[Inputs], tuple[Contact, Answer, Value | None]]
"""Function solve(inputs) -> contact, answer, result of a search or None.  Raises InputError."""


class _Line(NamedTuple):
    """A line through the draws, along which values are interpolated.

    Attributes
    ----------
    places, levels : np.ndarray, shape (DRAWS,)
        Coordinate of each draw along the line, and its distance from the centre in standard
        deviations.
    inputs_at, place_at : callable
        inputs_at(level) -> Inputs, and place_at(level) -> coordinate.
    nodes : list
        Level, place and values by name of each node.
    """

    places: np.ndarray
    levels: np.ndarray
    inputs_at: Callable[[float], Inputs]
    place_at: Callable[[float], float]
    nodes: list[tuple[float, float, dict[str, float]]]

    def add(self, level: float, solve: Callable[[Inputs], dict[str, float]]) -> None:
        """Add a node at a level.  If this level has no values, a level nearer to the centre is
        used."""
        for one in (factor * level for factor in NEARER):
            try:
                self.nodes.append((one, self.place_at(one), solve(self.inputs_at(one))))
            except (InputError, ArithmeticError):  # outside the range of the theory or the solver
                continue
            return

    def values(self, name: str) -> np.ndarray:
        """Values of all draws: interpolated between the nodes, constant outside, and NaN where the
        nearest node has no value."""
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
    """Draws of uncertain inputs, and the contact and the answer for each of them.

    Parameters
    ----------
    inputs : Inputs
        The inputs, of which at least one is uncertain.
    contact, answer : Contact, Answer
        The contact and the answer for the central values.
    solve : callable
        See Solve.

    Attributes
    ----------
    contact, answer : Contact, Answer
        The contact and the answer of all draws, with arrays of shape (DRAWS,).
    """

    def __init__(self, inputs: Inputs, contact: Contact, answer: Answer, solve: Solve):
        self._inputs, self._centre = inputs, contact
        self._normal = normal_numbers(len(inputs.uncertain))
        drawn, central = self._drawn(self._normal), answer.values
        self.contact = Contact(contact.inputs.at(**drawn))

        def solution(other: Inputs) -> dict[str, float]:
            """The answer, and as "root" the logarithm of the result of a search."""
            try:
                _, answer, root = solve(other)
            except NoSolutionError:
                return {}
            values = {name: one.value for name, one in answer.values.items()}
            return values | ({"root": math.log(root.value)} if root else {})

        middle = solution(inputs)
        limit = None if inputs.search else middle.pop("static", None)
        known = self._total(middle, self._lines(False, middle), LEVELS, solution)
        if limit is not None:
            known["static"] = self._static(limit)
        if inputs.search is not None:
            drawn[inputs.search] = np.exp(known.pop("root"))
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
        """Values of the uncertain inputs within their ranges, from standard normal numbers of shape
        (..., inputs)."""
        names = enumerate(self._inputs.uncertain)
        return {name: _clipped(self._inputs, name, normal[..., k]) for k, name in names}

    def _total(
        self,
        central: dict[str, float],
        lines: list[_Line],
        levels: Sequence[float],
        solve: Callable[[Inputs], dict[str, float]],
        refine: Callable[[_Line], None] = lambda line: None,
    ) -> dict[str, np.ndarray]:
        """The central values and their changes along all lines.  refine: adds more nodes."""
        totals = {name: np.full(DRAWS, value) for name, value in central.items()}
        for line in lines:
            for level in levels:
                line.add(level, solve)
            refine(line)
            for name, value in central.items():
                totals[name] += line.values(name) - value
        return totals

    def _static(self, central: float) -> np.ndarray:
        """The static limit for all draws.  Points are added where it vanishes and where it is close
        to the force."""
        force, lines = self.contact.drive().get("force"), self._lines(True, {"static": central})

        def limit(inputs: Inputs) -> dict[str, float]:
            contact = Contact(inputs)
            if contact.amplitude <= 0.0:
                return {"static": 1.0}
            finite = math.isfinite(contact.amplitude)
            return {"static": static_limit(contact).mu_macro if finite else 0.0}

        def refine(line: _Line) -> None:
            for _ in range(REFINEMENTS):
                sizes = sorted((level, values["static"]) for level, _, values in line.nodes)
                pairs = pairwise(sizes)
                ends = [(a, b) for (a, x), (b, y) in pairs if (x > VANISHING) != (y > VANISHING)]
                if ends:
                    line.add(0.5 * sum(ends[0]), limit)
            for _ in range(REFINEMENTS if force is not None and len(lines) == 1 else 0):
                distance = np.abs(line.values("static") - force)
                closest = np.argpartition(distance, DRAWS // CLOSEST)[: DRAWS // CLOSEST]
                line.add(float(np.median(line.levels[closest])), limit)

        total = self._total({"static": central}, lines, STATIC_LEVELS, limit, refine)
        return np.clip(total["static"], 0.0, 1.0)

    def _groups(self, contact: Contact, static: bool) -> np.ndarray:
        """Groups of a contact relative to the centre, shape (draws, groups)."""
        central, columns = self._centre.coordinates, []
        for name, value in contact.coordinates.items():
            if static and name in DRIVEN:
                continue
            change, reference = value - central[name], central[name]
            if name not in ("poisson", "phase") and reference:  # smooth at 0 and at infinity
                change = 1.0 / (1.0 + reference / np.asarray(value)) - 0.5
            columns.append(np.atleast_1d(change))
        return np.nan_to_num(np.stack(np.broadcast_arrays(*columns), axis=-1))

    def _lines(self, static: bool, central: dict[str, float]) -> list[_Line]:
        """The lines along which the answer, or the static limit, varies: the principal axes of the
        groups, or the axes of the inputs if there are at most as many.  The first node of each line
        is at the centre."""
        normal, count = self._normal, len(self._inputs.uncertain)
        base = self._centre.inputs if static else self._inputs
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
        directions = np.ones((1, 1)) if count == 1 and not by_inputs else slopes
        levels = normal if count == 1 else scores / deviations

        def line(axis: int) -> _Line:
            def inputs_at(level: float) -> Inputs:
                drawn = self._drawn(level * directions[axis])
                return base.at(**{name: np.float64(one) for name, one in drawn.items()})

            def place_at(level: float) -> float:
                drawn = self._drawn(level * directions[axis][None, :])
                contact = Contact(self._centre.inputs.at(**drawn))
                return float((self._groups(contact, static)[0] - middle) @ axes[axis])

            place = float if by_inputs else place_at
            nodes = [(0.0, place(0.0), central)]
            return _Line(scores[:, axis], levels[:, axis], inputs_at, place, nodes)

        return [line(axis) for axis in range(scores.shape[1])]


def _clipped(inputs: Inputs, name: str, normal: Any) -> Any:
    """Values of an uncertain input within its range."""
    one, allowed = inputs.quantities[name], INPUTS[name]
    values = one.si + normal * one.deviation
    if allowed.low == -math.inf:  # a radius keeps its sign
        return np.copysign(np.maximum(values * np.sign(one.si), SMALLEST), one.si)
    return np.clip(values, allowed.low if allowed.zero else SMALLEST, allowed.high)


def normal_numbers(count: int) -> np.ndarray:
    """Draws of independent standard normal numbers, shape (DRAWS, count), with mean 0 and variance
    1.

    They form a Kronecker sequence.  Its irrational numbers are powers of the root of
    x^(count + 1) = x + 1.
    """
    from scipy.special import ndtri

    root = 2.0
    for _ in range(60):  # each step reduces the error by at least a factor of 2
        root = (1.0 + root) ** (1.0 / (count + 1.0))
    steps = root ** -np.arange(1.0, count + 1.0)
    draws = ndtri(np.mod(0.5 + np.arange(1.0, DRAWS + 1.0)[:, None] * steps, 1.0))
    return (draws - draws.mean(axis=0)) / draws.std(axis=0)


def with_interval(one: Value, draws: Any) -> Value:
    """A Value with the standard uncertainty and the 95 % interval of its draws.  A draw without a
    value counts as infinite."""
    drawn = np.broadcast_to(np.asarray(draws, dtype=float), (DRAWS,))
    drawn = np.where(np.isnan(drawn), math.inf, drawn)
    low, high = np.quantile(drawn, INTERVAL, method="nearest")
    finite = drawn[np.isfinite(drawn)]
    spread = float(np.std(finite)) if len(finite) else 0.0
    if len(finite) < (1.0 - NEGLIGIBLE) * DRAWS:
        spread = math.inf
    elif len(finite) and np.ptp(finite) <= ROUNDING * np.abs(finite).max():
        spread, low, high = 0.0, one.value, one.value
    return Value(one.value, one.error, spread, float(low), float(high))


def probabilities(contact: Contact, answer: Answer) -> dict[str, Value]:
    """Probability of each outcome under a force, with its error estimate; empty without a force.

    The error estimate follows from the error of the threshold, or from the difference between the
    even and the odd draws. It is at least log(DRAWS) / DRAWS, the order of the sequence's
    discrepancy.

    contact, answer: those of Draws.
    """
    if contact.inputs.force is None:
        return {}
    known = answer.values
    force = np.broadcast_to(contact.drive(known["mean_load"].value)["force"], (DRAWS,))
    away, threshold = force >= known["largest_force"].value, known.get("threshold")
    outcomes, shift = {"runs_away": away}, 0.0
    if threshold is not None:
        value, error = threshold.pair
        stays, at_least, at_most = (~away & (force < value + k * error) for k in (0.0, -1.0, 1.0))
        shift = max(abs(np.mean(end) - np.mean(stays)) for end in (at_least, at_most))
        outcomes |= {"stays": stays, "moves": ~away & ~stays}
    values = {}
    for name, draws in outcomes.items():
        halves = abs(np.mean(draws[::2]) - np.mean(draws[1::2]))
        error = max(0.0 if name == "runs_away" else shift, halves, math.log(DRAWS) / DRAWS)
        values[f"probability_{name}"] = Value(float(np.mean(draws)), float(error))
    return values
