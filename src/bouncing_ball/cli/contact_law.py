"""A contact law on the command line: which it is, its model, and its description."""

import argparse
import math
from typing import Any

import numpy as np

from bouncing_ball.contacts.law_choice import law_named, law_of_impact
from bouncing_ball.contacts.law_signature import LawSignature, free_impact
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits.calls import law_at_orbit
from bouncing_ball.orbits.continued import restitution_speed
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.law_model import LawModel
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed
from bouncing_ball.orbits.stability import Side


def options(kind: type[ContactLaw]) -> list[str]:
    """The law's parameters as they are typed after ``--set``."""
    return [name.replace("_", "-") for name in kind.parameter_names()]


def law_of(args: argparse.Namespace) -> ContactLaw:
    """The law that was asked for, by its parameters or by its free impact.

    Raises
    ------
    ModelError
        If the law or a parameter is unknown, a parameter is missing or out of its
        range, or options contradict each other.
    NoOrbitError
        If r and D are to be those at an orbit that does not exist.
    """
    kind = law_named(args.law)
    needs = ", ".join(f"--set {name}=NUMBER" for name in options(kind))
    r, duration = args.restitution, args.duration
    if args.set:
        for name in ("restitution", "duration", "speed"):
            if getattr(args, name) is not None:
                raise ModelError(f"--{name} does not go with --set: {needs} are all of {kind.name}")
        return _by_parameters(kind, args)
    if r is None or duration is None:
        raise ModelError(f"--law {kind.name} needs {needs}, or --restitution and --duration")
    if args.release is not None:
        raise ModelError("--release goes with --law linear and --set only")
    if args.speed is not None:
        return law_of_impact(kind, r, duration, args.speed)
    if args.command == "orbit":
        side = Side.UNSTABLE if args.side == "unstable" else Side.STABLE
        return law_at_orbit(kind, r, duration, args.n, args.amplitude, side)
    if args.command == "limits":
        return law_of_impact(kind, r, duration, rigid_speed(args.n, r))
    velocity = -math.pi if args.velocity is None else args.velocity
    return law_of_impact(kind, r, duration, args.amplitude * math.cos(args.phase) - velocity)


def _by_parameters(kind: type[ContactLaw], args: argparse.Namespace) -> ContactLaw:
    named = {name.replace("-", "_"): value for name, value in args.set}
    known = list(kind.parameter_names())
    for name in named:
        if name not in known:
            raise ModelError(
                f"unknown parameter {name!r} of {kind.name}: its parameters are {', '.join(known)}"
            )
    missing = [name for name in known if name not in named]
    if missing:
        raise ModelError(f"{kind.name} needs --set {missing[0]}=NUMBER as well")
    release = {} if args.release is None else {"release": Release.of(args.release)}
    if release and not kind.chooses_release():
        raise ModelError(f"the release is part of {kind.name}: --release is for the linear law")
    return kind(**named, **release)


def model_of(args: argparse.Namespace) -> ImpactModel:
    """The model of the law that was asked for, or its corrected restitution model."""
    law = law_of(args)
    return CorrectedModel(LawSignature(law)) if args.model == "corrected" else LawModel(law)


def _law_behind(model: Any) -> ContactLaw:
    return model.law.law if isinstance(model.law, LawSignature) else model.law


def rigid_speed_of(model: Any, n: int) -> float:
    """2πn/(1 + r(v)) of the model's law: where limits are described."""
    return float(restitution_speed(n, LawModel(_law_behind(model)))[0])


def described(model: Any, speed: float) -> dict[str, Any]:
    """The law, and its free impact at a speed: r, D, and π/D, which stands for ϖ."""
    law = _law_behind(model)
    impact = free_impact(law, np.float64(speed))
    return {
        "law": law.name,
        "parameters": {name: float(x) for name, x in law.parameters().items()},
        "measured_restitution": float(impact.restitution),
        "free_duration": float(impact.duration),
        "frequency_ratio": math.pi / float(impact.duration),
        "at_impact_speed": float(speed),
    }
