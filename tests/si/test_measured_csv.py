"""Tables of measured friction: units of any kind give the same numbers, faults have one message."""

import pytest

import microslip
from microslip.foundation.errors import InputError
from microslip.si.fitting.measured import read_measured
from microslip.si.fitting.measured_csv import read_table

GOOD = "speed [mm/s],amplitude [um],friction [N]\n1,0.5,1.93\n2,0.5,2.1\n"
NONE = dict.fromkeys(("speed", "amplitude", "frequency", "load"))


def test_a_table_is_in_the_si():
    found = read_table(GOOD.encode(), "m")
    assert found == {"speed": [1e-3, 2e-3], "amplitude": [5e-7, 5e-7], "friction": [1.93, 2.1]}


@pytest.mark.parametrize(
    "text",
    [
        "# a ball on a flat\n\n" + GOOD,
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        GOOD.replace("\n", "\r\n"),
        "\ufeff" + GOOD,
        "friction [mN] , speed [m/s] , amplitude [nm]\n1930,0.001,500\n2100,2e-3,5e2\n",
    ],
)
def test_the_same_table_in_other_words(text):
    assert read_table(text.encode(), "m") == read_table(GOOD.encode(), "m")


def test_angles_and_coefficients():
    text = "amplitude [deg],frequency [rpm],mu [%],mu_error\n180,60,30,0.01\n"
    found = read_table(text.encode(), "rad")
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
        (GOOD.replace("2.1", "2,1"), "line 3: 4 values; allowed: 3"),
        (GOOD.replace(",", ";").replace("2.1", "2,1"), "line 3: '2,1' has a decimal comma"),
        (GOOD.replace("1,0.5", "-1,0.5"), "line 2: speed = '-1 mm/s': allowed is a finite value"),
        ("speed [mm/s];mu\n900;0.1\n1.100;0.2\n", "line 3: speed is '1.100' beside whole numbers"),
    ],
)
def test_a_fault_has_one_message_with_its_line(text, said):
    with pytest.raises(ValueError) as caught:
        read_table(text.encode(), "m")
    assert said in str(caught.value) and "\n" not in str(caught.value)


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
