"""Points and fields on the whole disc, computed from the half disc of the polar model."""

from __future__ import annotations

import numpy as np

from microslip.contact.modes import PolarContact


def points_of(contact: PolarContact) -> list[np.ndarray]:
    """Forward and lateral positions, bounds and areas on the whole disc, shape (points,) each."""
    forward, lateral = contact.forward_position, contact.lateral_position
    if contact.whole:
        every = (np.broadcast_to(part, forward.shape) for part in (contact.bound, contact.weight))
        return [part.ravel() for part in (forward, lateral, *every)]
    other = lateral if contact.rotates else -lateral
    bound = np.broadcast_to(contact.bound, forward.shape)
    # the weight of a point on the half disc includes its mirror image
    area = np.broadcast_to(0.5 * contact.weight, forward.shape)
    parts = (forward, -forward), (lateral, other), (bound, bound), (area, area)
    return [np.concatenate([half.ravel() for half in part]) for part in parts]


def whole_disc(contact: PolarContact, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Forward and lateral components, shape (n, points), of a field (n, 2, M, N) on the whole disc.

    For a rotation, the other half is the mirror image across the lateral axis.  For a translation,
    it is the first half rotated by 180 degrees.
    """
    flat = field.reshape(len(field), 2, -1)
    if contact.whole:
        return flat[:, 0], flat[:, 1]
    other = flat * [[1.0], [-1.0]] if contact.rotates else flat
    both = np.concatenate([flat, other], axis=2)
    return both[:, 0], both[:, 1]
