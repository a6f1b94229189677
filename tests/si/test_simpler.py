"""A prediction says when a simpler contact has the same friction."""

import pytest

from microslip import predict, solve

CONTACT = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "frequency": "20 kHz", "speed": "10 mm/s"}
STEEL = {"material": "steel", "counterbody": "steel"}
RUBBER = {"young": "2 MPa", "nu": 0.5, "counterbody": "steel"}


@pytest.mark.parametrize(
    ("word", "changes", "given"),
    [
        ("a sphere suffices", {"pressure": "hertz"}, STEEL | {"radius_across": "5.05 mm"}),
        ("a sphere suffices", {"pressure": "hertz"}, STEEL | {"radius_across": "50 mm"}),
        (
            "Poisson's ratio matters for u_lim only",
            {"poisson": 0.0},
            RUBBER | {"speed": "33 um/s", "frequency": "10 Hz", "amplitude": "420 um"},
        ),
    ],
)
def test_the_simpler_contact_suffices_if_it_changes_less_than_the_error(word, changes, given):
    given = CONTACT | {"amplitude": "0.5 um"} | given
    one = predict("transverse", **given)
    says = any(remark.startswith(word) for remark in one.remarks)
    numbers = {name: one.values[name].value for name in ("velocity", "amplitude", "poisson")}
    simpler = solve("transverse", **numbers | changes, tolerance=1e-4).mu_macro
    friction = one.values["mu_macro"]
    apart = abs(simpler - friction.value)
    assert abs(apart - friction.error) > 2e-4  # clearly one or the other
    assert says == (apart < friction.error)


def test_nothing_is_said_under_a_force_or_of_a_sphere_without_lateral_contraction():
    force = CONTACT | STEEL | {"amplitude": "0.5 um", "force": "2.9 N"}
    del force["speed"]
    cork = CONTACT | {"young": "30 MPa", "nu": 0.0, "counterbody": "rigid", "amplitude": "9 um"}
    for given in (force, cork):
        remarks = predict("transverse", **given).remarks
        assert not any("same u_lim" in remark for remark in remarks)
