"""Processes that run the scripts of jobs, one script after another.

The imports of a short job take longer than its work. A run of Snakemake therefore keeps its
processes, as many as it has jobs at the same time, and each pays its imports once. A script is run
as ``script:`` would run it, with ``snakemake`` as a name of its own. A job that fails ends its
process, so that no later job meets what it has left.
"""

import atexit
import gc
import os
import runpy
import signal
import subprocess
import sys
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any

STANDARD_INPUT = 0

_idle: list[tuple[subprocess.Popen[bytes], Connection]] = []


def run_script(script: Path, job: Any) -> bool:
    """Run a script in a process that is idle, or in a new one; whether it came to its end.

    Parameters
    ----------
    script
        The file of the script.
    job
        What the script knows as ``snakemake``; it must be possible to pickle it.
    """
    try:
        process, connection = _idle.pop()
    except IndexError:
        process, connection = _started()
    try:
        connection.send((str(script), job))
        connection.recv()
    except (EOFError, OSError):
        process.wait()
        return False
    _idle.append((process, connection))
    return True


def _started() -> tuple[subprocess.Popen[bytes], Connection]:
    """A new process, and the connection that is its standard input."""
    connection, theirs = Pipe()
    with theirs:
        command = [sys.executable, "-m", __spec__.name]
        return subprocess.Popen(command, stdin=theirs.fileno()), connection


@atexit.register
def end_processes() -> None:
    """End all processes, which are idle."""
    while _idle:
        process, connection = _idle.pop()
        connection.close()
        process.wait()


def serve() -> None:
    """Run the scripts that come on the standard input until it is closed."""
    # Ctrl-C ends the process at once. An exception could be raised while a netCDF file is locked,
    # and closing the file would then wait forever. Because files are written completely or not at
    # all, no file is damaged.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Jobs run side by side and their matrices are small, so that threads for them would only cost.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # What scripts import stays: looking for garbage among it would take a tenth of the time.
    gc.set_threshold(100_000)
    atexit.register(gc.freeze)
    connection = Connection(os.dup(STANDARD_INPUT))
    # What a job starts has no standard input.
    with open(os.devnull) as nothing:
        os.dup2(nothing.fileno(), STANDARD_INPUT)
    while True:
        try:
            script, job = connection.recv()
        except EOFError:
            return
        runpy.run_path(script, {"snakemake": job})
        connection.send("done")


if __name__ == "__main__":
    serve()
