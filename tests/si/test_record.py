"""Periods from records with noise and drift, compared with the known motion."""

import json

import numpy as np
import pytest
from bad_input_tables.odd_quantities import Q
from xarray import DataArray

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


def swept(change, seconds=0.5):
    """Times, s, and an amplitude of 1 at 1300 Hz plus a linear change of the frequency, Hz."""
    time = np.arange(round(seconds * RATE)) / RATE
    phase = 2.0 * np.pi * (1300.0 * time + 0.5 * change / seconds * time**2)
    return time, np.sin(phase) + 1e-3 * np.random.default_rng(2).standard_normal(len(time))


@pytest.mark.parametrize(("change", "decay"), [(0.1, 0.0), (1.0, 0.0), (0.0, 0.05)])
def test_the_error_covers_a_small_drift_of_the_frequency_and_of_the_amplitude(change, decay):
    time, lateral = swept(change)
    lateral = lateral * (1.0 - decay * time / time[-1])
    size, error = microslip.fold(time, {"lateral": lateral}).peak_to_peak("lateral")
    assert abs(size - 2.0 * (1.0 - 0.5 * decay)) <= 1.2 * error - 0.6 * decay
    assert error <= 0.02 + decay
    fall = microslip.fold(
        time, {"lateral": np.sin(2.0 * np.pi * FREQUENCY * time) * (1.0 - decay * time)}
    )
    assert abs(fall.frequency - FREQUENCY) <= fall.frequency_error + 1e-8


def test_a_weak_fundamental_is_not_mistaken_for_a_fraction():
    time, lateral = record()
    slow = np.sin(np.pi * FREQUENCY * time)
    with pytest.raises(InputError, match=r"after 2 periods; allowed is 103.6\d* Hz"):
        microslip.fold(time, {"lateral": lateral + 0.2 * slow})
    lateral += 0.05 * slow
    size, error = microslip.fold(time, {"lateral": lateral}).peak_to_peak("lateral")
    phase = np.linspace(0.0, 4.0 * np.pi, 10_001)
    assert abs(size - np.ptp(motion(phase) + 0.05 * np.sin(0.5 * phase))) <= error < 0.3
    result = microslip.fold(time, {"lateral": lateral}, frequency=0.5 * FREQUENCY)
    assert abs(result.frequency - 0.5 * FREQUENCY) <= 4.0 * result.frequency_error


RECORD, LATERAL = record()
FINE, ROW = RECORD, np.arange(len(RECORD))
SINE = np.sin(2.0 * np.pi * FREQUENCY * FINE)
SINE += NOISE * np.random.default_rng(1).standard_normal(len(FINE))


@pytest.mark.parametrize(
    ("offset", "form"), [(0.0, ".4f"), (10.0, ".4f"), (1.0, ".3f"), (10.0, ".6g")]
)
def test_times_within_half_a_unit_of_the_last_digit_are_equally_spaced(offset, form):
    rounded = np.array([float(format(offset + one, form)) for one in FINE])
    result = microslip.fold(rounded, {"lateral": SINE})
    assert abs(result.frequency - FREQUENCY) < 4.0 * result.frequency_error
    assert result.peak_to_peak("lateral")[0] == pytest.approx(2.0, abs=0.05)


def test_a_saturated_signal_and_a_square_wave_are_within_the_error():
    for wave, most in ((np.clip(SINE, -0.8, 0.8), 0.1), (np.sign(SINE - NOISE), 1.5)):
        size, error = microslip.fold(FINE, {"lateral": wave}).peak_to_peak("lateral")
        assert abs(size - np.ptp(wave)) <= error <= most


def test_the_peak_is_within_the_error_for_any_number_of_samples_in_a_period():
    rng, ratios = np.random.default_rng(3), []
    for _ in range(100):
        orders = np.arange(1, rng.integers(2, 7))
        parts = [1.0, *rng.standard_normal(len(orders) - 1)] * np.exp(6j * rng.random(len(orders)))
        parts *= 0.3 / orders**2

        def wave(turns, parts=parts, orders=orders):
            return 2.0 * np.real(np.exp(2j * np.pi * np.outer(turns, orders)) @ parts)

        samples, noise = rng.uniform(4.0, 40.0), 10.0 ** rng.uniform(-6.0, -2.0)
        time = np.arange(round(samples * rng.uniform(10.0, 200.0)))
        lateral = wave(time / samples) + noise * rng.standard_normal(len(time)) + 1e-3 * time
        result = microslip.fold(time, {"lateral": lateral}, frequency=1.0 / samples)
        size, error = result.peak_to_peak("lateral")
        ratios.append(abs(size - np.ptp(wave(np.linspace(0.0, 1.0, 10_001)))) / error)
    assert np.mean(np.array(ratios) <= 1.0) > 0.9 and max(ratios) < 2.0


