"""Bad input: one line that names the argument, before any work, for every entry point."""

import re
import shlex
from decimal import Decimal

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from bad_input_tables.odd_quantities import Q
from stubs import in_process, new_process
from stubs.eq6_map import map_of

import microslip
from microslip.foundation.errors import CacheError, InputError
from microslip.report.figures.drawing import loaded
from microslip.si.materials import Material
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
STROKES = ["file:bare.csv", "file:newton.csv", "file:time.csv", "file:both.csv"]
"""Columns without a unit, with a wrong unit, and of both a load and an indentation."""
VALUES = {
    "point": {
        "MOTION": ["bores", "elliptic:forward", "elliptic:forward=2", "elliptic:phas=2"],
        "velocity": [None, "-1", f"{MINUS}1", "1e7", "1\n2", "0,5", "1e400"],
        "amplitude": [None, "-0.5"],
        "force": ["0.1"],
        "stiffness": ["1e7"],
        "pressure": ["cone", "power:exponent=0.5", "power:exponent=1e400", "file:nothing.csv"],
        "model": ["best"],
        "cells": ["7", "8.5"],
        "time_limit": ["0", "5s"],
        "method": ["shiped", "../euler", "projected-gradient:step=1,step=2"],
    },
    "predict": {
        "MOTION": ["Transverse", "normal:lateral=0.5", "transverse-bore:angle=0.5", *STROKES],
        "amplitude": [None, "1 deg", "-1 um", "1 m"],
        "frequency": ["0 Hz", "20 s^-1"],
        "load": [None, "nan N", "1\n2 N", "10 N +- 1 mm", "10 +- 1 N"],
        "mu": ["0,3", "1100 %", "0.3 +- 0.4"],
        "radius": [None, "1e-320 m", "1e-12 m"],
        "rotation": ["10 rpm"],
        "counter_radius": ["0 mm", "-4 mm"],
        "radius_across": ["1 um"],
        "material": ["Steel", "rigid"],
        "counterbody": ["0.22, 70 GPa", "70 GPa, 0.9", "70 GPa, 0,22"],
        "counter_hardness": ["7 GPa"],
        "hardness": ["60 HRB", "HV"],
        "speed": [None, "1 mm"],
        "force": ["1 N"],
        "mass": ["20 g"],
        "damping": ["1 N*s/m"],
        "tolerance": ["none", "1e-400", "0.01 +- 1 %"],
        "output": ["new.nc"],
        "decimal": [","],
        "figure": ["a.jpg"],
    },
    "fit": {"map": ["m.csv", "nosuch.nc"], "output": ["fit.csv"], "CSV": ["none.csv"]},
    "fold": {"output": [None, "none/a.csv", "new.nc"], "CSV": ["a-file", "path.csv"]},
    "response": {"output": ["none/a.csv", "path.csv"], "CSV": ["none.csv", "units.csv"]},
    "export iwan": {"elements": ["2.5", "0"], "mu": [None]},
    "export table": {"amplitude": ["1 um", "-1..1 um, 3", "1e-7..1 m, 2"], "mass": ["1 g"]},
}
"""Single changes: the option is named in the message."""
FORCED = {"speed": None, "force": "1 N"}
SPRUNG = {"drive_stiffness": "1 N/um"}
STEADY = {"MOTION": "continuous-bore", "amplitude": None}
OSCILLATING = {"MOTION": "normal", "amplitude": None, "load_amplitude": "3 N"}
ALL_WRONG = {"load": None, "table": "wrong.csv"}
SEARCH = {"amplitude": None, "reduction": "50 %"}
ELASTIC = {"material": None, "young": "210 GPa", "nu": "0.3"}
PUSHED = {"velocity": None, "force": "0.1"}
CHANGES = [
    *(("point", PUSHED | {name: "1"}) for name in ("stiffness", "damping")),
    ("point", {"stiffness": "1", "mass": "-1"}),
    ("point", {"MOTION": "bore", "model": "rigid", "method": "euler"}),
    ("predict", {"MOTION": "elliptic", "forward_amplitude": "0 m", "amplitude": "0 m"}),
    ("predict", ELASTIC | {"young": "1 MPa", "radius": "40 mm", "counter_radius": "1 mm"}),
    ("predict", {"counter_radius": "1 m", "radius_across": "1 mm"}),
    ("predict", OSCILLATING | {"radius_across": "8 mm"}),
    ("predict", {"contact_radius": "1 mm", "radius": "5 mm"}),
    ("predict", {"radius": None, "pressure": "hertz", "contact_radius": None}),
    *(("predict", ELASTIC | {"nu": text}) for text in (None, "0.7")),
    ("predict", {"nu": "30 %", "material": "steel"}),
    ("predict", FORCED | SPRUNG),
    ("predict", STEADY | {"frequency": None, "rotation": "1 Hz"} | SPRUNG),
    *(("predict", SEARCH | {"reduction": text}) for text in ("150 %", "100 %")),
    ("predict", {"amplitude": None, "load": None, "reduction": "50 %"}),
    ("predict", SPRUNG | SEARCH),
    ("predict", {"table": "contacts.csv", "load": "1 N"}),
    ("predict", {"table": "contacts.csv", "amplitude": "0..1 um"}),
    ("predict", {"table": "contacts.csv", "load": None, "output": "contacts.csv"}),
    ("predict", ALL_WRONG),
    (
        "predict",
        {"amplitude": "0..1 um", "speed": "1..2 m/s", "phase": "0..1 deg", "figure": "a.png"},
    ),
]
"""Changes of several options: the last one is named in the message."""
POINT = "point transverse --velocity 0.5 --amplitude 0.5"
LINES = [
    ("", "COMMAND is missing"),
    ("pont", "COMMAND = 'pont'; did you mean point?"),
    ("--json", "unknown option --json;"),
    ("point --poisson 0.3", "required: MOTION"),
    ("point transverse --amplitude 0.5 --velocity", "--velocity: expected one argument"),
    ("point transverse --speed 1", "option --speed; did you mean --velocity?"),
    ("predict transverse --diameter '10 mm'", "--radius is half of it"),
    (f"{POINT} --step 8", "unknown option --step; did you mean --steps?"),
    (f"{POINT} '--a\nb'", "unknown option --a b;"),
    (f"{POINT} --velocity -0.2", "--velocity is given twice"),
    (f"{POINT} --poisson 0.1 --nu=0.2", "--nu is given twice, as --poisson the first time"),
    ("predict transverse --amplitude 1 mm", "unrecognized arguments: mm"),
    ("predict transverse --table comma.csv", "line 2: '1,5 N' has a decimal comma, in load; "),
    ("fold noise.csv --output new.csv", " um: peak to peak at "),
    ("predict bore --rotation-amplitude 1deg", "has none; it needs amplitude in rad, frequency"),
    ("predict transverse --mu 0.3", "--load: needed; also missing: amplitude, frequency, speed"),
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
COMMAND_LINES += [*LINES, (command_line("predict", ALL_WRONG), "in line 2 (the first of 2 refused")]
WHITE = np.random.default_rng(4).normal(size=2000)
NOISE = "\n".join(f"{t},{x:.4f}" for t, x in enumerate(WHITE))
TABLES = {
    "a-file": "kept\n",
    "path.csv": "forward [um]\n0\n1\n",
    "units.csv": "forward [N]\n0\n1\n",
    "contacts.csv": "load [N]\n10\n",
    "wrong.csv": "load [mm]\n5\n6\n",
    "noise.csv": f"time [ms],lateral [um]\n{NOISE}\n",
    "bare.csv": "lateral\n1\n2\n3\n4\n5\n",
    "newton.csv": "lateral [N]\n1\n2\n3\n4\n5\n",
    "time.csv": "time,lateral [um]\n1,1\n2,2\n3,3\n4,4\n5,5\n",
    "both.csv": "load [N],indentation [um]\n1,1\n2,2\n3,3\n4,4\n5,5\n",
    "comma.csv": 'load,amplitude [um]\n"1,5 N",1\n',
}


@pytest.fixture
def there(tmp_path, monkeypatch):
    """The working directory, in which commands must not change anything, and nothing is solved."""
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    for name in ("refine.refine", "request.closed_form"):
        monkeypatch.setattr(f"microslip.answer.{name}", None)
    yield tmp_path
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == TABLES


@pytest.mark.parametrize(("line", "part"), COMMAND_LINES, ids=short)
def test_a_bad_command_line_is_one_line(line, part, there):
    process = in_process.run(*shlex.split(line))
    assert (process.returncode, process.stdout) == (2, "")
    assert re.fullmatch(r"microslip[^\n]*: [^\n]+\n", process.stderr)
    assert part in process.stderr


# Python.  Objects of other types than numbers and names, which NumPy or Python would convert.

SPAN, HIDDEN = np.timedelta64(16), np.ma.array(0.5, mask=True)
NO_NUMBERS = [[0.5], "0.5", 0.5j, Decimal("0.5"), np.array([0.5, 0.6]), HIDDEN, SPAN, HUGE]
NO_NUMBERS += [xr.DataArray([0.5, 0.6]), xr.DataArray(0.5, attrs={"units": "mm"}), np.array(True)]
NO_NAMES = [b"a", HUGE, np.array(["a"]), pd.Series(["hertz", "a"])]
PLACE = {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5}
AT = [HIDDEN, HUGE, "1_0", True, None, np.array(["2020-01-01"], "datetime64[ns]"), [0.1, None]]
AXES = {"velocity": np.geomspace(1e-3, 10, 13), "amplitude": np.linspace(0, 3, 13)}


def whole():
    """A map of Eq 6."""
    mu = paper.large_amplitude_transverse(*np.meshgrid(*AXES.values()))
    return map_of(mu, *AXES.values(), 1e-4, tolerance=1e-3)


def at(velocity=0.15):
    """Friction at a point of the map."""
    return whole().microslip.at(velocity, 1.3)


PATH, SQUARE = [0.0, 0.5, 1.0], np.eye(2)
NO_ARRAYS = [Q(PATH, "um"), np.array([1, 2], "m8[s]"), np.array(["2020"], "M8[D]"), [1j, 2], "1"]
NO_ARRAYS += [[True, False], ["1", "2"], np.array(["1"], object), [None, 1.0]]
NO_ARRAYS += [np.ma.array(PATH, mask=[0, 1, 0]), xr.DataArray(PATH, attrs={"units": "mm"})]
ARRAYS = [
    lambda values: microslip.Pressure.from_array(values, [0, 1], SQUARE),
    lambda values: microslip.Pressure.from_array([0, 1], [0, 1], values),
    lambda values: microslip.response(PATH, load=values),
    lambda values: microslip.Sampled.of_columns({"lateral": values}),
    lambda values: microslip.fold(np.arange(3.0), {"load": values}),
    lambda values: microslip.iwan(elements=2).force(values),
]
"""Functions of arrays."""
CALLS = [
    *((at, {"velocity": value}, "velocity = ") for value in AT),
    *((function, {"values": value}, "= ") for function in ARRAYS for value in NO_ARRAYS),
    *((microslip.solve, PLACE | {"velocity": value}, "velocity") for value in NO_NUMBERS),
    *((microslip.solve, PLACE | {"pressure": value}, "pressure") for value in NO_NAMES),
    (microslip.solve, PLACE | {"tolerance": list(range(10**5))}, "tolerance"),
    (microslip.solve, PLACE | {"pressure": "file:."}, "pressure"),
    *((microslip.history, PLACE | {name: 10**12}, name) for name in ("cells", "steps", "periods")),
    (microslip.period, PLACE | {"cells": 1000, "angles": 1000, "steps": 1000}, "cells x angles"),
    *((microslip.open_map, {"name": name}, "name") for name in (None, "")),
    (microslip.open_map, {"name": "s3://b/x.nc"}, "is not there"),
    (microslip.open_map, {"name": "x" * 300 + ".nc"}, "File name too long"),
    *((microslip.open_map, {"name": "a", "results": one}, repr(one)) for one in (None, "~")),
    (microslip.to_xarray, {"record": 5}, "record"),
    (Material, {"young": HUGE, "poisson": 0.3}, "young"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("function", "arguments", "argument"), CALLS, ids=short)
def test_a_call_is_refused_in_one_line(function, arguments, argument, there):
    with pytest.raises((InputError, CacheError)) as caught:
        function(**arguments)
    one_line(caught.value, argument)


@pytest.mark.parametrize("read", [microslip.open_map, loaded])
def test_a_dataset_half_of_which_is_lost_is_one_line(read, tmp_path):
    path = tmp_path / "map.nc"
    whole().to_netcdf(path)
    assert loaded(path).identical(whole()) and at().mu_macro_error < 0.1
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2].ljust(len(content), b"\0"))
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
