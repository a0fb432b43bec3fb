"""Scripts that drop the ball of a design in its engine and print the rebound."""

import math

from bouncing_ball_contacts.designs import Design
from bouncing_ball_contacts.engines import filled, text_of
from bouncing_ball_contacts.units import Refused

# The scripts of engines with several contacts are the same.
_FILES = {
    "mujoco": "mujoco-drop",
    "pybullet": "pybullet-drop",
    "drake": "drake-drop",
    "drake-hunt-crossley": "drake-drop",
    "lammps": "lammps-drop",
    "lammps-limit-damping": "lammps-drop",
    "lammps-hertz": "lammps-drop",
    "newton": "newton-drop",
}


def drop_script(design: Design) -> str:
    """Return a script in Python that drops the ball of a design in its engine.

    Raises
    ------
    Refused
        If there is no script for the engine or for this bounce.
    """
    bounce = design.bounce
    if design.engine not in _FILES:
        raise Refused(f"no script is written for {design.engine}: only for {', '.join(_FILES)}")
    if bounce.points > 1 or bounce.other_mass is not None or design.one_body:
        raise Refused("a script drops one ball on a table: leave out points, other mass, one body")
    row = design.row
    height = bounce.impact_speed**2 / (2 * bounce.gravity)
    fall = math.sqrt(2 * height / bounce.gravity)
    low, _, high = row.outcome.restitution
    contact = 8 * row.outcome.depth[1] / bounce.impact_speed
    steps = math.ceil((2.05 * fall + contact) / row.step) + 10
    radius = bounce.size
    values = {
        "mass": bounce.mass,
        "radius": radius,
        "diameter": 2 * radius,
        "density": bounce.mass / (4 / 3 * math.pi * radius**3),
        "gravity": bounce.gravity,
        "height": height,
        "start": radius + height,
        "top": 2 * (radius + height + row.outcome.depth[1]),
        "step": row.step,
        # Within a step, so that rounding errors take none away.
        "end": (steps + 0.5) * row.step,
    }
    texts = {name: f"{value:.9g}" for name, value in values.items()}
    texts["steps"] = str(steps)
    # At this step the ball is in contact.
    texts["fall"] = str(math.ceil(fall / row.step) + 1)
    texts["rise"] = f"{low**2 * height:.3g} to {high**2 * height:.3g}"
    texts["recipe"] = design.snippet
    return filled(text_of(_FILES[design.engine]), texts)
