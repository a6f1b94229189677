"""A stored period on the whole disc and over the whole period, by its symmetries."""

import numpy as np

from microslip.sweeps import period_codec


def unpacked(result):
    """What `packed` kept, on the whole disc and over the whole period: a dict of arrays.

    The names and shapes are those of period.Period, without slip_forward, slip_lateral
    and area. traction_forward and traction_lateral are off by bound/254 at most.
    """
    angles, radius = result["angles"], np.array(result["radius"])
    found = {name: np.array(result[name]) for name in period_codec.HISTORIES}
    steps, slips = period_codec.unpacked_half(result)
    shares = steps / period_codec.SHARES
    # half a period later: theta to pi - theta, lateral tractions negated
    shares = np.concatenate([shares, shares[1:, :, ::-1] * np.array([[[1]], [[-1]]])])
    slips = np.concatenate([slips, slips[1:, ::-1]])
    theta = (np.arange(angles)[:, None] + 0.5) * np.pi / angles
    forward, lateral = np.sin(theta) * radius, np.cos(theta) * radius
    bound = np.broadcast_to(result["bound"], forward.shape)
    turned = result["turned"]
    parts = {
        "forward_position": (forward, -forward),
        "lateral_position": (lateral, -lateral if turned else lateral),
        "bound": (bound, bound),
        "traction_forward": (shares[:, 0] * bound, shares[:, 0] * bound),
        "traction_lateral": (shares[:, 1] * bound, shares[:, 1] * (bound if turned else -bound)),
        "slips": (slips, slips),
    }
    for name, halves in parts.items():
        flat = [half.reshape(*half.shape[:-2], -1) for half in halves]
        found[name] = np.concatenate(flat, axis=-1)
    return found | {name: result[name] for name in ("mu_macro", "converged", "reason")}
