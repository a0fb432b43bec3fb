"""Designs in their engines with the printed text alone.

Each scene has a ball, a floor, gravity and a drop, and the text that `bounce design` prints. All
else is left to the engine: friction, thresholds, iterations. A ball meets the floor at several
instants within a step. The promise is kept if r is within the range of the answer.

``python tests/engine_pasted.py [ENGINE]...`` saves the rows in docs/validation/pasted.csv, and in
masses.csv those of light and heavy, small and large balls with a restitution by number. Engines
of JavaScript are run by ``engine_drops.mjs``, which has the command that installs them. An engine
that is not installed has a row with the reason. The exit status is 1 if a promise is not kept.
"""

import functools
import math
import sys
from typing import NamedTuple

import engine_drops
import engine_runs
import numpy as np
from engine_page import KEPT, NOT_RUN, save

from bouncing_ball_contacts import ENGINES, Bounce, Refused, design
from bouncing_ball_contacts.engines import ran_in
from bouncing_ball_contacts.rows import BY_NUMBER

G = engine_drops.G
INSTANTS = 13
SLOW = ("mujoco-warp", "newton", "newton-mujoco")
"""Engines that are run at three instants only: a drop in short steps takes minutes there."""


class Case(NamedTuple):
    """A ball: r, height of the drop and radius in m, the step, which may be none, and the mass."""

    name: str
    restitution: float
    height: float
    radius: float
    step: str | None
    mass: float = 0.1

    @property
    def bounce(self):
        return Bounce(
            mass=self.mass,
            restitution=self.restitution,
            drop_height=self.height,
            radius=self.radius,
            gravity=G,
        )


SPRINGS = [
    Case("a step", 0.7, 1.0, 0.05, "1 ms"),
    Case("no step", 0.8, 0.3, 0.05, None),
    Case("low r", 0.3, 0.5, 0.05, "0.5 ms"),
    Case("a step that is too long", 0.6, 1.0, 0.1, "1/60"),
    Case("a small ball", 0.65, 0.3, 0.01, "0.2 ms"),
]
NUMBERS = [
    Case("a step", 0.7, 1.0, 0.25, "1/60"),
    Case("a fast drop", 0.9, 3.0, 0.25, "1/240"),
    Case("low r", 0.3, 0.5, 0.25, "1/120"),
    Case("a step that is too long", 0.5, 0.04, 0.05, "1/60"),
    Case("a small ball", 0.65, 1.5, 0.1, "1/60"),
]
WITHOUT_STEP = Case("no step", 0.8, 2.0, 0.05, None)
MASSES = [
    Case(f"{mass:g} kg", 0.6, height, radius, step, mass)
    for height, radius, step in [(0.02, 0.001, "1/1000"), (5.0, 1.0, "1/60")]
    for mass in (1e-3, 1.0, 1e3)
]


def answered(case, engine):
    """Return the answer whose lines are pasted; None if there is none."""
    try:
        answer = design(case.bounce, engine, case.step)
    except Refused:
        return None
    return next((candidate for candidate in (answer, *answer.also) if candidate.snippet), None)


def by_spring(name, answer):
    """Return r over instants within a step, of a row of :data:`engine_runs.RUNS`."""
    instants = 3 if name in SLOW else INSTANTS
    return engine_runs.measure(answer, "ball", instants=instants).restitution


def by_number(name, answer):
    """Return r over instants within a step, of a row of :data:`engine_drops.ENGINES`."""
    bounce = answer.bounce
    way = bounce.impact_speed * answer.time_step
    drops = bounce.impact_speed**2 / (2 * G) + way * (np.arange(INSTANTS) / INSTANTS - 0.5)
    steps = math.ceil(2.4 * bounce.impact_speed / G / answer.time_step) + 6
    turns = [{}]
    if "turn" in BY_NUMBER[name].either[0]:
        # Half the angle between two corners of the coarsest polygon, which has ten.
        turns = [{"turn": float(turn)} for turn in np.linspace(0, math.pi / 10, 4)]
    restitutions = []
    body = engine_drops.Body(mass=bounce.mass)
    for turn in turns:
        run = functools.partial(engine_drops.ENGINES[name], **turn)
        heights = run(answer.snippet, drops, bounce.size, steps, body)
        restitutions += [
            math.sqrt(engine_runs.rebound(column) / drop)
            for column, drop in zip(heights.T, drops, strict=True)
        ]
    return min(restitutions), max(restitutions)


