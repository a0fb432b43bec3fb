"""Whether the restitution model is good enough for a contact: the facts that decide it.

A contact is judged on a periodic orbit, or on the motion on which a ball ends if none stays on the
orbit. All errors are deviations of a model from the contact, relative to the value on the contact
(:func:`~bouncing_ball_beyond.accuracy.errors.deviation`). The sentences on these facts are in
:mod:`bouncing_ball_beyond.inherited.contacts.contact.verdict`.
"""

import math
from dataclasses import dataclass
from enum import Enum, auto

from bouncing_ball_beyond.accuracy.errors import deviation
from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion
from bouncing_ball_beyond.inherited.contacts.contact.needed import Needed
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.motions.motions import Kind


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
    """The kinds of motion differ."""
    LIFT_OFF = auto()
    """The ball rests on the contact, and leaves the table in the restitution model."""
    GREATEST_HEIGHT = auto()
    NOTHING = auto()
    """A motion is not known to repeat, so that it has no greatest height."""


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
    """

    motion: FinalMotion
    tolerance: float
    n: int
    share: float | None = None
    amplitude: float | None = None

    @property
    def basis(self) -> Basis:
        """What decides."""
        exact = self.motion.kind
        simple = self.motion.restitution_kind
        if exact == simple == Kind.PERMANENT_CONTACT:
            return Basis.BOTH_REST
        # A locked motion may be long and look chaotic, but other kinds that differ are not alike.
        # An undecided motion may be of any kind, but is not the n-T orbit, on which no ball stays.
        on_orbit = simple == Kind.ORBIT and self.motion.restitution_periods == self.n
        known = on_orbit or Kind.UNDECIDED not in (exact, simple)
        distinct = {Kind.PERMANENT_CONTACT, Kind.ORBIT, Kind.SUBHARMONIC}
        if exact != simple and known and {exact, simple} & distinct:
            return Basis.KINDS
        leaves = self.amplitude is not None and self.amplitude > RESTITUTION_THRESHOLD
        if exact == Kind.PERMANENT_CONTACT and leaves:
            return Basis.LIFT_OFF
        return Basis.NOTHING if self.motion.greatest is None else Basis.GREATEST_HEIGHT

    @property
    def error(self) -> float:
        """The deviation of the greatest height in the restitution model; NaN without one."""
        if self.motion.greatest is None:
            return math.nan
        true, predicted = self.motion.greatest.values()
        return float(deviation(exact=true, simple=predicted))

    @property
    def is_decided(self) -> bool:
        """Whether the restitution model is known to be good enough or not to be."""
        return self.basis is not Basis.NOTHING

    @property
    def is_good_enough(self) -> bool:
        """Whether the restitution model is good enough."""
        if self.basis is Basis.GREATEST_HEIGHT:
            return abs(self.error) <= self.tolerance
        return self.basis is Basis.BOTH_REST
