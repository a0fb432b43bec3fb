r"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and the mapper computes
the motion on which it ends (:mod:`bouncing_ball.attractors.mapper`). Motions that repeat in the
same way in both models are compared by their greatest height. Other motions are compared by means
over time of the height, and of the power that the table transfers to the ball. Its work in a
contact is, per unit of mass, ::

    ∫ (z″ + 1) w′ dt = [z′ w′ + w] + ∫ z′ w dt

because w″ = -w. At an instantaneous impact it is the first term alone, the impulse times w′.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind
from bouncing_ball.calculator.case import Case
from bouncing_ball.calculator.results import Family, Mean, Motion
from bouncing_ball.motion.history import history
from bouncing_ball.motion.sequence import ImpactSequence, Status

# Relative change of the velocity of an orbit, for a start beside it.
_BESIDE = 1e-3
# Number of impacts after which the search for a repetition ends.
_IMPACTS = 600
# Balls and impacts of a mean, and impacts left out before, for a linear contact and for a law,
# which takes a hundred times as long.
_SAMPLES, _SAMPLES_OF_LAW = (128, 500, 100), (32, 120, 40)
# Quantile of Student's distribution for an interval of 95 %, with 32 balls or more.
_STUDENT = 2.04
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True)
class _Start:
    """A first impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


def of_family(case: Case, family: Family) -> Motion:
    """The motion of a ball that starts on the orbit, or beside it if it is not stable."""
    lam = case.table.amplitude
    exact, simple = list(case.models)[:2]
    if family.exists and family.is_stable and family.is_admissible:
        return Motion(str(Kind.ORBIT), family.n, 1, _laid(case, family))
    orbits = (case.models[name].orbit(family.n, lam) for name in (exact, simple, "corrected"))
    orbit = next(orbit for orbit in orbits if orbit.exists)
    lossless = float(case.contact.restitution) == 1 and family.exists and family.is_admissible
    if lossless and abs(float(orbit.trace_and_determinant()[0])) < 2:
        return Motion(str(Kind.UNDECIDED), 0, 0)
    start = _Start(float(orbit.phase), float(orbit.impact_velocity) * (1 + _BESIDE))
    found = {
        name: label(_law(case, name), lam, start.phase, start.velocity, impacts=_IMPACTS)
        for name in (exact, simple)
    }
    one, other = found[exact], found[simple]
    ideal = family.standing[simple]
    if ideal.exists and ideal.is_stable and ideal.is_admissible:
        # If the stability is weak, the mapper may not recognise that the motion repeats.
        stays: dict[str, Any] = {"kind": Kind.ORBIT, "periods": family.n, "impacts": 1}
        other = replace(other, **stays)
    same = all(getattr(one, x) == getattr(other, x) for x in ("kind", "periods", "impacts"))
    values: dict[str, Any] = {}
    if same and int(one.periods) and one.kind != Kind.PERMANENT_CONTACT:
        values["greatest"] = {
            name: _greatest(case, name, start, found[name]) for name in (exact, simple)
        }
    elif Kind.PERMANENT_CONTACT not in (one.kind, other.kind):
        means = {name: _means(case, name, start) for name in (exact, simple)}
        values["mean_height"] = {name: pair[0] for name, pair in means.items()}
        values["mean_power"] = {name: pair[1] for name, pair in means.items()}
    return Motion(
        str(one.kind),
        int(one.periods),
        int(one.impacts),
        None,
        str(other.kind),
        int(other.periods),
        int(other.impacts),
        **values,
    )


def _law(case: Case, name: str) -> Any:
    model: Any = case.models[name]
    if name == "restitution":
        return model.restitution
    return case.contact if case.law is None else case.law


def _laid(case: Case, family: Family) -> str | None:
    """The motion of a ball that is laid on the table; None if it is that of the orbit."""
    lam = case.table.amplitude
    if lam <= case.permanent_contact:
        return str(Kind.PERMANENT_CONTACT)
    found = label(_law(case, next(iter(case.models))), lam, 0.0, lam, impacts=_IMPACTS)
    same = found.kind == Kind.ORBIT and (int(found.periods), int(found.impacts)) == (family.n, 1)
    return None if same else str(found.kind)


def _tops(sequence: ImpactSequence) -> np.ndarray:
    """Greatest heights of the flights after the impacts."""
    rise = np.maximum(sequence.bounce_velocity, 0.0)
    lift = sequence.amplitude * np.sin(sequence.release_phase)
    return sequence.release_displacement + lift + rise * rise / 2


def _greatest(case: Case, name: str, start: _Start, motion: Any) -> float:
    """Greatest height of a motion that repeats, in m."""
    impacts = int(motion.followed) + 2 * max(int(motion.impacts), 1)
    model = case.models[name]
    found = model.simulate(case.table.amplitude, start.phase, start.velocity, impacts)
    last = _tops(found)[-1 - max(int(motion.impacts), 1) :]
    return float(np.nanmax(last)) * case.table.length


def _means(case: Case, name: str, start: _Start) -> tuple[Mean | None, Mean | None]:
    """Means over many balls that start beside each other, in m and W."""
    balls, impacts, before = _SAMPLES if case.law is None else _SAMPLES_OF_LAW
    table = case.table
    velocity = start.velocity * (1 + _BESIDE * np.arange(1, balls + 1) / balls)
    found = case.models[name].simulate(table.amplitude, start.phase, velocity, impacts)
    going = np.flatnonzero(found.status == Status.BOUNCING)
    if going.size < balls:
        return None, None
    means = np.array([height_and_power(found[k], before) for k in going])
    units = table.length, case.mass * table.gravity**2 / table.angular_frequency
    middle, error = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(balls)
    height, power = (
        Mean(float(m * unit), float(_STUDENT * e * unit))
        for m, e, unit in zip(middle, error, units, strict=True)
    )
    return height, power


def height_and_power(sequence: ImpactSequence, before: int = 0) -> tuple[float, float]:
    """Means over time of a ball's height and of the power that the table transfers, dimensionless.

    They are taken from the impact number ``before`` to the last one recorded.

    Examples
    --------
    An elastic ball on a table at rest has two thirds of its greatest height in the mean, and
    receives no power:

    >>> from bouncing_ball.motion.simulation import simulate
    >>> height, power = height_and_power(simulate(1.0, 0.0, 0.0, -2.0, 5))
    >>> round(height, 12), round(power, 12)
    (1.333333333333, 0.0)
    """
    lam, part = sequence.amplitude, slice(before, -1)
    time, phase, duration = sequence.time, sequence.phase[part], sequence.contact_duration[part]
    impact, bounce = sequence.impact_velocity[part], sequence.bounce_velocity[part]
    end = phase + duration
    flight = time[before + 1 :] - time[part] - duration
    lift, left = lam * np.sin(phase), lam * np.sin(end)
    low = sequence.release_displacement[part] + left
    flown = (low + (bounce / 2 - flight / 6) * flight) * flight
    work = bounce * lam * np.cos(end) - impact * lam * np.cos(phase) + left - lift
    # The integrals over the contact are computed by Gauss's rule.
    half = duration[:, np.newaxis] / 2
    inside = history(sequence, (time[part, np.newaxis] + half * (1 + _NODES)).ravel())
    shape = (*duration.shape, _NODES.size)
    height, pushed = inside.height, inside.velocity * inside.table
    held, moved = (half[:, 0] * (x.reshape(shape) @ _WEIGHTS) for x in (height, pushed))
    # If a contact is an instant all nodes are at its start, and the integral is zero.
    held, moved = (np.where(duration > 0, x, 0.0) for x in (held, moved))
    total = time[-1] - time[before]
    return float(np.sum(flown + held) / total), float(np.sum(work + moved) / total)


def headline(motion: Motion, family: Family) -> str:
    """The motion of the ball, in one sentence."""
    orbit = f"{family.n}-T orbit"
    if motion.kind == Kind.ORBIT and motion.restitution_kind is None:
        said = f"A ball on the {orbit} stays on it: it is stable"
        if motion.laid is None:
            return f"{said}."
        rests = motion.laid == Kind.PERMANENT_CONTACT
        does = "stays at rest" if rests else _DOES[motion.laid]
        return f"{said}. Laid on the table a ball {does}."
    if motion.restitution_kind is None:
        return f"A ball beside the {orbit} stays beside it: nothing is lost, and it ends nowhere."
    does = _DOES[motion.kind]
    if motion.periods > 1 and motion.kind != Kind.PERMANENT_CONTACT:
        does += f", every {motion.periods} periods of the table and {motion.impacts} impacts"
    why = "not stable" if family.is_admissible else "inadmissible: another impact comes first"
    if not family.exists:
        return f"The contact has no {orbit}: a ball that starts like one {does}."
    return f"No ball stays on the {orbit}, which is {why}: one that starts beside it {does}."


_DOES: Mapping[str, str] = {
    Kind.ORBIT: "repeats itself on a periodic orbit",
    Kind.SUBHARMONIC: "repeats itself with a multiple of a period (doubled)",
    Kind.LOCKED: "repeats itself and sticks to the table on the way (locked)",
    Kind.PERMANENT_CONTACT: "comes to rest on the table",
    Kind.CHAOTIC: "ends in chaotic motion",
    Kind.UNDECIDED: "shows no motion that repeats, and is not known to be chaotic",
}
