"""The static limit of an oscillation that is not to and fro on a line, and of one of the load.

static_limit.py says why the limit is a problem of its own at every point.  On a line two instants
count; here the whole period does.  Let q(t) be the tractions that the oscillation alone settles
into, g(t) the friction bound.  A constant traction s may be added wherever it leaves |q + s| <= g
at all times, and where a point drifts forward s is the best there is:

    mu F_z mu_static = Integral { mean of q_forward
                                  + max s_forward : |q(t) + s| <= g(t) for all t } dA.

Where points slip in every period of the oscillation alone, no s but 0 is left, for q is on the
bound in directions that balance.  Their mean counts: a loop that is not its own image under a turn
by half a period drags the contact along.  Where points never slip, q is known up to a constant,
whatever the period began with, and the maximum makes up for it.
"""

from __future__ import annotations

import numpy as np

HALVINGS = 50
"""Halvings of the interval with the largest shift: enough to reach rounding."""


def largest_shift(tractions: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Forward component of the furthest s with |q + s| <= g at all phases.

    Where s = 0 fits, so does every smaller shift than the largest one: the discs |q + s| <= g are
    convex, and so is what they share.

    Parameters
    ----------
    tractions : np.ndarray, shape (phases, 2, ...)
        q, forward first.
    bounds : np.ndarray, shape (phases, ...) or broadcast to it
        g, where no q is beyond it by more than rounding.

    Returns
    -------
    np.ndarray, shape (...)
        At every point.
    """
    forward, lateral = tractions[:, 0], tractions[:, 1]
    bounds = np.maximum(bounds, np.hypot(forward, lateral))  # s = 0 does fit
    least, most = np.zeros(forward.shape[1:]), 2.0 * bounds.min(axis=0)
    for _ in range(HALVINGS):
        shift = 0.5 * (least + most)
        across = bounds**2 - (forward + shift) ** 2
        width = np.sqrt(np.maximum(across, 0.0))
        within = (across >= 0.0).all(axis=0)
        within &= (-lateral - width).max(axis=0) <= (width - lateral).min(axis=0)
        least, most = np.where(within, shift, least), np.where(within, most, shift)
    return least
