"""Bad input: one line that names the argument, before any work, for every entry point."""

import errno
import os
import re
import shlex
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from stubs import in_process, new_process
from stubs.eq6_map import map_of

import microslip
from microslip.app import cli
from microslip.config import load
from microslip.foundation import files
from microslip.foundation.errors import CacheError, InputError
from microslip.report.figures.drawing import loaded
from microslip.scene.by_name import pressure_named
from microslip.si.materials import Material
from microslip.sweeps import batch, evaluate
from microslip.theory import paper

MINUS, HUGE = "\N{MINUS SIGN}", 10**5000
LONGEST_LINE = 1500
"""Largest number of characters of an error message; longer values are shortened."""


def one_line(error, *parts):
    line = str(error)
    assert "\n" not in line and len(line) < LONGEST_LINE
    assert [part for part in parts if part not in line] == []


def short(value):
    """Name of a value that is the same in every process."""
    try:
        return re.sub(" at 0x[0-9a-f]+", "", getattr(value, "__name__", None) or repr(value))[:60]
    except ValueError:  # a whole number of thousands of digits
        return "huge"


# Command lines.  Valid options of a command, and changes of them (None: missing).

CONTACT = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": "0.3"}
VIBRATED = {"speed": "10 mm/s", "amplitude": "1 um", "frequency": "20 kHz", "tolerance": "0.1"}
GOOD = {
    "point": {"MOTION": "transverse", "velocity": "0.5", "amplitude": "0.5"},
    "predict": {"MOTION": "transverse"} | CONTACT | VIBRATED,
    "fit": {"MOTION": "transverse", "CSV": "a-file"},
    "fold": {"CSV": "a-file", "output": "new.csv"},
    "response": {"CSV": "path.csv"} | CONTACT,
    "export iwan": CONTACT,
    "export table": {"MOTION": "transverse"} | CONTACT | VIBRATED | {"amplitude": "0..1 um"},
}
"""Positional arguments are in capitals."""
VALUES = {
    "point": {
        "MOTION": ["bores", "elliptic:forward", "elliptic:forward=2", "elliptic:phas=2"],
        "velocity": [None, "-1", f"{MINUS}1", "1e7", "1\n2", "0,5", "1e400", "1e-400"],
        "amplitude": [None, "-0.5"],
        "force": ["0.1"],
        "stiffness": ["1e7"],
        "mass": ["1"],
        "damping": ["1"],
        "pressure": ["cone", "power:exponent=0.5", "power:exponent=1e400", "file:nothing.csv"],
        "poisson": ["0.7"],
        "nu": ["0.7"],
        "model": ["best"],
        "tolerance": ["0"],
        "cells": ["7", "1002", "8.5"],
        "steps": ["9"],
        "time_limit": ["0", "5s"],
        "method": ["shiped", "../euler", "projected-gradient:step=1,step=2", "paper"],
    },
    "predict": {
        "MOTION": ["Transverse", "normal:lateral=0.5", "transverse-bore:angle=0.5"],
        "amplitude": [None, "1 deg", "-1 um", "1 m"],
        "frequency": ["0 Hz", "20 s^-1"],
        "rotation": ["10 rpm"],
        "forward_amplitude": ["1 um"],
        "load": [None, "nan N", "10 kg", "1\n2 N", "10 N +- 1 mm", "10 +- 1 N"],
        "mu": [None, "0,3", "1100 %", "0.3 +- 0.4"],
        "radius": [None, "5", "1e-320 m", "1e-12 m"],
        "counter_radius": ["0 mm", "-4 mm"],
        "radius_across": ["1 um"],
        "material": ["Steel", "rigid"],
        "counterbody": ["wood", "0.22, 70 GPa", "70 GPa, 0.9", "70 GPa, 0,22"],
        "counter_hardness": ["7 GPa"],
        "hardness": ["60 HRB", "80 HRC", "200 HB", "HV"],
        "density": ["7.85"],
        "speed": [None, "1 mm"],
        "force": ["1 N"],
        "mass": ["20 g"],
        "damping": ["1 N*s/m"],
        "tolerance": ["none", "1e-9", "1e-400", "0.01 +- 1 %"],
        "reduction": ["50 %"],
        "output": ["new.nc"],
        "decimal": [","],
        "figure": ["a.jpg"],
    },
    "fit": {
        "map": ["m.csv", "nosuch.nc"],
        "output": ["fit.csv"],
        "figure": ["fit.jpg"],
        "CSV": ["none.csv"],
    },
    "fold": {"output": [None, "none/a.csv"], "CSV": ["a-file"]},
    "response": {"output": ["none/a.csv", "path.csv"], "CSV": ["none.csv", "units.csv"]},
    "export iwan": {"elements": ["2.5", "0"], "mu": [None]},
    "export table": {
        "MOTION": ["sideways"],
        "amplitude": ["1 um", "-1..1 um, 3", "1e-7..1 m, 2"],
        "speed": [None],
        "mass": ["1 g"],
    },
}
"""Single changes: the option is named in the message."""
FORCED = {"speed": None, "force": "1 N"}
SPRUNG = {"drive_stiffness": "1 N/um"}
STEADY = {"MOTION": "continuous-bore", "amplitude": None}
SIZED = {"radius": None, "contact_radius": "1 mm"}
SEARCH = {"amplitude": None, "reduction": "50 %"}
ELASTIC = {"material": None, "young": "210 GPa", "nu": "0.3"}
PUSHED = {"velocity": None, "force": "0.1"}
CHANGES = [
    ("point", PUSHED | {"force": "-0.1"}),
    *(("point", PUSHED | {name: "1"}) for name in ("stiffness", "damping")),
    *(("point", PUSHED | {name: text}) for name, text in (("model", "rigid"), ("method", "march"))),
    *(("point", {"stiffness": "1", name: "-1"}) for name in ("mass", "damping")),
    ("point", {"pressure": "ellipse", "model": "radial"}),
    ("point", {"poisson": "0.3", "model": "radial"}),
    *(("point", {"MOTION": "bore", "model": name}) for name in ("radial", "slider")),
    ("point", {"MOTION": "bore", "model": "rigid", "method": "euler"}),
    ("point", STEADY | {"method": "march"}),
    ("point", {"MOTION": "continuous-bore", "amplitude": "1"}),
    ("predict", {"MOTION": "bore", "amplitude": "1e9 turn"}),
    ("predict", {"MOTION": "elliptic", "forward_amplitude": None}),
    ("predict", {"MOTION": "elliptic", "forward_amplitude": "0 m", "amplitude": "0 m"}),
    ("predict", {"MOTION": "normal", "amplitude": None, "load_amplitude": "1e10 N"}),
    ("predict", {"radius": "1e-300 m", "load": "1e-300 N"}),
    ("predict", ELASTIC | {"young": "1 MPa", "radius": "40 mm", "counter_radius": "1 mm"}),
    ("predict", {"counter_radius": "1 m", "radius_across": "1 mm"}),
    ("predict", {"contact_radius": "1 mm", "radius": "5 mm"}),
    ("predict", {"radius": None, "pressure": "hertz", "contact_radius": None}),
    ("predict", SIZED | {"pressure": "rong"}),
    ("predict", SIZED | {"contact_radius": "1e-200 m"}),
    ("predict", {"material": None, "young": None}),
    *(("predict", ELASTIC | {"nu": text}) for text in (None, "0.7")),
    ("predict", {"material": None, "nu": "0.3", "young": "inf GPa"}),
    ("predict", {"nu": "30 %", "material": "steel"}),
    ("predict", {"frequency": "1e-300 Hz", "speed": "1e300 m/s"}),
    ("predict", FORCED | {"force": "0 N"}),
    ("predict", FORCED | SPRUNG),
    ("predict", FORCED | {"damping": "1 N*s/m"}),
    *(("predict", SPRUNG | {"mass": text}) for text in ("-20 g", "1e308 kg")),
    ("predict", SPRUNG | {"MOTION": "longitudinal", "speed": "0 m/s"}),
    ("predict", STEADY | {"frequency": None, "rotation": "1 Hz"} | SPRUNG),
    *(("predict", SEARCH | {"reduction": text}) for text in ("150 %", "5 %", "100 %")),
    ("predict", {"amplitude": None, "load": None, "reduction": "50 %"}),
    *(("predict", more | SEARCH) for more in (FORCED, SPRUNG)),
    ("predict", {"MOTION": "elliptic", "forward_amplitude": "1 um"} | SEARCH),
    ("predict", {"reduction": "50 %", "load": None, "amplitude": "0 m"}),
    ("predict", {"table": "contacts.csv", "load": "1 N"}),
    ("predict", {"table": "contacts.csv", "amplitude": "0..1 um"}),
    ("predict", {"table": "contacts.csv", "load": None, "amplitude": None, "output": "found.txt"}),
    ("predict", {"table": "contacts.csv", "load": None, "output": "contacts.csv"}),
    ("predict", {"load": None, "table": "wrong.csv"}),
    (
        "predict",
        {"amplitude": "0..1 um", "speed": "1..2 m/s", "phase": "0..1 deg", "figure": "a.png"},
    ),
    ("export iwan", {"tolerance": "1e-2", "elements": "2"}),
    ("export iwan", {"radius_across": "8 mm"}),
]
"""Changes of several options: the last one is named in the message."""
GIVEN = " ".join(
    f"--{name}={value!r}" for name, value in GOOD["predict"].items() if name != "MOTION"
)
POINT = "point transverse --velocity 0.5 --amplitude 0.5"
LINES = [
    ("", "COMMAND is missing"),
    ("pont", "COMMAND = 'pont'; did you mean point?"),
    ("export", "COMMAND = 'export'"),
    ("--json", "unknown option --json;"),
    ("point --poisson 0.3", "required: MOTION"),
    ("point transverse --amplitude 0.5 --velocity", "--velocity: expected one argument"),
    ("point transverse --speed 1", "option --speed; did you mean --velocity?"),
    ("predict transverse --velocity 1", "option --velocity; did you mean --speed?"),
    ("predict transverse --diameter '10 mm'", "--radius is half of it"),
    (f"{POINT} --step 8", "unknown option --step; did you mean --steps?"),
    (f"{POINT} '--a\nb'", "unknown option --a b;"),
    (f"{POINT} bore", "unrecognized arguments: bore"),
    (f"{POINT} --velocity -0.2", "--velocity is given twice"),
    (f"{POINT} --poisson 0.1 --nu=0.2", "--nu is given twice, as --poisson the first time"),
    ("predict transverse --amplitude 1 mm", "unrecognized arguments: mm"),
    ("predict transverse --mu 0.3", "--load: needed; also missing: amplitude, frequency, speed"),
    ("fit transverse a-file --mu 0.3", "unknown option --mu;"),
]
"""Other command lines, each with a part of the message."""


