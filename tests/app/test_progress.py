"""The elapsed time of a calculation."""

import io
import sys
import time

from microslip.app import progress


class Terminal(io.StringIO):
    """A stream that acts as the standard error of a terminal."""

    def isatty(self):
        return True


def elapsed(monkeypatch, stream):
    for name in ("FIRST_LINE", "BETWEEN_LINES", "BETWEEN_LINES_OF_A_FILE"):
        monkeypatch.setattr(progress, name, 0.02)
    monkeypatch.setattr(sys, "stderr", stream)
    with progress.elapsed_time("microslip predict"):
        time.sleep(0.1)
    return stream.getvalue()


def test_a_terminal_shows_the_elapsed_time_in_a_line_that_goes(monkeypatch):
    text = elapsed(monkeypatch, Terminal())
    assert "\rmicroslip predict: 0 s" in text
    assert text.split("\r")[-1] == "" and text.split("\r")[-2].isspace()


def test_a_file_gets_lines_of_the_elapsed_time(monkeypatch):
    assert "microslip predict: 0 s\n" in elapsed(monkeypatch, io.StringIO())
