"""Designs beside what their engines do: ``python tests/engine_table.py [ENGINE]...``.

It prints the designs without friction and with it, and saves docs/validation/designs.csv. Balls
with friction that are dropped move along the table with half the speed of their impact as well. The
exit status is 1 if a design differs.
"""

import math
import sys

import engine_runs
import numpy as np
from engine_page import KEPT, save

from bouncing_ball_contacts import ENGINES, Bounce, design
from bouncing_ball_contacts.designs import Problem
from bouncing_ball_contacts.schemes import exact, offsets

BOX = dict(mass="1 kg", restitution=0.8, radius="5 cm", points=4)
CASES = [
    ("mujoco", "ball", dict(mass="50 g", restitution=0.8), "2 ms", {}),
    ("mujoco", "ball", dict(mass="50 g", restitution=0.8, penetration="2 mm"), "2 ms", {}),
    ("mujoco", "ball", dict(mass="5 g", restitution=0.95, density="rubber"), "1 ms", {}),
    ("mujoco", "ball", dict(mass="1 kg", restitution=0.02, density="rubber"), "2 ms", {}),
    ("mujoco", "ball", dict(mass="1 kg", restitution=0.99, radius="10 cm"), "1 ms", {}),
    ("mujoco", "ball", dict(mass="2 t", restitution=0.3, radius="0.5 m"), "10 ms", {}),
    ("mujoco", "ball", dict(mass="2 mg", restitution=0.7, drop_height="5 cm"), "20 us", {}),
    ("mujoco", "box", BOX, "1 ms", {}),
    ("pybullet", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    ("pybullet", "ball", dict(mass="50 g", restitution=0.8), "1/240", {}),
    (
        "pybullet",
        "ball",
        dict(mass="1 kg", restitution=0.3, penetration="5 mm", density="rubber"),
        None,
        {},
    ),
    ("pybullet", "ball", dict(mass="1 kg", restitution=0.02, radius="5 cm"), "1 ms", {}),
    ("pybullet", "ball", dict(mass="1 kg", restitution=0.99, radius="5 cm"), "50 us", {}),
    (
        "pybullet",
        "ball",
        dict(mass="1 kg", restitution=0.5, radius="5 cm"),
        "1 ms",
        {"springs": True},
    ),
    ("pybullet", "box", BOX, "1 ms", {}),
    (
        "pybullet",
        "box",
        dict(mass="1 kg", restitution=0.8, radius="5 cm", points=4, penetration="5 mm"),
        None,
        {},
    ),
    ("drake-sap", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    (
        "drake-sap",
        "ball",
        dict(mass="1 kg", restitution=0.1, penetration="5 mm", density="rubber"),
        None,
        {},
    ),
    ("drake-sap", "ball", dict(mass="2 t", restitution=0.6, radius="0.5 m"), "10 ms", {}),
    ("drake-sap", "ball", dict(mass="5 g", restitution=0.95, density="rubber"), "20 us", {}),
    ("drake-sap", "box", BOX, "1 ms", {}),
    ("drake-sap", "ball", dict(mass="1 kg", restitution=0, radius="5 cm"), None, {}),
    (
        "drake",
        "ball",
        dict(mass="50 g", restitution=0.7, penetration="5 mm", radius="30 mm"),
        None,
        {},
    ),
    ("lammps", "ball", dict(mass="50 g", restitution=0.8, radius="30 mm"), "1 ms", {}),
    ("lammps", "ball", dict(mass="2 mg", restitution=0.99, drop_height="5 cm"), "20 us", {}),
    ("lammps", "ball", dict(mass="1 kg", restitution=0.05, radius="5 cm"), "200 us", {}),
    (
        "lammps-limit-damping",
        "ball",
        dict(mass="50 g", restitution=0.5, radius="30 mm"),
        "200 us",
        {},
    ),
    (
        "lammps-hertz",
        "ball",
        dict(mass="50 g", restitution=0.8, penetration="3 mm", radius="30 mm"),
        None,
        {},
    ),
    (
        "newton",
        "ball",
        dict(mass="500 g", restitution=0.75, penetration="15 mm", radius="10 cm"),
        None,
        {},
    ),
    ("newton", "box", BOX, "1 ms", {}),
    ("newton-mujoco", "ball", dict(mass="500 g", restitution=0.75, radius="10 cm"), "1 ms", {}),
    ("newton-mujoco", "box", BOX, "1 ms", {}),
    ("physx", "ball", dict(mass="500 g", restitution=0.8, radius="10 cm"), "1 ms", {}),
    (
        "physx",
        "ball",
        dict(mass="1 kg", restitution=0.3, radius="10 cm", penetration="20 mm"),
        None,
        {},
    ),
    ("physx", "box", BOX, "1 ms", {}),
    ("ode", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    ("ode", "box", BOX, "1 ms", {}),
    ("gazebo", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    ("gazebo", "ball", dict(mass="1 kg", restitution=0.3, radius="5 cm"), None, {}),
    ("gazebo", "ball", dict(mass="1 kg", restitution=0.97, radius="10 cm"), "20 us", {}),
    ("gazebo", "box", BOX, "1 ms", {}),
    ("genesis", "ball", dict(mass="500 g", restitution=0.75, radius="10 cm"), "1 ms", {}),
    ("genesis", "box", BOX, "1 ms", {}),
]
FRICTION = 0.3
SMOOTH = ("gazebo",)
"""Engines that are run without friction only."""
HEAD = [
    "engine",
    "friction",
    "shape",
    "given",
    "step, ms",
    "r designed",
    "r at this step",
    "r in the engine",
    "sinks, mm",
    "sinks in the engine, mm",
    "force, N",
    "force in the engine, N",
    "at rest, mm",
    "at rest in the engine, mm",
    "promise",
]


def label(name, shape, wanted, more):
    """Return cells of a row: the shape, and what is given."""
    given = ", ".join(map(str, wanted.values()))
    return [shape, given + ", springs" * bool(more)]


def cells(name, shape, wanted, time_step, more, friction):
    """Return the further cells of a row of the table, and whether the engine agrees."""
    engine = ENGINES[name] if more else engine_runs.number_row(name)
    answer = design(Bounce(**wanted, friction=friction), engine, time_step)
    outcome = here = answer.outcome
    is_spring = "stiffness" in answer.numbers
    problem = Problem(answer.bounce, ENGINES[name])
    if is_spring:
        law = problem.law_of(answer.parameters, answer.time_step)
        # The design is for neighbouring steps as well, and the engine has this one.
        here = problem.outcome(law, answer.time_step, exact(offsets(401)))
    low, _, high = here.restitution
    slide = answer.bounce.impact_speed / 2 if friction and shape == "ball" else 0.0
    wider = problem.promised(here, 0.5) if slide and is_spring else (low, high)
    measured = engine_runs.measure(answer, shape, slide)
    at_least, at_most = measured.restitution
    texts = [
        f"{answer.time_step * 1e3:.4g}",
        f"{outcome.restitution[0]:.4f} to {outcome.restitution[2]:.4f}",
        f"{low:.4f} to {high:.4f}",
        f"{at_least:.4f} to {at_most:.4f}",
        f"{max(here.depth, default=math.nan) * 1e3:.4g}",
        f"{measured.depth * 1e3:.4g}",
        f"{max(here.force, default=math.nan):.4g}",
        f"{measured.force:.4g}",
        f"{outcome.rest * 1e3:.4g}" if outcome.rest else "–",
        "–" if math.isnan(measured.rest) else f"{measured.rest * 1e3:.4g}",
    ]
    # Thirteen instants do not meet the extremes of 401, which differ by less than a thirteenth of
    # the range, where r is a smooth function of the instant.
    slack = 0.001 + (high - low) / 13
    agrees = wider[0] - slack <= at_least and at_most <= wider[1] + slack
    if wider != (low, high):
        # Of bodies that slide the answer has this range of r, and neither depth nor force.
        return texts, agrees
    if not is_spring:
        return texts, agrees
    spread = (here.depth[1] - here.depth[0]) / 13
    agrees &= bool(np.isclose(measured.depth, here.depth[1], rtol=0.02, atol=spread))
    spread = (here.force[1] - here.force[0]) / 13
    agrees &= bool(np.isclose(measured.force, here.force[1], rtol=0.02, atol=spread))
    agrees &= math.isnan(measured.rest) or bool(np.isclose(measured.rest, outcome.rest, rtol=0.02))
    return texts, agrees


def table(cases, friction, engines):
    """Return the rows of a table."""
    rows = []
    for name, shape, wanted, time_step, more in cases:
        if engines and name not in engines:
            continue
        try:
            texts, agrees = cells(name, shape, wanted, time_step, more, friction)
        except ImportError as missing:
            print(f"Not run, because it is not installed: {name} ({missing.name}).")
            continue
        first = [name, f"{friction:g}", *label(name, shape, wanted, more)]
        rows.append([*first, *texts, KEPT[bool(agrees)]])
        print(" | ".join(rows[-1]), flush=True)
    return rows


def main():
    engines = sys.argv[1:]
    smooth = table(CASES, 0.0, engines)
    rubbed = table([case for case in CASES if case[0] not in SMOOTH], FRICTION, engines)
    rows = smooth + rubbed
    if rows:
        save("designs", HEAD, rows)
    differ = sum(row[-1] == KEPT[False] for row in rows)
    print(f"{len(rows) - differ} of {len(rows)} designs agree with their engines.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
