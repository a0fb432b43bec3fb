"""Scripts that let the bodies of a design bounce in its engine and print how they rebound."""

import math

from bouncing_ball_contacts.designs import Design
from bouncing_ball_contacts.engines import filled, snippet_of
from bouncing_ball_contacts.units import refuse, span

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
_BALLS = {
    "mujoco": 'size="@radius@"',
    "pybullet": "pybullet.GEOM_SPHERE, radius=@radius@",
    "drake": "Sphere(@radius@)",
}
_BOXES = {
    "mujoco": 'type="box" size="@radius@ @radius@ @radius@"',
    "pybullet": "pybullet.GEOM_BOX, halfExtents=[@radius@, @radius@, @radius@]",
    "drake": "Box(2 * @radius@, 2 * @radius@, 2 * @radius@)",
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
    family = FAMILIES.get(design.engine, "")
    is_pair = bounce.other_mass is not None
    is_box = bounce.points > 1
    text = snippet_of(f"{family}-meet" if is_pair else f"{family}-drop")
    refuse(
        [
            (
                not family,
                f"no script is written for {design.engine}: only for {', '.join(FAMILIES)}",
            ),
            (not text, f"no script of two free balls is written for {design.engine}"),
            (
                is_box and (bounce.points != 4 or family not in _BOXES or is_pair),
                "a script drops a ball, or in MuJoCo, PyBullet and Drake a box of 4 points",
            ),
            (not (bounce.gravity or is_pair), "a script drops a body: it needs gravity"),
        ]
    )
    step = design.row.step
    depth = design.row.outcome.depth[1]
    low, _, high = design.row.outcome.restitution
    speed = bounce.impact_speed
    lasts = 8 * depth / speed
    fall = 0.0 if is_pair else speed / bounce.gravity
    # Two balls touch within the eleventh step.
    gap = 10.5 * speed * step if is_pair else speed * fall / 2
    steps = math.ceil((2.05 * fall + lasts) / step) + (22 if is_pair else 10)
    # Twice as long as until all bounces are over, because steps of gravity prolong the last ones.
    seconds = 2 * fall * (1 + high) / max(1 - high, 0.02) + lasts + 3
    radius = bounce.size
    other = bounce.other_mass or bounce.mass
    other_radius = radius * (other / bounce.mass) ** (1 / 3)
    numbers = {
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
        "top": 2 * (radius + other_radius + gap + depth),
        "step": step,
        # Within a step, so that rounding errors take none away.
        "end": (steps + 0.5) * step,
    }
    size = {"radius": f"{radius:.9g}"}
    texts = {name: f"{value:.9g}" for name, value in numbers.items()} | {
        "steps": str(steps),
        "long": str(max(steps, math.ceil(seconds / step))),
        "last": str(math.ceil(0.5 / step)),
        "seconds": f"{seconds:.2g}",
        # At this step the ball is in contact.
        "fall": str(math.ceil(fall / step) + 1),
        "rise": span(low**2 * gap, high**2 * gap, form="g"),
        "leave": span(low, high),
        "recipe": design.snippet,
        "shape": filled((_BOXES if is_box else _BALLS).get(family, ""), size),
        # In PyBullet a box gets its four points at once on a box, and not on a plane.
        "table": "GEOM_BOX, halfExtents=[9, 9, 9]" if is_box else "GEOM_PLANE",
        "below": "-9" if is_box else "0",
        "body": "box of a half height" if is_box else "ball of a radius",
    }
    return filled(text, texts)
