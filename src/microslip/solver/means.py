"""Means over a period: forces, and the work that the oscillation does on the contact."""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.models.contact import FORWARD, Contact, GrowingContact
from microslip.models.path import Path
from microslip.motions.problem import Problem


def mean_forces(contact: Contact, problem: Problem, path: Path, forces: np.ndarray) -> np.ndarray:
    """Means over a march of the forces at its phases, shape (3,)."""
    if problem.depth is None:
        return path.mean(forces)
    # the difference from full slip, whose mean is exact, leaves less to the trapezoidal rule
    growing = cast(GrowingContact, contact)  # as its load changes
    bounds = growing.bounds(problem.depth(path.phase))
    full = contact.angles * (bounds @ contact.weight)[:, None] * [1.0, 0.0, 0.0]
    return [problem.mean_load, 0.0, 0.0] - path.mean(full - forces)


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
