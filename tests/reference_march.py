"""The time integrator as plain as it can be written: what every compiled march is tested against.

A contact of K points under given pressure has tractions q, shape (2, K), forward part first, which
displace its surface by A q, A being a matrix (2 K, 2 K).  The indenter moves by w(t), shape (2, K).
What a point slips is what the indenter has moved and the surface has not followed, so that

    d slip = dw - A dq,    |q| <= g,    a point slips only where |q| = g, and along q.

Over a step of length h the rates are replaced by those at its end (backward Euler), or at two
stages, the first at gamma = 1 - sqrt(1/2) of the step and the second at its end (SDIRK2).  Either
way every stage asks for q and its slip r with

    A q + r = b,    |q| <= g,    r only where |q| = g, and along q,

which is the minimum of 1/2 <q, A q> - <b, q> over the discs |q| <= g.  Nothing here is fast, and
nothing is taken from the package: no guess, no factor, no derivative, no search for the periodic
state but to march until it repeats itself.
"""

from functools import lru_cache
from itertools import pairwise

import numpy as np

GAMMA = 1.0 - np.sqrt(0.5)


def projected(q, bound):
    """Projection of tractions on the disc |q| <= bound, point by point."""
    return q * np.minimum(1.0, bound / np.maximum(np.hypot(*q), 1e-300))


@lru_cache
def norm(content, size):
    """Norm of a matrix from its bytes, computed once for all stages."""
    return np.linalg.norm(np.frombuffer(content).reshape(size, size), 2)


def solved_stage(matrix, b, bound, start):
    """Tractions of a stage, by projected gradients with Nesterov's acceleration.

    With the step 1 / norm, at most 1 / (largest eigenvalue), the energy decreases. After an
    increase the momentum is reset.
    """
    length = 1.0 / norm(matrix.tobytes(), len(matrix))
    q, ahead, momentum = start, start, 1.0
    for count in range(200_000):
        slip = (b.ravel() - matrix @ ahead.ravel()).reshape(b.shape)
        proposal = projected(ahead + length * slip, bound)
        if np.sum((proposal - q) * (ahead - proposal)) > 0.0:
            momentum = 1.0
        following = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * momentum**2))
        ahead = proposal + (momentum - 1.0) / following * (proposal - q)
        change, q, momentum = np.abs(proposal - q).max(), proposal, following
        if change < 1e-15 and count > 50:
            return q
    raise AssertionError("the reference did not converge")


def march(matrix, bound, displacement, phases, q, stages=2):
    """Tractions at every phase, shape (len(phases), 2, ...), from those at the first phase.

    displacement(phase): w, in the shape of q. stages: 1 for backward Euler, 2 for SDIRK2.
    """

    def elastic(q):
        return (matrix @ q.ravel()).reshape(q.shape)

    result = [q]
    for start, end in pairwise(phases):
        before = elastic(q) - displacement(start)  # minus the slip so far
        carried = 0.0
        if stages == 2:
            b = before + displacement(start + GAMMA * (end - start))
            q = solved_stage(matrix, b, bound, q)
            carried = (1.0 - GAMMA) / GAMMA * (b - elastic(q))
        q = solved_stage(matrix, before + displacement(end) - carried, bound, q)
        result.append(q)
    return np.array(result)
