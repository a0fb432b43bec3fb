"""Designs beside what their engines do: ``python tests/engine_table.py [ENGINE]...``.

It prints two tables, without friction and with it, and writes them into docs/validation.md, where
rows of other engines and of those that are not installed stay as they are. The exit status is 1 if
a design differs.
"""

import math
import re
import sys

import engine_runs
import numpy as np
from engine_page import said, write

from bouncing_ball_contacts import Bounce, design
from bouncing_ball_contacts.designs import Problem
from bouncing_ball_contacts.engines import engine_named
from bouncing_ball_contacts.schemes import exact, offsets

EQUAL = dict(mass="1 kg", restitution=0.8, other_mass="1 kg", speed="2 m/s", radius="5 cm")
BOX = dict(mass="1 kg", restitution=0.8, radius="5 cm", points=4)
UNEQUAL = dict(mass="1 kg", restitution=0.8, other_mass="3 kg", speed="2 m/s", radius="5 cm")
CASES = [
    ("mujoco", "ball", dict(mass="50 g", restitution=0.8), "2 ms", {}),
    ("mujoco", "ball", dict(mass="50 g", restitution=0.8, penetration="2 mm"), "2 ms", {}),
    ("mujoco", "ball", dict(mass="5 g", restitution=0.95, density="rubber"), "1 ms", {}),
    ("mujoco", "ball", dict(mass="1 kg", restitution=0.02, density="rubber"), "2 ms", {}),
    ("mujoco", "ball", dict(mass="1 kg", restitution=0.99, radius="10 cm"), "1 ms", {}),
    ("mujoco", "ball", dict(mass="2 t", restitution=0.3, radius="0.5 m"), "10 ms", {}),
    ("mujoco", "ball", dict(mass="2 mg", restitution=0.7, drop_height="5 cm"), "20 us", {}),
    ("mujoco", "box", BOX, "1 ms", {}),
    ("mujoco", "two", EQUAL, None, {}),
    (
        "mujoco",
        "two",
        dict(mass="1 kg", restitution=0.5, other_mass="3 kg", speed="2 m/s", radius="5 cm"),
        "1 ms",
        {},
    ),
    ("pybullet", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    ("pybullet", "ball", dict(mass="50 g", restitution=0.8), "1/240", {"pick": "impulse"}),
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
        {"pick": "your step"},
    ),
    ("pybullet", "box", BOX, "1 ms", {}),
    (
        "pybullet",
        "box",
        dict(mass="1 kg", restitution=0.8, radius="5 cm", points=4, penetration="5 mm"),
        None,
        {},
    ),
    ("pybullet", "two", EQUAL, None, {}),
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
    ("drake-sap", "two", EQUAL, None, {}),
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
    ("lammps", "two", UNEQUAL, None, {}),
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
        "lammps-hertz",
        "two",
        dict(mass="1 kg", restitution=0.6, other_mass="1 kg", speed="2 m/s", radius="5 cm"),
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
    (
        "ode",
        "two",
        dict(mass="1 kg", restitution=0.5, other_mass="3 kg", speed="2 m/s", radius="5 cm"),
        None,
        {},
    ),
    ("gazebo", "ball", dict(mass="50 g", restitution=0.8), "1 ms", {}),
    ("gazebo", "ball", dict(mass="1 kg", restitution=0.3, radius="5 cm"), None, {}),
    ("gazebo", "ball", dict(mass="1 kg", restitution=0.97, radius="10 cm"), "20 us", {}),
    ("gazebo", "box", BOX, "1 ms", {}),
    (
        "gazebo",
        "two",
        dict(mass="1 kg", restitution=0.5, other_mass="3 kg", speed="2 m/s", radius="5 cm"),
        None,
        {},
    ),
    ("genesis", "ball", dict(mass="500 g", restitution=0.75, radius="10 cm"), "1 ms", {}),
    ("genesis", "box", BOX, "1 ms", {}),
]
DESIGNS = (
    "Designs at 13 instants within a step. *r designed* is what `bounce design` prints, which "
    "holds for neighbouring contacts as well; the numbers before each column *engine* are for the "
    "contact and the step as they are written. `two` are two free balls without gravity."
)
FRICTION = 0.3
RUBBED = (
    f"The same at a friction of {FRICTION}; balls that are dropped move along the table with half "
    "the speed of their impact as well. Of SAP in Drake, and of MuJoCo up to r = 0.6, the r of the "
    "engine is within the range that the answer has for bodies that slide. The program for "
    "Gazebo has no friction."
)
SMOOTH = ("gazebo",)
"""Engines that are run without friction only."""
HEAD = [
    "engine, shape",
    "given",
    "step",
    "r designed",
    "r at this step",
    "engine",
    "sinks, mm",
    "engine",
    "force, N",
    "engine",
    "at rest, mm",
    "engine",
]


