"""Base class of motions: displacement as a function of the phase, and symmetries.

*Forward* is the direction of sliding, and *lateral* is perpendicular to it.  A positive angle moves
points with a positive lateral coordinate forward.  Displacements are in u_lim, angles in u_lim / a,
and time is the phase omega t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from microslip.foundation import spec
from microslip.pressures.pressure import Pressure

FOCUS_RANGE = (0.05, 0.9995)
"""Range of radii towards which rings are graded.  A smaller stick zone carries almost no load."""

LOOP = np.linspace(0.0, 2.0 * np.pi, 721)
"""Phases of a period at which the extremes of an oscillation are evaluated."""
HALF_PERIOD = (-np.pi / 2, np.pi / 2)
"""Phases of two consecutive turning points of a sine."""
WHOLE_PERIOD = (*HALF_PERIOD, 1.5 * np.pi)
"""Phases of three consecutive turning points of a sine.  They span a whole period."""


@dataclass(frozen=True)
class Motion:
    """A prescribed motion.

    Each motion is a subclass in its own file.  The fields of the class are the numbers that may
    follow the motion's name in a text such as "elliptic:forward=0.5,phase=30"; `str` returns this
    text.  The motion's name is derived from the class name: ContinuousBore has the name
    "continuous-bore".

    Attributes
    ----------
    summary, numbers : str
        Description of the motion in one line, and description of its numbers.
    velocity_label, amplitude_label : str
        Formulas of the dimensionless velocity and amplitude.
    periodic : bool
        Whether the motion has an amplitude and the period 2 pi; otherwise it is steady.
    rotates : bool
        Whether the contact rotates.  In a rotation, the tractions depend on the polar angle.
    half_period_mirror : bool
        Whether the second half of a period equals the first half with the lateral displacement and
        the angle reversed.  If False, a march covers a whole period.
    straight : bool
        Whether the oscillation alone follows a straight line and turns at the phases -pi/2 and
        pi/2.
    propels : bool
        Whether the oscillation alone can propel the contact, so that the mean friction can be
        negative; see `symmetry.reverses_forward`.
    cycles : int
        Largest number of cycles that a component has in a period.
    half_disc : bool
        Whether the tractions on one half of a round contact follow by symmetry from those on the
        other half.  The symmetry is a mirror across the lateral axis for rotations, and a point
        reflection for other motions.  A rotation combined with a lateral motion has neither
        symmetry.
    loads : bool
        Whether the normal load oscillates, as described by `depth`, `deepest` and `mean_load`.
    readings : tuple of Motion
        Alternative motions through the same samples.  The difference in friction between these
        motions serves as an error estimate.
    """

    summary: ClassVar[str] = ""
    numbers: ClassVar[str] = ""
    velocity_label: ClassVar[str] = "v0 / (omega u_lim)"
    amplitude_label: ClassVar[str] = "A"
    periodic: ClassVar[bool] = True
    loads: ClassVar[bool] = False
    closed_form: ClassVar[Callable | None] = None
    """closed_form(velocity, amplitude, pressure) -> mean friction and dissipated energy per period
    at nu = 0.  Velocity 0 is the static limit.  The function returns None for arguments without a
    closed form.  The attribute is None for motions without a closed form."""

    @property
    def readings(self) -> tuple[Motion, ...]:
        return ()

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
        """Name of the motion, followed by the numbers that differ from their defaults."""
        return spec.text_of(self)

    def __str__(self) -> str:
        return self.name

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward, lateral and angular displacement, each with the shape of `phase`."""
        raise NotImplementedError

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Radius of a kink in the traction, towards which rings are graded; None without a kink."""
        return None

    def turns(self, velocity: float, amplitude: float) -> tuple[float, ...]:
        """Phases of the turning points during a march, including its start and its end.  A march
        covers half a period or a period."""
        return HALF_PERIOD if self.half_period_mirror else WHOLE_PERIOD

    def depth(self, phase: np.ndarray, amplitude: float, pressure: Pressure) -> np.ndarray:
        """Indentation depth divided by its reference value, >= 0; 0 if there is no contact."""
        return np.ones_like(phase)

    def deepest(self, amplitude: float, pressure: Pressure) -> float:
        """Largest value of `depth` in a period."""
        return 1.0

    def mean_load(self, amplitude: float, pressure: Pressure) -> float:
        """Mean normal load divided by its reference value."""
        return 1.0

    def drift(self, velocity: float, amplitude: float, poisson: float) -> float:
        """Mean forward displacement per radian of phase, in u_lim.

        The drift is proportional to the velocity.  It is computed at velocity 1 and scaled, because
        at small velocities the rounding error of the oscillation would exceed the drift.
        """
        ends = np.array([0.0, 2.0 * np.pi])
        fast, _, _ = self.displacement(ends, 1.0, amplitude, poisson)
        still, _, _ = self.displacement(ends, 0.0, amplitude, poisson)
        advance = (fast[1] - still[1]) - (fast[0] - still[0])
        return float(advance) / (2.0 * np.pi) * velocity

    def stroke(self, amplitude: float, poisson: float) -> float:
        """Half the peak-to-peak displacement of the edge of the contact, in u_lim; 0 for steady
        motions."""
        if not self.periodic:
            return 0.0
        ends = self.displacement(np.array([-0.5, 0.5]) * np.pi, 0.0, amplitude, poisson)
        return 0.5 * max(float(abs(part[1] - part[0])) for part in ends)


def within_rings(radius: float) -> float:
    """Clip a radius to FOCUS_RANGE, so that no ring degenerates at the centre or the edge."""
    return float(np.clip(radius, *FOCUS_RANGE))


def stick_focus(reach: float, pressure: Pressure) -> float | None:
    """Stick radius of an oscillation along a line with the amplitude `reach`, in u_lim.

    For a sphere, it is Eq 8.  The result is None at full slip, or if the stick zone is not a
    circle.
    """
    radius = pressure.stick_radius(reach) if reach < 1.0 else None
    return None if radius is None else within_rings(radius)
