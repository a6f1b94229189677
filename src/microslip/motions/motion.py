"""The record of a motion: where it goes, which symmetries it has, what pressure it is under.

Names do not depend on the paper's axes: *forward* is the direction of sliding, *lateral* the one
across it, with forward x lateral such that a positive angle moves points on the positive lateral
side forward.  Displacements are in u_lim, angles in u_lim / a, time is the phase omega t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from microslip.pressures.by_name import HERTZ, Pressure

FOCUS_RANGE = (0.05, 0.9995)
"""Radii that rings may gather at; a stick zone smaller than the first carries next to no load."""


LOOP = np.linspace(0.0, 2.0 * np.pi, 721)
"""Phases of a period, close enough to see where an oscillation goes."""
HALF_PERIOD = (-np.pi / 2, np.pi / 2)
"""From one turning point of a sine to the next."""


@dataclass(frozen=True)
class Motion:
    """One kind of motion.

    Attributes
    ----------
    name, summary : str
        As it is asked for, and in a line.
    displacement : callable
        displacement(phase, velocity, amplitude, poisson) -> (forward, lateral, angle), arrays of
        the shape of the phase.
    periodic : bool
        The motion oscillates with period 2 pi and needs an amplitude; otherwise it is steady.
    rotates : bool
        The angle is not zero, so tractions depend on the angle around the contact.
    half_period_mirror : bool
        Half a period later the motion is its own image under lateral -> -lateral.  Without it a
        whole period is marched.
    focus : callable
        focus(velocity, amplitude, pressure): radius where the traction has its kink (None: nowhere
        special).
    velocity_label, amplitude_label : str
        Formulas of the dimensionless groups.
    turns : callable
        turns(velocity, amplitude): phases at which the motion turns, from where a march begins to
        where it ends, half a period later or a whole one.
    straight : bool
        The oscillation alone goes to and fro on a line, from the phase -pi/2 to pi/2.
    propels : bool
        The oscillation alone may propel the contact forward, so that friction may be negative;
        without it the mean force resists, see theory/bounds.py and mirror_image.reverses_forward.
    cycles : int
        Of the oscillation in a period, along the direction that has more.
    half_disc : bool
        Half of a round contact tells the other half: where the motion rotates by mirror symmetry
        across the lateral axis, else by point symmetry.  A rotation together with a lateral motion
        has neither, and all of the disc is resolved.
    pressure : pressure.Pressure
        How the load is spread; it does not change while the contact moves.
    depth : callable or None
        depth(phase, amplitude, pressure): indentation over that of the reference state, >= 0 (0: no
        contact), of the shape of the phase; None: it does not change.
    deepest, mean_load : callable
        Of (amplitude, pressure): its largest value, and the mean of the normal load over that of
        the reference state.
    whole : callable or None
        whole(velocity, amplitude, pressure): mean friction in closed form at nu = 0, velocity 0 as
        its limit, or None if there is none; None: there never is.
    """

    name: str
    summary: str
    displacement: Callable
    periodic: bool
    rotates: bool
    half_period_mirror: bool
    focus: Callable
    velocity_label: str
    amplitude_label: str = ""
    turns: Callable = lambda velocity, amplitude: HALF_PERIOD
    straight: bool = True
    propels: bool = False
    cycles: int = 1
    half_disc: bool = True
    pressure: Pressure = HERTZ
    depth: Callable | None = None
    deepest: Callable = lambda amplitude, pressure: 1.0
    mean_load: Callable = lambda amplitude, pressure: 1.0
    closed_form_of: Callable | None = None

    def creep(self, velocity: float, amplitude: float, poisson: float) -> float:
        """Mean forward displacement in one radian of phase, in u_lim.

        It is proportional to the velocity, so that it is taken at one which the oscillation, whose
        return is rounded, does not drown.
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
    """Where the contact would stick if it went so far (u_lim) along a line and back (Eq 8 for a
    sphere); nowhere once all of it slides, or if that is not a circle."""
    radius = pressure.stick_radius(reach) if reach < 1.0 else None
    return None if radius is None else within_rings(radius)
