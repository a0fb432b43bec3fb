"""The calls that most people need: a model, an orbit, its limits, a simulation.

Each takes the parameters of a model: r alone is the restitution model, r and ϖ
are a spring-damper contact with the damping of r by Eq. 16, a law is a contact of that law.
The command line has the same calls, with the options from their signatures.
"""

import inspect
import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

from bouncing_ball.contacts.batch import Single, plain
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.law_choice import law_named, law_of_impact
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import NoOrbitError, ParameterError
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.law_model import LawModel, law_at_orbit
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side
from bouncing_ball.signatures import Range, check, takes

# Of frequency ratio and amplitude: beyond, their squares leave no digits.
FrequencyRatio = Annotated[Any, Range(1e-8, 1e8, "[]")]
Amplitude = Annotated[Any, Range(0, 1e8, "(]")]
AnyAmplitude = Annotated[Any, Range(0, 1e8, "[]")]
Restitution = Annotated[Any, Range(0, 1, "(]")]
DampingRatio = Annotated[Any, Range(0, 1, "[)")]
Positive = Annotated[Any, Range(0)]
Finite = Annotated[Any, Range()]
Index = Annotated[int, Range(1, 1000, "[]")]
# One impact takes a third of a millisecond of a processor: half a minute.
Impacts = Annotated[int, Range(1, 100_000, "[]")]
Rule = Literal["displacement", "force"]

LOSS = ("restitution", "damping_ratio", "measured_restitution")
"""The parameters that say how much an impact loses; one of them is needed."""

LawAt = Callable[[type[ContactLaw], float, float], ContactLaw]
"""The law of a kind whose free impact has r and D at the speed that a call is about."""


