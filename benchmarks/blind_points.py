"""Draw stratified random points, with more points where error estimates can be too small.

`point(seed, k)` returns point k of a seed's sample. The point depends on seed and k only, so every
longer sample begins with the shorter ones. Seed 3 has the strata that calibrate the error estimate.
The strata of all other seeds also cover drives, several contacts, slow loops under steep pressures,
the neighbourhood of full sliding, and the ranges of the paper at 1e-4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

TOLERANCES, SHARES = (1e-2, 1e-3, 1e-4), (0.45, 0.45, 0.1)
COARSE = (1e-2,)
"""Tolerance of points whose references would be too expensive at smaller tolerances."""
ROUND = ("hertz", "power:exponent=1", "power:exponent=8", "punch", "ring")
OTHERS = ROUND[1:]
TURNING = (
    "normal:angle=1",
    "normal:angle=1,normal_cycles=2",
    "normal:indentation=1,angle=0.5,forward=1,phase=30",
)
LOADS = (
    "normal:lateral=1",
    "normal:lateral=1,normal_cycles=2",
    "normal:forward=1,phase=90",
)
LOOPS = (
    "elliptic",
    "elliptic:forward=0.5,phase=30",
    "elliptic:forward=0.5,phase=0,forward_cycles=2",
)


@dataclass(frozen=True)
class Stratum:
    """Points of one kind.

    Attributes
    ----------
    name : str
        Common property of the points.
    weight : float
        Relative number of points. The weights of all strata are divided by their sum.
    motions : tuple of str, or callable
        Equally probable motions, or a function of the random generator that draws a motion.
    pressures : tuple of str
        Equally probable pressures.
    poisson : tuple of float
        Equally probable Poisson's ratios.
    velocity : (float, float) or None
        Decimal logarithms of the velocity range, or None for the static limit.
    amplitude : (float, float)
        Decimal logarithms of the amplitude range.
    tolerances : tuple of float
        Tolerances. Their probabilities are the first entries of SHARES.
    largest_amplitude : float or None
        If not None, amplitudes are uniform between 0 and this value instead of log-uniform.
    drive : callable or None
        Function of the random generator that draws a drive as a dict of `microslip.solve`
        arguments. A force replaces the velocity.
    contacts : tuple of str
        Equally probable strings that describe several contacts on one body. The solver has no
        such contacts any more. Their points are drawn but not solved, so that the numbers and
        the references of all other points remain.
    """

    name: str
    weight: float
    motions: tuple[str, ...] | Callable
    pressures: tuple[str, ...] = ("hertz",)
    poisson: tuple[float, ...] = (0.0,)
    velocity: tuple[float, float] | None = (-4.0, 2.0)
    amplitude: tuple[float, float] = (-2.0, 2.0)
    tolerances: tuple[float, ...] = TOLERANCES
    largest_amplitude: float | None = None
    drive: Callable | None = None
    contacts: tuple[str, ...] = ()


LATE = np.log10(0.6), np.log10(1.05)
"""Amplitude range in which a translation's stick zone is small, as decimal logarithms."""
NEAR = {"velocity": (-3.0, 1.0), "amplitude": (-1.3, 0.7)}
"""Range in which friction depends on partial slip, as decimal logarithms."""
CALIBRATION_SEED = 3
CALIBRATION = (
    Stratum("lateral, nu = 0", 0.14, ("transverse",)),
    Stratum(
        "lateral, nu = 0, stick zone small",
        0.14,
        ("transverse",),
        velocity=(-4.0, -1.5),
        amplitude=LATE,
    ),
    Stratum("lateral, nu > 0", 0.10, ("transverse",), poisson=(0.3, 0.5)),
    Stratum("bore", 0.18, ("bore",), poisson=(0.0, 0.3, 0.5)),
    Stratum(
        "bore, slow",
        0.12,
        ("bore",),
        poisson=(0.0, 0.3, 0.5),
        velocity=(-4.0, -1.0),
        amplitude=(-0.3, 1.0),
    ),
    Stratum("lateral, other pressures", 0.08, ("transverse",), OTHERS, **NEAR),
    Stratum("bore, other pressures", 0.06, ("bore",), OTHERS, (0.0, 0.3), **NEAR),
    Stratum("forward", 0.04, ("longitudinal",), ROUND, **NEAR),
    Stratum("loops", 0.04, LOOPS, tolerances=TOLERANCES[:2], **NEAR),
    Stratum("oscillating load", 0.02, LOADS, tolerances=TOLERANCES[:2], **NEAR),
    Stratum("oscillating load with a rotation", 0.01, TURNING, tolerances=COARSE, **NEAR),
    Stratum(
        "sideways and rotation",
        0.02,
        ("transverse-bore", "transverse-bore:phase=90"),
        poisson=(0.0, 0.3, 0.5),
        tolerances=TOLERANCES[:2],
        **NEAR,
    ),
    Stratum(
        "squares, elliptic contact",
        0.01,
        ("transverse", "bore"),
        ("ellipse",),
        tolerances=COARSE,
        **NEAR,
    ),
    Stratum("static limit", 0.03, ("transverse", "bore"), ROUND, (0.0, 0.3), None, (-1.3, 0.1)),
    Stratum(
        "static limit of loops", 0.01, LOOPS + LOADS, ("hertz",), (0.0,), None, (-1.3, 0.0), COARSE
    ),
)


