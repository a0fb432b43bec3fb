"""The model of the impact that the parameters of a call describe."""

import inspect
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from bouncing_ball.beyond.calculator.units import Rule
from bouncing_ball.beyond.corrected.orbits import CorrectedModel
from bouncing_ball.beyond.corrected.signature import Signature
from bouncing_ball.beyond.laws.contact_law import ContactLaw
from bouncing_ball.beyond.laws.law_of_impact import law_of_impact
from bouncing_ball.beyond.laws.orbits import LawModel
from bouncing_ball.beyond.laws.registry import law_named
from bouncing_ball.calls.signatures import check
from bouncing_ball.errors import ParameterError, Range
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits.model import ImpactModel
from bouncing_ball.paper.orbits.restitution_branch import rigid_speed
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel

# Range of the frequency ratio and of the amplitude, beyond which their squares leave no digits.
FrequencyRatio = Annotated[Any, Range(1e-8, 1e8, "[]")]
AnyAmplitude = Annotated[Any, Range(0, 1e8, "[]")]
Restitution = Annotated[Any, Range(0, 1, "(]")]
DampingRatio = Annotated[Any, Range(0, 1, "[)")]
Positive = Annotated[Any, Range(0)]
LOSS = ("restitution", "damping_ratio", "measured_restitution")
"""The parameters that determine the loss of an impact; exactly one of them is needed."""

LawAt = Callable[[type[ContactLaw], float, float], ContactLaw]
"""A function that returns the contact law of a type whose free impact has the given r and D at the
impact speed of the call."""


def model(
    restitution: Restitution | None = None,
    frequency_ratio: FrequencyRatio | None = None,
    release: Rule | None = None,
    *,
    damping_ratio: DampingRatio | None = None,
    measured_restitution: Restitution | None = None,
    model: Literal["restitution", "spring-damper", "corrected"] | None = None,
    law: str | None = None,
    parameters: Mapping[str, float] | None = None,
    duration: Positive | None = None,
    speed: Positive | None = None,
) -> ImpactModel:
    """The model with these parameters.

    Parameters
    ----------
    restitution : array_like, optional
        Restitution coefficient r in (0, 1]. A spring-damper contact then has the damping ratio
        ζ with r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper.
    frequency_ratio : array_like, optional
        Frequency ratio ϖ of a spring-damper contact; the restitution model has none.
    release : str, optional
        Where a contact ends: "displacement" at the table's level, as in the paper (default), or
        "force" where the contact force vanishes.
    damping_ratio : array_like, optional
        Damping ratio ζ in [0, 1) of the contact, in place of the restitution coefficient.
    measured_restitution : array_like, optional
        Restitution coefficient of a free impact under the given release, in place of the
        parameter restitution, which always refers to the displacement release.
    model : str, optional
        "restitution", "spring-damper" or "corrected". By default "spring-damper" if ϖ is
        given, and otherwise "restitution".
    law : str, optional
        Name of a contact law, in place of the linear spring and damper.
    parameters : mapping, optional
        Parameters of the contact law by name, such as stiffness=1000.
    duration : float, optional
        Duration D of a free impact. With the restitution coefficient it replaces the
        parameters of the contact law.
    speed : float, optional
        Speed of this free impact. The default is the impact speed of the orbit; for limits, the
        impact speed of the restitution model, 2πn/(1 + r); for a simulation, the first one.

    Returns
    -------
    ImpactModel
        Has the shape to which the arrays broadcast.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> model(0.85)
    RestitutionModel(restitution=0.85)
    """
    return impact_model(locals(), None)


def model_of_limits(n: int, **impact: Any) -> ImpactModel:
    """The model for a call about limits.

    A contact law that is given by r and D has these values at the impact speed of the restitution
    model's orbits.

    Examples
    --------
    >>> model_of_limits(1, restitution=0.85)
    RestitutionModel(restitution=0.85)
    """
    return impact_model(impact, lambda kind, r, d: law_of_impact(kind, r, d, rigid_speed(n, r)))


def model_of_impact(amplitude: Any, phase: Any, velocity: Any, **impact: Any) -> ImpactModel:
    """The model for a call that starts with an impact.

    A contact law that is given by r and D has these values at the speed of this impact.
    """
    speed = np.asarray(amplitude) * np.cos(phase) - velocity
    return impact_model(impact, lambda kind, r, d: law_of_impact(kind, r, d, speed))


