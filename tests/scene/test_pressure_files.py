"""Pressures from files: their meaning, the error due to the grid, formats, and bad input."""

import netCDF4
import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.foundation import named_files
from microslip.foundation.errors import InputError
from microslip.scene import files
from microslip.scene.by_name import pressure_named
from microslip.scene.pressure import Measured

AXIS = np.linspace(-1.25, 1.25, 51)
HERTZIAN = np.sqrt(np.maximum(1.0 - AXIS[:, None] ** 2 - AXIS**2, 0.0))
HEAD = "forward,lateral,pressure\n"
READINGS = ["cells", "samples"]


def text(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return f"file:{path}"


def csv(path, forward=AXIS, lateral=AXIS, values=HERTZIAN):
    points = ((x, y, values[i, j]) for i, x in enumerate(forward) for j, y in enumerate(lateral))
    return text(path, HEAD + "".join(f"{x:.15g},{y:.15g},{p:.15g}\n" for x, y, p in points))


def netcdf(path, variables, **coordinates):
    xr.Dataset(variables, coordinates).to_netcdf(path)
    return f"file:{path}"


def refusal(name):
    with pytest.raises(InputError) as refused:
        pressure_named(name)
    assert refused.value.argument == "pressure"
    assert "\n" not in str(refused.value)
    return str(refused.value)


# Meaning of a grid


@pytest.mark.slow
@pytest.mark.parametrize("reading", READINGS)
def test_a_uniform_square_is_one_pressure_at_any_resolution(reading):
    """The torque is the mean distance from the centre of the square, and u_lim the displacement at
    the centre."""
    for count in (2, 3, 41):
        axis = np.linspace(3.0, 7.0, count)
        square = Measured.on_grid("square", axis, axis, np.full((count, count), 5.0), reading)
        assert square.torque == pytest.approx((np.sqrt(2.0) + np.arcsinh(1.0)) / 3.0, abs=1e-12)
        # (1/pi) Integral of 1/distance over [-1, 1]^2 at load 1, for cells next to the centre
        assert square.G_star == pytest.approx(2.0 * np.arcsinh(1.0) / np.pi, abs=2e-5)
        for other in (square, *square.readings):
            assert other.cell_loads(7) == pytest.approx(np.full((7, 7), 1.0 / 49.0), abs=1e-14)
            assert other.G_star == pytest.approx(square.G_star, rel=1e-12)
            assert other.torque == pytest.approx(square.torque, rel=1e-12)


def test_cells_are_even_up_to_half_a_step_beyond_the_points():
    values = np.array([[1.0, 2.0], [3.0, 4.0]])
    pressure = Measured.on_grid("four", [0.0, 1.0], [5.0, 6.0], values)
    assert pressure.cell_loads(2) == pytest.approx(values / 10.0, abs=1e-14)
    assert pressure.cell_loads(4) == pytest.approx(np.kron(values, np.ones((2, 2))) / 40.0)
    # mean distance of a unit square from its corner, for any loads
    assert pressure.torque == pytest.approx((np.sqrt(2.0) + np.arcsinh(1.0)) / 3.0, abs=1e-12)
    around = np.zeros((5, 5))
    around[1:3, 2:4] = values
    outside = Measured.on_grid("four", np.arange(-1.0, 4.0), np.arange(-2.0, 3.0), around)
    assert outside.cell_loads(6) == pytest.approx(pressure.cell_loads(6), abs=1e-14)


def test_samples_are_bilinear_between_the_points_and_end_there():
    """For p = 1 + x on [0, 1]^2 the two halves carry 5/12 and 7/12 of the load."""
    values = np.array([[1.0, 1.0], [2.0, 2.0]])
    pressure = Measured.on_grid("ramp", [0.0, 1.0], [0.0, 1.0], values, "samples")
    assert pressure.cell_loads(2).sum(axis=1) == pytest.approx([5.0 / 12.0, 7.0 / 12.0], abs=1e-14)
    assert pressure.cell_loads(2).sum(axis=0) == pytest.approx([0.5, 0.5], abs=1e-14)


# Error due to the grid


def sphere(x, y):
    return np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))


def cone(x, y):
    """Pressure of a cone (Love), cut off at a quarter of a step from the centre."""
    step = x.ravel()[1] - x.ravel()[0]
    return np.arccosh(1.0 / np.clip(np.hypot(x, y), 0.25 * step, 1.0))


