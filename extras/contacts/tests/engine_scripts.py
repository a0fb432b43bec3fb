"""Scripts of ``--script``, run as a user runs them: ``python tests/engine_scripts.py [ENGINE]...``.

Each is run as it is written, and with a friction and a speed along the table, as a user would add
them. What the scripts printed is written into docs/validation.md. The exit status is 1 if a rebound
is not as designed.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from engine_page import write

from bouncing_ball_contacts import Bounce, design
from bouncing_ball_contacts.scripts import FAMILIES, drop_script

BALL = dict(mass="50 g", restitution=0.8, radius="30 mm", penetration="5 mm")
BOX = dict(mass="1 kg", restitution=0.7, radius="5 cm", points=4, penetration="5 mm")
TWO = dict(mass="1 kg", restitution=0.8, other_mass="3 kg", speed="2 m/s", radius="5 cm")
CASES = [
    *((engine, "ball", BALL) for engine in ("mujoco", "pybullet", "drake-sap", "lammps", "newton")),
    *((engine, "box", BOX) for engine in ("mujoco", "pybullet", "drake-sap", "drake")),
    *((engine, "two", TWO) for engine in ("mujoco", "pybullet", "drake-sap", "drake")),
    *((engine, "two", TWO) for engine in ("lammps", "lammps-limit-damping", "lammps-hertz")),
]


FRICTION = 0.3
SLIDE = 1.0
# What is replaced in the script of an engine, and by what: the friction of both bodies, and at last
# in a drop the speed along.
ADDED = {
    "mujoco": [
        ('class="bounce" ', f'class="bounce" friction="{FRICTION}" '),
        ("heights = []", f"data.qvel[0] = {SLIDE}\nheights = []"),
    ],
    "pybullet": [
        ("body, -1, ", f"body, -1, lateralFriction={FRICTION**0.5}, "),
        ("heights = []", f"pybullet.resetBaseVelocity(other, [{SLIDE}, 0, 0])\nheights = []"),
    ],
    "drake": [
        ("CoulombFriction(0, 0)", f"CoulombFriction({FRICTION}, {FRICTION})"),
        (
            "simulator = Simulator(builder.Build())\nsimulator.AdvanceTo",
            "simulator = Simulator(builder.Build())\nplant.SetVelocities(plant."
            "GetMyMutableContextFromRoot(simulator.get_mutable_context()), "
            f"[0, 0, 0, {SLIDE}, 0, 0])\nsimulator.AdvanceTo",
        ),
    ],
    "newton": [
        ("kf=0.0, mu=0.0", f"mu={FRICTION}"),
        (
            'finalize(device="cpu")',
            f'finalize(device="cpu")\nmodel.joint_qd.assign([{SLIDE}, 0, 0, 0, 0, 0])',
        ),
    ],
    "lammps": [
        ("linear_nohistory 0 0", f"linear_nohistory 1 {FRICTION}"),
        (" 0 0 0 zplane", f" 1000 {FRICTION} 1 zplane"),
        (" 0 0 0\npair_coeff", f" 1000 {FRICTION} 1\npair_coeff"),
        (" 0 0 0 limit_damping", f" 1000 {FRICTION} 1 limit_damping"),
        ("\nfix down", f"\nvelocity all set {SLIDE} 0 0\nfix down"),
    ],
}
HEAD = ["| engine | bodies | the script prints |", "| --- | --- | --- |"]


def cells(engine, shape, bounce, changes):
    """Return the cells of a script, and whether the rebound is as designed."""
    text = drop_script(design(Bounce(**bounce), engine))
    for old, new in changes:
        text = text.replace(old, new)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "drop.py")
        file.write_text(text, "utf-8")
        command = [sys.executable, str(file)]
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    lines = ran.stdout.splitlines()
    shown = lines[-1] if ran.returncode == 0 and lines else ran.stderr.strip()[-200:]
    numbers = re.search(r"(?:to|with) ([\d.]+) .*designed are ([\d.]+) to ([\d.]+)", shown)
    # Both are printed with three or four digits.
    agrees = numbers is not None and (
        0.998 * float(numbers[2]) <= float(numbers[1]) <= 1.002 * float(numbers[3])
    )
    return [engine, shape, shown + ("" if agrees else " (differs)")], agrees


def table(cases, rubs):
    """Return the lines of a table, and how many scripts differ."""
    lines = [*HEAD]
    wrong = 0
    for engine, shape, bounce in cases:
        changes = ADDED[FAMILIES[engine]] if rubs else []
        if shape == "box" and engine != "mujoco":
            # On springs r is that of a box which does not slide, as the answers say.
            changes = changes[:-1]
        texts, agrees = cells(engine, shape, bounce, changes)
        wrong += not agrees
        lines.append(f"| {' | '.join(texts)} |")
        print(lines[-1], flush=True)
    said = f"{len(cases) - wrong} of {len(cases)} scripts print what was designed."
    print(said)
    return [said, "", *lines], wrong


def main():
    wanted = sys.argv[1:]
    cases = [case for case in CASES if not wanted or case[0] in wanted]
    lines, wrong = table(cases, False)
    more, also_wrong = table(cases, True)
    rubbed = (
        f"The same with a friction of {FRICTION}, and {SLIDE:g} m/s along the table of balls that "
        "are dropped and of the box in MuJoCo; on springs r is that of a box which does not slide."
    )
    if not wanted:
        write("scripts", ["## Scripts", "", *lines, "", rubbed, "", *more])
    sys.exit(wrong + also_wrong > 0)


if __name__ == "__main__":
    main()
