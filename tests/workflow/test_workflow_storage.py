"""A run without a shared file system: what jobs declare travels through an S3 server here.

It needs moto's server and Snakemake's plugin for S3; where these are not installed it is left out.
"""

import shutil
import socket
import subprocess
import sys
import time

import pytest
import yaml
from stubs.workflow_project import AXES, ENVIRONMENT, RUN, SNAKEMAKE, TINY

pytest.importorskip("moto.server")
pytest.importorskip("snakemake_storage_plugin_s3")
boto3 = pytest.importorskip("boto3")
pytestmark = pytest.mark.slow

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
        with socket.socket() as asked:
            if asked.connect_ex(("127.0.0.1", port)) == 0:
                break
        time.sleep(0.1)
    client(address).create_bucket(Bucket=BUCKET)
    yield address
    running.terminate()
    running.wait()


def client(address):
    given = {name.lower(): value for name, value in KEYS.items() if "KEY" in name}
    return boto3.client("s3", endpoint_url=address, region_name="us-east-1", **given)


def run(folder, address):
    """Run the workflow with everything it makes in the bucket; what it says."""
    plugin = {
        "SNAKEMAKE_STORAGE_S3_ENDPOINT_URL": address,
        "SNAKEMAKE_STORAGE_S3_ACCESS_KEY": "a",
        "SNAKEMAKE_STORAGE_S3_SECRET_KEY": "b",
    }
    done = subprocess.run(
        [SNAKEMAKE, *RUN, *STORAGE],
        cwd=folder,
        env={**ENVIRONMENT, **KEYS, **plugin},
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def stored(address):
    """Contents of the bucket by name."""
    s3 = client(address)
    listed = s3.list_objects_v2(Bucket=BUCKET)["Contents"]
    names = [entry["Key"] for entry in listed]
    return {
        name.removeprefix(f"{FOLDER}/"): s3.get_object(Bucket=BUCKET, Key=name)["Body"].read()
        for name in names
    }


def computed(files):
    """Points that were computed, by what the logs of the jobs in the bucket say."""
    logs = (text.decode() for name, text in files.items() if "logs/solve_batch" in name)
    return sum(int(log.split(" points, ")[1].split()[0]) for log in logs)


def empty_copy(finished, folder):
    """The project on another machine: nothing of what any run has left."""
    left = shutil.ignore_patterns("results", ".snakemake")
    shutil.copytree(finished.folder, folder, ignore=left)
    return folder


def test_points_are_solved_once_and_datasets_are_those_of_a_local_run(finished, server, tmp_path):
    run(empty_copy(finished, tmp_path / "first"), server)
    files = stored(server)
    assert computed(files) == 10 + 5  # points, and single runs for figures
    local = {p.name: p.read_bytes() for p in (finished.folder / "results").glob("*.nc")}
    assert {name: files[f"results/{name}"] for name in local} == local
    # another machine, with one more velocity: the batch that has it is solved, and no other
    other = empty_copy(finished, tmp_path / "other")
    grown = {**AXES, "velocity": [0.5, 2, 3]}
    configuration = {**TINY, "sweeps": {**TINY["sweeps"], "continuous_bore": None}}
    configuration["sweeps"]["continuous_bore"] = {
        name: value for name, value in grown.items() if name != "amplitude"
    }
    (other / "tiny.yaml").write_text(yaml.safe_dump(configuration))
    run(other, server)
    after = stored(server)
    assert after["results/transverse.nc"] == files["results/transverse.nc"]
    assert after["results/continuous_bore.nc"] != files["results/continuous_bore.nc"]
    batches = {name for name in after if "batches/" in name} - set(files)
    assert [name.split("/")[2] for name in batches] == ["continuous_bore"]
    # and a third one, as it was in the beginning
    run(empty_copy(finished, tmp_path / "third"), server)
    assert stored(server)["results/continuous_bore.nc"] == files["results/continuous_bore.nc"]
