"""What each subcommand answers, as plain dictionaries."""

import argparse
import math
from typing import Any

import numpy as np

from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.permanent_contact import (
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.impacts.spring_damper import Contact, Release
from bouncing_ball.motion.sequence import Status
from bouncing_ball.orbits import limits as contact_limits
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.admissibility import is_admissible, restitution_is_admissible
from bouncing_ball.orbits.closed_form import branch_point
from bouncing_ball.orbits.contact_system import OrbitSystem, Parameter
from bouncing_ball.orbits.monodromy import trace_and_contraction
from bouncing_ball.orbits.stability import is_stable, multipliers

Answer = dict[str, Any]


def _contact(args: argparse.Namespace) -> Contact:
    zeta = args.damping_ratio
    if zeta is None:
        zeta = float(damping_ratio(args.restitution))
    return Contact(args.frequency_ratio, zeta, Release(args.release))


def _pairs(trace: float, determinant: float) -> list[list[float]]:
    return [[value.real, value.imag] for value in multipliers(trace, determinant).tolist()]


def _restitution_orbit(args: argparse.Namespace) -> Answer:
    n, r, lam = args.n, args.restitution, args.amplitude
    phase = float(restitution_orbits.phase(n, r, lam, args.side == "stable"))
    velocity = n * math.pi
    trace, det = (float(x) for x in restitution_orbits.trace_and_determinant(r, lam, phase))
    defect = -r * velocity + velocity - (1 + r) * lam * math.cos(phase)
    return {
        "phase": phase,
        "contact_duration": 0.0,
        "impact_velocity": -velocity,
        "bounce_velocity": velocity,
        "apparent_restitution": r,
        "max_height": float(restitution_orbits.max_height(n, lam, phase)),
        "multipliers": _pairs(trace, det),
        "is_stable": bool(is_stable(trace, det)),
        "is_admissible": bool(restitution_is_admissible(n, lam, phase)),
        "residual": abs(defect),
    }


def _contact_orbit(args: argparse.Namespace) -> Answer:
    contact = _contact(args)
    side = contact_limits.Side(args.side)
    orbit = contact_limits.require_orbit(contact, args.n, args.amplitude, side)
    trace, det = (float(x) for x in trace_and_contraction(orbit))
    system = OrbitSystem(
        args.n, contact.damping_ratio, Parameter.AMPLITUDE, args.frequency_ratio, contact.release
    )
    angle = orbit.contact_duration * args.frequency_ratio
    y = np.array([orbit.phase, orbit.impact_velocity, angle, orbit.amplitude])
    return {
        "phase": float(orbit.phase),
        "contact_duration": float(orbit.contact_duration),
        "impact_velocity": float(orbit.impact_velocity),
        "bounce_velocity": float(orbit.bounce_velocity),
        "apparent_restitution": float(orbit.apparent_restitution),
        "max_height": float(orbit.max_height),
        "multipliers": _pairs(trace, det),
        "is_stable": bool(is_stable(trace, det)),
        "is_admissible": bool(is_admissible(orbit)),
        "residual": float(np.max(np.abs(system.residual(y)))),
    }


def orbit(args: argparse.Namespace) -> Answer:
    """The n-T orbit at Λ.

    Raises
    ------
    NoOrbitError
        With the reason, if there is none.
    """
    return _restitution_orbit(args) if args.model == "restitution" else _contact_orbit(args)


def limits(args: argparse.Namespace) -> Answer:
    """Saddle-node and period doubling, the latter of the exact map.

    Raises
    ------
    NoOrbitError
        If the branch has not both.
    """
    if args.model == "restitution":
        n, r = args.n, args.restitution
        node = float(restitution_orbits.saddle_node(n, r))
        doubling = float(restitution_orbits.period_doubling(n, r))
        phase = float(restitution_orbits.phase(n, r, doubling))
        return {
            "saddle_node": {"amplitude": node, "phase": 0.0, "contact_duration": 0.0},
            "period_doubling": {"amplitude": doubling, "phase": phase, "contact_duration": 0.0},
        }
    contact = _contact(args)
    found = {}
    for name, find in (
        ("saddle_node", contact_limits.saddle_node),
        ("period_doubling", contact_limits.period_doubling),
    ):
        point = branch_point(find(contact, args.n), contact, args.n)
        if np.isnan(point.contact_duration):
            raise NoOrbitError(
                f"the branch of {args.n}-T orbits for ϖ = {args.frequency_ratio:g}, "
                f"ζ = {contact.damping_ratio:.4g} has no {name.replace('_', ' ')}"
            )
        found[name] = {
            "amplitude": float(point.amplitude),
            "phase": float(point.phase),
            "contact_duration": float(point.contact_duration),
        }
    return found


def permanent_contact(args: argparse.Namespace) -> Answer:
    """Threshold at ϖ, and its minimum over ϖ.

    The minimum is null where there is none (ζ ≥ 1/√2, displacement release).
    """
    contact = _contact(args)
    zeta, release = contact.damping_ratio, contact.release
    answer = {
        "threshold": float(permanent_contact_threshold(args.frequency_ratio, zeta, release)),
        "minimum": None,
        "at_frequency_ratio": None,
    }
    if release is Release.FORCE or 2 * zeta * zeta < 1:
        lowest = permanent_contact_minimum(zeta, release)
        answer["minimum"] = float(lowest.threshold)
        answer["at_frequency_ratio"] = float(lowest.frequency_ratio)
    return answer


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
    if args.model == "restitution":
        from bouncing_ball.motion.instants import simulate as of_instants

        r, table = args.restitution, args.amplitude * math.cos(args.phase)
        if velocity > table:
            raise ModelError("a ball that rises from the table has no impact: z′ > w′")
        after = -r * velocity + (1 + r) * table
        sequence = of_instants(r, args.amplitude, args.phase, after, args.impacts)
    else:
        from bouncing_ball.motion.contacts import simulate as of_contacts

        sequence = of_contacts(_contact(args), args.amplitude, args.phase, velocity, args.impacts)
    status = Status(int(sequence.status)).name.lower().replace("_", " ")
    return {"status": status, "sequence": _columns(sequence)}
