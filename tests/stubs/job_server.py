"""Snakemake and its jobs as forks of a process that has imported the libraries.

Snakemake starts Python for every script, and most of the time of both goes into imports of
libraries. The server process does not import this package: each fork reads the sources of its
own project.

`python` is a program that runs in place of Python. It asks the server for a fork with its
folder, environment and streams, and ends like the fork. Commands of pages start it, too.
"""

import atexit
import contextlib
import json
import os
import runpy
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import threading
from functools import cache
from importlib import import_module
from pathlib import Path

LIBRARIES = (
    *("numba", "scipy.special", "scipy.linalg", "scipy.optimize"),
    *("netCDF4", "xarray", "dask.array", "pint", "matplotlib.figure", "matplotlib.offsetbox"),
    *("matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf"),
    *("yaml", "jsonschema", "tqdm", "snakemake.cli", "snakemake.script", "snakemake.storage"),
    *("nbformat", "requests", "smart_open"),
)

CLIENT = """\
import json, os, socket, sys
asked = {"arguments": sys.argv[2:], "folder": os.getcwd(), "environment": dict(os.environ)}
server = socket.socket(socket.AF_UNIX)
server.connect(sys.argv[1])
socket.send_fds(server, [b"."], [0, 1, 2])
server.sendall(json.dumps(asked).encode() + b"\\n")
raise SystemExit(int(server.recv(9) or b"1"))
"""


@cache
def python(environment):
    """Start the server; return the path of the program that replaces Python.

    environment: environment variables of the server, as a tuple of pairs. Jobs have their own.
    """
    folder = tempfile.TemporaryDirectory(prefix="jobs-")
    atexit.register(folder.cleanup)
    client, started = Path(folder.name, "client.py"), Path(folder.name, "python")
    client.write_text(CLIENT)
    address = f"{folder.name}/socket"
    one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    command = [sys.executable, __file__, address, str(started)]
    running = subprocess.Popen(command, env=dict(environment) | one, stdin=subprocess.PIPE)
    atexit.register(running.kill)
    started.write_text(f'#!/bin/sh\nexec {sys.executable} -I -S {client} {address} "$@"\n')
    started.chmod(stat.S_IRWXU)
    while not os.path.exists(address) and running.poll() is None:
        threading.Event().wait(0.02)
    return str(started)


def snakemake(arguments, folder, environment, timeout=900):
    """Result of Snakemake with these arguments in a folder, as from subprocess.run."""
    return subprocess.run(
        [python(tuple(sorted(environment.items()))), "-m", "snakemake", *map(str, arguments)],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout,
    )


# The server


def main(address):
    sys.path.remove(str(Path(__file__).parent))
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            import_module(name)
    import_module("snakemake.cli").get_argument_parser()  # imports all plugins
    _load_numba()
    signal.signal(signal.SIGCHLD, _bury)
    server = socket.socket(socket.AF_UNIX)
    server.bind(address)
    server.listen(64)
    while True:
        request, _ = server.accept()
        if not os.fork():
            server.close()
            _run(request)
        request.close()


def _load_numba():
    """Load the modules that Numba imports with its first compiled function."""
    from numba.core.registry import cpu_target

    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()


def _bury(*_):
    """Remove ended jobs from the list; they report their exit codes themselves."""
    with contextlib.suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def _run(connection):
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    _, files, _, _ = socket.recv_fds(connection, 1, 3)
    for number, file in enumerate(files):
        os.dup2(file, number)
        os.close(file)
    request = json.loads(connection.makefile().readline())
    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    sys.executable = sys.argv[2]  # path of the program that jobs start for other jobs
    paths = request["environment"].get("PYTHONPATH", "").split(os.pathsep)
    sys.path[:0] = filter(None, paths)
    threading.Thread(target=_end_with, args=[connection], daemon=True).start()
    code = 1
    try:
        _do(request["arguments"])
        code = 0
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else 1 if ended.code else 0
        if isinstance(ended.code, str):
            print(ended.code, file=sys.stderr)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        threading._shutdown()
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        connection.sendall(str(code).encode())
        os._exit(code)


def _do(arguments):
    """Run a script, or a module after -m, as Python does."""
    is_module = arguments[0] == "-m"
    sys.argv = arguments[is_module:]
    if is_module:
        sys.path.insert(0, os.getcwd())
        runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
    else:
        sys.path.insert(0, os.path.dirname(sys.argv[0]))
        runpy.run_path(sys.argv[0], run_name="__main__")


def _end_with(connection):
    """End this process together with the one that it replaces."""
    connection.recv(1)
    os._exit(1)


if __name__ == "__main__":
    main(sys.argv[1])
