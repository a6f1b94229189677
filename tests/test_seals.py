"""Seals: damage to datasets and figures is noticed, and what is damaged is set aside."""

import pytest

from microslip import cache


@pytest.fixture
def sealed(tmp_path):
    path = tmp_path / "friction.nc"
    with cache.writing_beside(path, sealed=True) as beside:
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
    "its seal": lambda path: cache.seal_of(path).write_bytes(b"\xff\xfe"),
    "the end of its seal": lambda path: cache.seal_of(path).write_text("0f"),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_is_noticed_and_set_aside(kind, sealed):
    assert not cache.is_damaged(sealed)
    assert cache.set_damaged_aside([sealed]) == []
    DAMAGE[kind](sealed)
    content = sealed.read_bytes()
    assert cache.is_damaged(sealed)
    assert cache.set_damaged_aside([sealed]) == [sealed]
    assert not sealed.exists()
    assert sealed.with_name("friction.nc.damaged").read_bytes() == content
    assert cache.set_damaged_aside([sealed]) == []


def test_without_a_file_or_a_seal_nothing_is_damaged(sealed):
    other = sealed.with_name("other.nc")
    other.write_bytes(b"\x89HDF, not sealed")
    sealed.unlink()
    assert cache.set_damaged_aside([sealed, other]) == []
    assert other.exists()


def test_a_new_content_has_a_new_seal(sealed):
    with cache.writing_beside(sealed, sealed=True) as beside:
        beside.write_bytes(b"less friction")
    assert not cache.is_damaged(sealed)
    assert sealed.read_bytes() == b"less friction"


def test_a_run_that_is_killed_between_seal_and_file_leaves_no_good_looking_one(sealed, monkeypatch):
    replace = cache.os.replace

    def killed(source, target):
        if target == sealed:
            raise KeyboardInterrupt
        replace(source, target)

    monkeypatch.setattr(cache.os, "replace", killed)
    with (
        pytest.raises(KeyboardInterrupt),
        cache.writing_beside(sealed, sealed=True) as beside,
    ):
        beside.write_bytes(b"newer")
    assert cache.is_damaged(sealed)
