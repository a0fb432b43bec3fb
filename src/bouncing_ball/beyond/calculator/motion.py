"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and the mapper computes
the motion on which it ends (:mod:`bouncing_ball.beyond.long_run.destination`). Motions that repeat in the
same way in both models are compared by their greatest height. Other motions are compared by means
over time of the height, and of the power that the table transfers to the ball
(:mod:`bouncing_ball.beyond.long_run.means`).

In a chaotic motion the balls of both models start alike, and each gives a pair of means. The error
of the ratio of both means follows from the differences within the pairs, so that fluctuations which
both models share cancel. For independent means it is smaller than the sum of both errors, by a
factor of √2 if these are equal. Balls are added until the difference is known to be within or
beyond the tolerance, up to a number of balls that takes about three seconds.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.beyond.calculator.case import Case
from bouncing_ball.beyond.calculator.results import Family, Mean, Motion
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.means import over_steps
from bouncing_ball.beyond.long_run.motions import Kind
from bouncing_ball.paper.comparison.errors import relative
from bouncing_ball.paper.contact.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.paper.motion.sequence import ImpactSequence, Status

# Relative change of an orbit's impact velocity for a start beside the orbit.
_BESIDE = 1e-3
# Number of impacts after which the search for a repetition ends.
_IMPACTS = 600
# Balls in a round, the largest number of rounds, impacts of each ball, and the number of first
# impacts left out of the means: for a linear contact, and for a contact law, of which a step takes
# much longer, though hardly longer for many balls than for a few.
_SAMPLES, _SAMPLES_OF_LAW = (256, 6, 500, 100), (128, 2, 80, 40)
# Quantile of Student's distribution for a confidence interval of 95 % with 128 balls or more.
_STUDENT = 1.98


class _Start(NamedTuple):
    """A first impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


def of_family(case: Case, family: Family, tolerance: float) -> Motion:
    """The motion of a ball that starts on the orbit of a family, or beside an unstable orbit.

    Balls are added to the means over time until these decide about the tolerance.
    """
    lam = case.table.amplitude
    exact, simple = list(case.models)[:2]
    if family.exists and family.is_stable and family.is_admissible:
        return Motion(str(Kind.ORBIT), family.n, 1, _laid(case, family))
    orbits = (case.models[name].orbit(family.n, lam) for name in (exact, simple, "corrected"))
    orbit = next((orbit for orbit in orbits if orbit.exists), None)
    lossless = float(case.contact.restitution) == 1 and family.exists and family.is_admissible
    if orbit is not None and lossless and abs(float(orbit.trace_and_determinant()[0])) < 2:
        return Motion(str(Kind.UNDECIDED), 0, 0)
    # If no model has an orbit, a ball laid on the table at the phase where the table moves down
    # fastest.
    start = _Start(np.pi, -lam)
    if orbit is not None:
        start = _Start(float(orbit.phase), float(orbit.impact_velocity) * (1 + _BESIDE))
    found = {
        name: final_motions(_law(case, name), lam, start.phase, start.velocity, impacts=_IMPACTS)
        for name in (exact, simple)
    }
    kinds = [(str(x.kind), int(x.periods), int(x.impacts)) for x in found.values()]
    ideal = family.standing[simple]
    if ideal.exists and ideal.is_stable and ideal.is_admissible:
        # If the orbit is weakly stable, the mapper may not recognise that the motion repeats.
        kinds[1] = str(Kind.ORBIT), family.n, 1
    values: dict[str, Any] = {}
    if kinds[0] == kinds[1] and kinds[0][1] and kinds[0][0] != Kind.PERMANENT_CONTACT:
        values["greatest"] = {name: _greatest(case, name, start, x) for name, x in found.items()}
    elif Kind.PERMANENT_CONTACT not in (kinds[0][0], kinds[1][0]):
        lengths = {name: kind[2] for name, kind in zip(found, kinds, strict=True)}
        values = _compared(case, lengths, start, tolerance)
    return Motion(*kinds[0], None, *kinds[1], **values)


def _law(case: Case, name: str) -> Any:
    model: Any = case.models[name]
    if name == "restitution":
        return model.restitution
    return case.contact if case.law is None else case.law


def _laid(case: Case, family: Family) -> str | None:
    """Kind of the motion of a ball that is laid on the table; None if it ends on the orbit."""
    lam = case.table.amplitude
    if lam <= case.permanent_contact:
        return str(Kind.PERMANENT_CONTACT)
    found = final_motions(_law(case, next(iter(case.models))), lam, 0.0, lam, impacts=_IMPACTS)
    same = found.kind == Kind.ORBIT and (int(found.periods), int(found.impacts)) == (family.n, 1)
    return None if same else str(found.kind)


def _tops(sequence: ImpactSequence) -> np.ndarray:
    """Greatest height of the flight after each impact, dimensionless."""
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


def _compared(
    case: Case, lengths: Mapping[str, int], start: _Start, tolerance: float
) -> dict[str, Any]:
    """Means of both models over balls that start alike, in m and W, and their relative errors.

    ``lengths`` is the number of impacts after which each motion repeats, 0 if it does not. Motions
    that repeat are averaged over whole repetitions: all balls end on the same motion, so that the
    error of a part of a repetition would not show in their scatter.
    """
    balls, rounds, impacts, before = _SAMPLES if case.law is None else _SAMPLES_OF_LAW
    table, means = case.table, np.zeros((2, 2, 0))
    velocity = start.velocity * (1 + _BESIDE * np.arange(1, rounds * balls + 1) / balls)
    for one in np.split(velocity, rounds):
        found = []
        for name, length in lengths.items():
            length = max(length, 1)
            whole = max((impacts - 1 - before) // length, 1) * length
            run = case.models[name].simulate(table.amplitude, start.phase, one, before + whole + 1)
            if np.any(run.status != Status.BOUNCING):
                # Some balls come to rest, so that the means do not exist.
                return {"mean_height": dict.fromkeys(lengths), "mean_power": dict.fromkeys(lengths)}
            found.append(height_and_power(run, before))
        means = np.concatenate([means, np.array(found)], axis=-1)
        exact, simple = means
        off = relative(exact.mean(axis=-1), simple.mean(axis=-1))[:, np.newaxis]
        apart = (exact - (1 + off) * simple) / simple.mean(axis=-1, keepdims=True)
        off, margin = np.abs(off[:, 0]), _half_width(apart)
        if np.all(off + margin <= tolerance) or np.any(off - margin > tolerance):
            break
    units = table.length, case.mass * table.gravity**2 / table.angular_frequency
    values: dict[str, Any] = {"mean_error": {}}
    for k, (name, unit) in enumerate(zip(("height", "power"), units, strict=True)):
        middle, width = means[:, k].mean(axis=-1) * unit, _half_width(means[:, k]) * unit
        pairs = map(Mean, middle.tolist(), width.tolist())
        values[f"mean_{name}"] = dict(zip(lengths, pairs, strict=True))
        values["mean_error"][name] = Mean(float(off[k]), float(margin[k]))
    return values


def _half_width(samples: np.ndarray) -> np.ndarray:
    """Half the width of the 95 % confidence interval of a mean over the last axis."""
    return _STUDENT * samples.std(axis=-1, ddof=1) / np.sqrt(samples.shape[-1])


def height_and_power(sequence: ImpactSequence, before: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Means over time of each ball's height and of the power that the table transfers to it.

    The means are dimensionless, have the shape of the balls, and extend from impact number
    ``before`` to the last impact recorded.

    Examples
    --------
    The mean height of an elastic ball on a table at rest is two thirds of its greatest height, and
    the ball receives no power:

    >>> from bouncing_ball.beyond.simulation import simulate
    >>> height, power = height_and_power(simulate(1.0, 0.0, 0.0, -2.0, 5))
    >>> round(float(height), 12), round(float(power), 12)
    (1.333333333333, 0.0)
    """
    part, law, time = slice(before, -1), sequence.contact, sequence.time
    duration, phase = sequence.contact_duration[part], sequence.phase[part]
    gap = np.array([sequence.displacement, sequence.release_displacement])[:, part]
    rate = np.array([sequence.relative_velocity, sequence.relative_bounce_velocity])[:, part]
    ends, flown = np.array([phase, phase + duration]), np.diff(time[before:], axis=0) - duration
    sums = over_steps(law, sequence.amplitude, duration, ends, gap, rate, flown)
    height, power = (np.sum(x, axis=0) / (time[-1] - time[before]) for x in sums)
    return height, power