STEEP = ("hertz", *OTHERS, "power:exponent=30", "punch:flat=0.95")
"""Pressures, mostly with a steep edge."""
CYCLES = ((1, 1), (1, 1), (2, 1), (1, 2), (3, 1), (3, 2))
PHASES = (0, 10, 30, 45, 60, 90, 120)
"""Loops: forward and sideways cycles in a period, and phases between them in degrees."""
SLOW = {"velocity": (-4.5, -1.0), "tolerances": (1e-2, 5e-3, 2e-3)}
STRAIGHT = ("transverse", "transverse", "zigzag", *LOOPS)
MOVING = {"velocity": (-2.0, 0.5), "amplitude": (-0.5, 1.0), "tolerances": TOLERANCES[:2]}
"""Range in which a force moves most contacts, and a spring changes the friction."""
COUPLES = (
    "phase=0;phase=180",
    "phase=0;phase=180",
    "phase=0;phase=90",
    "load=2;load=1,phase=180",
    "load=2;amplitude=0.5,phase=90",
)
FULL_SLIDING = {
    "velocity": tuple(np.log10((0.06, 0.17))),
    "amplitude": tuple(np.log10((0.95, 1.5))),
}
"""Neighbourhood of full sliding of a translation, where levels can agree by chance."""
BORE_FULL_SLIDING = {
    "velocity": tuple(np.log10((0.05, 0.4))),
    "amplitude": tuple(np.log10((0.9, 3.0))),
}
"""Neighbourhood of full sliding of a rotation, whose centre slides last."""
STIFFNESS = 1.5
"""Stiffness of a sphere's contact at nu = 0."""


def _loop(draw):
    forward, lateral = CYCLES[draw.integers(len(CYCLES))]
    share, phase = round(float(draw.uniform(0.2, 1.0)), 2), int(draw.choice(PHASES))
    cycles = f"forward_cycles={forward},lateral_cycles={lateral}"
    return f"elliptic:forward={share},phase={phase},{cycles}"


def _between(draw, low, high):
    """Draw a log-uniform number with four digits."""
    return float(f"{10.0 ** draw.uniform(np.log10(low), np.log10(high)):.4g}")


def _force(draw):
    return {"force": round(float(draw.uniform(0.1, 0.95)), 4)}


def _spring(draw):
    return {"stiffness": _between(draw, 1e-2, 1e2)}


def _mass(draw):
    return {"mass": _between(draw, 0.03, 100.0)}


def _light_mass(draw):
    """Draw a mass with a natural frequency of 2 to 50 times the vibration frequency."""
    return {"mass": float(f"{STIFFNESS / _between(draw, 2.0, 50.0) ** 2:.4g}")}


def _together(*drives):
    def drawn(draw):
        return {name: value for drive in drives for name, value in drive(draw).items()}

    return drawn


def _driven(name, drive, weights, **changes):
    """Return the strata of translations and rotations under a drive."""
    both = (("translations", STRAIGHT, ROUND), ("bore", ("bore",), ("hertz", *ROUND)))
    return tuple(
        Stratum(
            f"{name}, {kind}",
            weight,
            motions,
            pressures,
            poisson=(0.0, 0.0, 0.3),
            drive=drive,
            **MOVING | changes,
        )
        for (kind, motions, pressures), weight in zip(both, weights, strict=True)
    )


