"""Oscillation of the normal load or of the indentation, with or without an in-plane oscillation.

    normal:load=1,indentation=0,lateral=L,forward=F,angle=B,phase=P,normal_cycles=K,...

With the amplitude A, the normal load divided by its reference value is 1 + A load sin(K t).  If
`indentation` is above 0, the indentation depth divided by its reference value is 1 + A indentation
sin(K t) instead.  There is no contact while the formula gives a load or a depth below 0.  The
in-plane displacement is v~ t + A F sin(M t + P) forward and A L sin(N t + P) lateral, in u_lim.
The angle is sin(Q t + P) times the largest angle of a bore with the amplitude A B.  P is in
degrees.  The units u_lim, a and mu F_z are those of the state without oscillation.  Friction is
divided by mu times the actual mean load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.elliptic import MOST_CYCLES
from microslip.motions.motion import Motion, within_rings
from microslip.motions.symmetry import reverses_forward
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz, oscillating_load


@dataclass(frozen=True)
class Normal(Motion):
    """Sliding forward while the normal load or the indentation oscillates.

    Parameters
    ----------
    load, indentation : float
        Amplitude of the load or of the indentation, divided by the amplitude of the motion, 0 to 1.
        `load` must keep its default of 1 if `indentation` is above 0.
    lateral, forward, angle : float
        In-plane amplitudes divided by the amplitude of the motion, 0 to 1.  The units are u_lim for
        displacements and phi_lk(a/2) for the angle.
    phase : float
        Phase of the oscillation in the plane, in degrees.
    normal_cycles, lateral_cycles, forward_cycles, angle_cycles : int
        Number of cycles in a period, 1 to 20.

    Raises
    ------
    InputError
        If an amplitude is outside 0 to 1, if neither the load nor the indentation oscillates, if
        both are set, or if a number of cycles is not an integer from 1 to 20.
    """

    load: float = 1.0
    indentation: float = 0.0
    lateral: float = 0.0
    forward: float = 0.0
    angle: float = 0.0
    phase: float = 0.0
    normal_cycles: int = 1
    lateral_cycles: int = 1
    forward_cycles: int = 1
    angle_cycles: int = 1

    summary = "sliding forward while the normal load oscillates, or the indentation"
    numbers = (
        "such as lateral=1,phase=90: fractions of A, load (1, divided by the mean) or indentation "
        "(0: the load oscillates), lateral and forward (0, divided by u_lim), angle (0, divided by "
        "phi_lk(a/2)), phase of these in degrees (0), normal_cycles, lateral_cycles, "
        "forward_cycles and angle_cycles (1)"
    )
    loads = True

    def __post_init__(self) -> None:
        super().__post_init__()
        in_plane = {"lateral": self.lateral, "forward": self.forward, "angle": self.angle}
        normal = {"load": self.load, "indentation": self.indentation}
        spec.refuse_shares(self.name, "motion", normal | in_plane)
        if self.load == self.indentation == 0.0:
            raise InputError("motion", self.name, "allowed is load or indentation above 0")
        if self.indentation > 0.0 and self.load != 1.0:
            allowed = f"load = {self.load:g}: allowed is no load beside an indentation"
            raise InputError("motion", self.name, allowed)
        names = ("normal_cycles", "lateral_cycles", "forward_cycles", "angle_cycles")
        cycles = {name: getattr(self, name) for name in names}
        spec.refuse_counts(self.name, "motion", cycles, MOST_CYCLES)

    @property
    def lead(self) -> float:
        """Phase of the oscillation in the plane, in radians."""
        return float(np.deg2rad(self.phase % 360.0))

    @property
    def by_load(self) -> bool:
        """Whether the load is prescribed; otherwise the indentation is."""
        return self.indentation == 0.0

    @property
    def share(self) -> float:
        """Amplitude of the load or of the indentation, divided by the amplitude of the motion."""
        return self.load if self.by_load else self.indentation

    @property
    def in_plane(self) -> dict[str, int]:
        """Number of cycles of each oscillating in-plane component, by name."""
        components = {
            "lateral": (self.lateral, self.lateral_cycles),
            "forward": (self.forward, self.forward_cycles),
            "angle": (self.angle, self.angle_cycles),
        }
        return {name: int(cycles) for name, (size, cycles) in components.items() if size}

    @property
    def rotates(self) -> bool:
        return self.angle > 0.0

    @property
    def half_disc(self) -> bool:
        return self.angle == 0.0 or self.lateral == 0.0

    @property
    def half_period_mirror(self) -> bool:
        cycles = self.in_plane
        ahead = cycles.pop("forward", 2)
        odd = all(count % 2 == 1 for count in cycles.values())
        return self.normal_cycles % 2 == 0 and ahead % 2 == 0 and odd

    @property
    def straight(self) -> bool:
        return not self.in_plane

    @property
    def propels(self) -> bool:
        cycles = self.in_plane | {"forward": int(self.forward_cycles)}
        return self.forward > 0.0 and not reverses_forward(**cycles, load=int(self.normal_cycles))

    @property
    def cycles(self) -> int:
        return max(int(self.normal_cycles), *self.in_plane.values(), 1)

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t + A F sin(M t + P), lateral displacement A L sin(N t + P), and
        an angle proportional to sin(Q t + P)."""
        ahead = amplitude * self.forward * np.sin(self.forward_cycles * phase + self.lead)
        aside = amplitude * self.lateral * np.sin(self.lateral_cycles * phase + self.lead)
        turn = np.sin(self.angle_cycles * phase + self.lead)
        return (
            velocity * phase + ahead,
            aside,
            hertz.bore_angle(amplitude * self.angle, poisson) * turn,
        )

    def turns(self, velocity: float, amplitude: float) -> tuple[float, ...]:
        """Phases at intervals of pi, starting at the smallest load of the first cycle."""
        least = -0.5 * np.pi / self.normal_cycles
        return tuple(least + np.pi * np.arange(2 if self.half_period_mirror else 3))

    def depth(self, phase: np.ndarray, amplitude: float, pressure: Pressure) -> np.ndarray:
        """Indentation depth divided by its reference value, >= 0."""
        height = 1.0 + amplitude * self.share * np.sin(self.normal_cycles * phase)
        height = np.maximum(height, 0.0)
        return pressure.of_load(height) if self.by_load else height

    def _extreme(self, sign: float, amplitude: float, pressure: Pressure) -> float:
        """Smallest (sign = -1) or largest (sign = 1) indentation depth."""
        height = max(1.0 + sign * amplitude * self.share, 0.0)
        return float(pressure.of_load(height)) if self.by_load else height

    def deepest(self, amplitude: float, pressure: Pressure) -> float:
        """Largest indentation depth divided by its reference value."""
        return self._extreme(1.0, amplitude, pressure)

    def mean_load(self, amplitude: float, pressure: Pressure) -> float:
        """Mean normal load divided by its reference value."""
        return oscillating_load.mean_load(amplitude * self.share, self.by_load, pressure)

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Smallest contact radius in a period divided by the largest contact radius."""
        least = pressure.radius(self._extreme(-1.0, amplitude, pressure))
        return within_rings(least / pressure.radius(self.deepest(amplitude, pressure)))

    def closed_form(
        self, velocity: float, amplitude: float, pressure: Pressure
    ) -> tuple[float, float] | None:
        """Friction and energy for axisymmetric indenters if there is no in-plane oscillation."""
        if self.in_plane or not pressure.is_indenter:
            return None
        slow = velocity / self.normal_cycles
        mu = oscillating_load.friction(slow, amplitude * self.share, self.by_load, pressure)
        return mu, 2.0 * np.pi * velocity * mu * self.mean_load(amplitude, pressure)
