"""A Fit in words, as printed by `microslip fit` and print()."""

from __future__ import annotations

from typing import Any

from microslip.si.printed_lines import force_unit, in_unit, line, prefixed

TITLES = {"shear_modulus": "shear modulus"}
"""Printed names of fitted numbers, if they differ from those in Fit.told."""


def fit_text(result: Any) -> str:
    """The printed text of a Fit."""
    friction = result.quantity == "friction"
    name = "the friction force" if friction else "the coefficient of friction"
    load = in_unit(result.load_N, 0.0, force_unit(result.load_N))
    lines = [line(name.replace("_", " "), text) for name, text in result.understood.items()]
    lines += [line("rows", f"{len(result.measured)}, of {name}; mean load {load}"), ""]
    lines.append(line("mu", _interval(result.mu, result.mu_low, result.mu_high, "")))
    u_lim = result.u_lim_m, result.u_lim_low_m, result.u_lim_high_m
    modulus = result.shear_modulus_Pa, result.shear_modulus_low_Pa, result.shear_modulus_high_Pa
    for title, parts, unit in (("u_lim", u_lim, "m"), ("shear modulus", modulus, "Pa")):
        if parts[0] is not None:
            lines.append(line(title, _interval(*parts, unit)))
    shares = {result.told[-1]: result.scale_model_share, "mu": result.mu_model_share}
    model = ", ".join(
        f"of {TITLES.get(name, name)} {_digits(100.0 * shares[name], 2)} %" for name in result.told
    )
    share = f"{100.0 * result.confidence:g} %, plus the model error: {model}"
    lines.append(line("intervals", share))
    if result.standard_error is not None:
        scatter = _scaled(result.standard_error, "N" if friction else "")
        lines.append(line("scatter", f"{scatter} a row"))
    else:
        chance = "" if result.p_value is None else f", p = {result.p_value:.2g}"
        text = f"{result.chi_square:.3g} for {result.degrees_of_freedom} degrees of freedom{chance}"
        lines.append(line("chi square", text))
    if result.reason:
        lines.append(f"NOT DETERMINED: {result.reason}")
    return "\n".join(lines + [f"warning: {text}" for text in result.warnings])


def _interval(value: float | None, low: float | None, high: float | None, unit: str) -> str:
    return f"{_scaled(value, unit)}, from {_scaled(low, unit)} to {_scaled(high, unit)}"


def _scaled(value: float | None, unit: str) -> str:
    """Format a value with a suitable prefix of the unit."""
    name, size = prefixed(value, unit) if unit and value else (unit, 1.0)
    return f"{_digits((value or 0.0) / size, 4)} {name}".strip()


def _digits(value: float, count: int) -> str:
    """Format a number with `count` significant digits, including trailing zeros."""
    return f"{value:#.{count}g}".rstrip(".") if value else "0"
