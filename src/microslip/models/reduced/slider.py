"""The elastic single slider: one friction element behind an isotropic spring (Benad et al. 2019).

Like the whole contact, the element slides once the displacement exceeds u_lim, so the dimensionless
groups are the same.  The model has no partial slip.  It is accurate and cheap well above the static
limit; near this limit, its friction is that of Eq 7.
"""

from __future__ import annotations

import numpy as np

from microslip.models.rings.contact import RadialContact


def slider_contact() -> RadialContact:
    """Create a contact of one point with unit friction bound and unit compliance."""
    return RadialContact(np.ones((1, 1)), np.ones(1), np.ones(1))
