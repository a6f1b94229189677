"""Progress of one calculation."""

import io
import sys
import time

from microslip.app import progress


def test_items_are_counted_with_their_rate(capsys):
    assert list(progress.bar(iter("abc"), 3, "certified_bore")) == ["a", "b", "c"]
    said = capsys.readouterr().err
    assert "certified_bore: 100%" in said and "3/3" in said and "point/s" in said


class Terminal(io.StringIO):
    """Standard error of a terminal."""

    def isatty(self):
        return True


def elapsed(monkeypatch, stream):
    for name in ("FIRST_LINE", "BETWEEN_LINES", "BETWEEN_LINES_OF_A_FILE"):
        monkeypatch.setattr(progress, name, 0.02)
    monkeypatch.setattr(sys, "stderr", stream)
    with progress.Elapsed("microslip predict"):
        time.sleep(0.1)
    return stream.getvalue()


def test_a_terminal_shows_the_elapsed_time_in_a_line_that_goes(monkeypatch):
    text = elapsed(monkeypatch, Terminal())
    assert "\rmicroslip predict: 0 s" in text
    assert text.split("\r")[-1] == "" and text.split("\r")[-2].isspace()


def test_a_file_gets_lines_of_the_elapsed_time(monkeypatch):
    assert "microslip predict: 0 s\n" in elapsed(monkeypatch, io.StringIO())