def impact_model(given: Mapping[str, Any], law_at: LawAt | None) -> ImpactModel:
    """The model from those parameters that are not None."""
    given = {name: value for name, value in given.items() if value is not None}
    if isinstance(of := given.pop("model", None), ImpactModel):
        _refuse(given, tuple(given), "is not allowed with {model}, which has its parameters")
        return of
    given |= {} if of is None else {"model": of}
    known = inspect.signature(model).parameters
    for name in given:
        _demand(name in known, f"unknown parameter {{}}: choose from {', '.join(known)}", name)
    check(model, given)
    losses = [name for name in LOSS if name in given]
    if len(losses) > 1:
        raise ParameterError(f"argument {{{losses[1]}}}: not allowed with argument {{{losses[0]}}}")
    kind = given.get("model") or ("spring-damper" if "frequency_ratio" in given else "restitution")
    if "law" in given:
        law = _law(given, law_at)
        return CorrectedModel(Signature(law)) if kind == "corrected" else LawModel(law)
    _refuse(given, ("parameters", "duration", "speed"), "needs {law}")
    names = " ".join(f"{{{name}}}" for name in LOSS)
    _demand(bool(losses), f"one of the arguments {names} is required")
    if kind == "restitution":
        instead = "needs {frequency_ratio}; {model} restitution takes {restitution}"
        _refuse(given, ("damping_ratio",), instead)
        meaning = "has no meaning for {model} restitution, which has no contact"
        _refuse(given, ("frequency_ratio", "release"), meaning)
        return RestitutionModel(given[losses[0]])
    _demand("frequency_ratio" in given, f"{{model}} {kind} needs {{frequency_ratio}}")
    ratio, rule = given["frequency_ratio"], Release.of(given.get("release", Release.DISPLACEMENT))
    if "damping_ratio" in given:
        contact = SpringDamper(ratio, given["damping_ratio"], rule)
    else:
        measured = "measured_restitution" in given
        contact = SpringDamper.from_restitution(given[losses[0]], ratio, rule, measured=measured)
    if kind == "corrected":
        return CorrectedModel.of_contact(contact)
    # Imported here, because its limits need scipy.optimize, which the other models do not need.
    from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel

    return SpringDamperModel(contact)


def _law(given: Mapping[str, Any], law_at: LawAt | None) -> ContactLaw:
    """The contact law, from its parameters or from the r and D of a free impact."""
    kind, r, duration = law_named(given["law"]), given.get("restitution"), given.get("duration")
    if given.get("model") in ("restitution", "spring-damper"):
        why = f"{given['model']} has no {{law}}: give corrected, or no {{model}} for the law itself"
        _refuse(given, ("model",), why)
    instead = "{parameters}, or {restitution} and {duration}"
    linear = ("frequency_ratio", "damping_ratio", "measured_restitution")
    _refuse(given, linear, f"is not allowed with {{law}} {kind.name}: give {instead}")
    needs = ", ".join(
        f"{{parameters}} {name.replace('_', '-')}=NUMBER" for name in kind.parameter_names()
    )
    if "parameters" in given:
        why = f"is not allowed with {{parameters}}: {needs} determine {kind.name}"
        _refuse(given, ("restitution", "duration", "speed"), why)
        return _law_of_parameters(kind, given)
    if r is None or duration is None:
        raise ParameterError(
            f"{{law}} {kind.name} needs {needs}, or {{restitution}} and {{duration}}"
        )
    _refuse(given, ("release",), "is allowed with {parameters} of {law} linear only")
    several = f"{{restitution}} must be a single number with {{law}} {kind.name}"
    _demand(not np.ndim(r), several)
    if "speed" in given:
        return law_of_impact(kind, r, duration, given["speed"])
    if law_at is None:
        raise ParameterError("{duration} needs {speed}")
    return law_at(kind, r, duration)


def _law_of_parameters(kind: type[ContactLaw], given: Mapping[str, Any]) -> ContactLaw:
    named = {name.replace("-", "_"): value for name, value in given["parameters"].items()}
    known = kind.parameter_names()
    for name in named:
        all_of = f"its parameters are {', '.join(known)}"
        _demand(name in known, f"unknown parameter {{}} of {kind.name}: {all_of}", name)
    for name in known:
        _demand(name in named, f"{kind.name} also needs {{parameters}} {name}=NUMBER")
    if "release" in given:
        why = f"{{release}} is not allowed: {kind.name} determines where a contact ends"
        _demand("release" in kind.__dataclass_fields__, why)
        named["release"] = Release.of(given["release"])
    return kind(**named)


def _refuse(given: Mapping[str, Any], names: tuple[str, ...], why: str) -> None:
    """Raise :class:`ParameterError` for the first of these parameters that is given."""
    for name in names:
        _demand(name not in given, f"{{{name}}} {why}")


def _demand(fulfilled: bool, text: str, *names: str) -> None:
    if not fulfilled:
        raise ParameterError(text, *map(repr, names))
