"""Runs without a shared file system: files travel through a local S3 server.

Needs moto's server and Snakemake's plugin for S3, else the tests are skipped.
"""

import shutil
import socket
import subprocess
import sys
import time

import pytest
import yaml
from stubs import snakemake_server
from stubs.workflow_project import AXES, ENVIRONMENT, RUN, TINY

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
    process = snakemake_server.start([*arguments, *RUN, *STORAGE], folder, environment, timeout=600)
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
    logs = (text.decode() for name, text in files.items() if "logs/solve/" in name)
    return sum(int(log.split(" points, ")[1].split()[0]) for log in logs)


def empty_copy(finished, folder):
    """The project on another machine, without any files of earlier runs."""
    left = shutil.ignore_patterns("results", ".snakemake")
    shutil.copytree(finished.folder, folder, ignore=left)
    return folder


DATASETS = ["results/transverse.nc", "results/bore.nc"]
DATASET = DATASETS[0]


def with_transverse(**changed):
    return yaml.safe_dump({**TINY, "sweeps": {"transverse": {**AXES, **changed}}})


@pytest.fixture(scope="module")
def first(finished, server, tmp_path_factory):
    """Contents of the bucket after a run on an empty machine."""
    run(empty_copy(finished, tmp_path_factory.mktemp("first") / "it"), server, *DATASETS)
    return stored(server)


def test_points_are_solved_once_and_datasets_are_those_of_a_local_run(
    finished, first, server, tmp_path
):
    assert computed(first) == 8 + 1  # points, and a single run for a figure
    assert {name: first[name] for name in DATASETS} == {
        name: (finished.folder / name).read_bytes() for name in DATASETS
    }
    # two more amplitudes, on another machine: the block of the first two is there
    other = empty_copy(finished, tmp_path / "other")
    (other / "tiny.yaml").write_text(with_transverse(amplitude=[0, 1, 2, 3]))
    run(other, server, DATASET)
    grown = stored(server)
    assert grown[DATASET] != first[DATASET]
    assert computed(grown) - computed(first) == 4
    # one more velocity: all rows are solved again
    third = empty_copy(finished, tmp_path / "third")
    (third / "tiny.yaml").write_text(with_transverse(velocity=[0.5, 2, 3]))
    run(third, server, DATASET)
    assert computed(stored(server)) - computed(grown) == 6
    # and a fourth machine, with the first configuration
    run(empty_copy(finished, tmp_path / "fourth"), server, DATASET)
    assert stored(server)[DATASET] == first[DATASET]
    assert computed(stored(server)) - computed(grown) == 6


def test_a_job_on_a_machine_of_its_own_finds_its_requests(finished, first, server, tmp_path):
    """A job as started by an executor without shared files: from the name of its batch alone."""
    (name,) = (name for name in first if "batches/bore/" in name)
    client(server).delete_object(Bucket=BUCKET, Key=f"{FOLDER}/{name}")
    job = f"solve:group=bore,batch={name.split('/')[-1].removesuffix('.jsonl')}"
    alone = ["--target-jobs", job, "--allowed-rules", "solve", "--mode", "remote", "--nolock"]
    run(empty_copy(finished, tmp_path / "alone"), server, *alone)
    assert stored(server)[name] == first[name]


def test_a_certified_map_is_made_in_the_bucket_and_answers_another_machine(
    finished, server, tmp_path
):
    map_ = with_transverse(velocity=[0.1, 10], amplitude=[0.5, 3], adaptive={"error": 0.1})
    datasets = []
    for machine in ("one", "two"):
        folder = empty_copy(finished, tmp_path / machine)
        (folder / "tiny.yaml").write_text(map_)
        message = run(folder, server, "results/certified_transverse.nc")
        datasets.append(stored(server)["results/certified_transverse.nc"])
        assert ("rule map:" in message or "map " in message) == (machine == "one")
    assert datasets[0] == datasets[1]
