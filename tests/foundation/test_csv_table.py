"""Tables of cells from CSV files, mappings and DataFrames."""

import numpy as np
import pandas as pd
import pytest

from microslip.foundation.csv_table import read_table, table_of
from microslip.foundation.errors import InputError

NAMES = {"load": "N", "speed": "m/s", "amplitude": "m", "mu": "", "counterbody": None}
NAMES |= {"load_amplitude": "N", "rotation_amplitude": "rad"}


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("load [N],speed\n10,1 mm/s +- 5 %\n", {"load": ["10 N"], "speed": ["1 mm/s +- 5 %"]}),
        ("load [N];mu\n1e1;0.3\n2;\n", {"load": ["1e1 N", "2 N"], "mu": ["0.3", None]}),
        ("# said\n\nmu [-]\t load [ kN ]\n0.3\t1\n", {"mu": ["0.3"], "load": ["1 kN"]}),
        ('counterbody,mu\n"70 GPa, 0.22",0.3\n', {"counterbody": ["70 GPa, 0.22"], "mu": ["0.3"]}),
        ("\ufeffLOAD (N)\r\n−10\r\n'20", {"load": ["-10 N", "20 N"]}),
        ("load [N]\r10\r", {"load": ["10 N"]}),
        ("Load-Amplitude [N]\trotation  amplitude\n1\t2 deg\n", {"load_amplitude": ["1 N"]}),
        # empty columns and rows at the end
        ("load [N],mu,,\n10,0.3,,\n,,,\n,,,\n", {"load": ["10 N"], "mu": ["0.3"]}),
        ('"load\n[N]",label\n10,"one\nof two"\n', {"load": ["10 N"], "label": ["one of two"]}),
        ('label,load [N]\n5" ball,10\n6" ball,20\n', {"label": ['5" ball', '6" ball']}),
        ('"sep=,"\nload [N],mu\n10,0.3\n', {"load": ["10 N"], "mu": ["0.3"]}),
        ("sep=\t\nload [N]\tmu\n10\t0.3\n", {"load": ["10 N"], "mu": ["0.3"]}),
        ("# measured\n#load [N], mu\n10,0.3\n", {"load": ["10 N"], "mu": ["0.3"]}),
        ("# load [N],mu\nload [N],mu\n10,0.3\n", {"load": ["10 N"], "mu": ["0.3"]}),
        # equal decimals, or commas between cells, leave no doubt about points
        ("load [N];mu\n1.900;1\n", {"load": ["1.900 N"], "mu": ["1"]}),
        ("load [N],mu\n900,1\n1.100,1\n", {"load": ["900 N", "1.100 N"]}),
        ("load [N],mu\n#N/A,0.3\n# end\n1,0.2\n", {"load": [None, "1 N"], "mu": [None, "0.2"]}),
    ],
)
def test_columns_are_texts_with_their_units(text, result):
    assert result.items() <= read_table(text.encode(), NAMES).columns.items()


def test_lines_have_the_numbers_of_the_file():
    text = b'# first day\n\nlabel,load [N]\n"a\n b",1\n# second day\nc,2\n'
    table = read_table(text, NAMES)
    assert (table.lines, table.labels) == ([4, 7], {"label": ["a  b", "c"]})


