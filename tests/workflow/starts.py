"""Snakemake, started many times: its libraries are imported once, and each start is a fork.

Two thirds of the processor time of a start import what is the same for all trees: Snakemake
with its plugins, scipy and xarray. Nothing of the package is imported here.

Reads one start a line, as JSON: the arguments, the folder, the environment, and where the
output goes. Answers with the exit status.
"""

import gc
import json
import os
import sys
from importlib import import_module

from snakemake.cli import main as snakemake

# What Snakemake and the package import as they run.
USED = (
    "nbformat",
    "pydantic",
    "scipy.optimize.elementwise",
    "smart_open",
    "snakemake.report.html_reporter",
    "xarray",
)


def become(start: dict) -> None:
    """Be the process that ``snakemake`` would be, called there and with that environment."""
    os.chdir(start["folder"])
    os.environ.clear()
    os.environ.update(start["environment"])
    # In place of the folder of this file, as Python itself does it.
    sys.path[:1] = start["environment"]["PYTHONPATH"].split(os.pathsep)
    sys.argv = ["snakemake", *start["arguments"]]
    for stream, path in ((0, os.devnull), (1, start["stdout"]), (2, start["stderr"])):
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, stream)
        os.close(file)


if __name__ == "__main__":
    for name in USED:
        import_module(name)
    assert "bouncing_ball" not in sys.modules
    gc.collect()
    gc.freeze()
    for line in sys.stdin:
        child = os.fork()
        if not child:
            become(json.loads(line))
            sys.exit(snakemake())
        _, status = os.waitpid(child, 0)
        print(os.waitstatus_to_exitcode(status), flush=True)
