"""Base class of contacts whose march runs in compiled code (microslip.contacts)."""

from __future__ import annotations

import signal
from collections.abc import Callable
from copy import copy
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from microslip.contacts.march import Loading, march
from microslip.contacts.operators import multiply
from microslip.contacts.splitting import best_penalty, resolvent
from microslip.contacts.system import COMPLIANCE, System
from microslip.foundation.compiled import kernel
from microslip.models.contact import MIRROR, Contact, Guess, March
from microslip.models.driven_body import Body
from microslip.models.path import Path


class Layout(NamedTuple):
    """Conversion between states (2, rows, columns) and the fields (2, points) of compiled code.

    In a state, the contacts of a body are concatenated along the columns. In a field, the points of
    each contact follow the points of the previous contact.

    Attributes
    ----------
    contacts, rows, columns : int
        Number of contacts, and number of rows and columns of each contact.
    width : int
        Number of columns of each contact in a field. Points in additional columns have area 0 and
        friction bound 0.
    """

    contacts: int
    rows: int
    columns: int
    width: int

    def pack(self, values: np.ndarray, fill: float = 0.0) -> np.ndarray:
        """Convert values to fields (..., points). The values have the shape (..., rows, columns of
        all contacts), where rows can be 1.

        fill: value at the additional points.
        """
        contacts, rows, columns, width = self
        *shape, count, _ = values.shape
        out = np.full((*shape, contacts, rows, width), fill, dtype=values.dtype)
        values = np.moveaxis(values.reshape(*shape, count, contacts, columns), -2, -3)
        out[..., :columns] = values
        return out.reshape(*shape, contacts * rows * width)

    def unpack(self, field: np.ndarray) -> np.ndarray:
        """Convert fields (..., points) to states (..., rows, columns of all contacts)."""
        contacts, rows, columns, width = self
        shape = field.shape[:-1]
        values = field.reshape(*shape, contacts, rows, width)[..., :columns]
        return np.moveaxis(values, -3, -2).reshape(*shape, rows, contacts * columns)

    def images(self, mirror: np.ndarray) -> np.ndarray:
        """Convert the flat indices of mirror images in a state to flat indices in a field."""
        place = self.pack(np.arange(mirror.size).reshape(self.rows, -1), -1)
        point = np.argsort(place, kind="stable")[np.count_nonzero(place < 0) :]
        return np.where(place < 0, np.arange(place.size), point[mirror[place]])


class SystemContact(Contact):
    """A contact with a System for compiled code; see models.contact.Contact.

    Attributes
    ----------
    layout : Layout
        Converter between states and fields.
    mirror : np.ndarray of int
        Flat index of each point's mirror image in a state, under lateral -> -lateral.
    operators : NamedTuple
        The operator A and the resolvents, see contacts/operators.py.
    resultants : np.ndarray, shape (3,)
        Forces that symmetry does not cancel; see system.System.
    """

    sticks = True
    radius = 1.0
    layout: Layout
    mirror: np.ndarray
    operators: Any
    resultants: np.ndarray
    bounds: Callable[..., np.ndarray]
    bounds_along: Callable[[Path], np.ndarray]

    def system(self) -> System:
        """Return the System with new scratch arrays, for use by one thread."""
        system = self._prepared
        return system._replace(operators=system.operators.own(), solver=system.solver.own())

    @cached_property
    def _prepared(self) -> System:
        layout = self.layout
        weight = layout.pack(np.atleast_2d(self.weight))
        points = len(weight) // layout.contacts
        return System(
            operators=self.operators,
            solver=self.solver(weight),
            scale=layout.pack(np.atleast_2d(self.compliance), 1.0),
            weight=weight,
            positions=layout.pack(np.stack([self.forward_position, self.lateral_position])),
            first=points * np.arange(layout.contacts + 1),
            mirror=layout.images(self.mirror),
            resultants=self.resultants,
            stiffness=float(self.stiffness),
        )

    def unprepared(self) -> Self:
        """Return a copy without cached properties. Attributes of the copy can be changed."""
        out = copy(self)
        for name in ("_prepared", "_constant_bound"):
            vars(out).pop(name, None)
        return out

    def solver(self, weight: np.ndarray) -> Any:
        """Create the solver of a Coulomb step for points with the areas `weight`. The solver uses
        the resolvents of rings."""
        penalty = best_penalty(self.compliance, self.layout.columns)
        return resolvent(self.layout.pack(np.atleast_2d(penalty), 1.0), weight)

    def field_bounds(self, path: Path) -> np.ndarray:
        """Friction bounds along a path, see march.Loading.bound."""
        if path.depth is None:
            return self._constant_bound
        return self.layout.pack(self.bounds_along(path)[:, None])

    @cached_property
    def _constant_bound(self) -> np.ndarray:
        return self.layout.pack(np.atleast_2d(self.bound))[None]

    def loading(self, path: Path) -> Loading:
        """Motion and friction bounds that a path imposes on the contact."""
        return Loading(path.motion, self.field_bounds(path), path.carry, float(path.end))

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Elastic displacement A q of each point under tractions q, with the shape of the state."""
        system, field = self.system(), self.layout.pack(np.asarray(state, dtype=float))
        image = np.empty_like(field)
        _displace(system, field, image)
        return self.layout.unpack(image)

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state under lateral -> -lateral. This negates lateral
        tractions."""
        return state.reshape(2, -1)[:, self.mirror].reshape(state.shape) * MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: Guess | None = None,
        *,
        body: Body | None = None,
        start: np.ndarray | None = None,
    ) -> March:
        """March along a path; see models.contact.Contact.

        body: driven body on the contact; None if the contact follows the path. start: x and x' of
        the body at the start of the path, shape (2,); None for zeros.
        """
        drive = None if body is None else body.along(path, np.zeros(2) if start is None else start)
        loading, pack, unpack = self.loading(path), self.layout.pack, self.layout.unpack
        guess = None if previous is None else previous.fields
        if guess is None or guess.shape != (len(loading.motion), *state.shape):
            guess = np.empty((0, *state.shape))
        state, guess = pack(np.asarray(state, dtype=float)), pack(guess)
        while True:
            trace = march(self.system(), loading, drive, state, guess, float(tolerance))
            if not trace.broken:
                break
            signal.raise_signal(signal.SIGINT)
        return March(
            unpack(trace.state),
            trace.forces,
            trace.residual,
            trace.iterations,
            len(trace.fields) - 1,
            unpack(trace.fields),
            trace.body,
        )


@kernel
def _displace(system: System, field: np.ndarray, image: np.ndarray) -> None:
    multiply(system.operators, COMPLIANCE, field, image)
