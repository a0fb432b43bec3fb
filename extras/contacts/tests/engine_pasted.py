"""Designs in their engines with the printed text alone.

Each scene has a ball, a floor, gravity and a drop, and the text that `bounce design` prints. All
else is left to the engine: friction, thresholds, iterations. A ball meets the floor at several
instants within a step. The promise is kept if r is within the range of the answer.

``python tests/engine_pasted.py [ENGINE]...`` saves the rows in docs/validation/pasted.csv. Engines
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

from bouncing_ball_contacts import ENGINES, Bounce, design
from bouncing_ball_contacts.rebounds import BY_NUMBER

G = engine_drops.G
INSTANTS = 13
SLOW = ("mujoco-warp", "newton", "newton-mujoco")
"""Engines that are run at three instants only: a drop in short steps takes minutes there."""


class Case(NamedTuple):
    """A ball of 100 g: r, height of the drop and radius in m, and the step, which may be none."""

    name: str
    restitution: float
    height: float
    radius: float
    step: str | None

    @property
    def bounce(self):
        return Bounce(
            mass=0.1,
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


def answered(case, engine):
    """Return the answer whose lines are pasted; None if there is none."""
    found = design(case.bounce, engine, case.step)
    return next((each for each in (found, *found.also) if each.snippet), None)


def by_spring(name, answer):
    """Return r over instants within a step, of a row of :data:`engine_runs.RUNS`."""
    instants = 3 if name in SLOW else INSTANTS
    return engine_runs.measure(answer, "ball", instants=instants).restitution


def by_number(name, answer):
    """Return r over instants within a step, of a row of :data:`engine_drops.ENGINES`."""
    bounce = answer.bounce
    skin = BY_NUMBER[name].skin
    way = bounce.impact_speed * answer.time_step
    drops = bounce.impact_speed**2 / (2 * G) + way * (np.arange(INSTANTS) / INSTANTS - 0.5)
    steps = math.ceil(2.4 * bounce.impact_speed / G / answer.time_step) + 6
    turns = [{}]
    if BY_NUMBER[name].turns:
        # Half the angle between two corners of the coarsest polygon, which has ten.
        turns = [{"turn": float(turn)} for turn in np.linspace(0, math.pi / 10, 4)]
    found = []
    for turn in turns:
        run = functools.partial(engine_drops.ENGINES[name], **turn)
        heights = run(answer.snippet, skin + drops, bounce.size, steps) - skin
        found += [
            math.sqrt(engine_runs.rebound(column) / drop)
            for column, drop in zip(heights.T, drops, strict=True)
        ]
    return min(found), max(found)


HEAD = ["engine", "case", "given", "step, ms", "r promised", "r in the engine", "promise"]


def cells(name, case, engine, run):
    """Return the cells of a row but the first."""
    given = f"r = {case.restitution}, {case.height:g} m, {case.radius:g} m, {case.step or '–'}"
    answer = answered(case, engine)
    if answer is None:
        return [case.name, given, "–", "nothing to paste", "–", KEPT[None]]
    low, _, high = answer.outcome.restitution
    least, most = run(name, answer)
    # Three digits are printed.
    is_kept = low - 5e-4 <= least and most <= high + 5e-4
    texts = [f"{1e3 * answer.time_step:.4g}", f"{low:.3f} to {high:.3f}"]
    return [case.name, given, *texts, f"{least:.3f} to {most:.3f}", KEPT[bool(is_kept)]]


def plans():
    """Yield the rows: the name, the engine of a design, how it is run, and the cases."""
    for name, row in ENGINES.items():
        yield name, row, by_spring if name in engine_runs.RUNS else None, SPRINGS
    for name, row in BY_NUMBER.items():
        cases = [*NUMBERS, WITHOUT_STEP] if row.springs else NUMBERS
        if name in engine_drops.ENGINES:
            yield name, name, by_number, cases
        else:
            is_run = name in engine_runs.RUNS or name in engine_runs.ROWS
            yield name, name, by_spring if is_run else None, cases


def reason(name):
    """Return why an engine is not run, as its row has it."""
    row = BY_NUMBER[name]
    return next((note for note in row.notes if "was not run" in note), f"no program for {name}")


def main():
    rows = []
    missing = {}
    for name, engine, run, cases in plans():
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
    ran = {row[0] for row in rows}
    for name, why in missing.items():
        print(f"Not run: {name}, because {why}.")
        if name not in ran:
            rows.append([name, why, *[""] * (len(HEAD) - 3), NOT_RUN])
    save("pasted", HEAD, rows)
    differ = sum(row[-1] == KEPT[False] for row in rows)
    print(f"{differ} promises are not kept.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
