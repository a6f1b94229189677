"""Pressures from files: their meaning, the error due to the grid, formats, and bad input."""

import os
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.app.cli import main
from microslip.foundation import named_files
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Measured

AXIS = np.linspace(-1.25, 1.25, 51)
HERTZIAN = np.sqrt(np.maximum(1.0 - AXIS[:, None] ** 2 - AXIS**2, 0.0))
HEAD = "forward,lateral,pressure\n"
POINT = ("point", "transverse", "--velocity", "0.1", "--amplitude", "0.5")


def csv(path, forward=AXIS, lateral=AXIS, values=HERTZIAN):
    rows = [
        f"{x:.15g},{y:.15g},{values[i, j]:.15g}"
        for i, x in enumerate(forward)
        for j, y in enumerate(lateral)
    ]
    path.write_text("\n".join(["forward,lateral,pressure", *rows]) + "\n")
    return f"file:{path}"


def netcdf(path, forward=AXIS, lateral=AXIS, values=HERTZIAN, units=None):
    coordinates = {"forward": forward, "lateral": lateral}
    array = xr.DataArray(values, coordinates, ("forward", "lateral"), name="pressure")
    data = array.to_dataset()
    for name, unit in (units or {}).items():
        data[name].attrs["units"] = unit
    data.to_netcdf(path)
    return f"file:{path}"


def text(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return f"file:{path}"


def refusal(name):
    with pytest.raises(InputError) as refused:
        pressure_named(name)
    assert refused.value.argument == "pressure"
    assert "\n" not in str(refused.value)
    return str(refused.value)


# Meaning of a grid


@pytest.mark.slow
@pytest.mark.parametrize("reading", ["cells", "samples"])
def test_a_uniform_square_is_one_pressure_at_any_resolution(reading):
    """The torque is the mean distance from the centre of the square, and u_lim the displacement at
    the centre."""
    for count in (2, 3, 41):
        axis = np.linspace(3.0, 7.0, count)
        square = Measured.on_grid("square", axis, axis, np.full((count, count), 5.0), reading)
        assert square.torque == pytest.approx((np.sqrt(2.0) + np.arcsinh(1.0)) / 3.0, abs=1e-12)
        # (1/pi) Integral of 1/distance over [-1, 1]^2 at load 1, for cells next to the centre
        assert square.G_star == pytest.approx(2.0 * np.arcsinh(1.0) / np.pi, abs=2e-5)
        assert square.cell_loads(7) == pytest.approx(np.full((7, 7), 1.0 / 49.0), abs=1e-14)
        for other in square.readings:
            assert other.cell_loads(7) == pytest.approx(square.cell_loads(7), abs=1e-14)
            assert other.G_star == pytest.approx(square.G_star, rel=1e-12)
            assert other.torque == pytest.approx(square.torque, rel=1e-12)


def test_cells_are_even_up_to_half_a_step_beyond_the_points():
    values = np.array([[1.0, 2.0], [3.0, 4.0]])
    pressure = Measured.on_grid("four", [0.0, 1.0], [5.0, 6.0], values)
    assert pressure.cell_loads(2) == pytest.approx(values / 10.0, abs=1e-14)
    assert pressure.cell_loads(4) == pytest.approx(np.kron(values, np.ones((2, 2))) / 40.0)
    # mean distance of a unit square from its corner, for any loads
    assert pressure.torque == pytest.approx((np.sqrt(2.0) + np.arcsinh(1.0)) / 3.0, abs=1e-12)


def test_samples_are_bilinear_between_the_points_and_end_there():
    """For p = 1 + x on [0, 1]^2 the two halves carry 5/12 and 7/12 of the load."""
    values = np.array([[1.0, 1.0], [2.0, 2.0]])
    pressure = Measured.on_grid("ramp", [0.0, 1.0], [0.0, 1.0], values, "samples")
    assert pressure.cell_loads(2).sum(axis=1) == pytest.approx([5.0 / 12.0, 7.0 / 12.0], abs=1e-14)
    assert pressure.cell_loads(2).sum(axis=0) == pytest.approx([0.5, 0.5], abs=1e-14)
    finer = np.linspace(0.0, 1.0, 5)
    same = Measured.on_grid(
        "ramp", finer, finer, np.repeat(1.0 + finer[:, None], 5, axis=1), "samples"
    )
    assert same.cell_loads(6) == pytest.approx(pressure.cell_loads(6), abs=1e-14)


def test_oblong_cells_and_grids_keep_their_shape():
    """The grid is half as wide as long; a is half the longer side."""
    forward, lateral = np.arange(4) * 0.5, np.arange(8) * 0.125
    oblong = Measured.on_grid("oblong", forward, lateral, np.ones((4, 8)))
    assert oblong.half_widths == pytest.approx((1.0, 0.5), abs=1e-14)
    assert oblong.cell_loads(8) == pytest.approx(np.full((8, 8), 1.0 / 64.0), abs=1e-14)


@pytest.mark.slow
def test_zeros_around_the_contact_change_nothing():
    values = np.array([[1.0, 2.0], [3.0, 4.0]])
    inside = Measured.on_grid("four", [0.0, 1.0], [0.0, 1.0], values)
    around = np.zeros((5, 5))
    around[1:3, 2:4] = values
    outside = Measured.on_grid("four", np.arange(-1.0, 4.0), np.arange(-2.0, 3.0), around)
    assert outside.cell_loads(6) == pytest.approx(inside.cell_loads(6), abs=1e-14)
    assert outside.torque == pytest.approx(inside.torque, abs=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize("reading", ["cells", "samples"])
def test_a_finer_grid_of_hertzs_pressure_is_nearer_to_it(reading):
    def off(count):
        axis = np.linspace(-1.0, 1.0, count + 1)
        values = np.sqrt(np.maximum(1.0 - axis[:, None] ** 2 - axis**2, 0.0))
        pressure = Measured.on_grid("sphere", axis, axis, values, reading)
        return np.abs([pressure.torque - HERTZ.torque, pressure.G_star - HERTZ.G_star])

    coarse, fine = off(16), off(64)
    assert np.all(fine < 0.5 * coarse)
    assert np.all(fine < 2e-2)


# Error due to the grid


def sphere(x, y):
    return np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))


