"""Small datasets for figures, from closed forms, with all variables that the figures need."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.text import Text
from stubs import certified_stub, claims_stub, studies_stub

from microslip.config.kinds import KINDS
from microslip.datasets import sweep_dataset
from microslip.datasets.catalogue import DRIFT_FORMS, FORMS
from microslip.report.figures import drawing
from microslip.sweeps import request
from microslip.theory import paper

VELOCITY = "v0 / (omega u_lim)"
PLANE = ("amplitude", "velocity")
VELOCITIES, FORCES = np.geomspace(1e-3, 10, 9), np.linspace(0.1, 0.9, 9)


def sweep(values, name="mu_macro", error=8e-4, attrs=(), **axes) -> xr.Dataset:
    """A sweep in which all points converged. axes: coordinates in the order of the dimensions."""
    columns = {name: values, f"{name}_error": np.full(values.shape, error)}
    columns["converged"] = np.ones(values.shape, np.int8)
    variables = {key: (tuple(axes), one) for key, one in columns.items()}
    return xr.Dataset(variables, axes | {"poisson": 0.0}, dict(attrs))


def with_forms(motion, amplitude, velocity, exact, large, **forms) -> xr.Dataset:
    """A sweep between the exact static limit and a limit for large amplitudes."""
    limit = exact[:, None]
    axes = {"amplitude": amplitude, "velocity": velocity}
    dataset = sweep(limit + (1 - limit) * large, attrs={"motion": motion}, **axes)
    large = (PLANE[2 - large.ndim :], large)
    forms = {f"mu_static{name}": ("amplitude", values) for name, values in forms.items()}
    return dataset.assign(mu_large_amplitude=large, **forms, mu_static=("amplitude", exact))


def fake_transverse(n: int = 9) -> xr.Dataset:
    """A transverse sweep, with the history of a slider."""
    amplitude, velocity = np.linspace(0, 3, n), np.geomspace(1e-3, 10, n)
    phase = np.linspace(0, 8 * np.pi, 401)
    path, force = 0.2 * phase + 1j * np.sin(phase), np.ones(phase.size, complex)
    for i in range(1, phase.size):  # a single elastic slider
        force[i] = force[i - 1] + path[i] - path[i - 1]
        force[i] /= max(1.0, abs(force[i]))
    large = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    forms = {"_slider": paper.static_slider(amplitude)}
    forms["_stick_zone"] = paper.static_transverse(amplitude)
    exact = paper.static_limit_transverse(amplitude)
    return with_forms("transverse", amplitude, velocity, exact, large, **forms).assign(
        history_phase=("history_step", phase, {"units": "rad"}),
        history_force_forward=("history_step", force.real),
        history_force_lateral=("history_step", force.imag),
        history_velocity=0.2,
        history_poisson=0.0,
        history_amplitude=1.0,
    )


def fake_bore(n: int = 9) -> xr.Dataset:
    """A bore sweep."""
    amplitude, velocity = np.linspace(0, 5, n), np.geomspace(1e-3, 10, n)
    forms = {"_stick_zone": paper.static_bore(amplitude)}
    forms["_stick_zone_printed"] = paper.static_bore_printed(amplitude)
    exact, large = paper.static_limit_bore(amplitude), paper.large_amplitude_bore(velocity)
    return with_forms("bore", amplitude, velocity, exact, large, **forms)


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
    step, mu = ("start", "transient_step"), force + 1e-3 * (-1.0) ** np.arange(n)
    dataset = sweep(mu, attrs={"motion": "continuous-bore"}, velocity=velocity)
    return dataset.assign_coords(start=["stress-free", "full-rotation", "full-slip"]).assign(
        mu_torque=("velocity", torque),
        mu_torque_error=("velocity", np.full(n, 1e-3)),
        mu_forward_theory=("velocity", force),
        mu_torque_theory=("velocity", torque),
        field_lateral_position=("cell", x),
        field_forward_position=("cell", y),
        field_traction_lateral=("cell", bound * y / away),
        field_traction_forward=("cell", -bound * (x + 0.8) / away),
        field_bound=("cell", bound),
        field_velocity=0.8,
        field_poisson=0.0,
        field_centre_lateral=-0.8,
        transient_displacement=(step, np.tile(travel, (3, 1))),
        transient_force_forward=(step, gone[0]),
        transient_torque=(step, gone[1]),
        transient_velocity=0.8,
        transient_poisson=0.0,
        transient_force_theory=end[0],
        transient_torque_theory=end[1],
    )


def at_ratios(dataset, *ratios):
    """A dataset with a dimension poisson; each ratio adds a tenth of itself to mu_macro."""
    dataset = dataset.drop_vars("poisson")
    parts = [dataset.assign(mu_macro=dataset.mu_macro + 0.1 * nu) for nu in ratios]
    both = xr.concat(parts, xr.Variable("poisson", list(ratios)), data_vars=["mu_macro"])
    both["mu_macro_change"] = both.mu_macro - both.mu_macro.isel(poisson=0)
    return both.assign_attrs(tolerance=1e-3)


def spanning(title="", shift=0.0, formula="x0 / u_lim", size=(7, 9), low=1e-3) -> xr.Dataset:
    """A map that decreases from 1 to `shift`. size: numbers of amplitudes and velocities."""
    amplitude, velocity = np.linspace(0.2, 3, size[0]), np.geomspace(low, 10, size[1])
    mu = shift + (1 - shift) * paper.large_amplitude_transverse(velocity, amplitude[:, None])
    dataset = sweep(mu, attrs={"title": title}, amplitude=amplitude, velocity=velocity)
    return labelled(dataset, formula)


def holed(velocities: int = 7, amplitudes: int = 5) -> xr.Dataset:
    """A coarse map in which every second point along each axis has no value."""
    dataset = spanning("a motion", size=(amplitudes, velocities), low=1e-2)
    dataset["mu_macro"][1::2, 1::2] = np.nan
    return dataset.assign(converged=np.isfinite(dataset["mu_macro"]).astype(np.int8))


def static(title="", velocity=(0.0, 1e-3)) -> xr.Dataset:
    """Static friction against amplitude, and friction at a small velocity."""
    amplitude, velocity = np.linspace(0, 1.2, 7), np.array(velocity)
    mu = np.maximum(1 - amplitude[:, None], 0) + 10 * velocity * (amplitude[:, None] > 0)
    dataset = sweep(mu, attrs={"title": title}, amplitude=amplitude, velocity=velocity)
    return labelled(dataset, "y0 / u_lim")


def many_lines():
    """Friction against amplitude at six velocities and two Poisson's ratios."""
    return at_ratios(static("", np.geomspace(1e-3, 1e-2, 6)), 0.0, 0.3)


