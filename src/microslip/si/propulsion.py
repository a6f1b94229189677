"""Force, speed and power of a self-propelled motion in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from microslip.adaptive.checks import checked_propulsion
from microslip.adaptive.propulsion import POINTS, PROPELS_NOTHING, PropulsionLine, propulsion
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.si.dimensionless import MovingContact, RealMotion
from microslip.si.inputs import contact_of, read_inputs
from microslip.si.printed_lines import force_unit, in_unit
from microslip.si.propulsion_text import propulsion_text
from microslip.si.quantities import read
from microslip.si.validity import broken_assumptions, unchecked

TOLERANCE = 1e-2
"""Default tolerance of a force, relative to mu times the mean load."""


@dataclass(frozen=True, eq=False)
class RealPropulsionLine:
    """The force-speed line of a real contact, from the stall force to the no-load speed.

    Every quantity has an error estimate.  Negative forces and speeds are backward.

    Attributes
    ----------
    understood : dict of str
        The arguments as the user wrote them; see prediction.Prediction.
    motion : str
        The motion.
    contact_radius_m, u_lim_m : float
        Contact radius, and displacement at which the whole contact slides, m.
    amplitude_m, frequency_Hz : float
        Amplitude, m, and frequency, Hz, of the oscillation.
    amplitude : float
        Amplitude of the oscillation divided by u_lim, dimensionless.
    stall_force_N, stall_force_error_N : float
        Opposing force that stops the motion, N.
    no_load_speed_m_s, no_load_speed_error_m_s : float
        Speed without an opposing force, m/s.
    holding_force_low_N, holding_force_low_error_N : float or None
        Lowest force under which the body stays at rest, N.  A negative force points backward.  None
        if the motion propels the contact.
    holding_force_high_N, holding_force_high_error_N : float or None
        Highest force under which the body stays at rest, N.
    speed_m_s, force_N, force_error_N : np.ndarray, shape (points,)
        Speeds from 0 to the no-load speed, m/s, and the force of the motion at each speed, N.
    power_out_W, power_out_error_W : np.ndarray, shape (points,)
        Power delivered to the opposing force, W.
    power_in_W, power_in_error_W : np.ndarray, shape (points,)
        Power of the oscillation, W.
    efficiency, efficiency_error : np.ndarray, shape (points,)
        Delivered power divided by the power of the oscillation, dimensionless.
    converged, reason : bool, str
        True if all error estimates are within the tolerance; otherwise `reason` is set.
    warnings, not_checked : tuple of str
        Assumptions that the contact violates, and checks that were skipped because a property is
        missing.
    """

    understood: dict = field(repr=False)
    motion: str
    contact_radius_m: float
    u_lim_m: float
    amplitude_m: float
    frequency_Hz: float
    amplitude: float
    stall_force_N: float
    stall_force_error_N: float
    no_load_speed_m_s: float
    no_load_speed_error_m_s: float
    holding_force_low_N: float | None
    holding_force_low_error_N: float | None
    holding_force_high_N: float | None
    holding_force_high_error_N: float | None
    speed_m_s: np.ndarray
    force_N: np.ndarray
    force_error_N: np.ndarray
    power_out_W: np.ndarray
    power_out_error_W: np.ndarray
    power_in_W: np.ndarray
    power_in_error_W: np.ndarray
    efficiency: np.ndarray
    efficiency_error: np.ndarray
    converged: bool
    reason: str
    warnings: tuple
    not_checked: tuple

    def __str__(self) -> str:
        """The output of `microslip predict --propulsion`."""
        return propulsion_text(self)

    def to_dict(self) -> dict:
        """The fields as a dict, with lists in place of arrays."""
        fields = dict(vars(self))
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in fields.items()}


def predict_propulsion(
    motion: str,
    *,
    radius: object,
    load: object,
    mu: object,
    amplitude: object,
    frequency: object,
    young: object = None,
    nu: object = None,
    material: object = None,
    counterbody: object = None,
    counter_radius: object = None,
    hardness: object = None,
    density: object = None,
    counter_hardness: object = None,
    counter_density: object = None,
    tolerance: object = TOLERANCE,
    points: int = POINTS,
) -> RealPropulsionLine:
    """Force, speed and power of a sphere that propels itself on a flat or on a second sphere.

    Parameters
    ----------
    motion : str
        A self-propelled motion of `microslip.propulsion` without a rotation.
    amplitude : quantity
        Half stroke, m, of a component whose number in `motion` is 1.  For an oscillating normal
        load, `load` is the load without oscillation.  The load's amplitude is `load` times its
        number in `motion`, times amplitude / u_lim.
    tolerance : quantity
        Largest accepted error of a force, relative to mu times the mean load.
    points : int
        Number of points on the line, including both ends.

    The other arguments are those of `microslip.predict`.

    Returns
    -------
    RealPropulsionLine
        The line of `microslip.propulsion` in SI units.

    Raises
    ------
    InputError
        If an argument is missing, out of range or not allowed.
    """
    arguments = dict(locals())
    inputs = read_inputs(arguments)
    size, rate = inputs.needed("amplitude"), inputs.needed("frequency")
    accepted = read("tolerance", tolerance, "", low_open=False)
    contact = contact_of(inputs)
    group = size / contact.u_lim
    if not group <= LARGEST["amplitude"]:
        allowed = f"{group:.3g} times u_lim; allowed is at most {LARGEST['amplitude']:g} times"
        raise InputError("amplitude", amplitude, allowed)
    problem = checked_propulsion(motion, group, poisson=contact.poisson)
    if problem.motion.rotates:
        raise InputError("motion", motion, "allowed is a motion without a rotation")
    line = propulsion(motion, group, poisson=contact.poisson, tolerance=accepted.si, points=points)
    newtons = contact.mu * contact.load * problem.mean_load
    speed = 2.0 * math.pi * rate * contact.u_lim
    fastest = speed * float(np.max(np.abs(line.velocity), initial=0.0))
    real = RealMotion(motion, "m", fastest, size, rate)
    holding, reason = _holding_forces(line, newtons)
    return RealPropulsionLine(
        understood={"motion": motion} | inputs.texts,
        motion=motion,
        contact_radius_m=contact.contact_radius,
        u_lim_m=contact.u_lim,
        amplitude_m=size,
        frequency_Hz=rate,
        amplitude=group,
        no_load_speed_m_s=speed * line.no_load_velocity,
        no_load_speed_error_m_s=speed * line.no_load_velocity_error,
        speed_m_s=speed * line.velocity,
        efficiency=line.efficiency,
        efficiency_error=line.efficiency_error,
        **holding,
        **_in_si(line, newtons, "N", "stall_force", "force"),
        **_in_si(line, newtons * speed, "W", "power_out", "power_in"),
        converged=line.converged,
        reason=reason,
        warnings=tuple(broken_assumptions(MovingContact(contact, real))),
        not_checked=tuple(unchecked(contact)),
    )


def _in_si(line: PropulsionLine, unit: float, name: str, *quantities: str) -> dict[str, Any]:
    """Fields for quantities and their errors.  unit: factor to SI units; name: name of the unit."""
    stems = [part for quantity in quantities for part in (quantity, f"{quantity}_error")]
    values = {stem: getattr(line, stem) for stem in stems}
    return {f"{stem}_{name}": None if one is None else unit * one for stem, one in values.items()}


def _holding_forces(line: PropulsionLine, newtons: float) -> tuple[dict[str, Any], str]:
    """Fields for the holding forces, and the text of the field `reason`.  newtons: unit of the
    forces, N."""
    names = [f"holding_force_{name}" for name in ("low", "high")]
    fields = _in_si(line, newtons, "N", *names)
    low, low_error, high, high_error = fields.values()
    if low is None or not line.converged:
        return fields, line.reason
    unit = force_unit(max(abs(low), abs(high)))
    texts = in_unit(low, low_error, unit), in_unit(high, high_error, unit)
    return fields, PROPELS_NOTHING.format(*texts)
