"""What closed forms ask of the pressure under an axisymmetric indenter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np


class IndenterPressure(Protocol):
    """The part of a pressure.Pressure of an axisymmetric indenter that closed forms ask for.

    Attributes
    ----------
    G_star, stiffness : float
        Reduced shear modulus; force per uniform displacement without slip.
    bound, depth, radius, of_load, load : callable
        See pressure.Pressure.
    """

    G_star: float
    stiffness: float
    bound: Callable
    depth: Callable
    radius: Callable
    of_load: Callable
    load: Callable

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load at a depth >= 0, any shape."""
