"""Snakemake, imported once: each start is a fork of a process after this import.

The import takes longer than most runs in tests. The process does not import this package, so
that each start reads the workflow and the sources of its own project.
"""

import atexit
import json
import os
import subprocess
import sys
import tempfile
import threading
from contextlib import ExitStack
from functools import cache
from importlib import import_module
from pathlib import Path

try:
    from stubs import forked, job_server
except ImportError:  # in the process itself
    import forked

    job_server = None


def start(arguments, folder, environment, timeout=900):
    """Run Snakemake with these arguments in a folder, as subprocess.run does a command."""
    server = _server(tuple(sorted(environment.items())))
    with ExitStack() as stack:
        said = [stack.enter_context(tempfile.NamedTemporaryFile("w+")) for _ in range(2)]
        asked = {"arguments": list(map(str, arguments)), "folder": str(folder)}
        asked["said"] = [file.name for file in said]
        code = server.ask(asked | {"timeout": timeout})
        for file in said:
            file.seek(0)
        return subprocess.CompletedProcess(arguments, code, *(file.read() for file in said))


class _Server:
    def __init__(self, environment):
        self.lock = threading.Lock()
        self.process = subprocess.Popen(
            [sys.executable, __file__, job_server.python(environment)],
            env=dict(environment),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        atexit.register(self.process.stdin.close)

    def ask(self, asked):
        with self.lock:
            print(json.dumps(asked), file=self.process.stdin, flush=True)
            return int(self.process.stdout.readline())


@cache
def _server(environment):
    return _Server(environment)


# The server

LOADED_LATER = ("jsonschema", "nbformat", "requests", "smart_open", "snakemake.storage", "tqdm")


def main():
    from snakemake import cli

    cli.get_argument_parser()  # imports all plugins
    for name in LOADED_LATER:
        import_module(name)
    sys.path.remove(str(Path(__file__).parent))
    for line in sys.stdin:
        asked = json.loads(line)
        child = os.fork()
        if not child:
            _run(asked)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


def _run(asked):
    import signal

    from snakemake.cli import main as snakemake

    signal.alarm(asked["timeout"])  # ends this fork
    sys.executable = sys.argv[1]  # path of the program that starts jobs
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    for number, name in enumerate(asked["said"], 1):
        os.dup2(os.open(name, os.O_WRONLY), number)
    os.chdir(asked["folder"])
    sys.argv = ["snakemake", *asked["arguments"]]
    forked.end_with(lambda: snakemake(asked["arguments"]))


if __name__ == "__main__":
    main()
