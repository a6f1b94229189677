"""Motions: forward sliding combined with an oscillation (a wave) along one or more directions.

*Forward* is the direction of sliding, and *lateral* is perpendicular to it.  If the angle is
positive, points whose lateral coordinate is positive move forward.  The unit of displacements is
u_lim, and the unit of angles is u_lim / a. The time is expressed as the phase omega t.  For a
motion of amplitude A, each wave adds the following term to the displacement along its direction:

    A * share * sin(cycles * phase + lead)

Waves of the angle are in units of phi_lk(a/2).  This unit is the largest angle of a bore motion of
amplitude 1.  The normal load or the indentation depth, divided by its reference value (the value
without oscillation), is 1 plus the wave.  There is no contact while this sum is below 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, NoReturn

import numpy as np

from microslip.foundation import spec
from microslip.foundation.arguments import is_real
from microslip.foundation.errors import InputError, shown
from microslip.scene.pressure import Pressure
from microslip.theory import hertz, masing, oscillating_load

FOCUS_RANGE = (0.05, 0.9995)
"""Range of radii towards which rings are graded.  If the stick radius is below this range, the
stick zone carries almost no load."""

LOOP = np.linspace(0.0, 2.0 * np.pi, 721)
"""Phases at which an oscillation over one period is evaluated, every half degree."""
ENDS = np.array([0.0, 2.0 * np.pi])
"""Phases of the start and the end of a period."""
HALF_PERIOD = (-np.pi / 2, np.pi / 2)
"""Phases of two consecutive turning points of a sine."""
MOST_CYCLES = 20
"""Largest number of cycles in a period."""
DEGREES = (-1e6, 1e6)
"""Range of the phase lead, in degrees.  For a larger lead, the computed phase would be
inaccurate."""
WEAKER = {"rotates": True, "half_disc": False, "half_period_mirror": False}
WEAKER |= {"straight": False, "propels": True}
"""For each attribute, the value that makes the weaker assumption about the symmetry of a motion."""
PLANE = ("forward", "lateral", "angle")
NORMAL = ("load", "indentation")


ROUNDING = 1e-9
"""Two values count as equal if their difference, divided by the largest value, is at most this
rounding error.  The limit applies to the symmetries of samples, and to waveforms and displacements
that users define."""


class Wave(NamedTuple):
    """Oscillation along one direction.

    Parameters
    ----------
    share : float
        Amplitude of the wave divided by the amplitude of the motion, from 0 to 1.
    cycles : int
        Number of cycles in a period, from 1 to 20.
    degrees : float
        Phase lead, in degrees.
    form : callable
        Waveform as a function of an array of phases.  The waveform must have the symmetries of the
        sine: form(-x) = -form(x) and form(pi - x) = form(x). The waveform must also rise from -1 at
        -pi/2 to 1 at pi/2.
    """

    share: float = 1.0
    cycles: int = 1
    degrees: float = 0.0
    form: Callable[[np.ndarray], np.ndarray] = np.sin

    def __call__(self, phase: np.ndarray) -> np.ndarray:
        lead = math.radians(self.degrees % 360.0)
        return self.share * np.asarray(self.form(self.cycles * phase + lead))


@dataclass(frozen=True)
class Motion(spec.Named):
    """A prescribed motion.

    A subclass declares its waves, from which all symmetries are derived.  In a string such as
    "elliptic:forward=0.5,phase=30", the parameters after the name of the motion are the fields of
    the class.  `str` returns this string.  The motion's name is derived from the class name:
    ContinuousBore has the name "continuous-bore".  If a motion is not a sum of waves, its class
    overrides `displacement`. The class also overrides those Python properties that state which
    symmetries the motion has.

    Attributes
    ----------
    waves : mapping of str to Wave
        The wave along each oscillating direction.  Possible keys are "forward", "lateral", "angle",
        and either "load" or "indentation".
    summary, numbers : str
        One-line description of the motion, and description of its parameters.
    velocity_label, amplitude_label : str
        Formulas for the dimensionless velocity and amplitude.
    periodic : bool
        True if the motion has an amplitude and the period 2 pi; False if the motion is steady.
    edge_velocity : bool
        Whether the dimensionless velocity is the velocity divided by the largest speed of the
        contact edge in rotation.  Otherwise, the velocity is divided by omega u_lim.
    readings : tuple of Motion
        Alternative motions through the same samples.  The differences in friction between these
        motions serve as an error estimate.

    Raises
    ------
    InputError
        If a parameter is not finite, if a share is outside 0 to 1, if a number of cycles is not an
        integer from 1 to 20, or if no direction oscillates.
    """

    waves: ClassVar[Mapping[str, Wave]] = {}
    summary: ClassVar[str] = ""
    numbers: ClassVar[str] = ""
    velocity_label: ClassVar[str] = "v0 / (omega u_lim)"
    amplitude_label: ClassVar[str] = "A"
    periodic: ClassVar[bool] = True
    edge_velocity: ClassVar[bool] = False
    readings: ClassVar[Any] = ()

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "motion")
        waves = self.waves if isinstance(self.waves, Mapping) else {"waves": self.waves}
        for name, wave in waves.items():
            if name not in (*PLANE, *NORMAL) or not isinstance(wave, Wave):
                allowed = f"allowed is a mapping of some of {', '.join(PLANE + NORMAL)} to a Wave"
                self._refuse(f"waves: {name!r} is {shown(wave)}; {allowed}")
            spec.refuse_outside(self.name, "motion", name, wave.share, (0.0, 1.0, "a share"))
            spec.refuse_outside(self.name, "motion", f"phase of {name}", wave.degrees, DEGREES)
            if not is_real(wave.cycles) or wave.cycles not in range(1, MOST_CYCLES + 1):
                key = f"{'normal' if name in NORMAL else name}_cycles = {shown(wave.cycles)}"
                self._refuse(f"{key}: allowed is a whole number from 1 to {MOST_CYCLES}")
            if not callable(wave.form) or not self._is_like_sine(f"form of {name}", wave.form):
                allowed = "with form(-x) = -form(x), form(pi - x) = form(x) and form(pi/2) = 1"
                self._refuse(f"form of {name}: allowed is a function {allowed}")
        is_sum = type(self).displacement is Motion.displacement
        if not self.components and (self.waves or self.periodic and is_sum):
            allowed = f"allowed is {' or '.join(self.waves or PLANE + NORMAL)} above 0"
            self._refuse(f"nothing oscillates; {allowed}")
        if self.components.keys() >= {*NORMAL}:
            self._refuse("waves: allowed is load or indentation, not both")
        if self.components.keys() - NORMAL - self.moving or not self.periodic and self.waves:
            self._refuse("waves contradict displacement; allowed are its oscillations alone")
        if self.periodic and np.ptp(self._loop[:, [0, -1]], axis=1).max() > ROUNDING:
            self._refuse("displacement: allowed is one that is equal after 2 pi at velocity 0")
        if self.periodic and not self.drift(1.0, 1.0, 0.0) > 0.0:
            self._refuse("displacement: allowed is one that advances at velocity 1")
        for name, weaker in WEAKER.items():
            derived = getattr(Motion, name)
            own = getattr(type(self), name) is not derived and getattr(self, name) != weaker
            if own and derived.func(self) == weaker:
                self._refuse(f"{name} = {not weaker} contradicts displacement; allowed is {weaker}")

    def _refuse(self, problem: str) -> NoReturn:
        raise InputError("motion", self.name, problem)

    # Symmetries

    @cached_property
    def components(self) -> dict[str, Wave]:
        """Waves with a nonzero share in the motion.

        If the motion is a single wave, and the class does not override `displacement`, the phase
        lead has no effect and is set to 0.
        """
        waves = {name: wave for name, wave in self.waves.items() if wave.share}
        if len(waves) == 1 and type(self).displacement is Motion.displacement:
            return {name: wave._replace(degrees=0.0) for name, wave in waves.items()}
        return waves

    @cached_property
    def moving(self) -> set[str]:
        """Names of the directions that oscillate."""
        if type(self).displacement is Motion.displacement:
            return {*self.components}
        sizes = np.ptp(self._loop, axis=1)
        moving = sizes > ROUNDING * sizes.max()
        return {*np.array(PLANE)[moving], *self.components.keys() & NORMAL}

    @cached_property
    def loads(self) -> bool:
        """Whether the normal load oscillates; see `depth`, `deepest` and `mean_load`."""
        return not self.moving.isdisjoint(NORMAL)

    @cached_property
    def rotates(self) -> bool:
        """Whether the contact rotates.  If the contact rotates, the tractions depend on the polar
        angle."""
        return "angle" in self.moving

    @cached_property
    def half_disc(self) -> bool:
        """Whether, by symmetry, the tractions on one half of a round contact determine the
        tractions on the other half.

        The symmetry is a mirror across the lateral axis for rotations, and a point reflection for
        other motions.  A rotation combined with a lateral motion has neither symmetry.
        """
        return not self.moving >= {"angle", "lateral"}

    def _repeats(self, *signs: float, shift: float = np.pi) -> bool:
        """Return whether a shift in phase multiplies the three displacements by the three signs and
        leaves the load unchanged."""
        phases = (LOOP + shift) % ENDS[1]
        now = np.vstack([self._loop, self._normal(LOOP)])
        later = np.vstack([self.moved(phases, 0.0, 1.0, 0.0), self._normal(phases)])
        mean, factors = now[:, :-1].mean(axis=1)[:, None], np.array([*signs, 1.0])[:, None]
        apart = np.abs(later - mean - factors * (now - mean)).max()
        return bool(apart <= ROUNDING * np.abs(now - mean).max())

    @cached_property
    def half_period_mirror(self) -> bool:
        """Whether the second half of a period equals the first half, except that the lateral
        displacement and the angle have the opposite signs.

        If False, the time integration covers a whole period.
        """
        return self.periodic and bool(self.moving) and self._repeats(1.0, -1.0, -1.0)

    @cached_property
    def straight(self) -> bool:
        """Whether the oscillation alone follows a straight line and turns at the phases -pi/2 and
        pi/2."""
        if not self.periodic or self.moving.isdisjoint(PLANE):
            return True
        end, start = self._loop[:, [180, 540]].T  # phases pi/2 and 3 pi/2
        half, offset = 0.5 * (end - start), self._loop - 0.5 * (start + end)[:, None]
        along = half @ offset / max(half @ half, np.finfo(float).tiny)
        apart = np.abs(offset - half[:, None] * along).max() / np.abs(offset).max()
        forth = np.where(np.cos(LOOP[1:] - LOOP[1] / 2.0) > 0.0, 1.0, -1.0) * np.diff(along)
        return not self.loads and bool(max(apart, -forth.min()) <= ROUNDING)

    @cached_property
    def propels(self) -> bool:
        """Whether the oscillation alone can propel the contact, so that the mean friction can be
        negative.

        Propulsion is impossible if a shift of the oscillation in time has the same effect as a
        reversal of the forward component.  The shift is a fraction 1/(2 d) of the period, where d
        divides the numbers of cycles of all components.  The oscillation cannot propel the contact
        if this shift reverses the forward component, preserves or reverses each of the other
        components, and preserves the load.  The signs of the lateral component and of the angle do
        not matter.  The reason is that, under a symmetric pressure, two images of a solution are
        solutions as well.  The mirror image reverses the forward component and the angle.  The
        point reflection q(-forward, -lateral) reverses the angle. This image is a solution, because
        the influence of one point on another is an even function of the vector between them.  The
        solution -q reverses all components.  Combinations of these three images give every
        combination of signs.  In each image, the forward force is multiplied by the same sign as
        the forward motion.
        """
        signs = [(-1.0, a, b) for a in (1.0, -1.0) for b in (1.0, -1.0)]
        shifts = np.pi / np.arange(1, MOST_CYCLES + 1)
        reverses = (self._repeats(*one, shift=shift) for shift in shifts for one in signs)
        return "forward" in self.moving and not any(reverses)

    @cached_property
    def cycles(self) -> int:
        """Largest number of cycles of any component in a period."""
        return max((int(wave.cycles) for wave in self.components.values()), default=1)

    @cached_property
    def _sines(self) -> bool:
        """Whether the displacement is a sum of sines.  Closed forms for sines apply only in this
        case."""
        sines = all(wave.form is np.sin for wave in self.components.values())
        return sines and type(self).displacement is Motion.displacement

    # Displacement in the plane

    @cached_property
    def _loop(self) -> np.ndarray:
        """Displacements at the phases `LOOP` for the amplitude 1, as an array of shape (3,
        phases)."""
        return self.moved(LOOP, 0.0, 1.0, 0.0)

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute the forward, lateral and angular displacement (Eqs 1, 2, 4, 23, 27 and 28).

        Each of the three arrays has the shape of `phase`.
        """
        parts = dict.fromkeys(PLANE, np.zeros_like(phase))
        for name, wave in self.components.items():
            if name in PLANE:
                parts[name] = amplitude * wave(phase)
        forward, lateral, turn = parts.values()
        if self.edge_velocity or "angle" in self.components:
            unit = hertz.bore_unit(poisson)
            turn = unit * turn
            if self.edge_velocity:
                velocity = velocity * unit * amplitude
        return velocity * phase + forward, lateral, turn

    def moved(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> np.ndarray:
        """Return the three arrays of `displacement` as one array.

        Raises InputError unless the three arrays contain finite real numbers and have the shape of
        `phase`.
        """
        parts = self.displacement(phase, velocity, amplitude, poisson)
        if self._sines:
            return np.array(parts)
        return self._checked("displacement", parts, phase, 3)

    def _checked(self, name: str, values: Any, phase: np.ndarray, *rows: int) -> np.ndarray:
        """Return the values of a user's function at a phase as one array."""
        shape = (*rows, *np.shape(phase))
        try:
            array = np.array(values)
        except ValueError:  # arrays of different shapes
            array = np.array(None)
        if array.shape != shape or array.dtype.kind not in "if":
            found = f"{array.dtype} of the shape {array.shape}"
            self._refuse(f"{name}: returns {found}; allowed are real numbers of the shape {shape}")
        if not np.isfinite(array).all():
            where = np.broadcast_to(phase, shape)[~np.isfinite(array)][0]
            problem = f"returns a number that is not finite at the phase {where:.6g}"
            self._refuse(f"{name}: {problem}; allowed are finite numbers")
        return array

    def _is_like_sine(self, name: str, form: Callable[[np.ndarray], np.ndarray]) -> bool:
        """Return whether a waveform has the symmetries of the sine and equals 1 at pi/2."""
        phase = np.linspace(-2.0 * np.pi, 2.0 * np.pi, 33)
        values = self._checked(name, form(phase), phase)
        images = np.array([np.negative(form(-phase)), form(np.pi - phase)])
        is_symmetric = np.allclose(images, values, rtol=0.0, atol=ROUNDING)
        return bool(is_symmetric and abs(values[20] - 1.0) <= ROUNDING)  # phase[20] is pi/2

    def drift(self, velocity: float, amplitude: float, poisson: float) -> float:
        """Compute the mean forward displacement per radian of phase, in units of u_lim.

        The drift is proportional to the velocity.  This function computes the drift at velocity 1
        and multiplies it by the velocity.  At small velocities, the rounding error of the
        oscillation would exceed the drift.
        """
        if type(self).displacement is Motion.displacement:
            return velocity * (hertz.bore_unit(poisson) * amplitude if self.edge_velocity else 1.0)
        fast = self.moved(ENDS, 1.0, amplitude, poisson)[0]
        still = self.moved(ENDS, 0.0, amplitude, poisson)[0]
        return float(np.diff(fast - still)[0]) / (2.0 * np.pi) * velocity

    def stroke(self, amplitude: float, poisson: float) -> float:
        """Compute half the peak-to-peak displacement of the contact edge, in units of u_lim.  The
        result is 0 for steady motions."""
        if not self.periodic:
            return 0.0
        ends = self.moved(np.array(HALF_PERIOD), 0.0, amplitude, poisson)
        return 0.5 * float(np.ptp(ends, axis=1).max())

    @cached_property
    def reach(self) -> float:
        """Largest distance from the mean position, divided by the amplitude of the motion."""
        return float(np.hypot(*self._loop[:2]).max())

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Return the radius towards which the rings are graded. The traction has a kink at this
        radius. The result is None if there is no kink.

        If the load oscillates, the result is the smallest contact radius divided by the largest.
        For a translation, consider a straight oscillation with the same largest distance from the
        centre. The result is the stick radius of this oscillation (Eq 8).  For a rotation, the
        result is Lubkin's stick radius (Eq 30).  Lubkin's radius is derived for Hertz pressure, but
        a mesh graded towards it does no harm under other pressures.
        """
        if self.loads:
            smallest, largest = map(pressure.radius, self._extremes(amplitude, pressure))
            return within_rings(float(smallest / largest))
        if self.reach > 0.0:
            return stick_focus(amplitude * self.reach, pressure)
        if "angle" not in self.components:
            return None
        turn = amplitude * self.components["angle"].share
        return within_rings(float(hertz.lubkin_stick_radius(turn * hertz.bore_unit(0.0))))

    def turns(self, velocity: float, amplitude: float) -> tuple[float, ...]:
        """Return the phases of the start, the turning points and the end of the time integration.

        The time integration covers half a period or a whole period.  If the load oscillates, the
        integration begins at the smallest load.  A longitudinal motion v t + A sin t turns where
        its velocity changes sign.
        """
        if self._longitudinal and velocity < amplitude * self.reach:
            back = float(np.arccos(-velocity / (amplitude * self.reach)))
            return -back, back, 2.0 * np.pi - back
        first = -0.5 * np.pi / self._normal.cycles
        return tuple(first + np.pi * np.arange(2 if self.half_period_mirror else 3))

    # Normal load

    @cached_property
    def _normal(self) -> Wave:
        waves = [self.components[name] for name in NORMAL if name in self.components]
        return waves[0] if waves else Wave(0.0)

    def _depth_at(self, height: np.ndarray, pressure: Pressure) -> np.ndarray:
        """Convert a load or an indentation to the indentation depth. The depth is 0 if there is no
        contact."""
        height = np.maximum(height, 0.0)
        return pressure.of_load(height) if "load" in self.moving else height

    def _extremes(self, amplitude: float, pressure: Pressure) -> tuple[float, float]:
        """Return the smallest and the largest indentation depth."""
        swing = amplitude * self._normal.share * np.array([-1.0, 1.0])
        least, most = self._depth_at(1.0 + swing, pressure)
        return float(least), float(most)

    def depth(self, phase: np.ndarray, amplitude: float, pressure: Pressure) -> np.ndarray:
        """Compute the indentation depth divided by its reference value.

        The result is 0 if there is no contact.
        """
        return self._depth_at(1.0 + amplitude * self._normal(phase), pressure)

    def deepest(self, amplitude: float, pressure: Pressure) -> float:
        """Return the largest value of `depth` in a period."""
        return self._extremes(amplitude, pressure)[1] if self.loads else 1.0

    def mean_load(self, amplitude: float, pressure: Pressure) -> float:
        """Compute the mean normal load, divided by the reference load."""
        if not self.loads:
            return 1.0
        size, by_load = amplitude * self._normal.share, "load" in self.components
        return oscillating_load.mean_load(size, by_load, pressure)

    # Closed forms

    @cached_property
    def _longitudinal(self) -> bool:
        return self.components.keys() == {"forward"} and self.straight and self._sines

    def closed_form(
        self, velocity: float, amplitude: float, pressure: Pressure
    ) -> tuple[float, float] | None:
        """Return the mean friction and the dissipated energy per period at nu = 0, if there is a
        closed form.

        The result is None if there is no closed form.  Velocity 0 stands for the static limit.  A
        motion along the direction of sliding follows Masing's rules under every pressure with a
        known loading curve.  If only the load oscillates, there is a closed form for axisymmetric
        indenters (theory/oscillating_load.py).
        """
        if self._longitudinal and pressure.loading is not None:
            place = velocity, amplitude * self.reach, pressure.loading
            return float(masing.longitudinal(*place)), masing.longitudinal_energy(*place)
        if self.loads and len(self.components) == 1 and self._sines and pressure.is_indenter:
            slow, size = velocity / self._normal.cycles, amplitude * self._normal.share
            by_load = "load" in self.components
            mu = oscillating_load.friction(slow, size, by_load, pressure)
            return mu, 2.0 * np.pi * velocity * mu * self.mean_load(amplitude, pressure)
        return None


def within_rings(radius: float) -> float:
    """Clip a radius to FOCUS_RANGE, so that no ring degenerates at the centre or the edge."""
    return float(np.clip(radius, *FOCUS_RANGE))


def stick_focus(reach: float, pressure: Pressure) -> float | None:
    """Return the stick radius of an oscillation along a line.  `reach` is the amplitude of the
    oscillation, in units of u_lim.

    For a sphere, the stick radius is given by Eq 8.  The result is None at full slip, or if the
    stick zone is not a circle.
    """
    radius = pressure.stick_radius(reach) if reach < 1.0 else None
    return None if radius is None else within_rings(radius)
