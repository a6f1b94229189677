"""Compact storage of a period of the periodic state.

Only half the disc and half the period are stored; the rest follows from symmetry.  Tractions are
stored as multiples of 1/127 of the friction bound, which is sufficient for drawings.  The density
of the dissipated energy is stored in 65,535 steps, and forces with seven decimals.  Slip flags are
exact.
"""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from microslip.answer.period import Period

SHARES = 127
"""Number of steps between 0 and the friction bound in stored tractions."""
DENSITIES = 65535
"""Number of steps between 0 and the largest density of the dissipated energy."""
DECIMALS = 7
"""Number of decimals of stored forces and displacements."""
HISTORIES = ("phase", "forward", "lateral", "angle", "force_forward", "force_lateral", "torque")


def packed(period: Period, angles: int) -> dict:
    """Pack a period whose second half is the mirror image of its first half.

    Parameters
    ----------
    period : Period
        The period, with points on complete rings.
    angles : int
        Number of points on half a ring.

    Returns
    -------
    dict
        radius, bound: arrays of shape (cells,), with one value for each ring.

        The quantities in HISTORIES: arrays of shape (steps + 1,), with one value for each time.

        tractions: base64 of an int8 array of shape (steps/2 + 1, 2, angles, cells), in units of
        bound/127.  The second axis contains the forward and the lateral component.

        slips: base64 of the bits of an array of shape (steps/2 + 1, angles, cells).

        densities: base64 of a uint16 array of shape (angles, cells) with the density of the
        dissipated energy, scaled so that its largest value is 65535.

        turned: True if the other half of the disc is the stored half rotated by half a turn, as in
        translations.  False if the other half is the mirror image of the stored half across the
        lateral axis.

        mu_macro, converged, reason: values of the Period.
    """
    frames, half = (len(period.phase) + 1) // 2, period.bound.size // 2
    bound = period.bound[:half]
    both = np.stack([period.traction_forward, period.traction_lateral], axis=1)
    shares = np.clip(both[:frames, :, :half] / bound, -1.0, 1.0)
    slips = period.slips[:frames, :half]
    radius = np.hypot(period.forward_position, period.lateral_position)[:half]
    density = np.maximum(period.dissipated_energy_density[:half], 0.0)
    histories = {name: np.round(getattr(period, name), DECIMALS) for name in HISTORIES}
    return histories | {
        "radius": radius.reshape(angles, -1)[0],
        "bound": bound.reshape(angles, -1)[0],
        "tractions": text_of(np.round(SHARES * shares).astype(np.int8)),
        "slips": text_of(np.packbits(slips)),
        "densities": text_of(np.round(DENSITIES * density / density.max()).astype(np.uint16)),
        "angles": angles,
        "turned": bool(period.lateral_position[half] != period.lateral_position[0]),
        "mu_macro": period.mu_macro,
        "converged": period.converged,
        "reason": period.reason,
    }


def text_of(values: np.ndarray) -> str:
    """Encode an array as base64 of its little-endian bytes."""
    ordered = np.ascontiguousarray(values)
    ordered = ordered.astype(ordered.dtype.newbyteorder("<"), copy=False)
    return base64.b64encode(ordered.tobytes()).decode("ascii")
