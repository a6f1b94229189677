"""A numerical method: integrator, step solver and search for the periodic state.

The shipped method is the default of `microslip.solve`.  The other methods are for comparison.  Each
of these methods replaces one part (the integrator, the step solver, the search or its initial
state) or the whole simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from microslip.contact.path import EULER, SDIRK2, Integrator, theta_method
from microslip.periodic.methods import SHIPPED


@dataclass(frozen=True)
class Method:
    """The parts of a numerical method.  The defaults are those of the shipped method.

    In the file of a method, `requires`, `resolution`, `turns`, `model` and `parameters` must be
    literals, since methods.declared reads them without running the file.

    Attributes
    ----------
    summary : str
        Description in one line, for tables and figures.
    integrator : path.Integrator
        Time integrator of a step.
    dress : callable or None
        `dress(contact, **parameters)` returns the contact with another step solver.
    parameters : mapping of str to float
        Keyword arguments of `dress`, with their defaults.
    search : callable or None
        Function that replaces search.find_periodic_state.
    prepared : bool
        Whether the search starts near the static limit.  Otherwise it starts from full slip.
    run : callable or None
        Function that replaces the whole simulation, as in methods/paper.py.
    model : str
        The only model that `run` supports.
    resolution : tuple of int or None
        Fixed resolution of `run`: number of cells, of angles and of steps in a period.
    requires : str
        Package that the method needs in addition to the dependencies of microslip.
    turns : bool
        Whether the method supports rotations.
    """

    summary: str
    integrator: Integrator = SDIRK2
    dress: Callable | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    search: Callable | None = None
    prepared: bool = True
    run: Callable | None = None
    model: str = ""
    resolution: tuple[int, int, int] | None = None
    requires: str = ""
    turns: bool = True


OWN = {
    SHIPPED: Method("what microslip.solve does unless told otherwise"),
    # robust and first order; tractions never exceed the friction bound
    "euler": Method("backward Euler, first order", integrator=EULER),
    # Coulomb's law is satisfied in the middle of a step.  The tractions at the end of the step are
    # extrapolated and can exceed the friction bound.  An error recurs in the next step with the
    # opposite sign.
    "midpoint": Method("implicit midpoint rule, undamped", integrator=theta_method(0.5)),
}
"""Methods of the package that need no file, by name.  These methods replace the integrator of the
shipped method, or nothing."""
