"""Small datasets for figures, from closed forms, with all variables that the figures need."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.text import Text
from stubs import claims_stub, drives_stub, studies_stub

from microslip.studies import registry
from microslip.theory import paper

VELOCITY = "v0 / (omega u_lim)"


def fake_transverse(n: int = 9) -> xr.Dataset:
    """A transverse sweep: between the exact static limit and Eq 6, with a slider's history."""
    amplitude, velocity = np.linspace(0, 3, n), np.geomspace(1e-3, 10, n)
    large = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    exact = paper.static_limit_transverse(amplitude)
    phase = np.linspace(0, 8 * np.pi, 401)
    path, force = 0.2 * phase + 1j * np.sin(phase), np.ones(phase.size, complex)
    for i in range(1, phase.size):  # a single elastic slider
        force[i] = force[i - 1] + path[i] - path[i - 1]
        force[i] /= max(1.0, abs(force[i]))
    both, one = ("amplitude", "velocity"), ("amplitude",)
    return xr.Dataset(
        {
            **fake_map(exact[:, None] + (1 - exact[:, None]) * large),
            "mu_large_amplitude": (both, large),
            "mu_static_slider": (one, paper.static_slider(amplitude)),
            "mu_static_stick_zone": (one, paper.static_transverse(amplitude)),
            "mu_static": (one, exact),
            "history_phase": ("history_step", phase, {"units": "rad"}),
            "history_force_forward": ("history_step", force.real),
            "history_force_lateral": ("history_step", force.imag),
            "history_velocity": 0.2,
            "history_amplitude": 1.0,
        },
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"motion": "transverse", "tolerance": 1e-3},
    )


def fake_bore(n: int = 9) -> xr.Dataset:
    """A bore sweep between the exact static limit and Eq 29."""
    amplitude, velocity = np.linspace(0, 5, n), np.geomspace(1e-3, 10, n)
    large, exact = paper.large_amplitude_bore(velocity), paper.static_limit_bore(amplitude)
    return xr.Dataset(
        {
            **fake_map(exact[:, None] + (1 - exact[:, None]) * large),
            "mu_large_amplitude": (("velocity",), large),
            "mu_static_stick_zone": (("amplitude",), paper.static_bore(amplitude)),
            "mu_static_stick_zone_printed": (("amplitude",), paper.static_bore_printed(amplitude)),
            "mu_static": (("amplitude",), exact),
        },
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"motion": "bore"},
    )


def fake_map(mu: np.ndarray) -> dict:
    """Variables mu_macro, mu_macro_error and converged, with all points converged."""
    both = ("amplitude", "velocity")
    return {
        "mu_macro": (both, mu),
        "mu_macro_error": (both, np.full_like(mu, 8e-4)),
        "converged": (both, np.ones(mu.shape, np.int8)),
    }


def fake_continuous_bore(n: int = 9, rings: int = 8) -> xr.Dataset:
    """A steady bore (Eqs 15, 21 and 22), and transients that decay to it."""
    velocity = np.geomspace(0.1, 10, n)
    force, torque = paper.bore_forward(velocity), paper.bore_torque(velocity)
    end = paper.bore_forward(0.8), paper.bore_torque(0.8)
    r = np.sin((np.arange(rings) + 0.5) / rings * np.pi / 2)
    turn = (np.arange(3 * rings) + 0.5) * 2 * np.pi / (3 * rings)
    x, y = (np.outer(r, f(turn)).ravel() for f in (np.cos, np.sin))
    bound = 1.5 / np.pi * np.sqrt(1 - x**2 - y**2)
    away = np.hypot(y, x + 0.8)
    travel = np.linspace(0, 3, 61)
    first = np.array([[0, 0], [0, 1], [1, 0]])
    gone = [f + (first[:, [i]] - f) * np.exp(-3 * travel) for i, f in enumerate(end)]
    step = ("start", "transient_step")
    return xr.Dataset(
        {
            "mu_macro": ("velocity", force + 1e-3 * (-1.0) ** np.arange(n)),
            "mu_torque": ("velocity", torque),
            "mu_macro_error": ("velocity", np.full(n, 1e-3)),
            "mu_torque_error": ("velocity", np.full(n, 1e-3)),
            "converged": ("velocity", np.ones(n, np.int8)),
            "mu_forward_theory": ("velocity", force),
            "mu_torque_theory": ("velocity", torque),
            "field_lateral_position": ("cell", x),
            "field_forward_position": ("cell", y),
            "field_traction_lateral": ("cell", bound * y / away),
            "field_traction_forward": ("cell", -bound * (x + 0.8) / away),
            "field_bound": ("cell", bound),
            "field_velocity": 0.8,
            "field_centre_lateral": -0.8,
            "transient_displacement": (step, np.tile(travel, (3, 1))),
            "transient_force_forward": (step, gone[0]),
            "transient_torque": (step, gone[1]),
            "transient_velocity": 0.8,
            "transient_force_theory": end[0],
            "transient_torque_theory": end[1],
        },
        coords={
            "velocity": velocity,
            "poisson": 0.0,
            "start": ["stress-free", "full-rotation", "full-slip"],
        },
        attrs={"motion": "continuous-bore"},
    )


