"""Means over time on motions that do not repeat, and the errors of the restitution model in them.

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
from typing import Any

import numpy as np

from bouncing_ball.accuracy.errors import deviation
from bouncing_ball.contacts.effort import Sampling
from bouncing_ball.contacts.ends import Ending, FirstImpact, end_of
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.errors import ModelError
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
from bouncing_ball.models.flight import table
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.law_of_impact import law_with_impact
from bouncing_ball.models.spring_damper import SpringDamper

# Relative change of an orbit's impact velocity for a start beside the orbit.
BESIDE = 1e-3
# Quantities of which means over time are compared.
_MEANS = ("height", "power")


@dataclass(frozen=True)
class Mean:
    """A mean, and half the width of its confidence interval of 95 %, in SI units."""

    value: float
    half_width: float


# An impact multiplies the energy by r² about, and so this number times 1/(1 - r) impacts by less
# than e⁻⁴; but so many impacts are not left out next to r = 1.
_FORGOTTEN = 2.0
_MOST_BEFORE = 400
# The relative change of r, k and g, which few users know better.
_CHANGE = 1e-3
# To this part of itself a law is found from its impact again.
_SAME = 1e-6


def compared_means(
    case: ResolvedContact,
    ends: Mapping[str, Ending],
    tolerance: float,
    most: int | None,
    first: FirstImpact,
) -> dict[str, Any]:
    """Means of both models, in m and W, and the deviations of the second model's from the first's,
    relative to these.
    """
    sampling = case.effort.samples
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


def _are_unlike(ends: Mapping[str, Ending]) -> bool:
    """Whether one of the motions is periodic and the other is not, so that no mean decides."""
    kinds = {end.motion.kind for end in ends.values()}
    periodic = {str(Kind.ORBIT), str(Kind.SUBHARMONIC)}
    return len(kinds) > 1 and bool(kinds & periodic) and str(Kind.UNDECIDED) not in kinds


NO_CHANGE = "no change"
"""The name of the linear contact in place of a law, among the changes."""


def _changed(case: ResolvedContact, end: Ending) -> dict[str, ResolvedContact]:
    """The case with r, k or g changed by a thousandth, the others as they are.

    r of a contact law is changed at the mean speed of the impacts of the motion. In place of a law
    that is not determined by an impact stands the linear contact, also without a change.
    """
    speed = _impact_speed(case, end)
    law = case.integrated_law
    if law is not None and not _is_of_impact(law, speed):
        spring = case.equivalent.linear
        linear = replace(case, law=spring, equivalent=spring)
        return {NO_CHANGE: linear} | _changed(linear, end)
    found = {"r -0.1 %": _with(case, speed, restitution=1 - _CHANGE)}
    if float(case.equivalent.restitution) * (1 + _CHANGE) <= 1:
        found["r +0.1 %"] = _with(case, speed, restitution=1 + _CHANGE)
    found["k +0.1 %"] = _with(case, speed, duration=_shorter(case, speed))
    # In units of g/Ω the same impact is then slower.
    found["g +0.1 %"] = replace(
        _with(case, speed, unit=1 + _CHANGE),
        table=replace(case.table, gravity=case.table.gravity * (1 + _CHANGE)),
    )
    return found


def _impact_speed(case: ResolvedContact, end: Ending) -> float:
    """The mean relative speed of the impacts of a motion, dimensionless."""
    speed, _ = table(end.impacts.phase, case.table.amplitude)
    return float(np.mean(speed - end.impacts.velocity))


def _shorter(case: ResolvedContact, speed: float) -> float:
    """The factor of the duration of an impact on a stiffer contact."""
    law = case.integrated_law
    if law is None:
        return 1 / math.sqrt(1 + _CHANGE)
    stiffer = law.stiffened(1 + _CHANGE)
    return float(stiffer.signature(speed).duration / law.signature(speed).duration)


def _with(
    case: ResolvedContact,
    speed: float,
    restitution: float = 1.0,
    duration: float = 1.0,
    unit: float = 1.0,
) -> ResolvedContact:
    """The case with r and the duration of free impacts, and the unit of speeds, times factors."""
    contact = case.equivalent
    r = float(contact.restitution) * restitution
    ratio = float(contact.frequency_ratio) / duration
    other = SpringDamper.from_restitution(r, ratio, contact.release, measured=True)
    of_law = case.integrated_law
    law: Any = other if of_law is None else _law(of_law, speed, restitution, duration, unit)
    return replace(case, law=law, equivalent=law if case.is_spring_damper else other)


def _law(
    law: ContactLaw,
    speed: float,
    restitution: float = 1.0,
    duration: float = 1.0,
    unit: float = 1.0,
) -> ContactLaw:
    """A law of the same kind, whose free impact at a speed has r and the duration times factors, in
    a unit of speeds that is greater by a factor.

    Raises
    ------
    ModelError
        If an impact does not determine laws of this kind.
    """
    impact = law.signature(speed)
    r = float(impact.restitution) * restitution
    time = float(impact.duration) * duration
    in_unit = replace(law, **law.in_si(1.0, 1 / unit, 1.0))
    return law_with_impact(in_unit, r, time, speed / unit)


def _is_of_impact(law: ContactLaw, speed: float) -> bool:
    """Whether the impact at a speed determines the law, to the accuracy of the impact, and the law
    has a stiffness that can be changed.
    """
    try:
        again = _law(law, speed).parameters()
        law.stiffened(1 + _CHANGE).signature(speed)
    except ModelError:
        return False
    return all(
        math.isclose(float(again[name]), float(x), rel_tol=_SAME)
        for name, x in law.parameters().items()
    )


def _changes(
    case: ResolvedContact, ends: Mapping[str, Ending], first: FirstImpact
) -> dict[str, dict[str, Mean]] | None:
    """The errors of the means in the changed cases, from smaller samples. Their motions are those
    on which a ball with the same start ends, or of balls beside the motion of a law. None if a ball
    rests, or if the linear contact in place of a law has another kind of motion.
    """
    exact_end, *_ = ends.values()
    kinds = [end.motion.kind for end in ends.values()]
    found = {}
    for name, changed in _changed(case, exact_end).items():
        sampling = changed.effort.samples_of_change
        lam = changed.table.amplitude
        # A ball beside a table that moves less would rise from it.
        start = first._replace(velocity=min(first.velocity, lam * math.cos(first.phase)))
        exact_model, simple_model, *_ = changed.models
        there = {
            exact_model: _beside(changed, exact_end, start),
            simple_model: end_of(changed, simple_model, start),
        }
        if name == NO_CHANGE and [end.motion.kind for end in there.values()] != kinds:
            return None
        if not all(end.impacts.phase.size for end in there.values()):
            return None
        samples = _sample_sizes(sampling, sampling.usual, there.values())
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


def _beside(changed: ResolvedContact, end: Ending, start: FirstImpact) -> Ending:
    """The motion of a changed contact: for a law, whose balls take long to follow, that of balls
    which start beside the impacts of a motion without a change, if this does not repeat.
    """
    if changed.is_linear or not end.is_sampled:
        return end_of(changed, next(iter(changed.models)), start)
    impacts = Starts.of_path(np.array(end.impacts), changed.table.amplitude)
    return end._replace(impacts=impacts)


def _sample_sizes(sampling: Sampling, balls: int, ends: Iterable[Ending]) -> list[SampleSize]:
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
    case: ResolvedContact, name: str, end: Ending, samples: list[SampleSize]
) -> Iterator[np.ndarray]:
    """The sums over the motion of a model at each look: of the balls of a sample, of sections of a
    lap, or of one repetition.
    """
    lam = case.table.amplitude
    model = case.models[name]
    impacts = end.impacts
    if end.is_sampled:
        starts = impacts.beside(samples[-1].balls, lam, BESIDE)
        return sums_at(samples, starts, model, lam, _before(case))
    if end.is_unresolved:
        return repeat(sections(*start(model, lam, impacts.first()), impacts.phase.size))
    _, once = advance(*start(model, lam, impacts.last()), end.motion.impacts)
    return repeat(once)


def _before(case: ResolvedContact) -> int:
    """Number of first impacts that are left out."""
    loss = 1 - float(case.equivalent.restitution)
    forgotten = _MOST_BEFORE if loss * _MOST_BEFORE < _FORGOTTEN else math.ceil(_FORGOTTEN / loss)
    return max(case.effort.samples.before, forgotten)


def _estimate(end: Ending, sums: np.ndarray) -> Estimate:
    """The means of a motion and their errors.

    The lap on which a ball locks is another one with other rounding errors, and so differs from the
    true one as two samples of its impacts do.
    """
    found = Estimate.of(sums)
    return found._replace(error=np.sqrt(2) * found.error) if end.is_unresolved else found


def _error_of_means(
    exact: Estimate, simple: Estimate, factor: float
) -> tuple[np.ndarray, np.ndarray]:
    """Deviations of the simple model's means from the exact ones, relative to these, and their
    half-widths: standard errors times a factor.
    """
    error = deviation(exact=exact.mean, simple=simple.mean)
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