def cone(x, y):
    """Pressure of a cone (Love), cut off at a quarter of a step from the centre."""
    step = x.ravel()[1] - x.ravel()[0]
    return np.arccosh(1.0 / np.clip(np.hypot(x, y), 0.25 * step, 1.0))


TRUTHS = [("hertz", sphere, 8), pytest.param("hertz", sphere, 64, marks=pytest.mark.long)]
TRUTHS += [("power:exponent=1", cone, 16)]


@pytest.mark.slow
@pytest.mark.parametrize("reading", ["cells", pytest.param("samples", marks=pytest.mark.long)])
@pytest.mark.parametrize(("name", "shape", "count"), TRUTHS)
def test_the_error_holds_what_the_resolution_of_a_file_leaves_open(
    tmp_path, name, shape, count, reading
):
    """Friction for values at the centres of cells over the disc is compared with rings."""
    axis = (np.arange(count) + 0.5) * 2.0 / count - 1.0
    file = csv(tmp_path / "p.csv", axis, axis, shape(axis[:, None], axis[None, :]))
    truth = microslip.solve("transverse", 0.1, 0.5, pressure=name)
    result = microslip.solve(
        "transverse", 0.1, 0.5, pressure=f"{file},grid={reading}", tolerance=2e-2
    )
    assert truth.model == "radial"
    assert result.friction.by_source["model"] > 0.0
    assert abs(result.mu_macro - truth.mu_macro) <= result.mu_macro_error + truth.mu_macro_error
    assert result.converged == (result.mu_macro_error <= 2e-2)


