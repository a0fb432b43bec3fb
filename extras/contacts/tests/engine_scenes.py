"""Scenes in the engines: ``python tests/engine_scenes.py [ENGINE]...``.

Each scene is a bounce that one would use a design for, with the row that is starred. A body starts
close to the surface with the speed of its drop, at several instants within a step, and r is √ of
the heights that it would fly to without the contact, before and after. The promise is kept if r is
within what the answer says, for bodies that slide if they do. Nothing is promised of what no
contact keeps, nor of boxes in engines whose answer says that r is that of a box which falls flat on
a plane and does not slide, or excepts boxes on boxes. Of a body at rest on a slope the speed is
given with which it creeps.

The rows of the engines that were run are saved in docs/validation/scenes.csv. The exit status is 1
if a promise is not kept.
"""

import math
import sys
from functools import cache
from typing import NamedTuple

import engine_runs
import numpy as np
from engine_page import KEPT, save

from bouncing_ball_contacts import ENGINES, Bounce, Refused, design
from bouncing_ball_contacts.designs import Problem
from bouncing_ball_contacts.rows import ON_BOXES

BALL = dict(mass=0.5, radius=0.1, restitution=0.8)
GOLF = dict(mass=0.046, radius=0.0213, restitution=0.8)
PING_PONG = dict(mass=0.0027, radius=0.02, restitution=0.9)
BOX = {**BALL, "points": 4}
INSTANTS = 5


class Scene(NamedTuple):
    """A bounce with its step, its friction, and how it starts; see :class:`engine_runs.Trial`.

    Where ``is_promised`` is not, the scene shows what no contact keeps.
    """

    name: str
    bounce: dict
    step: str
    friction: float = 0.5
    how: dict = {}
    is_promised: bool = True

    @property
    def shape(self):
        return "box" if "points" in self.bounce else "ball"


SCENES = [
    *(Scene(f"friction {mu}", BALL, "1 ms", mu) for mu in (0, 0.1, 0.3, 0.5, 1, 1.5)),
    Scene("1 m/s along", BALL, "1 ms", 0.3, dict(slide=1)),
    *(
        Scene(f"5 m/s along, friction {mu}", BALL, "1 ms", mu, dict(slide=5))
        for mu in (0.1, 0.5, 1.5)
    ),
    *(Scene(f"spin 30 rad/s, friction {mu}", BALL, "1 ms", mu, dict(spin=30)) for mu in (0.1, 1)),
    Scene("3 m/s along, spin -30 rad/s", BALL, "1 ms", 0.5, dict(slide=3, spin=-30)),
    Scene("table of 2 cm", BALL, "1 ms", 0.5, dict(table="slab")),
    Scene("table of 2 cm, 5 m/s along", BALL, "1 ms", 0.5, dict(table="slab", slide=5)),
    *(
        Scene(f"{step}, 3 m/s along", BALL, step, 0.5, dict(slide=3))
        for step in ("2 ms", "4 ms", "1/240", "1/60")
    ),
    *(
        Scene(f"{step}, table of 2 cm", BALL, step, 0.5, dict(table="slab"))
        for step in ("4 ms", "1/60")
    ),
    Scene("moon, 1 m/s along", {**BALL, "gravity": 1.62}, "2 ms", 0.5, dict(slide=1)),
    *(
        Scene(f"r = {r}, 3 m/s along", {**BALL, "restitution": r}, "2 ms", 0.3, dict(slide=3))
        for r in (0.3, 0.5, 0.95)
    ),
    # Here the damper of MuJoCo pushes most.
    Scene("r = 0.3, 5 m/s along", {**BALL, "restitution": 0.3}, "4 ms", 0.1, dict(slide=5)),
    Scene("golf ball, table of 2 cm", GOLF, "4 ms", 0.5, dict(table="slab", slide=3)),
    Scene("table tennis ball, 3 m/s along", PING_PONG, "1 ms", 0.3, dict(slide=3)),
    *(Scene(f"box, friction {mu}", BOX, "1 ms", mu) for mu in (0, 0.5, 1)),
    Scene("box, table of 2 cm", BOX, "1 ms", 0.5, dict(table="slab")),
    Scene("box, 4 ms", BOX, "4 ms"),
    Scene("box, 3 m/s along", BOX, "1 ms", 0.5, dict(slide=3)),
    Scene("box, 5 m/s along, friction 1", BOX, "1 ms", 1, dict(slide=5), False),
    *(Scene(f"box on an edge, friction {mu}", BOX, "1 ms", mu, dict(tilt=45)) for mu in (0.1, 1)),
    *(Scene(f"box {deg}° off flat", BOX, "1 ms", 0.5, dict(tilt=deg), False) for deg in (1, 5)),
    Scene("box 5° off flat, 3 m/s along", BOX, "1 ms", 0.5, dict(tilt=5, slide=3), False),
    *(
        Scene(f"box at rest on 10°, friction {mu}", BOX, "2 ms", mu, dict(slope=10))
        for mu in (0.3, 1)
    ),
]
WITHOUT_BOXES = ("lammps", "lammps-limit-damping", "lammps-hertz")


