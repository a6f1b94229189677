"""Friction from the dataset of a sweep, such as a certified map, in place of the solver."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from microslip.answer.answer import Estimate, Result
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem

MAP = "map"
"""Model name in a Result that comes from a map."""


class FrictionMap:
    """Friction from the dataset of a sweep, through its accessor (see datasets.accessor).

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep.
    motion, pressure : str
        Motion and pressure of the contact.

    Raises
    ------
    InputError
        If the dataset has another motion or pressure, or a drive.
    """

    def __init__(self, dataset: Any, motion: str, pressure: str = "hertz"):
        attributes = getattr(dataset, "attrs", {})
        own = attributes.get("motion"), attributes.get("pressure", "hertz")
        if own != (motion, pressure):
            kind = type(dataset).__name__ if hasattr(dataset, "attrs") else dataset
            what = kind if own[0] is None else f"{own[0]}, pressure {own[1]}"
            allowed = f"allowed is the dataset of a sweep of {motion}, pressure {pressure}"
            raise InputError("map", what, allowed)
        if "drive" in attributes:
            allowed = "allowed is a map with a prescribed velocity"
            raise InputError("map", motion, f"it has a drive; {allowed}")
        self.dataset, self.motion, self.pressure = dataset, motion, pressure

    def at(
        self, velocity: Any, amplitude: Any, poisson: float | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Friction and its error bound at points.  Raises InputError about `nu`, and ValueError for
        points outside the map."""
        try:
            answer = self.dataset.microslip.at(velocity, amplitude, poisson=poisson)
        except InputError as error:
            raise (error.renamed("nu") if error.argument == "poisson" else error) from None
        return answer.mu_macro.values, answer.mu_macro_error.values

    def solve(
        self, velocity: float, amplitude: float | None, *, poisson: float, tolerance: float
    ) -> Result:
        """The answer of the map as a Result of microslip.solve.

        It is not converged if the error bound is above the tolerance, or if the map does not
        contain the point.
        """
        try:
            value, error = (float(one) for one in self.at(velocity, amplitude, poisson))
            reason = f"the error bound of the map is {error:.1e}; allowed is at most {tolerance:g}"
            reason = "" if error <= tolerance else reason
        except InputError as problem:
            value, error, reason = math.nan, math.inf, f"{problem.argument} = {problem.value}: "
            reason += problem.allowed.partition(";")[0]
        except ValueError as problem:
            value, error, reason = math.nan, math.inf, str(problem)
        point = Problem(motion_named(self.motion), velocity, amplitude, poisson)
        friction = {"friction": Estimate(value, {"model": error})}
        place = {"pressure": self.pressure, "model": MAP, "tolerance": tolerance}
        return Result.of(point, friction, reason, **place)
