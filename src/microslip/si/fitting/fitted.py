"""The result of a fit."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from microslip.si.fitting.curves import Curve
from microslip.si.fitting.fit_text import fit_text
from microslip.si.prediction import column_unit

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False, kw_only=True)
class Fit:
    """Coefficient of friction and u_lim of a contact, from measured friction.

    An interval includes the scatter of the rows at a confidence level.  It also includes the
    model's error estimate, which is not random.

    Attributes
    ----------
    motion : str
        The motion.
    quantity : str
        Measured quantity: "friction", a force in N, or "mu", a coefficient.
    mu, mu_low, mu_high : float
        Coefficient of friction without vibration, dimensionless, and the ends of its interval.
    u_lim_m, u_lim_low_m, u_lim_high_m : float or None
        Displacement at which the whole contact slides under the mean load, m, and the ends of its
        interval.  A value is None if the rows do not determine it, and an end is None if it is
        infinite.
    shear_modulus_Pa, shear_modulus_low_Pa, shear_modulus_high_Pa : float or None
        Shear modulus of the bodies, Pa, and the ends of its interval; None in a fit without a
        radius.
    load_N : float
        The mean load, N.
    confidence : float
        Confidence level of the intervals, 0 to 1.
    mu_model_share, scale_model_share : float
        Largest relative changes in mu and in the second unknown (u_lim or the shear modulus) due to
        model errors.  The intervals include these changes.
    standard_error : float or None
        Standard error of one row, from the residuals of the fit, in the unit of the rows.  None for
        rows with standard errors.
    chi_square, p_value : float or None
        Weighted sum of squares, and the probability of a larger sum by chance.  None for rows
        without standard errors.
    degrees_of_freedom : int
        Number of rows minus 2.
    told : tuple of str
        Numbers that the rows determine: "mu", and "u_lim" or "shear_modulus".
    reason : str
        The reason why the rows do not determine both numbers; empty if they do.
    warnings : tuple of str
        Reasons to doubt the result.
    understood : dict of str
        Inputs as text.
    labels : dict of list
        Text columns of the table, by name.
    left_out : tuple of str
        Unreadable lines of the table, with the reasons.  The fit ignores these lines.
    speed_m_s, amplitude_si, frequency_Hz, row_load_N : np.ndarray, shape (rows,)
        Conditions of each row.  The amplitude is in m.
    velocity, amplitude : np.ndarray, shape (rows,)
        Dimensionless velocity and amplitude of each row at the best fit, as in microslip.solve.
    measured, measured_error : np.ndarray, shape (rows,)
        Measured values and standard errors, N or dimensionless; NaN for an unknown error.
    fitted, fitted_error : np.ndarray, shape (rows,)
        Values of the model and their error estimates, in the unit of the measured values.
    residual : np.ndarray, shape (rows,)
        Measured minus fitted values, divided by the standard error, dimensionless.
    curve : Curve
        Friction of the model between the rows, for figures.
    """

    motion: str
    quantity: str
    mu: float
    mu_low: float
    mu_high: float
    u_lim_m: float | None
    u_lim_low_m: float | None
    u_lim_high_m: float | None
    shear_modulus_Pa: float | None
    shear_modulus_low_Pa: float | None
    shear_modulus_high_Pa: float | None
    load_N: float
    confidence: float
    mu_model_share: float
    scale_model_share: float
    standard_error: float | None
    chi_square: float | None
    p_value: float | None
    degrees_of_freedom: int
    told: tuple
    reason: str
    warnings: tuple
    understood: dict = field(repr=False)
    labels: dict = field(repr=False)
    left_out: tuple
    speed_m_s: np.ndarray = field(repr=False)
    amplitude_si: np.ndarray = field(repr=False)
    frequency_Hz: np.ndarray = field(repr=False)
    row_load_N: np.ndarray = field(repr=False)
    velocity: np.ndarray = field(repr=False)
    amplitude: np.ndarray = field(repr=False)
    measured: np.ndarray = field(repr=False)
    measured_error: np.ndarray = field(repr=False)
    fitted: np.ndarray = field(repr=False)
    fitted_error: np.ndarray = field(repr=False)
    residual: np.ndarray = field(repr=False)
    curve: Curve = field(repr=False)

    def __str__(self) -> str:
        """The lines that `microslip fit` prints."""
        return fit_text(self)

    def to_dict(self) -> dict:
        """All fields except the curve as a dict.  Arrays and tuples become lists."""

        def plain(value: object) -> object:
            if isinstance(value, np.ndarray):
                return value.tolist()
            return list(value) if isinstance(value, tuple) else value

        return {name: plain(one) for name, one in vars(self).items() if name != "curve"}

    def to_xarray(self) -> xr.Dataset:
        """Convert the fit to a dataset.  Row data have the dimension `row`, numbers have no
        dimension, and texts are attributes.

        Variables `curve_NAME` along `curve_point` contain the curve.
        """
        import xarray as xr

        names = ("measured", "measured_error", "fitted", "fitted_error", "standard_error")
        units = dict.fromkeys(names, "N" if self.quantity == "friction" else "1")
        units["amplitude_si"] = "m"
        variables: dict[str, tuple] = {}
        attributes: dict[str, str] = {}

        def about(name: str) -> dict[str, str]:
            return {"units": units.get(name, column_unit(name))}

        for name, value in vars(self).items():
            if isinstance(value, Curve):
                for part, values in value._asdict().items():
                    variables[f"curve_{part}"] = ("curve_point", values, about(part))
            elif isinstance(value, np.ndarray):
                variables[name] = ("row", value, about(name))
            elif name == "labels":
                variables |= {label: ("row", texts) for label, texts in value.items()}
            elif isinstance(value, dict):
                attributes[name] = "; ".join(f"{key}: {text}" for key, text in value.items())
            elif isinstance(value, tuple):
                attributes[name] = "; ".join(value)
            elif isinstance(value, str):
                attributes[name] = value
            else:
                variables[name] = ((), np.nan if value is None else value, about(name))
        return xr.Dataset(variables, attrs=attributes)