@cache
def _designed(engine, bounce, step, friction):
    name = engine_runs.number_row(engine)
    return design(Bounce(**dict(bounce), friction=friction), name, step)


def corners(poses, size):
    """Return the height of the lowest corner of a cube over its poses."""
    w, x, y, z = poses[:, 3:7].T
    # The third row of the rotation matrix.
    upwards = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    return poses[:, 2] - size * np.abs(upwards).sum(axis=0)


def flight(z, g, h):
    """Return the height over which a body turns, from its heights after two free steps.

    For v⁺ = v - g h, z⁺ = z + h v⁺ it is z + v²/(2g) - v h/2 in each step, and also for velocity
    Verlet, whose v of half steps this is.
    """
    v = (z[1] - z[0]) / h
    return z[1] + v * v / (2 * g) - v * h / 2


def restitution(trial, motion):
    """Return r of the first impact, 0 if the body stays, and NaN if it is lost."""
    h, size = trial.step, trial.size
    z = motion.poses[:, 2] - trial.touching
    low = corners(motion.poses, size) if trial.shape == "box" else z
    if z.min() < -20 * size:
        return math.nan
    free = (low > 0.05 * size) & (np.gradient(z) > 0)
    free[: int(np.argmin(z)) + 1] = False
    if not free[:-1].any():
        return 0.0
    after = int(np.argmax(free))
    before = flight(z[:2], trial.gravity, h)
    return math.sqrt(max(flight(z[after : after + 2], trial.gravity, h), 0.0) / before)


