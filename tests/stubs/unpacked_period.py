"""A stored period, extended by its symmetries to the whole disc and the whole period."""

import base64
import math

import numpy as np

from microslip.sweeps import period_codec


def values_of(text, kind):
    """Decode a string from `period_codec.text_of` to a flat array."""
    return np.frombuffer(base64.b64decode(text), np.dtype(kind).newbyteorder("<"))


def unpacked(result):
    """Arrays of a record of `packed`, for the whole disc and the whole period, by name.

    The names and shapes are those of period.Period, without slip_forward, slip_lateral and area.
    `densities` is dissipated_energy_density divided by its largest value.
    The error of traction_forward and traction_lateral is at most bound/254.
    """
    angles, radius = result["angles"], np.array(result["radius"])
    answer = {name: np.array(result[name]) for name in period_codec.HISTORIES}
    frames = (len(result["phase"]) + 1) // 2
    shape = frames, angles, len(radius)
    steps = values_of(result["tractions"], np.int8)
    shares = steps.reshape(frames, 2, *shape[1:]) / period_codec.SHARES
    bits = values_of(result["slips"], np.uint8)
    slips = np.unpackbits(bits, count=math.prod(shape)).astype(bool).reshape(shape)
    # half a period later: theta to pi - theta, lateral tractions negated
    shares = np.concatenate([shares, shares[1:, :, ::-1] * np.array([[[1]], [[-1]]])])
    slips = np.concatenate([slips, slips[1:, ::-1]])
    theta = (np.arange(angles)[:, None] + 0.5) * np.pi / angles
    forward, lateral = np.sin(theta) * radius, np.cos(theta) * radius
    bound = np.broadcast_to(result["bound"], forward.shape)
    density = values_of(result["densities"], np.uint16) / period_codec.DENSITIES
    turned = result["turned"]
    parts = {
        "forward_position": (forward, -forward),
        "lateral_position": (lateral, -lateral if turned else lateral),
        "bound": (bound, bound),
        "traction_forward": (shares[:, 0] * bound, shares[:, 0] * bound),
        "traction_lateral": (shares[:, 1] * bound, shares[:, 1] * (bound if turned else -bound)),
        "slips": (slips, slips),
        "densities": (density.reshape(forward.shape),) * 2,
    }
    for name, halves in parts.items():
        flat = [half.reshape(*half.shape[:-2], -1) for half in halves]
        answer[name] = np.concatenate(flat, axis=-1)
    return answer | {name: result[name] for name in ("mu_macro", "converged", "reason")}