SLOW, TURNING = ("transverse", 0.1, 0.5), ("bore", 0.5, 1.0)
TRUTHS = [
    (SLOW, 2e-2, "hertz", sphere, (np.arange(8) + 0.5) / 4.0 - 1.0),
    (SLOW, 2e-2, "power:exponent=1", cone, (np.arange(16) + 0.5) / 8.0 - 1.0),
    # friction of a rotation depends on the size of the contact, which is smaller than the grid
    (TURNING, 3e-2, "hertz", sphere, np.arange(-6, 7) / 4.0),
    (TURNING, 3e-2, "hertz", sphere, np.arange(-17.5, 19.0) / 16.0),
]


@pytest.mark.slow
@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize(("place", "tolerance", "name", "shape", "axis"), TRUTHS)
def test_the_error_covers_the_resolution_of_a_file(
    tmp_path, place, tolerance, name, shape, axis, reading
):
    file = csv(tmp_path / "p.csv", axis, axis, shape(axis[:, None], axis[None, :]))
    truth = microslip.solve(*place, pressure=name)
    result = microslip.solve(*place, pressure=f"{file},grid={reading}", tolerance=tolerance)
    assert result.friction.by_source["model"] > 0.0
    assert abs(result.mu_macro - truth.mu_macro) <= result.mu_macro_error + truth.mu_macro_error
    assert result.converged == (result.mu_macro_error <= tolerance)


# Formats of files

PLAIN = HEAD + "0,0,1\n0,1,2\n1,0,3\n1,1,4\n"
BOM = b"\xef\xbb\xbf"
TEKSCAN = "\n".join(
    ["DATA_TYPE MOVIE", "ROWS 2", "COLS 2", "UNITS MPa", "", "Frame 1", "1.0,2.0", "3.0,4.0", "@@"]
)
LOADS = np.array([[1.0, 2.0], [3.0, 4.0]]) / 10.0


@pytest.mark.parametrize(
    ("content", "options"),
    [
        ("# sensor\n" + HEAD + "# first row\n0,0,1\n0,1,2\n\n1,0,3\n1,1,4\n# end", ""),
        (BOM + PLAIN.replace("\n", "\r\n").encode(), ""),
        (PLAIN.replace(HEAD, "forward[um], lateral [mm] ,pressure\n"), ""),
        ("lateral;pressure;forward\n0,0;1;0\n1,0;2;0\n0;3;1\n1;4;1\n", ",decimal=comma"),
        (HEAD + "1,1,4\n0,0,1\n1,0,3\n0,1,2\n", ""),
        ("# film, 2 x 2\n\n1 2\n3 4\n", ",pitch=0.5 mm"),
        ("left;right\n1,0; 2,0\n3,0; 4,0\n;;\n", ",pitch=0.5 mm,decimal=comma"),
        ("1,0 2,0\n3,0 4,0\n", ",pitch=0.5 mm,decimal=comma"),
        ("1;2,000\n3;4\n", ",pitch=0.5 mm,decimal=comma"),
        ('"1,0","2,0"\n"3,0","4,0"\n', ",pitch=0.5 mm,decimal=comma"),
        (TEKSCAN.replace("2.0", "2.0,B").replace("4.0", "4.0,B"), ",pitch=0.5 mm"),
    ],
)
def test_a_grid_is_read_with_forward_down_the_lines(tmp_path, content, options):
    pressure = pressure_named(text(tmp_path / "p.csv", content) + options)
    values = pressure.grid.values  # without the zeros around the pressure
    assert values / values.sum() == pytest.approx(LOADS, rel=1e-12)


def test_a_matrix_is_the_grid_with_these_coordinates(tmp_path):
    values = np.array([[1.0, 2.0, 3.0], [4.0, 7.0, 5.0]])
    np.savetxt(tmp_path / "m.txt", values)
    grid = pressure_named(csv(tmp_path / "p.csv", [0.0, 0.5], [0.0, 1.0, 2.0], values))
    for pitch in ("0.5 mm x 1 mm", "0.5 mm x 0.1 cm", "500 um x 1 mm", "0.5 x 1"):
        matrix = pressure_named(f"file:{tmp_path / 'm.txt'},pitch={pitch}")
        assert matrix.cell_loads(12) == pytest.approx(grid.cell_loads(12), abs=1e-15), pitch
        assert matrix.half_widths == pytest.approx(grid.half_widths), pitch
        assert f",pitch={pitch}" in matrix.name


