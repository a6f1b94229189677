"""The base class of motions: displacement as a function of the phase, and its symmetries.

Names do not depend on the paper's axes: *forward* is the direction of sliding, *lateral* the one
across it, with forward x lateral such that a positive angle moves points on the positive lateral
side forward.  Displacements are in u_lim, angles in u_lim / a, time is the phase omega t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from microslip.foundation import spec
from microslip.pressures.pressure import Pressure

FOCUS_RANGE = (0.05, 0.9995)
"""Radii that rings may be graded towards; a smaller stick zone carries next to no load."""


LOOP = np.linspace(0.0, 2.0 * np.pi, 721)
"""Phases of a period, fine enough to find the extremes of an oscillation."""
HALF_PERIOD = (-np.pi / 2, np.pi / 2)
"""From one turning point of a sine to the next."""
WHOLE_PERIOD = (*HALF_PERIOD, 1.5 * np.pi)


@dataclass(frozen=True)
class Motion:
    """A prescribed motion.

    Each motion is a subclass in a file of its own.  Its fields are the numbers that may follow its
    name, as in "elliptic:forward=0.5,phase=30", which `str` writes back.  The name is that of the
    class: ContinuousBore is "continuous-bore".

    Attributes
    ----------
    summary, numbers : str
        Description in a line, and of the numbers.
    velocity_label, amplitude_label : str
        Formulas of the dimensionless groups.
    periodic : bool
        Whether the motion oscillates with period 2 pi and has an amplitude; otherwise it is steady.
    rotates : bool
        Whether the angle varies, so that tractions depend on the angle around the contact.
    half_period_mirror : bool
        Whether the motion half a period later is its own image under lateral -> -lateral, angle ->
        -angle.  Otherwise a march takes a whole period.
    straight : bool
        Whether the oscillation alone goes to and fro on a line, from the phase -pi/2 to pi/2.
    propels : bool
        Whether the oscillation alone may propel the contact forward, so that friction may be
        negative; see `symmetry.reverses_forward`.
    cycles : int
        Largest number of cycles in a period.
    half_disc : bool
        Whether half of a round contact determines the other half: by mirror symmetry across the
        lateral axis for rotations, else by point symmetry.  A rotation together with a lateral
        motion has neither.
    loads : bool
        Whether the normal load oscillates; then `depth`, `deepest` and `mean_load` count.
    """

    summary: ClassVar[str] = ""
    numbers: ClassVar[str] = ""
    velocity_label: ClassVar[str] = "v0 / (omega u_lim)"
    amplitude_label: ClassVar[str] = "A"
    periodic: ClassVar[bool] = True
    loads: ClassVar[bool] = False
    closed_form: ClassVar[Callable | None] = None
    """closed_form(velocity, amplitude, pressure) -> mean friction at nu = 0 (velocity 0: its
    limit), or None where it is not known; None for motions without one."""

    @property
    def rotates(self) -> bool:
        return False

    @property
    def half_period_mirror(self) -> bool:
        return False

    @property
    def straight(self) -> bool:
        return True

    @property
    def propels(self) -> bool:
        return False

    @property
    def cycles(self) -> int:
        return 1

    @property
    def half_disc(self) -> bool:
        return True

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "motion")

    @property
    def name(self) -> str:
        """Name with the numbers that differ from their defaults."""
        return spec.text_of(self)

    def __str__(self) -> str:
        return self.name

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward, lateral and angular displacement, arrays of the shape of the phase."""
        raise NotImplementedError

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Radius towards which rings are graded, where the traction has its kink; None: nowhere."""
        return None

    def turns(self, velocity: float, amplitude: float) -> tuple[float, ...]:
        """Turning points: phases from the start of a march to its end, half a period or a whole
        one later."""
        return HALF_PERIOD if self.half_period_mirror else WHOLE_PERIOD

    def depth(self, phase: np.ndarray, amplitude: float, pressure: Pressure) -> np.ndarray:
        """Indentation over that of the reference state, >= 0; 0 where contact is lost."""
        return np.ones_like(phase)

    def deepest(self, amplitude: float, pressure: Pressure) -> float:
        """Largest value of `depth`."""
        return 1.0

    def mean_load(self, amplitude: float, pressure: Pressure) -> float:
        """Mean of the normal load over that of the reference state."""
        return 1.0

    def drift(self, velocity: float, amplitude: float, poisson: float) -> float:
        """Mean forward displacement in one radian of phase, in u_lim.

        It is proportional to the velocity, so it is computed at velocity 1: at a small velocity it
        would drown in the rounding of the oscillation.
        """
        ends = np.array([0.0, 2.0 * np.pi])
        fast, _, _ = self.displacement(ends, 1.0, amplitude, poisson)
        still, _, _ = self.displacement(ends, 0.0, amplitude, poisson)
        gained = (fast[1] - still[1]) - (fast[0] - still[0])
        return float(gained) / (2.0 * np.pi) * velocity

    def stroke(self, amplitude: float, poisson: float) -> float:
        """Half the way that the edge of the contact oscillates, in u_lim; 0 for steady motions."""
        if not self.periodic:
            return 0.0
        ends = self.displacement(np.array([-0.5, 0.5]) * np.pi, 0.0, amplitude, poisson)
        return 0.5 * max(float(abs(part[1] - part[0])) for part in ends)


def within_rings(radius: float) -> float:
    """The radius, kept off the centre and the edge so that no ring degenerates."""
    return float(np.clip(radius, *FOCUS_RANGE))


def stick_focus(reach: float, pressure: Pressure) -> float | None:
    """Stick radius after a displacement `reach` (u_lim) along a line and back (Eq 8 for a sphere);
    None at full slip, or if the stick zone is not a circle."""
    radius = pressure.stick_radius(reach) if reach < 1.0 else None
    return None if radius is None else within_rings(radius)
