"""The statements of the paper in plain words, and the criteria of their parts.

The runs behind each comparison are in `parts`.
"""

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
