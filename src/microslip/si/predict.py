"""How much friction falls in a real contact, and how far to trust that."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field

from microslip.adaptive.checks import SMALLEST_TOLERANCE
from microslip.adaptive.point import Result, solve
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.si.dimensionless import groups
from microslip.si.inputs import read_body, read_contact, read_counterbody, read_motion
from microslip.si.quantities import read
from microslip.si.reduction import friction_of, motion_for
from microslip.si.validity import broken_assumptions, unchecked

LARGEST_TOLERANCE = 0.1
"""Of mu_macro; what is larger is no answer."""


@dataclass(frozen=True)
class Prediction:
    """Friction of a vibrated contact in SI units.

    Attributes
    ----------
    understood : dict of str
        What was asked, each by the name of its argument and as it was given, with the value in the
        SI behind it where that is another kind of measure ("1200 rpm = 20 Hz"); what was not given
        and counts is said ("rigid, as none was given").  Not compared by ==.
    scene : str
        The motion.
    counterbody : str
        The body opposite, as in `understood`.  Not compared by ==.
    contact_radius_m, indentation_m, largest_pressure_Pa : float
        Hertz's contact.
    u_lim_m : float
        Displacement at which the whole contact slides, m.
    poisson : float
        Poisson's ratio of the one half-space that stands for both bodies, dimensionless.
    speed_m_s : float
        Forward speed, m/s.
    amplitude_si : float or None
        Half stroke of the oscillation, m, or rad for a bore; None for steady motions.
    frequency_Hz : float or None
        Cyclic frequency of the oscillation, Hz; None for steady motions.
    rotation_rad_s : float or None
        Angular speed of a continuous bore, rad/s; None for motions that oscillate.
    velocity, amplitude : float or None
        The dimensionless groups of the motion; amplitude: None for steady motions; velocity: None
        for a bore of amplitude 0, which it is measured by.
    mu_macro, mu_macro_error : float
        A ratio, dimensionless: mean forward force with vibration over that without, mu F_z.
    mu_apparent, mu_apparent_error : float
        A coefficient of friction, dimensionless: the one that is felt, mu mu_macro.
    friction_force_N, friction_force_still_N : float
        Mean forward force with and without vibration, N.
    force_reduction : float
        1 - mu_macro, dimensionless.
    mu_static, mu_static_error : float or None
        A ratio: mu_macro in the limit of vanishing speed; None for steady motions.
    mu_static_apparent : float or None
        The coefficient of friction there, mu mu_static; None for steady motions.
    model : str
        Contact model that gave mu_macro, or "closed-form".
    converged, reason : bool, str
        Whether the error is within the tolerance, and why not; NaN has its reason there, too.
    warnings : tuple of str
        Where an assumption of the theory breaks.
    not_checked : tuple of str
        What was not looked at, and why.
    """

    scene: str
    contact_radius_m: float
    indentation_m: float
    u_lim_m: float
    largest_pressure_Pa: float
    poisson: float
    speed_m_s: float
    amplitude_si: float | None
    frequency_Hz: float | None
    rotation_rad_s: float | None
    velocity: float | None
    amplitude: float | None
    mu_macro: float
    mu_macro_error: float
    mu_apparent: float
    mu_apparent_error: float
    friction_force_N: float
    friction_force_still_N: float
    force_reduction: float
    mu_static: float | None
    mu_static_error: float | None
    mu_static_apparent: float | None
    model: str
    converged: bool
    reason: str
    warnings: tuple
    not_checked: tuple
    counterbody: str = field(compare=False)
    understood: dict = field(compare=False)

    def to_dict(self) -> dict:
        """Fields as a plain dict."""
        return asdict(self) | {
            "warnings": list(self.warnings),
            "not_checked": list(self.not_checked),
        }


def predict(
    scene: str,
    *,
    radius: object,
    load: object,
    mu: object,
    speed: object,
    young: object = None,
    nu: object = None,
    material: object = None,
    counterbody: object = None,
    counter_radius: object = None,
    amplitude: object = None,
    frequency: object = None,
    rotation: object = None,
    reduction: object = None,
    hardness: object = None,
    density: object = None,
    counter_hardness: object = None,
    counter_density: object = None,
    tolerance: object = 1e-3,
) -> Prediction:
    """Friction of a sphere on a flat (or on a second sphere) under vibration.

    A quantity is a text of one number and one unit ("5 mm"), a pint quantity, or a number in the
    unit of the SI.  Texts are read strictly: what is not understood to its last character is
    refused.

    Parameters
    ----------
    scene : str
        "transverse", "longitudinal", "zigzag", "bore" (the sphere spins to and fro about the
        contact normal) or "continuous-bore" (it spins steadily).
    radius, load, mu : quantity
        Radius of the sphere, m; normal force, N; coefficient of friction without vibration.
    speed : quantity
        Forward speed of sliding, m/s.
    young, nu : quantity
        Young's modulus, Pa, and Poisson's ratio of the body.
    material : str or Material
        The same in one: a name in materials.MATERIALS, or a materials.Material.
    counterbody : str or Material, optional
        "rigid", a material, or E and nu as in "70 GPa, 0.22"; rigid if not given.
    counter_radius : quantity, optional
        Radius of the counterbody, m, negative if hollow; flat if not given.
    amplitude : quantity
        Half stroke of the oscillation: a length, or for a bore an angle.
    frequency : quantity
        Frequency of the oscillation: cyclic (Hz, cps), or angular (rad/s, deg/s, rpm, turn/s),
        which is converted, 2 pi rad/s being 1 Hz.  A number is in Hz.
    rotation : quantity
        Angular speed of a continuous bore, in the same units.  A number is in rad/s.
    reduction : quantity, optional
        Instead of the amplitude, the share of friction to be taken away, 0 to 1 or in per cent: the
        least amplitude that does it is looked for.
    hardness, density, counter_hardness, counter_density : quantity, optional
        Of the body and the counterbody, Pa and kg/m^3, for the warnings alone.
    tolerance : quantity
        Largest accepted error of the ratio mu_macro, absolute.

    Returns
    -------
    Prediction
        With what was understood, what was found, and where the theory breaks.

    Raises
    ------
    InputError
        A ValueError that names the argument, its value as it was given, and what is allowed: for
        what is missing, ambiguous or out of range, for bodies that fit so closely that the contact
        is half as wide as one of them, and where no amplitude takes that much friction away.
    """
    motion, asked = read_motion(
        scene,
        speed=speed,
        amplitude=amplitude,
        frequency=frequency,
        rotation=rotation,
        reduction=reduction,
    )
    accepted = read(
        "tolerance", tolerance, "", low=SMALLEST_TOLERANCE, low_open=False, high=LARGEST_TOLERANCE
    )
    contact, understood = read_contact(
        read_body(young, nu, material).completed("", hardness, density),
        read_counterbody(counterbody).completed("counter_", counter_hardness, counter_density),
        radius=radius,
        counter_radius=counter_radius,
        load=load,
        mu=mu,
    )
    about = understood | asked
    if reduction is not None:
        share = read("reduction", reduction, "", high=1.0)
        about["reduction"] = share.text
        settings = {"share": share.si, "tolerance": accepted.si, "given": reduction}
        motion = motion_for(contact, motion, **settings)
    velocity, size = _checked_groups(contact, motion, speed, amplitude)
    answer = friction_of(contact, motion, accepted.si)
    limit = None
    if size is not None:
        limit = solve(scene, 0.0, size, poisson=contact.poisson, tolerance=accepted.si)
    return _prediction(contact, motion, velocity, answer, limit, about)


def _checked_groups(contact, motion, speed, amplitude):
    """velocity and amplitude as groups gives them; raises InputError for what the solver cannot
    take, in terms of the speed and the amplitude as they were given."""
    velocity, size = groups(motion, contact)
    if not math.isfinite(velocity):
        problem = "over that of the vibration, it is beyond the range of floating-point numbers"
        raise InputError("speed", speed, f"{problem}; allowed is what a laboratory can have")
    if size is not None and not size <= LARGEST["amplitude"]:
        unit = "the angle that leaves half of the contact sticking"
        if motion.scene != "bore":
            unit = f"the {contact.u_lim:.3g} m that let the whole contact slide"
        raise InputError(
            "amplitude",
            amplitude,
            f"{size:.3g} times {unit}; allowed is at most {LARGEST['amplitude']:g} times",
        )
    return velocity, size


def _prediction(contact, motion, velocity, answer: Result, limit: Result | None, understood):
    still = contact.mu * contact.load
    return Prediction(
        scene=motion.scene,
        contact_radius_m=contact.contact_radius,
        indentation_m=contact.indentation,
        u_lim_m=contact.u_lim,
        largest_pressure_Pa=contact.largest_pressure,
        poisson=contact.poisson,
        speed_m_s=motion.speed,
        amplitude_si=motion.amplitude,
        frequency_Hz=motion.frequency,
        rotation_rad_s=motion.rotation,
        velocity=None if motion.scene == "bore" and not motion.amplitude else velocity,
        amplitude=answer.amplitude,
        mu_macro=answer.mu_macro,
        mu_macro_error=answer.mu_macro_error,
        mu_apparent=contact.mu * answer.mu_macro,
        mu_apparent_error=contact.mu * answer.mu_macro_error,
        friction_force_N=still * answer.mu_macro,
        friction_force_still_N=still,
        force_reduction=1.0 - answer.mu_macro,
        mu_static=None if limit is None else limit.mu_macro,
        mu_static_error=None if limit is None else limit.mu_macro_error,
        mu_static_apparent=None if limit is None else contact.mu * limit.mu_macro,
        model=answer.model,
        converged=answer.converged and (limit is None or limit.converged),
        reason=answer.reason or ("" if limit is None else limit.reason),
        warnings=tuple(broken_assumptions(contact, motion)),
        not_checked=tuple(unchecked(contact)),
        counterbody=understood["counterbody"],
        understood=understood,
    )
