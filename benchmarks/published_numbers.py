"""Compare microslip with published numbers and formulas.

    python benchmarks/published_numbers.py [--markdown FILE]

The published numbers and their sources are in docs/measured/published_numbers.json. The table has a
line for each comparison, with the largest difference that counts as agreement.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import contact_squares
import numpy as np
import tables
from scipy.optimize import brentq

import microslip
from microslip.theory import hertz

NUMBERS = json.loads(
    (Path(__file__).parents[1] / "docs/measured/published_numbers.json").read_text("utf-8")
)
GRID = 2e-3
"""Largest difference between CONTACT's elements and a refined mesh."""
SLIDERS = 2e-3
"""Largest error of tmdsimpy due to its finite number of sliders (100)."""
EXACT = 1e-4
"""Largest difference between exact formulas for a flat end and the solver."""
EXPONENTS = (50, 100)
"""Indenter exponents used to extrapolate to a flat end."""
AMPLITUDE = 0.6
"""Amplitude of the indentation for the sawtooth and square waveforms."""
ROWS = 80
"""Number of rows in a period of these waveforms."""


class Comparison(NamedTuple):
    """Comparison of a published value with a computed one. They agree if the difference is at most
    `allowed`. `error` is the error estimate of the computed value, or 0 if it has none."""

    what: str
    published: float
    computed: float
    allowed: float
    error: float = 0.0

    @property
    def agrees(self) -> bool:
        return abs(self.computed - self.published) <= self.allowed

    def row(self) -> dict:
        """Return the row of the table."""
        scale = max(abs(self.published), abs(self.computed))
        return {
            "quantity": self.what,
            "published": f"{self.published:.5g}",
            "microslip": f"{self.computed:.5g}",
            "difference": tables.number(
                self.computed - self.published, ".1e", error=self.error, scale=scale
            ),
            "allowed": tables.number(self.allowed, ".1e", scale=scale),
            "agrees": "yes" if self.agrees else "**no**",
        }


def half_digit(value: float, digits: int) -> float:
    """Return the largest rounding error of a number printed with `digits` significant digits."""
    return 0.5 * 10.0 ** (np.floor(np.log10(abs(value))) - digits + 1)


# CONTACT

QUOTIENT = 0.015
"""Largest relative error of a CONTACT stiffness. It is a difference quotient of the last iterations
in the search for the shift."""
LAST_DIGITS = {"stiffness_forward": 3, "stiffness_lateral": 3}
"""Number of printed digits of these quantities. All others are printed with four digits."""

CONTACT_CASES = """\
CONTACT: each cell contains the published value and that of `microslip`. Values in bold disagree.
The force and the work, divided by the friction force, are computed on a refined mesh. They may
differ by 0.002. A stiffness may differ by 1.5 %. All other values must agree to the last printed
digit."""


def contact_on_its_elements(case: dict) -> list[Comparison]:
    """Compare all printed numbers of a shift on CONTACT's elements, to their last digit."""
    computed = contact_squares.shifted(case)
    out = []
    for name, published in case["printed"].items():
        if name == "elements":
            kinds = ("in contact", "in adhesion", "in slip")
            for kind, one, other in zip(kinds, published, computed[name], strict=True):
                out.append(Comparison(f"elements {kind}", one, other, 0.0))
            continue
        allowed = half_digit(published, LAST_DIGITS.get(name, 4))
        if name.startswith("stiffness"):
            allowed += QUOTIENT * published
        out.append(Comparison(name.replace("_", " "), published, computed[name], allowed))
    return out


