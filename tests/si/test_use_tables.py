"""Tables as other programs write them."""

import json

import pytest

from microslip.app.cli import main

BALL = ("--material=steel", "--radius=5 mm", "--mu=0.3", "--rotation=10 rad/s")
ROWS = "10,1\n20,2\n"


def table(tmp_path, text, *words):
    path = tmp_path / "table.csv"
    path.write_text(text)
    return main(["predict", "continuous-bore", f"--table={path}", *BALL, *words])


@pytest.mark.parametrize(
    "text",
    [
        "sep=,\nload [N],speed [mm/s]\n" + ROWS,
        '"sep=,"\nload [N],speed [mm/s]\n' + ROWS,
        "sep=;\nload [N];speed [mm/s]\n" + ROWS.replace(",", ";"),
        "# load [N], speed [mm/s]\n" + ROWS,
        "# measured\n#load [N],speed [mm/s]\n" + ROWS,
        "# load [N],speed [mm/s]\nload [N],speed [mm/s]\n" + ROWS,
    ],
)
def test_a_heading_below_sep_or_behind_a_mark_is_read(tmp_path, text, capsys):
    assert table(tmp_path, text, "--json") == 0
    rows = json.loads(capsys.readouterr().out)
    loads = [(row["load_N"], row["speed_m_s"]) for row in rows]
    assert loads == [(10.0, 1e-3), (20.0, 2e-3)]


def test_a_label_with_a_line_break_is_one_row(tmp_path, capsys):
    text = 'load [N],speed [mm/s],label\n10,1,"one\nof two"\n20,2,other\n'
    assert table(tmp_path, text, "--json") == 0
    printed = capsys.readouterr().out
    assert "one of two" in printed and printed.count('"load_N"') == 2


def test_a_quote_that_is_never_closed_loses_no_other_row(tmp_path, capsys):
    text = 'load [N],speed [mm/s],label\n10,1,"one\n20,2,other\n'
    assert table(tmp_path, text) == 1
    captured = capsys.readouterr()
    assert "line 2" in captured.err and "line 3" not in captured.err


def test_units_below_the_heading_belong_into_it(tmp_path, capsys):
    assert table(tmp_path, "load,speed\nN,mm/s\n" + ROWS) == 2
    assert "load [N]" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["fold", "fit", "predict"])
def test_a_labview_file_is_named(tmp_path, command, capsys):
    path = tmp_path / "run.csv"
    path.write_text(
        "LabVIEW Measurement\t\nWriter_Version\t2\n***End_of_Header***\t\nX_Value\tVoltage\n0\t1\n"
    )
    words = {
        "fold": [str(path), f"--output={tmp_path / 'out.csv'}"],
        "fit": ["transverse", str(path)],
        "predict": ["transverse", f"--table={path}"],
    }
    assert main([command, *words[command]]) == 2
    assert "LabVIEW" in capsys.readouterr().err.split("allowed")[-1]


def test_units_below_the_heading_of_a_record_belong_into_it(tmp_path, capsys):
    path = tmp_path / "record.csv"
    path.write_text("time,lateral\ns,um\n0,1\n1,2\n")
    assert main(["fold", str(path), f"--output={tmp_path / 'out.csv'}"]) == 2
    assert "time [s]" in capsys.readouterr().err
