"""Run the drivers of engines that are installed, beside the reference heights: a table."""

import csv
import runpy
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# The release rule of each driver, and its time step in s.
DRIVERS = {
    "pymunk": ("restitution", 1e-3),
    "box2d": ("restitution", 1e-3),
    "dartpy": ("restitution", 1e-3),
    "pybullet": ("restitution", 1 / 240),
    "newton_xpbd": ("restitution", 1e-3),
    "rapier": ("restitution", 1e-3),
    "lammps": ("displacement", 1e-5),
    "mujoco": ("force", 1e-5),
    "drake": ("force", 1e-4),
    "pybullet_springs": ("force", 1e-5),
    "newton_mujoco": ("force", 5e-4),
    "genesis": ("force", 1e-4),
    "newton": ("approach", 2e-4),
}


def top(name):
    """Return the height in m of the first rebound in a driver."""
    heights = [
        float(z) for z in runpy.run_path(str(HERE / "drivers" / f"{name}_driver.py"))["heights"]
    ]
    rising = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return max(heights[rising[0] :])


def reference(rule):
    """Return the reference height in m of the first rebound under a rule."""
    with (HERE / "reference" / "bounces.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            is_case = (
                row["r"] == "0.75"
                if rule == "restitution"
                else (row["stiffness"] == "1e4" and row["damping"] == "20")
            )
            if row["rule"] == rule and row["bounce"] == "1" and is_case:
                return float(row["top_height"])
    raise LookupError(rule)


def main():
    print("| driver | rule | time step in ms | measured | reference |")
    print("| --- | --- | --- | --- | --- |")
    for name, (rule, step) in DRIVERS.items():
        # Each engine has a process of its own: some of them do not bear one another.
        ran = subprocess.run(
            [sys.executable, __file__, name], capture_output=True, text=True, check=False
        )
        found = [line for line in ran.stdout.splitlines() if line.startswith("top ")]
        measured = f"{float(found[0].split()[1]):.4f}" if found else "not run"
        shown = [f"`{name}_driver.py`", f"`{rule}`", f"{1000 * step:.3g}", measured]
        print(f"| {' | '.join(shown)} | {reference(rule):.4f} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print("top", top(sys.argv[1]))
    else:
        main()