FEW = 0.011
"""Weight of strata with expensive references: about 60 of 6,000 points."""
WEIGHTS = {
    "lateral, nu = 0": 0.04,
    "lateral, nu = 0, stick zone small": 0.06,
    "lateral, nu > 0": 0.02,
    "lateral, other pressures": 0.04,
    "forward": 0.02,
    "loops": 0.03,
    "oscillating load": 0.015,
    "static limit": 0.015,
}
"""Weights of the calibration strata in the validation. Other strata have the weight FEW."""
VALIDATION = (
    *(replace(stratum, weight=WEIGHTS.get(stratum.name, FEW)) for stratum in CALIBRATION),
    Stratum(
        "lateral, next to full sliding",
        0.09,
        ("transverse", "transverse", "zigzag"),
        poisson=(0.0, 0.0, 0.3),
        **FULL_SLIDING,
    ),
    Stratum(
        "lateral, next to full sliding, other pressures",
        0.08,
        ("transverse",),
        OTHERS,
        **FULL_SLIDING,
    ),
    Stratum(
        "bore, next to full sliding", 0.017, ("bore",), ROUND, (0.0, 0.3, 0.5), **BORE_FULL_SLIDING
    ),
    Stratum(
        "sideways and rotation, next to full sliding",
        FEW,
        ("transverse-bore", "transverse-bore:phase=90"),
        poisson=(0.0, 0.3),
        tolerances=TOLERANCES[:2],
        **BORE_FULL_SLIDING,
    ),
    Stratum("slow loops, steep pressures", 0.045, _loop, STEEP, amplitude=(-1.0, 0.3), **SLOW),
    Stratum(
        "slow loops, steep pressures, stick zone small",
        0.045,
        _loop,
        STEEP,
        amplitude=tuple(np.log10((0.55, 1.1))),
        **SLOW,
    ),
    *_driven("force", _force, (0.05, FEW)),
    *_driven("force on a mass", _together(_force, _mass), (0.04, FEW)),
    *_driven("force on a small mass", _together(_force, _light_mass), (0.05, FEW)),
    *_driven("spring", _spring, (0.045, FEW)),
    *_driven("spring with a mass", _together(_spring, _mass), (0.04, FEW)),
    *_driven("spring with a small mass", _together(_spring, _light_mass), (0.05, FEW)),
    Stratum(
        "several contacts",
        0.015,
        ("transverse", "longitudinal", "bore", *LOOPS),
        contacts=COUPLES,
        **NEAR | {"tolerances": TOLERANCES[:2]},
    ),
    *(
        Stratum(
            f"several contacts, {name}",
            0.03,
            ("transverse", "longitudinal", "zigzag", *LOOPS),
            contacts=COUPLES,
            drive=drive,
            **MOVING,
        )
        for name, drive in (("force", _force), ("spring with a mass", _together(_spring, _mass)))
    ),
    Stratum(
        "several contacts, bore",
        FEW,
        ("bore",),
        contacts=COUPLES,
        drive=_force,
        **MOVING | {"tolerances": COARSE},
    ),
    *(
        Stratum(
            f"{name}, ranges of the paper",
            weight,
            (motion,),
            velocity=(-3.0, 1.0),
            largest_amplitude=largest,
            tolerances=TOLERANCES[2:],
        )
        for name, weight, motion, largest in (
            ("lateral", 0.04, "transverse", 3.0),
            ("bore", FEW, "bore", 5.0),
        )
    ),
)
GOLDEN = 0.5 * (5.0**0.5 - 1.0)
"""The fractional parts of the multiples of this number fill the interval from 0 to 1 evenly."""


ELLIPSES = tuple(
    f"ellipse:ratio={ratio},across={across}"
    for ratio in (0.9, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05)
    for across in (0, 1)
)
ELLIPTIC_SEED = 9
ELLIPTIC = tuple(
    Stratum(
        f"elliptic contacts, {kind}",
        0.5,
        motions,
        ELLIPSES,
        poisson=(0.0, 0.3, 0.5),
        tolerances=(1e-2, 5e-3),
        **NEAR,
    )
    for kind, motions in (
        ("translations", ("transverse", "longitudinal", "elliptic:forward=0.5,phase=60")),
        ("rotations", ("bore", "bore", "transverse-bore")),
    )
)
"""Ellipses of all aspect ratios, with the long axis forward or sideways."""


def strata_of(seed: int) -> tuple[Stratum, ...]:
    """Return the strata of a seed's sample."""
    return {CALIBRATION_SEED: CALIBRATION, ELLIPTIC_SEED: ELLIPTIC}.get(seed, VALIDATION)


def point(seed: int, k: int) -> dict:
    """Return point k of a seed's sample: arguments of `microslip.solve`, and the stratum."""
    draw = np.random.default_rng([seed, k])
    strata = strata_of(seed)
    weights = np.array([stratum.weight for stratum in strata])
    if seed == CALIBRATION_SEED:
        stratum = strata[draw.choice(len(strata), p=weights / weights.sum())]
    else:
        ends = np.cumsum(weights) / weights.sum()
        stratum = strata[np.searchsorted(ends[:-1], GOLDEN * (k + 1) % 1.0)]
    shares = np.array(SHARES[: len(stratum.tolerances)])

    def within(decades):
        return float(f"{10.0 ** draw.uniform(*decades):.4g}")

    def amplitude():
        if stratum.largest_amplitude is None:
            return within(stratum.amplitude)
        return round(float(draw.uniform(0.0, stratum.largest_amplitude)), 4)

    motions = stratum.motions
    drawn = {
        "stratum": stratum.name,
        "motion": motions(draw) if callable(motions) else str(draw.choice(motions)),
        "pressure": str(draw.choice(stratum.pressures)),
        "poisson": float(draw.choice(stratum.poisson)),
        "velocity": within(stratum.velocity) if stratum.velocity else 0.0,
        "amplitude": amplitude(),
        "tolerance": float(draw.choice(stratum.tolerances, p=shares / shares.sum())),
    }
    if stratum.drive:
        drawn |= stratum.drive(draw)
    if stratum.contacts:
        drawn["contacts"] = str(draw.choice(stratum.contacts))
    if "force" in drawn:
        del drawn["velocity"]
    return drawn
