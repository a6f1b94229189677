"""The body that a contact hangs on, as plain as it can be written: the reference of pulled marches.

A body at x ahead of the contact's given motion w(t) obeys m x'' + c x' + k x + f = load, f the
forward force of the contact.  Every stage of length g is an implicit step of it,

    K x + f = F,    K = k + c / g + m / g^2,    F = load + (c / g) X + m (X / g^2 + Y / g),

with X and Y what earlier stages make of x and x'.  Where K > 0 nothing new is to be solved: the
body is a spring of stiffness K in series, so that all points give way by f / K more than they did,
which is a matrix of rank one.  A force alone (K = 0) is found by bisection over x, in which f does
not fall.
"""

from itertools import pairwise

import numpy as np
from reference_march import GAMMA, solved_stage
from scipy.optimize import brentq


def forward_force(weight, q):
    return float(np.sum(weight * q[0]))


def solved_pulled_stage(matrix, weight, b, bound, q, stiffness, load):
    """Tractions of a stage, and the position x."""
    ahead = np.zeros_like(b)
    ahead[0] = 1.0
    if stiffness > 0.0:
        weights = np.zeros_like(b)
        weights[0] = weight
        compliant = matrix + np.outer(ahead.ravel(), weights.ravel()) / stiffness
        q = solved_stage(compliant, b + ahead * (load / stiffness), bound, q)
        return q, (load - forward_force(weight, q)) / stiffness

    def left(x):
        return forward_force(weight, solved_stage(matrix, b + ahead * x, bound, q)) - load

    x = brentq(left, -5.0, 5.0, xtol=1e-13)
    return solved_stage(matrix, b + ahead * x, bound, q), x


def pulled_march(contact, displacement, phases, q, body, start, stages=2):
    """Tractions and x at every phase, from those at the first phase.

    contact: matrix, weight and bound. body: k, c, m and load. start: x and x'. Without mass and
    damping, x follows from the force on the spring.
    """
    matrix, weight, bound = contact
    k, c, m, load = body
    x, rate = start
    if m == c == 0.0:
        x = (load - forward_force(weight, q)) / k if k > 0.0 else 0.0
    ahead = np.zeros_like(q)
    ahead[0] = 1.0

    def elastic(q):
        return (matrix @ q.ravel()).reshape(q.shape)

    result, places = [q], [x]
    for begin, end in pairwise(phases):
        g = (GAMMA if stages == 2 else 1.0) * (end - begin)
        stiffness = k + c / g + m / g**2
        times = [begin + GAMMA * (end - begin), end] if stages == 2 else [end]
        before = elastic(q) - displacement(begin) - ahead * x
        past_x, past_rate, carried = x, rate, 0.0
        for time in times:
            pushed = load + c / g * past_x + m * (past_x / g**2 + past_rate / g)
            b = before + displacement(time) - carried
            q, now = solved_pulled_stage(matrix, weight, b, bound, q, stiffness, pushed)
            share = (1.0 - GAMMA) / GAMMA
            carried = share * (b + ahead * now - elastic(q))
            speed = (now - past_x) / g
            past_x, past_rate = x + share * (now - past_x), rate + share * (speed - past_rate)
        x, rate = now, speed
        result.append(q)
        places.append(x)
    return np.array(result), np.array(places)