def test_a_decimal_comma_is_read_if_declared():
    """A comma between two digits is a decimal mark; labels keep it."""
    text = "name;load [N];mu;counterbody\n1,5 N;1,5;,3;70 GPa, 0,22\n2;1,5e1;0,3 +- 0,03;steel\n"
    table = read_table(f'{text}"3";1.5;0,3;steel\n'.encode(), NAMES, decimal=",")
    assert table.columns == {
        "name": ["1,5 N", "2", "3"],
        "load": ["1.5 N", "1.5e1 N", None],
        "mu": [".3", "0.3 +- 0.03", None],
        "counterbody": ["70 GPa, 0.22", "steel", None],
    }
    assert table.errors[2].startswith("line 4: load is '1.5'; allowed: no points")
    text = 'load [N],mu\n"<0,1",1\n"1 234,5",1\n1,2,3\n'
    problems = read_table(text.encode(), NAMES, decimal=",").errors.values()
    parts = ("load is '<0,1'", "load is '1 234,5'", "give decimal = ','")
    assert [a in b for a, b in zip(parts, problems, strict=True)] == [True, True, False]
    for text in ('load [N],mu\n"1,5","0,3"\n', "load [N]\n1,5\n"):
        assert read_table(text.encode(), NAMES, decimal=",").columns["load"] == ["1.5 N"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("load [N],mu\n1\n", "1 cells; allowed: 2, parted by a comma"),
        ("load [N],mu\n1,5,0.3\n", "3 cells; allowed: 2, parted by a comma"),
        ("load [N]\n1 kN\n", "load is '1 kN'; allowed: a number in N"),
        ("load [N]\nnan\n", "load is nan; allowed: a finite number"),
        ("load [N];mu\n2,1;0.3\n", "'2,1' has a decimal comma, in load; allowed: a decimal"),
        ('load [N],mu\n4,"0.3\n', "a double quote is open"),
    ],
)
def test_an_unreadable_row_does_not_refuse_the_others(text, problem):
    other = "2;0.3" if ";" in text else "2,0.3" if "mu" in text else "2"
    table = read_table(f"{text}{other}\n".encode(), NAMES)
    assert table.columns["load"] == [None, "2 N"] and table.lines == [2, 3]
    with pytest.raises(ValueError, match=f"^line 2: {problem}"):
        table.numbers()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1: the heading is ''"),
        ("load [N],sped\n1,2\n", "line 1: the heading has a column 'sped'; did you mean speed"),
        ("load in N,mu\n1,2\n", "line 1: the heading has a column 'load in N'; "),
        ("mu;load: N\n1;2\n", "line 1: the heading has a column 'load: N'; "),
        ("load [N],load [kN]\n1,2\n", "line 1: load is there twice"),
        ("LabVIEW Measurement\t\nX_Value\tVoltage\n0\t1\n", "line 1: .*allowed: .* LabVIEW file"),
        ("load,counterbody\nN,steel\n1,steel\n", r"line 2: load is 'N'.*as in load \[N\]"),
        ("load [N];mu\n900;0.3\n;0.3\n1.100;0.3\n", "line 4: load is '1.100' beside whole numbers"),
        ("load [N]\n1\0\n", "line 2: not text"),
        ("load [\xb5N]\n1\n", "line 1: byte 0xb5 is not UTF-8; allowed: UTF-8, which"),
    ],
)
def test_an_invalid_table_is_refused_by_line(text, message):
    with pytest.raises(ValueError, match=message):
        read_table(text.encode("latin-1"), NAMES)


def test_a_number_has_a_smallest_value():
    table = read_table(b"load [N]\n0\n-1\n", NAMES)
    with pytest.raises(ValueError, match="^line 3: load is -1; allowed: a finite number, 0 or"):
        table.numbers({"load": 0.0})


@pytest.mark.parametrize("unit", ["", " []", " [1]"])
def test_a_heading_may_need_a_unit(unit):
    with pytest.raises(ValueError, match=r"line 1: speed has no unit; allowed: .* speed \[m/s\]"):
        read_table(f"speed{unit},mu\n1,1".encode(), NAMES, need_units=True)


@pytest.mark.parametrize(
    ("source", "form", "message"),
    [
        ("none.csv", {}, r"^table = 'none.csv': cannot be read \(No such file"),
        ("none.csv", {"encoding": "klingon"}, "^encoding = 'klingon': allowed is the name"),
        ("none.csv", {"decimal": ";"}, "^decimal = ';': allowed is '.' or ','"),
        (5, {}, "^table = 5: allowed is a path"),
        ({"load": 5}, {}, "^load = 5: allowed is a sequence"),
        ({"load": ["3 N"], "load [N]": [1.0]}, {}, "^table = 'load': is there twice"),
        (pd.DataFrame({0: ["5 N"]}), {}, "^table = 0: names of columns must be texts"),
        ({"load": [1.0], "mu": [1.0, 2.0]}, {}, "^table = .*: columns of 1 and 2 values"),
        ("empty.csv", {}, "^table = 'empty.csv': no line follows"),
        ("bad.csv", {}, "^table = 'bad.csv': line 2: load is 'x'.*all 2 lines are"),
        (pd.DataFrame({"load [N]": ["5,0"]}), {"decimal": ","}, "^decimal = ',': allowed for a"),
    ],
)
def test_other_objects_are_refused(source, form, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty.csv").write_text("load [N]\n")
    (tmp_path / "bad.csv").write_text("load [N]\nx\ny\n")
    with pytest.raises(InputError, match=message):
        table_of("table", source, NAMES, **form)


def test_another_encoding_is_read_if_declared(tmp_path):
    (tmp_path / "latin.csv").write_bytes("label,amplitude [µm]\nprüf,1\n".encode("cp1252"))
    result = table_of("table", tmp_path / "latin.csv", NAMES, encoding="cp1252")
    assert result.columns == {"label": ["prüf"], "amplitude": ["1 µm"]}


def test_columns_of_a_frame_are_lists_with_units():
    """Every missing value of pandas becomes None."""
    frame = pd.DataFrame({"load [N]": [1.5, np.nan], "mu": [0.3, None], "label": ["a", pd.NA]})
    result = table_of("table", frame, NAMES)
    assert result.columns == {"load": ["1.5 N", None], "mu": [0.3, None], "label": ["a", None]}
