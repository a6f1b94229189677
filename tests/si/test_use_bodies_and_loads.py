"""Warnings about adhesion, separation and waves, missing inputs, and matrices with gaps."""

import math
import re

import numpy as np
import pytest

import microslip
from microslip.app.cli import main

BALL = {"material": "steel", "counterbody": "steel", "mu": 0.3, "radius": "5 mm", "load": "10 N"}
SIDEWAYS = {"speed": "1 mm/s", "amplitude": "1 um", "frequency": "1 kHz"}


def warnings(words, **inputs):
    texts = microslip.predict("transverse", tolerance=0.1, **SIDEWAYS | inputs).warnings
    return [text for text in texts if words in text]


def newtons(text):
    value, prefix = re.search(r"about ([\d.e+-]+) (k|m|u|n|)N", text).groups()
    return float(value) * {"k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9}[prefix]


STEEL = 210e9 / (2.0 * (1.0 - 0.3**2))
PAIR = {"young": "210 GPa", "nu": 0.3, "counterbody": "210 GPa, 0.3", "mu": 0.3}
ENERGY = 0.05  # N/m, of van der Waals forces between clean surfaces


def test_adhesion_of_a_flat_punch_is_kendalls():
    (text,) = warnings(
        "adhere", contact_radius="10 mm", pressure="punch:flat=0.99", load="1 kN", **PAIR
    )
    kendall = math.sqrt(8.0 * math.pi * STEEL * ENERGY * 10e-3**3)
    assert newtons(text) == pytest.approx(kendall, rel=0.03)


def test_adhesion_of_a_power_law_indenter_equals_that_of_the_same_sphere():
    """The load is that at which a sphere of radius 5 mm has a contact radius of 5 um."""
    load = 4.0 / 3.0 * STEEL * 5e-6**3 / 5e-3
    shape = {"contact_radius": "5 um", "pressure": "power:exponent=2", "load": load}
    (text,) = warnings("adhere", **shape, **PAIR)
    assert newtons(text) == pytest.approx(1.5 * math.pi * ENERGY * 5e-3, rel=0.02)


def test_adhesion_of_an_ellipse_follows_from_the_mean_curvature():
    """Derjaguin: 2 pi w sqrt(R' R''), for a short Tabor number."""
    shape = {"radius": "5 mm", "radius_across": "50 um", "load": "1 mN"}
    (text,) = warnings("adhere", **shape, **PAIR)
    assert newtons(text) == pytest.approx(2.0 * math.pi * ENERGY * 0.5e-3, rel=0.3)
    assert newtons(text) <= 2.0 * math.pi * ENERGY * 0.5e-3 * 1.05


def test_adhesion_without_a_formula_is_not_checked():
    inputs = {"contact_radius": "10 mm", "pressure": "ring:inner=0.5", "load": "1 N"}
    result = microslip.predict("transverse", tolerance=0.1, **SIDEWAYS | inputs | PAIR)
    assert not [text for text in result.warnings if "adhere" in text]
    assert [text for text in result.not_checked if "adhesion" in text]


@pytest.mark.parametrize(
    "newtons, load, separates",
    [
        ([140, 100, 60, 100], "50 N", False),
        ([140, 100, 60, 100], "100 N", False),
        ([90, 30, 0, 0, 0, 30], "100 N", True),
        ([90, 30, 0, 0, 0, 30], None, True),
    ],
)
def test_bodies_separate_if_the_load_of_a_file_vanishes(tmp_path, newtons, load, separates):
    rows = "\n".join(f"{one},{0.1 * k}" for k, one in enumerate(newtons))
    (tmp_path / "load.csv").write_text(f"load [N],lateral [um]\n{rows}\n")
    inputs = BALL | {"load": load, "speed": "1 mm/s", "frequency": "1 kHz"}
    result = microslip.predict(f"file:{tmp_path}/load.csv", tolerance=0.1, **inputs)
    assert any("separate" in text for text in result.warnings) is separates


def test_the_time_of_a_wave_is_named_after_its_way():
    """The time over the contact radius, in radians of the oscillation."""
    inputs = BALL | {"frequency": "10 MHz", "density": "7850 kg/m^3"}
    result = microslip.predict("transverse", tolerance=0.1, **SIDEWAYS | inputs)
    (text,) = [one for one in result.warnings if "shear wave" in one]
    wave = math.sqrt(210e9 / 2.6 / 7850.0)
    radians = 2.0 * math.pi * 1e7 * result.contact_radius_m / wave
    assert "contact radius" in text and "crosses" not in text
    assert float(re.search(r"([\d.]+) radians", text)[1]) == pytest.approx(radians, rel=0.05)


# Missing inputs


def test_all_missing_inputs_are_named_at_once(capsys):
    assert main(["predict", "transverse", "--mu", "0.3"]) == 2
    line = capsys.readouterr().err
    for name in ("load", "amplitude", "frequency", "speed", "radius", "young", "nu"):
        assert name in line
    assert len(line.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "option, half", [("--diameter", "--radius"), ("--contact-diameter", "--contact-radius")]
)
def test_a_diameter_is_twice_the_radius(option, half, capsys):
    with pytest.raises(SystemExit) as stop:
        main(["predict", "transverse", option, "10 mm"])
    assert stop.value.code == 2
    assert f"{half} is half of it" in capsys.readouterr().err


def test_a_column_of_diameters_is_twice_the_radius(tmp_path, capsys):
    (tmp_path / "t.csv").write_text("load [N],diameter [mm]\n1,5\n")
    assert main(["predict", "transverse", "--table", str(tmp_path / "t.csv")]) == 2
    assert "radius is half of it" in capsys.readouterr().err


# Matrices of pressures


def film(cells):
    return "\n".join(",".join(str(one) for one in row) for row in cells) + "\n"


@pytest.mark.parametrize(
    "text, line, cell",
    [
        (",2,3,\n1,2,3,1\n1,2,3,1\n", 1, 1),
        ("1,2,3,1\n1,2,3,\n1,2,3,1\n", 2, 4),
        ("1,2,,1\n1,2,3,1\n", 1, 3),
        ("film\n,,1,2\n3,4,5,6\n3,4,5,6\n", 2, 1),
        ("1;2;3\n4;5;\n", 2, 3),
    ],
)
def test_an_empty_cell_of_a_film_is_named(tmp_path, text, line, cell):
    (tmp_path / "film.csv").write_text(text)
    with pytest.raises(microslip.InputError, match=f"line {line}: cell {cell}\\b") as caught:
        microslip.solve("transverse", 0.1, 1.0, pressure=f"file:{tmp_path}/film.csv,pitch=1 mm")
    assert caught.value.argument == "pressure"


@pytest.mark.parametrize("corner", ["", "x"])
def test_a_film_with_a_cut_corner_is_refused(tmp_path, corner):
    x = np.linspace(-1.0, 1.0, 8)
    cells = [[round(2.0 - a * a - b * b, 3) for b in x] for a in x]
    for i in range(2):
        cells[i][: 2 - i] = [corner] * (2 - i)
    (tmp_path / "film.csv").write_text(film(cells))
    with pytest.raises(microslip.InputError, match="line 1"):
        microslip.solve("transverse", 0.1, 1.0, pressure=f"file:{tmp_path}/film.csv,pitch=1 mm")


# Fits


@pytest.mark.parametrize("column", ["friction [N]", "mu"])
@pytest.mark.parametrize("value, word", [(0.0, "neither"), (-0.2, "negative")])
def test_a_fit_without_positive_friction_determines_nothing(tmp_path, column, value, word, capsys):
    rows = "".join(f"{speed},1,1,10,{value}\n" for speed in (1, 2, 4, 8))
    heading = f"speed [mm/s],amplitude [um],frequency [kHz],load [N],{column}\n"
    (tmp_path / "rows.csv").write_text(heading + rows)
    assert main(["fit", "transverse", str(tmp_path / "rows.csv")]) == 2
    assert word in capsys.readouterr().err


def test_a_large_fitted_mu_has_the_warning_of_predict():
    rows = {"speed [mm/s]": [1, 2, 4, 8, 1000], "mu": [0.6, 0.9, 1.2, 1.4, 1.5]}
    common = {"amplitude": "1 um", "frequency": "1 kHz", "load": "10 N"}
    result = microslip.fit("transverse", rows, **common, tolerance=0.02)
    assert result.mu > 1.0
    assert any("Coulomb" in text for text in result.warnings)


def test_a_fit_prints_what_the_command_prints(tmp_path, capsys):
    rows = "".join(f"{v},{mu}\n" for v, mu in ((1, 0.1), (2, 0.15), (4, 0.2), (8, 0.25), (99, 0.3)))
    path = tmp_path / "rows.csv"
    path.write_text("speed [mm/s],mu\n" + rows)
    common = {"amplitude": "1 um", "frequency": "1 kHz", "load": "10 N", "tolerance": "0.02"}
    code = main(["fit", "transverse", str(path), *(f"--{n}={x}" for n, x in common.items())])
    printed = capsys.readouterr().out
    assert code in (0, 1)
    assert str(microslip.fit("transverse", path, **common)) + "\n" == printed
    assert "u_lim" in printed and "u lim" not in printed


@pytest.mark.parametrize(
    "missing, titles",
    [
        ("amplitude", {"amplitude": 1.0}),
        ("load", {"u_lim": 2.0 / 3.0, "contact radius": 1.0 / 3.0}),
    ],
)
def test_values_that_follow_from_a_root_have_its_error(missing, titles):
    inputs = {n: v for n, v in (BALL | SIDEWAYS).items() if n != missing}
    result = microslip.predict("transverse", reduction="40 %", tolerance=0.02, **inputs)
    root = result.input_values[missing]
    lines = str(result).split("\n\n")[1].splitlines()
    for title, power in titles.items():
        line = next(one for one in lines if one.startswith(f"{title} "))
        number, error = re.search(r"([\d.]+) \+- ([\d.e-]+)", line).groups()
        share = power * root.error / root.value
        assert float(error) / float(number) == pytest.approx(share, rel=0.15)
