"""A period of the periodic state in few bytes, and back.

Half the disc and half the period are enough: the rest follows from symmetry. Tractions are kept as
shares of the friction bound in steps of 1/127, which is what a drawing can show; forces keep seven
decimals, and which points slip is exact.
"""

from __future__ import annotations

import base64
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import DTypeLike

if TYPE_CHECKING:
    from microslip.adaptive.period import Period

SHARES = 127
"""Steps of a traction from 0 to the friction bound; kept ones are off by half a step at most."""
DECIMALS = 7
"""Decimals of forces and displacements."""
HISTORIES = ("phase", "forward", "lateral", "angle", "force_forward", "force_lateral", "torque")


def packed(period: Period, angles: int) -> dict:
    """A period.Period as a dict of plain values and texts; angles: points on half a ring.

    The second half of the period has to be the mirror image of the first.

    radius, bound: of the rings, lists of (cells,); the names in HISTORIES: lists of (steps + 1,);
    tractions: base64 of int8, (steps/2 + 1, 2, angles, cells), forward and lateral, over bound/127;
    slips: base64 of bits, (steps/2 + 1, angles, cells); turned: whether the other half of the disc
    is this one turned by half a turn (translations), else it is the mirror image across the lateral
    axis; mu_macro, converged, reason as in the Period.
    """
    frames, half = (len(period.phase) + 1) // 2, period.bound.size // 2
    bound = period.bound[:half]
    both = np.stack([period.traction_forward, period.traction_lateral], axis=1)
    shares = np.clip(both[:frames, :, :half] / bound, -1.0, 1.0)
    slips = period.slips[:frames, :half]
    radius = np.hypot(period.forward_position, period.lateral_position)[:half]
    histories = {name: np.round(getattr(period, name), DECIMALS) for name in HISTORIES}
    return histories | {
        "radius": radius.reshape(angles, -1)[0],
        "bound": bound.reshape(angles, -1)[0],
        "tractions": text_of(np.round(SHARES * shares).astype(np.int8)),
        "slips": text_of(np.packbits(slips)),
        "angles": angles,
        "turned": bool(period.lateral_position[half] != period.lateral_position[0]),
        "mu_macro": period.mu_macro,
        "converged": period.converged,
        "reason": period.reason,
    }


def unpacked_half(result: dict) -> tuple[np.ndarray, np.ndarray]:
    """Tractions in steps of bound/127 (int8) and slips (bool) as kept: half the disc and period.

    Shapes (steps/2 + 1, 2, angles, cells), forward and lateral, and (steps/2 + 1, angles, cells).
    """
    frames = (len(result["phase"]) + 1) // 2
    shape = frames, result["angles"], len(result["radius"])
    shares = values_of(result["tractions"], np.int8).reshape(frames, 2, *shape[1:])
    bits = np.unpackbits(values_of(result["slips"], np.uint8), count=math.prod(shape))
    return shares, bits.astype(bool).reshape(shape)


def text_of(values: np.ndarray) -> str:
    """The bytes of an array as base64; little end first, whatever the machine."""
    ordered = np.ascontiguousarray(values)
    ordered = ordered.astype(ordered.dtype.newbyteorder("<"), copy=False)
    return base64.b64encode(ordered.tobytes()).decode("ascii")


def values_of(text: str, kind: DTypeLike) -> np.ndarray:
    """The array that `text_of` made a text of, flat; kind: its type."""
    return np.frombuffer(base64.b64decode(text), np.dtype(kind).newbyteorder("<"))
