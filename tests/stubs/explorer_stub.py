"""Small maps with periods of their points, computed or from formulas, for tests of the explorer."""

import numpy as np
from stubs import sweep_stub
from stubs.sweep_stub import EFFORT

from microslip.datasets import netcdf, sweep_dataset
from microslip.report.explorer import explorer
from microslip.sweeps import batch, evaluate, request

AXES = {"velocity": [0, 0.02, 0.1, 1], "amplitude": [0, 0.6, 1.2], "tolerance": 1e-2}
BAD_POINT = ("transverse", 1, 3)  # a map, and a point of it to mark as not converged
NO_PERIOD = ("transverse", 2, 3)
BAD_PERIOD = ("bore", 2, 1)


def configured(**axes):
    maps = dict.fromkeys(("transverse", "bore"), AXES | axes)
    page = {"kind": "explorer", "sweep": list(maps)}
    return sweep_stub.configured(maps, figures={"explorer": page})


def maps_of(configuration):
    """Names of the maps with periods of the page."""
    return explorer.maps_of(configuration, configuration.figures["explorer"])


def period_requests(configuration, name):
    """Requests of the periods of a map."""
    return explorer.period_requests(configuration, *maps_of(configuration), name=name)


def dataset(folder, configuration, name, records):
    """Dataset of a sweep, written to a file and read from it."""
    path = folder / f"{name}.nc"
    netcdf.write(path, *sweep_dataset.build(configuration, name, records))
    return netcdf.whole(path)


def computed(folder):
    """Datasets and periods of both maps as made by the workflow, with one unconverged point.

    Returns (datasets, periods), each by the names of maps.
    """
    configuration = configured()
    datasets, periods = {}, {}
    for name, grid in configuration.sweeps.items():
        points = sweep_stub.records_of(configuration, name)
        requests = period_requests(configuration, name)
        periods[name] = [batch.computed(request)[0] for request in requests]
        if name == BAD_POINT[0]:
            at = BAD_POINT[1] * len(grid.velocity) + BAD_POINT[2]
            points[at]["result"] |= {"converged": False, "reason": "made up"}
        for where, result in ((NO_PERIOD, {}), (BAD_PERIOD, None)):
            if name == where[0]:
                wanted = str(grid.amplitude[where[1]]), f"{grid.velocity[where[2]]:g}"
                (record,) = (r for r in periods[name] if place(r) == wanted)
                rows = record["result"] if result is None else {}
                record["result"] = rows | {"converged": False, "reason": "none to be found"}
        datasets[name] = dataset(folder, configuration, name, points)
    return datasets, periods


def place(record):
    return record["request"]["amplitude"], record["request"]["velocity"]


def made_up(folder, configuration):
    """Datasets of a whole configuration with points from formulas, and one period for all points.

    Without bores under other pressures, whose limits take a minute each.
    """
    datasets = {
        name: made_up_sweep(folder, configuration, name)
        for name, grid in configuration.sweeps.items()
        if grid.motion != "bore" or grid.pressure == "hertz"
    }
    periods = {}
    for name in maps_of(configuration):
        requests = period_requests(configuration, name)
        one = evaluate.computed(requests[len(requests) // 2])
        periods[name] = [{"request": request, "result": one} for request in requests]
    return datasets, periods


def made_up_sweep(folder, configuration, name):
    """Dataset of a sweep with mu_macro = 1 / (3 + k) at point k, whose velocity is k."""
    result = EFFORT | {"mu_macro_error": 1e-4, "velocity_error": 1e-5, "converged": True}
    result |= {f"error_{part}": 1 / 7 for part in ("resolution", "periodicity", "solver")}
    result |= {"mu_torque": 0.5, "mu_torque_error": 1e-4, "model": "polar"}
    points = [
        {"result": result | {"mu_macro": 1 / (3 + k), "velocity": float(k)}, "versions": {}}
        for k in range(len(request.points_of(configuration.sweeps[name]).requests))
    ]
    return dataset(folder, configuration, name, points)


def mean_over(phase, values):
    """Mean over a period of values at uneven phases."""
    return np.trapezoid(values, phase) / (phase[-1] - phase[0])
