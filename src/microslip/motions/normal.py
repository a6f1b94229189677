"""Oscillation of the normal load or of the indentation, alone or with one in the plane.

    normal:load=1,indentation=0,lateral=L,forward=F,angle=B,phase=P,normal_cycles=K,...

With the amplitude A the normal load is 1 + A load sin(K t) of its mean, or the indentation
1 + A indentation sin(K t) of its mean, whichever is above 0; contact is lost where that falls to 0.
In the plane the sphere moves forward by v~ t + A F sin(M t + P), sideways by A L sin(N t + P), in
u_lim, and turns by the bore amplitude A B, angle ~ sin(Q t + P): P in degrees.  Reference of u_lim,
a and mu F_z is the state without oscillation, and friction is over mu times the mean of the load as
it is.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.elliptic import MOST_CYCLES
from microslip.motions.mirror_image import reverses_forward
from microslip.motions.motion import Motion, within_rings
from microslip.theory import hertz, oscillating_load

SUMMARY = "sliding forward while the normal load oscillates, or the indentation"
HELP = (
    "such as lateral=1,phase=90: shares of A, load (1, over the mean) or indentation (0: the load "
    "oscillates), lateral and forward (0, over u_lim), angle (0, over phi_lk(a/2)), phase of these "
    "in degrees (0), normal_cycles, lateral_cycles, forward_cycles and angle_cycles (1)"
)
DEFAULTS = {
    "load": 1.0,
    "indentation": 0.0,
    "lateral": 0.0,
    "forward": 0.0,
    "angle": 0.0,
    "phase": 0.0,
    "normal_cycles": 1.0,
    "lateral_cycles": 1.0,
    "forward_cycles": 1.0,
    "angle_cycles": 1.0,
}


def motion(
    name: str,
    *,
    load: float,
    indentation: float,
    lateral: float,
    forward: float,
    angle: float,
    phase: float,
    normal_cycles: float,
    lateral_cycles: float,
    forward_cycles: float,
    angle_cycles: float,
) -> Motion:
    """The Motion of these numbers; raises InputError for shares out of 0..1, where neither or both
    of load and indentation oscillate, and for cycles that are no whole numbers."""
    cycles = {
        "normal_cycles": normal_cycles,
        "lateral_cycles": lateral_cycles,
        "forward_cycles": forward_cycles,
        "angle_cycles": angle_cycles,
    }
    in_plane = {"lateral": lateral, "forward": forward, "angle": angle}
    shares = {"load": load, "indentation": indentation} | in_plane
    _check(name, shares, cycles)
    by_load = indentation == 0.0
    share = load if by_load else indentation
    lead = np.deg2rad(phase % 360.0)

    def displacement(phase, velocity, amplitude, poisson):
        along = velocity * phase + amplitude * forward * np.sin(forward_cycles * phase + lead)
        across = amplitude * lateral * np.sin(lateral_cycles * phase + lead)
        turn = np.sin(angle_cycles * phase + lead)
        return along, across, hertz.bore_angle(amplitude * angle, poisson) * turn

    def depth(phase, amplitude, pressure):
        height = np.maximum(1.0 + amplitude * share * np.sin(normal_cycles * phase), 0.0)
        return pressure.of_load(height) if by_load else height

    def extreme(sign, amplitude, pressure):
        height = max(1.0 + sign * amplitude * share, 0.0)
        return float(pressure.of_load(height)) if by_load else height

    def focus(velocity, amplitude, pressure):
        """The edge of what never loses contact."""
        least = pressure.radius(extreme(-1.0, amplitude, pressure))
        return within_rings(least / pressure.radius(extreme(1.0, amplitude, pressure)))

    def turns(velocity, amplitude):
        least = -0.5 * np.pi / normal_cycles
        return tuple(least + np.pi * np.arange(2 if mirrored else 3))

    def closed_form_of(velocity, amplitude, pressure):
        if not pressure.is_indenter:
            return None
        place = (velocity / normal_cycles, amplitude * share, by_load, pressure)
        return oscillating_load.friction(*place)

    aside_odd = lateral == 0.0 or lateral_cycles % 2 == 1
    turns_odd = angle == 0.0 or angle_cycles % 2 == 1
    ahead_even = forward == 0.0 or forward_cycles % 2 == 0
    mirrored = normal_cycles % 2 == 0 and aside_odd and turns_odd and ahead_even
    reverses = reverses_forward(
        forward=int(forward_cycles),
        lateral=int(lateral_cycles) if lateral else 0,
        angle=int(angle_cycles) if angle else 0,
        load=int(normal_cycles),
    )
    alone = lateral == forward == angle == 0.0
    return Motion(
        name=name,
        summary=SUMMARY,
        displacement=displacement,
        periodic=True,
        rotates=angle > 0.0,
        half_disc=angle == 0.0 or lateral == 0.0,
        half_period_mirror=mirrored,
        focus=focus,
        velocity_label="v0 / (omega u_lim)",
        amplitude_label="A",
        turns=turns,
        straight=alone,
        propels=forward > 0.0 and not reverses,
        cycles=int(
            max(
                normal_cycles,
                lateral_cycles if lateral else 1.0,
                forward_cycles if forward else 1.0,
                angle_cycles if angle else 1.0,
            )
        ),
        depth=depth,
        deepest=lambda amplitude, pressure: extreme(1.0, amplitude, pressure),
        mean_load=lambda amplitude, pressure: oscillating_load.mean_load(
            amplitude * share, by_load, pressure
        ),
        closed_form_of=closed_form_of if alone else None,
    )


def _check(name, shares, cycles):
    spec.refuse_shares(name, "motion", shares)
    if shares["load"] == shares["indentation"] == 0.0:
        raise InputError("motion", name, "allowed is load or indentation above 0")
    if shares["indentation"] > 0.0 and shares["load"] != DEFAULTS["load"]:
        raise InputError(
            "motion", name, f"load = {shares['load']:g}: allowed is no load beside an indentation"
        )
    spec.refuse_counts(name, "motion", cycles, MOST_CYCLES)
