"""A table of contacts as CSV."""

import pytest

from microslip.foundation.errors import InputError
from microslip.si.table_csv import Cases, cases_of_file, read_cases

NAMES = ("load", "speed", "amplitude", "mu", "counterbody")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("load [N],speed\n10,1 mm/s\n", {"load": ["10 N"], "speed": ["1 mm/s"]}),
        ("load [N];mu\n1e1;0.3\n2;\n", {"load": ["1e1 N", "2 N"], "mu": ["0.3", None]}),
        ("# said\n\nmu [-]\t load [ kN ]\n0.3\t1\n", {"mu": ["0.3"], "load": ["1 kN"]}),
        ('counterbody,mu\n"70 GPa, 0.22",0.3\n', {"counterbody": ["70 GPa, 0.22"], "mu": ["0.3"]}),
        ("load\n10 N +- 5 %\n", {"load": ["10 N +- 5 %"]}),
        ("LOAD [N]\r\n10\r\n", {"load": ["10 N"]}),
        ("load (N),speed (mm/s)\n10,1\n", {"load": ["10 N"], "speed": ["1 mm/s"]}),
        # spreadsheets save empty columns and rows
        ("load [N],mu,,\n10,0.3,,\n,,,\n,,,\n", {"load": ["10 N"], "mu": ["0.3"]}),
        ("label,load [N]\nsecond run,10\n", {"label": ["second run"], "load": ["10 N"]}),
    ],
)
def test_columns_are_texts_with_their_units(text, found):
    cases = read_cases(text.encode(), NAMES)
    assert (cases.columns, cases.errors) == (found, {})


def test_lines_are_numbered_as_the_file_has_them():
    text = b"# measured on two days\n\nload [N]\n1\n# the second day\n2\n"
    assert read_cases(text, NAMES) == Cases({"load": ["1 N", "2 N"]}, [4, 6], {})


def test_a_decimal_comma_is_read_if_declared():
    """A comma between two digits is decimal; in labels it stays."""
    text = (
        "name;load [N];mu;counterbody\n1,5 N;1,5;,3;70 GPa, 0,22\n2;1,5e1;0,3 +- 0,03;steel\n"
        '"3";1.5;0,3;steel\n'
    )
    cases = read_cases(text.encode(), (*NAMES, "counterbody"), decimal=",")
    assert cases.columns["name"] == ["1,5 N", "2", "3"]
    assert cases.columns["load"] == ["1.5 N", "1.5e1 N", None]
    assert cases.columns["mu"] == [".3", "0.3 +- 0.03", None]
    assert cases.columns["counterbody"] == ["70 GPa, 0.22", "steel", None]
    assert cases.errors == {2: "line 4: load is '1.5'; allowed: no points where commas are decimal"}
    quoted = 'load [N],mu\n"1,5","0,3"\n'
    assert read_cases(quoted.encode(), NAMES, decimal=",").columns["load"] == ["1.5 N"]


def test_windows_1252_is_read_if_declared(tmp_path):
    path = tmp_path / "latin.csv"
    path.write_bytes("label,amplitude [µm]\nprüf,1\n".encode("cp1252"))
    cases = cases_of_file(path, NAMES, encoding="cp1252")
    assert cases.columns == {"label": ["prüf"], "amplitude": ["1 µm"]}
    with pytest.raises(InputError, match="^encoding = 'klingon': allowed is the name"):
        cases_of_file(path, NAMES, encoding="klingon")
    with pytest.raises(InputError, match="^decimal = ';': allowed is '.' or ','"):
        cases_of_file(path, NAMES, decimal=";")


def test_a_line_that_cannot_be_read_does_not_refuse_the_others():
    text = 'load [N],mu\n1\n2,0.3\nl0,0.3\n4,"0.3\n'
    cases = read_cases(text.encode(), NAMES)
    assert (cases.columns["load"], cases.lines) == ([None, "2 N", None, None], [2, 3, 4, 5])
    said = ("1 cells; allowed: 2", "load is 'l0' in a column in N", "unexpected end of data")
    assert [one in text for one, text in zip(said, cases.errors.values(), strict=True)] == [
        True
    ] * 3


def test_another_encoding_is_told(tmp_path):
    (tmp_path / "latin.csv").write_bytes("amplitude [µm]\n1\n".encode("latin-1"))
    with pytest.raises(ValueError, match="line 1: byte 0xb5 is not UTF-8; allowed: UTF-8, which"):
        cases_of_file(tmp_path / "latin.csv", NAMES)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: the heading is ''"),
        ("load [N]\n", "line 1: no line follows"),
        ("load [N],sped\n1,2\n", "line 1: a column 'sped'; allowed: some of load, speed"),
        ("load [N],load [kN]\n1,2\n", "line 1: load is there twice"),
        ("load [N],mu\n1\n", "line 2: 1 cells; allowed: 2"),
        ("load [N],mu\n1,5,0.3\n", "line 2: 3 cells; allowed: 2, parted by a comma"),
        ("load [N]\nl0\n", "line 2: load is 'l0' in a column in N"),
        ("load [N]\n1 kN\n", "line 2: load is '1 kN' in a column in N"),
        ("load [N];mu\n900;0.3\n1.100;0.3\n", "line 3: load is '1.100' beside whole numbers"),
        ("load [N]\n1\0\n", "line 2: not text"),
        ('load [N],counterbody\n1,"70 GPa, 0.22\n', "line 2: unexpected end of data; allowed"),
    ],
)
def test_what_is_no_table_is_refused_by_line(text, said):
    with pytest.raises(ValueError, match=said.replace("(", r"\(")):
        read_cases(text.encode(), NAMES)


def test_a_file_that_is_none_is_told_by_its_name(tmp_path):
    with pytest.raises(ValueError, match=r"^table = '.*none.csv': cannot be read \(No such file"):
        cases_of_file(tmp_path / "none.csv", NAMES)
