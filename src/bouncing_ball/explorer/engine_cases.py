"""The engines as data: their texts with placeholders for numbers, and settings to compare with.

The page of the explorer writes the same texts in the reader's browser.
"""

import json
from typing import Any

from bouncing_ball.contacts.engines.choice import ENGINES
from bouncing_ball.contacts.engines.engine import Engine, Physical
from bouncing_ball.errors import ModelError
from bouncing_ball.models.damping import Release, damping_ratio

# m, k, r and the error of r that the time step may cause: from light to heavy and elastic balls.
_CASES = (
    (0.5, 1e5, 0.75, 1e-3),
    (0.02, 3e7, 0.9, 0.01),
    (3.0, 2e3, 0.3, 2e-3),
    (1.0, 1e4, 1.0, 0.02),
)


def _case(engine: Engine, release: Release, *case: float) -> dict[str, Any] | None:
    """The settings of a contact; None if the engine has no contact with this r."""
    mass, stiffness, restitution, error = case
    try:
        zeta = float(damping_ratio(restitution, release))
        contact = Physical(mass, stiffness, 2 * zeta * mass * (stiffness / mass) ** 0.5)
        found = engine.settings(contact, release, error)
    except ModelError:
        return None
    return {
        "state": [engine.name, str(release), *case],
        "values": [found.time_step, found.steps, found.restitution],
        "snippet": found.snippet,
    }


def as_json() -> str:
    """The engines of the page by name, and the settings of four contacts under each release."""
    pairs = [(engine, rule) for engine in ENGINES.values() for rule in engine.releases]
    engines = {
        engine.name: {
            "scheme": str(engine.scheme),
            "snippets": {str(rule): engine.template(rule) for rule in engine.releases},
        }
        for engine in ENGINES.values()
    }
    tried = (_case(engine, rule, *case) for engine, rule in pairs for case in _CASES)
    cases = [case for case in tried if case is not None]
    # Without "<" no text can open or close a tag of the page.
    return json.dumps({"engines": engines, "cases": cases}, allow_nan=False).replace("<", "\\u003c")
