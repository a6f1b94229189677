"""What moves: the rigid in-plane motions of the counterbody and their dimensionless groups.

A scene is one ``Scene`` record (see scene.py for it and for the names of directions).  To add a
motion write its displacement and say which symmetries it has; nothing else in the package names a
scene, but for closed forms that hold for it alone (choice.py).  A family of motions gives a Scene
for numbers, such as elliptic.py and normal.py.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from microslip import elliptic, hertz, normal, parameters
from microslip.scene import Scene, within_rings


def _transverse(phase, velocity, amplitude, poisson):
    """Eq 1 with Eqs 2 and 4: forward v~ t, lateral y~ sin t."""
    return velocity * phase, amplitude * np.sin(phase), np.zeros_like(phase)


def _longitudinal(phase, velocity, amplitude, poisson):
    """The oscillation along the forward direction: forward v~ t + x~ sin t."""
    forward = velocity * phase + amplitude * np.sin(phase)
    return forward, np.zeros_like(phase), np.zeros_like(phase)


def _longitudinal_turns(velocity, amplitude):
    """Where the sphere turns back and forth, if it does: v~ + x~ cos t = 0."""
    back = np.arccos(-velocity / amplitude) if velocity < amplitude else np.pi / 2
    return -back, back, 2.0 * np.pi - back


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


def _transverse_focus(velocity, amplitude):
    """Mindlin's stick radius of the oscillation alone (Eq 8); nowhere once it slides fully."""
    return within_rings(np.sqrt(1.0 - amplitude)) if amplitude < 1.0 else None


def _bore_focus(velocity, amplitude):
    """Lubkin's stick radius of the oscillation alone (Eq 30)."""
    return within_rings(hertz.lubkin_stick_radius(hertz.bore_angle(amplitude)))


def _steady_focus(velocity, amplitude):
    """The instantaneous centre of rotation, while it lies inside the contact (Eq 14)."""
    return within_rings(velocity) if velocity < 1.0 else None


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
    turns=_longitudinal_turns,
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
FAMILIES = {family.NAME: (family.DEFAULTS, family.scene) for family in (elliptic, normal)}
"""Name -> numbers with their defaults, and what makes a Scene of them."""


def scene_named(name):
    """The scene of this name, or of a family for the numbers that follow its name, such as
    "elliptic:forward=0.5,phase=90".  Raises ValueError saying what is allowed."""
    if isinstance(name, str) and name in SCENES:
        return SCENES[name]
    if not isinstance(name, str):
        raise ValueError(f"scene = {name!r}: allowed is one of {', '.join([*SCENES, *FAMILIES])}")
    return _of_family(name)


@lru_cache(maxsize=64)
def _of_family(name):
    """One record for a name: what is prepared for a motion is found again by it."""
    family, numbers = parameters.split(name, "scene", [*SCENES, *FAMILIES])
    defaults, build = FAMILIES.get(family, ({}, None))
    problem = parameters.unknown(name, "scene", numbers, list(defaults))
    if problem:
        raise ValueError(problem)
    given = {key: value for key, value in sorted(numbers.items()) if value != defaults[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    return build(f"{family}:{words}" if words else family, **(defaults | given))
