"""The sentences on the motion of a ball, and on the judgement of a contact by this motion."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from bouncing_ball.accuracy.errors import deviation
from bouncing_ball.contacts.families import ComparedOrbit
from bouncing_ball.contacts.judgement import Basis, MotionJudgement
from bouncing_ball.contacts.means import NO_CHANGE, Mean
from bouncing_ball.contacts.motion import FinalMotion
from bouncing_ball.contacts.question import MOST_BALLS
from bouncing_ball.contacts.starts import FEW
from bouncing_ball.contacts.texts import in_place_of, percent, shown, signed
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.permanent_contact import RESTITUTION_THRESHOLD

# Units of the means over time.
_OF_MEANS = {"height": "m", "power": "W"}

# What a ball does that starts near an orbit, by the kind of the motion on which it ends.
_DOES: Mapping[str, str] = {
    Kind.ORBIT: "settles on a periodic orbit, which repeats",
    Kind.SUBHARMONIC: "settles on a doubled orbit, which repeats",
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
    asked = percent(judged.tolerance)
    if judged.basis is Basis.NOTHING:
        return "Whether the restitution model is good enough for this motion is not known."
    if judged.spread is not None:
        name, low, high = judged.spread
        ends = f"{100 * low:+.2g} % to {100 * high:+.2g} %"
        of = f" with the changes {_OF_LINEAR}" if NO_CHANGE in (judged.motion.changes or {}) else ""
        return (
            f"Whether the restitution model is good enough at {asked} is decided by changes of "
            f"0.1 % in r, k or g: its mean {name} is off by {ends}{of}."
        )
    found = _found(judged)
    if not judged.is_decided:
        return f"Whether the restitution model is good enough is not decided at {asked}: {found}."
    if judged.basis in (Basis.GREATEST_HEIGHT, Basis.MEANS):
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
    if motion.greatest is not None:
        true, predicted = motion.greatest.values()
        off = signed(float(deviation(exact=true, simple=predicted)))
        both_heights = in_place_of(predicted, true, "m")
        return f"for the greatest height of this motion it predicts {both_heights}, {off}"
    means = {"height": motion.mean_height, "power": motion.mean_power}
    errors = (motion.mean_error or {}).items()
    return "it predicts " + " and ".join(_of_mean(name, means[name], x) for name, x in errors)


def _reason(judged: MotionJudgement) -> str:
    n = judged.n
    motion = judged.motion
    about = f"no ball stays on the {n}-T orbit, so that its errors are not judged"
    if (share := judged.share) is not None:
        ends = f"{shown(share, '%')} of the starts end" if share else "no start ends"
        about = f"{ends} on the stable {n}-T orbit, so that its errors are not judged"
    if judged.basis is Basis.NOTHING:
        return f"{about}; nor are means, as some balls come to rest"
    if judged.basis not in (Basis.MEANS, Basis.CHANGES):
        return about
    why = f"{about}; means over time are compared, of the height above the table's middle and of "
    why += "the power that the table transfers; ± is of sampling alone"
    if motion.changes is None and Kind.CHAOTIC in (motion.kind, motion.restitution_kind):
        why += "; what changes of 0.1 % in r, k and g do is not known"
    if motion.changes:
        why += f"; {_said_of(motion.changes)}"
    if judged.basis is Basis.MEANS and not judged.is_decided:
        why += f"; {_larger_sample(motion, judged.tolerance)}"
    return why


_OF_LINEAR = "of the linear contact with this r and duration"


def _said_of(changes: Mapping[str, Mapping[str, Mean]]) -> str:
    """What small changes of the contact and of gravity do to the error of the mean height."""
    heights = {name: of["height"] for name, of in changes.items()}
    parts = [
        f"{100 * one.value:+.2g} % ± {100 * one.half_width:.2g} % with {name}"
        for name, one in heights.items()
    ]
    of = f"{_OF_LINEAR}, " if NO_CHANGE in changes else ""
    return f"{of}from smaller samples the mean height is off by {', '.join(parts)}"


def _larger_sample(motion: FinalMotion, tolerance: float) -> str:
    """How many balls would decide, because an interval shrinks as the square root of their number.

    The number is rounded up to two digits.
    """
    assert motion.mean_error is not None and motion.balls is not None
    ends = (motion.kind, motion.periods), (motion.restitution_kind, motion.restitution_periods)
    if (Kind.LOCKED, 0) in ends:
        return (
            "no larger sample would decide, as rounding errors decide after which lap a ball locks"
        )
    shares = [
        error.half_width / abs(abs(error.value) - tolerance)
        for error in motion.mean_error.values()
        if error.half_width > abs(abs(error.value) - tolerance) > 0
    ]
    wanted = motion.balls * max(shares, default=2.0) ** 2
    if wanted > MOST_BALLS.high:
        return (
            f"the sample of {motion.balls} balls is too small to decide; as far as it tells, more "
            f"than {MOST_BALLS.high} are needed, because the error is next to the tolerance"
        )
    digits = 10 ** max(len(f"{wanted:.0f}") - 2, 0)
    enough = math.ceil(wanted / digits) * digits
    return (
        f"the sample of {motion.balls} balls is too small to decide; with balls = {enough} "
        f"(--balls {enough}) it should be large enough"
    )


def _named(kind: str | None) -> str:
    words: dict[str | None, str] = {Kind.ORBIT: "periodic", Kind.SUBHARMONIC: "doubled"}
    return words.get(kind, str(kind))


def _of_mean(name: str, of_models: Mapping[str, Mean | None] | None, error: Mean) -> str:
    """The mean of both models, and the error with its interval."""
    true, predicted = (mean for mean in (of_models or {}).values() if mean is not None)
    both = in_place_of(predicted.value, true.value, _OF_MEANS[name])
    return f"a mean {name} of {both}, {_between(error)}"


# A half-width below a hundredth of a per cent is not printed.
_UNSEEN = 1e-4


def _between(error: Mean) -> str:
    """An error with its interval, or its largest size where the interval contains zero."""
    size = abs(error.value)
    if error.half_width > size:
        return f"at most {shown(size + error.half_width, '%')} off"
    if error.half_width < _UNSEEN:
        return signed(error.value)
    # As many decimals as the first digit of the half-width has.
    decimals = max(-math.floor(math.log10(100 * error.half_width)), 0)
    return f"{100 * error.value:+.{decimals}f} % ± {100 * error.half_width:.{decimals}f} %"


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
