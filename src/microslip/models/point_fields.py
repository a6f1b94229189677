"""What a field of points shares, whatever grid it sits on: rigid displacement and forces.

Points are stored row by row; rows are angles or squares along the forward axis, and the weight of a
point depends on its column alone.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel


@kernel
def rigid_displacement(motion: np.ndarray, positions: tuple, out: np.ndarray) -> None:
    """Fill out, (2, rows, columns), for motion = (forward, lateral, angle); positions: (forward,
    lateral), (rows, columns) each."""
    forward_position, lateral_position = positions
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            out[0, j, i] = motion[0] + motion[2] * lateral_position[j, i]
            out[1, j, i] = motion[1] - motion[2] * forward_position[j, i]


@kernel
def sum_forces(q: np.ndarray, weight: np.ndarray, positions: tuple, out: np.ndarray) -> None:
    """Fill out with forward force, lateral force and torque of tractions q, (2, rows, columns);
    weight: area of the points of each column, (columns,)."""
    forward_position, lateral_position = positions
    out[:] = 0.0
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward, lateral = weight[i] * q[0, j, i], weight[i] * q[1, j, i]
            out[0] += forward
            out[1] += lateral
            out[2] += lateral_position[j, i] * forward - forward_position[j, i] * lateral


@kernel
def copy(out: np.ndarray, values: np.ndarray) -> None:
    """out[:] = values for shape (2, rows, columns), which takes a second less to compile."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] = values[c, j, i]


@kernel
def add(out: np.ndarray, factor: float, values: np.ndarray) -> None:
    """out += factor values for shape (2, rows, columns); see copy."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] += factor * values[c, j, i]


@kernel
def move_forward(out: np.ndarray, place: float) -> None:
    """Add a forward displacement to shape (2, rows, columns), in place."""
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            out[0, j, i] += place
