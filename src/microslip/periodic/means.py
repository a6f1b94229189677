"""Mean forces over a period, and the energy that friction dissipates."""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.contact.contact import Contact, GrowingContact
from microslip.contact.path import Path
from microslip.periodic.search import PeriodicState
from microslip.scene.problem import Problem


def mean_forces(contact: Contact, problem: Problem, path: Path, forces: np.ndarray) -> np.ndarray:
    """Mean forces over a march, shape (3,).  `forces` are the forces at the phases of the path."""
    if problem.depth is None:
        return path.mean(forces)
    # the mean of full slip is exact, so the trapezoidal rule integrates only the difference
    growing = cast(GrowingContact, contact)  # because the load oscillates
    bounds = growing.bounds(problem.depth(path.phase))
    full = contact.angles * (bounds @ contact.weight)[:, None] * [1.0, 0.0, 0.0]
    return [problem.mean_load, 0.0, 0.0] - path.mean(full - forces)


def dissipated_energy(contact: Contact, path: Path, periodic: PeriodicState) -> float:
    """Energy that friction dissipates in a period, divided by mu F_z u_lim.

    The elastic energy is the same at both ends of a period.  An oscillating normal load does no net
    work, because the load is a function of the indentation.  So the dissipated energy is the work
    of the tangential forces on the rigid displacements of the contact.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over a period, or over half a period if the second half is the mirror image of the
        first.
    periodic : search.PeriodicState
        The periodic state.
    """
    march, moves = periodic.march, np.diff(path.positions, axis=0)
    if len(march.body):
        moves[:, 0] += np.diff(march.body[:, 0])
    work = 0.5 * np.vdot(march.forces[1:] + march.forces[:-1], moves)
    return float(work) * 2.0 * np.pi / (path.phase[-1] - path.phase[0])
