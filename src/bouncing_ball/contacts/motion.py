"""The motion on which a ball ends, and how accurately the restitution model predicts it.

A ball on a stable orbit stays there. A ball near an unstable one leaves, and the mapper computes
the motion on which it ends (:mod:`bouncing_ball.long_run.destination`). Motions that repeat
in the same way in both models are compared by their greatest height. Other motions are compared by
means over time of the height, and of the power that the table transfers to the ball
(:mod:`bouncing_ball.long_run.means`).

A motion that repeats has the mean of one repetition. The mean of another motion is that of many
balls that start beside its impacts (:mod:`bouncing_ball.long_run.sampled_means`). The sample
grows until the difference between both models is known to be within or beyond the tolerance, or
until it has as many balls and impacts as take about a second. The samples of both models are
independent, because balls that start alike have nothing in common after the first impacts, which
are left out. If rounding errors decide after which lap a ball locks, the mean is that of the lap
computed, and its error that of a sample of as many impacts.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import repeat
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.contacts.families import ComparedOrbit, prediction_error
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.long_run.sampled_means import (
    Estimate,
    SampleSize,
    Starts,
    advance,
    quantile,
    sample_sizes,
    sections,
    start,
    sums_at,
)
from bouncing_ball.models.sequence import ImpactSequence
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import n_t

# Relative change of an orbit's impact velocity for a start beside the orbit.
_BESIDE = 1e-3
# Number of impacts after which the search for a repetition ends. A contact law is integrated in
# time, which takes several milliseconds for an impact, so that it is followed for fewer.
_IMPACTS = 600
_IMPACTS_OF_LAW = 250


@dataclass(frozen=True)
class Mean:
    """A mean, and half the width of its confidence interval of 95 %, in SI units."""

    value: float
    half_width: float


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
    the signed relative errors of the restitution model. ``is_laid`` tells whether the ball was
    laid on the table, because no model has an orbit on which a ball can arrive, and ``is_common``
    whether it is the motion on which most balls end, because few end on the orbit. ``changes`` has
    the relative errors of the means if r, k or g change by a thousandth; "r -0.1 %" and the like
    are the names of these changes. For a contact law they are those of the linear contact with its
    r and duration, also without a change, because its own would take minutes; they are None if that
    contact has another kind of motion.

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


class Sampling(NamedTuple):
    """The samples of balls: the number of balls is rounded up to multiples of ``unit``; unless one
    is asked for it is ``usual``. The means are examined after each of the numbers of ``impacts`` of
    a ball. At least ``before`` first impacts are left out.
    """

    unit: int
    usual: int
    impacts: tuple[int, ...]
    before: int


# A step of a contact law takes much longer than one of a linear contact, though hardly longer for
# many balls than for a few.
_SAMPLES = Sampling(256, 4096, (25, 75, 150), 50)
_SAMPLES_OF_LAW = Sampling(128, 256, (20, 40), 40)
# An impact multiplies the energy by r² about, and so this number times 1/(1 - r) impacts by less
# than e⁻⁴; but so many impacts are not left out next to r = 1.
_FORGOTTEN = 2.0
_MOST_BEFORE = 400
# The relative change of r, k and g, which few users know better, and the balls of its samples.
_CHANGE = 1e-3
_BALLS_OF_CHANGE = 1024
# Quantities of which means over time are compared.
_MEANS = ("height", "power")


class _Kind(NamedTuple):
    """The kind of a motion, with the periods and impacts after which it repeats, or 0."""

    kind: str
    periods: int
    impacts: int


class _Start(NamedTuple):
    """A first impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