def contact_tractions() -> list[Comparison]:
    """Compare the tractions of the first case, and return the largest differences."""
    data = NUMBERS["CONTACT"]
    computed = contact_squares.shifted(data["cases"][0])
    published = np.array(data["tractions"]).T
    order = np.lexsort((np.round(computed["x"], 3), np.round(computed["y"], 3)))
    vector = computed["forward"][order] + 1j * computed["lateral"][order]
    fields = {
        "pressure (N/mm2)": computed["pressure"][order] - published[2],
        "traction (N/mm2)": np.abs(vector) - published[3],
        "direction (degrees)": np.degrees(np.angle(vector / np.exp(1j * np.radians(published[4])))),
        "slip (mm)": computed["slip"][order] - published[5],
    }
    out = []
    for column, (name, difference) in enumerate(fields.items(), start=2):
        if name.startswith("direction"):
            allowed = np.full(len(difference), 0.05)
        else:
            allowed = half_digit(np.where(published[column] == 0.0, 1e-7, published[column]), 3)
        worst = np.argmax(np.abs(difference) / allowed)
        at = published[column, worst]
        what = f"{name}, worst of 177 elements"
        out.append(Comparison(what, at, at + difference[worst], allowed[worst]))
    return out


def contact_refined(case: dict) -> list[Comparison]:
    """Compare force and work of a shift with `microslip.response`, on a refined mesh."""
    prescribed, printed = case["prescribed"], case["printed"]
    known = printed | prescribed
    modulus = case["shear_modulus"]
    radius = known.get("radius")
    if radius is None:  # Hertz
        cube = 3.0 * known["load"] * (1.0 - case["poisson"]) / (16.0 * modulus * case["curvature"])
        radius = (2.0 * cube) ** (1.0 / 3.0)
    limit = case["friction"] * known["load"]
    u_lim = 0.75 * limit * (2.0 - case["poisson"]) / (2.0 * modulus * radius)
    path = [0.0, known["shift"] / u_lim]
    answer = microslip.response(path, poisson=case["poisson"], tolerance=1e-3)
    work = printed["friction_work"] / (limit * u_lim * contact_squares.JOULE)
    force, dissipated = answer.force_forward[-1], answer.dissipated_energy[-1]
    return [
        Comparison("force / (friction x load)", known["force"], force, GRID),
        Comparison("work / (friction x load x u_lim)", work, dissipated, GRID),
    ]


def contact_page(cases: list[dict]) -> str:
    """Return a Markdown list of CONTACT's cases, and a table with a column for each case."""
    headings = [f"case {number}" for number in range(1, len(cases) + 1)]
    names, rows = [], {}
    for heading, case in zip(headings, cases, strict=True):
        names.append(f"- {heading}: {case['name']} ({case['file']})")
        for one in contact_on_its_elements(case) + contact_refined(case):
            pair = f"{one.published:.5g}, {one.computed:.5g}"
            columns = rows.setdefault(one.what, dict.fromkeys(headings, ""))
            columns[heading] = pair if one.agrees else f"**{pair}**"
    table = tables.markdown([{"quantity": what, **columns} for what, columns in rows.items()])
    listed = "\n".join(names)
    return f"{CONTACT_CASES}\n\n{listed}\n\n{table}\n\n"


# Closed forms

SMALL = 1e-3
"""Displacement in u_lim, or angle in u_lim / a, at which a stiffness is computed."""
STIFFNESS = 2e-3
"""Largest relative error of a stiffness, due to slip near the contact's edge."""
POISSON, LOOP = 0.3, 0.5
"""Poisson's ratio of the stiffness, and displacement amplitude of the loop in u_lim."""


def closed_forms() -> list[Comparison]:
    """Compare two stiffnesses without slip, and the energy of a loop, with closed forms."""
    path = np.array([0.0, SMALL])
    options = {"poisson": POISSON, "tolerance": 1e-5}
    translation = microslip.response(path, **options).force_forward[-1] / SMALL
    torque = microslip.response(0.0 * path, angle=path, **options).torque[-1]
    rotation = torque * 3.0 * np.pi / 16.0 / SMALL
    loop = np.array([0.0, LOOP, -LOOP, LOOP])
    energy = microslip.response(loop, tolerance=1e-4).dissipated_energy
    x = float(hertz.mindlin_force(LOOP))
    published = 4.8 * (1.0 - (1.0 - x) ** (5 / 3) - 5.0 * x / 6.0 * (1.0 + (1.0 - x) ** (2 / 3)))
    return [
        Comparison(
            f"stiffness 8 G a / (2 - nu), nu = {POISSON}, x u_lim / (mu F_z)",
            1.5,
            translation,
            1.5 * STIFFNESS,
        ),
        Comparison(
            f"torsional stiffness 16 G a^3 / 3, nu = {POISSON}, x u_lim / (mu F_z a^2)",
            2.0 - POISSON,
            rotation,
            (2.0 - POISSON) * STIFFNESS,
        ),
        Comparison(
            f"energy of a loop, amplitude {LOOP} u_lim, / (mu F_z u_lim)",
            published,
            energy[3] - energy[1],
            EXACT,
        ),
    ]


