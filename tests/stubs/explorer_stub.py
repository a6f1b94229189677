"""Small maps with periods of their points, computed or from formulas, for tests of the explorer."""

import numpy as np
from stubs.sweep_stub import EFFORT

from microslip.config import load
from microslip.datasets import netcdf, sweep_dataset
from microslip.report.explorer import explorer
from microslip.sweeps import batches, evaluate

AXES = {"velocity": [0, 0.02, 0.1, 1], "amplitude": [0, 0.6, 1.2], "tolerance": 1e-2}
BAD_POINT = ("transverse", 1, 3)  # a map, and a point of it to mark as not converged
NO_PERIOD = ("transverse", 2, 3)
BAD_PERIOD = ("bore", 2, 1)


def configured(**axes):
    return load.from_mapping({"sweeps": dict.fromkeys(("transverse", "bore"), AXES | axes)})


def computed(folder, store):
    """Datasets and periods of both maps as made by the workflow, with one unconverged point.

    Returns (datasets, periods), each by the names of maps.
    """
    configuration = configured()
    datasets, periods = {}, {}
    for name, grid in configuration.sweeps.items():
        points = [batches.answer(request, store)[0] for request in batches.points_of(grid).requests]
        requests = explorer.period_requests(configuration, name)
        periods[name] = [batches.answer(request, store)[0] for request in requests]
        if name == BAD_POINT[0]:
            at = BAD_POINT[1] * len(grid.velocity) + BAD_POINT[2]
            points[at]["result"] |= {"converged": False, "reason": "made up"}
        for where, result in ((NO_PERIOD, {}), (BAD_PERIOD, None)):
            if name == where[0]:
                wanted = str(grid.amplitude[where[1]]), f"{grid.velocity[where[2]]:g}"
                (record,) = (r for r in periods[name] if place(r) == wanted)
                rows = record["result"] if result is None else {}
                record["result"] = rows | {"converged": False, "reason": "none to be found"}
        path = folder / f"{name}.nc"
        sweep_dataset.write_sweep(path, grid, points, [], configuration.of_sweep(name))
        datasets[name] = netcdf.whole(path)
    return datasets, periods


def place(record):
    return record["request"]["amplitude"], record["request"]["velocity"]


def made_up(folder, configuration):
    """Datasets of a whole configuration with points from formulas, and one period for all points.

    Without bores under other pressures, whose limits take a minute each.
    """
    datasets = {
        name: made_up_sweep(folder, configuration, name)
        for name, grid in configuration.grids.items()
        if grid.motion != "bore" or grid.pressure == "hertz"
    }
    periods = {}
    for name in explorer.maps_of(configuration):
        requests = explorer.period_requests(configuration, name)
        one = evaluate.computed(requests[len(requests) // 2])
        periods[name] = [{"request": request, "result": one} for request in requests]
    return datasets, periods


def made_up_sweep(folder, configuration, name):
    """Dataset of a sweep with mu_macro = 1 / (3 + k) at point k, whose velocity is k."""
    grid = configuration.grids[name]
    result = EFFORT | {"mu_macro_error": 1e-4, "velocity_error": 1e-5, "converged": True}
    result |= {f"error_{part}": 1 / 7 for part in ("resolution", "periodicity", "solver")}
    result |= {"mu_torque": 0.5, "mu_torque_error": 1e-4, "model": "polar"}
    points = [
        {"result": result | {"mu_macro": 1 / (3 + k), "velocity": float(k)}, "versions": {}}
        for k in range(len(batches.points_of(grid).requests))
    ]
    path = folder / f"{name}.nc"
    sweep_dataset.write_sweep(path, grid, points, [], configuration.of_sweep(name))
    return netcdf.whole(path)


def mean_over(phase, values):
    """Mean over a period of values at uneven phases."""
    return np.trapezoid(values, phase) / (phase[-1] - phase[0])
