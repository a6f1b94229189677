"""Oscillation along both directions: lines, ellipses and Lissajous figures.

    elliptic:forward=F,lateral=L,phase=P,forward_cycles=M,lateral_cycles=N

The displacement is v~ t + A F sin(M t + P) forward and A L sin(N t) lateral, in u_lim, with the
amplitude A and the phase P in degrees.  The default path is a circle.  F = 0 gives the transverse
motion, and L = 0 the longitudinal motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.motion import LOOP, Motion, stick_focus
from microslip.motions.symmetry import reverses_forward
from microslip.pressures.pressure import Pressure

MOST_CYCLES = 20
"""Largest number of cycles in a period."""


@dataclass(frozen=True)
class Elliptic(Motion):
    """Sliding forward while oscillating along two directions.

    Parameters
    ----------
    forward, lateral : float
        Amplitude in each direction divided by the amplitude of the motion, 0 to 1.
    phase : float
        Phase of the forward oscillation, in degrees.
    forward_cycles, lateral_cycles : int
        Number of cycles in a period, 1 to 20.

    Raises
    ------
    InputError
        If an amplitude is outside 0 to 1, if both amplitudes are 0, or if a number of cycles is not
        an integer from 1 to 20.
    """

    forward: float = 1.0
    lateral: float = 1.0
    phase: float = 90.0
    forward_cycles: int = 1
    lateral_cycles: int = 1

    summary = "sliding forward while oscillating along two directions"
    numbers = (
        "such as forward=0.5,phase=30: shares of A, forward and lateral (1), phase of forward in "
        "degrees (90), forward_cycles and lateral_cycles (1)"
    )
    amplitude_label = "A / u_lim"

    def __post_init__(self) -> None:
        super().__post_init__()
        shares = {"forward": self.forward, "lateral": self.lateral}
        spec.refuse_shares(self.name, "motion", shares)
        if max(shares.values()) == 0.0:
            raise InputError("motion", self.name, "allowed is forward or lateral above 0")
        cycles = {"forward_cycles": self.forward_cycles, "lateral_cycles": self.lateral_cycles}
        spec.refuse_counts(self.name, "motion", cycles, MOST_CYCLES)

    @property
    def lead(self) -> float:
        """Phase of the forward oscillation, in radians."""
        return float(np.deg2rad(self.phase % 360.0))

    @cached_property
    def reach(self) -> float:
        """Largest distance from the mean position, divided by the amplitude."""
        ahead, aside, _ = self.displacement(LOOP, 0.0, 1.0, 0.0)
        return float(np.hypot(ahead, aside).max())

    @property
    def half_period_mirror(self) -> bool:
        return self.lateral_cycles % 2 == 1 and (
            self.forward == 0.0 or self.forward_cycles % 2 == 0
        )

    @property
    def straight(self) -> bool:
        simple = self.forward_cycles == self.lateral_cycles == 1
        return simple and (self.forward == 0.0 or self.lead % np.pi == 0.0)

    @property
    def propels(self) -> bool:
        cycles = {"forward": int(self.forward_cycles), "lateral": int(self.lateral_cycles)}
        return min(self.forward, self.lateral) > 0.0 and not reverses_forward(**cycles)

    @property
    def cycles(self) -> int:
        ahead = self.forward_cycles if self.forward else 1
        return int(max(ahead, self.lateral_cycles if self.lateral else 1))

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t + A F sin(M t + P) and lateral displacement A L sin(N t)."""
        ahead = amplitude * self.forward * np.sin(self.forward_cycles * phase + self.lead)
        aside = amplitude * self.lateral * np.sin(self.lateral_cycles * phase)
        return velocity * phase + ahead, aside, np.zeros_like(phase)

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Stick radius of a straight oscillation with the amplitude `amplitude * reach`."""
        return stick_focus(amplitude * self.reach, pressure)