def built(configuration) -> xr.Dataset:
    """Dataset of the sweep "map" of a configuration. Under a force, half of the points are at
    rest."""
    sweep = configuration.sweeps["map"]
    if sweep.is_certified:
        return certified_stub.built(configuration, lambda one: certified_stub.record(one, 0.5))
    records = [certified_stub.record(one, 0.5) for one in request.points_of(sweep).requests]
    for k, record in enumerate(records):
        record["result"] |= {"velocity": k % 2, "velocity_error": 0.1}
    return sweep_dataset.build(configuration, "map", records)[0]


def labelled(dataset, formula):
    """A dataset with the formulas of its axes."""
    dataset["velocity"].attrs["formula"] = VELOCITY
    dataset["amplitude"].attrs["formula"] = formula
    return dataset


# Drives


def drift(motion):
    """Map of the velocity of a rigid contact under a force: 0 below the threshold."""
    amplitude, fine = np.linspace(0.25, 3.0, 6), np.linspace(0.25, 3.0, 50)
    rigid = DRIFT_FORMS[motion].function(*np.meshgrid(FORCES, amplitude))
    held, curve = (FORMS[motion]["mu_static"].function(one) for one in (amplitude, fine))
    speed = np.where(held[:, None] < FORCES, rigid, 0.0)
    texts = {"motion": motion, "title": motion}
    return sweep(speed, "velocity", attrs=texts, amplitude=amplitude, force=FORCES).assign(
        velocity_large_amplitude=(("amplitude", "force"), rigid),
        mu_static=("amplitude", held),
        mu_static_curve=("amplitude_curve", curve),
        amplitude_curve=fine,
    )


def pulled():
    """Datasets of the figure of drives: friction v / (1 + v), 0.1 less on the softest spring."""
    velocity, stiffness = np.geomspace(1e-3, 10, 7), np.array([0.1, 10.0])
    mu, one = velocity / (1 + velocity), {"amplitude": [1.0]}
    both = np.stack([mu - 0.1, mu])[:, None]
    springs = one | {"velocity": velocity}
    body = {"mass": [0.1, 1.0, 10.0], "stiffness": stiffness} | one | {"velocity": [0.1]}
    return {
        "transverse": sweep(mu[None], **springs),
        "drive_force": sweep(FORCES[None] / (1 - FORCES[None]), "velocity", **one, force=FORCES),
        "drive_spring": sweep(both, stiffness=stiffness, **springs),
        "drive_body": sweep(np.full((3, 2, 1, 1), 0.5), **body),
    }


# Commands


def predictions():
    """Invented predictions over a speed and a load, one of them not converged."""
    speed, load = np.array([0.001, 0.01, 0.1]), np.array([0.05, 0.1])
    mu = np.add.outer(0.01 * np.arange(2), 0.1 * np.arange(1, 4))
    force = mu * load[:, None]
    variables = {"mu_apparent": mu, "friction_force_N": force, "converged": mu != 0.2}
    variables |= {"mu_apparent_error": 0.01 * mu, "friction_force_error_N": 0.01 * force}
    for end, factor in (("low", 0.9), ("high", 1.2)):
        variables |= {f"mu_apparent_{end}": factor * mu, f"friction_force_{end}_N": factor * force}
    variables["force_N"] = np.full(mu.shape, np.nan)
    axes = {"load_N": (load, "N", "load"), "speed_m_s": (speed, "m/s", "speed")}
    return xr.Dataset(
        {name: (tuple(axes), values) for name, values in variables.items()},
        {n: (n, x, {"units": unit, "long_name": text}) for n, (x, unit, text) in axes.items()},
    )


