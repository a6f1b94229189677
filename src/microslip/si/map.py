"""Friction from the dataset of a sweep, such as a certified map, in place of the solver."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from microslip.answer.answer import Estimate, Result
from microslip.foundation.errors import InputError
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

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
        what = f"{own[0]}, pressure {own[1]}"
        if own[0] is None:
            what = type(dataset).__name__ if hasattr(dataset, "attrs") else dataset
        allowed = f"allowed is the dataset of a sweep of {motion}, pressure {pressure}"
        if own != (motion, pressure) or "drive" in attributes:
            raise InputError("map", what, f"{allowed}, with a prescribed velocity")
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

    def solve(self, velocity: float, amplitude: float | None, poisson: float, tol: float) -> Result:
        """The answer of the map as a Result of microslip.solve.  It is not converged if the error
        bound is above the tolerance, or if the point is outside the map."""
        value, error = math.nan, math.inf
        try:
            value, error = (float(one) for one in self.at(velocity, amplitude, poisson))
            reason = f"the error bound of the map is {error:.1e}; allowed is at most {tol:g}"
        except InputError as problem:
            reason = f"{problem.argument} = {problem.value}: {problem.allowed.partition(';')[0]}"
        except ValueError as problem:
            reason = str(problem)
        reason = "" if error <= tol else reason
        point = Problem(motion_named(self.motion), velocity, amplitude, poisson)
        friction = {"friction": Estimate(value, {"model": error})}
        place = {"pressure": self.pressure, "model": MAP, "tolerance": tol}
        return Result.of(point, friction, reason, **place)
