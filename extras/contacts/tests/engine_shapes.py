"""Other shapes with the lines of a ball: ``python tests/engine_shapes.py [ENGINE]...``.

Each design is of a ball. A ball, a flat box, a lying capsule and a ball that spins are dropped with
what it prints, at several instants within a step, and r is √(h′/h) of the first bounce. The box and
the capsule have the half height or the radius of the ball. All else is left to the engine.

The promise is kept if r is within the answer. Shapes after its "Not for" are not promised. The rows
of the engines that were run are saved in docs/validation/shapes.csv. The exit status is 1 if a
promise is not kept.
"""

import functools
import math
import re
import sys

import engine_drops
import engine_runs
import numpy as np
from engine_drops import Body
from engine_page import KEPT, save

from bouncing_ball_contacts import Bounce, design
from bouncing_ball_contacts.designs import Problem
from bouncing_ball_contacts.rows import BY_NUMBER, ENGINES

INSTANTS = 9
DESIGNS = {
    "0.65 from 1.5 m": (dict(restitution=0.65, drop_height=1.5, radius=0.1, mass=1.0), "1/60"),
    "0.42 from 0.55 m": (dict(restitution=0.42, drop_height=0.55, radius=0.03, mass=0.2), "1/240"),
}
SHAPES = {
    "ball": Body(),
    "flat box": Body("box"),
    "lying capsule": Body("capsule"),
    "ball with 30 rad/s": Body("ball", 30.0),
}
NOT_FOR = {
    "ball": "^balls",
    "flat box": "^(flat )?boxes",
    "lying capsule": "^(boxes or )?lying capsules",
    "ball with 30 rad/s": "^spinning",
}
"""Patterns of texts after "Not for" that except a shape."""
MISSING = {
    "flat box": ("lammps", "lammps-limit-damping", "lammps-hertz"),
    "lying capsule": (
        *("lammps", "lammps-limit-damping", "lammps-hertz"),
        *("box2d-2", "box2d-2.3", "planck", "matter-js", "cannon-es"),
    ),
}
"""Engines that do not have a shape."""


def by_spring(name, floor, answer, drops, steps, kind):
    """Return the heights over a floor in an engine of engine_runs.py."""
    g = answer.bounce.gravity
    run = engine_runs.RUNS[name]
    how = dict(spin=kind.spin, table=floor)
    trials = (
        engine_runs.Trial(answer, kind.shape, drop, 0.0, steps, g, None, **how)
        for drop in drops.tolist()
    )
    return np.array([run(trial).heights for trial in trials]).T


def by_number(run, answer, drops, steps, kind):
    """Return the heights above the floor, or above the skins of a box, in engine_drops.py."""
    skin = 2 * BY_NUMBER[answer.engine].skin * (kind.shape == "box")
    return run(answer.snippet, drops + skin, answer.bounce.size, steps, kind) - skin


def on_floor(name, floor="plane"):
    return functools.partial(by_spring, name, floor)


def dropped(name, **more):
    return functools.partial(by_number, functools.partial(engine_drops.ENGINES[name], **more))


RUNS = {
    **{
        name: {ENGINES[name].ran: on_floor(name)}
        for name in engine_runs.RUNS
        if name not in (*engine_runs.DROPS_ONLY, "physx", "lammps-limit-damping", "lammps-hertz")
    },
    **{
        name: {BY_NUMBER[name].ran: dropped(name)}
        for name in engine_drops.ENGINES
        if name not in ("gazebo-sim", "rapier")
    },
    "pybullet": {
        "PyBullet 3.2.7, on a box": on_floor("pybullet", "block"),
        "PyBullet 3.2.7, on GEOM_PLANE": on_floor("pybullet", "GEOM_PLANE"),
    },
    "isaac-lab": {ENGINES["physx"].ran: on_floor("physx")},
    "rapier": {
        "Rapier 0.36 (Python)": dropped("rapier"),
        "Rapier 0.21 (JavaScript)": functools.partial(
            by_number, functools.partial(engine_drops.by_node, "rapier")
        ),
    },
}
"""Engines by the names of rows, and by versions."""


def measured(run, answer, kind):
    """Return the smallest and the largest r of a body that is dropped."""
    bounce = answer.bounce
    step, speed = answer.time_step, bounce.impact_speed
    # Next to the flights, the contact lasts for the way of some depths.
    deepest = max(answer.outcome.depth, default=0.0)
    steps = math.ceil((2.6 * speed / bounce.gravity + 8 * deepest / speed) / step) + 6
    instants = np.arange(INSTANTS) / INSTANTS - 0.5
    drops = speed**2 / (2 * bounce.gravity) + speed * step * instants
    tops = [engine_runs.rebound(column) for column in run(answer, drops, steps, kind).T]
    r = np.sqrt(np.array(tops) / drops)
    return r.min(), r.max()


def promise(answer, kind):
    """Return the smallest and the largest r of an answer; a ball that spins slides."""
    low, _, high = answer.outcome.restitution
    row = BY_NUMBER.get(answer.engine)
    if row and kind.shape == "box":
        share = row.skin / answer.bounce.drop_height
        low, high = (math.sqrt((r**2 - share) / (1 - share)) for r in (low, high))
    along = abs(kind.spin) * answer.bounce.size / answer.bounce.impact_speed
    if along and "stiffness" in answer.numbers:
        low, high = Problem(answer.bounce, ENGINES[answer.engine]).promised(answer.outcome, along)
    return low, high


HEAD = ["engine", "run in", "design", "step", "shape", "r promised", "r in the engine", "promise"]


def table(engine):
    """Return the rows of an engine."""
    rows = []
    for version, run in RUNS[engine].items():
        for named, (bounce, step) in DESIGNS.items():
            answer = design(Bounce(**bounce, gravity=engine_drops.G), engine, step)
            pasted = next(candidate for candidate in (answer, *answer.also) if candidate.snippet)
            excepted = [
                text
                for text in pasted.not_for
                if "GEOM_PLANE" not in text or "GEOM_PLANE" in version
            ]
            for shape, kind in SHAPES.items():
                if engine in MISSING.get(shape, ()):
                    continue
                low, high = promise(pasted, kind)
                least, most = measured(run, pasted, kind)
                # Three digits are printed.
                kept = bool(low - 5e-4 <= least and most <= high + 5e-4)
                is_excepted = any(re.search(NOT_FOR[shape], text) for text in excepted)
                texts = [version, named, f"{1e3 * pasted.time_step:.4g} ms", shape]
                ranges = [f"{low:.3f} to {high:.3f}", f"{least:.3f} to {most:.3f}"]
                rows.append([engine, *texts, *ranges, KEPT[None if is_excepted else kept]])
                print(" | ".join(rows[-1]), flush=True)
    return rows


def main():
    differ = 0
    for name in sys.argv[1:] or RUNS:
        try:
            rows = table(name)
        except ImportError as missing:
            print(f"Not run, because it is not installed: {name} ({missing.name}).")
            continue
        save("shapes", HEAD, rows)
        differ += sum(row[-1] == KEPT[False] for row in rows)
    print(f"{differ} promises are not kept.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
