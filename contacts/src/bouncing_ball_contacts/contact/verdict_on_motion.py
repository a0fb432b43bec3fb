"""The sentences on the motion of a ball, and on the judgement of a contact by this motion."""

from collections.abc import Mapping
from typing import NamedTuple

from bouncing_ball.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.motions.motions import Kind
from bouncing_ball_contacts.contact.families import ComparedOrbit
from bouncing_ball_contacts.contact.judgement import Basis, MotionJudgement
from bouncing_ball_contacts.contact.motion import FinalMotion
from bouncing_ball_contacts.contact.starts import FEW
from bouncing_ball_contacts.contact.texts import in_place_of, percent, shown, signed

# What a ball does that starts near an orbit, by the kind of the motion on which it ends.
_DOES: Mapping[str, str] = {
    Kind.ORBIT: "settles on a periodic orbit, which repeats",
    Kind.SUBHARMONIC: "settles on a subharmonic orbit, which repeats",
    Kind.LOCKED: "settles on a locked motion, which sticks to the table and repeats",
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


def said_of_motion(judged: MotionJudgement) -> Sentences:
    """The judgement on the motion on which a ball ends, in words."""
    return Sentences(_verdict(judged), _reason(judged))


def _verdict(judged: MotionJudgement) -> str:
    if not judged.is_decided:
        return "Whether the restitution model is good enough for this motion is not known."
    found = _found(judged)
    if judged.basis is Basis.GREATEST_HEIGHT:
        asked = percent(judged.tolerance)
        found += f", {'within' if judged.is_good_enough else 'beyond'} {asked}"
    enough = "good enough" if judged.is_good_enough else "not good enough"
    return f"The restitution model is {enough}: {found}."


def _found(judged: MotionJudgement) -> str:
    """A clause on what was found in both models."""
    motion = judged.motion
    if judged.basis is Basis.BOTH_REST:
        return "the ball rests in both models"
    if judged.basis is Basis.KINDS:
        both = _named(motion.restitution_kind), _named(motion.kind)
        return f"its motion is {both[0]}, and the contact's is {both[1]}"
    if judged.basis is Basis.LIFT_OFF:
        return (
            f"its ball leaves the table again and again, as Λ = {judged.amplitude:.4g} is above 1, "
            "and that of the contact rests"
        )
    assert motion.greatest is not None
    true, predicted = motion.greatest.values()
    both_heights = in_place_of(predicted, true, "m")
    off = signed(judged.error)
    return f"for the greatest height of this motion it predicts {both_heights}, {off}"


def _reason(judged: MotionJudgement) -> str:
    n = judged.n
    about = f"no ball stays on the {n}-T orbit, so that its errors are not judged"
    if (share := judged.share) is not None:
        ends = f"{shown(share, '%')} of the starts end" if share else "no start ends"
        about = f"{ends} on the stable {n}-T orbit, so that its errors are not judged"
    if judged.is_decided:
        return about
    return f"{about}; nor is this motion, which is not known to repeat in both models"


def _named(kind: str | None) -> str:
    words: dict[str | None, str] = {Kind.ORBIT: "periodic", Kind.SUBHARMONIC: "subharmonic"}
    return words.get(kind, str(kind))


def aside(motion: FinalMotion, amplitude: float) -> str:
    """A clause that follows the verdict on the orbit if a ball laid on the table ends elsewhere."""
    rests = motion.laid == Kind.PERMANENT_CONTACT and amplitude <= RESTITUTION_THRESHOLD
    if motion.laid is None or rests:
        return ""
    return f"; a ball laid on the table {_LAID[motion.laid]}, and is not judged"


def _common(motion: FinalMotion) -> str:
    """A clause on the motion on which most balls end."""
    does = f"such a ball {_DOES[motion.kind]}"
    if motion.periods > 1 and motion.kind != Kind.PERMANENT_CONTACT:
        does += f" after {motion.periods} periods of the table and {motion.impacts} impacts"
    return does


def headline(motion: FinalMotion, family: ComparedOrbit, share: float = 1.0) -> str:
    """The motion of the ball, in one sentence; ``share`` is that of the starts on a stable orbit.

    An orbit that few balls reach is the headline only if its family was asked for.
    """
    orbit = f"{family.n}-T orbit"
    if motion.kind == Kind.ORBIT and motion.restitution_kind is None:
        said = f"The {orbit} is stable: a ball on it stays on it."
        if share < FEW:
            ends = f"only {shown(share, '%')} of the starts end" if share else "no start ends"
            said = f"{said[:-1]}, but {ends} on it."
        if motion.laid is None:
            return said
        return f"{said} A ball laid on the table {_LAID[motion.laid]}."
    if motion.restitution_kind is None:
        return f"A ball near the {orbit} stays near it, because the contact loses no energy."
    none = not any(each.exists for each in family.standing.values())
    if motion.is_common:
        return f"Most balls end otherwise than on the stable {orbit}: {_common(motion)}."
    does = (_LAID if motion.is_laid else _DOES)[motion.kind]
    if motion.periods > 1 and motion.kind != Kind.PERMANENT_CONTACT:
        does += f" after {motion.periods} periods of the table and {motion.impacts} impacts"
    why = "not stable" if family.is_admissible else "not admissible"
    if none:
        return f"No model has an n-T orbit. A ball laid on the table {does}."
    if motion.is_laid:
        said = f"The {orbit} is {why}" if family.exists else f"The contact has no {orbit}"
        return f"{said}. A ball laid on the table {does}."
    if not family.exists:
        return f"The contact has no {orbit}. A ball that starts as on such an orbit {does}."
    return f"The {orbit} is {why}. A ball that starts near it {does}."
