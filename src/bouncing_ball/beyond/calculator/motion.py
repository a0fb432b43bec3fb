"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and the mapper computes
the motion on which it ends (:mod:`bouncing_ball.beyond.long_run.destination`). Motions that repeat
in the same way in both models are compared by their greatest height. Other motions are compared by
means over time of the height, and of the power that the table transfers to the ball
(:mod:`bouncing_ball.beyond.long_run.means`).

In a chaotic motion the balls of both models start alike, and each gives a pair of means. The error
of the ratio of both means follows from the differences within the pairs, so that fluctuations which
both models share cancel. For independent means it is smaller than the sum of both errors, by a
factor of √2 if these are equal. Balls are added until the difference is known to be within or
beyond the tolerance, up to a number of balls that takes about three seconds.
"""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.beyond.calculator.case import PhysicalCase
from bouncing_ball.beyond.calculator.families import prediction_error
from bouncing_ball.beyond.calculator.results import Family, FinalMotion, Mean
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.means import over_steps
from bouncing_ball.beyond.long_run.motions import Kind
from bouncing_ball.paper.motion.sequence import ImpactSequence, Status

# Relative change of an orbit's impact velocity for a start beside the orbit.
_BESIDE = 1e-3
# Number of impacts after which the search for a repetition ends. A contact law is integrated in
# time, which takes several milliseconds for an impact, so that it is followed for fewer.
_IMPACTS = 600
_IMPACTS_OF_LAW = 250
# Balls in a round, the number of rounds unless a number of balls is asked for, impacts of each
# ball, and the number of first impacts left out of the means. A step of a contact law takes much
# longer than one of a linear contact, though hardly longer for many balls than for a few.
_SAMPLES = (256, 6, 500, 100)
_SAMPLES_OF_LAW = (128, 2, 80, 40)
# Quantities of which means over time are compared.
_MEANS = ("height", "power")
# Quantile of Student's distribution for a confidence interval of 95 % with 128 balls or more.
_STUDENT = 1.98


class _Kind(NamedTuple):
    """The kind of a motion, with the periods and impacts after which it repeats, or 0."""

    kind: str
    periods: int
    impacts: int


class _Start(NamedTuple):
    """A first impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


def of_family(
    case: PhysicalCase, family: Family, tolerance: float, balls: int | None = None
) -> FinalMotion:
    """The motion of a ball that starts on the orbit of a family, or beside an unstable orbit.

    Balls are added to the means over time until these decide about the tolerance, up to ``balls``,
    rounded up to whole rounds.
    """
    if family.exists and family.is_stable and family.is_admissible:
        return FinalMotion(str(Kind.ORBIT), family.n, 1, laid=_laid(case, family))
    orbit = _first_orbit(case, family.n)
    if orbit is not None and _is_elliptic(case, family, orbit):
        return FinalMotion(str(Kind.UNDECIDED), 0, 0)
    start = _start(case, orbit)
    followed = _followed(case)
    # The exact model and the restitution model.
    found = {
        name: final_motions(
            case.models[name], case.table.amplitude, start.phase, start.velocity, impacts=followed
        )
        for name in list(case.models)[:2]
    }
    kinds = {
        name: _Kind(str(motion.kind), int(motion.periods), int(motion.impacts))
        for name, motion in found.items()
    }
    ideal = family.standing["restitution"]
    if ideal.exists and ideal.is_stable and ideal.is_admissible:
        # If the orbit is weakly stable, the mapper may not recognise that the motion repeats.
        kinds["restitution"] = _Kind(str(Kind.ORBIT), family.n, 1)
    exact, simple = kinds.values()
    values: dict[str, Any] = {}
    rests = Kind.PERMANENT_CONTACT in (exact.kind, simple.kind)
    if exact == simple and exact.periods > 0 and not rests:
        values["greatest"] = {name: _greatest(case, name, start, x) for name, x in found.items()}
    elif not rests:
        lengths = {name: kind.impacts for name, kind in kinds.items()}
        values = _compared(case, lengths, start, tolerance, balls)
    return FinalMotion(
        kind=exact.kind,
        periods=exact.periods,
        impacts=exact.impacts,
        restitution_kind=simple.kind,
        restitution_periods=simple.periods,
        restitution_impacts=simple.impacts,
        **values,
    )


def _followed(case: PhysicalCase) -> int:
    """Number of impacts of a ball in the search for its final motion."""
    return _IMPACTS if case.law is None else _IMPACTS_OF_LAW


def _first_orbit(case: PhysicalCase, n: int) -> Any | None:
    """The n-T orbit of the first model that has one: exact, restitution or corrected."""
    for model in case.models.values():
        orbit = model.orbit(n, case.table.amplitude)
        if orbit.exists:
            return orbit
    return None


def _is_elliptic(case: PhysicalCase, family: Family, orbit: Any) -> bool:
    """Whether a ball stays near the orbit without being attracted, as the contact has no loss."""
    lossless = float(case.contact.restitution) == 1
    if not (lossless and family.exists and family.is_admissible):
        return False
    trace, _ = orbit.trace_and_determinant()
    return abs(float(trace)) < 2


def _start(case: PhysicalCase, orbit: Any | None) -> _Start:
    """An impact beside the orbit, or without one that of a ball laid on the table at the phase
    where the table moves down fastest.
    """
    if orbit is None:
        return _Start(np.pi, -case.table.amplitude)
    return _Start(float(orbit.phase), float(orbit.impact_velocity) * (1 + _BESIDE))


