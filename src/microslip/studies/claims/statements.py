"""The paper's statements in plain words, and their criteria. Statement 10 is by M. Popov (2020).

A part is one aspect of a statement that numbers can confirm or refute. The checks of each part are
in `parts`.
"""

GOOD = 0.02
"""A formula for mu_macro counts as good if its error is at most this. An error of this size is just
visible on a map with contours at steps of 0.1."""
SLIGHT = 0.05
"""Largest difference in mu_macro that counts as slight."""
AGREES = 0.01
"""A curve and a dashed line over it count as equal up to this difference in mu_macro."""
RELATIVE = 0.1
"""Where friction is small, a formula counts as good if its relative error is at most this."""
LARGE_BORE = 5.0
"""Smallest bore amplitude that counts as large: the largest amplitude of the paper's map."""
TURNING_BORE = 2.0
"""Bore amplitude above which the paper considers Eq 33 good."""
ON_BOUND = 0.999
"""A point counts as slipping if its traction divided by the friction bound is above this number."""
ALIGNED = 4.0
"""Largest angle in degrees between traction and slip: the tolerance of the paper."""
ALTERNATES = 0.5
"""The patches alternate if the stick areas of the two halves differ by at least this fraction of
the whole stick area."""
VANISHES = 1e-9
"""Largest mean force, divided by mu F_z, that counts as zero."""
FAR = 3.0
"""Smallest bore amplitude at which the stick zone is small enough for the asymptote."""

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
    10: "M. Popov (2020): if the indentation oscillates and the stiffness is constant, Eq 37 "
    "approximates the friction and is more accurate than Eq 38.",
}

CRITERIA = {
    1: {
        "rigid_below": "Eq 6 lies below the computed friction",
        "rigid_near": f"Eq 6 is within {SLIGHT:g} of the computed friction",
        "rigid_below_squares": "Eq 6 lies below the friction of the paper's own run, at its "
        "smallest velocity and the largest amplitude",
    },
    2: {
        "slider_above": "Eq 7 lies above the static limit",
        "zone_nearer": "Eq 11 is nearer to the static limit than Eq 7",
        "slider_above_march": "Eq 7 lies above even the friction at the smallest velocity, an "
        "upper bound of the limit",
        "zone_above": "Eq 11 lies above the static limit too",
    },
    3: {
        "force_settles": f"the force ends within {AGREES:g} of Eq 21, from each start",
        "torque_settles": f"the torque ends within {AGREES:g} of Eq 22, from each start",
        "force_steady": f"the steady force at the tolerance is within {AGREES:g} of Eq 21",
    },
    4: {
        "on_bound": f"every traction is at least {ON_BOUND:g} of its bound",
        "aligned": f"every traction is within {ALIGNED:g} degrees of the rigid slip (Eq 15)",
    },
    5: {
        "steady_near": f"Eq 29 is within {GOOD:g}, at amplitudes from {LARGE_BORE:g} on",
        "steady_nears": "Eq 29 gets nearer from one amplitude to the next",
        "steady_near_below": f"Eq 29 is within {GOOD:g} at amplitudes below {LARGE_BORE:g} too",
    },
    6: {
        "bore_zone_near": f"Eq 33 is within {GOOD:g} of the static limit, at amplitudes above "
        f"{TURNING_BORE:g}",
        "bore_zone_relative": f"Eq 33 is within {100 * RELATIVE:g} % of the static limit, at "
        f"amplitudes above {TURNING_BORE:g}",
        "bore_zone_above": f"Eq 33 lies above the static limit, at amplitudes below "
        f"{TURNING_BORE:g}",
        "bore_zone_seen": f"Eq 33 is within {GOOD:g} of the friction at the paper's smallest "
        f"velocity, at amplitudes above {TURNING_BORE:g}",
        "bore_zone_above_march": "Eq 33 lies above even the friction at the smallest velocity, an "
        f"upper bound of the limit, at amplitudes below {TURNING_BORE:g}",
        "bore_zone_printed": f"Eq 33 as printed, without the square, is within {GOOD:g} of the "
        f"static limit, at amplitudes above {TURNING_BORE:g}",
    },
    7: {
        "some_sticks": "at every phase a part of the contact sticks, larger than one cell",
        "alternates": f"when the sticking area is smallest, one side leads by {ALTERNATES:g} of "
        "this area, and the other side half a period later",
    },
    8: {
        "limit_positive": f"the static limit is above {VANISHES:g} (closed form)",
        "limit_positive_rings": f"the static limit is above {VANISHES:g} on rings, without a "
        "closed form",
        "limit_asymptote": f"from amplitude {FAR:g} on the static limit is within "
        f"{100 * RELATIVE:g} % of an asymptote that never vanishes",
    },
    9: {
        "rises_transverse": "transverse: friction rises from one velocity to the next",
        "rises_bore": "oscillating bore: friction rises from one velocity to the next",
        "rises_continuous_bore": "continuous bore: friction rises from one velocity to the next",
    },
    10: {
        "sine_near": f"Eq 37 is within {GOOD:g} of the computed friction",
        "sine_nearer": "Eq 37 is nearer to the computed friction than Eq 38",
        "sine_below": "Eq 37 lies below the computed friction",
    },
}
"""Criterion of each part, by the number of the statement and the name of the part."""
BESIDE = {
    *("rigid_below_squares", "slider_above_march", "zone_above", "force_steady", "steady_nears"),
    *("steady_near_below", "bore_zone_seen", "bore_zone_above_march", "bore_zone_printed"),
    *("limit_positive_rings", "sine_below"),
}
"""Parts that do not affect the verdict on their statement."""
