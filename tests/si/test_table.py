"""Tables of contacts equal the predictions of their rows."""

import pandas as pd
import pytest

import microslip
from microslip.foundation.errors import InputError

SHARED = {"material": "steel", "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
SHARED |= {"tolerance": 0.01}
CASES = {"load": ["10 N", "20 N"], "speed": [0.01, 0.1], "amplitude": ["1 um", "0.3 um"]}


@pytest.mark.parametrize(
    ("cases", "message"),
    [
        ({}, "a mapping of names to sequences"),
        ({"load": ["10 N"], "speed": [0.1, 0.2]}, "columns of one length"),
        ({"load": []}, "1 to 100000 cases"),
        ({"mu": [0.3]}, "not allowed: the table has it"),
        (CASES | {"load": ["10 kg", "1 s"]}, "load = '10 kg': in case 0: the unit is kg"),
    ],
)
def test_a_table_that_is_none_is_refused(cases, message):
    with pytest.raises(InputError, match=message):
        microslip.predict_table("transverse", cases, **SHARED)


def test_pandas_tables_and_files_are_cases(tmp_path):
    """A DataFrame of pandas.read_csv and its file give equal datasets."""
    text = "label;load [N];speed [mm/s];amplitude [um];reduction\na;10;1,5;1;\nb;20;2,5;0,3;\n"
    (tmp_path / "cases.csv").write_text(text)
    frame = pd.read_csv(tmp_path / "cases.csv", sep=";", decimal=",")
    by_file = microslip.predict_table("transverse", tmp_path / "cases.csv", decimal=",", **SHARED)
    by_frame = microslip.predict_table("transverse", frame, **SHARED)
    assert by_frame.mu_macro.values.tolist() == by_file.mu_macro.values.tolist()
    assert by_frame.speed_m_s.values.tolist() == [1.5e-3, 2.5e-3]
    assert by_frame.label.values.tolist() == ["a", "b"]
    assert by_file.case_load.values.tolist() == ["10 N", "20 N"]
    assert by_file.torque_N_m.isnull().all() and by_file.torque_N_m.units == "N m"
    alone = microslip.predict("transverse", load=20, speed=2.5e-3, amplitude=3e-7, **SHARED)
    row = by_file.isel(case=1)
    for name in ("mu_macro", "mu_apparent_error", "u_lim_m", "velocity", "drag_power_W"):
        assert float(row[name]) == pytest.approx(getattr(alone, name), rel=1e-9)
    assert str(row.warnings.values) == "; ".join(alone.warnings) and bool(row.converged)


def test_a_dataframe_without_columns_is_refused():
    with pytest.raises(InputError, match="^cases = {}: allowed is .* with one column at least"):
        microslip.predict_table("transverse", pd.DataFrame(), radius="1 mm")
