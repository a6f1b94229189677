"""Mean forces and mean power of the oscillation over a period."""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.models.contact import FORWARD, Contact, GrowingContact
from microslip.models.path import Path
from microslip.motions.problem import Problem


def mean_forces(contact: Contact, problem: Problem, path: Path, forces: np.ndarray) -> np.ndarray:
    """Mean forces over a march, shape (3,).  `forces` are the forces at the phases of the path."""
    if problem.depth is None:
        return path.mean(forces)
    # the trapezoidal rule integrates only the difference from full slip, whose mean is exact
    growing = cast(GrowingContact, contact)  # because the load oscillates
    bounds = growing.bounds(problem.depth(path.phase))
    full = contact.angles * (bounds @ contact.weight)[:, None] * [1.0, 0.0, 0.0]
    return [problem.mean_load, 0.0, 0.0] - path.mean(full - forces)


def oscillation_power(problem: Problem, path: Path, forces: np.ndarray) -> float:
    """Mean power of the oscillation: work of the forces per radian of phase.

    The oscillation is the motion minus its mean forward velocity.  An oscillating normal load
    does no work over a period, since it is a function of the indentation.

    Parameters
    ----------
    problem : problem.Problem
        The problem.
    path : path.Path
        Path over a period, or over half a period if the second half is the mirror image of the
        first.
    forces : np.ndarray, shape (steps + 1, 3)
        Forward and lateral force divided by mu F_z, and torque divided by mu F_z a, at the phases
        of the path.

    Returns
    -------
    float
        Power divided by mu times the mean normal load and by u_lim.
    """
    displacement = np.diff(path.positions, axis=0)
    work = 0.5 * np.vdot(forces[1:] + forces[:-1], displacement)
    advance = problem.drift * float(path.mean(forces)[FORWARD])
    return float(work / (path.phase[-1] - path.phase[0]) - advance) / problem.mean_load
