"""Scripts of ``--script``, run as a user runs them: ``python tests/engine_scripts.py [ENGINE]...``.

It prints what each script printed. The exit status is 1 if a rebound is not as designed.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from bouncing_ball_contacts import Bounce, design
from bouncing_ball_contacts.scripts import drop_script

BALL = dict(mass="50 g", restitution=0.8, radius="30 mm", penetration="5 mm")
BOX = dict(mass="1 kg", restitution=0.7, radius="5 cm", points=4, penetration="5 mm")
TWO = dict(mass="1 kg", restitution=0.8, other_mass="3 kg", speed="2 m/s", radius="5 cm")
CASES = [
    *((engine, "ball", BALL) for engine in ("mujoco", "pybullet", "drake-sap", "lammps", "newton")),
    *((engine, "box", BOX) for engine in ("mujoco", "pybullet", "drake-sap", "drake")),
    *((engine, "two", TWO) for engine in ("mujoco", "pybullet", "drake-sap", "drake")),
    *((engine, "two", TWO) for engine in ("lammps", "lammps-limit-damping", "lammps-hertz")),
]


def main():
    wanted = sys.argv[1:]
    print("| engine | bodies | the script prints |")
    print("| --- | --- | --- |")
    wrong = 0
    for engine, shape, bounce in CASES:
        if wanted and engine not in wanted:
            continue
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "drop.py")
            file.write_text(drop_script(design(Bounce(**bounce), engine)), "utf-8")
            command = [sys.executable, str(file)]
            ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        lines = ran.stdout.splitlines()
        shown = lines[-1] if ran.returncode == 0 and lines else ran.stderr.strip()[-200:]
        numbers = re.search(r"(?:to|with) ([\d.]+) .*designed are ([\d.]+) to ([\d.]+)", shown)
        # Both are printed with three or four digits.
        agrees = numbers is not None and (
            0.998 * float(numbers[2]) <= float(numbers[1]) <= 1.002 * float(numbers[3])
        )
        wrong += not agrees
        print(f"| {engine} | {shape} | {shown}{'' if agrees else ' (differs)'} |", flush=True)
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
