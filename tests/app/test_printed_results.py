"""print() of results: the lines of the command, or a short summary without arrays."""

import numpy as np
import pytest

import microslip
from microslip.app.cli import main

POINTS = [
    (["transverse", "--velocity", "0.1", "--amplitude", "1"], ("transverse", 0.1, 1.0), {}),
    (
        ["transverse", "--amplitude", "1", "--force", "0.3", "--tolerance", "1e-2"],
        ("transverse", None, 1.0),
        {"force": 0.3, "tolerance": 1e-2},
    ),
    (["continuous-bore", "--velocity", "0.5"], ("continuous-bore", 0.5), {}),
]


@pytest.mark.slow
@pytest.mark.parametrize(("words", "place", "others"), POINTS, ids=str)
def test_a_result_prints_what_the_command_prints(words, place, others, capsys):
    assert main(["point", *words]) == 0
    assert capsys.readouterr().out == f"{microslip.solve(*place, **others)}\n"


def test_a_result_that_is_not_converged_says_why(capsys):
    words = ["--velocity", "0.1", "--amplitude", "1", "--cells", "4", "--steps", "8"]
    assert main(["point", "transverse", *words]) == 1
    result = microslip.solve("transverse", 0.1, 1.0, cells=4, steps=8)
    assert capsys.readouterr().out == f"{result}\n" and f"mu_macro: {result.reason}" in str(result)


def test_a_response_prints_what_the_command_prints(tmp_path, capsys):
    file = tmp_path / "path.csv"
    file.write_text("forward,load\n" + "".join(f"{0.1 * k},1\n" for k in range(5)))
    assert main(["response", str(file), "--tolerance", "1e-2"]) == 0
    path = {"forward": 0.1 * np.arange(5), "load": np.ones(5)}
    assert capsys.readouterr().out == f"{microslip.response(**path, tolerance=1e-2)}\n"


def test_records_of_arrays_print_a_few_lines():
    place = {"velocity": 0.5, "amplitude": 0.5, "cells": 4, "steps": 8}
    period = microslip.period("transverse", **place)
    history = microslip.history("transverse", **place, periods=2)
    for text in (str(period), str(history)):
        assert text.count("\n") < 5 and "array" not in text
    assert f"mu_macro = {period.mu_macro:.6g}" in str(period)
    assert f"force_forward = {history.force_forward[-1]:.6g}" in str(history)
