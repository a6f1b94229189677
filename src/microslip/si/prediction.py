"""Predictions for real contacts: a record class for each kind of request, and their base class.

A contact at a prescribed speed has the record `Sliding`, or `SteadySpin` without an oscillation.  A
contact under a force has the record `Rest`, `Drift` or `SpinDrift`.  `Prediction.to_dict` returns
the columns used in JSON output and in tables.  The columns are the same for all records.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from microslip.estimate.estimate import Estimate
from microslip.foundation.errors import InputError
from microslip.si.motions import RealMotionKind
from microslip.si.prediction_text import prediction_text

_NAMES = """
    motion contact_radius_m indentation_m u_lim_m largest_pressure_Pa poisson speed_m_s
    amplitude_si frequency_Hz rotation_rad_s velocity amplitude mu_macro mu_macro_error
    mu_apparent mu_apparent_error friction_force_N friction_force_error_N friction_force_still_N
    force_reduction mu_static mu_static_error mu_static_apparent mu_static_apparent_error
    mu_static_reason model converged reason warnings not_checked counterbody understood force_N
    drive_stiffness_N_m mass_kg damping_N_s_m force stiffness mass damping outcome
    speed_error_m_s velocity_error displacement_per_cycle_m displacement_per_cycle_error_m
    time_to_1_mm_s time_to_1_mm_error_s time_to_contact_radius_s time_to_contact_radius_error_s
    displacement_m displacement_error_m cycles_to_rest displacement_reason force_threshold_N
    force_threshold_error_N safety_factor safety_factor_error natural_frequency pressure
    forward_amplitude_m rotation_amplitude_rad load_amplitude_N phase_rad torque_N_m
    torque_error_N_m drag_power_W drag_power_error_W vibration_power_W vibration_power_error_W
    dissipated_power_W dissipated_power_error_W energy_per_cycle_J energy_per_cycle_error_J
    wear_volume_per_cycle_m3 wear_volume_per_cycle_error_m3 wear_depth_per_cycle_m
    wear_depth_per_cycle_error_m load_N sought sought_error mu_macro_spread mu_apparent_spread
    friction_force_spread_N speed_spread_m_s sought_spread mu_static_spread mu_static_low
    mu_static_high mu_static_apparent_spread mu_static_apparent_low mu_static_apparent_high
    force_threshold_spread_N force_threshold_low_N force_threshold_high_N safety_factor_spread
    safety_factor_low safety_factor_high interval_method probability_stays probability_moves
    probability_runs_away probability_error
