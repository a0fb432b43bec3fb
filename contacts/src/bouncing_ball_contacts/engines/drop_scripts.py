"""Scripts that drop a ball in an engine, with the text to paste, and print its rebound."""

import math

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.engines.engine import filled, text_to_paste
from bouncing_ball_contacts.engines.settings import EngineSettings

ENGINES = ("mujoco", "pybullet", "drake", "lammps")
"""The engines for which there is a script, ``snippets/NAME-drop.txt``."""
# The radius in m of a ball without one, and how much greater it is than the depth of the drop.
_RADIUS = 0.05
_DEPTHS = 10
# Falls and contacts until the ball is at its top, with a margin.
_FALLS = 2.2
_CONTACTS = 3


def drop_script(settings: EngineSettings, radius: float | None, gravity: float) -> str:
    """A script in Python for the drop of settings, of a ball with a radius in m.

    Raises
    ------
    ModelError
        If there is no script for the engine, or no drop.
    """
    if settings.name not in ENGINES:
        raise ModelError(f"no script is written for {settings.name}: one of {', '.join(ENGINES)}")
    drop = settings.drop
    if drop is None:
        raise ModelError(f"a drop in {settings.name} takes too many steps: allow a larger error")
    size = max(_RADIUS, _DEPTHS * drop.compression.most) if radius is None else radius
    fall = math.sqrt(2 * drop.height / gravity)
    steps = math.ceil(_FALLS * fall / settings.time_step + _CONTACTS * settings.steps)
    mass = settings.contact.mass
    numbers = {
        "mass": mass,
        "height": drop.height,
        "gravity": gravity,
        "radius": size,
        "diameter": 2 * size,
        "density": mass / (4 / 3 * math.pi * size**3),
        "start": size + drop.height,
        "top": 2 * (size + drop.height),
        "time_step": settings.time_step,
        # At this step the ball is in contact.
        "fall": math.ceil(fall / settings.time_step) + 1,
        "steps": steps,
        # Within a step, so that rounding errors take none away.
        "end": (steps + 0.5) * settings.time_step,
    }
    texts = {name: f"{value:.12g}" for name, value in numbers.items()}
    without = f", with a radius of {size:.3g} m because none was given,"
    recipe = settings.snippet
    if settings.name == "lammps":
        # The units come before the box.
        recipe = recipe.split("\n", 1)[1]
    text = text_to_paste(f"{settings.name}-drop")
    return filled(text, texts | {"recipe": recipe, "without": "" if radius else without}) + "\n"
