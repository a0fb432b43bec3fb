"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and the mapper computes
the motion on which it ends (:mod:`bouncing_ball.long_run.destination`). Motions that repeat
in the same way in both models are compared by their greatest height. Other motions are compared by
means over time of the height, and of the power that the table transfers to the ball
(:mod:`bouncing_ball.contacts.means`).
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball.contacts.ends import Ending, FirstImpact, end_of, on_orbit
from bouncing_ball.contacts.families import ComparedOrbit
from bouncing_ball.contacts.means import BESIDE, Mean, compared_means
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.sequence import ImpactSequence
from bouncing_ball.periodic.one_impact import n_t


@dataclass(frozen=True)
class FinalMotion:
    """The motion on which a ball ends that starts on the orbit of the verdict, or beside it.

    ``kind`` is the kind of this motion in the exact model: "orbit", "subharmonic", "locked",
    "permanent contact", "chaotic" or "undecided". The periods of the table and the impacts after
    which the motion repeats follow; they are 0 if it does not repeat. ``laid`` is the kind for a
    ball laid on the table, None if it is the same. If the orbit is not stable, there are the same
    three values for the restitution model. For motions that repeat in the same way in both models
    there is then the ``greatest`` height in each model; for other motions there are means over
    time of the height and of the power that the table transfers, over a number of ``balls``, with
    the signed deviations of the restitution model from the contact, relative to the value on the
    contact (:func:`~bouncing_ball.accuracy.errors.deviation`). ``is_laid`` tells whether the ball
    was laid on the table, because no model has an orbit on which a ball can arrive, and
    ``is_common`` whether it is the motion on which most balls end, because few end on the orbit.
    ``changes`` has these deviations of the means if r, k or g change by a thousandth; "r -0.1 %"
    and the like are the names of these changes. The r of a contact law is changed at the mean speed
    of the impacts of this motion. For a law that no impact determines, such as an impedance, they
    are those of the linear contact with its r and duration, also without a change; they are None if
    that contact has another kind of motion.

    The mean height is the mean over time of the height of the ball above the middle of the table,
    and the mean power that of the contact force times the velocity of the table.
    """

    kind: str
    periods: int
    impacts: int
    laid: str | None = None
    restitution_kind: str | None = None
    restitution_periods: int | None = None
    restitution_impacts: int | None = None
    greatest: dict[str, float] | None = None
    mean_height: dict[str, Mean | None] | None = None
    mean_power: dict[str, Mean | None] | None = None
    mean_error: dict[str, Mean] | None = None
    balls: int | None = None
    is_laid: bool = False
    is_common: bool = False
    changes: dict[str, dict[str, Mean]] | None = None


def of_family(
    case: ResolvedContact,
    family: ComparedOrbit,
    tolerance: float,
    balls: int | None = None,
    start: tuple[float, float] | None = None,
) -> FinalMotion:
    """The motion of a ball that starts on the orbit of a family, or beside an unstable orbit; or
    from the phase and velocity of a ``start``, if few balls end on the orbit.

    The sample for means over time grows until these decide about the tolerance, up to ``balls``,
    rounded up to multiples of 256, or of 128 for a contact law.
    """
    if family.attracts and start is None:
        return FinalMotion(str(Kind.ORBIT), family.n, 1, laid=_laid(case, family))
    orbit = None if start is not None else _first_orbit(case, family)
    # A ball stays near a neutral orbit without being attracted.
    is_possible = family.exists and family.is_admissible
    if orbit is not None and is_possible and orbit.is_neutral():
        return FinalMotion(str(Kind.UNDECIDED), 0, 0)
    first = None if orbit is None else _beside(case, orbit)
    first = first if start is None else FirstImpact(*start)
    is_laid = first is None
    first = first or _laid_down(case)
    # The exact model and the restitution model.
    ends = {name: end_of(case, name, first) for name in list(case.models)[:2]}
    ideal = family.standing["restitution"]
    if start is None and ideal.attracts:
        # If the orbit is weakly stable, the mapper may not recognise that the motion repeats.
        ends["restitution"] = on_orbit(case, family.n)
    exact, simple = (end.motion for end in ends.values())
    values: dict[str, Any] = {}
    rests = Kind.PERMANENT_CONTACT in (exact.kind, simple.kind)
    if exact == simple and exact.periods > 0 and not rests:
        values["greatest"] = {name: _greatest(case, name, end) for name, end in ends.items()}
    elif not rests:
        values = compared_means(case, ends, tolerance, balls, first)
    return FinalMotion(
        kind=str(exact.kind),
        periods=exact.periods,
        impacts=exact.impacts,
        restitution_kind=str(simple.kind),
        restitution_periods=simple.periods,
        restitution_impacts=simple.impacts,
        is_laid=is_laid,
        is_common=start is not None,
        **values,
    )


def _first_orbit(case: ResolvedContact, family: ComparedOrbit) -> Any | None:
    """The n-T orbit of the first model that has one: exact, restitution or corrected."""
    for name, model in case.models.items():
        if family.standing[name].exists:
            return n_t.orbit(model, family.n, case.table.amplitude)
    return None


def _beside(case: ResolvedContact, orbit: Any) -> FirstImpact | None:
    """An impact beside the orbit; None if no ball arrives with it, because it would rise from
    below the table, as on some inadmissible orbits of compliant contacts.
    """
    phase = float(orbit.phase)
    velocity = float(orbit.impact_velocity) * (1 + BESIDE)
    if velocity > case.table.amplitude * math.cos(phase):
        return None
    return FirstImpact(phase, velocity)


def _laid_down(case: ResolvedContact) -> FirstImpact:
    """A ball that is laid on the table at the phase where the table moves down fastest."""
    return FirstImpact(np.pi, -case.table.amplitude)


def _laid(case: ResolvedContact, family: ComparedOrbit) -> str | None:
    """Kind of the motion of a ball that is laid on the table; None if it ends on the orbit."""
    lam = case.table.amplitude
    if lam <= case.permanent_contact:
        return str(Kind.PERMANENT_CONTACT)
    exact, *_ = case.models.values()
    found = final_motions(exact, lam, 0.0, lam, impacts=case.effort.impacts)
    same = found.kind == Kind.ORBIT and (int(found.periods), int(found.impacts)) == (family.n, 1)
    return None if same else str(found.kind)


def _tops(sequence: ImpactSequence) -> np.ndarray:
    """Greatest height of the flight after each impact, dimensionless."""
    rise = np.maximum(sequence.bounce_velocity, 0.0)
    lift = sequence.amplitude * np.sin(sequence.release_phase)
    return sequence.release_displacement + lift + rise * rise / 2


def _greatest(case: ResolvedContact, name: str, end: Ending) -> float:
    """Greatest height of a motion that repeats, in m."""
    once = end.impacts.last()
    found = case.models[name].simulate(
        case.table.amplitude, once.phase[0], once.velocity[0], 2 * end.motion.impacts + 1
    )
    last = _tops(found)[-1 - end.motion.impacts :]
    return float(np.nanmax(last)) * case.table.length
