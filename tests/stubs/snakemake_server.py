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
        message = [stack.enter_context(tempfile.NamedTemporaryFile("w+")) for _ in range(2)]
        request = {"arguments": list(map(str, arguments)), "folder": str(folder)}
        request["said"] = [file.name for file in message]
        code = server.ask(request | {"timeout": timeout})
        for file in message:
            file.seek(0)
        return subprocess.CompletedProcess(arguments, code, *(file.read() for file in message))


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
        request = json.loads(line)
        child = os.fork()
        if not child:
            _run(request)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


def _run(request):
    import signal

    from snakemake.cli import main as snakemake

    signal.alarm(request["timeout"])  # ends this fork
    sys.executable = sys.argv[1]  # path of the program that starts jobs
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    for number, name in enumerate(request["said"], 1):
        os.dup2(os.open(name, os.O_WRONLY), number)
    os.chdir(request["folder"])
    sys.argv = ["snakemake", *request["arguments"]]
    forked.end_with(lambda: snakemake(request["arguments"]))


if __name__ == "__main__":
    main()