def command_line(command, changes):
    options = GOOD[command] | changes
    places = [value for name, value in options.items() if name.isupper()]
    words = [f"--{n.replace('_', '-')}={v}" for n, v in options.items() if v and n.islower()]
    return shlex.join([*command.split(), *places, *words])


def named(name, value):
    argument = name if name.isupper() else f"--{name.replace('_', '-')}"
    return f"{argument}: " if value is None else f"{argument} = {value!r}"


SINGLE = [(c, {n: v}) for c, of in VALUES.items() for n, values in of.items() for v in values]
COMMAND_LINES = [(command_line(c, new), named(*[*new.items()][-1])) for c, new in SINGLE + CHANGES]
COMMAND_LINES += LINES
TABLES = {
    "a-file": "kept\n",
    "path.csv": "forward [um]\n0\n1\n",
    "units.csv": "forward [N]\n0\n1\n",
    "contacts.csv": "load [N]\n10\n",
    "wrong.csv": "load [mm]\n5\n",
}


@pytest.fixture
def there(tmp_path, monkeypatch):
    """The working directory, in which commands must not change anything, and nothing is solved."""
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    for name in ("refine.refine", "request.no_vibration", "request.closed_form"):
        monkeypatch.setattr(f"microslip.answer.{name}", None)
    yield tmp_path
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == TABLES