def label(name, shape, wanted, more):
    """Return the first two cells of a row: the engine, and what is given."""
    given = ", ".join(map(str, wanted.values()))
    return [f"{name}, {shape}", given + "".join(f", {value}" for value in more.values())]


def cells(name, shape, wanted, time_step, more, friction):
    """Return the further cells of a row of the table, and whether the engine agrees."""
    found = design(Bounce(**wanted, friction=friction), name, time_step, **more)
    outcome = found.row.outcome
    problem = Problem(found.bounce, engine_named(name))
    law = problem.law_of(found.parameters, found.row.step)
    # The design is for neighbouring steps as well, and the engine has this one.
    here = problem.outcome(law, found.row.step, exact(offsets(401)))
    low, _, high = here.restitution
    slide = found.bounce.impact_speed / 2 if friction and shape == "ball" else 0.0
    wider = problem.promised(here, 0.5) if slide else (low, high)
    measured = engine_runs.measure(found, shape, slide)
    at_least, at_most = measured.restitution
    texts = [
        f"{found.row.step * 1e3:.4g} ms",
        f"{outcome.restitution[0]:.4f} to {outcome.restitution[2]:.4f}",
        f"{low:.4f} to {high:.4f}",
        f"{at_least:.4f} to {at_most:.4f}",
        f"{here.depth[1] * 1e3:.4g}",
        f"{measured.depth * 1e3:.4g}",
        f"{here.force[1]:.4g}",
        f"{measured.force:.4g}",
        f"{outcome.rest * 1e3:.4g}" if outcome.rest > 0 else "–",
        "–" if math.isnan(measured.rest) else f"{measured.rest * 1e3:.4g}",
    ]
    # Thirteen instants do not meet the extremes of 401, which differ by less than a thirteenth of
    # the range, where r is a smooth function of the instant.
    slack = 0.001 + (high - low) / 13
    agrees = wider[0] - slack <= at_least and at_most <= wider[1] + slack
    if wider != (low, high):
        # Of bodies that slide the answer has this range of r, and neither depth nor force.
        return texts, agrees
    spread = (here.depth[1] - here.depth[0]) / 13
    agrees &= bool(np.isclose(measured.depth, here.depth[1], rtol=0.02, atol=spread))
    spread = (here.force[1] - here.force[0]) / 13
    agrees &= bool(np.isclose(measured.force, here.force[1], rtol=0.02, atol=spread))
    agrees &= math.isnan(measured.rest) or bool(np.isclose(measured.rest, outcome.rest, rtol=0.02))
    return texts, agrees


def table(cases, friction, engines, earlier):
    """Return the lines of a table, and how many of its designs differ.

    The rows of other ``engines`` are those of an ``earlier`` table, by their first cells.
    """
    lines = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)]
    agreed = 0
    run = 0
    kept = set()
    for name, shape, wanted, time_step, more in cases:
        start = "| " + " | ".join(label(name, shape, wanted, more)) + " | "
        try:
            if engines and name not in engines:
                raise ImportError(name=name)
            texts, agrees = cells(name, shape, wanted, time_step, more, friction)
        except ImportError:
            lines += [line for line in earlier if line.startswith(start)]
            kept.add(name)
            continue
        run += 1
        agreed += agrees
        mark = "" if agrees else " (differs)"
        lines.append(start + " | ".join(texts) + mark + " |")
        print(lines[-1], flush=True)
    print(f"{agreed} of {run} designs agree; not run: {', '.join(sorted(kept)) or 'none'}.")
    rows = lines[2:]
    differ = sum("(differs)" in row for row in rows)
    summary = f"{len(rows) - differ} of {len(rows)} designs agree with their engines."
    absent = len(cases) - len(rows)
    if absent:
        names = sorted({case[0] for case in cases if not any(f"| {case[0]}," in r for r in rows)})
        summary += f" Not run: {absent}, of {', '.join(names)}."
    return [summary, "", *lines], run - agreed


def main():
    engines = sys.argv[1:]
    # The rows of both tables on the page: the second one has the same designs with friction.
    (rubbed,) = said(f"^{re.escape(RUBBED)}$") or [None]
    rows = said("^(?:The same at a friction.*|\\| .*)$")
    where = rows.index(rubbed) if rubbed else len(rows)
    lines, wrong = table(CASES, 0.0, engines, rows[:where])
    cases = [case for case in CASES if case[0] not in SMOOTH]
    with_friction, also_wrong = table(cases, FRICTION, engines, rows[where:])
    write("designs", ["## Designs", "", DESIGNS, "", *lines, "", RUBBED, "", *with_friction])
    sys.exit(1 if wrong + also_wrong else 0)


if __name__ == "__main__":
    main()
