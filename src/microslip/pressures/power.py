"""Power-law indenters f(r) ~ r^n: a cone for n = 1, a sphere for n = 2, and flatter ends for larger
n."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from microslip.foundation import spec
from microslip.pressures.axisymmetric_indenter import Indenter

LIMITS = (1.0, 100.0)
"""Range of the exponent."""


@dataclass(frozen=True)
class Power(Indenter):
    """The pressure of an indenter with the profile r^exponent.

    Parameters
    ----------
    exponent : float
        Exponent of the profile, 1 to 100.

    Raises
    ------
    InputError
        If the exponent is outside its range.
    """

    exponent: float = 2.0

    def __post_init__(self) -> None:
        super().__post_init__()
        spec.refuse_outside(self.name, "pressure", "exponent", self.exponent, LIMITS)

    @property
    def summary(self) -> str:
        return f"an indenter with the profile r^{self.exponent:g}"

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Indentation depth for the contact radius c."""
        return np.asarray(c, float) ** self.exponent

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Derivative of the depth with respect to the contact radius."""
        return self.exponent * c ** (self.exponent - 1.0)

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Contact radius at a depth."""
        return np.maximum(depth, 0.0) ** (1.0 / self.exponent)

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Depth at which the load is `share` times the mean load."""
        return np.maximum(share, 0.0) ** (self.exponent / (self.exponent + 1.0))

    @cached_property
    def largest(self) -> float:
        """Largest friction bound.

        For exponents n up to 2 the largest bound is at the centre: (G*/pi) Integral_0^1 n x^(n - 2)
        dx = (n + 1) / (2 pi (n - 1)).
        """
        if self.exponent > 2.0:
            return super().largest
        over = 2.0 * np.pi * (self.exponent - 1.0)
        return (self.exponent + 1.0) / over if over > 0.0 else np.inf