@pytest.mark.parametrize(("line", "part"), COMMAND_LINES, ids=short)
def test_a_bad_command_line_is_one_line(line, part, there):
    process = in_process.run(*shlex.split(line))
    assert (process.returncode, process.stdout) == (2, "")
    assert re.fullmatch(r"microslip[^\n]*: [^\n]+\n", process.stderr)
    assert part in process.stderr


def test_every_option_is_given_a_bad_value():
    options = {one for one in cli.parser_of("point")._option_string_actions if one[1] == "-"}
    tested = {word for line, _ in COMMAND_LINES for word in re.findall(r"--[a-z-]+", line)}
    assert options - tested == {"--help"}


def test_a_location_of_bad_cells_is_the_line_of_the_table(there):
    text = 'load,amplitude [um]\n"1,5 N",1\n'
    (there / "contacts.csv").write_text(text)
    options = {"table": "contacts.csv", "load": None, "amplitude": None}
    process = in_process.run(*shlex.split(command_line("predict", options)))
    (there / "contacts.csv").write_text(TABLES["contacts.csv"])
    assert process.returncode == 2 and "line 2" in process.stderr
    assert "or --decimal ','" in process.stderr  # the option in place of the Python argument


# Python.  Objects of other types than numbers and names, which NumPy or Python would convert.

