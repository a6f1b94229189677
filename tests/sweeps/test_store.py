"""The store: a record is read as it was written, or counts as missing."""

import concurrent.futures
import errno
import logging
import os
import signal
import subprocess
import sys
import textwrap
from unittest.mock import Mock

import pytest
from stubs.in_process import ENVIRONMENT

from microslip.foundation import files
from microslip.foundation.files import CacheError
from microslip.sweeps.store import Store

KEY = "ab" + "0" * 62
RECORD = {
    "request": {"velocity": "0.1"},
    "result": {"mu_macro": 0.1 + 0.2, "reason": "", "x": None},
}


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "results")


def written(store, group):
    store.write(group, KEY, RECORD)
    return store.path(group, KEY)


def leftovers(store):
    return [p for p in store.folder.rglob("*") if p.is_file() and p.suffix != ".json"]


def test_a_record_comes_back_equal_to_the_last_bit(store):
    path = written(store, "points/bore")
    assert path == store.folder / "points" / "bore" / "ab" / f"{KEY}.json"
    assert store.read("points/bore", KEY) == {**RECORD, "key": KEY}
    assert not leftovers(store)


def test_what_was_never_written_is_absent(store):
    assert store.read("points/bore", KEY) is None
    store.write("points/bore", KEY, RECORD)
    assert store.read("points/transverse", KEY) is None


def test_equal_records_give_equal_bytes(store):
    store.write("b", KEY, dict(reversed(RECORD.items())))
    assert written(store, "a").read_bytes() == store.path("b", KEY).read_bytes()


def test_a_record_with_nan_is_refused(store):
    with pytest.raises(ValueError, match="not JSON compliant"):
        store.write("a", KEY, {"mu_macro": float("nan")})
    assert store.read("a", KEY) is None


def test_a_truncated_file_is_absent_at_every_length(store):
    path = written(store, "a")
    whole = path.read_bytes()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        assert store.read("a", KEY) is None


def test_a_file_with_any_flipped_bit_is_absent(store):
    path = written(store, "a")
    whole = path.read_bytes()
    for index, byte in enumerate(whole):
        bit = index % 8
        path.write_bytes(whole[:index] + bytes([byte ^ 1 << bit]) + whole[index + 1 :])
        assert store.read("a", KEY) is None


@pytest.mark.parametrize(
    "content", [b"", b"[]", b"null", b"{}", b'{"record": 1}', b"\xff", b"[" * 9999]
)
def test_a_file_with_other_content_is_absent(store, content):
    written(store, "a").write_bytes(content)
    assert store.read("a", KEY) is None


def test_a_record_in_the_wrong_place_is_absent(store):
    path = written(store, "a")
    other = "cd" + "0" * 62
    store.path("a", other).parent.mkdir(parents=True)
    path.rename(store.path("a", other))
    assert store.read("a", other) is None


def test_a_damaged_file_is_reported_and_then_replaced(store, caplog):
    path = written(store, "a")
    path.write_bytes(path.read_bytes()[:-5])
    with caplog.at_level(logging.WARNING):
        assert store.read("a", KEY) is None
    assert caplog.messages == [f"damaged result {path}: computed again"]
    store.write("a", KEY, RECORD)
    caplog.clear()
    assert store.read("a", KEY) == {**RECORD, "key": KEY}
    assert not caplog.messages


@pytest.mark.parametrize("moment", ["fsync", "replace"])
def test_killed_before_the_rename_nothing_is_lost(store, moment):
    """After a SIGKILL during the replacement of a result the former result is read."""
    path = written(store, "a")
    program = f"""
        import os, signal
        from microslip.sweeps.store import Store
        os.{moment} = lambda *args: os.kill(os.getpid(), signal.SIGKILL)
        Store({str(store.folder)!r}).write("a", {KEY!r}, {{"other": 1}})
    """
    jobs = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], env=ENVIRONMENT)
    assert jobs.returncode == -signal.SIGKILL
    assert path.exists()
    assert len(leftovers(store)) == 1
    assert store.read("a", KEY) == {**RECORD, "key": KEY}


def test_an_interrupt_leaves_nothing_behind(store, monkeypatch):
    monkeypatch.setattr(files.os, "fsync", Mock(side_effect=KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        store.write("a", KEY, RECORD)
    assert store.read("a", KEY) is None
    assert not leftovers(store)


full = Mock(side_effect=OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))


def test_a_full_disk_gives_one_message_that_says_what_to_do(store, monkeypatch):
    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(CacheError, match=r"No space left on device.*make room") as caught:
        store.write("a", KEY, RECORD)
    assert "\n" not in str(caught.value)
    assert not leftovers(store)


@pytest.mark.parametrize(
    "message",
    [PermissionError(errno.EACCES, "Permission denied"), RuntimeError("NetCDF: HDF error")],
)
def test_what_hdf5_says_on_a_full_disk_is_put_right(store, monkeypatch, message):
    monkeypatch.setattr(files.os, "fsync", full)
    with (
        pytest.raises(CacheError, match=r"cannot write .*No space left on device.*make room"),
        files.writing_beside(store.folder / "x.nc") as beside,
    ):
        beside.write_text("half")
        raise message
    assert not leftovers(store)


@pytest.mark.parametrize(
    ("error", "kind", "text"),
    [
        (RuntimeError("NetCDF: HDF error"), CacheError, "cannot write .*x.nc: NetCDF: HDF error"),
        (RuntimeError("dictionary changed"), RuntimeError, "^dictionary changed"),
    ],
)
def test_errors_of_netcdf_and_of_the_code_are_told_apart(store, error, kind, text):
    with pytest.raises(kind, match=text), files.writing_beside(store.folder / "x.nc"):
        raise error


def test_old_halves_of_files_are_cleared_and_nothing_else(store):
    path = written(store, "a")
    old, young = (path.with_name(f".{name}.json.0123.part") for name in "ab")
    for half in (old, young):
        half.write_text("half")
    for half in (path, old):
        os.utime(half, (0, 0))
    assert files.clear_abandoned(store.folder) == [old]
    assert {p.name for p in path.parent.iterdir()} == {path.name, young.name}


def test_a_file_in_the_place_of_a_folder_gives_the_same_message(store):
    store.folder.write_text("not a folder")
    with pytest.raises(CacheError, match=r"cannot write .*another folder"):
        store.write("a", KEY, RECORD)
    with pytest.raises(CacheError, match="cannot read"):
        store.read("a", KEY)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder_gives_the_same_message(store):
    store.folder.mkdir()
    store.folder.chmod(0o500)
    with pytest.raises(CacheError, match=r"Permission denied.*set permissions"):
        store.write("a", KEY, RECORD)


def test_many_threads_and_containers_write_one_result_without_disturbing_each_other(
    store, monkeypatch
):
    """Threads, and processes in containers, have equal process numbers."""
    monkeypatch.setattr(os, "getpid", lambda: 7)
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        jobs = [pool.submit(store.write, "a", KEY, RECORD) for _ in range(400)]
    assert all(future.result() is None for future in jobs)
    assert store.read("a", KEY) == {**RECORD, "key": KEY}
    assert not leftovers(store)
