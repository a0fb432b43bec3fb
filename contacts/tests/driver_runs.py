"""The drivers of docs/bounces in processes of their own, and the certified heights beside them."""

import csv
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).parents[1] / "docs" / "bounces"
GIVEN = {"r": "0.75", "mass": "1", "stiffness": "1e4", "damping": "20"}
"""What the drivers have in common: the first, or the others."""


class Driver(NamedTuple):
    """The rule of the certified number, and the time step of the driver in s."""

    rule: str
    time_step: float


DRIVERS = {
    "pymunk": Driver("restitution", 1e-3),
    "box2d": Driver("restitution", 1e-3),
    "dartpy": Driver("restitution", 1e-3),
    "pybullet": Driver("restitution", 1 / 240),
    "newton_xpbd": Driver("restitution", 1e-3),
    "rapier": Driver("restitution", 1e-3),
    "lammps": Driver("displacement", 1e-5),
    "mujoco": Driver("force", 1e-5),
    "drake": Driver("force", 1e-4),
    "pybullet_springs": Driver("force", 1e-5),
    "newton_mujoco": Driver("force", 5e-4),
    "genesis": Driver("force", 1e-4),
    "newton": Driver("approach", 2e-4),
}
_TOP = """
import runpy, sys
heights = [float(z) for z in runpy.run_path(sys.argv[1])["heights"]]
rising = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
print("top", max(heights[rising[0]:]))
"""


def top(name: str) -> float:
    """The height in m of the first rebound in a driver."""
    path = FOLDER / "drivers" / f"{name}_driver.py"
    ran = subprocess.run(
        [sys.executable, "-c", _TOP, str(path)], capture_output=True, text=True, check=True
    )
    (line,) = [line for line in ran.stdout.splitlines() if line.startswith("top ")]
    return float(line.split()[1])


def certified(name: str) -> float:
    """The height in m of the first rebound of the ball with certified digits."""
    rule = DRIVERS[name].rule
    with (FOLDER / "reference" / "bounces.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = ("r",) if rule == "restitution" else ("mass", "stiffness", "damping")
    (row,) = [
        row
        for row in rows
        if row["rule"] == rule
        and row["bounce"] == "1"
        and all(row[key] == GIVEN[key] for key in names)
    ]
    return float(row["top_height"])
