"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and is followed until the
motion is known on which it ends (:mod:`bouncing_ball_beyond.motions.destination`). If this motion
repeats in both models, its greatest heights are compared.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.motions.basins import MotionName
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.motions.motions import Kind
from bouncing_ball_beyond.periodic.one_impact import n_t

# Relative change of an orbit's impact velocity for a start beside the orbit.
_BESIDE = 1e-3


@dataclass(frozen=True)
class FinalMotion:
    """The motion on which a ball ends that starts on the orbit of the verdict, or beside it.

    ``kind`` is the kind of this motion in the exact model: "orbit", "subharmonic", "locked",
    "permanent contact", "chaotic" or "undecided". The periods of the table and the impacts after
    which the motion repeats follow; they are 0 if it does not repeat. ``laid`` is the kind for a
    ball laid on the table, None if it is the same. If the orbit is not stable, there are the same
    three values for the restitution model, and if the motions of both models repeat without a rest
    that lasts, the ``greatest`` height in each. ``is_laid`` tells whether the ball was laid on the
    table, because no model has an orbit on which a ball can arrive, and ``is_common`` whether it is
    the motion on which most balls end, because few end on the orbit.
    """

    kind: str
    periods: int
    impacts: int
    laid: str | None = None
    restitution_kind: str | None = None
    restitution_periods: int | None = None
    restitution_impacts: int | None = None
    greatest: dict[str, float] | None = None
    is_laid: bool = False
    is_common: bool = False


class _Impact(NamedTuple):
    """An impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


def of_family(
    case: ResolvedContact, family: ComparedOrbit, start: tuple[float, float] | None = None
) -> FinalMotion:
    """The motion of a ball that starts on the orbit of a family, or beside an unstable orbit; or
    from the phase and velocity of a ``start``, if few balls end on the orbit.
    """
    if family.attracts and start is None:
        return FinalMotion(str(Kind.ORBIT), family.n, 1, laid=_laid(case, family))
    orbit = None if start is not None else _first_orbit(case, family)
    # A ball stays near a neutral orbit without being attracted.
    is_possible = family.exists and family.is_admissible
    if orbit is not None and is_possible and orbit.is_neutral():
        return FinalMotion(str(Kind.UNDECIDED), 0, 0)
    first = None if orbit is None else _beside(case, orbit)
    first = first if start is None else _Impact(*start)
    is_laid = first is None
    # A ball is laid on the table at the phase where the table moves down fastest.
    first = first or _Impact(np.pi, -case.table.amplitude)
    contact = next(iter(case.models))
    ends = {contact: _end_of(case, contact, first)}
    if start is None and family.standing["restitution"].attracts:
        # If the orbit is weakly stable, the mapper may not recognise that the motion repeats.
        orbit = n_t.orbit(case.models["restitution"], family.n, case.table.amplitude)
        impact = _Impact(float(orbit.phase), float(orbit.impact_velocity))
        ends["restitution"] = MotionName(Kind.ORBIT, family.n, 1), impact
    else:
        ends["restitution"] = _end_of(case, "restitution", first)
    exact, simple = (motion for motion, _ in ends.values())
    rests = Kind.PERMANENT_CONTACT in (exact.kind, simple.kind)
    repeat = exact.periods > 0 and simple.periods > 0
    greatest = None
    if repeat and not rests:
        greatest = {name: _greatest(case, name, *end) for name, end in ends.items()}
    return FinalMotion(
        kind=str(exact.kind),
        periods=exact.periods,
        impacts=exact.impacts,
        restitution_kind=str(simple.kind),
        restitution_periods=simple.periods,
        restitution_impacts=simple.impacts,
        greatest=greatest,
        is_laid=is_laid,
        is_common=start is not None,
    )


def _end_of(case: ResolvedContact, name: str, first: _Impact) -> tuple[MotionName, _Impact]:
    """The motion on which a ball of a model ends, and one of its impacts."""
    lam = case.table.amplitude
    found = final_motions(case.models[name], lam, *first, impacts=case.effort.impacts)
    motion = MotionName(Kind(str(found.kind)), int(found.periods), int(found.impacts))
    return motion, _Impact(float(found.end_phase), float(found.end_velocity))


def _first_orbit(case: ResolvedContact, family: ComparedOrbit) -> Any | None:
    """The n-T orbit of the first model that has one: exact, restitution or corrected."""
    for name, model in case.models.items():
        if family.standing[name].exists:
            return n_t.orbit(model, family.n, case.table.amplitude)
    return None


def _beside(case: ResolvedContact, orbit: Any) -> _Impact | None:
    """An impact beside the orbit; None if no ball arrives with it, because it would rise from
    below the table, as on some inadmissible orbits of compliant contacts.
    """
    phase = float(orbit.phase)
    velocity = float(orbit.impact_velocity) * (1 + _BESIDE)
    if velocity > case.table.amplitude * math.cos(phase):
        return None
    return _Impact(phase, velocity)


def _laid(case: ResolvedContact, family: ComparedOrbit) -> str | None:
    """Kind of the motion of a ball that is laid on the table; None if it ends on the orbit."""
    lam = case.table.amplitude
    if lam <= case.permanent_contact:
        return str(Kind.PERMANENT_CONTACT)
    exact, *_ = case.models.values()
    found = final_motions(exact, lam, 0.0, lam, impacts=case.effort.impacts)
    same = found.kind == Kind.ORBIT and (int(found.periods), int(found.impacts)) == (family.n, 1)
    return None if same else str(found.kind)


def _greatest(case: ResolvedContact, name: str, motion: MotionName, impact: _Impact) -> float:
    """Greatest height of a motion that repeats, in m."""
    found = case.models[name].simulate(case.table.amplitude, *impact, 2 * motion.impacts + 1)
    rise = np.maximum(found.bounce_velocity, 0.0)
    lift = found.amplitude * np.sin(found.release_phase)
    tops = found.release_displacement + lift + rise * rise / 2
    return float(np.nanmax(tops[-1 - motion.impacts :])) * case.table.length
