"""The rounds of a certified map, played in one process without a workflow."""

from microslip.config import load
from microslip.sweeps import map_rounds


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
