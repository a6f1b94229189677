"""The record of a pressure: what carries the load, and how much friction each point may take.

Working units, dimensionless: a = 1 (outer radius, or half the longer side of what bounds the
contact), mu F_z = 1 and u_lim = 1.  Here u_lim is the largest displacement that full slip of the
whole contact causes anywhere, by its mean compliance over the directions,

    u_lim = max of 1/(pi G*) Integral mu p(z') / |z - z'| dA',

which for every indenter pressed to a depth d is mu d E*/G*, the usual 3 mu F_z/(4 G* a) for a
sphere.  The contact of a round body slides everywhere from u_lim on, pushed in one direction from
rest, and so does any contact at nu = 0.  Others at nu > 0 do so some percent before or after, by
direction.
What these units leave of the stiffness is the number G*, 3/4 for a sphere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Pressure:
    """One distribution of the load over the contact; dimensionless, in the working units above.

    Attributes
    ----------
    name, summary : str
        As it is asked for, and in a line.
    G_star : float
        Reduced shear modulus 4G/(2 - nu).
    torque : float
        Of a contact that slips everywhere about its centre, in mu F_z a.
    largest : float
        Largest friction bound, or infinity; largest pressure over F_z / a^2.
    cell_loads : callable
        cell_loads(cells): load on each of cells x cells squares over [-1, 1]^2, forward axis first,
        sum 1.
    mirrored : bool
        Whether it is its own image under lateral -> -lateral.
    ring_means : callable or None
        ring_means(psi) -> (bound, lever): mean friction bound of the rings between r = sin(psi),
        and mean lever arm of a traction shaped like it, shape (n,) each, from (n + 1,).  This and
        the next two: of contacts whose pressure depends on the radius alone.
    bound : callable or None
        bound(r): friction bound mu p, of arrays; of an indenter bound(r, c), too.
    inner : float
        Radius of the hole in the middle.
    depth : callable or None
        depth(c): indentation that makes the contact radius c, other than 1 if the load is not the
        mean one.  This and the next four: of axisymmetric indenters, which touch a full circle and
        whose contact grows with the load.
    radius : callable or None
        radius(depth): its inverse, 0 for no contact.
    of_load : callable or None
        of_load(share): the depth at which the load is that share of the mean one.
    load : callable or None
        load(r, c): load within r; of arrays that broadcast.
    loading : callable or None
        loading(u): tangential force over mu F_z after a displacement u_lim >= 0 in one direction
        from rest, nu = 0, of any shape; also of elliptic Hertz contacts.
    hertzian : bool
        Whether it is that of an elliptic Hertz contact, whose stick zones are ellipses of the same
        shape (Vermeulen and Johnson), so that it shares `loading` with the sphere.
    readings : tuple of Pressure
        Of a pressure that is known on a grid alone, others that the same numbers may stand for; how
        far friction differs under them is what the grid leaves open.
    """

    name: str
    summary: str
    G_star: float
    torque: float
    largest: float
    cell_loads: Callable
    mirrored: bool = True
    ring_means: Callable | None = None
    bound: Callable | None = None
    inner: float = 0.0
    depth: Callable | None = None
    radius: Callable | None = None
    of_load: Callable | None = None
    load: Callable | None = None
    loading: Callable | None = None
    hertzian: bool = False
    readings: tuple[Pressure, ...] = ()

    @property
    def is_round(self) -> bool:
        """Whether it depends on the radius alone."""
        return self.ring_means is not None

    @property
    def is_indenter(self) -> bool:
        """Whether it is that of an axisymmetric indenter."""
        return self.depth is not None

    @property
    def stiffness(self) -> float:
        """Force over mu F_z per uniform displacement u_lim without slip, 2 G* a; of a contact that
        does not fill the circle of radius a an upper bound."""
        return 2.0 * self.G_star

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load of an indenter at a depth >= 0, any shape."""
        radius = self.radius(depth)
        return self.load(radius, radius)

    def stick_radius(self, displacement: float) -> float | None:
        """Stick radius after a displacement (u_lim) in one direction from rest: that of the contact
        whose indentation is less by this share (Ciavarella, Jaeger); None if it is not known, and
        0.0 where all slides.  displacement >= 0: a float."""
        if self.depth is None:
            return None
        if displacement >= 1.0:
            return 0.0
        return float(self.radius(1.0 - displacement))


def of_radii(
    ring_loads: Callable, ring_moments: Callable, psi: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """ring_means from loads and first moments of the bound between the radii r = sin(psi)."""
    loads, moments = ring_loads(psi), ring_moments(psi)
    area = np.pi * np.diff(np.sin(psi) ** 2)
    radii = np.sin(psi)
    # a ring without load has a lever arm all the same
    lever = np.where(loads > 0.0, moments / np.where(loads > 0.0, loads, 1.0), radii[1:])
    return loads / area, lever
