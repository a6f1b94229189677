"""Runs without a shared file system: files travel through a local S3 server.

Needs moto's server and Snakemake's plugin for S3, else the tests are skipped.
"""

import re
import shutil
import socket
import subprocess
import sys
import time

import pytest
import yaml
from stubs.workflow_project import ENVIRONMENT, RUN, TINY, snakemake

pytest.importorskip("moto.server")
pytest.importorskip("snakemake_storage_plugin_s3")
boto3 = pytest.importorskip("boto3")
pytestmark = pytest.mark.long

BUCKET, FOLDER = "bucket", "friction"
KEYS = {"AWS_ACCESS_KEY_ID": "a", "AWS_SECRET_ACCESS_KEY": "b", "AWS_DEFAULT_REGION": "us-east-1"}
STORAGE = [
    "--default-storage-provider",
    "s3",
    "--default-storage-prefix",
    f"s3://{BUCKET}/{FOLDER}",
]


@pytest.fixture(scope="module")
def server():
    """Address of a server with an empty bucket."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)]
    running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}"
    for _ in range(600):
        with socket.socket() as request:
            if request.connect_ex(("127.0.0.1", port)) == 0:
                break
        time.sleep(0.1)
    client(address).create_bucket(Bucket=BUCKET)
    yield address
    running.terminate()
    running.wait()


def client(address):
    settings = {name.lower(): value for name, value in KEYS.items() if "KEY" in name}
    return boto3.client("s3", endpoint_url=address, region_name="us-east-1", **settings)


def run(folder, address, *arguments):
    """Run the workflow with all files in the bucket; return its output."""
    plugin = {
        "SNAKEMAKE_STORAGE_S3_ENDPOINT_URL": address,
        "SNAKEMAKE_STORAGE_S3_ACCESS_KEY": "a",
        "SNAKEMAKE_STORAGE_S3_SECRET_KEY": "b",
    }
    environment = {**ENVIRONMENT, **KEYS, **plugin}
    process = snakemake([*arguments, *RUN, *STORAGE], folder, environment)
    assert process.returncode == 0, process.stderr
    return process.stdout + process.stderr


def stored(address):
    """Contents of all files in the bucket, by name."""
    s3 = client(address)
    listed = s3.list_objects_v2(Bucket=BUCKET)["Contents"]
    names = [entry["Key"] for entry in listed]
    return {
        name.removeprefix(f"{FOLDER}/"): s3.get_object(Bucket=BUCKET, Key=name)["Body"].read()
        for name in names
    }


def computed(files):
    """Number of computed points according to the logs of jobs in the bucket."""
    logs = (text.decode() for name, text in files.items() if name.endswith(".log"))
    return sum(int(log.split(" points, ")[1].split()[0]) for log in logs if " computed in " in log)


def empty_copy(finished, folder):
    """The project on another machine, without any files of earlier runs."""
    left = shutil.ignore_patterns("results", ".snakemake")
    shutil.copytree(finished.folder, folder, ignore=left)
    return folder


def dataset_in(files, name="transverse"):
    """Content of the only dataset with this plain name; its file is named by content."""
    (found,) = (
        text for file, text in files.items() if re.match(rf"results/data/{name}\..*nc$", file)
    )
    return found


def with_transverse(**changed):
    return yaml.safe_dump({"sweeps": {"transverse": TINY["sweeps"]["transverse"] | changed}})


@pytest.fixture(scope="module")
def first(finished, server, tmp_path_factory):
    """Contents of the bucket after a run on an empty machine."""
    run(empty_copy(finished, tmp_path_factory.mktemp("first") / "it"), server, "transverse", "bore")
    return stored(server)


def test_points_are_solved_once_and_datasets_are_those_of_a_local_run(
    finished, first, server, tmp_path
):
    assert computed(first) == 8 + 1  # points, and a single run for a figure
    for name in ("transverse", "bore"):
        local = (finished.folder / f"results/{name}.nc").read_bytes()
        assert dataset_in(first, name) == local
    # on another machine, there is nothing to do
    other = empty_copy(finished, tmp_path / "other")
    assert "Nothing to be done" in run(other, server, "transverse", "bore")
    # one more velocity: all rows are solved again
    (other / "tiny.yaml").write_text(with_transverse(velocity=[0.5, 2, 3]))
    run(other, server, "transverse")
    grown = stored(server)
    assert computed(grown) - computed(first) == 6
    assert len([name for name in grown if name.startswith("results/data/transverse.")]) == 4
    # and a third machine, with the first configuration
    assert "Nothing to be done" in run(
        empty_copy(finished, tmp_path / "third"), server, "transverse"
    )


def test_a_job_on_a_machine_of_its_own_finds_its_requests(finished, first, server, tmp_path):
    """A job as started by an executor without shared files: from the name of its batch alone."""
    name = next(name for name in first if "batches/bore/" in name)
    client(server).delete_object(Bucket=BUCKET, Key=f"{FOLDER}/{name}")
    job = f"solve_batch:folder=bore,batch={name.split('/')[-1].removesuffix('.jsonl')}"
    alone = ["--target-jobs", job, "--allowed-rules", "solve_batch", "--mode", "remote", "--nolock"]
    run(empty_copy(finished, tmp_path / "alone"), server, *alone)
    assert stored(server)[name] == first[name]


def test_a_certified_map_is_made_in_the_bucket_and_is_there_for_another_machine(
    finished, server, tmp_path
):
    map_ = with_transverse(velocity=[0.1, 10], amplitude=[0.5, 3], error=0.1, tolerance=0.01)
    for machine in ("one", "two"):
        folder = empty_copy(finished, tmp_path / machine)
        (folder / "tiny.yaml").write_text(map_)
        message = run(folder, server, "transverse")
        assert ("solve_map" in message) == (machine == "one")
