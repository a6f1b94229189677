"""Periods from records with noise and drift, compared with the known motion."""

import json

import numpy as np
import pytest

import microslip
from microslip.app.cli import main
from microslip.foundation.errors import InputError

RATE, FREQUENCY = 50_000.0, 207.3117
NOISE = 0.02


def motion(phase):
    return 0.8 * np.sin(phase) + 0.2 * np.sin(2.0 * phase + 0.7) + 0.05 * np.cos(5.0 * phase)


def record(seconds=0.5, noise=NOISE):
    """Times, s, and lateral displacement, um, with white noise and a drift."""
    time = np.arange(round(seconds * RATE)) / RATE
    drift = 5.0 + 2.0 * time + 0.3 * np.sin(2.0 * np.pi * 1.3 * time)
    white = noise * np.random.default_rng(1).standard_normal(len(time))
    return time, motion(2.0 * np.pi * FREQUENCY * time) + drift + white


def aligned(result):
    """The true motion at the samples.  The phase of the first sample is arbitrary, so it is taken
    from the fundamental."""
    rows = len(result.columns["lateral"])
    phase = np.angle(np.fft.rfft(result.columns["lateral"])[1]) + 0.5 * np.pi
    return motion(phase + 2.0 * np.pi * np.arange(rows) / rows)


@pytest.mark.parametrize("frequency", [None, 207.0])
def test_noise_and_drift_are_removed_within_the_errors(frequency):
    time, lateral = record()
    result = microslip.fold(time, {"lateral": lateral}, frequency=frequency)
    assert abs(result.frequency - FREQUENCY) <= 4.0 * result.frequency_error
    off = result.columns["lateral"] - aligned(result)
    error = float(np.sqrt(np.mean(result.errors["lateral"] ** 2)))
    assert np.sqrt(np.mean(off**2)) <= 1.3 * error
    # white noise: the mean over the periods, and the harmonics up to 15 of 120 in a period
    share = 30.0 / (RATE / FREQUENCY)
    assert error == pytest.approx(NOISE * np.sqrt(share / result.periods), rel=0.1)
    assert result.periods == int(0.5 * FREQUENCY) - 1
    # the drift rises by 2 um/s, and by the sine between the centres of the first and last period
    ends = np.array([0.5, 0.5 * FREQUENCY - 0.5]) / FREQUENCY
    sine = np.diff(0.3 * np.sin(2.0 * np.pi * 1.3 * ends))[0] / np.diff(ends)[0]
    assert result.drift["lateral"] == pytest.approx(2.0 + sine, abs=0.02)


def test_without_noise_the_motion_is_exact():
    time, lateral = record(noise=0.0)
    result = microslip.fold(time, {"lateral": lateral})
    assert result.frequency == pytest.approx(FREQUENCY, rel=1e-6)
    assert result.columns["lateral"] == pytest.approx(aligned(result), abs=2e-4)


def test_a_load_keeps_its_mean_and_sliding_is_a_drift():
    time = np.arange(5000) / 1e4
    phase = 2.0 * np.pi * 40.0 * time
    columns = {"load": 10.0 + np.sin(phase), "forward": 3.0 * time + 0.1 * np.cos(phase)}
    result = microslip.fold(time, columns)
    assert result.columns["load"].mean() == pytest.approx(10.0, abs=1e-6)
    assert np.ptp(result.columns["load"]) == pytest.approx(2.0, rel=1e-3)
    assert result.columns["forward"].mean() == pytest.approx(0.0, abs=1e-9)
    assert result.drift["forward"] == pytest.approx(3.0, rel=1e-6)


def test_a_record_becomes_friction_in_two_commands(tmp_path, capsys):
    time, lateral = record()
    lines = (f"{t:.6f},{x:.5f}" for t, x in zip(time, 0.3 * lateral, strict=True))
    (tmp_path / "record.csv").write_text("\n".join(["Time [s],Lateral [um]", *lines]) + "\n")
    stroke = str(tmp_path / "stroke.csv")
    assert main(["fold", str(tmp_path / "record.csv"), "--output", stroke, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert abs(answer["frequency_Hz"] - FREQUENCY) <= 4.0 * answer["frequency_error_Hz"]
    phase = np.linspace(0.0, 2.0 * np.pi, 10001)
    assert answer["columns"]["lateral"]["peak_to_peak"] == pytest.approx(
        0.3 * np.ptp(motion(phase)), rel=1e-2
    )
    contact = ["--mu", "0.3", "--load", "10 N", "--radius", "5 mm", "--material", "steel"]
    words = ["predict", f"file:{stroke}", *contact, "--speed", "20 um/s", "--json"]
    assert main([*words, "--tolerance", "0.01"]) == 0
    measured = json.loads(capsys.readouterr().out)
    exact = 0.3e-6 * motion(np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
    rows = "\n".join(map(repr, map(float, exact)))
    (tmp_path / "exact.csv").write_text(f"lateral [m]\n{rows}\n")
    words[1] = f"file:{tmp_path / 'exact.csv'}"
    assert main([*words, "--tolerance", "0.01", "--frequency", f"{FREQUENCY} Hz"]) == 0
    truth = json.loads(capsys.readouterr().out)
    left = measured["mu_macro_error"] + truth["mu_macro_error"]
    assert abs(measured["mu_macro"] - truth["mu_macro"]) <= left


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"time": np.delete(np.arange(1001.0), 500)}, "not equally spaced; this is row"),
        ({"frequency": 0.002}, "frequency = 0.002: allowed are 4 periods or more"),
        ({"columns": {"lateral": np.zeros(1000)}}, "constant; allowed is an oscillation"),
        ({"columns": {"lateral": np.zeros(9)}}, "allowed are as many numbers as times: 1000"),
        ({"rows": 63}, "rows = 63: allowed is an even number"),
        ({"columns": {}}, "allowed is one column or more"),
    ],
)
def test_bad_records_are_refused_in_one_line(change, problem):
    time = np.arange(1000.0)
    arguments = {"time": time, "columns": {"lateral": np.sin(0.3 * time)}} | change
    with pytest.raises(InputError) as refused:
        microslip.fold(arguments.pop("time"), arguments.pop("columns"), **arguments)
    assert problem in str(refused.value) and "\n" not in str(refused.value)


def test_a_record_without_time_is_refused(tmp_path, capsys):
    (tmp_path / "record.csv").write_text("lateral [um]\n" + "0\n1\n" * 20)
    words = ["fold", str(tmp_path / "record.csv"), "--output", str(tmp_path / "stroke.csv")]
    assert main(words) == 2
    assert "no column time" in capsys.readouterr().err
