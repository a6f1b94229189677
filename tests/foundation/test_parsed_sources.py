"""What was read off sources is kept, and nothing that is kept is ever taken for something else."""

import pytest

from microslip.foundation import parsed_sources, source_digest


@pytest.fixture
def package(tmp_path):
    (tmp_path / "a.py").write_text("A = 1\n")
    (tmp_path / "b.py").write_text(f"from {tmp_path.name} import a\n")
    return tmp_path


def digest(package):
    sources = source_digest.Sources(package)
    return sources.digest(sources.closure({"b.py"}))


def test_a_second_process_parses_nothing(package, monkeypatch):
    first = digest(package)
    monkeypatch.setattr("ast.parse", None)
    assert digest(package) == first


def test_an_edit_is_parsed_and_the_way_back_is_known(package, monkeypatch):
    first = digest(package)
    (package / "a.py").write_text("A = 2\n")
    assert digest(package) != first
    (package / "a.py").write_text("A = 1\n")
    monkeypatch.setattr("ast.parse", None)
    assert digest(package) == first


@pytest.mark.parametrize(
    "damage", [lambda b: b[:-9], lambda b: b"", lambda b: b.replace(b"a", b"b")]
)
def test_what_is_damaged_counts_as_empty(damage, package):
    first = digest(package)
    (kept,) = (package / "__pycache__").glob("sources.*.json")
    whole = kept.read_bytes()
    kept.write_bytes(damage(whole))
    assert digest(package) == first
    assert kept.read_bytes() == whole


def test_where_nothing_can_be_written_nothing_is_kept(package):
    (package / "__pycache__").write_text("in the way")
    assert digest(package) == digest(package)


def test_the_same_text_says_other_things_in_other_places(tmp_path):
    answers = parsed_sources.Answers(tmp_path)
    assert answers.of("one", b"text", lambda: 1) == 1
    assert answers.of("two", b"text", lambda: 2) == 2
    answers.keep()
    again = parsed_sources.Answers(tmp_path)
    assert [again.of(question, b"text", None) for question in ("one", "two")] == [1, 2]


def test_what_nobody_asks_for_is_forgotten_in_time(tmp_path, monkeypatch):
    monkeypatch.setattr(parsed_sources, "MOST", 3)
    for begin in (0, 2):
        answers = parsed_sources.Answers(tmp_path)
        for number in range(begin, begin + 2):
            answers.of("what", bytes([number]), lambda: 1)
        answers.keep()
    later = parsed_sources.Answers(tmp_path)
    assert later.of("what", bytes([0]), lambda: "new") == "new"
    assert later.of("what", bytes([3]), lambda: "new") == 1
