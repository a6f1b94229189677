"""Periods from records with noise and drift, compared with the known motion."""

import json
import re

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
    exact = np.ptp(motion(np.linspace(0.0, 2.0 * np.pi, 10001)))  # between the samples, too
    assert result.peak_to_peak("lateral")[0] == pytest.approx(exact, rel=5e-4)


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
    exact = 0.3e-6 * motion(np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
    (tmp_path / "exact.csv").write_text("\n".join(["lateral [m]", *map(str, exact)]) + "\n")

    def run(*words):
        assert main([*map(str, words), "--json"]) == 0
        return json.loads(capsys.readouterr().out)

    answer = run("fold", tmp_path / "record.csv", "--output", tmp_path / "stroke.csv")
    assert abs(answer["frequency_Hz"] - FREQUENCY) <= 4.0 * answer["frequency_error_Hz"]
    lateral = answer["columns"]["lateral"]
    off = lateral["peak_to_peak"] - 0.3 * np.ptp(motion(np.linspace(0.0, 2.0 * np.pi, 10001)))
    assert abs(off) <= 2.0 * lateral["peak_to_peak_error"]
    contact = "--mu 0.3 --load 10N --radius 5mm --material steel --speed 20um/s --tolerance 0.01"
    frequency = ["--frequency", f"{FREQUENCY} Hz"]
    measured = run("predict", f"file:{tmp_path / 'stroke.csv'}", *contact.split())
    truth = run("predict", f"file:{tmp_path / 'exact.csv'}", *contact.split(), *frequency)
    left = measured["mu_macro_error"] + truth["mu_macro_error"]
    assert abs(measured["mu_macro"] - truth["mu_macro"]) <= left


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"time": np.delete(np.arange(1001.0), 500)}, "not equally spaced"),
        ({"frequency": 0.002}, "frequency = 0.002: the record of 999 s has"),
        ({"columns": {"lateral": np.zeros(9)}}, "allowed are as many numbers as times: 1000"),
        ({"rows": 63}, "rows = 63: allowed is an even number"),
        ({"columns": {}}, "allowed is one column or more"),
        ({"columns": {"foo": np.sin(0.3 * np.arange(1000.0))}}, "columns = 'foo': unknown"),
        ({"columns": np.zeros(1000)}, "allowed is a mapping"),
        ({"time": None}, "time = None: allowed is an array"),
        ({"time": np.arange(1000.0)[::-1]}, "allowed are increasing times"),
        ({"time": [0.0], "columns": {"lateral": [1.0]}}, "the record is too short"),
        ({"columns": {"load": np.sin(0.3 * np.arange(1000.0)) - 2.0}}, "allowed is a mean above 0"),
        ({"columns": {"load": np.ones(1000), "indentation": np.ones(1000)}}, "one of the two"),
    ],
)
def test_bad_records_are_refused_in_one_line(change, problem):
    time = np.arange(1000.0)
    arguments = {"time": time, "columns": {"lateral": np.sin(0.3 * time)}} | change
    with pytest.raises(InputError) as refused:
        microslip.fold(arguments.pop("time"), arguments.pop("columns"), **arguments)
    assert problem in str(refused.value) and "\n" not in str(refused.value)


def swept(change, seconds=0.5):
    """Times, s, and an amplitude of 1 at 1300 Hz plus a linear change of the frequency, Hz."""
    time = np.arange(round(seconds * RATE)) / RATE
    phase = 2.0 * np.pi * (1300.0 * time + 0.5 * change / seconds * time**2)
    return time, np.sin(phase) + 1e-3 * np.random.default_rng(2).standard_normal(len(time))


@pytest.mark.parametrize("change", [0.1, 1.0])
def test_the_error_covers_a_small_drift_of_the_frequency(change):
    time, lateral = swept(change)
    size, error = microslip.fold(time, {"lateral": lateral}).peak_to_peak("lateral")
    assert abs(size - 2.0) <= 1.2 * error
    assert error <= 0.02


def test_a_large_drift_of_the_frequency_is_refused():
    time, lateral = swept(2.0)
    with pytest.raises(InputError, match="frequency changes by about 2 Hz"):
        microslip.fold(time, {"lateral": lateral})


@pytest.mark.parametrize("frequency", [None, 40.0])
def test_noise_is_refused(frequency):
    noise = np.random.default_rng(0).standard_normal(2000)
    with pytest.raises(InputError, match="times its standard error|periods of .* samples;"):
        microslip.fold(np.arange(2000) / 1000.0, {"lateral": noise}, frequency=frequency)


@pytest.mark.parametrize("factor", [0.1, 0.5, 2.0])
def test_a_multiple_or_a_fraction_of_the_frequency_is_refused(factor):
    time, lateral = record()
    with pytest.raises(InputError) as refused:
        microslip.fold(time, {"lateral": lateral}, frequency=factor * FREQUENCY)
    assert refused.value.argument == "frequency"


