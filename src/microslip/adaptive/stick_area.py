"""Stick area over a period: shares of the contact area, right and left, and single moments."""

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
    """Stick and slip over a period of the periodic state, reduced to what figures and checks need.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson, cells, angles, steps
        As for `microslip.period`; a motion whose second half of a period mirrors the first.

    Returns
    -------
    dict
        - mu_macro, converged, reason: as for `microslip.solve`.
        - phase, stick_right, stick_left: over the steps, the last two the shares of the contact's
          area that stick at positive and at negative lateral positions.
        - least_stick: of both together.
        - forward_position, lateral_position, area: of the points, units a and a^2; the areas add up
          to pi.
        - moment_phase: phases of single moments: when least of the contact sticks in a stroke, the
          middle of the stroke, and the same of the stroke back.
        - moment_share, shape (moments, points): size of the traction over the bound there, 1 where
          a point slips.

    Raises
    ------
    InputError
        As for `microslip.period`.
    """
    sizes = {"cells": cells, "angles": angles, "steps": steps}
    found = period(motion, velocity, amplitude, pressure=pressure, poisson=poisson, **sizes)
    sticking = np.where(found.slips, 0.0, found.area / np.pi)
    right = found.lateral_position > 0.0
    # the first row repeats the last one: a stroke is rows 1 to half
    half = steps // 2
    least = 1 + int(np.argmin(sticking[1 : half + 1].sum(axis=1)))
    moments = np.array([least, half // 2, least + half, half // 2 + half])
    share = np.hypot(found.traction_forward, found.traction_lateral)[moments] / found.bound
    return {
        "mu_macro": found.mu_macro,
        "converged": found.converged,
        "reason": found.reason,
        "phase": found.phase,
        "stick_right": sticking[:, right].sum(axis=1),
        "stick_left": sticking[:, ~right].sum(axis=1),
        "least_stick": sticking[1:].sum(axis=1).min(),
        "forward_position": found.forward_position,
        "lateral_position": found.lateral_position,
        "area": found.area,
        "moment_phase": found.phase[moments],
        "moment_share": np.where(found.slips[moments], 1.0, np.minimum(share, 1.0)),
    }