"""
COLUMNS = tuple(_NAMES.split())
"""Names of the columns in JSON output and in tables, in order."""
EMPTY: dict[str, Any] = dict.fromkeys(COLUMNS) | {"mu_static_reason": "", "displacement_reason": ""}
"""Default values of missing columns."""
UNITS = {
    **{"_N_m": "N m", "_N_s_m": "N s m-1", "_m_s": "m s-1", "_rad_s": "rad s-1", "_Pa": "Pa"},
    **{"_Hz": "Hz", "_kg": "kg", "_rad": "rad", "_W": "W", "_J": "J", "_N": "N", "_m": "m"},
    **{"_s": "s", "_m3": "m3"},
}
"""Units of columns, keyed by the suffix of the column name.  The first matching suffix counts."""
OTHER_UNITS = {"drive_stiffness_N_m": "N m-1", "time_to_1_mm_s": "s"}


def column_unit(column: str) -> str:
    """SI unit of a column, "1" if it is dimensionless."""
    ends = (unit for end, unit in UNITS.items() if column.endswith(end))
    return OTHER_UNITS.get(column) or next(ends, "1")


def columns_of(
    name: str, estimate: Estimate | None, unit: float = 1.0, suffix: str = ""
) -> dict[str, Any]:
    """Columns for a quantity and its error.  unit: factor to SI units; suffix: end of the column
    names."""
    pair = (None, None) if estimate is None else (unit * estimate.value, unit * estimate.error)
    return dict(zip((f"{name}{suffix}", f"{name}_error{suffix}"), pair, strict=True))


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """Friction of a vibrated contact in SI units: the fields common to all requests.

    Every column is an attribute.  A missing column is None.

    Attributes
    ----------
    understood : dict of str
        The arguments as the user wrote them, by name.  The SI value is added if the unit is of
        another kind ("1200 rpm = 20 Hz").  The operator == ignores this field.
    kind : RealMotionKind
        The kind of the motion, for the printed text.
    motion, pressure : str
        The motion, and the pressure as in microslip.solve.
    contact_radius_m, indentation_m, largest_pressure_Pa : float
        Contact radius and indentation, m, and largest pressure, Pa.
    u_lim_m : float
        Displacement at which the whole contact slides, m.
    poisson : float
        Poisson's ratio of the half-space equivalent to both bodies, dimensionless.
    load_N : float
        Normal force, N.
    speed_m_s : float
        Forward speed, m/s.  Under a force, it is the mean speed, which is NaN if the contact runs
        away.
    velocity : float or None
        Dimensionless speed; None for a bore of amplitude 0.
    mu_macro, mu_macro_error : float
        Mean forward force with vibration divided by the force without vibration, mu F_z;
        dimensionless.
    mu_apparent, mu_apparent_error : float
        Coefficient of friction with vibration, mu times mu_macro; dimensionless.
    friction_force_N, friction_force_error_N, friction_force_still_N : float
        Mean forward force with vibration, its error estimate, and the force without vibration, N.
        Both forces are for the same mean load.
    force_reduction : float
        1 - mu_macro, dimensionless; its error estimate is mu_macro_error.
    force_threshold_N, force_threshold_error_N : float or None
        Smallest constant force that moves the contact, N; None if it is unknown.
    drag_power_W, drag_power_error_W : float or None
        Mean power of the forward force, W; None if the answer is not converged.
    model : str
        Contact model, or "closed-form".
    converged, reason : bool, str
        True if the error estimate of mu_macro, or of the speed under a force, is at most the
        tolerance.  Otherwise, `reason` is set.
    warnings : tuple of str
        Assumptions of the theory that the contact violates.
    not_checked : tuple of str
        Checks that were skipped because a property is missing.
    vibration_power_W, vibration_power_error_W : float or None
        Mean power of the oscillation or of the spin, W.  It is None with a dashpot, because the
        dashpot dissipates an unknown part of this power.
    dissipated_power_W, dissipated_power_error_W : float or None
        Mean power dissipated by friction, W.  Without a dashpot, it is the sum of the oscillation's
        power and the drag power.  It is None if the answer is not converged.
    energy_per_cycle_J, energy_per_cycle_error_J : float or None
        Energy dissipated by friction per period or per turn, J.
    wear_volume_per_cycle_m3, wear_volume_per_cycle_error_m3 : float or None
        Wear volume of a body per period or per turn by Archard's law, m^3: the wear coefficient
        times the dissipated energy, divided by mu.
    wear_depth_per_cycle_m, wear_depth_per_cycle_error_m : float or None
        Mean wear depth over the contact area, m.
    uncertainty : mapping
        Standard uncertainties, 95 % intervals and probabilities of the outcomes for uncertain
        inputs, by column.  The columns are NAME_spread, NAME_low and NAME_high, `interval_method`
        ("quantiles" of draws, or "first order"), `probability_stays`, `probability_moves`,
        `probability_runs_away` and `probability_error`.  A standard uncertainty is infinite if some
        inputs within their uncertainty have no answer.  Empty if every input is exact.
    """

    understood: dict = field(compare=False)
    kind: RealMotionKind = field(compare=False, repr=False)
    motion: str
    pressure: str
    contact_radius_m: float
    indentation_m: float
    largest_pressure_Pa: float
    u_lim_m: float
    poisson: float
    load_N: float
    speed_m_s: float
    velocity: float | None
    mu_macro: float
    mu_macro_error: float
    mu_apparent: float
    mu_apparent_error: float
    friction_force_N: float
    friction_force_error_N: float
    friction_force_still_N: float
    force_reduction: float
    force_threshold_N: float | None
    force_threshold_error_N: float | None
    drag_power_W: float | None = None
    drag_power_error_W: float | None = None
    model: str
    converged: bool
    reason: str
    warnings: tuple = ()
    not_checked: tuple = ()
    vibration_power_W: float | None = None
    vibration_power_error_W: float | None = None
    dissipated_power_W: float | None = None
    dissipated_power_error_W: float | None = None
    energy_per_cycle_J: float | None = None
    energy_per_cycle_error_J: float | None = None
    wear_volume_per_cycle_m3: float | None = None
    wear_volume_per_cycle_error_m3: float | None = None
    wear_depth_per_cycle_m: float | None = None
    wear_depth_per_cycle_error_m: float | None = None
    uncertainty: Mapping[str, Any] = field(default_factory=dict)

    @property
    def counterbody(self) -> str:
        """The counterbody in words."""
        return self.understood["counterbody"]

    def to_dict(self) -> dict[str, Any]:
        """All columns as a plain dict."""
        columns = EMPTY | vars(self) | {"counterbody": self.counterbody}
        columns |= columns.pop("uncertainty")
        del columns["kind"]
        return columns | {name: list(columns[name]) for name in ("warnings", "not_checked")}

    def __getattr__(self, name: str) -> Any:
        if name not in EMPTY:
            raise AttributeError(f"{type(self).__name__} has no column {name!r}")
        return self.uncertainty.get(name, EMPTY[name])

    def __str__(self) -> str:
        """The lines that `microslip predict` prints."""
        return prediction_text(self)


@dataclass(frozen=True, kw_only=True)
class Oscillating(Prediction):
    """Base class of predictions for motions that oscillate.

    Attributes
    ----------
    amplitude_si : float or None
        Half stroke of the oscillation, m, or rad for a bore.  It is None if only other components
        oscillate.
    forward_amplitude_m, rotation_amplitude_rad, load_amplitude_N, phase_rad : float or None
        Other half strokes and the phase of a motion with several oscillations.
    frequency_Hz : float
        Cyclic frequency of the oscillation, Hz.
    amplitude : float
        The largest dimensionless half stroke.
    mu_static, mu_static_error : float
        mu_macro in the limit of vanishing speed, dimensionless.
    mu_static_apparent, mu_static_apparent_error : float
        Coefficient of friction in this limit, mu times mu_static; dimensionless.
    mu_static_reason : str
        Why the error of mu_static is above its tolerance; else empty.
    displacement_per_cycle_m, displacement_per_cycle_error_m : float
        Mean forward displacement in a period of the oscillation, m.
    drive_stiffness_N_m, mass_kg, damping_N_s_m : float or None
        Stiffness of the spring (N/m), mass (kg) and damping (N s/m).  A missing part is None.
    stiffness, mass, damping : float or None
        Dimensionless stiffness, mass and damping, as in microslip.solve.
    natural_frequency : float or None
        Natural frequency of the mass on the spring and the sticking contact, divided by the
        frequency of the oscillation; None without a mass.
    """

    amplitude_si: float | None
    forward_amplitude_m: float | None
    rotation_amplitude_rad: float | None
    load_amplitude_N: float | None
    phase_rad: float | None
    frequency_Hz: float
    amplitude: float
    mu_static: float | None = None
    mu_static_error: float | None = None
    mu_static_apparent: float | None = None
    mu_static_apparent_error: float | None = None
    mu_static_reason: str = ""
    displacement_per_cycle_m: float | None = None
    displacement_per_cycle_error_m: float | None = None
    drive_stiffness_N_m: float | None = None
    mass_kg: float | None = None
    damping_N_s_m: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None
    natural_frequency: float | None = None


@dataclass(frozen=True, kw_only=True)
class Sliding(Oscillating):
    """Friction at a prescribed speed.

    Attributes
    ----------
    sought : str or None
        "amplitude", "speed" or "load" if a reduction was requested.
    sought_error : float or None
        Error estimate of this quantity, in its SI unit.
    """

    sought: str | None = None
    sought_error: float | None = None

    @property
    def sought_value(self) -> float | None:
        """The result of a search in its SI unit.  It is NaN if there is no solution, and None
        without a search."""
        values = {"amplitude": self.amplitude_si, "speed": self.speed_m_s, "load": self.load_N}
        return None if self.sought is None else values[self.sought]


@dataclass(frozen=True, kw_only=True)
class SteadySpin(Prediction):
    """Friction of a contact that spins steadily.

    Attributes
    ----------
    rotation_rad_s : float
        Angular speed, rad/s.
    torque_N_m, torque_error_N_m : float or None
        Torque of the spin, N m; None if the answer is not converged.
    """

    rotation_rad_s: float | None
    torque_N_m: float | None = None
    torque_error_N_m: float | None = None


@dataclass(frozen=True, kw_only=True)
class Forced(Prediction):
    """Base class of predictions for contacts under a constant force.

    Attributes
    ----------
    force_N, force : float
        The force, N, and the dimensionless force.
    outcome : str or None
        "moves", "stays", "runs away", or "undecided" if the speed is below its error estimate.  It
        is None if the solver failed.
    speed_error_m_s, velocity_error : float
        Error estimates of speed_m_s and velocity.
    safety_factor, safety_factor_error : float or None
        Force threshold divided by the force; None if the threshold is unknown.
    time_to_1_mm_s, time_to_1_mm_error_s : float or None
        Time to travel 1 mm, s; None if the contact does not move.
    time_to_contact_radius_s, time_to_contact_radius_error_s : float or None
        Time to travel one contact radius, s.
    """

    force_N: float
    force: float
    outcome: str | None
    speed_error_m_s: float
    velocity_error: float
    safety_factor: float | None = None
    safety_factor_error: float | None = None
    time_to_1_mm_s: float | None = None
    time_to_1_mm_error_s: float | None = None
    time_to_contact_radius_s: float | None = None
    time_to_contact_radius_error_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Drift(Forced, Oscillating):
    """A contact that moves under a force, or may move within the error estimate."""


@dataclass(frozen=True, kw_only=True)
class Rest(Forced, Oscillating):
    """A contact that comes to rest under a force.

    Attributes
    ----------
    displacement_m, displacement_error_m : float or None
        Forward displacement until the contact rests, m.  It is None if the body has a mass, or if
        the contact is not round.
    cycles_to_rest : float or None
        Number of periods until the vibration has caused nine tenths of the displacement.
    displacement_reason : str
        Why the displacement is unknown; empty if it is known.
    """

    displacement_m: float | None = None
    displacement_error_m: float | None = None
    cycles_to_rest: float | None = None
    displacement_reason: str = ""


@dataclass(frozen=True, kw_only=True)
class SpinDrift(Forced, SteadySpin):
    """A contact that spins steadily under a force."""


@dataclass(frozen=True)
class NoPrediction:
    """A case without a prediction in a table.

    Attributes
    ----------
    error : InputError or str
        The cause.
    """

    error: InputError | str
    converged: bool = False
    warnings: tuple = ()
    not_checked: tuple = ()