SPAN, HIDDEN = np.timedelta64(16), np.ma.array(0.5, mask=True)
NO_NUMBERS = [[0.5], "0.5", 0.5j, Decimal("0.5"), np.array([0.5]), HIDDEN, SPAN, HUGE]
NO_NUMBERS += [xr.DataArray([0.5, 0.6]), xr.DataArray(0.5, attrs={"units": "mm"}), np.array(True)]
NO_NAMES = [b"a", HUGE, np.array(["a"]), pd.Series(["hertz", "a"])]
PLACE = {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5}
CALLS = [(microslip.solve, PLACE | {"velocity": value}, "velocity") for value in NO_NUMBERS]
CALLS += [(microslip.solve, PLACE | {"cells": value}, "cells") for value in NO_NUMBERS]
CALLS += [
    (microslip.solve, PLACE | {name: value}, name)
    for name in ("motion", "model", "method", "pressure")
    for value in NO_NAMES
]
CALLS += [
    (microslip.solve, PLACE | {"tolerance": list(range(10**5))}, "tolerance"),
    (microslip.solve, PLACE | {"pressure": "file:."}, "pressure"),
    (microslip.solve, PLACE | {"motion": "elliptic:lateral=0,forward=0"}, "motion"),
    (microslip.history, PLACE | {"travel": 1e300}, "travel"),
    (microslip.history, PLACE | {"start": np.array(["full-slip", "a"])}, "start"),
    (microslip.history, {"motion": "continuous-bore", "velocity": 1e-320}, "velocity"),
    *((microslip.history, PLACE | {name: 10**12}, name) for name in ("cells", "steps", "periods")),
    (microslip.period, PLACE | {"angles": 10**12}, "angles"),
    (microslip.period, PLACE | {"cells": 1000, "angles": 1000, "steps": 1000}, "cells x angles"),
    *((microslip.open_map, {"name": name}, "name") for name in (None, "", "transvers")),
    (microslip.open_map, {"name": "s3://b/x.nc"}, "is not there"),
    (microslip.open_map, {"name": "x" * 300 + ".nc"}, "File name too long"),
    *((microslip.open_map, {"name": "a", "results": one}, repr(one)) for one in (None, "~")),
    (microslip.to_xarray, {"record": 5}, "record"),
    (Material, {"young": HUGE, "poisson": 0.3}, "young"),
]


