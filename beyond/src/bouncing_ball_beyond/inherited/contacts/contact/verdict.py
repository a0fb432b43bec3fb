"""The sentences on the judgement of a contact, by an orbit or by the motion on which a ball ends,
and on a contact that was chosen; they are in ``templates/``.

The error in a sentence is the deviation of a model from the contact, relative to the value on the
contact (:func:`~bouncing_ball_beyond.accuracy.errors.deviation`).
"""

from collections.abc import Mapping
from typing import NamedTuple

from bouncing_ball_beyond.accuracy.errors import QUANTITIES
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit
from bouncing_ball_beyond.inherited.contacts.contact.judgement import (
    MotionJudgement,
    OrbitJudgement,
)
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion
from bouncing_ball_beyond.inherited.contacts.contact.needed import NO_ORBIT, Needed
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.starts import FEW
from bouncing_ball_beyond.inherited.contacts.contact.texts import lines
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.motions import Kind

_UNITS = {Quantity.MAX_HEIGHT: "m", Quantity.BOUNCE_VELOCITY: "m/s"}
_NO_CROSSING = {
    ThresholdStatus.ALWAYS_WITHIN: "the error is within the tolerance at every ϖ scanned",
    ThresholdStatus.NEVER_WITHIN: "the error is outside the tolerance at the largest ϖ scanned",
    NO_ORBIT: "the restitution model has no such orbit",
}
# What a ball does that starts near an orbit, by the kind of the motion on which it ends.
_DOES: Mapping[str, str] = {
    Kind.ORBIT: "settles on a periodic orbit, which repeats",
    Kind.SUBHARMONIC: "settles on a subharmonic orbit, which repeats",
    Kind.LOCKED: "settles on a motion that sticks to the table and repeats",
    Kind.PERMANENT_CONTACT: "comes to rest on the table",
    Kind.CHAOTIC: "ends in chaotic motion",
    Kind.UNDECIDED: "shows no periodic motion and is not known to be chaotic",
}
# The same for a ball that is laid on the table.
_LAID = {**_DOES, Kind.PERMANENT_CONTACT: "stays at rest"}


class Sentences(NamedTuple):
    """A judgement in words: the verdict as a sentence, and the reason as a clause."""

    verdict: str
    reason: str


def _subject(quantity: str, n: int) -> str:
    of_family = "" if quantity == Quantity.PERMANENT_CONTACT else f" of the {n}-T orbit"
    return f"the {QUANTITIES[Quantity(quantity)]}{of_family}"


def said_of_orbit(
    judged: OrbitJudgement, linear: SpringDamper, law: ContactLaw | None = None
) -> Sentences:
    """The judgement on a contact by an orbit, in words; the contact is ``linear``, or of another
    ``law`` with the same r and duration.

    The ϖ that the tolerance needs is one of linear contacts, so that it is no reason for a verdict
    on another law.
    """
    quantity = Quantity(judged.needed.quantity)
    found = lines(
        "orbit_verdict",
        judged=judged,
        linear=linear,
        law=law,
        quantity=QUANTITIES[quantity],
        subject=_subject(quantity, judged.family.n),
        unit=_UNITS.get(quantity, ""),
        no_crossing=_NO_CROSSING.get(judged.needed.status),
    )
    return Sentences(*found)


def judged_choice(case: ResolvedContact, needed: Needed, n: int) -> Sentences:
    """The most compliant contact within the tolerance, in words."""
    subject = _subject(needed.quantity, n)
    why = _NO_CROSSING.get(needed.status)
    found = lines("choice_verdict", case=case, need=needed, n=n, subject=subject, no_crossing=why)
    return Sentences(*found)


def said_of_motion(judged: MotionJudgement) -> Sentences:
    """The judgement on the motion on which a ball ends, in words."""
    return Sentences(*lines("motion_verdict", judged=judged))


def aside(motion: FinalMotion, amplitude: float) -> str:
    """A clause that follows the verdict on the orbit if a ball laid on the table ends elsewhere."""
    rests = motion.laid == Kind.PERMANENT_CONTACT and amplitude <= RESTITUTION_THRESHOLD
    if motion.laid is None or rests:
        return ""
    return f"; a ball laid on the table {_LAID[motion.laid]}, and is not judged"


def headline(motion: FinalMotion, family: ComparedOrbit, share: float = 1.0) -> str:
    """The motion of the ball, in one sentence; ``share`` is that of the starts on a stable orbit.

    An orbit that few balls reach is the headline only if its family was asked for.
    """
    of = {"of_started": _DOES, "of_laid": _LAID, "share": share, "few": FEW}
    (found,) = lines("headline", motion=motion, family=family, **of)
    return found
