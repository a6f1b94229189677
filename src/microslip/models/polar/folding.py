"""Tractions folded into parts that are even and odd under the mirrors of a disc.

The mirror theta -> pi - theta maps the points of half a disc onto themselves: the parts that are
even and odd under it, on the first M/2 angles, are *folded* tractions.

Tractions on a whole disc are the sum of two parts: one that the mirror across the lateral axis
leaves as it is, and one that it turns round.  With forward and lateral exchanged, the second is of
the first kind, under an operator whose coupling at nu > 0 has the other sign; so it has sectors of
its own behind those of the first, and folded tractions are twice as many.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel


@kernel
def fold(x: np.ndarray, out: np.ndarray) -> None:
    """Even and odd parts (4, M/2, N) of tractions (2, M, N), or (8, M/2, N) of (2, 2 M, N)."""
    last = x.shape[1] - 1
    if out.shape[0] == 8:
        _fold_disc(x, out)
        return
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            out[0, j, i] = 0.5 * (x[0, j, i] + x[0, last - j, i])
            out[1, j, i] = 0.5 * (x[1, j, i] - x[1, last - j, i])
            out[2, j, i] = 0.5 * (x[0, j, i] - x[0, last - j, i])
            out[3, j, i] = 0.5 * (x[1, j, i] + x[1, last - j, i])


@kernel
def unfold(x: np.ndarray, out: np.ndarray) -> None:
    """Tractions (2, M, N), or of a whole disc (2, 2 M, N), from their folded parts."""
    last = out.shape[1] - 1
    if x.shape[0] == 8:
        _unfold_disc(x, out)
        return
    for j in range(x.shape[1]):
        for i in range(x.shape[2]):
            out[0, j, i] = x[0, j, i] + x[2, j, i]
            out[0, last - j, i] = x[0, j, i] - x[2, j, i]
            out[1, j, i] = x[3, j, i] + x[1, j, i]
            out[1, last - j, i] = x[3, j, i] - x[1, j, i]


@kernel
def _fold_disc(x, out):
    """As fold, of a whole disc: what the mirror leaves in the first four parts, the rest, with
    forward and lateral exchanged, in the others."""
    half, last = x.shape[1] // 2 - 1, x.shape[1] - 1
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            # a point, its mirror image across the lateral axis, and both on the other side
            forward, lateral = x[0, j, i], x[1, j, i]
            below, aside = x[0, last - j, i], x[1, last - j, i]
            other, across = x[0, half - j, i], x[1, half - j, i]
            opposite, far = x[0, last - half + j, i], x[1, last - half + j, i]
            out[0, j, i] = 0.25 * ((forward + below) + (other + opposite))
            out[1, j, i] = 0.25 * ((lateral - aside) - (across - far))
            out[2, j, i] = 0.25 * ((forward + below) - (other + opposite))
            out[3, j, i] = 0.25 * ((lateral - aside) + (across - far))
            out[4, j, i] = 0.25 * ((lateral + aside) + (across + far))
            out[5, j, i] = 0.25 * ((other - opposite) - (forward - below))
            out[6, j, i] = 0.25 * ((lateral + aside) - (across + far))
            out[7, j, i] = -0.25 * ((forward - below) + (other - opposite))


@kernel
def _unfold_disc(x, out):
    """As unfold, of a whole disc."""
    half, last = out.shape[1] // 2 - 1, out.shape[1] - 1
    for j in range(x.shape[1]):
        for i in range(x.shape[2]):
            kept, turned = x[0, j, i] + x[2, j, i], x[5, j, i] + x[7, j, i]
            out[0, j, i], out[0, last - j, i] = kept - turned, kept + turned
            kept, turned = x[0, j, i] - x[2, j, i], x[7, j, i] - x[5, j, i]
            out[0, half - j, i], out[0, last - half + j, i] = kept - turned, kept + turned
            kept, turned = x[3, j, i] + x[1, j, i], x[4, j, i] + x[6, j, i]
            out[1, j, i], out[1, last - j, i] = turned + kept, turned - kept
            kept, turned = x[3, j, i] - x[1, j, i], x[4, j, i] - x[6, j, i]
            out[1, half - j, i], out[1, last - half + j, i] = turned + kept, turned - kept
