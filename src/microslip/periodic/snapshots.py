"""Tractions and friction bounds at every phase of a march."""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from microslip.contact.contact import Contact, GrowingContact, Guess, March
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
    """March along a path from a state, and return tractions and forces at every phase.

    The arguments are those of contact.Contact.march, for a contact whose marches have `fields`.
    """
    march = contact.march(path, state, tolerance, previous)
    tractions = tractions_at_phases(contact, path, march)
    return Frames(tractions, march.forces, march.residual, march.solves)


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