def test_a_weak_fundamental_is_not_mistaken_for_a_fraction():
    time, lateral = record()
    lateral += 0.05 * np.sin(np.pi * FREQUENCY * time)
    result = microslip.fold(time, {"lateral": lateral}, frequency=0.5 * FREQUENCY)
    assert abs(result.frequency - 0.5 * FREQUENCY) <= 4.0 * result.frequency_error


@pytest.mark.parametrize("periods", [1, 3.9])
def test_a_record_of_few_periods_is_refused_with_plain_numbers(periods):
    time = np.arange(2000) / 1000.0
    with pytest.raises(InputError, match="Hz, the strongest component.*allowed are") as refused:
        microslip.fold(time, {"lateral": np.sin(np.pi * periods * time)})
    assert "np.float64" not in str(refused.value)


def sine(seconds=0.5):
    """Times, s, and a noisy sine of amplitude 1."""
    time = np.arange(round(seconds * RATE)) / RATE
    noise = NOISE * np.random.default_rng(1).standard_normal(len(time))
    return time, np.sin(2.0 * np.pi * FREQUENCY * time) + noise


@pytest.mark.parametrize(
    ("offset", "form"), [(0.0, ".4f"), (10.0, ".4f"), (1.0, ".3f"), (10.0, ".6g")]
)
def test_times_within_half_a_unit_of_the_last_digit_are_equally_spaced(offset, form):
    time, lateral = sine()
    rounded = np.array([float(format(offset + one, form)) for one in time])
    result = microslip.fold(rounded, {"lateral": lateral})
    assert abs(result.frequency - FREQUENCY) < 4.0 * result.frequency_error
    assert result.peak_to_peak("lateral")[0] == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("decimals", [5, 8])
def test_a_missing_sample_is_refused(decimals):
    time, lateral = sine()
    keep = np.arange(len(time)) != 12_000
    with pytest.raises(microslip.InputError) as caught:
        microslip.fold(np.round(time, decimals)[keep], {"lateral": lateral[keep]})
    assert caught.value.argument == "time"


@pytest.mark.parametrize("value", [0.1, 1e6, -3.7e-9])
def test_a_constant_channel_does_not_oscillate(value):
    with pytest.raises(microslip.InputError, match="constant"):
        microslip.fold(np.arange(1000.0), {"lateral": np.full(1000, value)})


@pytest.mark.parametrize("part", [slice(None, 12_500), slice(12_500, None)])
def test_a_motion_of_half_the_record_is_not_periodic_throughout(part):
    time, lateral = sine()
    lateral[part] = 0.02 * np.random.default_rng(2).standard_normal(12_500)
    with pytest.raises(microslip.InputError, match="not periodic throughout") as caught:
        microslip.fold(time, {"lateral": lateral})
    assert caught.value.argument == "time"


@pytest.mark.parametrize("mark", [-9999.0, 32767.0])
def test_a_value_that_marks_missing_samples_is_named(mark):
    time, lateral = sine()
    lateral[::400] = mark
    with pytest.raises(microslip.InputError, match="63 rows") as caught:
        microslip.fold(time, {"lateral": lateral})
    assert (caught.value.argument, caught.value.value) == ("lateral", mark)


def test_a_saturated_signal_and_a_square_wave_have_no_such_value():
    time, lateral = sine()
    microslip.fold(time, {"lateral": np.clip(lateral, -0.8, 0.8)})
    microslip.fold(time, {"lateral": np.sign(np.sin(2.0 * np.pi * FREQUENCY * time))})


NOISE_ROWS = "\n".join(
    f"{t},{x:.4f}" for t, x in enumerate(np.random.default_rng(4).normal(size=2000))
)


@pytest.mark.parametrize(
    ("text", "output", "message"),
    [
        ("lateral [um]\n" + "0\n1\n" * 20, "stroke.csv", "no column time"),
        (f"time [ms],lateral [um]\n{NOISE_ROWS}\n", "stroke.csv", r"lateral = [0-9.]+ um: .* Hz"),
        (f"time [ms],lateral [um]\n{NOISE_ROWS}\n", "stroke.nc", "a name that ends in .csv"),
    ],
)
def test_bad_files_are_refused_by_the_command(tmp_path, capsys, text, output, message):
    (tmp_path / "record.csv").write_text(text)
    words = ["fold", str(tmp_path / "record.csv"), "--output", str(tmp_path / output)]
    assert main([*words, "--frequency", "40 Hz"]) == 2
    assert re.search(message, capsys.readouterr().err)
    assert not (tmp_path / output).exists()
