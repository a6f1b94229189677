"""Responses of real contacts: units, columns, and the same numbers as without units."""

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError

STEEL = {"mu": 0.3, "load": "10 N", "radius": "5 mm", "material": "steel"}


def test_forces_are_the_dimensionless_ones_in_newtons():
    rows = np.array([0.0, 0.1, 0.25, 0.1])  # um
    real = microslip.predict_response({"forward [um]": rows, "lateral [nm]": 300 * rows}, **STEEL)
    still = microslip.predict("transverse", **STEEL, amplitude=0.0, speed=1.0, frequency=1.0)
    assert real.u_lim_m == pytest.approx(still.u_lim_m)
    one = rows * 1e-6 / real.u_lim_m
    plain = microslip.response(one, 0.3 * one, poisson=0.3)
    assert real.force_forward_N == pytest.approx(3.0 * plain.force_forward, abs=3e-3)
    assert real.force_lateral_N == pytest.approx(3.0 * plain.force_lateral, abs=3e-3)
    energy = 3.0 * real.u_lim_m * plain.dissipated_energy
    assert real.dissipated_energy_J == pytest.approx(energy, abs=3e-3 * real.u_lim_m)


def test_force_is_that_of_mindlin():
    """F = mu F_z (1 - (1 - u / u_lim)^(3/2)).

    Its first slope is 8 G a / (2 - nu) on a rigid flat, with G = E / (2 (1 + nu)).
    """
    material = microslip.Material(210e9, 0.3)
    path = {"forward": [0.0, 1e-8]}
    real = microslip.predict_response(path, **STEEL | {"material": material}, tolerance=1e-3)
    assert real.converged
    force = 3.0 * (1 - (1 - 1e-8 / real.u_lim_m) ** 1.5)
    assert real.force_forward_N[-1] == pytest.approx(force, abs=3.0 * 1e-3)
    stiffness = 8 * 210e9 / (2 * 1.3) * real.contact_radius_m / (2 - 0.3)
    assert 1.5 * 3.0 / real.u_lim_m == pytest.approx(stiffness, rel=1e-9)


def test_loads_and_indentations_of_the_same_path_agree():
    load = np.array([10.0, 12.0, 8.0])
    forward = np.array([0.0, 0.1, 0.3])
    by_load = microslip.predict_response({"forward [um]": forward, "load": load}, **STEEL)
    still = microslip.predict("transverse", **STEEL, amplitude=0.0, speed=1.0, frequency=1.0)
    depth = still.indentation_m * (load / 10.0) ** (2 / 3)
    other = microslip.predict_response({"forward [um]": forward, "indentation": depth}, **STEEL)
    # between rows the load and the indentation are linear, so that the paths differ a little
    assert by_load.force_forward_N == pytest.approx(other.force_forward_N, abs=2e-2)


def test_a_dataset_has_the_columns_with_their_units():
    real = microslip.predict_response({"angle [deg]": [0.0, 0.01]}, **STEEL)
    dataset = real.to_xarray()
    assert dataset.angle.attrs["units"] == "rad" and dataset.torque.attrs["units"] == "N m"
    assert dataset.angle.values[-1] == pytest.approx(np.deg2rad(0.01))
    assert dataset.torque.values[-1] > 0.0 and dataset.sizes == {"row": 2}


@pytest.mark.parametrize(
    ("path", "contact", "argument"),
    [
        ({"forward [N]": [0, 1]}, {}, "path"),
        ({"forward": [0, None]}, {}, "path"),
        ({"forward": 1.0}, {}, "forward"),
        ({"speed": [0, 1]}, {}, "path"),
        ({"forward": [0, 1], "load": [10.0, -1.0]}, {}, "path"),
        ({"forward": [0, 1]}, {"mu": None}, "mu"),
        ({"forward": [0, 1]}, {"speed": "1 m/s"}, "speed"),
    ],
)
def test_bad_paths_and_contacts_are_refused_by_name(path, contact, argument):
    with pytest.raises(InputError) as error:
        microslip.predict_response(path, **{**STEEL, **contact})
    assert error.value.argument == argument
