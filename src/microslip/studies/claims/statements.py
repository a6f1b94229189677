"""The statements of the paper in plain words, the parts that they are cut into, and the criteria.

A criterion is a number that stands here and nowhere else; what it is compared with comes out of
runs, see checks.py.
"""

from dataclasses import dataclass

GOOD = 0.02
"""Largest distance of mu_macro from a formula that counts as good: what the eye sees on a map with
contours of a tenth."""
SLIGHT = 0.05
"""Largest distance that counts as slight."""
AGREES = 0.01
"""Largest distance that counts as agreement, of a curve and a dashed line drawn over it."""
RELATIVE = 0.1
"""Largest distance over the true value that counts as good, where friction itself is small."""
LARGE_BORE = 5.0
"""Bore amplitude from which on it counts as large: the largest that the paper's map shows."""
TURNING_BORE = 2.0
"""Bore amplitude that divides where the paper finds Eq 33 good from where it does not."""
ON_BOUND = 0.999
"""Share of the friction bound that a traction has to reach to count as slipping."""
ALIGNED = 4.0
"""Largest angle in degrees between traction and slip: what the paper itself allows."""
ALTERNATES = 0.5
"""Part of the sticking area by which one side has to lead where patches alternate."""
VANISHES = 1e-9
"""Friction over mu F_z up to which there counts as being none."""
FAR = 3.0
"""Bore amplitude from which on the stick zone is small and an asymptote may be asked for."""

STATEMENTS = {
    1: "Under transverse oscillation the rigid slider (Eq 6) gives a friction slightly too low at "
    "any finite amplitude: it overestimates the reduction.",
    2: "Under transverse oscillation an elastic slider (Eq 7) overestimates static friction; the "
    "load inside the stick zone (Eq 11) comes closer.",
    3: "The continuous bore settles on the steady force and torque of Eqs 21 and 22, whether it "
    "starts from full stick, full rotational slip or full lateral slip.",
    4: "In the steady continuous bore nothing sticks, even with the centre of rotation inside the "
    "contact.",
    5: "Under oscillating bore of large amplitude friction is that of a contact which is steady at "
    "every instant (Eq 29).",
    6: "Under oscillating bore Eq 33 is good for static friction at amplitudes above 2, and "
    "underestimates the reduction below.",
    7: "Near static friction the oscillating bore never slides fully; patches of stick alternate "
    "between left and right.",
    8: "However slow the forward motion, the oscillating bore never takes all friction away.",
    9: "Under any superposed motion friction rises with the forward velocity.",
}


@dataclass(frozen=True)
class Part:
    """One thing that a statement says, in a form that a number can speak for or against.

    Attributes
    ----------
    claim : int
        Number of the statement.
    name : str
        Name of the part, and of the function in `checks` or `checks_static` for its checks.
    text : str
        What is asked, with its criterion.
    counts : bool
        Whether the verdict on the statement depends on it.
    """

    claim: int
    name: str
    text: str
    counts: bool = True


PARTS = (
    Part(1, "rigid_below", "Eq 6 lies below the computed friction"),
    Part(1, "rigid_near", f"... and within {SLIGHT:g} of it"),
    Part(
        1,
        "rigid_below_squares",
        "Eq 6 lies below the friction of the paper's own run, at its smallest velocity and the "
        "largest amplitude",
        counts=False,
    ),
    Part(2, "slider_above", "Eq 7 lies above the static limit"),
    Part(2, "zone_nearer", "Eq 11 is nearer to the static limit than Eq 7"),
    Part(
        2,
        "slider_above_march",
        "Eq 7 lies above even the friction at the smallest velocity, a bound of the limit",
        counts=False,
    ),
    Part(2, "zone_above", "Eq 11 lies above the static limit too", counts=False),
    Part(3, "force_settles", f"the force ends within {AGREES:g} of Eq 21, from each start"),
    Part(3, "torque_settles", f"the torque ends within {AGREES:g} of Eq 22, from each start"),
    Part(3, "force_steady", f"certified steady force within {AGREES:g} of Eq 21", counts=False),
    Part(4, "on_bound", f"every traction is at least {ON_BOUND:g} of its bound"),
    Part(4, "aligned", f"every traction is within {ALIGNED:g} degrees of the rigid slip (Eq 15)"),
    Part(5, "steady_near", f"Eq 29 is within {GOOD:g}, at amplitudes from {LARGE_BORE:g} on"),
    Part(5, "steady_nears", "Eq 29 gets nearer from one amplitude to the next", counts=False),
    Part(
        5,
        "steady_near_below",
        f"Eq 29 is within {GOOD:g} at amplitudes below {LARGE_BORE:g} too",
        counts=False,
    ),
    Part(
        6,
        "bore_zone_near",
        f"Eq 33 is within {GOOD:g} of the static limit, at amplitudes above {TURNING_BORE:g}",
    ),
    Part(
        6,
        "bore_zone_relative",
        f"... and within {100 * RELATIVE:g} % of the limit's own value",
    ),
    Part(
        6,
        "bore_zone_above",
        f"Eq 33 lies above the static limit, at amplitudes below {TURNING_BORE:g}",
    ),
    Part(
        6,
        "bore_zone_seen",
        f"Eq 33 is within {GOOD:g} of the friction at the paper's smallest velocity, above "
        f"{TURNING_BORE:g}",
        counts=False,
    ),
    Part(
        6,
        "bore_zone_above_march",
        "there Eq 33 lies above even the friction at the smallest velocity, a bound of the limit",
        counts=False,
    ),
    Part(
        6,
        "bore_zone_printed",
        f"Eq 33 as printed, without the square, is within {GOOD:g}, above {TURNING_BORE:g}",
        counts=False,
    ),
    Part(7, "some_sticks", "at every phase part of the contact sticks, more than one cell"),
    Part(
        7,
        "alternates",
        f"when least sticks one side leads by {ALTERNATES:g} of it, the other half a period later",
    ),
    Part(8, "limit_positive", f"the static limit is above {VANISHES:g} (closed form)"),
    Part(
        8,
        "limit_positive_rings",
        f"the static limit is above {VANISHES:g} on rings too, with no closed form",
        counts=False,
    ),
    Part(
        8,
        "limit_asymptote",
        f"from amplitude {FAR:g} on it is within {100 * RELATIVE:g} % of an asymptote that never "
        "vanishes",
    ),
    Part(9, "rises_transverse", "transverse: from one velocity to the next friction rises"),
    Part(9, "rises_bore", "oscillating bore: from one velocity to the next friction rises"),
    Part(9, "rises_continuous_bore", "continuous bore: likewise"),
)
