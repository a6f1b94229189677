"""Missing inputs, matrices of pressures with gaps, and fits of extreme rows."""

import numpy as np
import pytest

import microslip
from microslip.app.cli import main

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
