"""The answer for a self-propelled motion: a line from stall force to no-load velocity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False, kw_only=True)
class PropulsionLine:
    """Load and velocity of a self-propelled motion, from stall to no load.

    All values except the time are dimensionless.  Forces are divided by mu times the mean normal
    load, powers by mu times the mean normal load, u_lim and omega.  Velocities are in the unit of
    the motion's own velocity.  Every error estimate belongs to the field before it.

    Attributes
    ----------
    motion, pressure, model : str
        What moves, how the load is spread, and the contact model.
    amplitude, poisson, tolerance : float
        As asked for.
    stall_force, stall_force_error : float
        Load that stops the motion; 0 where it propels nothing, below 0 where it propels backward.
    no_load_velocity, no_load_velocity_error : float
        Velocity without a load, with the same sign.
    holding_force_low, holding_force_low_error : float or None
        Lowest of the forces against which friction holds a body at rest, below 0: a pull backward;
        None where the motion propels the contact.
    holding_force_high, holding_force_high_error : float or None
        Highest of these forces.
    velocity, force, force_error : np.ndarray, shape (points,)
        From 0 to the no-load velocity in equal parts, and the force that is pulled with there.  No
        points where nothing is driven.
    power_out, power_out_error : np.ndarray, shape (points,)
        force times velocity.
    power_in, power_in_error : np.ndarray, shape (points,)
        Mean work of the oscillation.
    efficiency, efficiency_error : np.ndarray, shape (points,)
        Power out over power in.
    converged : bool
        Whether the forces and powers are within the tolerance; of powers over the mean speed of the
        oscillation.
    reason : str
        Why not, or why nothing is driven; else empty.
    solve_time_s : float
        Seconds by the wall clock.
    """

    motion: str
    pressure: str
    model: str
    amplitude: float
    poisson: float
    tolerance: float
    stall_force: float
    stall_force_error: float
    no_load_velocity: float
    no_load_velocity_error: float
    holding_force_low: float | None = None
    holding_force_low_error: float | None = None
    holding_force_high: float | None = None
    holding_force_high_error: float | None = None
    velocity: np.ndarray
    force: np.ndarray
    force_error: np.ndarray
    power_out: np.ndarray
    power_out_error: np.ndarray
    power_in: np.ndarray
    power_in_error: np.ndarray
    efficiency: np.ndarray
    efficiency_error: np.ndarray
    converged: bool
    reason: str
    solve_time_s: float

    def to_dict(self) -> dict:
        """Fields as a plain dict, arrays as lists."""
        fields = dict(vars(self))
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in fields.items()}
