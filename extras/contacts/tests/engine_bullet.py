"""Contacts that PyBullet finds ahead, or when boxes touch.

``python tests/engine_bullet.py`` lets balls and boxes meet a table, at 16 instants
within a step, without friction and with it, and saves r as diagnosed and in PyBullet in
docs/validation/bullet.csv. The exit status is 1 if one differs.
"""

import sys

import numpy as np
import pybullet
from engine_page import KEPT, save

from bouncing_ball_contacts import Bounce, diagnose

G = 9.80665
SPEED = 3.0
LONG = 1 / 240
FRICTION = 0.3
SLIDE = 0.5
NUMBER = {"restitution": 0.9}


def spring(stiffness, damping):
    return {"contactStiffness": stiffness, "contactDamping": damping}


# What meets what, the radius or half height in m, the step, the parameters.
CASES = [
    ("ball, plane", 0.5, LONG, spring(1e5, 10)),
    ("ball, plane", 1.0, LONG, spring(1e6, 5)),
    ("ball, plane", 1.0, 1e-3, spring(1e6, 5)),
    ("ball, plane", 0.5, LONG, spring(1e4, 2)),
    ("ball, plane", 0.1, 1e-3, spring(1e5, 5)),
    ("ball, plane", 0.02, 1e-3, spring(1e5, 20)),
    ("ball, plane", 0.5, LONG, NUMBER),
    ("ball, plane", 0.05, 1e-3, NUMBER),
    ("ball, box", 0.5, LONG, spring(1e5, 10)),
    ("ball, box", 0.1, 1e-3, spring(1e5, 5)),
    ("box, box", 0.1, 1e-3, spring(1e4, 2)),
    ("box, box", 0.1, 1e-3, spring(1e5, 5)),
]


def body(shape, size, mass, height):
    if shape == "plane":
        collision_shape = pybullet.createCollisionShape(pybullet.GEOM_PLANE)
    elif shape == "ball":
        collision_shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=size)
    else:
        collision_shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[size] * 3)
    return pybullet.createMultiBody(mass, collision_shape, basePosition=[0, 0, height])


def met(shapes, size, step, parameters, gap, friction):
    """Return r of one impact by the heights above a table.

    With friction a body that falls moves along the table as well.
    """
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -G)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=step, numSubSteps=1)
    above, below = shapes.split(", ")
    one = body(above, size, 1.0, size + gap)
    other = body(below, 9.0, 0, 0.0 if below == "plane" else -9.0)
    for body_id in (one, other):
        pybullet.changeDynamics(body_id, -1, **parameters, lateralFriction=friction**0.5)
    if friction:
        pybullet.resetBaseVelocity(one, [SLIDE, 0, 0])
    heights = [gap]
    for _ in range(int(1.2 / step)):
        pybullet.stepSimulation()
        heights.append(pybullet.getBasePositionAndOrientation(one)[0][2] - size)
    turn = int(np.argmax(np.diff(heights) >= -1e-9))
    falls = np.diff(heights[turn:]) < 0
    top = turn + int(np.argmax(falls)) if falls.any() else len(heights) - 1
    return np.sqrt(max(max(heights[turn : top + 1]), 0) / gap)


HEAD = [
    "engine",
    "friction",
    "bodies",
    "size, m",
    "step, ms",
    "parameters",
    "r",
    "r in the engine",
    "promise",
]


def table(friction):
    """Return the rows of a table."""
    rows = []
    for shapes, size, step, parameters in CASES:
        asked = dict(mass=1.0, radius=size, speed=SPEED, points=4 if "box, " in shapes else 1)
        diagnosis = diagnose(Bounce(**asked), "pybullet", parameters, step)
        height = SPEED**2 / (2 * G)
        measured = [
            met(shapes, size, step, parameters, height + SPEED * step * share, friction)
            for share in np.linspace(0, 1, 16)
        ]
        low, mean, high = diagnosis.outcome.restitution
        agrees = low - 2e-3 <= min(measured) and max(measured) <= high + 2e-3
        agrees &= abs(np.mean(measured) - mean) < 0.01 + (high - low) / 16
        given = ", ".join(f"{name} = {value:g}" for name, value in parameters.items())
        texts = [shapes, f"{size:g}", f"{1e3 * step:.3g}", given]
        texts += [f"{low:.3f} to {high:.3f}", f"{min(measured):.3f} to {max(measured):.3f}"]
        rows.append(["pybullet", f"{friction:g}", *texts, KEPT[bool(agrees)]])
        print(" | ".join(rows[-1]), flush=True)
    return rows


def main():
    pybullet.connect(pybullet.DIRECT)
    rows = table(0.0) + table(FRICTION)
    save("bullet", HEAD, rows)
    differ = sum(row[-1] == KEPT[False] for row in rows)
    print(f"{len(rows) - differ} of {len(rows)} agree with PyBullet.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