def fitted():
    """Rows of a fit at two amplitudes: friction that increases with speed, with residuals of up to
    two standard errors."""

    def columns(count):
        speed = np.tile(np.geomspace(1e-3, 0.3, count), 2)
        amplitude = np.repeat([3e-7, 6e-7], count)
        names = {"speed_m_s": speed, "amplitude_si": amplitude}
        names |= {"row_load_N": np.full(2 * count, 10.0), "frequency_Hz": np.full(2 * count, 2e4)}
        names["fitted"] = 3.0 * speed / (speed + 1e4 * amplitude)
        return names | {"fitted_error": np.full(2 * count, 3e-3)}

    result, residual = columns(6), 2.0 * np.cos(3.0 * np.arange(12))
    result |= {"measured": result["fitted"] + 0.05 * residual, "residual": residual}
    result["measured_error"] = np.full(12, 0.05)
    numbers = {"mu": 0.3, "mu_low": 0.29, "mu_high": 0.31}
    numbers |= {"u_lim_m": 3e-7, "u_lim_low_m": 2.8e-7, "u_lim_high_m": 3.3e-7}
    variables = {name: ("row", values) for name, values in result.items()} | numbers
    curve = {f"curve_{name}": ("curve_point", values) for name, values in columns(50).items()}
    return xr.Dataset(variables | curve, attrs={"motion": "transverse", "quantity": "friction"})


# Studies

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
    methods = ["shipped", "projected-gradient", "euler", "midpoint", "full-newton"]
    configuration = studies_stub.configured(
        {"points": POINTS, "methods": METHODS}, {"axes": AXES, "methods": methods}
    )
    answers = {"accuracy": studies_stub.accuracy_result, "stability": studies_stub.stability_result}
    datasets = {one: studies_stub.dataset(configuration, one, answers[one]) for one in answers}
    claims = studies_stub.dataset(claims_stub.configured(), "claims", claims_stub.result)
    return datasets | {"claims": claims}


# Figures


def every_figure() -> dict[str, tuple[str, list]]:
    """Kind and datasets of every figure, by a name of the case."""
    paper = {"transverse": fake_transverse(12), "bore": fake_bore(12)}
    ratios = {name: at_ratios(dataset, 0.0, 0.5) for name, dataset in paper.items()}
    for dataset in ratios.values():
        labelled(dataset, "y0 / u_lim")
    few = fake_transverse(7)
    few["converged"][2, 2] = 0
    static_map = certified_stub.bore(velocity=[0], poisson=[0.1, 0.4])
    motions = [spanning(f"motion {k}") for k in range(12)]
    datasets = studies() | {"": fake_continuous_bore()}
    figures = {kind: (kind, [datasets[of.study]]) for kind, of in KINDS.items() if of.study}
    figures |= {kind: (kind, [datasets[""]]) for kind in ("field", "curves", "transients")}
    return figures | {
        "history": ("history", [paper["transverse"]]),
        "Figure 2": ("map", [paper["transverse"]]),
        "Figure 6": ("map", [paper["bore"]]),
        "two maps": ("map", list(paper.values())),
        "poisson": ("map", list(ratios.values())),
        "a map at two ratios": ("map", [ratios["bore"]]),
        "coarse": ("map", [at_ratios(few, 0.0, 0.2, 0.4)]),
        "coarse motion": ("map", [at_ratios(holed(), 0.0, 0.3)]),
        "coarse motions": ("map", [holed(), *motions[:2]]),
        "drift": ("map", [drift("transverse"), drift("bore")]),
        "drives": ("curves", list(pulled().values())),
        "fit": ("fit", [fitted()]),
        "predictions": ("curve", [predictions()]),
        "certified": ("map", [certified_stub.bore()]),
        "deep": ("map", [certified_stub.bore(poisson=[0.1, 0.4])]),
        "certified and not": ("map", [certified_stub.bore(), paper["bore"]]),
        "certified static": ("curves", [static_map]),
        **{f"{n} maps": ("map", motions[:n]) for n in (1, 5, 12)},
        "many lines": ("curves", [many_lines()]),
        "lines": ("curves", [static("a"), static("b")]),
    }


def draw(kind, *datasets):
    """A figure of datasets."""
    return drawing.draw(kind, dict(enumerate(datasets)))


def words(figure) -> str:
    """All texts of a figure."""
    return " ".join(text.get_text() for text in figure.findobj(Text))


def artists(where, gid: str) -> list:
    """Artists of a figure or a panel with an id."""
    return where.findobj(lambda artist: artist.get_gid() == gid)
