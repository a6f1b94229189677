"""Tables of quantities from CSV files, mappings and DataFrames."""

import numpy as np
import pandas as pd
import pytest

from microslip.foundation.errors import InputError
from microslip.si.tables import Table, read_table, table_of

NAMES = dict.fromkeys(("load", "speed", "amplitude", "mu", "counterbody"), False)


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("load [N],speed\n10,1 mm/s\n", {"load": ["10 N"], "speed": ["1 mm/s"]}),
        ("load [N];mu\n1e1;0.3\n2;\n", {"load": ["1e1 N", "2 N"], "mu": ["0.3", None]}),
        ("# said\n\nmu [-]\t load [ kN ]\n0.3\t1\n", {"mu": ["0.3"], "load": ["1 kN"]}),
        ('counterbody,mu\n"70 GPa, 0.22",0.3\n', {"counterbody": ["70 GPa, 0.22"], "mu": ["0.3"]}),
        ("load\n10 N +- 5 %\n", {"load": ["10 N +- 5 %"]}),
        ("\ufeffLOAD (N)\r\n10\r\n", {"load": ["10 N"]}),
        # spreadsheets save empty columns and rows
        ("load [N],mu,,\n10,0.3,,\n,,,\n,,,\n", {"load": ["10 N"], "mu": ["0.3"]}),
        ("label,load [N]\nsecond run,10\n", {"label": ["second run"], "load": ["10 N"]}),
    ],
)
def test_columns_are_texts_with_their_units(text, result):
    table = read_table(text.encode(), NAMES)
    assert (table.columns, table.errors) == (result, {})


def test_lines_are_numbered_as_the_file_has_them():
    text = b"# measured on two days\n\nload [N]\n1\n# the second day\n2\n"
    assert read_table(text, NAMES) == Table({"load": ["1 N", "2 N"]}, [4, 6], {})


def test_a_decimal_comma_is_read_if_declared():
    """A comma between two digits is a decimal mark; labels keep it."""
    text = (
        "name;load [N];mu;counterbody\n1,5 N;1,5;,3;70 GPa, 0,22\n2;1,5e1;0,3 +- 0,03;steel\n"
        '"3";1.5;0,3;steel\n'
    )
    table = read_table(text.encode(), NAMES, decimal=",")
    assert table.columns["name"] == ["1,5 N", "2", "3"]
    assert table.columns["load"] == ["1.5 N", "1.5e1 N", None]
    assert table.columns["mu"] == [".3", "0.3 +- 0.03", None]
    assert table.columns["counterbody"] == ["70 GPa, 0.22", "steel", None]
    assert table.errors == {2: "line 4: load is '1.5'; allowed: no points where commas are decimal"}
    for text in ('load [N],mu\n"1,5","0,3"\n', "load [N]\n1,5\n"):
        assert read_table(text.encode(), NAMES, decimal=",").columns["load"] == ["1.5 N"]


def test_a_line_that_cannot_be_read_does_not_refuse_the_others():
    text = 'load [N],mu\n1\n2,0.3\nl0,0.3\n4,"0.3\n'
    table = read_table(text.encode(), NAMES)
    assert (table.columns["load"], table.lines) == ([None, "2 N", None, None], [2, 3, 4, 5])
    parts = ("1 cells; allowed: 2", "load is 'l0' in a column in N", "unexpected end of data")
    assert all(part in text for part, text in zip(parts, table.errors.values(), strict=True))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1: the heading is ''"),
        ("load [N]\n", "line 1: no line follows"),
        ("load [N],sped\n1,2\n", "line 1: a column 'sped'; did you mean speed"),
        ("load [N],load [kN]\n1,2\n", "line 1: load is there twice"),
        ("load [N],mu\n1,5,0.3\n", "line 2: 3 cells; allowed: 2, parted by a comma"),
        ("load [N]\n1 kN\n", "line 2: load is '1 kN' in a column in N"),
        ("load [N];mu\n2,1;0.3\n", "line 2: '2,1' has a decimal comma, in load; allowed: a"),
        ("load [N];mu\n900;0.3\n1.100;0.3\n", "line 3: load is '1.100' beside whole numbers"),
        ("load [N]\n1\0\n", "line 2: not text"),
        ("load [\xb5N]\n1\n", "line 1: byte 0xb5 is not UTF-8; allowed: UTF-8, which"),
    ],
)
def test_what_is_no_table_is_refused_by_line(text, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        read_table(text.encode("latin-1"), NAMES)


def test_a_heading_may_need_a_unit():
    with pytest.raises(ValueError, match="line 1: speed has no unit; allowed: some of speed, each"):
        read_table(b"speed\n1\n", {"speed": True})


@pytest.mark.parametrize(
    ("source", "form", "message"),
    [
        ("none.csv", {}, r"^table = 'none.csv': cannot be read \(No such file"),
        ("none.csv", {"encoding": "klingon"}, "^encoding = 'klingon': allowed is the name"),
        ("none.csv", {"decimal": ";"}, "^decimal = ';': allowed is '.' or ','"),
        ({"load [kN]": [2.0], "load [N]": [1.0]}, {}, "^table = 'load': is there twice"),
        ({"load": ["3 N"], "load [N]": [1.0]}, {}, "^table = 'load': is there twice"),
        (
            pd.DataFrame([[1.0, 2.0]], columns=["load [N]", "load [N]"]),
            {},
            "^table = 'load': is there twice",
        ),
        (pd.DataFrame({0: ["5 N"]}), {}, "^table = 0: names of columns must be texts"),
    ],
)
def test_what_is_no_table_is_refused(source, form, message):
    with pytest.raises(InputError, match=message):
        table_of("table", source, NAMES, **form)


def test_another_encoding_is_read_if_declared(tmp_path):
    path = tmp_path / "latin.csv"
    path.write_bytes("label,amplitude [µm]\nprüf,1\n".encode("cp1252"))
    result = table_of("table", path, NAMES, encoding="cp1252")
    assert result.columns == {"label": ["prüf"], "amplitude": ["1 µm"]}


def test_columns_of_a_frame_are_lists_with_units():
    """Every missing value of pandas becomes None."""
    frame = pd.DataFrame({"load [N]": [1.5, np.nan], "mu": [0.3, None], "label": ["a", pd.NA]})
    result = table_of("table", frame, NAMES)
    assert result.columns == {"load": ["1.5 N", None], "mu": [0.3, None], "label": ["a", None]}
    series = {"load": pd.Series(["1 N", "2 N"], index=[7, 3])}
    assert table_of("table", series, NAMES).columns == {"load": ["1 N", "2 N"]}