def measured(name, case, engine, run):
    """Return the step, r promised, r in the engine and the verdict, with what is written."""
    answer = answered(case, engine)
    if answer is None:
        return ["–", "nothing to paste", "–", KEPT[None]], ""
    low, _, high = answer.outcome.restitution
    least, most = run(name, answer)
    # Three digits are printed.
    is_kept = low - 5e-4 <= least and most <= high + 5e-4
    ranges = f"{low:.3f} to {high:.3f}", f"{least:.3f} to {most:.3f}"
    written = "; ".join(f"{key}={value}" for key, value in answer.parameters.items())
    return [f"{1e3 * answer.time_step:.4g}", *ranges, KEPT[bool(is_kept)]], written


def pasted(name, case, engine, run):
    """Return the cells of a row of pasted.csv but the first."""
    cells, _ = measured(name, case, engine, run)
    given = f"r = {case.restitution}, {case.height:g} m, {case.radius:g} m, {case.step or '–'}"
    return [case.name, given, *cells]


def of_masses(name, case, engine, run):
    """Return the cells of a row of masses.csv but the first."""
    cells, written = measured(name, case, engine, run)
    return [f"{case.mass:g}", f"{case.radius:g}", f"{case.height:g}", written, *cells]


FOUND = ["step, ms", "r promised", "r in the engine", "promise"]
TABLES = {
    "pasted": (["engine", "case", "given", *FOUND], pasted),
    "masses": (["engine", "mass, kg", "radius, m", "height, m", "written", *FOUND], of_masses),
}


def plans(table):
    """Yield the rows: the name, the engine of a design, how it is run, and the cases."""
    if table == "pasted":
        for name, row in ENGINES.items():
            yield name, row, by_spring if name in engine_runs.RUNS else None, SPRINGS
    for name, row in BY_NUMBER.items():
        cases = [*NUMBERS, WITHOUT_STEP] if row.springs else NUMBERS
        if table == "masses":
            cases = MASSES
        # A ball rises to the skin, however low r is.
        cases = [case._replace(height=case.height + 2 * row.skin) for case in cases]
        if name in engine_drops.ENGINES:
            yield name, name, by_number, cases
        else:
            is_run = name in engine_runs.RUNS or name in engine_runs.ROWS
            yield name, name, by_spring if is_run else None, cases


def reason(name):
    """Return why an engine is not run, as its row has it."""
    row = BY_NUMBER[name]
    return ran_in(row) if row.borrows else f"no program for {name}"


def ran(table):
    """Run the engines of a table, save its rows, and return how many promises are not kept."""
    head, cells = TABLES[table]
    rows = []
    missing = {}
    for name, engine, run, cases in plans(table):
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        if run is None:
            missing[name] = reason(name)
            continue
        for case in cases:
            try:
                rows.append([name, *cells(name, case, engine, run)])
            except ImportError as absent:
                missing[name] = f"{absent.name} is not installed"
                break
            print(" | ".join(rows[-1]), flush=True)
    names = {row[0] for row in rows}
    for name, why in missing.items():
        print(f"Not run: {name}, because {why}.")
        if name not in names:
            rows.append([name, why, *[""] * (len(head) - 3), NOT_RUN])
    save(table, head, rows)
    return sum(row[-1] == KEPT[False] for row in rows)


def main():
    differ = sum(map(ran, TABLES))
    print(f"{differ} promises are not kept.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
