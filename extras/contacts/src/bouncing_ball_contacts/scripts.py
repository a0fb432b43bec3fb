"""Scripts that let the bodies of a design bounce in its engine and print how they rebound."""

import math

from bouncing_ball_contacts.designs import Design
from bouncing_ball_contacts.engines import filled, snippet_of
from bouncing_ball_contacts.units import Refused, span

FAMILIES = {
    "mujoco": "mujoco",
    "pybullet": "pybullet",
    "drake": "drake",
    "drake-sap": "drake",
    "lammps": "lammps",
    "lammps-limit-damping": "lammps",
    "lammps-hertz": "lammps",
    "newton": "newton",
}
"""The engines that have scripts; those of engines with several contacts are the same."""
# A ball, and a box with four contact points, in those engines that have boxes.
_SHAPES = {
    "mujoco": (
        'size="@radius@"',
        'type="box" size="@radius@ @radius@ @radius@"',
    ),
    "pybullet": (
        "pybullet.GEOM_SPHERE, radius=@radius@",
        "pybullet.GEOM_BOX, halfExtents=[@radius@, @radius@, @radius@]",
    ),
    "drake": (
        "Sphere(@radius@)",
        "Box(2 * @radius@, 2 * @radius@, 2 * @radius@)",
    ),
}


def drop_script(design: Design) -> str:
    """Return a script in Python that drops the body of a design in its engine.

    It is a ball, or a box if the design has four contact points. Two free balls meet without
    gravity; they have the same density.

    Raises
    ------
    Refused
        If there is no script for the engine or for this bounce.
    """
    bounce = design.bounce
    family = FAMILIES.get(design.engine)
    if family is None:
        known = ", ".join(FAMILIES)
        raise Refused(f"no script is written for {design.engine}: only for {known}")
    is_pair = bounce.other_mass is not None
    text = snippet_of(f"{family}-meet" if is_pair else f"{family}-drop")
    if not text:
        raise Refused(f"no script of two free balls is written for {design.engine}")
    if bounce.points > 1 and (bounce.points != 4 or family not in _SHAPES or is_pair):
        raise Refused("a script drops a ball, or in MuJoCo, PyBullet and Drake a box of 4 points")
    if not (bounce.gravity or is_pair):
        raise Refused("a script drops a body: it needs gravity")
    row = design.row
    speed = bounce.impact_speed
    low, _, high = row.outcome.restitution
    lasts = 8 * row.outcome.depth[1] / speed
    if is_pair:
        # They touch within the eleventh step.
        gap = 10.5 * speed * row.step
        steps = math.ceil(lasts / row.step) + 22
        fall = 0.0
    else:
        gap = speed**2 / (2 * bounce.gravity)
        fall = speed / bounce.gravity
        steps = math.ceil((2.05 * fall + lasts) / row.step) + 10
    # Twice as long as until all bounces are over, because steps of gravity prolong the last ones.
    seconds = 2 * fall * (1 + high) / max(1 - high, 0.02) + lasts + 3
    radius = bounce.size
    other = bounce.other_mass or bounce.mass
    other_radius = radius * (other / bounce.mass) ** (1 / 3)
    values = {
        "mass": bounce.mass,
        "radius": radius,
        "other_mass": other,
        "other_radius": other_radius,
        "diameter": 2 * radius,
        "other_diameter": 2 * other_radius,
        "density": bounce.mass / (4 / 3 * math.pi * radius**3),
        "gravity": bounce.gravity,
        "speed": speed,
        "height": gap,
        "start": radius + gap,
        "apart": radius + other_radius + gap,
        "top": 2 * (radius + other_radius + gap + row.outcome.depth[1]),
        "step": row.step,
        # Within a step, so that rounding errors take none away.
        "end": (steps + 0.5) * row.step,
    }
    texts = {name: f"{value:.9g}" for name, value in values.items()}
    texts["steps"] = str(steps)
    texts["long"] = str(max(steps, math.ceil(seconds / row.step)))
    texts["last"] = str(math.ceil(0.5 / row.step))
    texts["seconds"] = f"{seconds:.2g}"
    # At this step the ball is in contact.
    texts["fall"] = str(math.ceil(fall / row.step) + 1)
    texts["rise"] = span(low**2 * gap, high**2 * gap, form="g")
    texts["leave"] = span(low, high)
    texts["recipe"] = design.snippet
    ball, box = _SHAPES.get(family, ("", ""))
    texts["shape"] = filled(box if bounce.points > 1 else ball, texts)
    # In PyBullet a box gets its four points at once on a box, and not on a plane.
    texts["table"] = "GEOM_BOX, halfExtents=[9, 9, 9]" if bounce.points > 1 else "GEOM_PLANE"
    texts["below"] = "-9" if bounce.points > 1 else "0"
    texts["body"] = "box of a half height" if bounce.points > 1 else "ball of a radius"
    return filled(text, texts)
