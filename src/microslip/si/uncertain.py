"""Uncertain inputs: draws of all outputs, and the probability of each outcome under a force.

The uncertain inputs are independent and normally distributed.  The draws form a low-discrepancy
sequence, so that equal inputs have equal draws.  A draw outside the range of its input is replaced
by the closest value of the range.  All closed forms are evaluated for each draw.  The answer of the
solver depends on the draw through a few dimensionless groups.  If the groups of all draws lie on a
line, the solver computes the answer at a few of its points, and the answer is interpolated.  In
general, the changes along several lines are added: the principal axes of the groups, or the axes of
the inputs if there are fewer of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from microslip.answer.answer import Estimate
from microslip.foundation.errors import InputError
from microslip.si.contact import Contact
from microslip.si.inputs import INPUTS, Inputs
from microslip.si.output import INTERVAL, Value
from microslip.si.search import NoSolutionError
from microslip.si.solve import Answer, static_limit

DRAWS = 2**15
"""Number of draws.  The error of a probability is about 1e-3."""
LEVELS = (-2.5, -1.25, 1.25, 2.5)
"""Points along a line at which the solver computes the answer, in standard deviations."""
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
SOLVED = ("mean_load", "largest_force", "torque", "dissipation", "displacement", "cycles")
"""Values of an answer that are interpolated between solved answers."""
DRIVEN = ("velocity", "force", "stiffness", "mass", "damping")
"""Groups that have no effect on the static limit."""

Solve = Callable[[Inputs], tuple[Contact, Answer, Estimate | None]]
"""Function solve(inputs) -> contact, answer, result of a search or None.  Raises InputError."""


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
        self._inputs, self._centre, self._central, self._solve = inputs, contact, answer, solve
        self._names, self._normal = list(inputs.uncertain), normal_numbers(len(inputs.uncertain))
        self._solutions: dict[tuple, tuple[Answer, float] | None] = {}
        drawn = self._drawn(self._normal)
        self.contact = Contact(contact.inputs.at(**drawn))
        lines, names = self._lines(False), [*SOLVED, "velocity", "friction"]
        known = {n: self._interpolated(n, lines) for n in names if n in answer.values}
        limit, threshold = answer.values.get("static"), answer.values.get("threshold")
        if limit is not None:
            searched = inputs.search is not None
            known["static"] = (
                self._interpolated("static", lines) if searched else self._static(self._lines(True))
            )
        if threshold is not None:
            same = threshold == limit
            known["threshold"] = _estimate(
                known["static"].value if same else self._interpolated("threshold", lines).value,
                threshold.by_source,
            )
        if inputs.search is not None:
            drawn[inputs.search] = np.exp(self._interpolated("root", lines).value)
            self.contact = Contact(inputs.at(**drawn))
        if inputs.force is not None:
            self._set_outcomes(known)
        self.answer = Answer(known, answer.model, answer.converged, "", answer.outcome)

    def _drawn(self, normal: np.ndarray) -> dict[str, Any]:
        """Values of the uncertain inputs within their ranges, from standard normal numbers of shape
        (..., inputs)."""
        return {
            name: _clipped(self._inputs, name, normal[..., k]) for k, name in enumerate(self._names)
        }

    # Answers of the solver

    def _value(self, name: str, inputs: Inputs) -> float:
        """A value of the answer for other inputs, NaN without one.  "root" is the logarithm of the
        result of a search.  Raises InputError."""
        key = tuple(float(one.si) for one in inputs.quantities.values())
        if key not in self._solutions:
            try:
                _, answer, root = self._solve(inputs)
                size = math.nan if root is None else math.log(root.value)
                self._solutions[key] = answer, size
            except NoSolutionError:
                self._solutions[key] = None
        solution = self._solutions[key]
        if solution is None:
            return math.nan
        one = solution[0].values.get(name)
        return solution[1] if name == "root" else math.nan if one is None else one.value

    def _limit(self, inputs: Inputs) -> float:
        """The static limit for other inputs, NaN without one."""
        contact = Contact(inputs)
        if contact.amplitude <= 0.0:
            return 1.0
        return static_limit(contact).mu_macro if math.isfinite(contact.amplitude) else 0.0

    def _interpolated(self, name: str, lines: list[_Line]) -> Estimate:
        """A value of the answer for all draws."""
        value = partial(self._value, name)
        central = self._central.values[name].value if name != "root" else value(self._inputs)
        total = np.full(DRAWS, central)
        for line in lines:
            line.start(central)
            for level in LEVELS:
                line.add(level, value)
            total += line.values() - central
        return _estimate(total)

    def _static(self, lines: list[_Line]) -> Estimate:
        """The static limit for all draws.  Points are added where it vanishes and where it is close
        to the force."""
        central = self._central.values["static"].value
        drive = self.contact.drive()
        total = np.full(DRAWS, central)
        for line in lines:
            line.start(central)
            for level in STATIC_LEVELS:
                line.add(level, self._limit)
            for _ in range(REFINEMENTS):
                pairs = pairwise(sorted(line.levels.values()))
                ends = [(a, b) for (a, x), (b, y) in pairs if (x > VANISHING) != (y > VANISHING)]
                if ends:
                    line.add(0.5 * sum(ends[0]), self._limit)
            for _ in range(REFINEMENTS if "force" in drive and len(lines) == 1 else 0):
                distance = np.abs(line.values() - drive["force"])
                closest = np.argpartition(distance, DRAWS // CLOSEST)[: DRAWS // CLOSEST]
                line.add(float(np.median(line.level_of(closest))), self._limit)
            total += line.values() - central
        return _estimate(np.clip(total, 0.0, 1.0))

    def _set_outcomes(self, known: dict[str, Estimate]) -> None:
        """Set the friction and the velocity of draws that stay or run away."""
        force = self.contact.drive(known["mean_load"].value)["force"]
        velocity = np.maximum(known["velocity"].value, 0.0)
        if "threshold" in known:
            velocity = np.where(force < known["threshold"].value, 0.0, velocity)
        away = force >= known["largest_force"].value
        known["velocity"] = _estimate(np.where(away, math.inf, velocity))
        known["friction"] = _estimate(np.minimum(force, 1.0))

    # Lines

    def _groups(self, contact: Contact, static: bool) -> np.ndarray:
        """Groups of a contact relative to the centre, shape (draws, groups)."""
        central, columns = self._centre.coordinates, []
        for name, value in contact.coordinates.items():
            reference = central[name]
            if static and name in DRIVEN:
                continue
            if name in ("poisson", "phase") or not reference:
                columns.append(value - reference)
            else:  # smooth at 0 and at infinity
                columns.append(1.0 / (1.0 + reference / np.asarray(value)) - 0.5)
        shape = np.shape(np.broadcast_arrays(*columns)[0]) or (1,)
        return np.nan_to_num(np.stack([np.broadcast_to(x, shape) for x in columns], axis=-1))

    def _lines(self, static: bool) -> list[_Line]:
        """The lines along which the answer, or the static limit, varies."""
        normal, count = self._normal, len(self._names)
        base = self._centre.inputs if static else self._inputs
        groups = self._groups(self.contact, static)
        if len(groups) == 1:
            return []
        middle = groups.mean(axis=0)
        _, sizes, axes = np.linalg.svd(groups[::8] - middle, full_matrices=False)
        rank = int(np.sum(sizes > NEGLIGIBLE * sizes[0])) if sizes[0] > 0.0 else 0

        def inputs_at(numbers: np.ndarray) -> Inputs:
            return base.at(**{n: np.float64(x) for n, x in self._drawn(numbers).items()})

        if rank >= count and rank > 1:
            units = np.eye(count)
            return [
                _Line(normal[:, k], normal[:, k], partial(_on_axis, units[k], inputs_at), None)
                for k in range(count)
            ]
        scores = (groups - middle) @ axes[:rank].T
        slopes = np.linalg.lstsq(scores, normal, rcond=None)[0]

        def place_of(axis: int, numbers: np.ndarray) -> float:
            contact = Contact(self._centre.inputs.at(**self._drawn(numbers[None, :])))
            return float((self._groups(contact, static)[0] - middle) @ axes[axis])

        lines = []
        for axis in range(rank):
            size = np.std(scores[:, axis])
            direction = np.array([1.0]) if count == 1 else slopes[axis] * size
            levels = normal[:, 0] if count == 1 else scores[:, axis] / size
            at = partial(_on_axis, direction, inputs_at)
            place = partial(_place_on_axis, direction, partial(place_of, axis))
            lines.append(_Line(scores[:, axis], levels, at, place))
        return lines


class _Line:
    """A line through the draws, along which a value is interpolated.

    Parameters
    ----------
    places : np.ndarray, shape (DRAWS,)
        Coordinate of each draw.
    draw_levels : np.ndarray, shape (DRAWS,)
        Level of each draw: its distance from the centre along the line, in standard deviations.
    inputs_at : callable
        inputs_at(level) -> Inputs.
    place_at : callable or None
        place_at(level) -> coordinate; None if it is the level.
    """

    def __init__(
        self,
        places: np.ndarray,
        draw_levels: np.ndarray,
        inputs_at: Callable[[float], Inputs],
        place_at: Callable[[float], float] | None,
    ):
        self._places, self._draw_levels = places, draw_levels
        self._inputs_at, self._place_at = inputs_at, place_at or float
        self._nodes: dict[float, float] = {}
        self.levels: dict[float, tuple[float, float]] = {}

    def start(self, central: float) -> None:
        """Begin with the value at the centre."""
        self._nodes = {self._place_at(0.0): central}
        self.levels = {0.0: (0.0, central)}

    def add(self, level: float, value: Callable[[Inputs], float]) -> None:
        """Add the value at a level, or nearer to the centre if there is none."""
        for factor in NEARER:
            try:
                number = value(self._inputs_at(factor * level))
            except (InputError, ArithmeticError):  # outside the range of the theory or the solver
                continue
            self._nodes[self._place_at(factor * level)] = number
            self.levels[level] = factor * level, number
            return

    def level_of(self, draws: np.ndarray) -> np.ndarray:
        """Levels of draws."""
        return self._draw_levels[draws]

    def values(self) -> np.ndarray:
        """Values of all draws: interpolated between the nodes, constant outside, and NaN where the
        nearest node has no value."""
        from scipy.interpolate import PchipInterpolator

        places = np.array(sorted(self._nodes))
        values = np.array([self._nodes[one] for one in places])
        good = np.isfinite(values)
        x, y = places[good], values[good]
        if len(x) < 2:
            result = np.full(self._places.shape, y[0] if len(y) else math.nan)
        else:
            result = PchipInterpolator(x, y)(np.clip(self._places, x[0], x[-1]))
        nearest = np.searchsorted(0.5 * (places[1:] + places[:-1]), self._places)
        return np.where(good[nearest], result, math.nan)


def _on_axis(direction: np.ndarray, inputs_at: Callable, level: float) -> Inputs:
    return inputs_at(level * direction)


def _place_on_axis(direction: np.ndarray, place_of: Callable, level: float) -> float:
    return place_of(level * direction)


def _estimate(draws: Any, errors: Any = None) -> Estimate:
    """An Estimate of arrays."""
    return Estimate(draws, errors or {})


def _clipped(inputs: Inputs, name: str, normal: Any) -> Any:
    """Values of an uncertain input within its range."""
    one, allowed = inputs.quantities[name], INPUTS[name]
    values = one.si + normal * one.deviation
    if allowed.low == -math.inf:  # a radius keeps its sign
        return np.copysign(np.maximum(values * np.sign(one.si), SMALLEST), one.si)
    return np.clip(values, allowed.low if allowed.zero else SMALLEST, allowed.high)


def normal_numbers(count: int) -> np.ndarray:
    """Draws of independent standard normal numbers, shape (DRAWS, count).

    They form a Kronecker sequence.  Its irrational numbers are powers of the root of
    x^(count + 1) = x + 1.
    """
    from scipy.special import ndtri

    root = 2.0
    for _ in range(60):  # each step reduces the error by at least a factor of 2
        root = (1.0 + root) ** (1.0 / (count + 1.0))
    steps = root ** -np.arange(1.0, count + 1.0)
    return ndtri(np.mod(0.5 + np.arange(1.0, DRAWS + 1.0)[:, None] * steps, 1.0))


def with_interval(one: Value, draws: Any) -> Value:
    """A Value with the standard uncertainty and the 95 % interval of its draws.  A draw without a
    value counts as infinite."""
    drawn = np.broadcast_to(np.asarray(draws, dtype=float), (DRAWS,))
    drawn = np.where(np.isnan(drawn), math.inf, drawn)
    low, high = np.quantile(drawn, INTERVAL, method="nearest")
    finite = drawn[np.isfinite(drawn)]
    spread = float(np.std(finite)) if len(finite) and np.ptp(finite) else 0.0
    if len(finite) < (1.0 - NEGLIGIBLE) * DRAWS:
        spread = math.inf
    return Value(one.value, one.error, spread, float(low), float(high))


def probabilities(contact: Contact, answer: Answer) -> dict[str, Value]:
    """Probability of each outcome under a force, with its error estimate; empty without a force.

    The error is that of the threshold, or the difference between the even and the odd draws.  It is
    at least log(DRAWS) / DRAWS, the order of the sequence's discrepancy.

    contact, answer: those of Draws.
    """
    if contact.inputs.force is None:
        return {}
    known = answer.values
    force = np.broadcast_to(contact.drive(known["mean_load"].value)["force"], (DRAWS,))
    away = force >= known["largest_force"].value
    outcomes, shift = {"runs_away": away}, 0.0
    if "threshold" in known:
        value, error = known["threshold"].value, known["threshold"].error
        stays = ~away & (force < value)
        ends = [np.mean(~away & (force < value + sign * error)) for sign in (-1.0, 1.0)]
        shift = float(max(abs(end - np.mean(stays)) for end in ends))
        outcomes |= {"stays": stays, "moves": ~away & ~stays}
    values = {}
    for name, draws in outcomes.items():
        halves = abs(float(np.mean(draws[::2]) - np.mean(draws[1::2])))
        error = max(0.0 if name == "runs_away" else shift, halves, math.log(DRAWS) / DRAWS)
        values[f"probability_{name}"] = Value(float(np.mean(draws)), error)
    return values