def _laid(case: PhysicalCase, family: Family) -> str | None:
    """Kind of the motion of a ball that is laid on the table; None if it ends on the orbit."""
    lam = case.table.amplitude
    if lam <= case.permanent_contact:
        return str(Kind.PERMANENT_CONTACT)
    followed = _followed(case)
    found = final_motions(next(iter(case.models.values())), lam, 0.0, lam, impacts=followed)
    same = found.kind == Kind.ORBIT and (int(found.periods), int(found.impacts)) == (family.n, 1)
    return None if same else str(found.kind)


def _tops(sequence: ImpactSequence) -> np.ndarray:
    """Greatest height of the flight after each impact, dimensionless."""
    rise = np.maximum(sequence.bounce_velocity, 0.0)
    lift = sequence.amplitude * np.sin(sequence.release_phase)
    return sequence.release_displacement + lift + rise * rise / 2


def _greatest(case: PhysicalCase, name: str, start: _Start, motion: Any) -> float:
    """Greatest height of a motion that repeats, in m."""
    impacts = int(motion.followed) + 2 * max(int(motion.impacts), 1)
    model = case.models[name]
    found = model.simulate(case.table.amplitude, start.phase, start.velocity, impacts)
    last = _tops(found)[-1 - max(int(motion.impacts), 1) :]
    return float(np.nanmax(last)) * case.table.length


def _compared(
    case: PhysicalCase,
    lengths: Mapping[str, int],
    start: _Start,
    tolerance: float,
    most: int | None,
) -> dict[str, Any]:
    """Means of both models over balls that start alike, in m and W, and their relative errors.

    ``lengths`` is the number of impacts after which each motion repeats, 0 if it does not. Motions
    that repeat are averaged over whole repetitions: all balls end on the same motion, so that the
    error of a part of a repetition would not show in their scatter.
    """
    balls, usual, impacts, before = _SAMPLES if case.law is None else _SAMPLES_OF_LAW
    rounds = usual if most is None else -(-most // balls)
    # However many balls there are, the last one starts as far from the orbit.
    beside = 1 + _BESIDE * usual * np.arange(1, rounds * balls + 1) / (rounds * balls)
    # Means of height and power for the balls so far, shape (model, quantity, ball).
    means = np.zeros((2, 2, 0))
    for velocity in np.split(start.velocity * beside, rounds):
        found = []
        for name, length in lengths.items():
            repeats = max(length, 1)
            counted = max((impacts - 1 - before) // repeats, 1) * repeats
            run = case.models[name].simulate(
                case.table.amplitude, start.phase, velocity, before + counted + 1
            )
            if np.any(run.status != Status.BOUNCING):
                # Some balls come to rest, so that the means do not exist.
                return {"mean_height": dict.fromkeys(lengths), "mean_power": dict.fromkeys(lengths)}
            found.append(height_and_power(run, before))
        means = np.concatenate([means, np.array(found)], axis=-1)
        error, margin = _error_of_means(*means)
        size = np.abs(error)
        if np.all(size + margin <= tolerance) or np.any(size - margin > tolerance):
            break
    table = case.table
    watt = case.mass * table.gravity**2 / table.angular_frequency
    return {
        "mean_height": _in_si(means[:, 0], table.length, lengths),
        "mean_power": _in_si(means[:, 1], watt, lengths),
        "mean_error": {
            name: Mean(float(error[k]), float(margin[k])) for k, name in enumerate(_MEANS)
        },
        "balls": means.shape[-1],
    }


def _error_of_means(exact: np.ndarray, simple: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Relative errors of the simple model's means against the exact ones, and their half-widths.

    The arguments have the shape (quantity, ball); equal balls of both models start alike.
    """
    error = prediction_error(simple.mean(axis=-1), exact.mean(axis=-1))[:, np.newaxis]
    differences = (simple - (1 + error) * exact) / exact.mean(axis=-1, keepdims=True)
    return error[:, 0], _half_width(differences)


def _in_si(samples: np.ndarray, unit: float, models: Iterable[str]) -> dict[str, Mean]:
    """The mean over the balls with its half-width for each model, from shape (model, ball)."""
    middle = (samples.mean(axis=-1) * unit).tolist()
    width = (_half_width(samples) * unit).tolist()
    return {name: Mean(*pair) for name, *pair in zip(models, middle, width, strict=True)}


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

    >>> from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
    >>> height, power = height_and_power(RestitutionModel(1.0).simulate(0.0, 0.0, -2.0, 5))
    >>> round(float(height), 12), round(float(power), 12)
    (1.333333333333, 0.0)
    """
    counted = slice(before, -1)
    time = sequence.time
    duration = sequence.contact_duration[counted]
    phase = sequence.phase[counted]
    sums = over_steps(
        sequence.contact,
        sequence.amplitude,
        duration,
        phase=np.array([phase, phase + duration]),
        gap=np.array([sequence.displacement, sequence.release_displacement])[:, counted],
        rate=np.array([sequence.relative_velocity, sequence.relative_bounce_velocity])[:, counted],
        flown=np.diff(time[before:], axis=0) - duration,
    )
    height, power = (np.sum(each, axis=0) / (time[-1] - time[before]) for each in sums)
    return height, power
