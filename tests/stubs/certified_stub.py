"""A certified map, refined in one process without a workflow."""

import xarray as xr
from stubs import sweep_stub

import microslip
from microslip.app import commands
from microslip.datasets import certified_map, netcdf
from microslip.si.solve import FrictionMap
from microslip.sweeps import evaluate, map_refinement
from microslip.sweeps.request import key_of


def record(request, mu, error=1e-4):
    """The record of a request with a friction, or of a point that did not converge (None)."""
    result = {"mu_macro": mu, "mu_macro_error": error, "converged": True}
    result = {"converged": False} if mu is None else result
    return {"key": key_of(request), "request": request, "result": result, "versions": {}}


def configured(motion, **settings):
    """Configuration of a certified map with some settings."""
    return sweep_stub.configured({"map": {"motion": motion} | settings})


def played(map_, answer):
    """Records of all points of a map; answer: function from a request to its record."""
    records = []

    def ask(requests):
        records.extend(map(answer, requests))
        return records[-len(requests) :]

    map_refinement.refine(map_.sweeps["map"], ask)
    return records


def built(map_, answer):
    """Dataset of a map; answer: function from a request to its record."""
    return certified_map.build(map_, "map", played(map_, answer))[0]


def reopened(dataset, folder) -> xr.Dataset:
    """A dataset of a map, written to a file and read from it."""
    path = folder / "certified.nc"
    netcdf.write(path, dataset)
    with microslip.open_map(path) as opened:
        return opened.load()


def first_requests(map_):
    """Requests of the first round, the only round for a constant."""
    result = {"mu_macro": 0.5, "velocity": 0.5, "converged": True}
    result |= {"mu_macro_error": 0.0, "velocity_error": 0.0}
    return [
        r["request"] for r in played(map_, lambda request: {"request": request, "result": result})
    ]


def bore(**settings) -> xr.Dataset:
    """Dataset of a bore map with the friction (v + 0.1) / (v + 0.1 + A)."""

    def answer(request):
        velocity, amplitude = (float(request[name]) for name in ("velocity", "amplitude"))
        return record(request, (velocity + 0.1) / (velocity + 0.1 + amplitude))

    axes = {"velocity": [0.01, 10], "amplitude": [0, 5], "error": 0.02}
    map_ = configured("bore", **axes | settings)
    return built(map_, answer)


def solved(request):
    """Record of a request, from the solver."""
    result = evaluate.computed(request)
    return {"key": key_of(request), "request": request, "result": result, "versions": {}}


def open_without_points(monkeypatch):
    """Let commands open a map of transverse that contains no point."""

    def outside(*_):
        raise ValueError("outside the map")

    monkeypatch.setattr(FrictionMap, "at", outside)
    dataset = xr.Dataset(attrs={"motion": "transverse"})
    dataset.encoding["source"] = "certified.nc"
    monkeypatch.setattr(commands, "opened_map", lambda *_: dataset)
