"""AUTO-07p with compiled equations: orbits of the restitution model with two impacts.

AUTO is built from its sources (github.com/auto-07p/auto-07p: ``./configure && make``, with
gfortran), and AUTO_DIR names the folder. The equations are those of two_impacts.f90.
"""

import math
import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

EQUATIONS = Path(__file__).with_name("two_impacts.f90")
RUNS = 15
# A run of AUTO is so short that other programs disturb most of them.
OF_AUTO = 100


class Compiled(NamedTuple):
    """Least seconds of AUTO's own clock and of the whole process, and (state, Λ) of the points."""

    seconds: float
    process: float
    points: list


def folder() -> Path | None:
    """The folder of a built AUTO-07p, None if there is none."""
    named = os.environ.get("AUTO_DIR")
    if not named or not shutil.which("gfortran"):
        return None
    path = Path(named)
    return path if list((path / "lib").glob("*.o")) else None


def followed(auto: Path, state: list, amplitude: float, restitution: float, to: float) -> Compiled:
    """The branch of an orbit up to an amplitude, with the settings of the interpreted runs."""
    with tempfile.TemporaryDirectory() as name:
        here = Path(name)
        program = here / "branch"
        objects = sorted(map(str, (auto / "lib").glob("*.o")))
        build = ["gfortran", "-O2", "-fopenmp", str(EQUATIONS), *objects, "-o", str(program)]
        subprocess.run(build, check=True, cwd=here, capture_output=True)
        (here / "start").write_text(" ".join(map(repr, [amplitude, restitution, *state])))
        (here / "fort.2").write_text(_constants(len(state), to))
        own = []
        whole = []
        for _ in range(OF_AUTO):
            start = time.perf_counter()
            run = subprocess.run([program], check=True, cwd=here, capture_output=True, text=True)
            whole.append(time.perf_counter() - start)
            own.append(float(re.search(r"Total Time\s+(\S+)", run.stdout)[1]))
        return Compiled(min(own), min(whole), _points(here / "fort.7", len(state)))


def _constants(unknowns: int, to: float) -> str:
    return f"""NDIM={unknowns}, IPS=0, IRS=0, ILP=1, ICP=[1]
NTST=10, NCOL=4, IAD=3, ISP=0, ISW=1, IPLT=0, NBC=0, NINT=0
NMX=500, NPR=1000, MXBF=10, IID=2, ITMX=9, ITNW=9, NWTN=3, JAC=0
EPSL=1e-12, EPSU=1e-12, EPSS=1e-10, DS=0.01, DSMIN=1e-6, DSMAX=0.1, IADS=1
NPAR=2, THL={{}}, THU={{}}, RL0=0.0, RL1={to}, A0=-1e300, A1=1e300
"""


def _points(file: Path, unknowns: int) -> list:
    """The rows of AUTO's table: branch, point, type, label, Λ, the norm, and the state."""
    found = []
    for line in file.read_text().splitlines():
        columns = line.split()
        if len(columns) != 6 + unknowns or columns[0] == "0":
            continue
        numbers = [float(x) for x in columns[4:]]
        if all(map(math.isfinite, numbers)):
            found.append((numbers[2:], numbers[0]))
    return found
