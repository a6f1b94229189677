"""Tractions and friction bounds at every phase of a march."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple, cast

import numpy as np

from microslip.contact.contact import Contact, GrowingContact, Guess
from microslip.contact.coulomb import project
from microslip.contact.path import Path


class Frames(NamedTuple):
    """Tractions and forces at every phase of a path.

    Attributes
    ----------
    tractions : np.ndarray, shape (steps + 1, 2, ...)
        Forward and lateral tractions.
    forces : np.ndarray, shape (steps + 1, 3)
        Forces at every phase, see contact.March.
    residual : float
        Residual of the step solver summed over the stages, as a force divided by mu F_z.
    solves : int
        Number of stages.
    """

    tractions: np.ndarray
    forces: np.ndarray
    residual: float
    solves: int


def frames(
    contact: Contact,
    path: Path,
    state: np.ndarray,
    tolerance: float,
    previous: Guess | None = None,
) -> Frames:
    """March along a path and return tractions and forces at every phase.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path of the march.
    state : np.ndarray
        Tractions at the first phase.
    tolerance : float
        Tolerance of a step, as a force divided by mu F_z.
    previous : contact.March or None
        Initial guess, see contact.Contact.march.

    Returns
    -------
    Frames
        Tractions and forces, shape (steps + 1, ...).
    """
    march = contact.march(path, state, tolerance, previous)
    if march.fields is not None and path.end == 1.0:
        stages = np.moveaxis(march.fields[:: path.stages.shape[1]], 1, 0)
        at_phases = np.moveaxis(project(stages, bounds_at_phases(contact, path)), 1, 0)
        return Frames(at_phases, march.forces, march.residual, march.solves)
    tractions, residual, solves = [state], 0.0, 0
    forces: list[np.ndarray] = []
    for k in range(path.steps):
        step = replace(
            path,
            phase=path.phase[k : k + 2],
            positions=path.positions[k : k + 2],
            stages=path.stages[k : k + 1],
        )
        march = contact.march(step, tractions[-1], tolerance)
        tractions.append(march.state)
        forces += list(march.forces[1 if forces else 0 :])
        residual += march.residual
        solves += march.solves
    return Frames(np.array(tractions), np.array(forces), residual, solves)


def bounds_at_phases(contact: Contact, path: Path) -> np.ndarray:
    """Friction bounds at every phase, shape (steps + 1, 1, n), or (1, ...) if they are constant."""
    if path.depth is None:
        return contact.bound[None]
    growing = cast(GrowingContact, contact)  # since the path has a depth
    return growing.bounds_along(path)[:: path.stages.shape[1], None]
