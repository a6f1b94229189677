"""Oscillation along two directions at once: lines, ellipses, figures of more cycles (Lissajous).

    elliptic:forward=F,lateral=L,phase=P,forward_cycles=M,lateral_cycles=N

moves by forward v~ t + A F sin(M t + P), lateral A L sin(N t): P in degrees, A the amplitude, in
u_lim.  The defaults are a circle; F = 0 is the transverse motion, L = 0 the longitudinal one.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.mirror_image import reverses_forward
from microslip.motions.motion import HALF_PERIOD, LOOP, Motion, stick_focus

SUMMARY = "sliding forward while oscillating along two directions"
HELP = (
    "such as forward=0.5,phase=30: shares of A, forward and lateral (1), phase of forward in "
    "degrees (90), forward_cycles and lateral_cycles (1)"
)
DEFAULTS = {
    "forward": 1.0,
    "lateral": 1.0,
    "phase": 90.0,
    "forward_cycles": 1.0,
    "lateral_cycles": 1.0,
}
MOST_CYCLES = 20
WHOLE_PERIOD = (*HALF_PERIOD, 1.5 * np.pi)


def motion(
    name: str,
    forward: float,
    lateral: float,
    phase: float,
    forward_cycles: float,
    lateral_cycles: float,
) -> Motion:
    """The Motion of these numbers; raises InputError for shares below 0, none at all, and cycles
    that are no whole numbers."""
    spec.refuse_shares(name, "motion", {"forward": forward, "lateral": lateral})
    if max(forward, lateral) == 0.0:
        raise InputError("motion", name, "allowed is forward or lateral above 0")
    cycles = {"forward_cycles": forward_cycles, "lateral_cycles": lateral_cycles}
    spec.refuse_counts(name, "motion", cycles, MOST_CYCLES)
    lead = np.deg2rad(phase % 360.0)

    def displacement(phase, velocity, amplitude, poisson):
        along = velocity * phase + amplitude * forward * np.sin(forward_cycles * phase + lead)
        across = amplitude * lateral * np.sin(lateral_cycles * phase)
        return along, across, np.zeros_like(phase)

    ahead, aside, _ = displacement(LOOP, 0.0, 1.0, 0.0)
    reach = float(np.hypot(ahead, aside).max())
    mirrored = lateral_cycles % 2 == 1 and (forward == 0.0 or forward_cycles % 2 == 0)
    simple = forward_cycles == lateral_cycles == 1.0
    return Motion(
        name=name,
        summary=SUMMARY,
        displacement=displacement,
        periodic=True,
        rotates=False,
        half_period_mirror=mirrored,
        focus=lambda velocity, amplitude, pressure: stick_focus(amplitude * reach, pressure),
        velocity_label="v0 / (omega u_lim)",
        amplitude_label="A / u_lim",
        turns=lambda velocity, amplitude: HALF_PERIOD if mirrored else WHOLE_PERIOD,
        straight=simple and (forward == 0.0 or lead % np.pi == 0.0),
        propels=forward > 0.0
        and lateral > 0.0
        and not reverses_forward(forward=int(forward_cycles), lateral=int(lateral_cycles)),
        cycles=int(max(forward_cycles if forward else 1.0, lateral_cycles if lateral else 1.0)),
    )
