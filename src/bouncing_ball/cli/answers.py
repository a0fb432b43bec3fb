"""The answers of the subcommands, as plain dictionaries.

The options come from the signatures of the public calls and of the functions in this module.
"""

import math
from typing import Any

import numpy as np

from bouncing_ball.beyond import error_law as error_laws
from bouncing_ball.beyond.continued_orbits import restitution_speed
from bouncing_ball.beyond.corrected.signature import Signature, free_impact
from bouncing_ball.beyond.laws.contact_law import ContactLaw
from bouncing_ball.calls import balls as models
from bouncing_ball.calls import over_time as motion
from bouncing_ball.calls import periodic as orbits
from bouncing_ball.calls.signatures import takes
from bouncing_ball.cli.output import lines as lines
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.sequence import Status
from bouncing_ball.paper.orbits.orbit import OBSERVABLES, Orbit
from bouncing_ball.paper.orbits.stability import Bifurcation

Answer = dict[str, Any]


def _described(of: Any, speed: float = math.nan) -> Answer:
    """r and ζ of a linear contact; of another law the parameters, and r and D at a speed."""
    match of:
        case SpringDamper():
            return {
                "measured_restitution": float(of.restitution),
                "damping_ratio": float(of.damping_ratio),
            }
        case ContactLaw():
            impact = free_impact(of, np.float64(speed))
            return {
                "law": of.name,
                "parameters": {name: float(x) for name, x in of.parameters().items()},
                "measured_restitution": float(impact.restitution),
                "free_duration": float(impact.duration),
                "frequency_ratio": math.pi / float(impact.duration),
                "at_impact_speed": speed,
            }
        case Signature(inner):
            return _described(inner, speed)
    return {}


def _orbit(found: Orbit) -> Answer:
    return {
        **{name: float(getattr(found, name)) for name in OBSERVABLES if name != "amplitude"},
        "multipliers": [[x.real, x.imag] for x in found.multipliers().tolist()],
        "is_stable": bool(found.is_stable()),
        "is_admissible": bool(found.is_admissible()),
        "residual": float(found.defect()),
    }


@takes(orbits.orbit)
def orbit(n=1, **given: Any) -> Answer:
    """The n-T orbit at Λ on one side of the saddle-node, all orbits there, or one of these."""
    found = orbits.orbit(n, **given)
    several = [_orbit(found[k]) for k in range(found.size)] if found.shape else []
    answer = {"orbits": several} if several else _orbit(found)
    return answer | _described(found.law, -float(np.ravel(found.relative_impact_velocity)[0]))


@takes(orbits.limits)
def limits(n=1, **impact: Any) -> Answer:
    """Saddle-node and period doubling of a family, and whether their orbits are admissible.

    Raises
    ------
    NoOrbitError
        If the branch has no saddle-node or no period doubling.
    """
    of = models.model_of_limits(n, **impact)
    found: Answer = {}
    for name in orbits.Limits._fields:
        orbit = getattr(of, name)(n)
        if not orbit.exists:
            what, branch = Bifurcation[name.upper()], f"the branch of {n}-T orbits for {of.label}"
            raise NoOrbitError(f"no {what} was found on {branch}")
        found[name] = {key: float(getattr(orbit, key)) for key in OBSERVABLES[:3]}
        found[name]["is_admissible"] = bool(orbit.is_admissible())
    # The two limits have different impact speeds, so that a contact law is described at the impact
    # speed of the restitution model.
    return found | _described(orbit.law, float(restitution_speed(n, of)[0]))


@takes(orbits.orbit, "n", "amplitude", "release", *models.LOSS)
def error_law(n=1, **given: Any) -> Answer:
    """The coefficient K of each quantity, whose relative error has the modulus K/ϖ + O(1/ϖ²).

    The restitution model has the r of a free impact on the contact. The sign in ``signed`` is that
    of the relative error, exact value minus restitution model. A quantity without a first-order law
    is null.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node of the restitution model.
    """
    amplitude = given.pop("amplitude")
    # The coefficients do not depend on ϖ; the contact with ϖ = 1 stands for all.
    of: Any = models.model(model="spring-damper", frequency_ratio=1.0, **given)
    contact = of.contact
    zeta, release = contact.damping_ratio, contact.release
    law = error_laws.coefficients(n, zeta, amplitude, release)
    signed = {str(name): float(k) if math.isfinite(k) else None for name, k in law.items()}
    second = error_laws.permanent_contact_coefficient(zeta, release)
    return {
        "coefficients": {name: k if k is None else abs(k) for name, k in signed.items()},
        "signed": signed,
        "second_order": {"permanent_contact": abs(float(second))},
        **_described(contact),
    }


@takes(models.model, "release", *models.LOSS)
def permanent_contact(*, frequency_ratio: models.FrequencyRatio, **given: Any) -> Answer:
    """The Λ up to which the ball stays on the table."""
    of: Any = models.model(model="spring-damper", frequency_ratio=frequency_ratio, **given)
    threshold = float(of.permanent_contact_threshold())
    return {"threshold_amplitude": threshold} | _described(of.contact)


@takes(motion.simulate)
def simulate(amplitude, phase, velocity, impacts, **impact: Any) -> Answer:
    """The sequence of impacts of one ball as lists, with null for an event that does not happen."""
    of = models.model_of_impact(amplitude, phase, velocity, **impact)
    found = of.simulate(amplitude, phase, velocity, impacts)
    names = ("time", "phase", "impact_velocity", "contact_duration", "bounce_velocity")
    columns = np.array([getattr(found, name) for name in names])
    there = columns[:, np.isfinite(found.time)]
    sequence = [[x if math.isfinite(x) else None for x in column] for column in there.tolist()]
    return {
        "status": Status(int(found.status)).name.lower().replace("_", " "),
        **_described(of.orbit_of(1, amplitude, phase).law, -float(found.relative_velocity[0])),
        "sequence": dict(zip((*names[:-1], "bounce_velocity"), sequence, strict=True)),
    }
