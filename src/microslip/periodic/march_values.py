"""Values of a march: tractions and bounds at each phase, mean forces, dissipated energy."""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.contact.contact import Contact, GrowingContact, March
from microslip.contact.coulomb import project
from microslip.contact.path import Path
from microslip.scene.problem import Problem


def tractions_at_phases(contact: Contact, path: Path, march: March) -> np.ndarray:
    """Tractions of a march at every phase of its path, shape (steps + 1, 2, ...)."""
    assert march.fields is not None  # true for contacts whose points can stick
    stages = np.moveaxis(march.fields[:: path.stages.shape[1]], 1, 0)
    tractions = np.moveaxis(project(stages, bounds_at_phases(contact, path)), 1, 0)
    if path.end < 1.0:  # extrapolate from the stage of each step
        tractions[0] = march.fields[0]
        for before, at in zip(tractions, tractions[1:], strict=False):
            at += (1.0 / path.end - 1.0) * (at - before)
    return tractions


def bounds_at_phases(contact: Contact, path: Path) -> np.ndarray:
    """Friction bounds at every phase, shape (steps + 1, 1, n), or (1, ...) if they are constant."""
    if path.depth is None:
        return contact.bound[None]
    growing = cast(GrowingContact, contact)  # since the path has a depth
    return growing.bounds_along(path)[:: path.stages.shape[1], None]


def mean_forces(contact: Contact, problem: Problem, path: Path, forces: np.ndarray) -> np.ndarray:
    """Mean forces over a march, shape (3,).  `forces` are the forces at the phases of the path."""
    if problem.depth is None:
        return path.mean(forces)
    # the mean of full slip is exact, so the trapezoidal rule integrates only the difference
    growing = cast(GrowingContact, contact)  # because the load oscillates
    bounds = growing.bounds(problem.depth(path.phase))
    full = contact.angles * (bounds @ contact.weight)[:, None] * [1.0, 0.0, 0.0]
    return [problem.mean_load, 0.0, 0.0] - path.mean(full - forces)


def dissipated_energy(contact: Contact, path: Path, march: March) -> float:
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
    march : March
        March along this path from a periodic state.
    """
    moves = np.diff(path.positions, axis=0)
    if len(march.body):
        moves[:, 0] += np.diff(march.body[:, 0])
    work = 0.5 * np.vdot(march.forces[1:] + march.forces[:-1], moves)
    return float(work) * 2.0 * np.pi / (path.phase[-1] - path.phase[0])
