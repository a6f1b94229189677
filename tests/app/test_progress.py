"""The line of progress of a whole run."""

import io
import re
import sys
import time

import pytest

from microslip.app import progress


def test_every_point_counts_when_it_is_done(tmp_path):
    path = tmp_path / "done"
    items = progress.counted(["a", "b"], path)
    assert next(items) == "a"
    assert not path.exists()
    assert next(items) == "b"
    assert path.stat().st_size == 1
    assert list(items) == []
    assert path.stat().st_size == 2
    assert list(progress.counted([1, 2, 3], path)) == [1, 2, 3]
    assert path.stat().st_size == 5


def test_what_cannot_be_counted_is_done_all_the_same(tmp_path):
    assert list(progress.counted([1, 2], tmp_path)) == [1, 2]


def test_points_of_all_jobs_rate_and_end_are_shown(tmp_path, capsys):
    path = tmp_path / "logs" / "done"
    shown = progress.Watch(path)
    path.parent.mkdir()
    path.write_bytes(b"left by the run before")
    shown.start(5)
    assert shown.done() == 0
    list(progress.counted(range(5), path))
    shown.stop()
    said = capsys.readouterr().err
    assert "5/5" in said
    assert "point/s" in said


def test_points_are_shown_where_nobody_knows_how_many_there_will_be(tmp_path, capsys):
    path = tmp_path / "done"
    shown = progress.Watch(path)
    shown.start(None)
    list(progress.counted(range(5), path))
    shown.stop()
    assert re.search(r"points: 5point \[.*point/s\]", capsys.readouterr().err)


@pytest.mark.parametrize("total", [0, 3])
def test_a_run_without_points_or_without_a_disk_shows_nothing(total, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    shown = progress.Watch(tmp_path / "file" / "done")
    shown.start(total)
    time.sleep(0.01)
    shown.stop()
    assert capsys.readouterr().err == ""


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
