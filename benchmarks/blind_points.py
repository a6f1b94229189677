"""Random points of all kinds, stratified: where claims are at risk there are many of them.

`point(seed, k)` is point k of the sample of a seed, whatever was drawn before it: a longer sample
begins with a shorter one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

TOLERANCES, SHARES = (1e-2, 1e-3, 1e-4), (0.45, 0.45, 0.1)
COARSE = (1e-2,)
"""Tolerance of what is too dear to be referred to at a tenth of a finer one."""
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
        What they have in common.
    weight : float
        Their share of all points, over the sum of the weights of all strata.
    motions, pressures : tuple of str
        Drawn with equal chances.
    poisson : tuple of float
        The same.
    velocity : (float, float) or None
        Decimal logarithms of the range; None: the static limit.
    amplitude : (float, float)
        The same of the amplitude.
    tolerances : tuple of float
        Drawn with the chances SHARES, as far as there are as many.
    """

    name: str
    weight: float
    motions: tuple[str, ...]
    pressures: tuple[str, ...] = ("hertz",)
    poisson: tuple[float, ...] = (0.0,)
    velocity: tuple[float, float] | None = (-4.0, 2.0)
    amplitude: tuple[float, float] = (-2.0, 2.0)
    tolerances: tuple[float, ...] = TOLERANCES


LATE = np.log10(0.6), np.log10(1.05)
"""Amplitudes at which the stick zone of a translation to and fro is small."""
NEAR = {"velocity": (-3.0, 1.0), "amplitude": (-1.3, 0.7)}
"""Where partial slip decides."""
STRATA = (
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


def point(seed: int, k: int) -> dict:
    """Point k of the sample of a seed: arguments of `microslip.solve`, and its stratum."""
    draw = np.random.default_rng([seed, k])
    weights = np.array([stratum.weight for stratum in STRATA])
    stratum = STRATA[draw.choice(len(STRATA), p=weights / weights.sum())]
    shares = np.array(SHARES[: len(stratum.tolerances)])

    def within(decades):
        return float(f"{10.0 ** draw.uniform(*decades):.4g}")

    return {
        "stratum": stratum.name,
        "motion": str(draw.choice(stratum.motions)),
        "pressure": str(draw.choice(stratum.pressures)),
        "poisson": float(draw.choice(stratum.poisson)),
        "velocity": within(stratum.velocity) if stratum.velocity else 0.0,
        "amplitude": within(stratum.amplitude),
        "tolerance": float(draw.choice(stratum.tolerances, p=shares / shares.sum())),
    }
