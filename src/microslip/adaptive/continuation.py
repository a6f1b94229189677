"""Second attempt at a run that did not converge: continuation in the velocity.

The slower the forward motion, the longer its transients.  In long transients, even small errors of
the steps accumulate to a wrong state, and the search needs a better initial guess.  So the second
attempt solves the steps to a tighter tolerance.  It first finds the periodic state at a higher
velocity, where this is easier.  Then it lowers the velocity step by step, and each run starts from
the previous run's state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from microslip.solver.effort import Effort
from microslip.solver.run import Run

FACTOR, SMALLEST_FACTOR = 4.0, 1.15
"""Ratio of successive velocities.  After a failure, the ratio is replaced by its square root, down
to SMALLEST_FACTOR."""
MOST_STEPS = 12
"""Largest number of times that the velocity is increased."""


def second_attempt(first: Run, run_at: Callable[[float, Run | None], Run], velocity: float) -> Run:
    """Run at a velocity after a run that did not converge.

    Parameters
    ----------
    first : run.Run
        The run that did not converge.
    run_at : callable
        `run_at(velocity, guess)` returns a run.Run with steps that are solved to a smaller
        tolerance.
    velocity : float
        Dimensionless velocity.

    Returns
    -------
    run.Run
        The run, with the effort of all attempts and `effort.retried` equal to 1.
    """
    attempts = [first]

    def run(velocity: float, guess: Run | None) -> Run:
        attempts.append(run_at(velocity, guess))
        return attempts[-1]

    result = _from_above(run, velocity)
    # the first reason is the most informative
    result = first if result is None else result
    return replace(result, effort=sum((one.effort for one in attempts), Effort(retried=1)))


def _from_above(run: Callable[[float, Run | None], Run], velocity: float) -> Run | None:
    """Run at a velocity by continuation from higher velocities; returns None if that fails."""
    higher = (velocity * FACTOR**step for step in range(MOST_STEPS + 1))
    above, at = next(
        ((result, v) for v in higher if (result := run(v, None)).converged), (None, velocity)
    )
    factor = FACTOR
    while at > velocity and factor > SMALLEST_FACTOR:
        lower = max(at / factor, velocity)
        result = run(lower, above)
        if result.converged:
            above, at = result, lower
        else:
            factor = factor**0.5
    return above if at == velocity else None
