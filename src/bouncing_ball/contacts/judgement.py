"""Whether the restitution model is good enough for a contact: the facts that decide it.

A contact is judged on a periodic orbit, or on the motion on which a ball ends if none stays on the
orbit. All errors are deviations of a model from the contact, relative to the value on the contact
(:func:`~bouncing_ball.accuracy.errors.deviation`). The sentences on these facts are in
:mod:`bouncing_ball.contacts.verdict` and :mod:`bouncing_ball.contacts.verdict_on_motion`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum, auto
from typing import NamedTuple

from bouncing_ball.accuracy.errors import deviation
from bouncing_ball.contacts.families import ComparedOrbit
from bouncing_ball.contacts.means import NO_CHANGE, Mean
from bouncing_ball.contacts.motion import FinalMotion
from bouncing_ball.contacts.needed import Needed
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.permanent_contact import RESTITUTION_THRESHOLD


class Disagreement(Enum):
    """What only one of two orbits has, that of the restitution model or that of the contact."""

    EXISTENCE = auto()
    ADMISSIBILITY = auto()
    STABILITY = auto()


@dataclass(frozen=True)
class OrbitJudgement:
    """The judgement on a contact by an orbit.

    The model is good enough if its orbit agrees with the exact one in existence, admissibility and
    stability, and if it deviates from the contact in the quantity that is needed by the tolerance
    at most.
    """

    family: ComparedOrbit
    needed: Needed

    @property
    def disagreement(self) -> Disagreement | None:
        """The first disagreement of the restitution model's orbit with the exact one."""
        exact = self.family
        simple = exact.standing["restitution"]
        if exact.exists != simple.exists:
            return Disagreement.EXISTENCE
        if exact.is_admissible != simple.is_admissible:
            return Disagreement.ADMISSIBILITY
        return Disagreement.STABILITY if exact.is_stable != simple.is_stable else None

    @property
    def error(self) -> float | None:
        """The deviation of the restitution model; None without a value to compare."""
        return self.family.errors[self.needed.quantity]

    @property
    def corrected_error(self) -> float | None:
        """The deviation of the corrected restitution model; None without a value to compare."""
        return self.family.corrected_errors[self.needed.quantity]

    @property
    def is_known(self) -> bool:
        """Whether the orbits disagree, or both have a value to compare."""
        return self.disagreement is not None or self.error is not None

    @property
    def is_good_enough(self) -> bool:
        """Whether the restitution model is good enough."""
        error = self.error
        within = error is not None and abs(error) <= self.needed.tolerance
        return self.disagreement is None and within

    @property
    def is_corrected_model_good_enough(self) -> bool:
        """Whether the corrected restitution model is good enough, but for its admissibility."""
        exact = self.family
        corrected = exact.standing["corrected"]
        same = (exact.exists, exact.is_stable) == (corrected.exists, corrected.is_stable)
        error = self.corrected_error
        return same and error is not None and abs(error) <= self.needed.tolerance


class Basis(Enum):
    """What decides about the motion on which a ball ends."""

    BOTH_REST = auto()
    KINDS = auto()
    """The kinds of motion differ, and no mean makes them alike."""
    LIFT_OFF = auto()
    """The ball rests on the contact, and leaves the table in the restitution model."""
    GREATEST_HEIGHT = auto()
    MEANS = auto()
    CHANGES = auto()
    """Changes of r, k and g by a thousandth decide whether the means are within the tolerance."""
    NOTHING = auto()
    """There are no means, because some balls come to rest."""


class SensitiveMean(NamedTuple):
    """The mean that small changes decide about, and the ends of its deviations with them."""

    name: str
    low: float
    high: float


@dataclass(frozen=True)
class MotionJudgement:
    """The judgement on a contact by the motion on which a ball ends.

    Parameters
    ----------
    motion : FinalMotion
    tolerance : float
    n : int
        The family of the orbit on which no ball stays, or few balls end.
    share : float, optional
        The share of the starts that end on this orbit, if it is stable.
    amplitude : float, optional
        Λ. With it, a contact on which the ball rests is told from the restitution model, in which
        no ball rests above Λ = 1, also if its motion is undecided.
    basis : Basis
    least, most : float
        Bounds of the modulus of the deviation that decides.
    spread : SensitiveMean, optional
        The mean that small changes decide about.
    """

    motion: FinalMotion
    tolerance: float
    n: int
    share: float | None = None
    amplitude: float | None = None
    basis: Basis = Basis.NOTHING
    least: float = 0.0
    most: float = 0.0
    spread: SensitiveMean | None = None

    @property
    def is_decided(self) -> bool:
        """Whether the restitution model is known to be good enough or not to be."""
        if self.basis in (Basis.GREATEST_HEIGHT, Basis.MEANS):
            return self.most <= self.tolerance or self.least > self.tolerance
        return self.basis not in (Basis.CHANGES, Basis.NOTHING)

    @property
    def is_good_enough(self) -> bool:
        """Whether the restitution model is good enough."""
        if self.basis in (Basis.GREATEST_HEIGHT, Basis.MEANS):
            return self.most <= self.tolerance
        return self.basis is Basis.BOTH_REST


