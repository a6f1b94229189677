"""Names, symbols and descriptions of quantities in datasets, figures and pages.

All quantities are dimensionless.  Their definitions are ratios in plain text with the names of
Greek letters, such as "v0 / (omega u_lim)".
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """Names and symbols of a quantity.

    Attributes
    ----------
    name : str
        Name of the coordinate or the variable in a dataset.
    text : str
        Label of an axis.
    unit : str
        Definition as a ratio, in plain text.  An empty text means that the symbol is the ratio.
        report.figures.formulas converts the definition to other notations.
    symbol, latex : str
        Symbol in plain text and in LaTeX.
    description : str
        Description in datasets.
    """

    name: str
    text: str
    unit: str
    symbol: str
    latex: str
    description: str = ""

    @property
    def math(self) -> str:
        """Symbol in mathtext."""
        return f"${self.latex}$"


MU_MACRO = Quantity(
    *("mu_macro", "friction ratio", "", "mu~macro", r"\tilde{\mu}_\mathrm{macro}"),
    "mean forward force divided by mu F_z",
)
FORCE_FORWARD = Quantity(
    "force_forward", "forward force", "", "F_forward/(mu F_z)", r"F_\mathrm{forward}/(\mu F_z)"
)
FORCE_LATERAL = Quantity(
    "force_lateral", "lateral force", "", "F_lateral/(mu F_z)", r"F_\mathrm{lateral}/(\mu F_z)"
)
TORQUE = Quantity(
    *("mu_torque", "torque", "", "M_z/M_z,0", r"M_z/M_{z,0}"),
    "torque about the normal divided by its value at zero forward velocity",
)
LATERAL = Quantity(
    "lateral_position", "lateral position", "", "r_lateral/a", r"r_\mathrm{lateral}/a"
)
FORWARD = Quantity(
    "forward_position", "forward position", "", "r_forward/a", r"r_\mathrm{forward}/a"
)

VELOCITY = {
    "transverse": Quantity(
        *("velocity", "forward velocity", "v0 / (omega u_lim)", "v~0", r"\tilde{v}_0"),
        "forward velocity divided by angular frequency and u_lim (Eq 4)",
    ),
    "bore": Quantity(
        *("velocity", "forward velocity", "v0 / (Omega phi0 a)", "v~", r"\tilde{v}"),
        "forward velocity divided by the largest rotational velocity of the contact's edge (Eq 28)",
    ),
    "continuous-bore": Quantity(
        *("velocity", "forward velocity", "v0 / (omega a)", "v~", r"\tilde{v}"),
        "forward velocity divided by the rotational velocity of the contact's edge (Eq 13)",
    ),
}
"""Velocity for each motion of the paper."""
AMPLITUDE = {
    "transverse": Quantity(
        *("amplitude", "amplitude", "y0 / u_lim", "y~0", r"\tilde{y}_0"),
        "amplitude of the transverse oscillation divided by u_lim (Eq 2)",
    ),
    "bore": Quantity(
        *("amplitude", "amplitude", "phi0 / phi_lk(a/2)", "phi~0", r"\tilde{\varphi}_0"),
        "amplitude of the rotation divided by the one that leaves the stick radius a/2 (Eq 27)",
    ),
}
"""Amplitude for each motion of the paper.  The steady motion has none."""

DRIVES = {
    "force": Quantity(
        *("force", "force", "P / (mu F_z)", "P~", r"\tilde{P}"),
        "prescribed force divided by mu times the mean normal load",
    ),
    "stiffness": Quantity(
        *("stiffness", "stiffness", "k u_lim / (mu F_z)", "k~", r"\tilde{k}"),
        "stiffness of the spring divided by mu F_z / u_lim",
    ),
    "mass": Quantity(
        *("mass", "mass", "m omega^2 u_lim / (mu F_z)", "m~", r"\tilde{m}"),
        "mass of the body divided by mu F_z / (u_lim omega^2)",
    ),
    "damping": Quantity(
        *("damping", "damping", "c omega u_lim / (mu F_z)", "c~", r"\tilde{c}"),
        "damping of the dashpot divided by mu F_z / (u_lim omega)",
    ),
}
"""Parameters of the drive of a contact."""
