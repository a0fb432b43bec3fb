"""What each subcommand answers, as plain dictionaries."""

import argparse
import math
from typing import Any

import numpy as np

from bouncing_ball.cli.contact_law import described, model_of, rigid_speed_of
from bouncing_ball.contacts.permanent_contact import permanent_contact_minimum
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.motion.sequence import Status
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.error_law import coefficients, permanent_contact_coefficient
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import OBSERVABLES, Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side

Answer = dict[str, Any]


def _contact(args: argparse.Namespace) -> SpringDamper:
    release = Release.of(args.release or Release.DISPLACEMENT)
    if args.damping_ratio is not None:
        return SpringDamper(args.frequency_ratio, args.damping_ratio, release)
    measured = args.measured_restitution is not None
    r = args.measured_restitution if measured else args.restitution
    return SpringDamper.from_restitution(r, args.frequency_ratio, release, measured=measured)


def _model(args: argparse.Namespace) -> ImpactModel:
    if args.law is not None:
        return model_of(args)
    if args.model == "restitution":
        r = args.restitution if args.measured_restitution is None else args.measured_restitution
        return RestitutionModel(r)
    contact = _contact(args)
    return (
        SpringDamperModel(contact)
        if args.model == "spring-damper"
        else CorrectedModel.of_contact(contact)
    )


def _measured(args: argparse.Namespace, model: ImpactModel, speed: float) -> Answer:
    """What a free impact on the contact has, whatever was asked for: r and ζ.

    Of a contact law, its parameters, and r and D at an impact speed.
    """
    if args.law is not None:
        return described(model, speed)
    if args.model == "restitution":
        return {}
    return _loss(_contact(args))


def _loss(contact: SpringDamper) -> Answer:
    """What the contact loses: r of a free impact, and ζ."""
    return {
        "measured_restitution": float(contact.restitution),
        "damping_ratio": float(contact.damping_ratio),
    }


def _described(orbit: Orbit) -> Answer:
    """One orbit."""
    return {
        **{name: float(getattr(orbit, name)) for name in OBSERVABLES if name != "amplitude"},
        "multipliers": [[x.real, x.imag] for x in orbit.multipliers().tolist()],
        "is_stable": bool(orbit.is_stable()),
        "is_admissible": bool(orbit.is_admissible()),
        "residual": float(orbit.defect()),
    }


def _all_orbits(model: ImpactModel, n: int, amplitude: float) -> Orbit:
    """Every orbit at Λ, in order of contact duration.

    Raises
    ------
    NoOrbitError
        If there is none.
    """
    found = model.orbits(n, amplitude)
    if not found.size:
        raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {model.label}")
    return found


def orbit(args: argparse.Namespace) -> Answer:
    """The n-T orbit at Λ on a side of the saddle-node, or all of them, or one of all.

    Raises
    ------
    NoOrbitError
        With the reason, if there is none.
    """
    model = _model(args)
    if args.side != "all" and args.index is None:
        orbit = model.require_orbit(args.n, args.amplitude, Side(args.side))
        return _described(orbit) | _measured(args, model, _speed(orbit))
    found = _all_orbits(model, args.n, args.amplitude)
    if args.index is None:
        orbits = [_described(found[k]) for k in range(found.size)]
        return {"orbits": orbits} | _measured(args, model, _speed(found[0]))
    if args.index > found.size:
        raise NoOrbitError(
            f"no orbit {args.index}: {model.label} has {found.size} {args.n}-T orbits "
            f"at Λ = {args.amplitude:g}"
        )
    orbit = found[args.index - 1]
    return _described(orbit) | _measured(args, model, _speed(orbit))


def _speed(orbit: Orbit) -> float:
    """Speed of the impact, against the table."""
    return -float(orbit.relative_impact_velocity)


def limits(args: argparse.Namespace) -> Answer:
    """Saddle-node and period doubling, and whether the orbits there are the ball's.

    Raises
    ------
    NoOrbitError
        If the branch has not both.
    """
    model = _model(args)
    found = {}
    for name in ("saddle_node", "period_doubling"):
        orbit = getattr(model, name)(args.n)
        if not orbit.exists:
            what = name.replace("_", " ")
            branch = f"the branch of {args.n}-T orbits for {model.label}"
            # Without a closed form only what is found is known.
            closed = args.law is None
            raise NoOrbitError(
                f"{branch} has no {what}" if closed else f"no {what} was found on {branch}"
            )
        found[name] = {
            "amplitude": float(orbit.amplitude),
            "phase": float(orbit.phase),
            "contact_duration": float(orbit.contact_duration),
            "is_admissible": bool(orbit.is_admissible()),
        }
    rigid = 0.0 if args.law is None else rigid_speed_of(model, args.n)
    return found | _measured(args, model, rigid)


def error_law(args: argparse.Namespace) -> Answer:
    """K of each quantity: the modulus of its relative error is K/ϖ + O(1/ϖ²).

    The restitution model has the contact's own r. ``signed`` has the sign of the
    exact value minus the restitution model's; what has no first-order law is null.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node of the restitution model.
    """
    contact = _contact(args)
    zeta, release = contact.damping_ratio, contact.release
    law = coefficients(args.n, zeta, args.amplitude, release)._asdict()
    signed = {name: float(k) if math.isfinite(k) else None for name, k in law.items()}
    return {
        "coefficients": {name: k if k is None else abs(k) for name, k in signed.items()},
        "signed": signed,
        "second_order": {
            "permanent_contact": abs(float(permanent_contact_coefficient(zeta, release)))
        },
        **_loss(contact),
    }


def permanent_contact(args: argparse.Namespace) -> Answer:
    """Threshold at ϖ, and its minimum over ϖ.

    The minimum is null where there is none (ζ ≥ 1/√2, displacement release).
    """
    contact = _contact(args)
    zeta, release = contact.damping_ratio, contact.release
    answer = {
        "threshold": float(SpringDamperModel(contact).permanent_contact_threshold()),
        "minimum": None,
        "at_frequency_ratio": None,
    }
    if release is Release.FORCE or 2 * zeta * zeta < 1:
        lowest = permanent_contact_minimum(zeta, release)
        answer["minimum"] = float(lowest.threshold)
        answer["at_frequency_ratio"] = float(lowest.frequency_ratio)
    return answer | _loss(contact)


def _columns(sequence: Any) -> Answer:
    """The recorded impacts of one ball, as lists; null for what does not happen."""
    there = np.isfinite(sequence.time)
    columns = {
        "time": sequence.time,
        "phase": sequence.phase,
        "impact_velocity": sequence.impact_velocity,
        "contact_duration": sequence.contact_duration,
        "bounce_velocity": sequence.release_velocity,
    }
    return {
        name: [value if math.isfinite(value) else None for value in column[there].tolist()]
        for name, column in columns.items()
    }


def simulate(args: argparse.Namespace) -> Answer:
    """The sequence of impacts from an initial impact.

    Raises
    ------
    ModelError
        If the ball does not approach the table at the first impact.
    """
    velocity = -math.pi if args.velocity is None else args.velocity
    model = _model(args)
    sequence = model.simulate(args.amplitude, args.phase, velocity, args.impacts)
    status = Status(int(sequence.status)).name.lower().replace("_", " ")
    speed = -float(sequence.relative_velocity[0])
    return {"status": status} | _measured(args, model, speed) | {"sequence": _columns(sequence)}
