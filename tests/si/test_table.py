"""Tables of contacts equal the predictions of their rows."""

import math

import pandas as pd
import pytest

import microslip
from microslip.foundation.errors import InputError

SHARED = {"material": "steel", "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
SHARED |= {"tolerance": 0.01}
CASES = {"load": ["10 N", "20 N"], "speed": [0.01, 0.1], "amplitude": ["1 um", "0.3 um"]}


@pytest.mark.slow
def test_each_case_is_its_prediction(tmp_path):
    table = microslip.predict_table("transverse", CASES, **SHARED)
    for case in range(2):
        own = {name: values[case] for name, values in CASES.items()}
        alone = microslip.predict("transverse", **SHARED, **own)
        row = table.sel(case=case)
        for name in ("mu_macro", "mu_apparent_error", "contact_radius_m", "u_lim_m", "velocity"):
            assert float(row[name]) == getattr(alone, name)
        assert str(row.warnings.values) == "; ".join(alone.warnings)
        assert math.isnan(float(row.torque_N_m)) and bool(row.converged)
    assert table.case_load.values.tolist() == ["10 N", "20 N"]
    units = {"u_lim_m": "m", "speed_m_s": "m/s", "torque_N_m": "N m", "mu_macro": "1"}
    units |= {"drag_power_W": "W"}
    assert {name: table[name].attrs["units"] for name in units} == units
    table.to_netcdf(tmp_path / "table.nc", engine="netcdf4")


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


def test_a_dataframe_without_columns_is_refused():
    with pytest.raises(InputError, match="^cases = {}: allowed is .* with one column at least"):
        microslip.predict_table("transverse", pd.DataFrame(), radius="1 mm")