@pytest.mark.parametrize(("function", "arguments", "argument"), CALLS, ids=short)
def test_a_call_is_refused_in_one_line(function, arguments, argument, there):
    with pytest.raises((InputError, CacheError)) as caught:
        function(**arguments)
    one_line(caught.value, argument)


TIMES = np.array(["2020-01-01"], "datetime64[ns]")
AT = [*NO_NUMBERS[1:3], HIDDEN, HUGE, "1_0", True, None, np.array([0.1 + 1j]), TIMES, -0.1]
AT += [np.ma.array([0.1, 0.3], mask=[True, False]), [True, False], [0.1, np.nan], [0.1, None]]
NUMBERS = [Decimal("0.3"), Fraction(3, 10), np.float32(0.3), [Decimal("0.3")], pd.Series([0.3])]


@pytest.fixture(scope="module")
def friction():
    velocity, amplitude = np.array([0.01, 0.1, 0.3, 1.0]), np.array([0.0, 0.5, 1.0])
    mu = velocity / (amplitude[:, None] + velocity)
    return map_of(mu, velocity, amplitude, 1e-3, tolerance=1e-2).microslip


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("velocity", AT, ids=short)
def test_a_bad_velocity_is_refused_by_a_map(velocity, friction):
    with pytest.raises(InputError) as caught:
        friction.at(velocity, 0.5)
    one_line(caught.value, "velocity = ")


@pytest.mark.parametrize("velocity", NUMBERS, ids=short)
def test_numbers_of_other_types_are_numbers(velocity, friction):
    """The value at a node of the map is 0.3 / (0.5 + 0.3)."""
    result = friction.at(velocity, 0.5).mu_macro
    assert float(result.squeeze()) == pytest.approx(0.375, abs=1e-6)


def test_a_travel_as_long_as_allowed_ends_in_the_steady_state():
    """The friction of the steady state is that of Eq 21 for any length of the steps."""
    ends = [
        microslip.history("continuous-bore", 0.5, cells=8, steps=16, travel=travel).force_forward
        for travel in (10.0, 1e6)
    ]
    assert ends[1][-1] == pytest.approx(paper.bore_forward(0.5), abs=1e-3)
    assert ends[1][-1] == pytest.approx(ends[0][-1], abs=1e-3)


# Configurations: a value in place of %s, and the velocity or parts of the message

SWEEP = "sweeps:\n  bore:\n    motion: bore\n    amplitude: [1]\n    velocity: %s\n"
SETTINGS = [
    ("[0,1, 0,5]", (0.0, 1.0, 5.0)),
    ("[0, 0.0e-400]", (0.0,)),
    ("[0.1, 1:30]", ["velocity[1]: '1:30' is text"]),
    ("[0.1, 1.0e-400]", ["1.0e-400", "nearer 0"]),
    ("[0.1, 0o10]", ["velocity[1]: '0o10' is text"]),
    ("[0.1, yes]", ["velocity[1]: True"]),
    ("!!set {0.1, 1}", ["velocity", "a number"]),
    ("{0: 0.1, 1: 1}", ["velocity:", "{log: [first, last, count]}"]),
    ("1\nresults: '~'", ["results", "'~'"]),
    ("1\nresults: s3://bucket/x", ["results", "s3://bucket/x"]),
    ('1\nresults: "\\ud800"', ["results", "\\ud800"]),
    ("1\nfigures: {1: {}, 1: {}}", ["the key 1 occurs twice", "line 6"]),
]


@pytest.mark.parametrize(("text", "expected"), SETTINGS)
def test_numbers_mean_what_they_show(text, expected, tmp_path):
    path = tmp_path / "given.yaml"
    path.write_text(SWEEP % text, encoding="utf-8")
    if isinstance(expected, tuple):
        assert load.load(path).sweeps["bore"].velocity == expected
        return
    with pytest.raises(load.ConfigError) as caught:
        load.load(path)
    one_line(caught.value, str(path), *expected)
    str(caught.value).encode()  # the message can be printed


# Files of pressures: the load shares of the four quarters, or a part of the message

