"""Pressures from files: what they hold is what is computed, and what they must not hold is told."""

import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.cli import main
from microslip.pressures import HERTZ, pressure_named
from microslip.scenes import scene_named

AXIS = np.linspace(-1.25, 1.25, 51)
HERTZIAN = np.sqrt(np.maximum(1.0 - AXIS[:, None] ** 2 - AXIS**2, 0.0))


@pytest.fixture(autouse=True)
def _files_known():
    assert microslip.solve  # it is what makes names of files known


def csv(path, forward=AXIS, lateral=AXIS, values=HERTZIAN):
    rows = [
        f"{x:.9g},{y:.9g},{values[i, j]:.9g}"
        for i, x in enumerate(forward)
        for j, y in enumerate(lateral)
    ]
    path.write_text("\n".join(["forward,lateral,pressure", *rows]) + "\n")
    return f"file:{path}"


def netcdf(path, forward=AXIS, lateral=AXIS, values=HERTZIAN):
    coordinates = {"forward": forward, "lateral": lateral}
    array = xr.DataArray(values, coordinates, ("forward", "lateral"), name="pressure")
    array.to_netcdf(path)
    return f"file:{path}"


def test_units_and_formats_do_not_matter(tmp_path):
    one = pressure_named(csv(tmp_path / "p.csv"))
    other = pressure_named(netcdf(tmp_path / "p.nc", 1e-3 * AXIS, 1e-3 * AXIS, 2e9 * HERTZIAN))
    assert one.G_star == pytest.approx(other.G_star, rel=1e-6)
    assert one.torque == pytest.approx(other.torque, rel=1e-6)
    assert one.cell_loads(20) == pytest.approx(other.cell_loads(20), abs=1e-8)


def test_hertzs_pressure_from_a_file_is_hertzs(tmp_path):
    """Along lines, where only the units u_lim count; the edge is blurred by a grid's width."""
    name = csv(tmp_path / "p.csv")
    assert pressure_named(name).torque == pytest.approx(HERTZ.torque, abs=5e-3)
    for scene in ("transverse", "longitudinal"):
        sphere = microslip.solve(scene, 0.1, 0.5)
        found = microslip.solve(scene, 0.1, 0.5, pressure=name, tolerance=3e-3)
        assert found.converged
        assert abs(found.mu_macro - sphere.mu_macro) <= found.mu_macro_error + 1e-3


def test_what_a_file_says_is_kept_where_it_says(tmp_path):
    """A quarter of the load lies on the square that is one quarter of four."""
    values = np.zeros((5, 5))
    values[1, 1], values[1, 3], values[3, 1], values[3, 3] = 1.0, 2.0, 3.0, 4.0
    name = csv(tmp_path / "p.csv", np.arange(5), np.arange(5), values)
    assert pressure_named(name).cell_loads(2) == pytest.approx(
        np.array([[0.1, 0.2], [0.3, 0.4]]), abs=1e-12
    )


def test_a_pressure_that_is_not_symmetric_is_marched_over_the_whole_period(tmp_path):
    values = HERTZIAN * (1.0 + 0.5 * AXIS)
    name = csv(tmp_path / "p.csv", values=values)
    scene = scene_named("bore", name)
    assert not scene.half_period_mirror
    assert scene.turns(0.1, 1.0) == pytest.approx((-np.pi / 2, np.pi / 2, 1.5 * np.pi))
    found = microslip.solve("bore", 0.3, 1.0, pressure=name, tolerance=5e-3)
    mirrored = csv(tmp_path / "m.csv", values=values[:, ::-1])
    other = microslip.solve("bore", 0.3, 1.0, pressure=mirrored, tolerance=5e-3)
    assert found.converged
    # the mirror image of the motion is the same half a period later
    assert found.mu_macro == pytest.approx(other.mu_macro, abs=1e-3)


def test_the_name_of_a_result_has_the_digest_of_the_file(tmp_path):
    name = csv(tmp_path / "p.csv")
    found = microslip.solve("transverse", 0.1, 0.5, pressure=name, tolerance=1e-2)
    assert found.pressure.startswith(f"{name},sha256=")
    again = microslip.solve("transverse", 0.1, 0.5, pressure=found.pressure, tolerance=1e-2)
    assert again.mu_macro == found.mu_macro
    csv(tmp_path / "p.csv", values=2.0 * HERTZIAN + HERTZIAN**2)
    with pytest.raises(ValueError, match="has changed: its sha256 begins with"):
        pressure_named(found.pressure)
    assert pressure_named(name).name != found.pressure


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "the first line is ''; allowed: forward,lateral,pressure"),
        ("x,y,p\n0,0,1\n", "the first line is 'x,y,p'; allowed: forward,lateral,pressure"),
        ("forward,lateral,pressure\n", "allowed are lines of three numbers"),
        ("forward,lateral,pressure\n0,0,a\n", "not three numbers a line"),
        ("forward,lateral,pressure\n0,0\n", "three numbers"),
        ("forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n", "3 points do not fill a grid of 2 x 2"),
        ("forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,-1\n", "pressure -1 is not allowed"),
        ("forward,lateral,pressure\n0,0,0\n0,1,0\n1,0,0\n1,1,0\n", "pressure is 0 everywhere"),
        ("forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,nan\n", "do not fill a grid"),
        ("forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,inf\n", "pressure inf is not allowed"),
        (
            "forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n3,0,1\n3,1,1\n",
            "forward: not evenly spaced",
        ),
    ],
)
def test_what_a_file_must_not_hold_is_told_in_one_line(tmp_path, capsys, text, problem):
    (tmp_path / "p.csv").write_text(text)
    point = ["point", "transverse", "--velocity", "0.1", "--amplitude", "0.5"]
    assert main([*point, "--pressure", f"file:{tmp_path / 'p.csv'}"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert problem in said
    assert "p.csv" in said


def test_a_relative_path_may_count_from_a_folder_of_the_environment(tmp_path, monkeypatch):
    csv(tmp_path / "p.csv")
    with pytest.raises(ValueError, match="cannot be read"):
        pressure_named("file:p.csv")
    monkeypatch.setenv("MICROSLIP_FILES", str(tmp_path))
    found = pressure_named("file:p.csv")
    assert found.name.startswith("file:p.csv,sha256=")
    monkeypatch.delenv("MICROSLIP_FILES")
    monkeypatch.chdir(tmp_path)
    assert pressure_named("file:p.csv").name == found.name  # wherever it was found


def test_files_that_are_not_there_or_not_netcdf_are_refused(tmp_path):
    with pytest.raises(ValueError, match="cannot be read: No such file"):
        pressure_named(f"file:{tmp_path / 'none.csv'}")
    with pytest.raises(ValueError, match="allowed is a file, as in file:measured.csv"):
        pressure_named("file:")
    (tmp_path / "p.nc").write_bytes(b"no netCDF")
    with pytest.raises(ValueError, match="not a netCDF file"):
        pressure_named(f"file:{tmp_path / 'p.nc'}")
    xr.Dataset({"pressure": ("forward", [1.0, 2.0])}).to_netcdf(tmp_path / "q.nc")
    with pytest.raises(ValueError, match="allowed is a variable pressure with the dimensions"):
        pressure_named(f"file:{tmp_path / 'q.nc'}")