class Limits(NamedTuple):
    """The orbits between which a family is stable; NaN where there is none."""

    saddle_node: Orbit
    period_doubling: Orbit

    def __repr__(self) -> str:
        return f"saddle-node: {self.saddle_node!r}\nperiod doubling: {self.period_doubling!r}"


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
        Restitution coefficient r in (0, 1]; a contact has then the damping ratio ζ with
        r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper.
    frequency_ratio : array_like, optional
        Frequency ratio ϖ of a spring-damper contact; without it an impact is an instant.
    release : str, optional
        What ends a contact: "displacement", as in the paper and by default, or "force".
    damping_ratio : array_like, optional
        Damping ratio ζ in [0, 1) of the contact, in place of the restitution.
    measured_restitution : array_like, optional
        Restitution coefficient that a free impact really has, in place of the restitution,
        which is that of the displacement release: the force release has a higher one.
    model : str, optional
        "restitution", "spring-damper" or "corrected"; by default a spring-damper if ϖ is
        given, and else a restitution coefficient.
    law : str, optional
        Name of a contact law, in place of the spring-damper.
    parameters : mapping, optional
        The law's parameters by name, such as stiffness=1000.
    duration : float, optional
        In place of the law's parameters, with the restitution: duration D of a free impact.
    speed : float, optional
        Impact speed of that free impact. By default it is that of the orbit; for limits that
        of the restitution model, 2πn/(1 + r); for a simulation that of the first impact.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> model(0.85)
    RestitutionModel(restitution=0.85)
    """
    return _model(locals(), None)


def _refuse(given: Mapping[str, Any], names: tuple[str, ...], why: str) -> None:
    """Raise :class:`ParameterError` with the first of these parameters that is given."""
    for name in names:
        if name in given:
            raise ParameterError(f"{{{name}}} {why}")


def _demand(fulfilled: bool, text: str) -> None:
    if not fulfilled:
        raise ParameterError(text)


def _model(given: Mapping[str, Any], law_at: LawAt | None) -> ImpactModel:
    """The model of the parameters that are not None."""
    given = {name: value for name, value in given.items() if value is not None}
    known = inspect.signature(model).parameters
    for name in given:
        _demand(name in known, f"unknown parameter {name!r}: a model has {', '.join(known)}")
    check(model, given)
    losses = [name for name in LOSS if name in given]
    for other in losses[1:]:
        raise ParameterError(f"argument {{{other}}}: not allowed with argument {{{losses[0]}}}")
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
    return CorrectedModel.of_contact(contact) if kind == "corrected" else SpringDamperModel(contact)


def _law(given: Mapping[str, Any], law_at: LawAt | None) -> ContactLaw:
    """The contact law, by its parameters or by its free impact."""
    name, r, duration = given["law"], given.get("restitution"), given.get("duration")
    if given.get("model") in ("restitution", "spring-damper"):
        why = f"{given['model']} has no {{law}}: corrected, or none, for the law itself"
        _refuse(given, ("model",), why)
    instead = "{parameters}, or {restitution} and {duration}"
    linear = ("frequency_ratio", "damping_ratio", "measured_restitution")
    _refuse(given, linear, f"does not go with {{law}} {name}: {instead}")
    kind = law_named(name)
    known = (x.replace("_", "-") for x in kind.parameter_names())
    needs = ", ".join(f"{{parameters}} {x}=NUMBER" for x in known)
    if "parameters" in given:
        why = f"does not go with {{parameters}}: {needs} are all of {name}"
        _refuse(given, ("restitution", "duration", "speed"), why)
        return _law_of_parameters(kind, given)
    if r is None or duration is None:
        raise ParameterError(f"{{law}} {name} needs {needs}, or {{restitution}} and {{duration}}")
    _refuse(given, ("release",), "goes with {law} linear and {parameters} only")
    if np.ndim(r):
        raise ParameterError(
            f"{{restitution}} of {{law}} {name} is one number: its law is found for it"
        )
    if "speed" in given:
        return law_of_impact(kind, r, duration, given["speed"])
    if law_at is None:
        raise ParameterError("{duration} needs {speed}")
    return law_at(kind, r, duration)


def _law_of_parameters(kind: type[ContactLaw], given: Mapping[str, Any]) -> ContactLaw:
    named = {name.replace("-", "_"): value for name, value in dict(given["parameters"]).items()}
    known = kind.parameter_names()
    for name in named:
        all_of = f"its parameters are {', '.join(known)}"
        _demand(name in known, f"unknown parameter {name!r} of {kind.name}: {all_of}")
    for name in known:
        _demand(name in named, f"{kind.name} needs {{parameters}} {name}=NUMBER as well")
    if "release" in given:
        why = f"the release is part of {kind.name}: {{release}} is for the linear law"
        _demand("release" in kind.__dataclass_fields__, why)
        named["release"] = Release.of(given["release"])
    return kind(**named)


@takes(model)
def orbit(
    n: Index,
    amplitude: Amplitude,
    *,
    side: Literal["stable", "unstable", "all"] = "stable",
    index: Index | None = None,
    **impact: Any,
) -> Any:
    """The n-T orbit at the excitation amplitude Λ.

    Parameters
    ----------
    n : int or array_like of int
        Index n of the family.
    amplitude : array_like
        Excitation amplitude Λ > 0.
    side : str
        Side of the saddle-node: "stable", the one that is stable next to it, or "unstable".
        "all" is every orbit at this amplitude, in order of contact duration.
    index : int, optional
        The number of one of all orbits, from 1.
    impact
        The parameters of :func:`model`.

    Returns
    -------
    Orbit or Labelled
        One orbit, whose numbers are Python's floats. If a parameter is an array, a dataset of
        the orbits' observables with an axis named after each array; NaN where there is no orbit.

    Raises
    ------
    NoOrbitError
        If there is none, with the reason.
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> orbit(1, 1.0, restitution=0.85, frequency_ratio=10.0)  # doctest: +ELLIPSIS
    SpringDamperOrbit
      n                     1
      law                   SpringDamper(frequency_ratio=10, damping_ratio=0.0516623, ...)
      amplitude             1
      phase                 1.16848
      contact_duration      0.314782
      impact_velocity       -2.99694
      bounce_velocity       2.97147
      apparent_restitution  0.851132
      max_height            5.41098
    """
    check(orbit, locals())
    if _arrays(impact, n, amplitude):
        if side == "all" or index is not None:
            of_one = "{side} all" if side == "all" else "{index}"
            raise ParameterError(f"{of_one} is for one orbit, and not for arrays of parameters")
        return _on_grid("orbits", _model_of_orbit, side, n=n, amplitude=amplitude, **impact)
    branch = Side.STABLE if side == "all" else Side(side)
    of = _model_of_orbit(n, amplitude, branch, **impact)
    if side != "all" and index is None:
        return plain(of.require_orbit(n, amplitude, branch))
    if side != "stable" and index is not None:
        raise ParameterError("argument {index}: not allowed with argument {side}")
    found = of.orbits(n, amplitude)
    if not found.size:
        raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {of.label}")
    if index is not None and index > found.size:
        raise NoOrbitError(
            f"no orbit {index}: {of.label} has {found.size} {n}-T orbits at Λ = {amplitude:g}"
        )
    return found if index is None else plain(found[index - 1])


def _model_of_orbit(n: int, amplitude: float, side: Side, **impact: Any) -> ImpactModel:
    """The model; a law given by r and D has them at the impact speed of this orbit."""
    return _model(impact, lambda kind, r, d: law_at_orbit(kind, r, d, n, amplitude, side))


def _arrays(impact: Mapping[str, Any], *given: Any) -> bool:
    """Whether any of the arguments is an array, except the parameters of a law, which are a
    mapping.
    """
    numbers = (value for name, value in impact.items() if name != "parameters")
    return any(np.ndim(x) > 0 for x in (*given, *numbers))


def _on_grid(result: str, *more: Any, **arguments: Any) -> Any:
    """A labelled result for arguments of which some are arrays."""
    # Imported here: a single orbit needs no labels, and xarray takes longer than the orbit.
    from bouncing_ball.datasets.labelled import Grid
    from bouncing_ball.orbits import labelled

    return getattr(labelled, result)(Grid(**arguments), *more)


def model_of_limits(n: int, **impact: Any) -> ImpactModel:
    """The model; a law given by r and D has them at the impact speed of the restitution model's
    orbits.

    Examples
    --------
    >>> model_of_limits(1, restitution=0.85)
    RestitutionModel(restitution=0.85)
    """
    return _model(impact, lambda kind, r, d: law_of_impact(kind, r, d, rigid_speed(n, r)))


@takes(model)
def limits(n: Index, **impact: Any) -> Any:
    """Saddle-node and period doubling of the n-T orbits; NaN where there is none.

    Parameters
    ----------
    n : int or array_like of int
        Index n of the family.
    impact
        The parameters of :func:`model`.

    Returns
    -------
    Limits or Labelled
        Two orbits. If a parameter is an array, a dataset of both amplitudes and phases with an
        axis named after each array.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = limits(1, restitution=0.85)
    >>> found.saddle_node.amplitude < found.period_doubling.amplitude
    True
    >>> str(found).splitlines()[0]
    'saddle-node: RestitutionOrbit'
    """
    check(limits, locals())
    if _arrays(impact, n):
        return _on_grid("limits", model_of_limits, n=n, **impact)
    of = model_of_limits(n, **impact)
    return Limits(plain(of.saddle_node(n)), plain(of.period_doubling(n)))


def model_of_impact(amplitude: Any, phase: Any, velocity: Any, **impact: Any) -> ImpactModel:
    """The model; a law given by r and D has them at the speed of this impact."""
    speed = np.asarray(amplitude) * np.cos(phase) - velocity
    return _model(impact, lambda kind, r, d: law_of_impact(kind, r, d, speed))


@takes(model)
def simulate(
    amplitude: AnyAmplitude,
    *,
    phase: Finite = 0.0,
    velocity: Finite = -math.pi,
    impacts: Impacts = 100,
    **impact: Any,
) -> Any:
    """Impacts in order, from a first one at a phase of the table.

    Parameters
    ----------
    amplitude : array_like
        Excitation amplitude Λ; arrays follow many balls at once.
    phase : array_like
        Phase of the table at the first impact.
    velocity : array_like
        Absolute velocity of the ball before the first impact.
    impacts : int
        Number of impacts.
    impact
        The parameters of :func:`model`.

    Returns
    -------
    ImpactSequence
        Arrays with one entry for each impact; of several balls shape (impact, ...).

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> simulate(0.0, restitution=0.5, velocity=-4.0, impacts=3).time.tolist()
    [0.0, 4.0, 6.0]
    """
    check(simulate, locals())
    of = model_of_impact(amplitude, phase, velocity, **impact)
    found = of.simulate(amplitude, phase, velocity, impacts)
    return found if found.status.shape else Single(found)