@pytest.mark.slow
@pytest.mark.parametrize("reading", ["cells", "samples"])
@pytest.mark.parametrize(("count", "shift"), [(8, 0.0), (16, 0.3), (32, 0.5)])
def test_so_it_does_where_the_edge_lies_between_the_points(tmp_path, count, shift, reading):
    """Friction of a rotation depends on the size of the contact, which is smaller than the grid
    here."""
    axis = (np.arange(-count // 2 - 2, count // 2 + 3) + shift) * 2.0 / count
    file = csv(tmp_path / "p.csv", axis, axis, sphere(axis[:, None], axis[None, :]))
    truth = microslip.solve("bore", 0.5, 1.0, tolerance=5e-3)
    result = microslip.solve("bore", 0.5, 1.0, pressure=f"{file},grid={reading}", tolerance=3e-2)
    assert abs(result.mu_macro - truth.mu_macro) <= result.mu_macro_error + truth.mu_macro_error


@pytest.mark.slow
def test_a_file_too_coarse_for_the_tolerance_is_not_converged(tmp_path):
    axis = np.linspace(-0.75, 0.75, 4)
    file = csv(tmp_path / "p.csv", axis, axis, sphere(axis[:, None], axis[None, :]))
    result = microslip.solve("transverse", 0.1, 0.5, pressure=file, tolerance=1e-2)
    assert not result.converged
    assert result.mu_macro_error > 1e-2
    assert (
        f"the file's own resolution leaves {result.friction.by_source['model']:.1e} open"
        in result.reason
    )


def test_sliding_fast_needs_no_resolution(tmp_path):
    """A fast sliding contact is rigid for any pressure."""
    file = csv(tmp_path / "p.csv", *2 * [np.array([-0.5, 0.5])], np.array([[1.0, 2.0], [3.0, 4.0]]))
    result = microslip.solve("transverse", 1e3, 0.5, pressure=file, tolerance=1e-3)
    assert result.converged
    assert result.mu_macro == pytest.approx(1.0, abs=1e-3)
    marched = microslip.solve(
        "transverse", 20.0, 0.5, pressure=file, tolerance=1e-2, cells=8, steps=32
    )
    rigid = microslip.solve("transverse", 20.0, 0.5, model="rigid")
    assert abs(marched.mu_macro - rigid.mu_macro) <= 1e-3


# Formats of files


@pytest.mark.long
def test_a_pressure_that_is_not_symmetric_is_marched_over_the_whole_period(tmp_path):
    values = HERTZIAN * (1.0 + 0.5 * AXIS)
    name = csv(tmp_path / "p.csv", values=values)
    problem = Problem(motion_named("bore"), 0.1, 1.0, pressure=pressure_named(name))
    assert not problem.half_period_mirror
    assert problem.turns == pytest.approx((-np.pi / 2, np.pi / 2, 1.5 * np.pi))
    result = microslip.solve("bore", 0.3, 1.0, pressure=name, tolerance=4e-2)
    mirrored = csv(tmp_path / "m.csv", values=values[:, ::-1])
    other = microslip.solve("bore", 0.3, 1.0, pressure=mirrored, tolerance=4e-2)
    assert result.converged
    # the mirror image of the motion is the motion half a period later
    assert result.mu_macro == pytest.approx(other.mu_macro, abs=1e-3)


PLAIN = "forward,lateral,pressure\n0,0,1\n0,1,2\n1,0,3\n1,1,4\n"
BOM = b"\xef\xbb\xbf"


@pytest.mark.slow
@pytest.mark.parametrize(
    "content",
    [
        "# sensor\nforward,lateral,pressure\n# first row\n0,0,1\n0,1,2\n\n1,0,3\n1,1,4\n# end",
        BOM + PLAIN.encode(),
        BOM + b"# sensor\r\n" + PLAIN.replace("\n", "\r\n").encode(),
        PLAIN.replace("\n", "\r"),
        "\n \n" + PLAIN.replace("\n", "\n\n"),
        PLAIN.replace("forward,lateral,pressure", '"forward","lateral", "pressure"'),
        PLAIN.replace("forward,lateral,pressure", "Forward [mm],Lateral [mm],Pressure [MPa]"),
        PLAIN.replace("forward,lateral,pressure", "forward[um], lateral [um] ,pressure [N/mm^2]"),
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        PLAIN.replace(",", " ; "),
        "pressure,lateral,forward\n1,0,0\n2,1,0\n3,0,1\n4,1,1\n",
        "forward,lateral,pressure\n1,1,4\n0,1,2\n1,0,3\n0,0,1\n",
        "forward [mm],lateral [um],pressure\n0,0,1\n0,1000,2\n1,0,3\n1,1000,4\n",
        "forward,lateral,pressure\n0,0,1\n0,.1e1,+2.\n1.0000000000001,0,3\n1,1,4E0",
    ],
)
def test_what_csv_may_look_like(tmp_path, content):
    loads = pressure_named(text(tmp_path / "p.csv", content)).cell_loads(2)
    assert loads == pytest.approx(np.array([[0.1, 0.2], [0.3, 0.4]]), abs=1e-12)


def test_a_spreadsheet_with_decimal_commas_in_windows_1252_is_read_if_declared(tmp_path):
    """Empty rows and columns at the end, as written by spreadsheets, are ignored."""
    rows = ["forward [mm];lateral [µm];pressure;;"]
    rows += ["0,0;0;1,0;;", "0;1000;2;;", "1,0;0;3;;", "1;1000,0;4,0;;", ";;;;", ";;;;"]
    (tmp_path / "p.csv").write_bytes("\r\n".join(rows).encode("cp1252"))
    name = f"file:{tmp_path / 'p.csv'},decimal=comma,encoding=cp1252"
    record = pressure_named(name)
    assert record.cell_loads(2) == pytest.approx(np.array([[0.1, 0.2], [0.3, 0.4]]), abs=1e-12)
    assert record.name.endswith(",decimal=comma,encoding=cp1252")
    assert "line 1: byte 0xb5 is not UTF-8" in refusal(f"file:{tmp_path / 'p.csv'},decimal=comma")
    assert "decimal is point or comma" in refusal(f"file:{tmp_path / 'p.csv'},decimal=dot")
    assert "such as utf-8 or cp1252" in refusal(f"file:{tmp_path / 'p.csv'},encoding=klingon")


# Matrices without coordinates

TEKSCAN = """DATA_TYPE FRAME
ROWS 3
COLS 4
ROW_SPACING 0.5 mm
ASCII_DATA @@

Frame 1
B,B,0,0
B,1,2,0
0,3,4,0
@@
"""
MATRIX_LOADS = np.array([[0.1, 0.2], [0.3, 0.4]])


@pytest.mark.parametrize(
    ("content", "options"),
    [
        ("1,2\n3,4\n", ""),
        ("# film, 2 x 2\n\n1 2\n3 4\n", ""),
        ("1.0\t2.0\t\r\n3.0\t4.0\t\r\n", ""),
        ("left;right\n1,0; 2,0\n3,0; 4,0\n;;\n", ",decimal=comma"),
        ("1,0 2,0\n3,0 4,0\n", ",decimal=comma"),
        ("1;2,000\n3;4\n", ",decimal=comma"),
        ("1,2.000\n3,4\n", ""),
        (BOM + b"1,2\n3,4", ""),
        (TEKSCAN, ""),
        (TEKSCAN.replace("\n", "\r\n"), ""),
    ],
)
def test_a_matrix_is_read_with_forward_down_the_lines(tmp_path, content, options):
    name = f"{text(tmp_path / 'p.csv', content)},pitch=0.5 mm{options}"
    assert pressure_named(name).cell_loads(2) == pytest.approx(MATRIX_LOADS, abs=1e-12)


def test_a_matrix_is_the_grid_with_these_coordinates(tmp_path):
    """Cells of 0.5 mm x 1 mm are those of the same file with coordinates."""
    values = np.array([[1.0, 2.0, 3.0], [4.0, 7.0, 5.0]])
    np.savetxt(tmp_path / "m.txt", values)
    grid = pressure_named(csv(tmp_path / "p.csv", [0.0, 0.5], [0.0, 1.0, 2.0], values))
    for pitch in ("0.5 mm x 1 mm", "0.5 mm x 0.1 cm", "500 um x 1 mm", "0.5 x 1"):
        matrix = pressure_named(f"file:{tmp_path / 'm.txt'},pitch={pitch}")
        assert matrix.cell_loads(12) == pytest.approx(grid.cell_loads(12), abs=1e-15), pitch
        assert f",pitch={pitch}" in matrix.name


def test_the_units_of_a_file_give_its_size_and_its_load(tmp_path):
    """A uniform pressure of 5 MPa on 3 x 2 cells of 0.5 mm x 1 mm is 15 N on 1.5 mm x 2 mm."""
    head = "forward [mm],lateral [um],pressure [N/mm^2]\n"
    rows = [f"{x},{y},5\n" for x in (0.0, 0.5, 1.0) for y in (0, 1000)]
    record = pressure_named(text(tmp_path / "p.csv", head + "".join(rows)))
    assert record.size_m == pytest.approx(1e-3, rel=1e-12)
    assert record.load_N == pytest.approx(15.0, rel=1e-12)
    for other in record.readings[1:]:
        assert other.load_N == pytest.approx(15.0, rel=1e-12)
    samples = pressure_named(f"file:{tmp_path / 'p.csv'},grid=samples")
    assert samples.size_m == pytest.approx(0.5e-3, rel=1e-12)  # from point to point
    assert samples.load_N == pytest.approx(5.0, rel=1e-12)
    units = {"forward": "um", "lateral": "um"}
    assert pressure_named(netcdf(tmp_path / "p.nc", units=units)).load_N is None
    text(tmp_path / "m.csv", "1,1\n1,1\n")
    assert pressure_named(f"file:{tmp_path / 'm.csv'},pitch=2 um").size_m == pytest.approx(2e-6)
    assert pressure_named(f"file:{tmp_path / 'm.csv'},pitch=2").size_m is None


@pytest.mark.parametrize(
    ("content", "options", "problem"),
    [
        ("", "pitch=1 mm", "no row of numbers"),
        ("0,5;1,2\n0,5;1,2\n", "pitch=1 mm", "line 1: '0,5' has a decimal comma"),
        ("0.5;1.2\n0.5;1.2\n", "pitch=1 mm,decimal=comma", "no points where commas are decimal"),
        ("1,2\n3\n", "pitch=1 mm", "line 2: 1 cells, but 2 in line 1"),
        ("1,2\n3,x\n", "pitch=1 mm", "line 2: pressure is 'x'; allowed: a number"),
        ("1,\n3,4\n", "pitch=1 mm", "line 1: cell 2 is empty"),
        ("1,x\n3,4\n5,6\n", "pitch=1 mm", "line 1: 'x' between numbers"),
        ("1,,2\n3,4,5\n", "pitch=1 mm", "line 1: cell 2 is empty"),
        ("1,2\n3,-4\n", "pitch=1 mm", "line 2: pressure is -4; allowed: a finite number"),
        ("1,2\n3,nan\n", "pitch=1 mm", "line 2: pressure is nan"),
        ("1,2\n\n3,4\n", "pitch=1 mm", "line 2: no row of the matrix"),
        ("1,2\n# x\n3,4\n", "pitch=1 mm", "line 2: no row of the matrix"),
        ("1;1.100\n900;1\n", "pitch=1 mm", "part thousands"),
        ("1,2\n", "pitch=1 mm", "a matrix of 1 x 2; allowed: two rows and two columns"),
        (TEKSCAN.replace("@@\n", "Frame 2\n", 2), "pitch=1 mm", "line 11: 2 cells, but 4"),
        ("x,0,1,2,3\n0,5,6,8,5\n1,5,7,8,5\n", "pitch=1 mm", "line 1: 'x' between numbers"),
        ("0,0,.33,.67,1\n0,5,6,8,5\n1,5,7,8,5\n", "pitch=1 mm", "first row look like coordinates"),
        ("9,4\n3,6\n2,8\n1,5\n0,6\n", "pitch=1 mm", "first column look like coordinates"),
        (PLAIN, "pitch=1 mm", "line 1: a heading of columns; allowed without pitch only"),
        ("1,2\n3,4\n", "pitch=-1 mm", "pitch is '-1 mm'; allowed: a length such as 0.5 mm"),
        ("1,2\n3,4\n", "pitch=0 mm", "pitch is '0 mm'"),
        ("1,2\n3,4\n", "pitch=1 mm x 1 mm x 1 mm", "pitch is '1 mm x 1 mm x 1 mm'"),
        ("1,2\n3,4\n", "pitch=1 N", "[N] is no known unit of length"),
        ("1,2\n3,4\n", "pitch=1 mm x 2", "forward alone has a unit"),
        ("1,2\n3,4\n", "pitch=1 mm,pitch=1 mm", "pitch occurs twice"),
        ("1,2\n3,4\n", "pitch=0,5 mm", "allowed after the path: grid=cells or grid=samples, and"),
        ("1,2\n3,4\n", "grid=cells", "or a matrix of pressures alone, with pitch=0.5 mm"),
        (b"CDF\x01", "pitch=1 mm", "pitch is for a matrix in a CSV file"),
    ],
)
def test_a_file_that_is_no_clear_matrix_is_refused(tmp_path, content, options, problem):
    assert problem in refusal(f"{text(tmp_path / 'p.csv', content)},{options}")


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("", "line 1: the heading is ''; allowed: forward,lateral,pressure"),
        ("x,y,p\n0,0,1\n", "line 1: the heading is 'x,y,p'; allowed: forward,lateral,pressure"),
        ("# x\n0,0,1\n", "line 2: the heading is '0,0,1'"),
        ("forward,lateral\n0,0\n", "line 1: the heading is 'forward,lateral'"),
        ("forward,lateral,pressure,pressure\n", "line 1: the heading"),
        (HEAD, "no points"),
        (HEAD + "0,0,a\n", "line 2: pressure is 'a'; allowed: a number"),
        (HEAD + "0,0,1_0\n", "line 2: pressure is '1_0'; allowed: a number"),
        (HEAD + "0,0,\n", "line 2: pressure is ''; allowed: a number"),
        (HEAD + "0,0\n", "line 2: 2 cells; allowed: 3"),
        (HEAD + "0,5,0,1\n", "line 2: 4 cells; allowed: 3"),
        ("forward;lateral;pressure\n0;0;1\n0,5;0;1\n", "line 3: '0,5' has a decimal comma"),
        ("forward\tlateral\tpressure\n0\t0\t1,5\n", "line 2: '1,5' has a decimal comma"),
        (HEAD + "0,0,1\n0,1,1\n1,0,1\n", "3 points do not fill a grid of 2 x 2, there is none at "),
        (HEAD + "0,0,1\n0,1,1\n1,0,1\n1,1", "line 5: 2 cells; allowed: 3"),
        (HEAD + "0,0,1\n0,1,1\n1,0,1\n1,1,-1\n", "line 5: pressure is -1; allowed: a finite"),
        (HEAD + "0,0,0\n0,1,0\n1,0,0\n1,1,0\n", "it is 0 everywhere"),
        (HEAD + "0,0,1\n# x\n0,1,nan\n", "line 4: pressure is nan; allowed: a finite number"),
        (HEAD + "0,0,1\n0,NaN,1\n", "line 3: lateral is nan; allowed: a finite number"),
        (HEAD + "0,0,1\n0,1,inf\n", "line 3: pressure is inf"),
        (HEAD + "0,0,1\n0,1,1e999\n", "line 3: pressure is 1e999"),
        (HEAD + "0,0,1\n0,1,1\n1,0,1\n1,1,1\n3,0,1\n3,1,1\n", "forward = '1, 3': not even"),
        (HEAD + "0,0,1\n0,1,1\n", "forward = '0': not evenly spaced; allowed: two coordinates"),
        (HEAD + "0,0,1\n0,1,1\n1,0,1\n0,1,1\n", "line 5: the same point as in line 3"),
        ("forward [mm],lateral,pressure\n0,0,1\n", "forward alone has a unit"),
        (
            "forward [mm],lateral [foo],pressure\n0,0,1\n",
            "lateral [foo] is no known unit of length",
        ),
        ("forward [mm],lateral [s],pressure\n0,0,1\n", "lateral [s] is no known unit of length"),
        ("forward [mm],lateral [1],pressure\n0,0,1\n", "are not the same kind"),
        ("forward,lateral,pressure [N]\n0,0,1\n", "pressure [N] is no known unit of pressure"),
        (HEAD.encode() + b"0,0,1\n0,1,\xb5\n", "line 3: byte 0xb5 is not UTF-8"),
        (PLAIN.encode("utf-16"), "line 1: UTF-16; allowed: UTF-8"),
        (HEAD + "0,0,1\n\0", "line 3: not text"),
        (b"\x1f\x8b\x08\x00", "packed (gzip); allowed: CSV or netCDF as it is"),
        (b"PK\x03\x04abc", "packed (zip, as spreadsheets are)"),
    ],
)
def test_what_csv_must_not_hold_is_told_in_one_line(tmp_path, capsys, content, problem):
    name = text(tmp_path / "p.csv", content)
    assert main([*POINT, "--pressure", name]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert problem in message
    assert "p.csv" in message


def test_huge_files_folders_and_pipes_are_refused_unread(tmp_path, monkeypatch):
    assert "a folder" in refusal(f"file:{tmp_path}")
    monkeypatch.setattr(named_files, "MOST_BYTES", 20)
    assert "larger than" in refusal(text(tmp_path / "p.csv", PLAIN))
    monkeypatch.undo()
    monkeypatch.setattr("microslip.pressures.grid_csv.MOST_POINTS", 3)
    assert "line 5: more than 3 points" in refusal(text(tmp_path / "p.csv", PLAIN))
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        assert "not a regular file" in refusal(f"file:{tmp_path / 'pipe'}")


@pytest.mark.slow
def test_netcdf_is_read_with_its_units_whatever_its_name(tmp_path):
    values, axis = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([0.0, 1.0])
    units = {"forward": "mm", "lateral": "um", "pressure": "MPa"}
    netcdf(tmp_path / "p.nc", axis[::-1], 1e3 * axis, values[::-1], units)
    (tmp_path / "p.nc").rename(tmp_path / "p.dat")
    loads = pressure_named(f"file:{tmp_path / 'p.dat'}").cell_loads(2)
    assert loads == pytest.approx(values / 10.0, abs=1e-12)
    data = xr.load_dataset(tmp_path / "p.dat")
    data.transpose("lateral", "forward").to_netcdf(tmp_path / "q.nc", format="NETCDF3_CLASSIC")
    loads = pressure_named(f"file:{tmp_path / 'q.nc'}").cell_loads(2)
    assert loads == pytest.approx(values / 10.0, abs=1e-12)


@pytest.mark.slow
def test_sizes_that_netcdf_declares_are_checked_before_they_are_read(tmp_path):
    """A file of some kB can declare more data than any memory can hold."""

    def declared(rows, chunk):
        path = tmp_path / "p.nc"
        with netCDF4.Dataset(path, "w") as file:
            file.createDimension("forward", rows)
            file.createDimension("lateral", 4)
            file.createVariable("forward", "f8", ("forward",), chunksizes=chunk[:1])
            file.createVariable("lateral", "f8", ("lateral",))
            file.createVariable("pressure", "f8", ("forward", "lateral"), chunksizes=chunk)
        assert path.stat().st_size < 20_000
        return f"file:{path}"

    message = refusal(declared(10**12, (1024, 4)))
    assert "the dimension forward has 1000000000000 points; allowed: at most 1000000" in message
    message = refusal(declared(None, (10**8, 4)))
    assert "forward is stored in chunks of 100000000; allowed" in message


def test_scattered_points_do_not_make_a_huge_grid(tmp_path, monkeypatch):
    """For n points on a diagonal, the grid would have n x n points."""
    monkeypatch.setattr("microslip.pressures.grid_csv.MOST_POINTS", 10)
    monkeypatch.setattr(np, "full", lambda *args: pytest.fail("it was allocated"))
    lines = "".join(f"{i},{i},1\n" for i in range(5))
    message = refusal(text(tmp_path / "p.csv", f"forward,lateral,pressure\n{lines}"))
    assert "5 points do not fill a grid of 5 x 5" in message


@pytest.mark.slow
def test_what_netcdf_must_not_hold_is_told_in_one_line(tmp_path):
    axis, one = [0.0, 1.0], np.ones((2, 2))

    def message(variables, **coordinates):
        xr.Dataset(variables, coordinates).to_netcdf(tmp_path / "p.nc")
        return refusal(f"file:{tmp_path / 'p.nc'}")

    dims = ("forward", "lateral")
    both = {"forward": axis, "lateral": axis}
    holed = np.array([[1.0, np.nan], [1.0, 1.0]])
    assert "nan: at forward 0, lateral 1" in message({"pressure": (dims, holed)}, **both)
    assert "pressure = -1.0: at forward 0" in message({"pressure": (dims, -one)}, **both)
    assert "no variable lateral" in message({"pressure": (dims, one)}, forward=axis)
    assert "no variable pressure" in message({"load": (dims, one)}, **both)
    assert "pressure has the dimensions time, forward, lateral" in message(
        {"pressure": (("time", *dims), one[None])}, **both
    )
    assert "forward = 'nan'" in message(
        {"pressure": (dims, one)}, forward=[0.0, np.nan], lateral=axis
    )
    assert "not evenly spaced" in message(
        {"pressure": (dims, one)}, forward=[1.0, 1.0], lateral=axis
    )
    assert "pressure holds" in message({"pressure": (dims, np.full((2, 2), "a"))}, **both)
    assert "lateral alone has a unit" in message(
        {"pressure": (dims, one)}, forward=axis, lateral=("lateral", axis, {"units": "mm"})
    )
    assert "not a netCDF file" in refusal(text(tmp_path / "q.nc", b"\x89HDF\r\n\x1a\n no netCDF"))
    name = text(tmp_path / "junk.nc", b"\x89\xff\xb5 no netCDF")
    assert "not a netCDF file" in refusal(name)


# Names and paths


@pytest.mark.slow
def test_a_file_is_found_without_any_other_import(tmp_path):
    """The file is read in a new process that imports one module."""
    name = csv(tmp_path / "p.csv", *2 * [np.array([0.0, 1.0])], np.ones((2, 2)))
    script = (
        "from microslip.adaptive.checks import checked_problem\n"
        f"problem = checked_problem('transverse', 0.5, 0.5, pressure={name!r})\n"
        "print(problem.pressure)"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith("file:sha256=")


def test_one_file_by_many_paths_is_one_pressure(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = csv(tmp_path / "p.csv", *2 * [np.array([0.0, 1.0])], np.ones((2, 2)))
    (tmp_path / "link.csv").symlink_to(tmp_path / "p.csv")
    (tmp_path / "copy, of=it.csv").write_bytes((tmp_path / "p.csv").read_bytes())
    paths = ("file:p.csv", "file:./p.csv", "file:link.csv", "file:copy, of=it.csv", name)
    records = [pressure_named(path) for path in paths]
    records += [pressure_named(f"{name},grid=cells"), pressure_named(records[0].name)]
    assert all(record is records[0] for record in records)
    assert str(tmp_path) not in records[0].name
    assert pressure_named("file:p.csv,grid=samples").name == f"{records[0].name},grid=samples"


@pytest.mark.slow
def test_a_file_that_changes_is_another_pressure(tmp_path):
    name = csv(tmp_path / "p.csv")
    result = pressure_named(name)
    digest = result.name.partition(":")[2]
    assert pressure_named(f"{name},{digest}") is result
    csv(tmp_path / "p.csv", values=2.0 * HERTZIAN + HERTZIAN**2)
    for past in (f"{name},{digest}", result.name):
        assert "has changed: its sha256 begins with" in refusal(past)
    assert pressure_named(name).name != result.name


def test_names_that_name_no_file_are_refused(tmp_path):
    assert "cannot be read: No such file; looked for" in refusal(f"file:{tmp_path / 'none.csv'}")
    assert "allowed is a file, as in file:measured.csv" in refusal("file:")
    assert "allowed for grid is one of cells, samples" in refusal(
        text(tmp_path / "p.csv", PLAIN) + ",grid=points"
    )
    assert "grid occurs twice" in refusal("file:p.csv,grid=cells,grid=cells")
    assert "grid=cells or grid=samples" in refusal("file:p.csv,gird=cells")
    assert "no file with this content is known here" in refusal("file:sha256=0000000000000000")
