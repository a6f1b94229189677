"""The elastic single slider: one friction element behind an isotropic spring (Benad et al. 2019).

Its spring yields at u_lim, as the contact as a whole does, so the dimensionless groups coincide.
It knows no partial slip: above the static limit it is a good and very cheap model, near it Eq 7
shows what it misses.
"""

from __future__ import annotations

import numpy as np

from microslip.models.rings.contact import RadialContact


def slider_contact() -> RadialContact:
    """The slider as a contact of one point: unit friction bound, unit compliance."""
    return RadialContact(np.ones((1, 1)), np.ones(1), np.ones(1))
