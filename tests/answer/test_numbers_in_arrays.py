"""Arrays that hold one number, as arguments."""

import numpy as np
import pytest
import xarray as xr

import microslip

ONE = {
    "numpy": lambda x: np.array(x),
    "numpy, one value": lambda x: np.array([x]),
    "xarray": lambda x: xr.DataArray(x),
    "a row of a dataset": lambda x: xr.DataArray([x, 9 * x], dims="t", coords={"t": [0, 1]})[0],
    "one value": lambda x: xr.DataArray([x], dims="t", attrs={"units": "1"}),
}
CONTACT = {"radius": "5 mm", "material": "steel", "frequency": "1 kHz"}


@pytest.mark.parametrize("kind", ONE)
def test_an_array_of_one_number_is_a_number(kind):
    of = ONE[kind]
    plain = microslip.solve("elliptic:forward=0.5", 0.3, 0.8, poisson=0.0, cells=8, steps=32)
    motion = microslip.Elliptic(forward=of(0.5))
    numbers = {"velocity": of(0.3), "amplitude": of(0.8), "poisson": of(0.0)}
    limits = {"most_work": of(1e8), "time_limit": of(1e8)}
    other = microslip.solve(motion, **numbers, **limits, cells=of(8), steps=of(32))
    assert (other.mu_macro, other.motion) == (plain.mu_macro, plain.motion)
    spring = microslip.solve("transverse", 0.3, 0.8, stiffness=of(1.0), tolerance=1e-2)
    assert spring.stiffness == 1.0 and type(spring.stiffness) is float


@pytest.mark.parametrize("kind", ONE)
def test_an_array_of_one_number_is_a_quantity(kind):
    numbers = {"load": 10.0, "mu": 0.3, "amplitude": 1e-6, "speed": 1e-3}
    arrays = {name: ONE[kind](value) for name, value in numbers.items()}
    plain, other = (microslip.predict("transverse", **CONTACT, **one) for one in (numbers, arrays))
    assert str(other) == str(plain)


def test_the_unit_of_a_dataset_is_read():
    rest = CONTACT | {"mu": 0.3, "amplitude": "1 um", "speed": "1 mm/s"}
    load = xr.DataArray(0.01, attrs={"units": "kN"})
    one, other = (microslip.predict("transverse", **rest, load=x) for x in (load, "10 N"))
    assert one.load_N == other.load_N
    wrong = xr.DataArray(0.01, attrs={"units": "mm"})
    with pytest.raises(microslip.InputError, match="^load = "):
        microslip.predict("transverse", **rest, load=wrong)
