"""Seals: damage to datasets and figures is noticed, and what they are made of is known."""

import pytest

from microslip.sweeps import sealed_files


@pytest.fixture
def sealed(tmp_path):
    path = tmp_path / "friction.nc"
    with sealed_files.writing_beside(path, sealed=True) as beside:
        beside.write_bytes(b"friction " * 1000)
    return path


def flip_a_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


DAMAGE = {
    "a bit": flip_a_bit,
    "the end": lambda path: path.write_bytes(path.read_bytes()[:-1]),
    "all": lambda path: path.write_bytes(b""),
    "its seal": lambda path: sealed_files.seal_of(path).write_bytes(b"\xff\xfe"),
    "the end of its seal": lambda path: sealed_files.seal_of(path).write_text("0f"),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_is_noticed_and_nothing_is_moved(kind, sealed):
    sealed_files.mark([sealed], "f00d")
    assert not sealed_files.is_damaged(sealed)
    assert sealed_files.is_made_of(sealed, "f00d")
    DAMAGE[kind](sealed)
    assert sealed_files.is_damaged(sealed)
    assert not sealed_files.is_made_of(sealed, "f00d")
    assert sealed.exists()


def test_a_file_is_of_what_its_seal_says_and_of_nothing_else(sealed):
    assert not sealed_files.is_made_of(sealed, "f00d")  # whole, but of what?
    sealed_files.mark([sealed], "f00d")
    assert sealed_files.is_made_of(sealed, "f00d")
    assert not sealed_files.is_made_of(sealed, "beef")
    with sealed_files.writing_beside(sealed, sealed=True) as beside:
        beside.write_bytes(b"friction " * 1000)
    assert not sealed_files.is_made_of(sealed, "f00d")  # the same bytes, but nobody says of what
    sealed_files.mark([sealed], "f00d")
    sealed_files.seal_of(sealed).unlink()
    assert not sealed_files.is_made_of(sealed, "f00d")
    assert not sealed_files.is_made_of(sealed.with_name("none.nc"), "f00d")


def test_the_seal_of_another_file_is_no_seal(sealed):
    """As where results are copied together from two places."""
    sealed_files.mark([sealed], "f00d")
    other = sealed.with_name("other.nc")
    other.write_bytes(b"another friction")
    sealed_files.seal_of(other).write_bytes(sealed_files.seal_of(sealed).read_bytes())
    assert not sealed_files.is_made_of(other, "f00d")


def test_without_a_file_or_a_seal_nothing_is_damaged(sealed):
    other = sealed.with_name("other.nc")
    other.write_bytes(b"\x89HDF, not sealed")
    sealed.unlink()
    assert not sealed_files.is_damaged(sealed) and not sealed_files.is_damaged(other)


def test_a_new_content_has_a_new_seal(sealed):
    with sealed_files.writing_beside(sealed, sealed=True) as beside:
        beside.write_bytes(b"less friction")
    assert not sealed_files.is_damaged(sealed)
    assert sealed.read_bytes() == b"less friction"


def test_a_run_that_is_killed_between_seal_and_file_leaves_no_good_looking_one(sealed, monkeypatch):
    replace = sealed_files.os.replace

    def killed(source, target):
        if target == sealed:
            raise KeyboardInterrupt
        replace(source, target)

    monkeypatch.setattr(sealed_files.os, "replace", killed)
    with (
        pytest.raises(KeyboardInterrupt),
        sealed_files.writing_beside(sealed, sealed=True) as beside,
    ):
        beside.write_bytes(b"newer")
    assert sealed_files.is_damaged(sealed)


@pytest.mark.parametrize("spoil", [lambda path: sealed_files.seal_of(path).unlink(), flip_a_bit])
def test_what_the_workflow_did_not_make_is_kept_beside_the_new_file(spoil, sealed):
    spoil(sealed)
    content = sealed.read_bytes()
    with sealed_files.writing_beside(sealed, sealed=True) as beside:
        beside.write_bytes(b"less friction")
    assert sealed.read_bytes() == b"less friction"
    assert sealed.with_name("friction.nc.damaged").read_bytes() == content
    with sealed_files.writing_beside(sealed, sealed=True) as beside:
        beside.write_bytes(b"no friction")
    assert sealed.with_name("friction.nc.damaged").read_bytes() == content
