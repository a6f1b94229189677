"""Tables of measured friction in SI units, with values that all rows share."""

import math

import pandas as pd
import pytest
import xarray as xr

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.si.fitting.measured import read_measured

GOOD = "speed [mm/s],amplitude [um],friction [N]\n1,0.5,1.93\n2,0.5,2.1\n"
SHARED = {"speed": None, "amplitude": None, "frequency": "20 kHz", "load": "10 N"}


def measured(tmp_path, text, motion="transverse", **more):
    (tmp_path / "m.csv").write_text(text)
    return read_measured(motion, tmp_path / "m.csv", **SHARED | more)


def test_a_table_is_in_the_si(tmp_path):
    result = measured(tmp_path, GOOD)
    assert result.speed.tolist() == [1e-3, 2e-3] and result.amplitude.tolist() == [5e-7, 5e-7]
    assert (result.value.tolist(), result.quantity) == ([1.93, 2.1], "friction")
    assert result.load.tolist() == [10.0, 10.0] and result.frequency.tolist() == [2e4, 2e4]
    assert result.texts == {"frequency": "20 kHz", "load": "10 N"}
    assert not result.has_errors and result.distinct == 2


def test_angles_and_coefficients(tmp_path):
    text = "amplitude [deg],frequency [rpm],mu [%],mu_error\n180,60,30,0.01\n"
    result = measured(tmp_path, text, "bore", speed="1 mm/s", frequency=None)
    assert result.amplitude == pytest.approx([math.pi], rel=1e-15)
    assert [part.tolist() for part in (result.frequency, result.value, result.error)] == [
        *([1.0], [0.3], [0.01])
    ]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (("mm/s", "mm"), "line 2: speed = '1 mm': the unit is millimeter"),
        (("mm/s", "furlong"), "line 2: speed = '1 furlong'"),
        (("1.93", ""), "line 2: friction is empty; allowed: a number in every row"),
        (("1.93", "nan"), "line 2: friction is nan; allowed: a finite number"),
        (("1,0.5", "-1,0.5"), "line 2: speed = '-1 mm/s': allowed is a finite value"),
        (("2,0.5", "2"), "line 3: 2 cells; allowed: 3"),
    ],
)
def test_a_line_that_cannot_be_read_is_left_out_with_its_reason(tmp_path, changed, message):
    try:
        problem = measured(tmp_path, GOOD.replace(*changed)).left_out[0]
    except InputError as error:  # one for each line
        problem = str(error)
    assert message in problem and "\n" not in problem


def test_a_pandas_table_is_read_as_its_file(tmp_path):
    text = "label," + GOOD.replace("\n1", "\nx,1").replace("\n2", "\ny,2")
    of_file = measured(tmp_path, text)
    frame = pd.read_csv(tmp_path / "m.csv")
    frame.loc[2] = [None] * 4  # an empty last row
    of_frame = read_measured("transverse", frame, **SHARED)
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
    assert complaint.startswith("microslip fit: line 6: speed is 'fast'")
    assert complaint.endswith("; left out\n") and complaint.count("\n") == 1
    assert "rows              4, of" in out
    columns = xr.load_dataset(tmp_path / "fit.nc")
    assert columns.label.values.tolist() == ["r0.2", "r0.5", "r1.0", "r2.0"]
