"""Contacts that march in compiled code (microslip.contacts)."""

from __future__ import annotations

import signal
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from microslip.contacts.drive import Drive
from microslip.contacts.march import Loading, Trace, march
from microslip.contacts.system import System
from microslip.models.contact import MIRROR, March
from microslip.models.path import BodyPath, Path
from microslip.models.pull import Body, PulledMarch


class SystemContact(ABC):
    """A contact that is a system.System for compiled code (see models.contact.Contact).

    Attributes
    ----------
    compiled : bool
        True: the search for the periodic state runs in compiled code, too.
    """

    compiled = True
    sticks = True
    radius = 1.0
    grading = None
    edges = None

    @abstractmethod
    def system(self) -> System:
        """The System, for one thread at a time."""

    @abstractmethod
    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; both fields."""

    def field_bounds(self, path: Path) -> np.ndarray:
        """Friction bounds along a path as march.Loading has them."""
        bounds = self.bound[None] if path.depth is None else self.bounds_along(path)
        return np.ascontiguousarray(bounds if bounds.ndim == 3 else bounds[:, None])

    def loading(self, path: Path) -> Loading:
        """What a path imposes on the contact."""
        return Loading(path.motion(), self.field_bounds(path), path.carry, float(path.end))

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Tractions of a coarser contact at the points of this one; None if there is no way."""
        return None

    def affordable(self, work: float) -> float:
        """Marches until a budget has to be looked at: without one, as many as you like."""
        return np.inf

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        """Count the marches of compiled code, where there is a budget."""
        return

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """The state after lateral -> -lateral (lateral traction negated)."""
        points = state.reshape(2, -1)[:, self.system().mirror]
        return points.reshape(state.shape) * MIRROR

    def march(
        self, path: Path, state: np.ndarray, tolerance: float, previous: March | None = None
    ) -> March:
        """March along a path; see models.contact.Contact."""
        trace = self._trace(path, None, state, tolerance, previous)
        return March(**_record(trace))

    def pulled_march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        body: Body,
        start: np.ndarray,
        previous: PulledMarch | None = None,
    ) -> PulledMarch:
        """March of a driven body that is at `start` (x, x') at first; see models.pull."""
        trace = self._trace(path, body.along(path, start), state, tolerance, previous)
        return PulledMarch(**_record(trace), body=trace.body)

    def _trace(
        self,
        path: Path,
        drive: Drive | None,
        state: np.ndarray,
        tolerance: float,
        previous: March | None,
    ) -> Trace:
        loading = self.loading(path)
        guess = None if previous is None else previous.fields
        if guess is None or guess.shape != (len(loading.motion), *state.shape):
            guess = np.empty((0, *state.shape))
        state = np.ascontiguousarray(state, dtype=float)
        while True:
            trace = march(self.system(), loading, drive, state, guess, float(tolerance))
            if not trace.broken:
                return trace
            signal.raise_signal(signal.SIGINT)


def _record(trace: Trace) -> dict:
    """Arguments of a March."""
    names = ("state", "forces", "residual", "iterations", "fields")
    return {name: getattr(trace, name) for name in names} | {"solves": len(trace.fields) - 1}


def bounds_of_each(contacts: Sequence[SystemContact], path: BodyPath) -> np.ndarray:
    """Friction bounds of contacts side by side, as march.Loading has them."""
    each = zip(contacts, path.each, strict=True)
    return np.ascontiguousarray(
        np.concatenate([one.field_bounds(own) for one, own in each], axis=-1)
    )