def test_units_of_arrays_are_converted_or_refused():
    plain = microslip.fold(FINE, {"lateral": 1e-6 * SINE})
    time, lateral = Q(1e3 * FINE, "ms"), DataArray(SINE, attrs={"units": "um"})
    result = microslip.fold(time, {"lateral": lateral})
    assert result.frequency == pytest.approx(plain.frequency, rel=1e-12)
    assert result.columns["lateral"] == pytest.approx(plain.columns["lateral"], rel=1e-6, abs=1e-12)
    with pytest.raises(InputError, match="^time = .*: allowed is an array of numbers in s"):
        microslip.fold(Q(FINE, "m"), {"lateral": SINE})


TIME = np.arange(1000.0)
WAVE = {"lateral": np.sin(0.3 * TIME)}
WHITE = {"lateral": np.random.default_rng(0).standard_normal(1000)}
REFUSED = [
    (np.delete(np.round(FINE, 5), 12_000), {"lateral": SINE[1:]}, {}, "not equally spaced"),
    (None, WAVE, {}, "time = .*allowed are"),
    (TIME[::-1], WAVE, {}, "allowed are increasing times"),
    ([0.0], {"lateral": [1.0]}, {}, "time = 1: .*at least 16"),
    (TIME, WAVE, {"frequency": 0.002}, "frequency = 0.002: the record of 999 s has"),
    (TIME, WAVE, {"rows": 63}, "rows = 63: allowed is an even number"),
    (TIME, {"lateral": np.zeros(9)}, {}, "lateral = 9: .*allowed is 1000, as in time"),
    (TIME, {}, {}, "columns = {}: allowed is one column or more"),
    (TIME, TIME, {}, "columns = .*allowed is a mapping"),
    (TIME, {"load": WAVE["lateral"] - 2.0}, {}, "load = .*numbers >= 0"),
    (TIME, {"lateral": np.full(1000, 0.1)}, {}, "lateral = 0.1: .*without an oscillation"),
    (TIME, {"lateral": 0.1 * TIME}, {"frequency": 0.04}, "lateral = 0.0: .*without an oscillation"),
    (TIME, WHITE, {"frequency": 0.04}, "frequency = 0.04: no component of the record"),
    (FINE, {"lateral": SINE}, {"frequency": 250.0}, "frequency = 250.0: no component of the rec"),
    (TIME, {"lateral": np.sin(np.pi * 3.9e-3 * TIME)}, {}, r" [\d.]+ Hz, the strongest comp.*are"),
    (FINE, {"lateral": np.where(ROW % 400, SINE, -9999.0)}, {}, "lateral = -9999.0: this is row 0"),
    (
        FINE,
        {"lateral": np.where(ROW < 12_500, 0.02 * SINE[0], SINE)},
        {},
        r"smallest in part [1-6] of 1[01]",
    ),
    *(
        (RECORD, {"lateral": LATERAL}, {"frequency": factor * FREQUENCY}, "^frequency = ")
        for factor in (0.1, 0.5, 2.0)
    ),
    (FINE, {"lateral": swept(2.0)[1]}, {}, "frequency changes by about 2 Hz"),
    (FINE, {"lateral": np.where(ROW == 9, -999.2, SINE)}, {}, "-999.2: this is row 9, far"),
    (FINE, {"lateral": np.where(ROW // 3500 == 3, 0.0, SINE)}, {}, "smallest in part 5 of"),
    (FINE, {"lateral": (1.0 - 0.4 * FINE) * SINE}, {}, "amplitude changes by 20 %"),
    (FINE, {"load": 0.5 + SINE}, {}, "load = -0.5.*: the smallest .*numbers >= 0"),
]


@pytest.mark.parametrize(("time", "columns", "options", "problem"), REFUSED)
def test_a_bad_record_is_refused_in_one_line(time, columns, options, problem):
    with pytest.raises(InputError, match=problem) as refused:
        microslip.fold(time, columns, **options)
    assert "\n" not in str(refused.value)