PLAIN = [[0.1, 0.2], [0.3, 0.4]]
GRIDS = [
    ("forward [mm],lateral [in],pressure [psi]", "0,0,1\n0,1,2\n25.4,0,3\n25.4,1,4\n", PLAIN),
    ("forward,lateral,pressure", "0,0,1\n0,1e-310,2\n1e-310,0,3\n1e-310,1e-310,4\n", PLAIN),
    ("forward,lateral,pressure", "1e9,0,1\n1e9,1,2\n1000000001,0,3\n1000000001,1,4\n", PLAIN),
    ("forward,lateral,pressure", "0,0,1\n0,1e20,2\n1,0,3\n1,1e20,4\n", "steps in one unit"),
    ("forward|lateral|pressure", "0|0|1\n", "line 1: the heading"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("heading", "rows", "expected"), GRIDS)
def test_odd_pressures_as_text(heading, rows, expected, tmp_path):
    (tmp_path / "p.csv").write_text(f"{heading}\n{rows}")
    if isinstance(expected, list):
        loads = pressure_named(f"file:{tmp_path}/p.csv").cell_loads(2)
        assert loads == pytest.approx(np.array(expected), abs=1e-9)
        return
    with pytest.raises(InputError) as caught:
        pressure_named(f"file:{tmp_path}/p.csv")
    one_line(caught.value, "pressure = ", "p.csv", expected)


def grid(**units):
    """A grid of pressures with attributes of its variables."""
    axes = {"forward": [0.0, 1.0], "lateral": [0.0, 1.0]}
    data = xr.Dataset({"pressure": (tuple(axes), np.array([[1.0, 2.0], [3.0, 4.0]]))}, axes)
    for name, attributes in units.items():
        data[name].attrs.update(attributes)
    return data


NETCDF = [
    (grid(forward={"unit": "mm"}, lateral={"UNIT": "um"}), ""),
    (grid(forward={"units": 5}, lateral={"units": 5}), "forward has the units 5"),
    (grid(forward={"units": "mm", "Unit": "um"}), "one attribute units"),
    (grid().isel(forward=[]), "no points"),
    (grid() > 1, "pressure holds bool"),
    (grid(pressure={"missing_value": 4.0}), "pressure = nan: at forward 1, lateral 1"),
    (None, "not a netCDF file"),
]


@pytest.mark.parametrize(("data", "part"), NETCDF)
def test_odd_pressures_as_netcdf(data, part, tmp_path):
    path = tmp_path / "p.nc"
    (grid() if data is None else data).to_netcdf(path)
    if data is None:
        os.truncate(path, path.stat().st_size // 2)
    if not part:
        # a thousand times as long as wide: mean distance of length / 4, divided by length / 2
        assert pressure_named(f"file:{path}").torque == pytest.approx(0.5, abs=1e-4)
        return
    with pytest.raises(InputError) as caught:
        pressure_named(f"file:{path}")
    one_line(caught.value, str(path), part)


# Datasets: of other origin, and damaged

AXES = {"velocity": np.geomspace(1e-3, 10, 13), "amplitude": np.linspace(0, 3, 13)}


def whole():
    """A map of Eq 6 that contains (0.15, 1.3)."""
    mu = paper.large_amplitude_transverse(*np.meshgrid(*AXES.values()))
    return map_of(mu, *AXES.values(), 1e-4, tolerance=1e-3)


DATASETS = {
    "mu_macro = 100.0": lambda d: d.assign(mu_macro=100 * d.mu_macro),
    "mu_macro = 'of type <U1'": lambda d: d.assign(mu_macro=xr.full_like(d.mu_macro, "a", "<U1")),
    "mu_macro_error = -0.0001": lambda d: d.assign(mu_macro_error=-d.mu_macro_error),
    "velocity = 'of type": lambda d: d.assign_coords(velocity=d.velocity.astype(str)),
    "velocity = -3.0": lambda d: d.assign_coords(velocity=np.log10(d.velocity)),
    "is there twice": lambda d: xr.concat([d, d.assign(mu_macro=0.5 * d.mu_macro)], "velocity"),
}


@pytest.mark.parametrize("part", DATASETS)
def test_a_dataset_that_no_sweep_has_made_is_refused(part):
    assert whole().microslip.at(0.15, 1.3).mu_macro_error < 0.1
    with pytest.raises(InputError) as caught:
        DATASETS[part](whole()).microslip.at(0.15, 1.3)
    one_line(caught.value, part)


SPOILED = {
    "cut off": lambda path: os.truncate(path, path.stat().st_size // 2),
    "missing": lambda path: path.unlink(),
    "a folder": lambda path: (path.unlink(), path.mkdir()),
    "half of it zeros": lambda path: path.write_bytes(
        path.read_bytes()[: path.stat().st_size // 2].ljust(path.stat().st_size, b"\0")
    ),
}


@pytest.mark.parametrize("case", SPOILED)
def test_a_dataset_that_cannot_be_read_is_one_line(case, tmp_path):
    path = tmp_path / "map.nc"
    whole().to_netcdf(path)
    assert loaded(path).identical(whole())
    SPOILED[case](path)
    for read in (microslip.open_map, loaded):
        with pytest.raises(CacheError) as caught:
            read(path)
        one_line(caught.value, str(path))


FULL_DISK = """
import resource, sys
import numpy, xarray
from microslip.datasets import netcdf
from microslip.foundation.errors import CacheError
data = xarray.Dataset({"a": ("x", numpy.random.default_rng(1).random(99999))})
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    netcdf.write(sys.argv[1], data)
except CacheError as error:
    print(error)
"""


@pytest.mark.slow
def test_a_disk_that_fills_up_under_a_dataset_leaves_the_old_one(tmp_path):
    """A limit on the size of files stands for a full disk: both interrupt a write."""
    path = tmp_path / "bore.nc"
    path.write_text("before")
    message = new_process.output(FULL_DISK, path)
    assert message.count("\n") == 1
    assert f"cannot write {path}: " in message and "make room" in message
    assert [one.read_text() for one in tmp_path.iterdir()] == ["before"]


# Folders of results

REQUEST = {"kind": "point", "motion": "continuous-bore", "velocity": "2", "poisson": "0"}
REQUEST |= {"model": "auto", "tolerance": "0.001", "amplitude": None, "cells": None, "steps": None}


def full(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("new", "No space left on device"),
        ("file/new", "Not a directory"),
        ("half", "Not a directory"),
        ("link", "File exists"),
    ],
)
def test_a_folder_that_cannot_keep_results_is_refused_before_work(
    name, part, tmp_path, monkeypatch
):
    (tmp_path / "file").write_text("kept")
    (tmp_path / "link").symlink_to("nowhere/at/all")
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "batches").write_text("kept")
    if name == "new":
        monkeypatch.setattr(files.os, "fsync", full)
    monkeypatch.setattr(evaluate, "computed", lambda _: pytest.fail("work has started"))
    with pytest.raises(CacheError) as caught:
        batch.solve([REQUEST], tmp_path / name / "batches" / "bore" / "0.jsonl")
    one_line(caught.value, str(tmp_path / name), part, "another folder")
    names = [p.name for p in tmp_path.rglob("*") if p.is_file()]
    assert sorted(names) == ["batches", "file"]


@pytest.mark.long
def test_sweep_runs_where_the_home_takes_no_files(tmp_path):
    (tmp_path / "home").write_text("no folder")
    axes = "{motion: bore, velocity: 1, amplitude: [0, 1], model: rigid, tolerance: 0.01}"
    (tmp_path / "tiny.yaml").write_text(f"sweeps: {{bore: {axes}}}\n")
    environment = {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": "", "NUMBA_CACHE_DIR": ""}
    words = ("sweep", "-n", "--configfile", "tiny.yaml")
    process = in_process.run_apart(*words, folder=tmp_path, **environment)
    assert process.returncode == 0, process.stderr
    assert "Traceback" not in process.stderr
    assert process.stderr.count("cannot be written to: Snakemake's own files are in") == 1
