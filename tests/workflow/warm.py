"""A Python that starts programs by a fork: what they import of others' is imported already.

    python warm.py FOLDER

listens in the folder for ``FOLDER/python``, which starts a module (``-m``) or a script as
Python does, in its own folder and environment. Nothing of this package is imported before:
each program has that of its own tree.
"""

import atexit
import ctypes
import gc
import importlib
import io
import json
import os
import runpy
import signal
import socket
import sys
import threading
from contextlib import suppress
from pathlib import Path

# What takes the time of a start of Snakemake, or of one of its jobs.
IMPORTED = (
    *("snakemake.cli", "snakemake.workflow", "snakemake.script", "snakemake.executors.local"),
    *("xarray.backends.netCDF4_", "pandas", "netCDF4", "pydantic", "jinja2"),
    *("scipy.optimize.elementwise", "scipy.integrate", "scipy.interpolate", "scipy.special"),
    *("matplotlib.pyplot", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg"),
    *("PIL.Image", "PIL.PngImagePlugin", "scipy.stats", "pint"),
)
PYTHON = """#!{python} -IS
import json, os, socket, sys
server = socket.socket(socket.AF_UNIX)
server.connect({address!r})
socket.send_fds(server, [b"3"], [0, 1, 2])
said = [sys.argv[1:], os.getcwd(), dict(os.environ), os.getpgrp()]
server.sendall(json.dumps(said).encode())
server.shutdown(socket.SHUT_WR)
sys.exit(int(server.recv(4) or 1))
"""


def main(folder: Path) -> None:
    """Serve; in a fork, become the program that is asked for."""
    # Nobody asks when the tests are gone, even if they were killed: PR_SET_PDEATHSIG.
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)
    for name in IMPORTED:
        importlib.import_module(name)
    # What the first text costs, the parser of its symbols and the fonts.
    plt = sys.modules["matplotlib.pyplot"]
    plt.figtext(0, 0, r"a $\frac{x^2}{\Lambda}$")
    for kind in ("png", "svg"):
        plt.savefig(io.BytesIO(), format=kind)
    plt.close()
    gc.freeze()
    program, address = folder / "python", str(folder / "socket")
    program.write_text(PYTHON.format(python=sys.executable, address=address))
    program.chmod(0o755)
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(address)
    listening.listen()
    (folder / "ready").touch()
    asking, _ = listening.accept()
    while os.fork():
        asking.close()
        asking, _ = listening.accept()
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
    _, streams, *_ = socket.recv_fds(asking, 1, 3)
    arguments, where, environment, group = json.load(asking.makefile())
    if child := os.fork():
        _, status = os.waitpid(child, 0)
        # Who asked may have been killed as well.
        with suppress(BrokenPipeError):
            asking.sendall(str(os.waitstatus_to_exitcode(status) & 0xFF).encode())
        os._exit(0)
    # What stops the group of who asked stops this as well.
    os.setpgid(0, group)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
    os.closerange(3, max(streams) + 1)
    os.chdir(where)
    os.environ.clear()
    os.environ.update(environment)
    sys.executable = str(program)
    leave(become(*arguments))


def become(first: str, *rest: str) -> int:
    """Run a module, after ``-m``, or a script, as Python does; the exit status."""
    name, *arguments = rest if first == "-m" else (first, *rest)
    here = os.getcwd() if first == "-m" else str(Path(name).parent)
    sys.path[:1] = [here, *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    sys.argv = [name, *arguments]
    try:
        (runpy.run_module if first == "-m" else runpy.run_path)(name, run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, int | None):
            return end.code or 0
        print(end.code, file=sys.stderr)
        return 1
    except BaseException:
        sys.excepthook(*sys.exc_info())
        return 1
    return 0


def leave(status: int) -> None:
    """End as Python does, but without taking apart what the server has imported.

    That copies all of its memory, and takes longer than most jobs.
    """
    threading._shutdown()
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
