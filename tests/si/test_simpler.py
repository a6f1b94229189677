"""A prediction says when a simpler contact has the same friction."""

import numpy as np
import pytest

from microslip import predict, solve

CONTACT = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "frequency": "20 kHz", "speed": "10 mm/s"}
STEEL = {"material": "steel", "counterbody": "steel"}
RUBBER = {"young": "2 MPa", "nu": 0.5, "counterbody": "steel"}


SLIDES = STEEL | {"amplitude": "0.5 um"}


def stroke(folder, swing):
    """Return a motion from a file: one period of the sideways displacement and of the load."""
    phase = 2.0 * np.pi * np.arange(32) / 32.0
    table = np.stack(
        [50.0 * phase / (2.0 * np.pi), 0.3 * np.cos(phase), 10 + swing * np.sin(phase)]
    )
    header = "time [us],lateral [um],load [N]"
    np.savetxt(folder / "stroke.csv", table.T, delimiter=",", header=header, comments="")
    return f"file:{folder}/stroke.csv"


@pytest.mark.parametrize(
    ("word", "motion", "given", "other"),
    [
        ("a sphere", "transverse", SLIDES | {"radius_across": "5.05 mm"}, {"pressure": "hertz"}),
        ("a sphere", "transverse", SLIDES | {"radius_across": "50 mm"}, {"pressure": "hertz"}),
        (
            "Poisson's ratio matters for u_lim only",
            "transverse",
            RUBBER | {"speed": "33 um/s", "frequency": "10 Hz", "amplitude": "420 um"},
            {"poisson": 0.0},
        ),
        ("a constant load", "normal", SLIDES | {"load_amplitude": "0.2 N"}, {}),
        ("a constant load", "normal", SLIDES | {"load_amplitude": "4 N"}, {}),
        (
            "a constant load",
            "normal",
            STEEL | {"load_amplitude": "5 mN", "forward_amplitude": "0.2 um"},
            {"motion": "longitudinal"},
        ),
        (
            "a constant load",
            "normal",
            STEEL | {"load_amplitude": "8 N", "speed": "0.1 m/s"},
            {"amplitude": 0.0},
        ),
        ("a constant load", "normal", STEEL | {"load_amplitude": "3 N"}, {"amplitude": 0.0}),
        ("a constant load", 0.05, STEEL, {}),
        ("a constant load", 1.0, STEEL, {}),
    ],
)
def test_the_simpler_contact_suffices_if_it_changes_less_than_the_error(
    word, motion, given, other, tmp_path
):
    """The friction of the simpler contact is computed with a smaller tolerance."""
    given = CONTACT | given
    if isinstance(motion, float):
        motion, given = stroke(tmp_path, motion), given | {"frequency": None, "load": None}
    one = predict(motion, **given)
    says = any(remark.startswith(word) for remark in one.remarks)
    numbers = {name: one.values[name].value for name in ("velocity", "amplitude", "poisson")}
    simpler = solve(**{"motion": "transverse"} | numbers | other, tolerance=1e-4).mu_macro
    friction = one.values["mu_macro"]
    apart = abs(simpler - friction.value)
    assert abs(apart - friction.error) > 2e-4  # clearly one or the other
    assert says == (apart < friction.error)


def test_nothing_is_said_under_a_force_at_poisson_0_and_of_a_named_material():
    force = CONTACT | SLIDES | {"force": "2.9 N"}
    del force["speed"]
    cork = CONTACT | {"young": "30 MPa", "nu": 0.0, "counterbody": "rigid", "amplitude": "9 um"}
    for given in (force, cork, CONTACT | SLIDES):
        remarks = predict("transverse", **given).remarks
        assert not any("same u_lim" in remark for remark in remarks)
