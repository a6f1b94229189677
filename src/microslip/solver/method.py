"""A method: how a contact is marched and how its periodic state is found.  What ships is SHIPPED.

Others exist to be compared with it (see the package `methods`).  Each replaces a part: the
integrator, the solver of a step, the search for the periodic state, or its start.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from microslip.models.contact import Contact
from microslip.models.path import SDIRK2, Integrator


@dataclass(frozen=True)
class Method:
    """The parts of a method; what is left out is as shipped.

    In a method's file `requires`, `resolution`, `turns`, `model` and `parameters` are literals:
    they are read without running it, see method_names.declared.

    Attributes
    ----------
    summary : str
        In a line, for tables and figures.
    integrator : path.Integrator
        Where the stages of a step sit, and what they carry on.
    dress : callable or None
        Takes a contact and `parameters`; returns a contact that solves its steps in another way.
    parameters : mapping of str to float
        Numbers that `dress` takes, with their defaults.
    search : callable or None
        Replaces periodic.find_periodic_state.
    prepared : bool
        Whether to start near the static limit and with coarse steps, else once from full slip.
    extrapolated : bool
        Whether to add the difference to the run with half the steps.
    run : callable or None
        Replaces the whole simulation, as in methods/paper.py.
    model : str
        The only one that `run` stands for.
    resolution : tuple of int or None
        (cells, angles, steps a period) that `run` keeps to whatever is asked for.
    requires : str
        Package that it takes besides those of microslip.
    turns : bool
        Whether it knows motions that rotate.
    """

    summary: str
    integrator: Integrator = SDIRK2
    dress: Callable | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    search: Callable | None = None
    prepared: bool = True
    extrapolated: bool = False
    run: Callable | None = None
    model: str = ""
    resolution: tuple[int, int, int] | None = None
    requires: str = ""
    turns: bool = True

    def dressed(self, contact: Contact) -> Contact:
        """The contact with this method's solver of a step."""
        return contact if self.dress is None else self.dress(contact, **self.parameters)


SHIPPED = Method("what microslip.solve does unless told otherwise")