class _End(NamedTuple):
    """The kind of the motion on which a ball ends, impacts of this motion in order, and whether
    rounding errors decide on its period.
    """

    kind: _Kind
    impacts: Starts
    is_unresolved: bool = False

    @property
    def is_sampled(self) -> bool:
        """Whether the means of the motion are those of a sample of balls."""
        return self.kind.impacts == 0 and not self.is_unresolved


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
    stays = family.exists and family.is_stable and family.is_admissible
    if stays and start is None:
        return FinalMotion(str(Kind.ORBIT), family.n, 1, laid=_laid(case, family))
    orbit = None if start is not None else _first_orbit(case, family)
    if orbit is not None and _is_elliptic(case, family, orbit):
        return FinalMotion(str(Kind.UNDECIDED), 0, 0)
    first = None if orbit is None else _beside(case, orbit)
    first = first if start is None else _Start(*start)
    is_laid = first is None
    first = first or _laid_down(case)
    # The exact model and the restitution model.
    ends = {name: _end(case, name, first) for name in list(case.models)[:2]}
    ideal = family.standing["restitution"]
    if start is None and ideal.exists and ideal.is_stable and ideal.is_admissible:
        # If the orbit is weakly stable, the mapper may not recognise that the motion repeats.
        ends["restitution"] = _on_orbit(case, family.n)
    exact, simple = (end.kind for end in ends.values())
    values: dict[str, Any] = {}
    rests = Kind.PERMANENT_CONTACT in (exact.kind, simple.kind)
    if exact == simple and exact.periods > 0 and not rests:
        values["greatest"] = {name: _greatest(case, name, end) for name, end in ends.items()}
    elif not rests:
        values = _compared(case, ends, tolerance, balls, first)
    return FinalMotion(
        kind=exact.kind,
        periods=exact.periods,
        impacts=exact.impacts,
        restitution_kind=simple.kind,
        restitution_periods=simple.periods,
        restitution_impacts=simple.impacts,
        is_laid=is_laid,
        is_common=start is not None,
        **values,
    )


def _followed(case: ResolvedContact) -> int:
    """Number of impacts of a ball in the search for its final motion."""
    return _IMPACTS if case.law is None else _IMPACTS_OF_LAW


def _first_orbit(case: ResolvedContact, family: ComparedOrbit) -> Any | None:
    """The n-T orbit of the first model that has one: exact, restitution or corrected."""
    for name, model in case.models.items():
        if family.standing[name].exists:
            return n_t.orbit(model, family.n, case.table.amplitude)
    return None


def _is_elliptic(case: ResolvedContact, family: ComparedOrbit, orbit: Any) -> bool:
    """Whether a ball stays near the orbit without being attracted, as the contact has no loss."""
    lossless = float(case.contact.restitution) == 1
    if not (lossless and family.exists and family.is_admissible):
        return False
    trace, _ = orbit.trace_and_determinant()
    return abs(float(trace)) < 2


def _beside(case: ResolvedContact, orbit: Any) -> _Start | None:
    """An impact beside the orbit; None if no ball arrives with it, because it would rise from
    below the table, as on some inadmissible orbits of compliant contacts.
    """
    phase = float(orbit.phase)
    velocity = float(orbit.impact_velocity) * (1 + _BESIDE)
    if velocity > case.table.amplitude * math.cos(phase):
        return None
    return _Start(phase, velocity)


def _laid_down(case: ResolvedContact) -> _Start:
    """A ball that is laid on the table at the phase where the table moves down fastest."""
    return _Start(np.pi, -case.table.amplitude)


def _laid(case: ResolvedContact, family: ComparedOrbit) -> str | None:
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


