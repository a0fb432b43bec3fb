"""``bouncing-ball law-orbit``, ``law-limits`` and ``error-law``."""

import math
from typing import Any

import numpy as np

from bouncing_ball_beyond.accuracy import error_law as error_laws
from bouncing_ball_beyond.cli.impact import add_ball, ball_of
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.cli.balls import Answer, SideOrAll, add_contact, add_orbit
from bouncing_ball_beyond.inherited.cli.options import Parser, add_number, meanings
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    TOLERANCE,
    ReleaseName,
)
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, Bifurcation
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.makers import spring_damper
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic import orbits_of_ball as library
from bouncing_ball_beyond.periodic.one_impact.searched_orbits import restitution_speed
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit


def law_values(law: Any, speed: float = math.nan) -> Answer:
    """r and ζ of a linear contact; of another law the parameters, and r and D at a speed."""
    match law:
        case SpringDamper():
            return {
                "measured_restitution": float(law.restitution),
                "damping_ratio": float(law.damping_ratio),
            }
        case ContactLaw():
            impact = law.signature(np.float64(speed))
            return {
                "law": law.name,
                "parameters": {name: float(x) for name, x in law.parameters().items()},
                "measured_restitution": float(impact.restitution),
                "free_duration": float(impact.duration),
                "frequency_ratio": math.pi / float(impact.duration),
                "at_impact_speed": speed,
            }
        case Signature(inner):
            return law_values(inner, speed)
    return {}


def orbit_options(parser: Parser) -> None:
    """Add the options of :func:`orbit`."""
    add_orbit(parser)
    add_ball(parser)


def orbit(*, n: int, amplitude: float, side: SideOrAll, index: int | None, **impact: Any) -> Answer:
    """As ``bouncing-ball orbit``, for a ball of any model."""
    ball = ball_of(**impact)
    if index is not None:
        if side != "stable":
            raise ParameterError("argument {index}: not allowed with argument {side}")
        found = _numbered(library.orbits(ball, n, amplitude=amplitude), index)
        return _orbit(found) | _law_of(found)
    if side == "all":
        several = library.orbits(ball, n, amplitude=amplitude)
        return {"orbits": [_orbit(each) for each in several]} | _law_of(several[0])
    one: Any = library.orbit(ball, n, amplitude=amplitude, side=side)
    return _orbit(one) | _law_of(one)


def _numbered(found: list[Orbit], index: int) -> Orbit:
    if index > len(found):
        first = found[0]
        raise NoOrbitError(
            f"no orbit {index}: {first.model.label} has {len(found)} {first.n}-T orbits at "
            f"Λ = {first.amplitude:g}"
        )
    return found[index - 1]


def _orbit(found: Orbit) -> Answer:
    return {
        **{name: getattr(found, name) for name in OBSERVABLES if name != "amplitude"},
        "multipliers": [[x.real, x.imag] for x in found.multipliers().tolist()],
        "is_stable": found.is_stable(),
        "is_admissible": found.is_admissible(),
        "residual": found.defect(),
    }


def _law_of(found: Orbit) -> Answer:
    return law_values(found.law, -found.relative_impact_velocity)


def limits_options(parser: Parser) -> None:
    """Add the options of :func:`limits`."""
    add_number(parser, "n", FAMILY, meanings(library.limits)["n"], default=1)
    add_ball(parser)


def limits(*, n: int, **impact: Any) -> Answer:
    """As ``bouncing-ball limits``, for a ball of any model."""
    found: Any = library.limits(ball_of(**impact), n)
    answer: Answer = {}
    for name, end in found._asdict().items():
        if not end.exists:
            kind = Bifurcation[name.upper()]
            branch = f"the branch of {n}-T orbits for {end.model.label}"
            raise NoOrbitError(f"no {kind} was found on {branch}")
        answer[name] = {key: getattr(end, key) for key in OBSERVABLES[:3]}
        answer[name]["is_admissible"] = end.is_admissible()
    # The two limits have different impact speeds, so that a contact law is described at the impact
    # speed of the restitution model.
    model = found.saddle_node.model
    return answer | law_values(model.impact_law, float(restitution_speed(n, model)[0]))


def error_law_options(parser: Parser) -> None:
    """Add the options of :func:`error_law`."""
    texts = meanings(library.orbit)
    add_number(parser, "n", FAMILY, texts["n"], default=1)
    add_number(parser, "amplitude", AMPLITUDE_OF_ORBIT, texts["amplitude"], required=True)
    add_number(parser, "tolerance", TOLERANCE, "Tolerated relative error.", default=0.01)
    add_contact(parser)


def error_law(*, n: int, amplitude: float, tolerance: float, **contact: Any) -> Answer:
    """The ϖ from which on each error is within the tolerance, and the coefficient K of each error.

    The error is the paper's (Eqs. 37-38): exact value minus restitution model, relative to the
    restitution model, which has the r of a free impact on the contact. The sign in ``signed`` is
    that of this error. Far above the saddle-node its modulus is K/ϖ + O(1/ϖ²). A number that is
    infinite is null.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node of the restitution model.
    """
    # The law does not depend on ϖ; the contact with ϖ = 1 stands for all.
    law = _ball(frequency_ratio=1.0, **contact).impact_law
    signed = _finite(error_laws.coefficients(n, law.damping_ratio, amplitude, law.release))
    allowed = -tolerance, tolerance
    needed = error_laws.law_thresholds(n, Signature(law)(), amplitude, allowed)
    still = error_laws.permanent_contact_ratio(law.damping_ratio, law.release, allowed)
    second = error_laws.permanent_contact_coefficient(law.damping_ratio, law.release)
    return {
        "tolerance": tolerance,
        "frequency_ratio": _finite(needed | {Quantity.PERMANENT_CONTACT: still}),
        "coefficients": {name: k if k is None else abs(k) for name, k in signed.items()},
        "signed": signed,
        "second_order": {"permanent_contact": abs(float(second))},
        **law_values(law),
    }


def _finite(values: error_laws.ByQuantity) -> dict[str, float | None]:
    return {str(name): float(x) if math.isfinite(x) else None for name, x in values.items()}


def _ball(*, release: ReleaseName | None, **contact: Any) -> ContactModel:
    """The ball on the contact that the options of :func:`.add_contact` describe."""
    return spring_damper(release=release or "displacement", **contact)
