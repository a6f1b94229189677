"""Bad options of `microslip predict`: an error message with the option, before any solve."""

import pytest
from bad_input_tables.bad_predictions import GOOD, PREDICTIONS

from microslip.app import cli


def refused(changed, part, capsys, *flags):
    settings = {"motion": "transverse"} | GOOD | changed
    motion = settings.pop("motion")
    words = [f"--{name.replace('_', '-')}={text}" for name, text in settings.items() if text]
    assert cli.main(["predict", motion, *words, *flags]) == 2
    out, line = capsys.readouterr()
    assert out == "" and line.startswith("microslip predict: ") and line.count("\n") == 1
    assert part in line


@pytest.fixture(autouse=True)
def nothing_runs(monkeypatch):
    def work(*_, **__):
        raise AssertionError("work has started")

    monkeypatch.setattr("microslip.si.solve.solve", work)


@pytest.mark.parametrize(("changed", "part"), PREDICTIONS, ids=repr)
def test_a_contact_is_refused_in_one_line(changed, part, capsys):
    refused(changed, part, capsys)
