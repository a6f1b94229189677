"""The answer for a real contact."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field

from microslip.foundation.errors import InputError
from microslip.si.prediction_text import prediction_text


@dataclass(frozen=True)
class Prediction:
    """Friction of a vibrated contact in SI units.

    Attributes
    ----------
    understood : dict of str
        What was asked, each by the name of its argument and as it was given, with the value in the
        SI behind it where that is another kind of measure ("1200 rpm = 20 Hz"); what was not given
        and counts is said ("rigid, as none was given").  Not compared by ==.
    motion : str
        The motion.
    counterbody : str
        The body opposite, as in `understood`.  Not compared by ==.
    contact_radius_m, indentation_m, largest_pressure_Pa : float
        Hertz's contact.
    u_lim_m : float
        Displacement at which the whole contact slides, m.
    poisson : float
        Poisson's ratio of the half-space that is equivalent to both bodies, dimensionless.
    speed_m_s : float
        Forward speed, m/s; under a force the mean one that comes out, NaN where it runs away.
    amplitude_si : float or None
        Half stroke of the oscillation, m, or rad for a bore; None where there is none.
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
    friction_force_N, friction_force_error_N, friction_force_still_N : float
        Mean forward force with vibration, its error estimate, and the force without vibration, N,
        under the same mean load: that of the oscillating load where it parts the bodies.
    force_reduction : float
        1 - mu_macro, dimensionless; its error estimate is mu_macro_error.
    mu_static, mu_static_error : float or None
        A ratio: mu_macro in the limit of vanishing speed; None for steady motions.
    mu_static_apparent, mu_static_apparent_error : float or None
        The coefficient of friction there, mu mu_static; None for steady motions.
    mu_static_reason : str
        Why mu_static is not within its tolerance; else empty.
    mu_static_spread, mu_static_low, mu_static_high : float or None
        Standard uncertainty of mu_static that follows from those of the inputs, and the ends of an
        interval with 95 % probability; None where every input is exact.
    mu_static_apparent_spread, mu_static_apparent_low, mu_static_apparent_high : float or None
        Standard uncertainty and 95 % interval of mu_static_apparent.
    model : str
        Contact model that gave mu_macro, or "closed-form".
    converged, reason : bool, str
        Whether the error of the requested quantity is within the tolerance, and why not: of
        mu_macro, or of the speed under a force, and of vibration_power_W if it was requested.
    warnings : tuple of str
        Where an assumption of the theory breaks.
    not_checked : tuple of str
        What was not looked at, and why.
    force_N, drive_stiffness_N_m, mass_kg, damping_N_s_m : float or None
        The drive, where it is not the speed alone.
    force, stiffness, mass, damping : float or None
        The drive as dimensionless groups, as for microslip.solve.
    outcome : str or None
        Under a force "moves", "stays", "runs away", or "undecided" where the error does not tell
        whether it moves; None where a speed was given, or the solver has no answer.
    speed_error_m_s, velocity_error : float or None
        Largest error that speed and velocity may have under a force, by estimate.
    displacement_per_cycle_m, displacement_per_cycle_error_m : float or None
        Mean forward displacement in a period of the oscillation, m; None for steady motions.
    time_to_1_mm_s, time_to_1_mm_error_s : float or None
        Time in which a contact that a force moves goes 1 mm, s.
    time_to_contact_radius_s, time_to_contact_radius_error_s : float or None
        Time in which it goes one contact radius, s.
    displacement_m, displacement_error_m, cycles_to_rest : float or None
        How far a contact that stays under a force goes forward before it stands, with its error,
        and after how many periods nine tenths of what the vibration adds are gone.  None for what
        moves, has a mass or is not round.
    displacement_reason : str
        Why displacement_m is not known for a contact that stays; else empty.
    force_threshold_N, force_threshold_error_N : float or None
        Constant force from which on the contact moves, N; None where it is not known.
    force_threshold_spread_N, force_threshold_low_N, force_threshold_high_N : float or None
        Standard uncertainty and 95 % interval of the threshold, N.
    safety_factor, safety_factor_error : float or None
        That threshold over the force; None without a force.
    safety_factor_spread, safety_factor_low, safety_factor_high : float or None
        Standard uncertainty and 95 % interval of the safety factor.
    interval_method : str or None
        How the interval of mu_static was computed: "quantiles" of draws of the inputs, or "first
        order", with a static friction that is linear in each input: with a reduction, and where the
        ratio of several amplitudes is uncertain.  None where there is no interval.
    probability_stays, probability_moves, probability_runs_away : float or None
        Probability of each outcome under a force, for independent inputs with normal distributions;
        None where every input is exact.  The first two are also None where the threshold is
        unknown, or is computed for the central values only (a forward oscillation that the contact
        follows).
    probability_error : float or None
        Largest error of these probabilities, by estimate.
    regime : str or None
        A key of regimes.REGIMES, of what is pulled through a spring or has a mass; else None.
    natural_frequency : float or None
        Natural frequency of the mass on its spring and the sticking contact, over the frequency of
        the oscillation; None without either.
    pressure : str
        How the load is spread, as microslip.solve takes it.
    forward_amplitude_m, rotation_amplitude_rad, load_amplitude_N, phase_rad : float or None
        Further half strokes, and a phase, of motions that oscillate in several ways.
    contacts : str or None
        The contacts that carry the body, as microslip.solve writes them; None for a single one.
        For several contacts, forces and powers are those of the body, and sizes and groups those of
        a contact with the mean load.
    torque_N_m, torque_error_N_m : float or None
        Torque that a steady spin takes, N m, and its error; None for motions that oscillate.
    drag_power_W, drag_power_error_W : float or None
        Mean work of the forward force in a second, W.
    vibration_power_W, vibration_power_error_W : float or None
        Mean work of the oscillation, or of the spin, in a second, W; of oscillations where it was
        asked for.
    vibration_power_reason : str or None
        Why the vibration power is not within the tolerance, else empty or None.
    dissipated_power_W, dissipated_power_error_W : float or None
    energy_per_cycle_J, energy_per_cycle_error_J : float or None
        Both powers together, W, which friction turns into heat, and what a period or a turn of it
        costs, J.
    load_N : float
        Normal force, N.
    sought, sought_error : str or None, float or None
        What was looked for so that vibration takes the wanted share of friction away ("amplitude",
        "speed", "load"), and the largest error that it may have, in its SI unit, by estimate.
    mu_macro_spread, mu_apparent_spread, friction_force_spread_N, speed_spread_m_s : float or None
        Standard uncertainties that follow from those of what was given; None where none was.
    sought_spread : float or None
        Standard uncertainty of the sought quantity, in its SI unit.  Like the others it is
        infinite where inputs within their uncertainty give no solution for the reduction.
    """

    motion: str
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
    friction_force_error_N: float
    friction_force_still_N: float
    force_reduction: float
    mu_static: float | None
    mu_static_error: float | None
    mu_static_apparent: float | None
    mu_static_apparent_error: float | None
    mu_static_reason: str
    model: str
    converged: bool
    reason: str
    warnings: tuple
    not_checked: tuple
    counterbody: str = field(compare=False)
    understood: dict = field(compare=False)
    force_N: float | None = None
    drive_stiffness_N_m: float | None = None
    mass_kg: float | None = None
    damping_N_s_m: float | None = None
    force: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None
    outcome: str | None = None
    speed_error_m_s: float | None = None
    velocity_error: float | None = None
    displacement_per_cycle_m: float | None = None
    displacement_per_cycle_error_m: float | None = None
    time_to_1_mm_s: float | None = None
    time_to_1_mm_error_s: float | None = None
    time_to_contact_radius_s: float | None = None
    time_to_contact_radius_error_s: float | None = None
    displacement_m: float | None = None
    displacement_error_m: float | None = None
    cycles_to_rest: float | None = None
    displacement_reason: str = ""
    force_threshold_N: float | None = None
    force_threshold_error_N: float | None = None
    safety_factor: float | None = None
    safety_factor_error: float | None = None
    regime: str | None = None
    natural_frequency: float | None = None
    pressure: str = "hertz"
    forward_amplitude_m: float | None = None
    rotation_amplitude_rad: float | None = None
    load_amplitude_N: float | None = None
    phase_rad: float | None = None
    contacts: str | None = None
    torque_N_m: float | None = None
    torque_error_N_m: float | None = None
    drag_power_W: float | None = None
    drag_power_error_W: float | None = None
    vibration_power_W: float | None = None
    vibration_power_error_W: float | None = None
    vibration_power_reason: str | None = None
    dissipated_power_W: float | None = None
    dissipated_power_error_W: float | None = None
    energy_per_cycle_J: float | None = None
    energy_per_cycle_error_J: float | None = None
    load_N: float | None = None
    sought: str | None = None
    sought_error: float | None = None
    mu_macro_spread: float | None = None
    mu_apparent_spread: float | None = None
    friction_force_spread_N: float | None = None
    speed_spread_m_s: float | None = None
    sought_spread: float | None = None
    mu_static_spread: float | None = None
    mu_static_low: float | None = None
    mu_static_high: float | None = None
    mu_static_apparent_spread: float | None = None
    mu_static_apparent_low: float | None = None
    mu_static_apparent_high: float | None = None
    force_threshold_spread_N: float | None = None
    force_threshold_low_N: float | None = None
    force_threshold_high_N: float | None = None
    safety_factor_spread: float | None = None
    safety_factor_low: float | None = None
    safety_factor_high: float | None = None
    interval_method: str | None = None
    probability_stays: float | None = None
    probability_moves: float | None = None
    probability_runs_away: float | None = None
    probability_error: float | None = None

    def __str__(self) -> str:
        """The lines that `microslip predict` prints."""
        return prediction_text(self)

    @property
    def sought_value(self) -> float | None:
        """The sought quantity in its SI unit; NaN without a solution, None if there is none."""
        fields: dict[str | None, float | None]
        fields = {"amplitude": self.amplitude_si, "speed": self.speed_m_s, "load": self.load_N}
        return fields.get(self.sought)

    def to_dict(self) -> dict:
        """Fields as a plain dict."""
        return asdict(self) | {
            "warnings": list(self.warnings),
            "not_checked": list(self.not_checked),
        }


@dataclass(frozen=True)
class NoPrediction:
    """A case of a table that cannot be answered.

    Attributes
    ----------
    error : InputError or str
        What is wrong with it.
    """

    error: InputError | str
    warnings: tuple = ()
    not_checked: tuple = ()
    converged: bool = False
