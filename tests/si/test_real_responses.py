"""Responses of real contacts: units, columns, and the same numbers as without units."""

import numpy as np
import pytest

import microslip

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
    one = dataset.angle.values * real.contact_radius_m / real.u_lim_m
    plain = microslip.response(0.0 * one, angle=one, poisson=0.3)
    whole = 3.0 * real.contact_radius_m * 3.0 * np.pi / 16.0
    assert real.torque_N_m == pytest.approx(whole * plain.torque, rel=2e-3)
