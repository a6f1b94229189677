"""A run that found no periodic state, done again by safer steps.

The slower the forward motion, the less a period forgets its start: the smaller are the errors of
the steps that add up to a wrong state, and the nearer a search has to start to where it is to end.
So steps are solved tighter, and the periodic state is followed in the velocity: at a higher one the
same point is easier, and from there on the velocity is lowered from state to state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from microslip.solver.effort import Effort
from microslip.solver.run import Run

FACTOR, SMALLEST_FACTOR = 4.0, 1.15
"""From one velocity to the next: where a search fails the factor is replaced by its root, until it
is less than the second one."""
MOST_STEPS = 12
"""Times that the velocity is raised at most."""


def run_safely(run_at: Callable, velocity: float, guess: Run | None) -> Run:
    """The run at a velocity; where it does not converge, one by safer steps.

    Parameters
    ----------
    run_at : callable
        run_at(velocity, guess, tighter) -> run.Run; tighter: solve the steps tighter.
    velocity : float
        Dimensionless.
    guess : run.Run or None
        One to start near.

    Returns
    -------
    run.Run
        It counts the effort of all that was tried; its `retried` is 1 if there was more than one.
    """
    first = run_at(velocity, guess, False)
    if first.converged:
        return first
    tried = [first]

    def run(velocity: float, guess: Run | None) -> Run:
        tried.append(run_at(velocity, guess, True))
        return tried[-1]

    found = _from_above(run, velocity)
    # a failure is best explained by the first one
    shown = first if found is None else found
    return replace(shown, effort=sum((one.effort for one in tried), Effort(retried=1)))


def _from_above(run: Callable[[float, Run | None], Run], velocity: float) -> Run | None:
    """The Run at a velocity, if need be by way of higher ones; None if it is not to be had."""
    higher = (velocity * FACTOR**step for step in range(MOST_STEPS + 1))
    above, at = next(
        ((found, v) for v in higher if (found := run(v, None)).converged), (None, velocity)
    )
    factor = FACTOR
    while at > velocity and factor > SMALLEST_FACTOR:
        lower = max(at / factor, velocity)
        found = run(lower, above)
        if found.converged:
            above, at = found, lower
        else:
            factor = factor**0.5
    return above if at == velocity else None
