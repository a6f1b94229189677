"""`microslip predict --table`: one contact for each line."""

import json

import pandas as pd
import pytest
import xarray as xr
from stubs import certified_stub

import microslip
from microslip.app import cli

SHARED = {"material": "steel", "radius": "5 mm", "mu": "0.3", "frequency": "20 kHz"}
WORDS = [word for name, text in SHARED.items() for word in (f"--{name}", text)]
COMMAND = ["predict", "transverse", *WORDS, "--tolerance", "0.01", "--table", "contacts.csv"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_each_line_has_its_prediction_or_its_problem(folder, capsys):
    text = "label;load [N];amplitude [um];speed\nfirst;20;0,1;1 cm/s\nsecond;20;-0,1;1 cm/s\n"
    text += "third;20;0,1;\nfourth;20;0,1\n;;;\n"
    (folder / "contacts.csv").write_text(text)
    words = [*COMMAND, "--decimal", ",", "--output", "found.csv"]
    assert cli.main([*words, "--json"]) == 1
    out, complaints = capsys.readouterr()
    first, *others = json.loads(out)
    assert (first["line"], first["label"], first["error"]) == (2, "first", None)
    request = SHARED | {"tolerance": 0.01, "load": "20 N", "amplitude": "0.1 um", "speed": "1 cm/s"}
    alone = microslip.predict("transverse", **request)
    assert (first["mu_apparent"], first["u_lim_m"]) == (alone.mu_apparent, alone.u_lim_m)
    message = ["amplitude = '-0.1 um'", "speed: needed", "line 5: 3 cells; allowed: 4"]
    assert [part in one["error"] for part, one in zip(message, others, strict=True)] == [True] * 3
    lines = [line for line in complaints.splitlines() if line.startswith("microslip predict: ")]
    assert [line.split(": ")[1] for line in lines] == ["line 3", "line 4", "line 5"]
    frame = pd.read_csv(folder / "found.csv")
    assert frame.columns[0] == "case" and frame.label.tolist()[:3] == ["first", "second", "third"]
    assert frame.error.isna().tolist() == frame.converged.tolist() == [True, False, False, False]
    assert frame.mu_macro.isna().tolist() == [False, True, True, True]
    assert cli.main([*words[:-1], "found.nc"]) == 1
    heading, row, *rest = capsys.readouterr().out.splitlines()
    assert heading.split()[:5] == ["line", "label", "mu_apparent", "+-", "force"]
    assert row.split()[:2] == ["2", "first"]
    assert float(row.split()[2]) == pytest.approx(alone.mu_apparent, rel=1e-3)
    assert rest[0].split() == ["3", "second", "no", "prediction"]
    dataset = xr.load_dataset(folder / "found.nc")
    assert dataset.friction_force_N[0] == first["friction_force_N"]
    assert dataset.line.values.tolist() == [2, 3, 4, 5] and dataset.load_N.attrs["units"] == "N"


def test_under_a_force_each_line_has_its_outcome_threshold_and_probabilities(folder, capsys):
    """Without vibration the threshold is mu times the load: 0.15 * 800 N = 120 N.

    For mu = 0.15 +- 0.05, forces of 90 N and 150 N are 0.75 standard deviations below and above the
    threshold.  The contact runs away with probabilities of 0.2266 and 0.7734.
    """
    text = "load [N],amplitude [um],force [N],mu\n800,0,90,0.15 +- 0.05\n800,0,150,0.15 +- 0.05\n"
    (folder / "contacts.csv").write_text(text + "800,0,90,0.15\n")
    words = ["--young", "210 GPa", "--nu", "0", "--radius", "200 mm", "--frequency", "50 Hz"]
    cli.main(["predict", "transverse", *words, "--table", "contacts.csv"])
    lines = capsys.readouterr().out.splitlines()[:4]
    titles, *cells = [
        [line[k : k + 13].strip() for k in range(0, len(lines[0]), 13)] for line in lines
    ]
    stays, away, exact = (dict(zip(titles, one, strict=False)) for one in cells)
    assert [one["outcome"] for one in (stays, away, exact)] == ["stays", "runs away", "stays"]
    assert [one["threshold N"] for one in (stays, away, exact)] == ["120.0"] * 3
    assert float(stays["stays"]) == pytest.approx(0.7734, abs=1e-3)
    assert float(away["runs_away"]) == pytest.approx(0.7734, abs=1e-3)
    assert stays["moves"] == away["moves"] == "0" and exact["stays"] == ""
    assert stays["speed m/s"] == "0" and away["speed m/s"] == ""


RANGED = ["predict", "transverse", *WORDS, "--tolerance", "0.01", "--load", "10 N"]
RANGED += ["--amplitude", "0..0.4 um, 3", "--speed", "5..20 mm/s, 2"]


@pytest.mark.slow
def test_ranges_give_a_table_a_file_and_a_figure(folder, capsys):
    pytest.importorskip("matplotlib")
    files = ["--output", "curve.csv", "--figure", "curve.png"]
    assert cli.main([*RANGED, *files]) == 0
    heading, *rows = capsys.readouterr().out.splitlines()[:7]
    assert heading.split()[:4] == ["amplitude", "speed", "mu_apparent", "+-"]
    assert [row.split()[:4] for row in rows[:2]] == [
        ["0", "um", "5", "mm/s"],
        ["0", "um", "20", "mm/s"],
    ]
    frame = pd.read_csv(folder / "curve.csv")
    assert list(frame.columns[:2]) == ["amplitude_m", "speed_m_s"] and len(frame) == 6
    assert float(rows[3].split()[4]) == pytest.approx(frame.mu_apparent[3], rel=1e-2)
    assert (folder / "curve.png").read_bytes().startswith(b"\x89PNG")
    assert cli.main([*RANGED, "--json"]) == 0
    points = json.loads(capsys.readouterr().out)
    assert [point["mu_apparent"] for point in points] == pytest.approx(list(frame.mu_apparent))
    assert [point["speed_m_s"] for point in points[:2]] == [0.005, 0.02]


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (["--amplitude", "0..10 m, 2"], "speed 5 mm/s, amplitude 10 m: --amplitude = "),
        (["--amplitude", "0..0.4 um, 3", "--map", "certified.nc"], "--map = 'certified.nc': at v"),
    ],
)
def test_a_point_of_a_range_without_a_prediction_is_named(
    changes, problem, folder, capsys, monkeypatch
):
    certified_stub.open_without_points(monkeypatch)
    assert cli.main([*RANGED[:-4], *RANGED[-2:], *changes]) == 1
    out, error = capsys.readouterr()
    assert out.count("no prediction") >= 2
    assert error.startswith("microslip predict: speed 5 mm/s, amplitude ") and problem in error


def test_a_long_period_gives_a_hint_to_fold_before_any_work(folder, capsys):
    rows = "\n".join(map(str, range(2001)))
    (folder / "record.csv").write_text(f"lateral [um]\n{rows}\n")
    assert cli.main(["predict", "file:record.csv", *WORDS]) == 2  # the load is missing
    hint, problem = capsys.readouterr().err.splitlines()
    assert "MOTION = 'file:record.csv'" in hint and "microslip fold" in hint
    assert "--load: needed" in problem