def _end(case: ResolvedContact, name: str, first: _Start) -> _End:
    """The motion on which a ball of a model ends."""
    lam = case.table.amplitude
    path = np.empty((3, _followed(case)))
    found = final_motions(case.models[name], lam, *first, impacts=path.shape[1], path=path)
    kind = _Kind(str(found.kind), int(found.periods), int(found.impacts))
    followed = int(found.followed)
    seen = path[1:, :followed]
    unresolved = bool(found.is_unresolved())
    if unresolved:
        # The motion begins with the impact after which the ball forgot what was before.
        began = np.flatnonzero(seen[0] == found.end_phase)
        of_motion = seen[:, began[0] if began.size else followed // 2 :]
    else:
        last = np.array([[found.end_phase], [found.end_velocity]])
        of_motion = np.concatenate([seen[:, followed // 2 :], last], axis=1)
    return _End(kind, Starts.of_path(of_motion, lam), unresolved)


def _on_orbit(case: ResolvedContact, n: int) -> _End:
    """The n-T orbit of the restitution model."""
    orbit = n_t.orbit(case.models["restitution"], n, case.table.amplitude)
    impact = Starts(np.atleast_1d(orbit.phase), np.atleast_1d(orbit.impact_velocity))
    return _End(_Kind(str(Kind.ORBIT), n, 1), impact)


def _greatest(case: ResolvedContact, name: str, end: _End) -> float:
    """Greatest height of a motion that repeats, in m."""
    once = end.impacts.last()
    found = case.models[name].simulate(
        case.table.amplitude, once.phase[0], once.velocity[0], 2 * end.kind.impacts + 1
    )
    last = _tops(found)[-1 - end.kind.impacts :]
    return float(np.nanmax(last)) * case.table.length


def _compared(
    case: ResolvedContact,
    ends: Mapping[str, _End],
    tolerance: float,
    most: int | None,
    first: _Start,
) -> dict[str, Any]:
    """Means of both models, in m and W, and the relative errors of the second model."""
    sampling = _SAMPLES if case.law is None else _SAMPLES_OF_LAW
    balls = sampling.usual if most is None else -(-most // sampling.unit) * sampling.unit
    without_means = {"mean_height": dict.fromkeys(ends), "mean_power": dict.fromkeys(ends)}
    if not all(end.impacts.phase.size for end in ends.values()):
        # The only contact that was followed had resumed below the table, and never ended.
        return without_means
    samples = _sample_sizes(sampling, balls, ends.values())
    sums = (_sums(case, name, end, samples) for name, end in ends.items())
    for look, *of_models in zip(samples, *sums, strict=False):
        if np.any(np.isnan(of_models[0])) or np.any(np.isnan(of_models[1])):
            # Some balls come to rest, so that the means do not exist.
            return without_means
        exact, simple = (
            _estimate(end, each) for end, each in zip(ends.values(), of_models, strict=True)
        )
        factor = quantile(look.level, min(exact.freedom, simple.freedom))
        error, margin = _error_of_means(exact, simple, factor)
        size = np.abs(error)
        if np.all(size + margin <= tolerance) or np.any(size - margin > tolerance):
            break
    sampled = any(end.is_sampled for end in ends.values())
    changes = _changes(case, ends, first) if sampled and not _are_unlike(ends) else None
    table = case.table
    watt = case.mass * table.gravity**2 / table.angular_frequency
    means = dict(zip(ends, (exact, simple), strict=True))
    return {
        "mean_height": _in_si(means, 0, table.length, factor),
        "mean_power": _in_si(means, 1, watt, factor),
        "mean_error": {
            name: Mean(float(error[k]), float(margin[k])) for k, name in enumerate(_MEANS)
        },
        "balls": look.balls,
        "changes": changes,
    }


def _are_unlike(ends: Mapping[str, _End]) -> bool:
    """Whether one of the motions is periodic and the other is not, so that no mean decides."""
    kinds = {end.kind.kind for end in ends.values()}
    periodic = {str(Kind.ORBIT), str(Kind.SUBHARMONIC)}
    return len(kinds) > 1 and bool(kinds & periodic) and str(Kind.UNDECIDED) not in kinds


NO_CHANGE = "no change"
"""The name of the linear contact in place of a law, among the changes."""


def _changed(case: ResolvedContact) -> dict[str, ResolvedContact]:
    """The case with r, k or g changed by a thousandth, the others as they are; in place of a law
    the linear contact, also without a change.
    """
    linear = replace(case, law=None)
    contact = case.contact
    r = float(contact.restitution)
    ratio = float(contact.frequency_ratio)

    def with_r(restitution: float) -> ResolvedContact:
        changed = SpringDamper.from_restitution(restitution, ratio, contact.release, measured=True)
        return replace(linear, contact=changed)

    stiffer = replace(contact, frequency_ratio=ratio * math.sqrt(1 + _CHANGE))
    heavier = replace(case.table, gravity=case.table.gravity * (1 + _CHANGE))
    found = {} if case.law is None else {NO_CHANGE: linear}
    found["r -0.1 %"] = with_r(r * (1 - _CHANGE))
    if r * (1 + _CHANGE) <= 1:
        found["r +0.1 %"] = with_r(r * (1 + _CHANGE))
    found["k +0.1 %"] = replace(linear, contact=stiffer)
    found["g +0.1 %"] = replace(linear, table=heavier)
    return found


def _changes(
    case: ResolvedContact, ends: Mapping[str, _End], first: _Start
) -> dict[str, dict[str, Mean]] | None:
    """The errors of the means in the changed cases, of the motions on which a ball with the same
    start ends there, from smaller samples; None if a ball rests, or if the linear contact in place
    of a law has another kind of motion.
    """
    balls = _BALLS_OF_CHANGE
    small = _SAMPLES._replace(unit=balls, usual=balls, impacts=_SAMPLES.impacts[-2:][:1])
    kinds = [end.kind.kind for end in ends.values()]
    found = {}
    for name, changed in _changed(case).items():
        lam = changed.table.amplitude
        # A ball beside a table that moves less would rise from it.
        start = first._replace(velocity=min(first.velocity, lam * math.cos(first.phase)))
        there = {model: _end(changed, model, start) for model in list(changed.models)[:2]}
        if name == NO_CHANGE and [end.kind.kind for end in there.values()] != kinds:
            return None
        if not all(end.impacts.phase.size for end in there.values()):
            return None
        samples = _sample_sizes(small, balls, there.values())
        looked = (_sums(changed, *each, samples) for each in there.items())
        # There is no end to the sums of a motion that repeats.
        *_, (_, *sums) = zip(samples, *looked, strict=False)
        if any(np.any(np.isnan(each)) for each in sums):
            return None
        exact, simple = (_estimate(*each) for each in zip(there.values(), sums, strict=True))
        factor = quantile(samples[-1].level, min(exact.freedom, simple.freedom))
        error, margin = _error_of_means(exact, simple, factor)
        found[name] = {
            each: Mean(float(error[k]), float(margin[k])) for k, each in enumerate(_MEANS)
        }
    return found


def _sample_sizes(sampling: Sampling, balls: int, ends: Iterable[_End]) -> list[SampleSize]:
    """The sizes of the sample at which the means are examined.

    Without a sample there is one look at one ball. Beside a lap on which rounding errors decide, a
    larger sample would not make the interval smaller.
    """
    ends = list(ends)
    if not any(end.is_sampled for end in ends):
        return sample_sizes(1, 1, (1,))
    if any(end.is_unresolved for end in ends):
        return sample_sizes(sampling.unit, sampling.unit, sampling.impacts[-1:])
    return sample_sizes(balls, sampling.usual, sampling.impacts)


def _sums(
    case: ResolvedContact, name: str, end: _End, samples: list[SampleSize]
) -> Iterator[np.ndarray]:
    """The sums over the motion of a model at each look: of the balls of a sample, of sections of a
    lap, or of one repetition.
    """
    lam = case.table.amplitude
    model = case.models[name]
    impacts = end.impacts
    if end.is_sampled:
        sampling = _SAMPLES if case.law is None else _SAMPLES_OF_LAW
        starts = impacts.beside(samples[-1].balls, lam, _BESIDE)
        return sums_at(samples, starts, model, lam, _before(case, sampling.before))
    if end.is_unresolved:
        return repeat(sections(*start(model, lam, impacts.first()), impacts.phase.size))
    _, once = advance(*start(model, lam, impacts.last()), end.kind.impacts)
    return repeat(once)


def _before(case: ResolvedContact, least: int) -> int:
    """Number of first impacts that are left out."""
    loss = 1 - float(case.contact.restitution)
    forgotten = _MOST_BEFORE if loss * _MOST_BEFORE < _FORGOTTEN else math.ceil(_FORGOTTEN / loss)
    return max(least, forgotten)


def _estimate(end: _End, sums: np.ndarray) -> Estimate:
    """The means of a motion and their errors.

    The lap on which a ball locks is another one with other rounding errors, and so differs from the
    true one as two samples of its impacts do.
    """
    found = Estimate.of(sums)
    return found._replace(error=np.sqrt(2) * found.error) if end.is_unresolved else found


def _error_of_means(
    exact: Estimate, simple: Estimate, factor: float
) -> tuple[np.ndarray, np.ndarray]:
    """Relative errors of the simple model's means against the exact ones, and their half-widths:
    standard errors times a factor.
    """
    error = prediction_error(simple.mean, exact.mean)
    spread = np.hypot(simple.error, (1 + error) * exact.error) / np.abs(exact.mean)
    return error, factor * spread


def _in_si(
    means: Mapping[str, Estimate], quantity: int, unit: float, factor: float
) -> dict[str, Mean]:
    """The mean of a quantity in each model with its half-width."""
    return {
        name: Mean(float(each.mean[quantity]) * unit, factor * float(each.error[quantity]) * unit)
        for name, each in means.items()
    }
