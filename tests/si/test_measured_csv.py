"""Tables of measured friction: units of any kind give the same numbers, faults have one message."""

import math

import pandas as pd
import pytest
import xarray as xr

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.si.fitting.measured import read_measured
from microslip.si.fitting.measured_csv import read_table

GOOD = "speed [mm/s],amplitude [um],friction [N]\n1,0.5,1.93\n2,0.5,2.1\n"
NONE = dict.fromkeys(("speed", "amplitude", "frequency", "load"))


def test_a_table_is_in_the_si():
    found = read_table(GOOD.encode(), "m").columns
    assert found == {"speed": [1e-3, 2e-3], "amplitude": [5e-7, 5e-7], "friction": [1.93, 2.1]}


@pytest.mark.parametrize(
    "text",
    [
        "# a ball on a flat\n\n" + GOOD,
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        GOOD.replace("\n", "\r\n"),
        "\ufeff" + GOOD,
        GOOD.replace("\n", ",,\n") + ",,,,\n,,,,\n",
        "friction [mN] , speed [m/s] , amplitude [nm]\n1930,0.001,500\n2100,2e-3,5e2\n",
    ],
)
def test_the_same_table_in_other_words(text):
    found, expected = (read_table(one.encode(), "m") for one in (text, GOOD))
    assert (found.columns, found.left_out) == (expected.columns, [])


def test_angles_and_coefficients():
    text = "amplitude [deg],frequency [rpm],mu [%],mu_error\n180,60,30,0.01\n"
    found = read_table(text.encode(), "rad").columns
    assert found["amplitude"] == [pytest.approx(3.141592653589793, rel=1e-15)]
    assert (found["frequency"], found["mu"], found["mu_error"]) == ([1.0], [0.3], [0.01])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: the heading is ''"),
        (GOOD.replace(" [mm/s]", ""), "line 1: speed has no unit"),
        (GOOD.replace("speed", "velocity"), "line 1: a column 'velocity'"),
        (GOOD.replace("amplitude [um]", "speed [m/s]"), "line 1: speed is there twice"),
        (GOOD.replace("mm/s", "mm"), "line 2: speed = '1 mm': the unit is millimeter"),
        (GOOD.replace("mm/s", "furlong"), "line 2: speed = '1 furlong'"),
        (GOOD.replace("1.93", ""), "line 2: friction is empty; allowed: a number in every row"),
        (GOOD.replace("2,0.5", "2, "), "line 3: amplitude is empty"),
        (GOOD.replace("1.93", "nan"), "line 2: friction = 'nan N': it is not finite"),
        (GOOD.replace("1.93", "1.93 kN"), "line 2: friction = '1.93 kN N'"),
        (GOOD.replace("2.1", "2,1"), "line 3: 4 cells; allowed: 3"),
        (GOOD.replace(",", ";").replace("2.1", "2,1"), "line 3: '2,1' has a decimal comma"),
        (GOOD.replace("1,0.5", "-1,0.5"), "line 2: speed = '-1 mm/s': allowed is a finite value"),
        ("speed [mm/s];mu\n900;0.1\n1.100;0.2\n", "line 3: speed is '1.100' beside whole numbers"),
    ],
)
def test_a_fault_has_one_message_with_its_line(text, said):
    try:
        rows = read_table(text.encode(), "m")
    except ValueError as error:  # about all of the table, or the only line of it
        problem = str(error)
    else:
        (problem,) = rows.left_out
        assert len(rows.columns["speed"]) == len(rows.lines) == 1
    assert said in problem and "\n" not in problem


def test_a_file_with_decimal_commas_and_labels_in_windows_1252(tmp_path):
    text = "Sample;speed [mm/s];amplitude [µm];friction [N]\nprüf 1;1;0,5;1,93\nprüf 2;2;0,5;2,1\n"
    (tmp_path / "m.csv").write_bytes(text.encode("cp1252"))
    form = {"decimal": ",", "encoding": "cp1252"}
    shared = NONE | {"frequency": "20 kHz", "load": "10 N"}
    found = read_measured("transverse", tmp_path / "m.csv", **form, **shared)
    assert found.value.tolist() == [1.93, 2.1] and found.amplitude.tolist() == [5e-7, 5e-7]
    assert found.labels == {"sample": ["prüf 1", "prüf 2"]}


def test_a_pandas_table_is_read_as_its_file(tmp_path):
    (tmp_path / "m.csv").write_text("label," + GOOD.replace("\n1", "\nx,1").replace("\n2", "\ny,2"))
    shared = NONE | {"frequency": "20 kHz", "load": "10 N"}
    frame = pd.read_csv(tmp_path / "m.csv")
    frame.loc[2] = [None] * 4  # an empty row at the end
    of_file, of_frame = (
        read_measured("transverse", given, **shared) for given in (tmp_path / "m.csv", frame)
    )
    for name in ("speed", "amplitude", "value"):
        assert getattr(of_frame, name).tolist() == getattr(of_file, name).tolist()
    assert of_frame.labels == of_file.labels == {"label": ["x", "y"]}


@pytest.mark.slow
def test_a_fit_without_a_line_that_cannot_be_read_says_which(tmp_path, capsys):
    rows = [(v, microslip.solve("transverse", v, 1.5).mu_macro) for v in (0.2, 0.5, 1.0, 2.0)]
    unit = 2.0 * math.pi * 1e3 * 1e-6 * 1e3  # u_lim = 1 um at 1 kHz, in mm/s
    text = "label,speed [mm/s],mu\n" + "".join(f"r{v},{v * unit},{0.3 * m}\n" for v, m in rows)
    (tmp_path / "m.csv").write_text(text + "bad,fast,0.1\n")
    words = ["fit", "transverse", str(tmp_path / "m.csv"), "--amplitude", "1.5 um"]
    words += ["--frequency", "1 kHz", "--load", "10 N", "--tolerance", "0.01"]
    assert cli.main([*words, "--output", str(tmp_path / "fit.nc")]) == 1
    out, complaint = capsys.readouterr()
    assert complaint == (
        "microslip fit: line 6: speed = 'fast mm/s': stopped at 'fast mm/s', where a number was "
        "expected; allowed is one number in units of m/s, such as '1 mm/s'; left out\n"
    )
    assert "rows              4, of" in out
    kept = xr.load_dataset(tmp_path / "fit.nc")
    assert kept.label.values.tolist() == ["r0.2", "r0.5", "r1.0", "r2.0"]


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_measured("transverse", tmp_path / "none.csv", **NONE)


def test_what_all_rows_share_is_given_once(tmp_path):
    path = tmp_path / "measured.csv"
    path.write_text(GOOD)
    shared = NONE | {"frequency": "20 kHz", "load": "10 N"}
    found = read_measured("transverse", path, **shared)
    assert found.texts == {"frequency": "20 kHz", "load": "10 N"}
    assert (found.load == 10.0).all() and (found.frequency == 2e4).all()
    assert not found.has_errors and found.distinct == 2
    with pytest.raises(InputError, match="load = None: it is missing"):
        microslip.fit("transverse", path, frequency="20 kHz")
    with pytest.raises(InputError, match="speed = '1 mm/s': it is both a column"):
        microslip.fit("transverse", path, **shared | {"speed": "1 mm/s"})
