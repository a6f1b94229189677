"""Stick area as a fraction of the contact area over a period, and tractions at four moments."""

from __future__ import annotations

import numpy as np

from microslip.adaptive.period import period
from microslip.pressures.hertz import HERTZ


def patches(
    motion: str,
    velocity: float,
    amplitude: float,
    *,
    pressure: str = HERTZ.name,
    poisson: float = 0.0,
    cells: int = 16,
    angles: int = 16,
    steps: int = 64,
) -> dict:
    """Compute stick and slip over one period of the periodic state, for figures and checks.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson, cells, angles, steps
        See `microslip.period`.  The second half of the period is assumed to mirror the first.

    Returns
    -------
    dict
        - mu_macro, converged, reason: see `microslip.solve`.
        - phase, shape (steps + 1,): phase in radians.
        - stick_right, stick_left, shape (steps + 1,): stick area at positive and at negative
          lateral positions, as fractions of the contact area.
        - least_stick: smallest sum of `stick_right` and `stick_left` over the period.
        - forward_position, lateral_position, area: positions of the points in units of a and their
          areas in units of a^2; the sum of the areas is pi.
        - moment_phase: phases of four moments.  At the first one, the stick area is smallest in
          a stroke.  The second is the middle of the stroke.  The others are half a period later.
        - moment_share, shape (moments, points): traction divided by the friction bound at these
          moments; 1 at points that slip.

    Raises
    ------
    InputError
        See `microslip.period`.
    """
    sizes = {"cells": cells, "angles": angles, "steps": steps}
    cycle = period(motion, velocity, amplitude, pressure=pressure, poisson=poisson, **sizes)
    sticking = np.where(cycle.slips, 0.0, cycle.area / np.pi)
    right = cycle.lateral_position > 0.0
    # the first row repeats the last one, so a stroke consists of rows 1 to half
    half = steps // 2
    least = 1 + int(np.argmin(sticking[1 : half + 1].sum(axis=1)))
    moments = np.array([least, half // 2, least + half, half // 2 + half])
    share = np.hypot(cycle.traction_forward, cycle.traction_lateral)[moments] / cycle.bound
    return {
        "mu_macro": cycle.mu_macro,
        "converged": cycle.converged,
        "reason": cycle.reason,
        "phase": cycle.phase,
        "stick_right": sticking[:, right].sum(axis=1),
        "stick_left": sticking[:, ~right].sum(axis=1),
        "least_stick": sticking[1:].sum(axis=1).min(),
        "forward_position": cycle.forward_position,
        "lateral_position": cycle.lateral_position,
        "area": cycle.area,
        "moment_phase": cycle.phase[moments],
        "moment_share": np.where(cycle.slips[moments], 1.0, np.minimum(share, 1.0)),
    }
