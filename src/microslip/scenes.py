"""What moves: the rigid in-plane motions of the counterbody and their dimensionless groups.

Names do not depend on the paper's axes: *forward* is the direction of sliding, *lateral* the one
across it, with forward x lateral such that a positive angle moves points on the positive lateral
side forward.  Displacements are in u_lim, angles in u_lim / a, time is the phase omega t.

A scene is one ``Scene`` record.  To add a motion write its displacement and say which symmetries
it has; nothing else in the package names a scene.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from microslip import hertz

FOCUS_RANGE = (0.05, 0.9995)
"""Radii that rings may gather at; a stick zone smaller than the first carries next to no load."""


@dataclass(frozen=True)
class Scene:
    """One kind of motion.

    displacement(phase, velocity, amplitude, poisson) -> (forward, lateral, angle), arrays of the
    shape of ``phase``.
    periodic: the motion oscillates with period 2 pi and needs an amplitude; otherwise it is steady.
    rotates: the angle is not zero, so tractions depend on the angle around the contact, with mirror
    symmetry across the lateral axis; without it they have point symmetry.
    half_period_mirror: half a period later the motion is its own image under lateral -> -lateral.
    Without it a whole period is marched.
    focus(velocity, amplitude): radius where the traction has its kink (None: nowhere special).
    """

    name: str
    summary: str
    displacement: Callable
    periodic: bool
    rotates: bool
    half_period_mirror: bool
    focus: Callable
    velocity_label: str
    amplitude_label: str = ""

    def creep(self, velocity, amplitude, poisson):
        """Mean forward displacement in one radian of phase, in u_lim."""
        ends = np.array([0.0, 2.0 * np.pi])
        forward, _, _ = self.displacement(ends, velocity, amplitude, poisson)
        return float(forward[1] - forward[0]) / (2.0 * np.pi)

    def stroke(self, amplitude, poisson):
        """Half the way that the edge of the contact oscillates, in u_lim; 0 for steady scenes."""
        if not self.periodic:
            return 0.0
        ends = self.displacement(np.array([-0.5, 0.5]) * np.pi, 0.0, amplitude, poisson)
        return 0.5 * max(float(abs(part[1] - part[0])) for part in ends)


def _transverse(phase, velocity, amplitude, poisson):
    """Eq 1 with Eqs 2 and 4: forward v~ t, lateral y~ sin t."""
    return velocity * phase, amplitude * np.sin(phase), np.zeros_like(phase)


def _longitudinal(phase, velocity, amplitude, poisson):
    """The oscillation along the forward direction: forward v~ t + x~ sin t."""
    forward = velocity * phase + amplitude * np.sin(phase)
    return forward, np.zeros_like(phase), np.zeros_like(phase)


def _zigzag(phase, velocity, amplitude, poisson):
    """The transverse scene with a lateral velocity that is constant but for its sign."""
    lateral = amplitude * 2.0 / np.pi * np.arcsin(np.sin(phase))
    return velocity * phase, lateral, np.zeros_like(phase)


def _bore(phase, velocity, amplitude, poisson):
    """Eq 23 with Eqs 27 and 28: forward v~ phi_0 t, angle phi_0 sin t."""
    angle = hertz.bore_angle(amplitude, poisson)
    return velocity * angle * phase, np.zeros_like(phase), angle * np.sin(phase)


def _continuous_bore(phase, velocity, amplitude, poisson):
    """Eqs 12 and 13: forward v~ and angle 1 for each unit of turned angle (in u_lim / a)."""
    return velocity * phase, np.zeros_like(phase), phase + 0.0


def _within(radius):
    """The radius, kept off the centre and the edge so that no ring degenerates."""
    return float(np.clip(radius, *FOCUS_RANGE))


def _transverse_focus(velocity, amplitude):
    """Mindlin's stick radius of the oscillation alone (Eq 8); nowhere once it slides fully."""
    return _within(np.sqrt(1.0 - amplitude)) if amplitude < 1.0 else None


def _bore_focus(velocity, amplitude):
    """Lubkin's stick radius of the oscillation alone (Eq 30)."""
    return _within(hertz.lubkin_stick_radius(hertz.bore_angle(amplitude)))


def _steady_focus(velocity, amplitude):
    """The instantaneous centre of rotation, while it lies inside the contact (Eq 14)."""
    return _within(velocity) if velocity < 1.0 else None


TRANSVERSE = Scene(
    name="transverse",
    summary="forward sliding with a lateral oscillation",
    displacement=_transverse,
    periodic=True,
    rotates=False,
    half_period_mirror=True,
    focus=_transverse_focus,
    velocity_label="v0 / (omega u_lim)",
    amplitude_label="y0 / u_lim",
)
ZIGZAG = replace(
    TRANSVERSE,
    name="zigzag",
    summary="forward sliding with a lateral oscillation at constant speed that turns abruptly",
    displacement=_zigzag,
)
LONGITUDINAL = replace(
    TRANSVERSE,
    name="longitudinal",
    summary="forward sliding with an oscillation along the same direction",
    displacement=_longitudinal,
    half_period_mirror=False,
    amplitude_label="x0 / u_lim",
)
BORE = Scene(
    name="bore",
    summary="forward sliding with an oscillating rotation about the contact normal",
    displacement=_bore,
    periodic=True,
    rotates=True,
    half_period_mirror=True,
    focus=_bore_focus,
    velocity_label="v0 / (Omega phi0 a)",
    amplitude_label="phi0 / phi_lk(a/2)",
)
CONTINUOUS_BORE = Scene(
    name="continuous-bore",
    summary="forward sliding with a steady rotation about the contact normal",
    displacement=_continuous_bore,
    periodic=False,
    rotates=True,
    half_period_mirror=False,
    focus=_steady_focus,
    velocity_label="v0 / (omega a)",
)

SCENES = {scene.name: scene for scene in (TRANSVERSE, LONGITUDINAL, ZIGZAG, BORE, CONTINUOUS_BORE)}


def scene_named(name):
    """The scene of this name; raises ValueError listing the known ones."""
    try:
        return SCENES[name]
    except (KeyError, TypeError):
        raise ValueError(f"scene = {name!r}: allowed is one of {', '.join(SCENES)}") from None
