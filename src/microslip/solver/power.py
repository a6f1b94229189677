"""Work that the oscillation does on the contact, mean over a period."""

from __future__ import annotations

import numpy as np

from microslip.models.contact import FORWARD
from microslip.models.path import Path
from microslip.motions.problem import Problem


def oscillation_power(problem: Problem, path: Path, forces: np.ndarray) -> float:
    """Mean work of the forces along the oscillation in a radian of phase.

    The oscillation is the motion less its mean forward velocity.  An oscillating normal load adds
    nothing: at given pressure it follows from the indentation alone, which returns.

    Parameters
    ----------
    problem : problem.Problem
        What moves.
    path : path.Path
        A period, or half of one where the second half is the mirror image of the first.
    forces : np.ndarray, shape (steps + 1, 3)
        Forward force, lateral force and torque at its phases, over mu F_z and mu F_z a.

    Returns
    -------
    float
        Over mu times the mean normal load and u_lim.
    """
    moved = np.diff(path.positions, axis=0)
    work = 0.5 * np.vdot(forces[1:] + forces[:-1], moved)
    advance = problem.drift * float(path.mean(forces)[FORWARD])
    return float(work / (path.phase[-1] - path.phase[0]) - advance) / problem.mean_load
