"""Friction of one contact, or of a body on several contacts, at a prescribed velocity."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from microslip.adaptive.closed_forms import exact_for, of_closed_form
from microslip.adaptive.request import Request
from microslip.adaptive.result import CLOSED_FORM, Result
from microslip.estimate.estimate import Estimate
from microslip.solver.effort import Effort


def solve_each(request: Request) -> Result:
    """Solve each contact separately; for several contacts, return the mean of their Results."""
    problem = request.problem
    if not problem.parts:
        return _solve(request)
    alone = {}
    for part in problem.parts:
        if part.problem not in alone:
            alone[part.problem] = _solve(replace(request, problem=part.problem))
    results = list(alone.values())

    each = zip(problem.shares, problem.parts, strict=True)
    means = [share * alone[part.problem].friction for share, part in each]
    dissipated = (
        (part.share * part.extent, alone[part.problem].dissipation) for part in problem.parts
    )
    energies = [unit * energy for unit, energy in dissipated if energy]

    def most(name: str) -> Any:
        return max(getattr(result, name) for result in results)

    by_runs = [result for result in results if result.model != CLOSED_FORM]
    return Result(
        **request.point,
        model=by_runs[0].model if by_runs else results[0].model,
        friction=sum(means, Estimate(0.0)),
        dissipation=sum(energies, Estimate(0.0)),
        converged=all(result.converged for result in results),
        periodic=all(result.periodic for result in results),
        reason=next((result.reason for result in results if result.reason), ""),
        **{name: most(name) for name in ("cells", "angles", "steps_per_period", "periods")},
        effort=sum((result.effort for result in results), Effort()),
        exhausted=request.budget.exhausted,
        solve_time_s=request.seconds,
    )


def _solve(request: Request) -> Result:
    """Solve one contact: use a closed form if there is one, otherwise runs of a model."""
    exact = exact_for(request)
    if exact is not None:
        return of_closed_form(request, exact)
    # imported here because it loads compiled code
    from microslip.adaptive.friction import solve_friction

    return solve_friction(request)