def aside(motion: Motion, amplitude: float) -> str:
    """A clause that follows the verdict on the orbit if a ball laid on the table ends elsewhere."""
    rests = motion.laid == Kind.PERMANENT_CONTACT and amplitude <= RESTITUTION_THRESHOLD
    if motion.laid is None or rests:
        return ""
    return f"; a ball laid on the table {_LAID[motion.laid]}, and is not judged"


def headline(motion: Motion, family: Family) -> str:
    """The motion of the ball, in one sentence."""
    orbit = f"{family.n}-T orbit"
    if motion.kind == Kind.ORBIT and motion.restitution_kind is None:
        said = f"The {orbit} is stable: a ball on it stays on it."
        if motion.laid is None:
            return said
        return f"{said} A ball laid on the table {_LAID[motion.laid]}."
    if motion.restitution_kind is None:
        return f"A ball near the {orbit} stays near it, because the contact loses no energy."
    none = not any(each.exists for each in family.standing.values())
    does = (_LAID if none else _DOES)[motion.kind]
    if motion.periods > 1 and motion.kind != Kind.PERMANENT_CONTACT:
        does += f" after {motion.periods} periods of the table and {motion.impacts} impacts"
    why = "not stable" if family.is_admissible else "not admissible"
    if none:
        return f"No model has an n-T orbit. A ball laid on the table {does}."
    if not family.exists:
        return f"The contact has no {orbit}. A ball that starts as on such an orbit {does}."
    return f"The {orbit} is {why}. A ball that starts near it {does}."


_DOES: Mapping[str, str] = {
    Kind.ORBIT: "settles on a periodic orbit, which repeats",
    Kind.SUBHARMONIC: "settles on a doubled orbit, which repeats",
    Kind.LOCKED: "settles on a locked motion, which sticks to the table and repeats",
    Kind.PERMANENT_CONTACT: "comes to rest on the table",
    Kind.CHAOTIC: "ends in chaotic motion",
    Kind.UNDECIDED: "shows no periodic motion and is not known to be chaotic",
}
_LAID = {**_DOES, Kind.PERMANENT_CONTACT: "stays at rest"}
