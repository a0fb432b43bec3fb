"""A Python that starts programs by a fork: what they import of others' is imported already.

    python warm.py FOLDER

listens in the folder for ``FOLDER/python``, which starts a module (``-m``) or a script as
Python does, in its own folder and environment. Nothing of this package is imported before:
each program has that of its own tree.
"""

import ctypes
import gc
import importlib
import io
import marshal
import multiprocessing
import os
import runpy
import signal
import socket
import sys
from contextlib import suppress
from pathlib import Path

# What takes the time of a start of Snakemake, or of one of its jobs.
IMPORTED = (
    *("snakemake.cli", "snakemake.workflow", "snakemake.script", "snakemake.executors.local"),
    *("snakemake.report.html_reporter", "smart_open", "yte"),
    *("xarray.backends.netCDF4_", "pandas", "netCDF4", "pydantic", "jinja2"),
    *("scipy.optimize.elementwise", "scipy.special"),
    *("matplotlib.pyplot", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg"),
    *("PIL.Image", "PIL.PngImagePlugin"),
)
PYTHON = """#!{python} -IS
# Quicker to import than what they are part of.
import _socket, array, marshal, os, sys
server = _socket.socket(_socket.AF_UNIX)
server.connect({address!r})
streams = array.array("i", [0, 1, 2])
server.sendmsg([b"3"], [(_socket.SOL_SOCKET, _socket.SCM_RIGHTS, streams)])
server.sendall(marshal.dumps([sys.argv[1:], os.getcwd(), dict(os.environ), os.getpgrp()]))
server.shutdown(_socket.SHUT_WR)
sys.exit(int(server.recv(4) or 1))
"""


def main(folder: Path) -> None:
    """Serve; in a fork, become the program that is asked for."""
    # Nobody asks when the tests are gone, even if they were killed: PR_SET_PDEATHSIG.
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)
    for name in IMPORTED:
        importlib.import_module(name)
    # What the first call costs: the search for plugins.
    sys.modules["snakemake.cli"].get_argument_parser()
    # What the first text costs, the parser of its symbols and the fonts.
    plt = sys.modules["matplotlib.pyplot"]
    plt.figtext(0, 0, r"a $\frac{x^2}{\Lambda}$")
    for kind in ("png", "svg"):
        plt.savefig(io.BytesIO(), format=kind)
    plt.close()
    gc.freeze()
    program = folder / "python"
    address = str(folder / "socket")
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
    arguments, where, environment, group = marshal.load(asking.makefile("rb"))
    # It ends without taking apart what is imported here, which would copy all of the memory.
    job = multiprocessing.get_context("fork").Process(
        target=become, args=(program, streams, where, environment, group, *arguments)
    )
    job.start()
    job.join()
    # Who asked may have been killed as well.
    with suppress(BrokenPipeError):
        asking.sendall(str(job.exitcode & 0xFF).encode())
    os._exit(0)


def become(program, streams, where, environment, group, first: str, *rest: str) -> None:
    """Run a module, after ``-m``, or a script, as Python does, in place of who asked."""
    # What stops the group of who asked stops this as well.
    os.setpgid(0, group)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
    os.closerange(3, max(streams) + 1)
    os.chdir(where)
    os.environ.clear()
    os.environ.update(environment)
    sys.executable = str(program)
    name, *arguments = rest if first == "-m" else (first, *rest)
    here = os.getcwd() if first == "-m" else str(Path(name).parent)
    sys.path[:1] = [here, *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    sys.argv = [name, *arguments]
    (runpy.run_module if first == "-m" else runpy.run_path)(name, run_name="__main__")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
