"""The sentences on the motion of a ball, and the verdict on it where the orbit is not judged."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from bouncing_ball.contacts.families import ComparedOrbit, prediction_error
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
    Kind.ALOFT: "does not touch the table again",
    Kind.UNDECIDED: "shows no periodic motion and is not known to be chaotic",
}
# The same for a ball that is laid on the table.
_LAID = {**_DOES, Kind.PERMANENT_CONTACT: "stays at rest"}


class Judgement(NamedTuple):
    """Whether the restitution model is good enough, this verdict as a sentence, and the reason."""

    is_good_enough: bool
    verdict: str
    reason: str


def judged_by_motion(
    motion: FinalMotion,
    tolerance: float,
    n: int,
    share: float | None = None,
    amplitude: float | None = None,
) -> Judgement:
    """The verdict on the motion on which a ball ends, if the orbit is not stable, or if only a
    small share of the starts ends on it.

    With the excitation ``amplitude``, a contact on which the ball rests is told from the
    restitution model, in which no ball rests above Λ = 1, also if its motion is undecided.
    """
    about = f"no ball stays on the {n}-T orbit, so that its errors are not judged"
    if share is not None:
        ends = f"{shown(share, '%')} of the starts end" if share else "no start ends"
        about = f"{ends} on the stable {n}-T orbit, so that its errors are not judged"
    exact = motion.kind
    simple = motion.restitution_kind
    if exact == simple == Kind.PERMANENT_CONTACT:
        sentence = "The restitution model is good enough: the ball rests in both models."
        return Judgement(True, sentence, about)
    # Locked and chaotic motions may be alike in the mean, but other kinds that differ are not. An
    # undecided motion may be of any kind, but is not the n-T orbit, on which no ball stays.
    on_orbit = simple == Kind.ORBIT and motion.restitution_periods == n
    known = on_orbit or Kind.UNDECIDED not in (exact, simple)
    distinct = {Kind.PERMANENT_CONTACT, Kind.ORBIT, Kind.SUBHARMONIC}
    if exact != simple and known and {exact, simple} & distinct:
        sentence = f"its motion is {_named(simple)}, and the contact's is {_named(exact)}"
        return Judgement(False, f"The restitution model is not good enough: {sentence}.", about)
    leaves = amplitude is not None and amplitude > RESTITUTION_THRESHOLD
    if exact == Kind.PERMANENT_CONTACT and leaves:
        sentence = f"its ball leaves the table again and again, as Λ = {amplitude:.4g} is above 1"
        both = f"{sentence}, and that of the contact rests"
        return Judgement(False, f"The restitution model is not good enough: {both}.", about)
    if motion.greatest is not None:
        true, predicted = motion.greatest.values()
        error = float(prediction_error(predicted, true))
        both = in_place_of(predicted, true, "m")
        found = f"for the greatest height of this motion it predicts {both}, {signed(error)}"
        return _within(abs(error), abs(error), tolerance, found, about)
    if motion.mean_error is None:
        sentence = "Whether the restitution model is good enough for this motion is not known."
        return Judgement(False, sentence, f"{about}; nor are means, as some balls come to rest")
    means = {"height": motion.mean_height, "power": motion.mean_power}
    found = "it predicts " + " and ".join(
        _of_mean(name, means[name], error) for name, error in motion.mean_error.items()
    )
    errors = motion.mean_error.values()
    least = max(abs(error.value) - error.half_width for error in errors)
    most = max(abs(error.value) + error.half_width for error in errors)
    why = f"{about}; means over time are compared, of the height above the table's middle and of "
    why += "the power that the table transfers; ± is of sampling alone"
    if motion.changes is None and Kind.CHAOTIC in (exact, simple):
        why += "; what changes of 0.1 % in r, k and g do is not known"
    if motion.changes:
        why += f"; {_said_of(motion.changes)}"
        if decided := _by_change(motion, tolerance):
            return decided._replace(reason=why)
    return _within(least, most, tolerance, found, why, _larger_sample(motion, tolerance))


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


# Five samples of one mean have intervals so much wider that do not meet in one of a hundred cases.
_WIDER = 1.25


def _by_change(motion: FinalMotion, tolerance: float) -> Judgement | None:
    """The verdict if a change of a thousandth decides about the error; otherwise None."""
    assert motion.mean_error is not None and motion.changes is not None
    for name, error in motion.mean_error.items():
        found = [error, *_with_changes(error, {k: of[name] for k, of in motion.changes.items()})]
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
            ends = f"{100 * min(lows):+.2g} % to {100 * max(highs):+.2g} %"
            of = f" with the changes {_OF_LINEAR}" if NO_CHANGE in motion.changes else ""
            sentence = (
                f"Whether the restitution model is good enough at {percent(tolerance)} is decided "
                f"by changes of 0.1 % in r, k or g: its mean {name} is off by {ends}{of}."
            )
            return Judgement(False, sentence, "")
    return None


def _with_changes(error: Mean, changes: Mapping[str, Mean]) -> list[Mean]:
    """The errors with small changes: for a law its own, changed as that of the linear contact."""
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
            f"the sample of {motion.balls} balls is too small to decide, and so is any up to "
            f"{MOST_BALLS.high}: the error is next to the tolerance"
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


def _within(
    least: float, most: float, tolerance: float, found: str, why: str, undecided: str = ""
) -> Judgement:
    """The verdict on a largest error between two bounds, against a tolerance.

    ``undecided`` says what helps if the tolerance lies between the bounds.
    """
    asked = percent(tolerance)
    if most <= tolerance:
        return Judgement(
            True, f"The restitution model is good enough: {found}, within {asked}.", why
        )
    if least > tolerance:
        sentence = f"The restitution model is not good enough: {found}, beyond {asked}."
        return Judgement(False, sentence, why)
    sentence = f"Whether the restitution model is good enough is not decided at {asked}: {found}."
    return Judgement(False, sentence, f"{why}; {undecided}")


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