def test_the_units_of_a_file_give_its_size_and_its_load(tmp_path):
    """A uniform pressure of 5 MPa on 3 x 2 cells of 0.5 mm x 1 mm is 15 N on 1.5 mm x 2 mm."""
    head = "forward [mm],lateral [um],pressure [N/mm^2]\n"
    rows = [f"{x},{y},5\n" for x in (0.0, 0.5, 1.0) for y in (0, 1000)]
    record = pressure_named(text(tmp_path / "p.csv", head + "".join(rows)))
    assert (record.size_m, record.load_N) == pytest.approx((1e-3, 15.0), rel=1e-12)
    _, half = record.readings
    assert half.load_N == pytest.approx(15.0, rel=1e-12)
    samples = pressure_named(f"file:{tmp_path / 'p.csv'},grid=samples")  # from point to point
    assert (samples.size_m, samples.load_N) == pytest.approx((0.5e-3, 5.0), rel=1e-12)
    text(tmp_path / "m.csv", "1,1\n1,1\n")
    matrix = pressure_named(f"file:{tmp_path / 'm.csv'},pitch=2 um")
    assert (matrix.size_m, matrix.load_N) == (pytest.approx(2e-6), None)
    assert pressure_named(f"file:{tmp_path / 'm.csv'},pitch=2").size_m is None


@pytest.mark.slow
def test_netcdf_is_read_with_its_units_whatever_its_name(tmp_path):
    dims, values = ("forward", "lateral"), np.array([[3.0, 4.0], [1.0, 2.0]])
    axes = {"forward": [1.0, 0.0], "lateral": ("lateral", [0.0, 1e3], {"units": "um"})}
    axes["forward"] = ("forward", [1.0, 0.0], {"units": "mm"})
    netcdf(tmp_path / "p.nc", {"pressure": (dims, values, {"units": "MPa"})}, **axes)
    (tmp_path / "p.nc").rename(tmp_path / "p.dat")
    data = xr.load_dataset(tmp_path / "p.dat").transpose("lateral", "forward")
    data.to_netcdf(tmp_path / "q.nc", format="NETCDF3_CLASSIC")
    for name in ("p.dat", "q.nc"):
        pressure = pressure_named(f"file:{tmp_path / name}")
        assert pressure.cell_loads(2) == pytest.approx(LOADS, abs=1e-12)
        assert pressure.load_N == pytest.approx(10.0)


# Refusals

PITCH = ",pitch=1 mm"
GRID = HEAD + "0,0,1\n0,1,1\n1,0,1\n"
BAD = [
    ("", PITCH, "no row of numbers"),
    ("0,5;1,2\n0,5;1,2\n", PITCH, "decimal comma"),
    ("0.5;1.2\n0.5;1.2\n", PITCH + ",decimal=comma", "no points where commas are decimal"),
    ("1;1.100\n900;1\n", PITCH, "part thousands"),
    ("1,2\n3\n", PITCH, "line 2: 1 cells, but 2"),
    (",2,3,\n1,2,3,1\n1,2,3,1\n", PITCH, "line 1: cell 1 is empty"),
    ("1,<0.5\n3,4\n5,6\n", PITCH, "line 1: cell 2 is '<0.5' in a line with numbers"),
    (",0,1,2\n0,5,6,7\n1,8,9,9\n", PITCH, "line 1: cell 1 is '', as in a line of coordinates"),
    ("0,05,1,00\n1,50,2,00\n", PITCH, "line 1: digits after a zero, as if commas were decimal"),
    ('"0,5",1\n1,2\n', PITCH, "line 1, cell 1: '0,5' has a decimal comma"),
    ("1,2\n3,-4\n", PITCH, "line 2, cell 2: pressure is -4; allowed: a finite number"),
    ("1,2\n# x\n3,4\n", PITCH, "line 2: no row of the matrix"),
    ("1,2\n", PITCH, "a matrix of 1 x 2"),
    ("0,0,.33,.67,1\n0,5,6,8,5\n1,5,7,8,5\n", PITCH, "first row look like coordinates"),
    ("9,4\n3,6\n2,8\n1,5\n0,6\n", PITCH, "first column look like coordinates"),
    ("1,2\n3,4\n", ",pitch=0 mm", "pitch is '0 mm'"),
    ("1,2\n3,4\n", ",pitch=1 N", "[N] is no known unit"),
    ("1,2\n3,4\n", ",pitch=1 mm x 2", "forward alone has a unit"),
    ("1,2\n3,4\n", PITCH + PITCH, "pitch occurs twice"),
    ("1,2\n3,4\n", "", "a matrix of pressures alone, with pitch=0.5 mm"),
    (b"CDF\x01", PITCH, "pitch is for a matrix in a CSV file"),
    ("x,y,p\n0,0,1\n", "", "line 1: the heading is 'x,y,p'"),
    (HEAD, "", "no points"),
    (HEAD + "0,0,\n", "", "line 2: pressure is ''; allowed: a number"),
    (HEAD + "0,0\n", "", "line 2: 2 cells; allowed: 3"),
    (GRID, "", "no line is the point forward 1, lateral 1 of a grid"),
    (GRID + "0,1,1\n", "", "lines 3 and 5 are the point forward 0, lateral 1"),
    (GRID + "1,1,-1\n", "", "line 5: pressure is -1; allowed: a finite"),
    (GRID + "1,1,1\n3,0,1\n3,1,1\n", "", "forward = '1, 3': not even"),
    (HEAD + "0,0,0\n0,1,0\n1,0,0\n1,1,0\n", "", "it is 0 everywhere"),
    (HEAD + "0,0,1\n0,NaN,1\n", "", "line 3: lateral is nan; allowed: a finite number"),
    (HEAD + "0,0,1\n0,1e20,2\n1,0,3\n1,1e20,4\n", "", "allowed are steps in one unit"),
    ("forward [mm],lateral,pressure\n0,0,1\n", "", "forward alone has a unit"),
    ("forward,lateral,pressure [N]\n0,0,1\n", "", "pressure [N] is no known unit"),
    (b"\x89HDF\r\n\x1a\n no netCDF", "", "not a netCDF file"),
    (PLAIN, ",grid=points", "allowed for grid is one of cells, samples"),
]


