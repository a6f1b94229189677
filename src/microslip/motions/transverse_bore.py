"""Oscillation sideways and in rotation at once.

    transverse-bore:lateral=L,angle=B,phase=P

moves by lateral A L sin(t) and turns by the bore amplitude A B, angle ~ sin(t + P): P in degrees, A
the amplitude.  B = 0 is the transverse motion, L = 0 the bore with its velocity over omega u_lim.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.motion import Motion, stick_focus, within_rings
from microslip.theory import hertz

SUMMARY = "sliding forward while oscillating sideways and in rotation"
HELP = (
    "such as angle=0.5,phase=90: shares of A, lateral (1, over u_lim) and angle (1, over "
    "phi_lk(a/2)), phase of the rotation in degrees (0)"
)
DEFAULTS = {"lateral": 1.0, "angle": 1.0, "phase": 0.0}


def motion(name: str, lateral: float, angle: float, phase: float) -> Motion:
    """The Motion of these numbers; raises InputError for shares below 0, and none at all."""
    spec.refuse_shares(name, "motion", {"lateral": lateral, "angle": angle})
    if max(lateral, angle) == 0.0:
        raise InputError("motion", name, "allowed is lateral or angle above 0")
    lead = np.deg2rad(phase % 360.0) if lateral > 0.0 else 0.0

    def displacement(phase, velocity, amplitude, poisson):
        turned = hertz.bore_angle(amplitude * angle, poisson) * np.sin(phase + lead)
        return velocity * phase, amplitude * lateral * np.sin(phase), turned

    def focus(velocity, amplitude, pressure):
        if lateral > 0.0:
            return stick_focus(amplitude * lateral, pressure)
        return within_rings(hertz.lubkin_stick_radius(hertz.bore_angle(amplitude * angle)))

    return Motion(
        name=name,
        summary=SUMMARY,
        displacement=displacement,
        periodic=True,
        rotates=angle > 0.0,
        half_disc=angle == 0.0 or lateral == 0.0,
        half_period_mirror=True,
        focus=focus,
        velocity_label="v0 / (omega u_lim)",
        amplitude_label="A",
        straight=angle == 0.0 or lead % np.pi == 0.0,
    )
