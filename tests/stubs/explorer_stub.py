"""A small configuration of the explorer, with points from formulas and a computed period."""

from stubs import sweep_stub
from stubs.sweep_stub import EFFORT

from microslip.datasets import netcdf, sweep_dataset
from microslip.report.explorer import explorer
from microslip.report.motions import MOTIONS
from microslip.sweeps import evaluate, request

RATIOS = [0, 0.3, 0.5]
BAD_POINT = 1, 3  # row and column of a point of transverse that did not converge
NO_PERIOD, BAD_PERIOD = ("transverse", "1.2", "1"), ("bore", "1.2", "0.02")
NOT = {"converged": False, "reason": "none to be found"}


def configured(**axes):
    """Maps with and without periods, lines, and several Poisson's ratios. axes: those of bore."""
    grid = {"velocity": [0, 0.02, 0.1, 1], "amplitude": [0, 0.6, 1.2], "tolerance": 1e-2}
    drive = {"velocity": 0.1, "amplitude": 1, "stiffness": [0.1, 1], "mass": [0.1, 1, 10]}
    sweeps = {
        "transverse": grid | {"poisson": RATIOS},
        "bore": grid | axes,
        "continuous_bore": {"velocity": {"log": [0.1, 10, 5]}},
        "along": grid | {"motion": "longitudinal", "title": "to and fro"},
        "still": {"motion": "bore", "velocity": [0, 0.001], "amplitude": [0, 0.5, 1]},
        "drift": {"motion": "transverse", "force": [0.2, 0.4, 0.8], "amplitude": [0.5, 1]},
        "body": {"motion": "transverse"} | drive,
    }
    page = {"kind": "explorer", "sweep": list(MOTIONS)}
    return sweep_stub.configured(sweeps, figures={"explorer": page})


def period_requests(configuration, name):
    """Requests of the periods of a map."""
    maps = explorer.maps_of(configuration, configuration.figures["explorer"])
    return explorer.period_requests(configuration, *maps, name=name)


def made_up(folder):
    """Datasets of the configuration and periods, each by name. A map has one period for all points,
    except for one point without a period and one with an unconverged period."""
    configuration = configured()
    datasets = {name: _dataset(folder, configuration, name) for name in configuration.sweeps}
    periods = {}
    for name in MOTIONS:
        requests = period_requests(configuration, name)
        one = evaluate.computed(requests[len(requests) // 2])
        results = {NO_PERIOD: NOT, BAD_PERIOD: one | NOT}
        places = [(name, request["amplitude"], request["velocity"]) for request in requests]
        periods[name] = [
            {"request": request, "result": results.get(place, one)}
            for request, place in zip(requests, places, strict=True)
        ]
    return datasets, periods


def _dataset(folder, configuration, name):
    """A sweep with mu_macro = 1 / (3 + k) at point k, whose velocity is k, written and read."""
    result = EFFORT | {"mu_macro_error": 1e-4, "velocity_error": 1e-5, "converged": True}
    result |= {f"error_{part}": 1 / 7 for part in ("resolution", "periodicity", "solver")}
    result |= {"mu_torque": 0.5, "mu_torque_error": 1e-4, "model": "polar"}
    result |= {"dissipated_energy": 0.25, "dissipated_energy_error": 1e-3}
    grid = configuration.sweeps[name]
    points = [
        {"result": result | {"mu_macro": 1 / (3 + k), "velocity": float(k)}, "versions": {}}
        for k in range(len(request.points_of(grid).requests))
    ]
    if name == "transverse":
        bad = points[BAD_POINT[0] * len(grid.velocity) + BAD_POINT[1]]
        bad["result"] |= {"converged": False, "reason": "made up"}
    path = folder / f"{name}.nc"
    netcdf.write(path, *sweep_dataset.build(configuration, name, points))
    return netcdf.whole(path)
