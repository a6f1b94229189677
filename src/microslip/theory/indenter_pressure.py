"""The interface of closed forms to the pressure under an axisymmetric indenter."""

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

    @property
    def G_star(self) -> float: ...

    @property
    def stiffness(self) -> float: ...

    @property
    def bound(self) -> Callable: ...

    @property
    def depth(self) -> Callable: ...

    @property
    def radius(self) -> Callable: ...

    @property
    def of_load(self) -> Callable: ...

    @property
    def load(self) -> Callable: ...

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load at a depth >= 0, any shape."""
