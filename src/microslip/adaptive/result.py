"""The answer for one point: friction, its error by source, and what it took."""

from __future__ import annotations

from dataclasses import asdict, dataclass


@dataclass(frozen=True, kw_only=True)
class Result:
    """Friction at one point, and how far to trust it.

    All numbers are dimensionless but the time.  A count is 0 where it does not apply: in a closed
    form nothing is marched, in a steady motion there are no periods.

    Attributes
    ----------
    motion : str
        What moves, with the numbers that its name takes.
    pressure : str
        How the load is spread over the contact, likewise.
    velocity, amplitude : float
        The dimensionless groups of the motion; amplitude: None where the motion is steady.  Under a
        force the mean velocity that comes out, NaN where it runs away.
    velocity_error : float or None
        Largest error that it may have then, by estimate; None where the velocity was given.
    force, stiffness, mass, damping : float or None
        What pulls, see motions.drive.Drive; None: not that.
    contacts : str or None
        Those that the body is on, see motions.body_contacts; None: one.
    poisson : float
        Poisson's ratio.
    model : str
        Contact model that was used, or "closed-form".
    tolerance : float or None
        Largest accepted error of mu_macro; under a force of the velocity, times the velocity where
        that is above 1; None: none was meant.
    method : str
        How it was computed: "shipped", or another to be compared with that.
    mu_macro : float
        Mean forward friction force over mu F_z, a ratio: 1 means that the vibration does nothing.
    mu_macro_error : float
        Largest error that mu_macro may have, by estimate: the sum of the next four.  Under a force
        these are of the velocity, and mu_macro is the force.
    error_resolution : float
        Part of it from the rings or squares, the angles and the time steps.
    error_periodicity, error_solver : float
        ... from the distance to the periodic state, and from what the steps left unsolved.
    error_model : float
        ... from a closed form in place of a run, else 0.
    mu_torque, mu_torque_error : float or None
        Torque over its value at zero forward velocity, and its error; None where the motion
        oscillates.
    converged : bool
        The error is within the tolerance, and every run found its state; without a tolerance
        the second alone.
    periodic : bool
        Every run found the state that repeats itself, so that what is wrong with mu_macro is that
        of the resolution.
    reason : str
        Why it is not converged, in a line; else empty.
    cells : int
        Rings, or squares across the contact, of the finest run.
    angles : int
        Angular points on half the disc, of the finest run; 1 where rings or squares suffice.
    steps_per_period : int
        Time steps in a full period, of the finest run.
    observed_order : float or None
        Observed order of convergence of the last three levels; None where it is not known.  2 is
        expected; far below 1 the runs are too coarse for the error estimate.
    periods : float
        Full periods marched in search of the periodic state in the longest run: 2.5 are five half
        ones.
    iterations : int
        Iterations of the step solver, over all runs.
    work : int
        Step solves times unknowns, over all runs.
    effort : int
        Iterations of the step solver times unknowns, over all runs.
    retried : int
        Runs that found no periodic state at first, and were done again by safer steps.
    exhausted : str
        What ran out before it was done: "work", or "time", with which another machine may get
        further; else empty.
    solve_time_s : float
        Seconds by the wall clock.
    """

    motion: str
    pressure: str
    velocity: float
    amplitude: float | None
    poisson: float
    model: str
    tolerance: float | None
    method: str
    force: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None
    velocity_error: float | None = None
    contacts: str | None = None
    mu_macro: float
    mu_macro_error: float
    error_resolution: float = 0.0
    error_periodicity: float = 0.0
    error_solver: float = 0.0
    error_model: float = 0.0
    mu_torque: float | None = None
    mu_torque_error: float | None = None
    converged: bool
    periodic: bool
    reason: str = ""
    cells: int = 0
    angles: int = 0
    steps_per_period: int = 0
    observed_order: float | None = None
    periods: float = 0.0
    iterations: int = 0
    work: int = 0
    effort: int = 0
    retried: int = 0
    exhausted: str = ""
    solve_time_s: float

    def to_dict(self) -> dict:
        """Fields as a plain dict, without those that the motion does not have."""
        fields = asdict(self)
        return {k: v for k, v in fields.items() if v is not None or k == "tolerance"}


def of_closed_form(point: dict, values: tuple, seconds: float) -> Result:
    """The Result of a point, a dict of its fields, where (mu, torque, error) are known."""
    (mu, torque, error), tolerance = values, point["tolerance"]
    within = tolerance is None or error <= tolerance
    return Result(
        **point,
        mu_macro=mu,
        mu_macro_error=error,
        error_model=error,
        mu_torque=torque,
        mu_torque_error=None if torque is None else error,
        converged=within,
        periodic=True,
        reason="" if within else f"the error is {error:.1e}, above the tolerance of {tolerance:g}",
        solve_time_s=seconds,
    )