# tmdsimpy


def tmdsimpy_loop(name: str) -> tuple[np.ndarray, microslip.Response]:
    """Return a loop's published forces, divided by friction times first load, and the response."""
    data = NUMBERS["tmdsimpy"]
    loop = {key: np.array(column) for key, column in data["loops"][name].items()}
    nu, approach = data["poisson"], loop["approach_m"]
    u_lim = data["friction"] * approach[0] * (2.0 - nu) / (2.0 * (1.0 - nu))
    height = approach / approach[0]
    varying = {"indentation": height} if np.ptp(height) > 0.0 else {}
    answer = microslip.response(loop["displacement_m"] / u_lim, tolerance=5e-4, **varying)
    return loop["force_N"] / (data["friction"] * loop["load_N"][0]), answer


def tmdsimpy(name: str) -> Comparison:
    """Compare a loop at the row with the largest difference."""
    published, answer = tmdsimpy_loop(name)
    worst = np.argmax(np.abs(answer.force_forward - published))
    allowed = SLIDERS + answer.force_error[worst, 0]
    what = f"{name.replace('_', ' ')}: force / (friction x load), worst of {len(published)} rows"
    return Comparison(what, published[worst], answer.force_forward[worst], allowed)


# M. Popov (2020)

WAVEFORMS = {
    "right-leaning sawtooth (Eq 34)": [(0.0, -1.0), (1.0, 1.0), (1.0, -1.0)],
    "left-leaning sawtooth (Eq 35)": [(0.0, 1.0), (1.0, -1.0), (1.0, 1.0)],
    "square (Eq 36)": [(0.0, 1.0), (0.5, 1.0), (0.5, -1.0), (1.0, -1.0), (1.0, 1.0)],
}
"""Corners (time in periods, indentation) of the waveforms."""
REDUCTION = {
    "right-leaning sawtooth (Eq 34)": lambda beta: 1.0 - beta / 2.0,
    "left-leaning sawtooth (Eq 35)": lambda beta: 2.0 / (2.0 + beta),
    "square (Eq 36)": lambda beta: 1.0 - beta / 8.0 if beta < 4.0 else 2.0 / beta,
}
"""Reduction of the friction divided by the amplitude, as a function of the velocity divided by
amplitude and frequency."""


def popov_waveform(name: str, beta: float) -> Comparison:
    """Compare the mean friction of the second period, extrapolated to a flat end."""
    corners = np.array(WAVEFORMS[name])
    pieces = [
        np.linspace(start, end, max(round(ROWS * (end[0] - start[0])), 1), endpoint=False)
        for start, end in zip(corners[:-1], corners[1:], strict=True)
    ]
    time, wave = np.concatenate(pieces).T
    time = np.concatenate([time, 1.0 + time, [2.0]])
    height = 1.0 + AMPLITUDE * np.concatenate([wave, wave, corners[-1:, 1]])
    last = slice(len(wave), None)
    friction = []
    for exponent in EXPONENTS:
        answer = microslip.response(
            AMPLITUDE * beta * time,
            indentation=height,
            state="full-slip",
            pressure=f"power:exponent={exponent}",
        )
        load = height ** ((exponent + 1) / exponent)
        mean = np.trapezoid(answer.force_forward[last], time[last])
        friction.append(mean / np.trapezoid(load[last], time[last]))
    computed = 2.0 * friction[1] - friction[0]
    return Comparison(
        f"{name}, beta = {beta:g}", 1.0 - AMPLITUDE * REDUCTION[name](beta), computed, EXACT
    )