def at_ratios(dataset, *ratios):
    """A dataset with a dimension poisson; each ratio adds a tenth of itself to mu_macro."""
    dataset = dataset.drop_vars("poisson")
    parts = [dataset.assign(mu_macro=dataset.mu_macro + 0.1 * nu) for nu in ratios]
    both = xr.concat(parts, xr.Variable("poisson", list(ratios)), data_vars=["mu_macro"])
    both["mu_macro_change"] = both.mu_macro - both.mu_macro.isel(poisson=0)
    return both.assign_attrs(tolerance=1e-3)


def spanning(title="", shift=0.0, amplitude_label="x0 / u_lim", group="motions") -> xr.Dataset:
    """A map that decreases from 1 to `shift`."""
    amplitude, velocity = np.linspace(0, 2, 7), np.geomspace(1e-3, 10, 9)
    mu = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    return labelled(
        xr.Dataset(
            fake_map(shift + (1 - shift) * mu),
            coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
            attrs={"title": title, "group": group},
        ),
        amplitude_label,
    )


def holed(velocities: int = 7, amplitudes: int = 5) -> xr.Dataset:
    """A coarse map in which every second point along each axis has no value."""
    velocity, amplitude = np.geomspace(1e-2, 3, velocities), np.linspace(0.2, 3, amplitudes)
    mu = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    mu[1::2, 1::2] = np.nan
    coords = {"amplitude": amplitude, "velocity": velocity, "poisson": 0.0}
    dataset = xr.Dataset(fake_map(mu), coords, {"title": "a motion", "group": "motions"})
    dataset["converged"] = np.isfinite(dataset["mu_macro"]).astype(np.int8)
    return labelled(dataset, "x0 / u_lim")


def static(title="", velocity=(0.0, 1e-3), power=1.0, **more) -> xr.Dataset:
    """Static friction against amplitude, and friction at a small velocity."""
    amplitude, velocity = np.linspace(0, 1.2, 7), np.array(velocity)
    mu = np.maximum(1 - amplitude[:, None], 0) ** power + 10 * velocity * (amplitude[:, None] > 0)
    dataset = xr.Dataset(
        fake_map(mu) | more,
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"title": title, "group": "static"},
    )
    return labelled(dataset, "y0 / u_lim")


def labelled(dataset, amplitude_label):
    dataset["velocity"].attrs["formula"] = VELOCITY
    if "amplitude" in dataset:
        dataset["amplitude"].attrs["formula"] = amplitude_label
    return dataset


def motions(count=3):
    return {f"m{i}": spanning(f"motion {i}") for i in range(count)}


POINTS = {
    "mid": {"motion": "transverse", "velocity": 0.1, "amplitude": 0.5, "title": "half way"},
    "large": {"motion": "transverse", "velocity": 0.1, "amplitude": 2, "title": "a title " * 6},
    "bore": {"motion": "bore", "velocity": 0.2, "amplitude": 1},
    "steady": {"motion": "continuous-bore", "velocity": 0.8},
}
METHODS = ["shipped", "euler", "paper", "full-newton", "midpoint", "march"]
BORE = {"motion": "bore", "velocity": 0.1, "amplitude": 1}
AXES = studies_stub.STABILITY["axes"] | {
    "slow-bore": BORE | {"velocity": [0.001, 0.01, 0.1]},
    "critical-amplitude": BORE | {"amplitude": [0.9, 1, 1.1], "title": "around the critical one"},
    "rotation-centre": BORE | {"velocity": [0.5, 1, 2], "amplitude": 5},
}


def studies() -> dict[str, xr.Dataset]:
    """Datasets of all studies."""
    stability = {
        "axes": AXES,
        "methods": ["shipped", "projected-gradient", "euler", "midpoint", "full-newton"],
    }
    configuration = studies_stub.configured({"points": POINTS, "methods": METHODS}, stability)
    answers = {"accuracy": studies_stub.accuracy_result, "stability": studies_stub.stability_result}
    accuracy, stability = (
        registry.undivided(configuration, study, studies_stub.answered(result)[0])
        for study, result in answers.items()
    )
    answer, configured = claims_stub.answered()[0], claims_stub.configured()
    return {
        "accuracy": accuracy,
        "stability": stability,
        "claims": registry.undivided(configured, "claims", answer),
    }


def pulled() -> dict[str, xr.Dataset]:
    """Datasets of the figures of drives."""
    maps = {f"drift_{motion}": drives_stub.drift(motion) for motion in ("transverse", "bore")}
    return maps | drives_stub.pulled()


def words(figure) -> str:
    """All texts of a figure."""
    return " ".join(text.get_text() for text in figure.findobj(Text))


def artists(where, gid: str) -> list:
    """Artists of a figure or a panel with an id."""
    return where.findobj(lambda artist: artist.get_gid() == gid)