def judged_by_motion(
    motion: FinalMotion,
    tolerance: float,
    n: int,
    share: float | None = None,
    amplitude: float | None = None,
) -> MotionJudgement:
    """The judgement by the motion on which a ball ends, if the orbit is not stable, or if only a
    small share of the starts ends on it. The arguments are those of :class:`MotionJudgement`.
    """
    found = MotionJudgement(motion, tolerance, n, share, amplitude)
    if (basis := _by_kind(found)) is not None:
        return replace(found, basis=basis)
    if motion.greatest is not None:
        true, predicted = motion.greatest.values()
        error = abs(float(deviation(exact=true, simple=predicted)))
        return replace(found, basis=Basis.GREATEST_HEIGHT, least=error, most=error)
    if motion.mean_error is None:
        return found
    spread = _by_change(motion.mean_error, motion.changes or {}, tolerance)
    if spread is not None:
        return replace(found, basis=Basis.CHANGES, spread=spread)
    errors = motion.mean_error.values()
    return replace(
        found,
        basis=Basis.MEANS,
        least=max(abs(error.value) - error.half_width for error in errors),
        most=max(abs(error.value) + error.half_width for error in errors),
    )


def _by_kind(judged: MotionJudgement) -> Basis | None:
    """The basis of the judgement if the kinds of the motions decide; otherwise None."""
    motion = judged.motion
    exact = motion.kind
    simple = motion.restitution_kind
    if exact == simple == Kind.PERMANENT_CONTACT:
        return Basis.BOTH_REST
    # Locked and chaotic motions may be alike in the mean, but other kinds that differ are not. An
    # undecided motion may be of any kind, but is not the n-T orbit, on which no ball stays.
    on_orbit = simple == Kind.ORBIT and motion.restitution_periods == judged.n
    known = on_orbit or Kind.UNDECIDED not in (exact, simple)
    distinct = {Kind.PERMANENT_CONTACT, Kind.ORBIT, Kind.SUBHARMONIC}
    if exact != simple and known and {exact, simple} & distinct:
        return Basis.KINDS
    leaves = judged.amplitude is not None and judged.amplitude > RESTITUTION_THRESHOLD
    return Basis.LIFT_OFF if exact == Kind.PERMANENT_CONTACT and leaves else None


# Five samples of one mean have intervals so much wider that do not meet in one of a hundred cases.
_WIDER = 1.25


def _by_change(
    errors: Mapping[str, Mean], changes: Mapping[str, Mapping[str, Mean]], tolerance: float
) -> SensitiveMean | None:
    """The first mean about whose error a change of a thousandth decides; None if there is none."""
    for name, error in errors.items():
        found = [error, *_with_changes(error, {k: of[name] for k, of in changes.items()})]
        lows = [one.value - _WIDER * one.half_width for one in found]
        highs = [one.value + _WIDER * one.half_width for one in found]
        if max(lows) <= min(highs):
            continue
        sizes = [
            (max(low, -high, 0.0), max(abs(low), abs(high)))
            for low, high in zip(lows, highs, strict=True)
        ]
        apart = any(most <= tolerance for _, most in sizes) and any(
            least > tolerance for least, _ in sizes
        )
        if apart or max(lows) > 0 > min(highs):
            return SensitiveMean(name, min(lows), max(highs))
    return None


def _with_changes(error: Mean, changes: Mapping[str, Mean]) -> list[Mean]:
    """The errors with small changes; for a law whose changes are those of the linear contact in its
    place, the error of the law plus each change of the linear contact's error.
    """
    base = changes.get(NO_CHANGE)
    if base is None:
        return list(changes.values())
    return [
        Mean(
            error.value + one.value - base.value,
            math.hypot(error.half_width, one.half_width, base.half_width),
        )
        for name, one in changes.items()
        if name != NO_CHANGE
    ]
