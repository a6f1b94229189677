"""Rows of a fit, with or without errors, at two amplitudes."""

import numpy as np
import xarray as xr

FINE = 50
"""Number of points of each model curve."""


def fitted(rows=12, errors=True):
    """Friction that increases with speed, with residuals of up to two standard errors."""
    speed = np.tile(np.geomspace(1e-3, 0.3, rows // 2), 2)
    amplitude = np.repeat([3e-7, 6e-7], rows // 2)
    force = 3.0 * speed / (speed + 1e4 * amplitude)
    residual = 2.0 * np.cos(3.0 * np.arange(rows))
    result = {
        "speed_m_s": speed,
        "amplitude_si": amplitude,
        "row_load_N": np.full(rows, 10.0),
        "frequency_Hz": np.full(rows, 2e4),
        "measured": force + 0.05 * residual,
        "measured_error": np.full(rows, 0.05 if errors else np.nan),
        "fitted": force,
        "fitted_error": np.full(rows, 3e-3),
        "residual": residual,
    }
    fine = np.tile(np.geomspace(1e-3, 0.3, FINE), 2)
    size = np.repeat([3e-7, 6e-7], FINE)
    curve = {
        "speed_m_s": fine,
        "amplitude_si": size,
        "row_load_N": np.full(2 * FINE, 10.0),
        "frequency_Hz": np.full(2 * FINE, 2e4),
        "fitted": 3.0 * fine / (fine + 1e4 * size),
        "fitted_error": np.full(2 * FINE, 3e-3),
    }
    numbers = {"mu": 0.3, "mu_low": 0.29, "mu_high": 0.31}
    numbers |= {"u_lim_m": 3e-7, "u_lim_low_m": 2.8e-7, "u_lim_high_m": 3.3e-7}
    variables = {name: ("row", values) for name, values in result.items()} | numbers
    variables |= {f"curve_{name}": ("curve_point", values) for name, values in curve.items()}
    return xr.Dataset(variables, attrs={"motion": "transverse", "quantity": "friction"})
