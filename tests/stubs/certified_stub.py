"""The rounds of a certified map, played in one process without a workflow."""

import xarray as xr

from microslip.config import load
from microslip.datasets import certified_map
from microslip.sweeps import map_rounds
from microslip.sweeps.batches import key_of


def configured(scene, **given):
    """The certified map of a sweep with these settings."""
    (map_,) = load.from_mapping({"sweeps": {scene: given}}).certified.values()
    return map_


def played(map_, answer):
    """Its rounds and the records that answer them; answer: from a request to its record."""
    rounds, records = [], []
    while not rounds or rounds[-1]["nodes"]:
        known = map_rounds.answers_in(rounds, records)
        rounds.append(map_rounds.next_round(map_, known, 50))
        records += [answer(request) for request in rounds[-1]["requests"]]
    return rounds, records


def bore(**given) -> xr.Dataset:
    """The dataset of a map of a bore whose friction is (v + 0.1) / (v + 0.1 + A), made up."""

    def answer(request):
        velocity, amplitude = (float(request[name]) for name in ("velocity", "amplitude"))
        mu = (velocity + 0.1) / (velocity + 0.1 + amplitude)
        result = {"mu_macro": mu, "mu_macro_error": 1e-4, "converged": True}
        return {"key": key_of(request), "request": request, "result": result, "versions": {}}

    axes = {"velocity": [0.01, 10], "amplitude": [0, 5], "adaptive": {"error": 0.02}}
    map_ = configured("bore", **axes | given)
    return certified_map.build(map_, *played(map_, answer))
