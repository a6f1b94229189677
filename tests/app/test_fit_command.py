"""`microslip fit`: from a table to both numbers, a figure and a dataset."""

import json
import re

import numpy as np
import pytest
import xarray as xr
from stubs.eq6_map import eq6_map

from microslip.app import cli

MU, U_LIM, LOAD, FREQUENCY = 0.3, 2e-7, 10.0, 1e3
SHARED = ("--load", "10 N", "--frequency", "1 kHz")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A map with errors of at most 1e-3, and the friction of a contact according to it."""
    monkeypatch.chdir(tmp_path)
    dataset = eq6_map(1e-3)
    dataset.to_netcdf("map.nc")
    velocity = np.tile(np.geomspace(0.05, 3.0, 6), 2)
    amplitude = np.repeat([0.7, 1.8], 6)
    points = (xr.DataArray(part, dims="row") for part in (velocity, amplitude))
    force = MU * LOAD * dataset.microslip.at(*points).mu_macro.values
    table(velocity, amplitude, force)
    return tmp_path


def table(velocity, amplitude, force):
    unit = 2.0 * np.pi * FREQUENCY * U_LIM
    rows = [
        f"{v * unit!r},{1e6 * a * U_LIM!r},{f!r}"
        for v, a, f in zip(velocity.tolist(), amplitude.tolist(), force.tolist(), strict=True)
    ]
    heading = "speed [m/s],amplitude [um],friction [N]"
    with open("measured.csv", "w") as file:
        file.write("\n".join([heading, *rows]) + "\n")


@pytest.mark.slow
def test_a_table_gives_both_numbers_a_figure_and_a_dataset(folder, capsys):
    words = ["fit", "transverse", "measured.csv", *SHARED, "--map", "map.nc"]
    files = ["--figure", "fit.png", "--output", "fit.nc"]
    assert cli.main([*words, *files, "--json"]) == 0
    message = json.loads(capsys.readouterr().out)
    assert message["told"] == ["mu", "u_lim"]
    # The rows are exact values of the map, and its error estimates are bounds.
    assert message["mu"] == pytest.approx(MU, rel=1e-5)
    assert message["u_lim_m"] == pytest.approx(U_LIM, rel=1e-5)
    assert message["u_lim_low_m"] < U_LIM < message["u_lim_high_m"]
    assert (folder / "fit.png").read_bytes().startswith(b"\x89PNG")
    rows = xr.load_dataset(folder / "fit.nc")
    assert float(rows.mu) == message["mu"] and rows.sizes["row"] == 12
    assert rows.fitted.values == pytest.approx(rows.measured.values, rel=1e-4)
    assert {variable.attrs.get("units") for variable in rows.values()} >= {"1", "N", "m", "m s-1"}
    assert cli.main(words) == 0
    text = capsys.readouterr().out
    assert re.search(r"^mu +0\.3000, from 0\.29", text, re.M)
    assert re.search(r"^u_lim +200\.0\ nm,\ from", text, re.M)


@pytest.mark.long
def test_rows_that_tell_mu_alone_are_exit_code_1(folder, capsys):
    velocity = np.geomspace(0.03, 0.3, 6)
    force = MU * LOAD * (1.0 + 1e-3 * np.cos(3.0 * np.arange(6)))
    table(velocity, np.full(6, 0.06), force)
    assert cli.main(["fit", "transverse", "measured.csv", *SHARED, "--map", "map.nc"]) == 1
    message = capsys.readouterr().out
    assert "NOT DETERMINED: the rows determine mu alone: any u_lim above" in message
    assert re.search(r"^mu +0\.3", message, re.M) and "\nu_lim" not in message


BAD = [
    (["none.csv", *SHARED], "CSV = 'none.csv': cannot be read"),
    (["measured.csv", "--load", "10 N"], "--frequency: it is missing"),
    (["measured.csv", *SHARED, "--speed", "1 mm/s"], "--speed = '1 mm/s': it is both"),
    (["measured.csv", *SHARED, "--figure", "fit.jpg"], "--figure = 'fit.jpg': allowed is a name"),
    (["measured.csv", *SHARED, "--output", "fit.csv"], "--output = 'fit.csv': allowed is a name"),
    (["measured.csv", *SHARED, "--map", "none.nc"], "none.nc is not there"),
    (["measured.csv", *SHARED, "--map", "map.nc", "--nu", "0.3"], "--nu = '0.3': allowed is 0"),
    (["measured.csv", *SHARED, "--mu", "0.3"], "unknown option --mu"),
]


@pytest.mark.parametrize(("words", "message"), BAD, ids=[message for _, message in BAD])
def test_bad_input_is_one_line(folder, capsys, words, message):
    try:
        code = cli.main(["fit", "transverse", *words])
    except SystemExit as end:  # raised by the parser
        code = end.code
    streams = capsys.readouterr()
    assert code == 2 and streams.out == ""
    assert message in streams.err and streams.err.startswith("microslip fit: ")
    assert streams.err.count("\n") == 1
