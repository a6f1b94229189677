"""Bad configurations: one line that begins with the file and the key."""

import re

import pytest
from bad_input_tables.bad_configurations import FILES, TOGETHER, VALUES, changed

from microslip.config import load


def refusal(path):
    with pytest.raises(load.ConfigError) as caught:
        load.load(path)
    message = str(caught.value)
    assert "\n" not in message and message.isprintable() and "unicode" not in message
    return message


SETTINGS = [({key: value}, key) for key, values in VALUES.items() for value in values]


@pytest.mark.parametrize(("settings", "named"), SETTINGS + TOGETHER, ids=str)
def test_a_bad_setting_is_one_line_that_begins_with_its_key(settings, named, tmp_path):
    path = tmp_path / "sweep.yaml"
    path.write_text(changed(settings))
    message = refusal(path)
    assert message.startswith(f"{path}: {named}: ")
    assert re.search("allowed|required|needs|no amplitude|does not apply", message)


@pytest.mark.parametrize("case", FILES)
def test_a_file_that_is_no_configuration_is_one_line(case, tmp_path):
    content, *parts = FILES[case]
    path = tmp_path / "sweep.yaml"
    path.write_bytes(content)
    message = refusal(path)
    assert message.startswith(f"{path}: ")
    assert [part for part in parts if part not in message] == []


def test_a_file_that_cannot_be_read_is_one_line(tmp_path):
    path = tmp_path / "none.yaml"
    assert refusal(path) == f"{path}: cannot be read: No such file or directory"


@pytest.mark.parametrize("item", ["[%s]", "{<<: [%s]}"], ids=["lists", "merged"])
def test_aliases_that_stand_for_millions_of_values_are_refused(item, tmp_path, monkeypatch):
    """The values are refused before they are constructed."""
    monkeypatch.setattr(
        load.Loader, "construct_document", lambda *args: pytest.fail("it was constructed")
    )
    path = tmp_path / "sweep.yaml"
    lines = [f"a{i}: &a{i} {item % ', '.join([f'*a{i - 1}'] * 10)}\n" for i in range(1, 8)]
    path.write_text("".join(["a0: &a0 {x: 1}\n", *lines]))
    message = refusal(path)
    assert message.startswith(f"{path}: ")
    assert "more than 100000 values" in message


def test_a_configuration_without_an_end_is_refused(tmp_path):
    path = tmp_path / "sweep.yaml"
    path.write_bytes(b"#" * 1_000_001)
    assert refusal(path) == f"{path}: larger than 1 MB; allowed: at most that"
