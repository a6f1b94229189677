"""The motions of the package.  Most motions are declared by their waves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.foundation import spec
from microslip.scene.motion import Motion, Wave, within_rings
from microslip.scene.pressure import Pressure


@dataclass(frozen=True)
class Transverse(Motion):
    """Sliding forward with a sinusoidal oscillation in the lateral direction (Eq 1)."""

    summary = "sliding forward while oscillating sideways"
    amplitude_label = "y0 / u_lim"
    waves = {"lateral": Wave()}


@dataclass(frozen=True)
class Longitudinal(Motion):
    """Sliding forward with a sinusoidal oscillation in the same direction."""

    summary = "sliding forward while oscillating along the same direction"
    amplitude_label = "x0 / u_lim"
    waves = {"forward": Wave()}


def triangle(phase: np.ndarray) -> np.ndarray:
    """Evaluate a triangular wave of amplitude 1 with the zeros and the sign of the sine."""
    return 2.0 / np.pi * np.arcsin(np.sin(phase))


@dataclass(frozen=True)
class Zigzag(Motion):
    """Sliding forward with a triangular oscillation in the lateral direction."""

    summary = "sliding forward while moving sideways at constant speed, with abrupt turns"
    amplitude_label = "y0 / u_lim"
    waves = {"lateral": Wave(form=triangle)}


@dataclass(frozen=True)
class Bore(Motion):
    """Sliding forward with a sinusoidal rotation about the contact normal (spin; Eqs 23 and 27)."""

    summary = "sliding forward while oscillating in rotation about the contact normal"
    velocity_label = "v0 / (Omega phi0 a)"
    amplitude_label = "phi0 / phi_lk(a/2)"
    edge_velocity = True
    waves = {"angle": Wave()}


@dataclass(frozen=True)
class ContinuousBore(Motion):
    """Sliding forward with a steady rotation about the contact normal (Eqs 12 and 13).

    The phase equals the angle of rotation in units of u_lim / a.
    """

    summary = "sliding forward while rotating steadily about the contact normal"
    velocity_label = "v0 / (omega a)"
    amplitude_label = ""
    periodic = False

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forward displacement v~ t, the lateral displacement 0, and the angle t."""
        return velocity * phase, np.zeros_like(phase), phase + 0.0

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Return the distance of the instantaneous centre of rotation from the contact centre (Eq
        14).  Return None if the centre is outside the contact."""
        return within_rings(velocity) if velocity < 1.0 else None


@dataclass(frozen=True)
class TransverseBore(Motion):
    """Sliding forward with a lateral oscillation and an oscillating rotation.

    Parameters
    ----------
    lateral, angle : float
        Amplitudes divided by the amplitude of the motion, from 0 to 1.  The unit of `lateral` is
        u_lim, and the unit of `angle` is phi_lk(a/2).
    phase : float
        Phase lead of the rotation, in degrees.
    """

    lateral: float = 1.0
    angle: float = 1.0
    phase: float = 0.0

    summary = "sliding forward while oscillating sideways and in rotation"
    numbers = (
        "such as angle=0.5,phase=90: fractions of A, lateral (1, divided by u_lim) and angle (1, "
        "divided by phi_lk(a/2)), phase of the rotation in degrees (0)"
    )

    @property
    def waves(self) -> dict[str, Wave]:  # type: ignore[override]
        return {"lateral": Wave(self.lateral), "angle": Wave(self.angle, 1, self.phase)}


@dataclass(frozen=True)
class Elliptic(Motion):
    """Sliding forward while oscillating on a line, an ellipse or a Lissajous figure.

    Parameters
    ----------
    forward, lateral : float
        Amplitude in each direction, divided by the amplitude of the motion, from 0 to 1.
    phase : float
        Phase lead of the forward oscillation, in degrees.
    forward_cycles, lateral_cycles : int
        Number of cycles in a period, from 1 to 20.
    """

    forward: float = 1.0
    lateral: float = 1.0
    phase: float = 90.0
    forward_cycles: int = 1
    lateral_cycles: int = 1

    summary = "sliding forward while oscillating along two directions"
    numbers = (
        "such as forward=0.5,phase=30: shares of A, forward and lateral (1), phase of forward in "
        "degrees (90), forward_cycles and lateral_cycles (1)"
    )
    amplitude_label = "A / u_lim"

    @property
    def waves(self) -> dict[str, Wave]:  # type: ignore[override]
        forward = Wave(self.forward, self.forward_cycles, self.phase)
        return {"forward": forward, "lateral": Wave(self.lateral, self.lateral_cycles)}


@dataclass(frozen=True)
class Normal(Motion):
    """Sliding forward while the normal load or the indentation oscillates.

    The contact can oscillate in the plane as well.  Friction is divided by mu times the mean load.

    Parameters
    ----------
    load, indentation : float
        Amplitude of the load or of the indentation, divided by the amplitude of the motion, from 0
        to 1.  `load` must keep its default of 1 if `indentation` is above 0.
    lateral, forward, angle : float
        In-plane amplitudes divided by the amplitude of the motion, from 0 to 1.  The unit is u_lim
        for displacements, and phi_lk(a/2) for the angle.
    phase : float
        Phase lead of the in-plane oscillation, in degrees.
    normal_cycles, lateral_cycles, forward_cycles, angle_cycles : int
        Number of cycles in a period, from 1 to 20.

    Raises
    ------
    InputError
        If neither the load nor the indentation oscillates, or if both are specified.
    """

    load: float = 1.0
    indentation: float = 0.0
    lateral: float = 0.0
    forward: float = 0.0
    angle: float = 0.0
    phase: float = 0.0
    normal_cycles: int = 1
    lateral_cycles: int = 1
    forward_cycles: int = 1
    angle_cycles: int = 1

    summary = "sliding forward while the normal load oscillates, or the indentation"
    numbers = (
        "such as lateral=1,phase=90: fractions of A, load (1, divided by the mean) or indentation "
        "(0: the load oscillates), lateral and forward (0, divided by u_lim), angle (0, divided by "
        "phi_lk(a/2)), phase of these in degrees (0), normal_cycles, lateral_cycles, "
        "forward_cycles and angle_cycles (1)"
    )

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "motion")
        if self.load == self.indentation == 0.0:
            self._refuse("allowed is load or indentation above 0")
        super().__post_init__()
        if self.indentation > 0.0 and self.load != 1.0:
            self._refuse(f"load = {self.load:g}: allowed is no load beside an indentation")

    @property
    def waves(self) -> dict[str, Wave]:  # type: ignore[override]
        return {
            "load": Wave(0.0 if self.indentation else self.load, self.normal_cycles),
            "indentation": Wave(self.indentation, self.normal_cycles),
            "forward": Wave(self.forward, self.forward_cycles, self.phase),
            "lateral": Wave(self.lateral, self.lateral_cycles, self.phase),
            "angle": Wave(self.angle, self.angle_cycles, self.phase),
        }


NAMED = (
    Transverse,
    Longitudinal,
    Zigzag,
    Bore,
    ContinuousBore,
    Elliptic,
    Normal,
    TransverseBore,
)
"""Motions in the order in which they are listed to users."""