@pytest.mark.parametrize(("content", "options", "problem"), BAD)
def test_a_file_that_is_no_clear_grid_is_refused(tmp_path, content, options, problem):
    message = refusal(text(tmp_path / "p.csv", content) + options)
    assert problem in message and "p.csv" in message


DIMS, EDGES, ONE = ("forward", "lateral"), {"forward": [0.0, 1.0], "lateral": [0.0, 1.0]}, np.eye(2)
BAD_NETCDF = [
    ({"pressure": (DIMS, np.array([[1, np.nan], [1, 1]]))}, {}, "nan: at forward 0, lateral 1"),
    ({"load": (DIMS, ONE)}, {}, "no variable pressure"),
    ({"pressure": (("time", *DIMS), ONE[None])}, {}, "has the dimensions time, forward, lateral"),
    ({"pressure": (DIMS, ONE)}, {"forward": [1.0, 1.0]}, "not evenly spaced"),
    ({"pressure": (DIMS, np.full((2, 2), "a"))}, {}, "pressure holds"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("variables", "coordinates", "problem"), BAD_NETCDF)
def test_netcdf_without_a_clear_grid_is_refused(tmp_path, variables, coordinates, problem):
    assert problem in refusal(netcdf(tmp_path / "p.nc", variables, **EDGES | coordinates))


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
        return f"file:{path}"

    assert "1000000000000 points; allowed: at most 1000000" in refusal(declared(10**12, (1024, 4)))
    message = refusal(declared(None, (10**8, 4)))
    assert "forward is stored in chunks of 100000000; allowed" in message


def test_large_files_and_grids_are_refused_before_memory_is_used(tmp_path, monkeypatch):
    assert "a folder" in refusal(f"file:{tmp_path}")
    monkeypatch.setattr(named_files, "MOST_BYTES", 20)
    assert "larger than" in refusal(text(tmp_path / "p.csv", PLAIN))
    monkeypatch.undo()
    monkeypatch.setattr(files, "MOST_POINTS", 10)  # n points on a diagonal: a grid of n x n
    scattered = text(tmp_path / "p.csv", HEAD + "".join(f"{i},{i},1\n" for i in range(5)))
    assert "5 points for a grid of 5 x 5" in refusal(scattered)


# Names


def test_one_file_by_many_paths_is_one_pressure(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = text(tmp_path / "p.csv", PLAIN)
    (tmp_path / "link.csv").symlink_to(tmp_path / "p.csv")
    (tmp_path / "copy, of=it.csv").write_text(PLAIN)
    paths = ("file:p.csv", "file:./p.csv", "file:link.csv", "file:copy, of=it.csv", name)
    records = [pressure_named(path) for path in paths]
    records += [pressure_named(f"{name},grid=cells"), pressure_named(records[0].name)]
    assert all(record is records[0] for record in records)
    assert str(tmp_path) not in records[0].name
    assert pressure_named("file:p.csv,grid=samples").name == f"{records[0].name},grid=samples"


def test_a_file_that_changes_is_another_pressure(tmp_path):
    name = text(tmp_path / "p.csv", PLAIN)
    before = pressure_named(name).name
    text(tmp_path / "p.csv", PLAIN + "# a comment\n")
    for past in (f"{name},{before.removeprefix('file:')}", before):
        assert "has changed: its sha256 begins with" in refusal(past)
    assert pressure_named(name).name != before
