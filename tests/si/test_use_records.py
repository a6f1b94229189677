"""Records of coarse times, constant channels, late starts and marks of missing samples."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import microslip

RATE, FREQUENCY = 50_000.0, 207.3117


def record(seconds=0.5, noise=0.02):
    time = np.arange(round(seconds * RATE)) / RATE
    white = noise * np.random.default_rng(1).standard_normal(len(time))
    return time, np.sin(2.0 * np.pi * FREQUENCY * time) + white


@pytest.mark.parametrize("offset, decimals", [(0.0, 4), (10.0, 4), (0.0, 5), (1.0, 3)])
def test_times_within_half_a_unit_of_the_last_digit_are_equally_spaced(offset, decimals):
    """The step, and so the frequency, is known to about the last digit over the duration."""
    time, lateral = record()
    result = microslip.fold(np.round(offset + time, decimals), {"lateral": lateral})
    error = result.frequency_error + FREQUENCY * 10.0**-decimals / time[-1]
    assert abs(result.frequency - FREQUENCY) < 5.0 * error
    assert result.peak_to_peak("lateral")[0] == pytest.approx(2.0, abs=0.05)


def test_times_with_six_significant_digits_after_an_offset_are_equally_spaced():
    time, lateral = record()
    rounded = np.array([float(f"{10.0 + one:.6g}") for one in time])
    assert microslip.fold(rounded, {"lateral": lateral}).frequency == pytest.approx(207.3, abs=0.1)


@pytest.mark.parametrize("decimals", [5, 8])
def test_a_missing_sample_is_refused(decimals):
    time, lateral = record()
    keep = np.arange(len(time)) != 12_000
    with pytest.raises(microslip.InputError) as caught:
        microslip.fold(np.round(time, decimals)[keep], {"lateral": lateral[keep]})
    assert caught.value.argument == "time"


def test_times_that_are_not_equally_spaced_are_refused_with_few_digits():
    time, lateral = record()
    with pytest.raises(microslip.InputError, match="equally spaced"):
        microslip.fold(np.round(time + 2e-3 * np.sin(20.0 * time), 4), {"lateral": lateral})


@pytest.mark.parametrize("value", [0.1, 1e6, -3.7e-9])
def test_a_constant_channel_does_not_oscillate(value):
    time, lateral = record()
    with pytest.raises(microslip.InputError, match="constant"):
        microslip.fold(time, {"lateral": np.full_like(lateral, value)})


@pytest.mark.parametrize("part", [slice(None, 12_500), slice(12_500, None)])
def test_a_motion_of_half_the_record_is_not_periodic_throughout(part):
    time, lateral = record()
    lateral[part] = 0.02 * np.random.default_rng(2).standard_normal(12_500)
    with pytest.raises(microslip.InputError, match="not periodic throughout") as caught:
        microslip.fold(time, {"lateral": lateral})
    assert caught.value.argument == "time"


@pytest.mark.parametrize("mark", [-9999.0, 32767.0])
def test_a_value_that_marks_missing_samples_is_named(mark):
    time, lateral = record()
    lateral[::400] = mark
    with pytest.raises(microslip.InputError, match="63 rows") as caught:
        microslip.fold(time, {"lateral": lateral})
    assert (caught.value.argument, caught.value.value) == ("lateral", mark)


def test_a_saturated_signal_and_a_square_wave_have_no_such_value():
    time, lateral = record()
    microslip.fold(time, {"lateral": np.clip(lateral, -0.8, 0.8)})
    microslip.fold(time, {"lateral": np.sign(np.sin(2.0 * np.pi * FREQUENCY * time))})


def test_a_prediction_of_a_file_prints_without_the_file(tmp_path):
    path = tmp_path / "stroke.csv"
    path.write_text("time [ms],lateral [um]\n0,0\n0.25,1\n0.5,0\n0.75,-1\n")
    body = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
    result = microslip.predict(f"file:{path}", **body, tolerance=0.1)
    text = str(result)
    path.write_text("time [ms],lateral [um]\n0,0\n0.25,2\n0.5,0\n0.75,-2\n")
    assert str(result) == text
    path.unlink()
    (tmp_path / "result").write_bytes(pickle.dumps(result))
    code = "import pickle, sys; print(pickle.load(open(sys.argv[1], 'rb')))"
    words = [sys.executable, "-c", code, str(tmp_path / "result")]
    assert subprocess.run(words, capture_output=True, text=True).stdout == text + "\n"