def run(engine, scene):
    """Return the design, least and greatest r or the creep in m/s, and the depth over the size."""
    bounce = tuple(scene.bounce.items())
    answer = _designed(engine, bounce, scene.step, scene.friction)
    wanted = answer.bounce
    h, speed = answer.time_step, wanted.impact_speed
    deepest_said = max(answer.outcome.depth, default=0.0) or speed * h
    g = wanted.gravity
    on = engine_runs.RUNS[engine]
    if "slope" in scene.how:
        steps = int(1 / h)
        trial = engine_runs.Trial(answer, "box", 0.0, 0.0, steps, g, scene.friction, **scene.how)
        x = on(trial).poses[:, 0]
        creep = float(np.ptp(x[steps // 2 :]) / (0.5 - h))
        return answer, (creep, creep), math.nan
    measured = []
    deepest = 0.0
    for share in (np.arange(INSTANTS) + 0.5) / INSTANTS:
        gap = float((3 + share) * h * speed)
        start = speed
        if g:
            # With it the body falls as from the height of its drop.
            start = g * (math.sqrt(h * h / 4 + 2 * (speed**2 / (2 * g) - gap) / g) - h / 2)
        # Until it has come out slowly and has risen by a quarter of its size.
        seconds = gap / speed + 6 * deepest_said / speed + 0.3 * wanted.size / (0.2 * speed)
        steps = int(seconds / h) + 20
        trial = engine_runs.Trial(
            answer, scene.shape, gap, start, steps, g, scene.friction, **scene.how
        )
        motion = on(trial)
        measured.append(restitution(trial, motion))
        deepest = max(deepest, -float(motion.heights.min()) / wanted.size)
    if any(map(math.isnan, measured)):
        return answer, (math.nan, math.nan), deepest
    return answer, (min(measured), max(measured)), deepest


def promise(answer, scene):
    """Return the least and the greatest r that the answer has for a scene, and whether it promises.

    A box has to fall flat on a plane and not to slide, if the answer says so.
    """
    engine = ENGINES[engine_runs.ROWS.get(answer.engine, answer.engine)]
    low, _, high = answer.outcome.restitution
    spin = abs(scene.how.get("spin", 0.0)) * answer.bounce.size
    speed = (scene.how.get("slide", 0.0) + spin) / answer.bounce.impact_speed
    if speed and "stiffness" in answer.numbers:
        low, high = Problem(answer.bounce, engine).promised(answer.outcome, speed)
    is_excepted = scene.shape == "box" and (
        (engine.flat_only and bool(scene.how))
        or (ON_BOXES in engine.not_for and "table" in scene.how)
    )
    return low, high, scene.is_promised and not is_excepted


def cells(engine, scene):
    """Return the cells of a scene, and whether the promise is kept (None if there is none)."""
    answer, (least, most), deepest = run(engine, scene)
    kind = "springs" if "stiffness" in answer.numbers else "number"
    texts = [scene.name, f"{scene.friction:g}", f"{kind}, {1e3 * answer.time_step:.4g} ms"]
    if "slope" in scene.how:
        return [*texts, "–", f"creeps at {1e3 * least:.2g} mm/s", "–"], None
    low, high, is_promised = promise(answer, scene)
    # Three digits are printed.
    kept = bool(low - 5e-4 <= least and most <= high + 5e-4) if is_promised else None
    said = f"{low:.3f} to {high:.3f}" if is_promised else f"({low:.3f} to {high:.3f})"
    does = "lost" if math.isnan(least) else f"{least:.3f} to {most:.3f}"
    computed = max(answer.outcome.depth, default=math.nan) / answer.bounce.size
    return [*texts, said, does, f"{computed:.2f}, {deepest:.2f}"], kept


HEAD = [
    "engine",
    "scene",
    "friction",
    "written",
    "r promised",
    "r in the engine",
    "sinks, in radii",
    "promise",
]


def table(engine):
    """Return the rows of an engine."""
    rows = []
    for scene in SCENES:
        is_missing = scene.shape == "box" and engine in WITHOUT_BOXES
        is_missing |= "table" in scene.how and engine in WITHOUT_BOXES
        if is_missing:
            continue
        try:
            texts, is_kept = cells(engine, scene)
        except Refused as refusal:
            refused = f"refused: {refusal}"
            texts, is_kept = [scene.name, f"{scene.friction:g}", refused, "", "", ""], None
        rows.append([engine, *texts, KEPT[is_kept]])
        print(" | ".join(rows[-1]), flush=True)
    return rows


def main():
    names = sys.argv[1:] or [
        name for name in engine_runs.RUNS if name not in engine_runs.DROPS_ONLY
    ]
    differ = 0
    for name in names:
        try:
            rows = table(name)
        except ImportError as missing:
            print(f"Not run, because it is not installed: {name} ({missing.name}).")
            continue
        save("scenes", HEAD, rows)
        differ += sum(row[-1] == KEPT[False] for row in rows)
    print(f"{differ} promises are not kept.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
