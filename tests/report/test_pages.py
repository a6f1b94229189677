"""The page of the study `claims`: verdicts, numbers, and commands that repeat each run."""

import html
import inspect
import re
import shlex

import pytest
from stubs.claims_stub import configured
from stubs.figures_stub import studies

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.report import pages
from microslip.scene.hertz import HERTZ
from microslip.studies import registry, verdicts
from microslip.studies.claims import command


@pytest.fixture(scope="module")
def data():
    return studies()["claims"]


@pytest.fixture(scope="module")
def page(data):
    return pages.page(data, ["a line"])


def test_every_verdict_is_there_with_a_run_that_shows_it(page, data):
    top = page[: page.index('<h2 id="claim1"')]
    rows = re.findall(r"<tr><td.*?</tr>", top, flags=re.DOTALL)
    assert len(rows) == 10
    for row, verdict in zip(rows, data["verdict"].values, strict=True):
        assert verdicts.WORDS[int(verdict)] in row
        assert re.search(r'href="#run\d+"', row)
    sections = page.split('<h2 id="claim')[1:]
    for section in sections:
        assert "<code>" in section.partition("<details>")[0]


def test_links_have_targets_on_the_page_and_nothing_is_external(page):
    links = set(re.findall(r'href="([^"]*)"', page))
    assert links
    for link in links:
        assert link.startswith("#")
        assert f'id="{link[1:]}"' in page
    assert not re.search(r"https?://|<script|<link|<img|@import|url\(", page)


def test_numbers_and_runs_are_those_of_the_dataset(page, data):
    for value in (*data["transverse_paper"].values, *data["bore_paper"].values):
        assert f"{value:.4f}" in page
    text = html.unescape(page[page.index('id="runs"') :])
    for key, line in zip(data["run"].values, data["run_command"].values, strict=True):
        assert key in text
        assert line in text


def test_the_command_of_a_point_requests_that_point(monkeypatch):
    signature, calls = inspect.signature(microslip.solve), []

    def solve(*values, **named):
        calls.append(signature.bind(*values, **named))
        raise InputError("velocity", None, "no result in this test")

    monkeypatch.setattr(microslip, "solve", solve)
    pieces = registry.pieces("claims", configured().claims)
    points = [one for piece in pieces for one in piece if one["kind"] == "point"]
    for request in points:
        program, *words = shlex.split(command(request))
        assert program == "microslip" and cli.main(words) == 2
        calls[-1].apply_defaults()
        arguments = {"pressure": HERTZ} | {
            name: float(value)
            if name in ("velocity", "amplitude", "poisson", "tolerance")
            else value
            for name, value in request.items()
            if name in signature.parameters and value is not None
        }
        assert arguments.items() <= calls[-1].arguments.items(), request
    assert len(calls) == len(points) > 20


def test_text_of_a_dataset_is_escaped(data):
    sly = data.assign(statement=("claim", ["<b>&" for _ in data["claim"]]))
    page = pages.page(sly, ["<i>"])
    assert "<b>" not in page
    assert "<i>" not in page
    assert page.startswith("<!DOCTYPE html>") and "&lt;b&gt;&amp;" in page


def test_a_page_of_another_study_is_html():
    text = pages.page(studies()["stability"], ["a <line>"])
    assert text.startswith("<!DOCTYPE html>")
    assert "a &lt;line&gt;" in text and '<h2 id="runs"' not in text
