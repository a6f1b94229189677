"""Incremental friction solver of the package aspher, on the squares and the path of microslip.

V. A. Yastrebov, https://github.com/cofebem/aspher (BSD-3-Clause).  The package must be installed.
First, the method solves the normal contact problem on the squares.  Then the method solves one
tangential problem in each backward Euler step, by a projected conjugate gradient method.  The
method supports translations only, at any nu.

The time integration starts without tractions.  The integration ends when the mean forces of two
periods agree, or when the largest number of periods (`MOST_PERIODS`) is reached.  Within this
number of periods, only fast forward motions become periodic.  Two settings differ from the defaults
of the package:

- The preconditioner is off.  The preconditioner is designed for sticking points.  When the slip
  changes direction, the preconditioned solver needs about five times as many iterations.  The mean
  forces do not become more accurate.

- A step that the package rejects counts as failed, and the march continues from the best tractions.
  By default, the package restores the tractions before the rejected step. The mean forces are then
  wrong.

In each iteration, the package computes two products with the influence operator, whereas the
solvers of microslip compute one.  The effort counts iterations.
"""

from __future__ import annotations

import math

import numpy as np

from microslip.contact.contact import coulomb_residual
from microslip.contact.convolution import square_convolution
from microslip.contact.path import EULER, Path
from microslip.periodic.discretise import Resolution, path_of
from microslip.periodic.method import Method
from microslip.periodic.run import Effort, Run, failed_run
from microslip.scene.problem import Problem
from microslip.theory.hertz import G_STAR

MOST_PERIODS = 6
"""Largest number of periods."""
ACCEPTED = 1e-2
"""Stopping criterion of the package's step solver.  The solver stops when the largest traction
change in a projected step is at most this fraction of the largest friction bound."""


class Solver:
    """A loaded sphere in working units with mu = 1.  The domain [-1, 1]^2 is divided into squares,
    and `cells` is the number of squares in each direction."""

    def __init__(self, cells: int, poisson: float):
        import aspher

        # G* = 4G/(2 - nu) is known, G = E* (1 - nu)/2; the load at contact radius 1 is 4/3 E*/R = 1
        modulus = G_STAR * (2.0 - poisson) / (2.0 * (1.0 - poisson))
        self.size = 2.0 / cells
        self.scale = square_convolution(cells, poisson)[1]
        self.unknowns, self.grading = 2 * cells**2, None
        self.iterations = self.solves = self.failed = 0
        self._solver = aspher.FrictionSolver(
            grid_size=cells,
            domain_size=2.0,
            E_star=modulus,
            nu=poisson,
            model=aspher.CoulombFriction(1.0),
            precond=False,
        )
        centres = (np.arange(cells) + 0.5) * self.size - 1.0
        forward, lateral = np.meshgrid(centres, centres)  # component 1 is along axis 1
        self._solver.set_gap((forward**2 + lateral**2) / (2.0 * 4.0 / 3.0 * modulus))
        self.loaded = self._solver.step(p_bar=1.0 / 4.0).converged
        self.bound = np.asarray(self._solver.pressure).reshape(cells, cells)

    def step(self, forward: float, lateral: float) -> tuple[float, float]:
        """Move to a rigid displacement (in u_lim).  Count the step, even if the step fails.

        Returns two numbers: the forward force divided by mu F_z, and the residual (see
        contact.coulomb_residual).
        """
        step = self._solver.step(delta_t=(forward, lateral), tol_kkt=math.inf)
        self.iterations += step.tangential_iters
        self.solves += 1
        self.failed += not (step.converged and step.proj_residual <= ACCEPTED)
        q, slip = np.stack([step.qx, step.qy]), np.stack([step.slip_x, step.slip_y])
        weight = np.full_like(self.bound, self.size**2)
        residual = coulomb_residual(q, slip, self.bound, weight, np.array(self.scale))
        return float(q[0].sum()) * self.size**2, residual


def half_period(solver: Solver, path: Path, number: int) -> tuple[np.ndarray, float]:
    """Integrate over one half period.  `number` counts the half periods from 0.

    Returns the forward forces at all phases except the first, and the sum of the residuals.
    """
    start, end = path.positions[0, :2], path.positions[-1, :2]
    sign = (-1) ** number
    forward = path.positions[1:, 0] - start[0] + number * (end[0] - start[0])
    lateral = sign * path.positions[1:, 1] - start[1]
    results = np.array([solver.step(*to) for to in zip(forward, lateral, strict=True)])
    return results[:, 0], float(results[:, 1].sum())


def _run(problem: Problem, model: str, resolution: Resolution, tolerance: float) -> Run:
    solver = Solver(resolution.cells, problem.poisson)
    if not solver.loaded:
        return failed_run("the normal contact was left unsolved")
    path = path_of(problem, solver, resolution.steps, EULER)
    force, means, residuals, change = 0.0, [], [], math.inf
    for number in range(2 * MOST_PERIODS):
        forces, residual = half_period(solver, path, number)
        means.append(float(path.weights @ np.array([force, *forces])))
        residuals.append(residual)
        force = forces[-1]
        if number % 2 == 1 and number > 1:
            change = abs(sum(means[-2:]) - sum(means[-4:-2])) / 2.0
            if not change > tolerance:
                break
    periods, reason = 0.5 * len(means), ""
    if solver.failed:
        reason = f"{solver.failed} of {solver.solves} steps failed"
    elif not change <= tolerance:
        reason = f"not periodic within {periods:g} periods: the mean still changed by {change:.1e}"
    return Run(
        {"friction": sum(means[-2:]) / 2.0},
        distance=change,
        residual=sum(residuals[-2:]),
        periods=periods,
        effort=Effort.of(solver.solves, solver.iterations, solver.unknowns),
        reason=reason,
    )


METHOD = Method(
    "another package's projected conjugate gradients: squares, backward Euler, plain march",
    run=_run,
    model="cartesian",
    requires="aspher",
    turns=False,
)
