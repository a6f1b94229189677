"""Interface through which closed forms use the pressure under an axisymmetric indenter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np


class IndenterPressure(Protocol):
    """The part of pressure.Pressure that closed forms for axisymmetric indenters use.

    Attributes
    ----------
    G_star, stiffness : float
        Reduced shear modulus, and force per unit of uniform displacement without slip.
    bound, depth, radius, of_load, load, loading : callable
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

    @property
    def loading(self) -> Callable: ...

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load at an indentation depth >= 0. The result has the shape of `depth`."""
