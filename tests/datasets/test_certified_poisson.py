"""Certified maps over velocity, amplitude and Poisson's ratio."""

import numpy as np
import pytest
from stubs import certified_stub
from stubs.eq6_map import places

from microslip.datasets.interpolation import COORDINATES
from microslip.foundation.errors import InputError
from microslip.theory import paper

pytestmark = pytest.mark.slow
ERROR = 3e-2


def friction(velocity, amplitude, poisson):
    """An invented friction: Eq 6 with the power 1.5 of the amplitude, and a drop that decreases
    with Poisson's ratio."""
    plain = paper.large_amplitude_transverse(velocity, np.asarray(amplitude) ** 1.5)
    return 1.0 - (1.0 - plain) * (1.0 - poisson**2)


def record(request):
    place = (float(request[name]) for name in ("velocity", "amplitude", "poisson"))
    return certified_stub.record(request, float(friction(*place)))


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    """A certified map over Poisson's ratios from 0 to 0.4, read from a file."""
    axes = {"velocity": [0.01, 10], "amplitude": [0, 3], "poisson": [0, 0.4]}
    map_ = certified_stub.configured("transverse", **axes, error=ERROR)
    built = certified_stub.built(map_, record)
    return certified_stub.reopened(built, tmp_path_factory.mktemp("certified"))


def test_a_file_says_its_directions(dataset):
    assert dataset.directions == "velocity amplitude poisson"
    assert dataset.degrees.tolist() == [4, 4, 2]
    assert dataset.sizes["node"] == 5 * 5 * 3
    assert set(np.unique(dataset.poisson)) >= {0.0, 0.2, 0.4}
    # the last direction changes fastest
    first = dataset.poisson.values[dataset.cell_node.values[:, :3]]
    assert (np.diff(first) > 0.0).all()
    assert (dataset.cell_poisson_low < dataset.cell_poisson_high).all()


@pytest.mark.parametrize("poisson", [0.0, 0.13, 0.3, 0.4])
def test_answers_at_any_poissons_ratio_are_within_their_errors(dataset, poisson):
    velocity, amplitude = places(20_000, (-2, 1), (0, 3))
    answer = dataset.microslip.at(velocity, amplitude, poisson=poisson)
    off = abs(answer.mu_macro - friction(velocity.values, amplitude.values, poisson))
    assert float((off <= answer.mu_macro_error).mean()) >= 0.999
    assert float(answer.mu_macro_error.max()) <= ERROR
    assert float(answer.poisson) == poisson


def test_a_map_of_another_version_is_refused(dataset):
    text = '{"velocity": [0.01, 10], "amplitude": [0, 3]}'
    with pytest.raises(InputError, match="make it again"):
        dataset.assign_attrs({COORDINATES: text}).microslip.at(0.1, 1.0, poisson=0.1)
