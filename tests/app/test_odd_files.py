"""Unusual files and damaged files: the right result, or one line with the reason."""

import pytest
import yaml
from bad_input_tables import odd_files as odd
from bad_input_tables.odd_files import SWEEP
from stubs.in_process import run_apart

from microslip.config import load
from microslip.config.load import ConfigError
from microslip.datasets.open_map import open_map
from microslip.foundation.errors import InputError
from microslip.foundation.files import CacheError
from microslip.scene.by_name import pressure_named


def one_line(caught, words):
    message = str(caught.value)
    assert "\n" not in message
    assert [word for word in words if word not in message] == []
    return message


@pytest.mark.parametrize(("text", "expected"), odd.VELOCITIES)
def test_numbers_mean_what_they_show(text, expected, tmp_path):
    path = tmp_path / "given.yaml"
    path.write_text(SWEEP % text, encoding="utf-8")
    if isinstance(expected, tuple):
        assert load.load(path).sweeps["bore"].velocity == expected
        return
    with pytest.raises(ConfigError) as caught:
        load.load(path)
    one_line(caught, [str(path), *expected["words"]])


@pytest.mark.parametrize(("text", "words"), odd.KEYS)
def test_odd_settings(text, words, tmp_path):
    path = tmp_path / "given.yaml"
    path.write_text(SWEEP % "[1]" + text + "\n", encoding="utf-8")
    if words is None:
        key, value = next(iter(yaml.safe_load(text.replace("010", "10")).items()))
        assert getattr(load.load(path), key) == value
        return
    with pytest.raises(ConfigError) as caught:
        load.load(path)
    one_line(caught, [str(path), *words]).encode()  # the message can be printed


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("text", "expected"), odd.CSV)
def test_odd_pressures_as_text(text, expected, tmp_path):
    path = tmp_path / "p.csv"
    path.write_bytes(text.encode())
    if isinstance(expected, list):
        assert pressure_named(f"file:{path}").cell_loads(2).tolist() == [
            pytest.approx(row, abs=1e-9) for row in expected
        ]
        return
    with pytest.raises(InputError) as caught:
        pressure_named(f"file:{path}")
    one_line(caught, [str(path), *expected["words"]])


@pytest.mark.parametrize(("data", "expected"), odd.NETCDF)
def test_odd_pressures_as_netcdf(data, expected, tmp_path):
    path = tmp_path / "p.nc"
    data.to_netcdf(path)
    if expected == "stretched":
        # a thousand times as long as wide: mean distance of length / 4, divided by length / 2
        assert pressure_named(f"file:{path}").torque == pytest.approx(0.5, abs=1e-4)
        return
    with pytest.raises(InputError) as caught:
        pressure_named(f"file:{path}")
    one_line(caught, [str(path), *expected["words"]])


# The netCDF library does not return from a grid whose second half is zeros.  Ctrl-C ends it.
def test_a_pressure_that_is_cut_off_is_refused(tmp_path):
    path = tmp_path / "pad.nc"
    odd.grid().to_netcdf(path)
    path.write_bytes(odd.DAMAGES["cut off"](path.read_bytes()))
    with pytest.raises(InputError) as caught:
        pressure_named(f"file:{path}")
    one_line(caught, [str(path), "not a netCDF file"])


@pytest.mark.parametrize("case", odd.DATASETS)
def test_a_dataset_that_no_sweep_has_made_is_refused(case):
    change, word = odd.DATASETS[case]
    with pytest.raises(InputError) as caught:
        change(odd.whole()).microslip.at(0.15, 1.3)
    one_line(caught, [word])
    unchanged = odd.whole()
    assert unchanged.microslip.at(0.15, 1.3).mu_macro_error < 0.1


@pytest.mark.parametrize(("name", "more", "word"), odd.OPENED)
def test_odd_names_of_datasets(name, more, word):
    with pytest.raises((InputError, CacheError)) as caught:
        open_map(name, **more)
    one_line(caught, [word])


@pytest.mark.parametrize("case", odd.DAMAGES)
def test_a_damaged_dataset_without_a_stamp_is_one_line(case, tmp_path):
    path = tmp_path / "map.nc"
    odd.whole().to_netcdf(path)
    path.write_bytes(odd.DAMAGES[case](path.read_bytes()))
    with pytest.raises(CacheError) as caught:
        open_map(path)
    one_line(caught, [str(path)])


@pytest.mark.long
def test_sweep_runs_where_the_home_takes_no_files(tmp_path):
    (tmp_path / "home").write_text("no folder")
    axes = "{motion: bore, velocity: 1, amplitude: [0, 1], model: rigid, tolerance: 0.01}"
    (tmp_path / "tiny.yaml").write_text(f"sweeps: {{bore: {axes}}}\n")
    environment = {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": "", "NUMBA_CACHE_DIR": ""}
    words = ("sweep", "-n", "--configfile", "tiny.yaml")
    process = run_apart(*words, folder=tmp_path, **environment)
    assert process.returncode == 0, process.stderr
    assert "Traceback" not in process.stderr
    assert process.stderr.count("cannot be written to: Snakemake's own files are in") == 1
