"""A motion seen in a mirror across the forward direction: what moved forward moves back."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from microslip.motions.motion import Motion


@lru_cache(maxsize=64)
def mirror_image(motion: Motion) -> Motion:
    """The mirror image of a motion under forward -> -forward, with its velocity.

    At a velocity v its friction is that of the motion at -v with the other sign, provided that the
    pressure is its own image.  Lateral motion stays, a rotation changes its sense.
    """

    def displacement(phase, velocity, amplitude, poisson):
        forward, lateral, angle = motion.displacement(phase, -velocity, amplitude, poisson)
        return -forward, lateral, -angle

    return replace(
        motion,
        displacement=displacement,
        turns=lambda velocity, amplitude: motion.turns(-velocity, amplitude),
        focus=lambda velocity, amplitude, pressure: motion.focus(-velocity, amplitude, pressure),
        closed_form_of=None,
    )
