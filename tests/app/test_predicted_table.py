"""`microslip predict --table`: one contact for each line."""

import io
import json

import pandas as pd
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.in_process import answer, options

import microslip

SHARED = {"material": "steel", "radius": "5 mm", "mu": "0.3", "frequency": "20 kHz"}
EXACT = SHARED | {"tolerance": 0.01}
RANGED = EXACT | {"load": "10 N", "amplitude": "0..0.4 um, 3", "speed": "5..20 mm/s, 2"}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def printed(text, rows):
    """The first rows of a printed table, as texts by title."""
    return pd.read_fwf(io.StringIO(text), widths=[13] * 20, nrows=rows, dtype=str).fillna("")


def test_each_line_has_its_prediction_or_its_problem(folder):
    text = "label;load [N];amplitude [um];speed\nfirst;20;0,1;1 cm/s\nsecond;20;-0,1;1 cm/s\n"
    (folder / "contacts.csv").write_text(f"{text}third;20;0,1;\nfourth;20;0,1\n;;;\n")
    line = f"predict transverse {options(**EXACT)} --table contacts.csv --decimal ,"
    problems = ["amplitude = '-0.1 um'", "speed: needed", "3 cells; allowed: 4"]
    complaints = [f"microslip predict: line {k}: {one}" for k, one in enumerate(problems, 3)]
    first, *others = json.loads(answer(f"{line} --output a.csv --json", 1, complaints))
    own = {"load": "20 N", "amplitude": "0.1 um", "speed": "1 cm/s"}
    alone = microslip.predict("transverse", **EXACT, **own)
    assert first == {"line": 2, "label": "first", "error": None} | alone.to_dict()
    assert [part in one["error"] for part, one in zip(problems, others, strict=True)] == [True] * 3
    text = answer(f"{line} --output a.nc", 1, complaints)
    assert f"{alone.mu_apparent:.3f}" in printed(text, 4).mu_apparent[0]
    assert printed(text, 4).line.tolist() == ["2", "3", "4", "5"]
    assert text.count("no prediction\n") == 3
    table = microslip.predict_table("transverse", "contacts.csv", decimal=",", **EXACT)
    dataset, frame = xr.load_dataset("a.nc"), pd.read_csv("a.csv")
    xr.testing.assert_equal(dataset.drop_vars(["line", "error"]), table.drop_vars("error"))
    assert dataset.line.values.tolist() == [2, 3, 4, 5] and dataset.load_N.attrs["units"] == "N"
    assert frame.columns[0] == "case" and frame.label.tolist() == table.label.values.tolist()
    assert frame.mu_macro.tolist() == pytest.approx(table.mu_macro.values.tolist(), nan_ok=True)
    assert ",nan" not in (folder / "a.csv").read_text()
    assert frame.error.isna().tolist() == frame.converged.tolist() == [True, False, False, False]


def test_under_a_force_each_line_has_its_outcome_threshold_and_probabilities(folder):
    """Without vibration the threshold is mu times the load: 0.15 * 800 N = 120 N.

    For mu = 0.15 +- 0.05, forces of 90 N and 150 N are 0.75 standard deviations below and above the
    threshold.  The contact runs away with probabilities of 0.2266 and 0.7734.
    """
    text = "load [N],amplitude [um],force [N],mu\n800,0,90,0.15 +- 0.05\n800,0,150,0.15 +- 0.05\n"
    (folder / "contacts.csv").write_text(f"{text}800,0,90,0.15\n")
    body = {"young": "210 GPa", "nu": 0, "radius": "200 mm", "frequency": "50 Hz"}
    text = answer(f"predict transverse {options(**body)} --table contacts.csv", 1)
    frame = printed(text, 3)
    assert frame.outcome.tolist() == ["stays", "runs away", "stays"]
    assert frame["threshold N"].tolist() == ["120.0"] * 3
    assert float(frame["stays"][0]) == pytest.approx(0.7734, abs=1e-3)
    assert float(frame.runs_away[1]) == pytest.approx(0.7734, abs=1e-3)
    assert frame.moves.tolist() == ["0", "0", ""] and frame["stays"][2] == ""
    assert frame["speed m/s"].tolist() == ["0", "", "0"]


@pytest.mark.slow
def test_ranges_give_a_table_a_file_and_a_figure(folder):
    pytest.importorskip("matplotlib")
    line = f"predict transverse {options(**RANGED)}"
    frame = printed(answer(f"{line} --output curve.csv --figure curve.png"), 6)
    grid = microslip.predict_grid("transverse", **RANGED)
    expected = grid.mu_apparent.values.ravel().tolist()
    assert frame.amplitude.tolist()[1:3] == ["0 um", "0.2 um"]
    assert frame.speed.tolist() == ["5 mm/s", "20 mm/s"] * 3
    assert frame.mu_apparent.astype(float).tolist() == pytest.approx(expected, rel=1e-2)
    written = pd.read_csv(folder / "curve.csv")
    assert list(written.columns[:2]) == ["amplitude_m", "speed_m_s"]
    assert (folder / "curve.png").read_bytes().startswith(b"\x89PNG")
    points = json.loads(answer(f"{line} --json"))
    assert [one["mu_apparent"] for one in points] == written.mu_apparent.tolist() == expected
    assert [one["speed_m_s"] for one in points] == written.speed_m_s.tolist() == [0.005, 0.02] * 3


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"amplitude": "0..10 m, 2"}, "mm/s, amplitude 10 m: --amplitude = "),
        ({"map": "certified.nc", "amplitude": "0.1 um"}, "mm/s: --map = 'certified.nc': at v"),
    ],
)
def test_a_point_of_a_range_without_a_prediction_is_named(changes, problem, monkeypatch):
    certified_stub.open_without_points(monkeypatch)
    words = options(**{"speed": None} | RANGED | changes)
    complaints = [f"microslip predict: speed {one} {problem}" for one in (5, 20)]
    assert answer(f"predict transverse {words}", 1, complaints).count("no prediction") == 2


def test_a_long_period_gives_a_hint_to_fold_before_any_work(folder):
    rows = "\n".join(map(str, range(2001)))
    (folder / "record.csv").write_text(f"lateral [um]\n{rows}\n")
    hint = "microslip predict: MOTION = 'file:record.csv': "
    answer(f"predict file:record.csv {options(**SHARED)}", 2, [hint, "--load: needed"])
