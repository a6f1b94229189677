"""Stamps of products: damage, other inputs, and dates for Snakemake."""

import os
import time

import pytest

from microslip.sweeps import stamps


@pytest.fixture
def product(tmp_path):
    """The stamp of a dataset and its page, and the paths of both."""
    paths = [tmp_path / "friction.nc", tmp_path / "summaries" / "friction.html"]
    for path in paths:
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"friction " * 1000)
    stamp = tmp_path / stamps.stamp_of("friction")
    stamps.write(stamp, "f00d", paths)
    return stamp, paths


def flip_a_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


DAMAGE = {
    "a bit": flip_a_bit,
    "the end": lambda path: os.truncate(path, path.stat().st_size - 1),
    "all": lambda path: os.truncate(path, 0),
    "longer": lambda path: path.write_bytes(path.read_bytes() + b"\0"),
    "gone": lambda path: path.unlink(),
}


@pytest.mark.parametrize("kind", DAMAGE)
@pytest.mark.parametrize("which", [0, 1])
def test_damage_to_a_file_is_noticed(kind, which, product):
    stamp, paths = product
    assert stamps.fits(stamp, "f00d", paths)
    assert not stamps.is_damaged(paths[0])
    DAMAGE[kind](paths[which])
    assert not stamps.fits(stamp, "f00d", paths)
    if paths[0].exists():
        assert stamps.is_damaged(paths[0]) == (which == 0)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"[]", b"{}", b'{"made_of":"f00d"}'])
def test_a_damaged_stamp_fits_nothing(content, product):
    stamp, paths = product
    stamp.write_bytes(content)
    assert not stamps.fits(stamp, "f00d", paths)


def test_a_product_is_made_of_what_its_stamp_says_and_of_nothing_else(product):
    stamp, paths = product
    assert not stamps.fits(stamp, "beef", paths)
    assert not stamps.fits(stamp, "f00d", paths[:1])
    assert not stamps.fits(stamp.with_name("other.json"), "f00d", paths)


def test_without_a_stamp_a_file_is_judged_by_how_it_begins(tmp_path):
    path = tmp_path / "other.nc"
    path.write_bytes(b"\x89HDF, written by other means")
    assert not stamps.is_damaged(path)
    path.write_text("velocity,mu_macro\n")
    assert stamps.is_damaged(path)


def test_a_file_that_the_workflow_did_not_make_is_renamed(product):
    stamp, paths = product
    stamps.set_aside(stamp, paths)
    assert all(path.exists() for path in paths)
    paths[0].write_text("mine")
    stamps.set_aside(stamp, paths)
    assert not paths[0].exists() and paths[1].exists()
    assert paths[0].with_name("friction.nc.damaged").read_text() == "mine"


def test_what_is_made_again_is_older_than_the_file_again_and_nothing_is_of_the_future(tmp_path):
    wrong, right, future = (tmp_path / name for name in ("wrong", "right", "future"))
    for path in (wrong, right, future):
        path.touch()
    os.utime(right, (10, 10))
    os.utime(future, (4e9, 4e9))
    stamps.write_again(tmp_path / stamps.AGAIN, dated=True)
    stamps.date([wrong, tmp_path / "none"], right=False)
    stamps.date([right, future], right=True)
    date = {path.name: path.stat().st_mtime for path in tmp_path.iterdir()}
    assert date["wrong"] < date[stamps.AGAIN] < time.time()
    assert (date["right"], date["future"]) == (10, pytest.approx(time.time(), abs=60))