def popov_static() -> list[Comparison]:
    """Compare the static friction under an oscillating force (Eqs 4, 6 and 8)."""
    force = float(hertz.mindlin_force(AMPLITUDE))
    cases = {
        "load (Eq 4), sphere": (1.0 - AMPLITUDE, "normal", "auto"),
        "forward force (Eq 6), one slider": (1.0 - AMPLITUDE, "longitudinal", "slider"),
        "forward force (Eq 6), sphere": (1.0 - force, "longitudinal", "auto"),
        "lateral force (Eq 8), one slider": (np.sqrt(1.0 - AMPLITUDE**2), "transverse", "slider"),
        "lateral force (Eq 8), sphere": (np.sqrt(1.0 - force**2), "transverse", "auto"),
    }
    out = []
    for name, (published, motion, model) in cases.items():
        answer = microslip.solve(
            motion, velocity=0.0, amplitude=AMPLITUDE, model=model, tolerance=1e-5
        )
        computed = answer.mu_macro, EXACT, answer.mu_macro_error
        out.append(Comparison(f"static, {name}", published, *computed))
    return out


# Luo et al. (2024)

PERCENT = 0.01
"""Sum of the rounding errors of two reductions in whole percent: the fitted and the compared."""


def luo() -> tuple[float, list[Comparison]]:
    """Fit u_lim to one measured reduction and compare the others.

    Returns u_lim in m, and the comparisons.
    """
    data = NUMBERS["Luo"]
    stroke, omega = data["amplitude_m"], 2.0 * np.pi * data["frequency_Hz"]
    static, sliding = data["reduction"]

    def reduction(speed: float, u_lim: float) -> float:
        place = {"velocity": speed / (omega * u_lim), "amplitude": stroke / u_lim}
        return 1.0 - microslip.solve("longitudinal", **place).mu_macro

    def misfit(u_lim: float) -> float:
        return reduction(sliding["speed_m_s"], u_lim) - sliding["value"]

    u_lim = brentq(misfit, 0.5 * stroke, 3.0 * stroke, xtol=1e-4 * stroke)
    low, high = data["range"]["value"]
    values = [reduction(speed, u_lim) for speed in data["range"]["speeds_m_s"]]
    rigid = 1.0 - 2.0 / np.pi * np.arcsin(sliding["speed_m_s"] / (omega * stroke))
    at = f"{1e3 * sliding['speed_m_s']:g} mm/s"
    return u_lim, [
        Comparison("reduction at rest", static["value"], reduction(0.0, u_lim), PERCENT),
        Comparison("smallest reduction of five speeds", low, min(values), PERCENT),
        Comparison("largest reduction of five speeds", high, max(values), PERCENT),
        Comparison(f"reduction at {at}, rigid bodies", sliding["value"], rigid, PERCENT),
    ]


def main() -> None:
    """Compute all comparisons and print the tables."""
    options = tables.parser_of(__doc__).parse_args()
    sections = {"CONTACT: tractions of the first case": contact_tractions()}
    sections["Closed forms of Mindlin (1949, 1953), Deresiewicz (1953) and Lubkin (1951)"] = (
        closed_forms()
    )
    sections["tmdsimpy: loops of a Hertz asperity"] = [
        tmdsimpy(name) for name in NUMBERS["tmdsimpy"]["loops"]
    ]
    sections["M. Popov (2020): friction under oscillating forces and indentations"] = [
        *popov_static(),
        *(popov_waveform(name, 1.0) for name in WAVEFORMS),
        popov_waveform("square (Eq 36)", 6.0),
    ]
    u_lim, rows = luo()
    sections[f"Luo et al. (2024): one fitted parameter, u_lim = {1e6 * u_lim:.3f} um"] = rows
    text = contact_page(NUMBERS["CONTACT"]["cases"])
    for name, rows in sections.items():
        text += f"{name}\n\n{tables.markdown([row.row() for row in rows])}\n\n"
    tables.publish(text, options)


if __name__ == "__main__":
    main()
