"""The verdict on the restitution model in one sentence, with the reason and further notes."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from bouncing_ball.beyond.calculator.case import Case
from bouncing_ball.beyond.calculator.families import NO_ORBIT
from bouncing_ball.beyond.calculator.results import Family, Motion, Needed
from bouncing_ball.beyond.calculator.units import percent, shown
from bouncing_ball.beyond.laws.hertzian import Tsuji
from bouncing_ball.beyond.laws.impedance import Impedance
from bouncing_ball.beyond.long_run.motions import Kind
from bouncing_ball.paper.comparison.errors import QUANTITIES, Quantity, modulus, relative
from bouncing_ball.paper.comparison.thresholds import ThresholdStatus
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel


class Verdict(NamedTuple):
    """Whether the restitution model is good enough, this verdict as a sentence, and the reason."""

    is_good_enough: bool
    verdict: str
    reason: str


_NO_CROSSING = {
    ThresholdStatus.ALWAYS_WITHIN: "the error is within the tolerance at every ϖ scanned",
    ThresholdStatus.NEVER_WITHIN: "the error is outside the tolerance at the largest ϖ scanned",
    NO_ORBIT: "the restitution model has no such orbit",
}


def _subject(quantity: str, n: int) -> str:
    of_family = "" if quantity == Quantity.PERMANENT_CONTACT else f" of the {n}-T orbit"
    return f"the {QUANTITIES[Quantity(quantity)]}{of_family}"


def _disagreement(family: Family) -> str | None:
    """The first qualitative disagreement between the restitution model's orbit and the exact one:
    in existence, admissibility or stability. None if they agree.
    """
    simple, orbit = family.standing["restitution"], f"{family.n}-T orbit"
    if family.exists != simple.exists:
        missed = f"it misses the {orbit}, which the contact has"
        return missed if family.exists else f"it has the {orbit}, which the contact has not"
    for name, word in (("is_admissible", "free of other impacts"), ("is_stable", "stable")):
        if getattr(family, name) != getattr(simple, name):
            own, other = ("is", "is not") if getattr(simple, name) else ("is not", "is")
            return f"its {orbit} {own} {word}, and the contact's {other}"
    return None


def assessed(family: Family, needed: Needed, frequency_ratio: float) -> Verdict:
    """The verdict on a given contact.

    The model is good enough if its orbit agrees with the exact one in existence, admissibility and
    stability, and if the error is within the tolerance.
    """
    tolerance, subject = percent(needed.tolerance), _subject(needed.quantity, family.n)
    error, wrong = family.errors[needed.quantity], _disagreement(family)
    if wrong is None and error is None:
        name = QUANTITIES[Quantity(needed.quantity)]
        sentence = f"Whether the restitution model is good enough in the {name} is not known."
        return Verdict(False, sentence, "the contact or the model has no value to compare")
    good = wrong is None and error is not None and error <= needed.tolerance
    found, place = shown(error, "%", needed.tolerance), "within" if good else "beyond"
    off = f"{subject} is {found} off, {place} {tolerance}"
    instead = _instead(family, needed)
    found = f"good enough: {off}" if good else f"not good enough: {wrong or off}{instead}"
    reason = _reason(needed, frequency_ratio, good, tolerance)
    return Verdict(good, f"The restitution model is {found}.", reason)


def judged_by_motion(motion: Motion, tolerance: float, n: int) -> Verdict:
    """The verdict on the motion on which a ball ends, if the orbit is not stable."""
    about = f"no ball stays on the {n}-T orbit, so that its errors are not judged"
    kinds = motion.kind, motion.restitution_kind
    if kinds == (Kind.PERMANENT_CONTACT,) * 2:
        sentence = "The restitution model is good enough: the ball rests in both models."
        return Verdict(True, sentence, about)
    # Locked and chaotic motions may be alike in the mean, but other kinds that differ are not. An
    # undecided motion may be of any kind, but is not the n-T orbit, on which no ball stays.
    on_orbit = kinds[1] == Kind.ORBIT and motion.restitution_periods == n
    different = len({*kinds}) > 1 and (on_orbit or Kind.UNDECIDED not in kinds)
    if different and {*kinds} & {Kind.PERMANENT_CONTACT, Kind.ORBIT, Kind.SUBHARMONIC}:
        sentence = f"its motion is {_named(kinds[1])}, and the contact's is {_named(kinds[0])}"
        return Verdict(False, f"The restitution model is not good enough: {sentence}.", about)
    if motion.greatest is not None:
        error = float(modulus(relative(*motion.greatest.values())))
        found = f"the greatest height of this motion is {shown(error, '%')} off"
        return _within(error, error, tolerance, found, about)
    if motion.mean_error is None:
        sentence = "Whether the restitution model is good enough for this motion is not known."
        return Verdict(False, sentence, f"{about}; nor are means, as some balls come to rest")
    errors = [(one.value, one.half_width, name) for name, one in motion.mean_error.items()]
    found = " and ".join(f"the mean {x} is {_between(e, h)} off" for e, h, x in errors)
    least, most = (max(e + sign * h for e, h, _ in errors) for sign in (-1, 1))
    return _within(least, most, tolerance, found, f"{about}; means over time are compared")


def _named(kind: str | None) -> str:
    words: dict[str | None, str] = {Kind.ORBIT: "periodic", Kind.SUBHARMONIC: "doubled"}
    return words.get(kind, str(kind))


def _between(e: float, h: float) -> str:
    return f"at most {shown(e + h, '%')}" if h > e else f"{shown(e, '%')} ± {shown(h, '%')}"


def _within(least: float, most: float, tolerance: float, found: str, why: str) -> Verdict:
    """The verdict on a largest error between two bounds, against a tolerance."""
    asked = percent(tolerance)
    if most <= tolerance:
        return Verdict(True, f"The restitution model is good enough: {found}, within {asked}.", why)
    if least > tolerance:
        sentence = f"The restitution model is not good enough: {found}, beyond {asked}."
        return Verdict(False, sentence, why)
    sentence = f"Whether the restitution model is good enough is not decided at {asked}: {found}."
    return Verdict(False, sentence, f"{why}; the sample is too small to decide")


def _instead(family: Family, needed: Needed) -> str:
    """A clause on whether the corrected model is good enough instead."""
    error, corrected = family.corrected_errors[needed.quantity], family.standing["corrected"]
    same = (family.exists, family.is_stable) == (corrected.exists, corrected.is_stable)
    if same and error is not None and error <= needed.tolerance:
        size = shown(error, "%", needed.tolerance)
        return f"; the corrected restitution model is good enough: its error is {size}"
    return "; nor is the corrected one: simulate the contact"


def _reason(needed: Needed, frequency_ratio: float, good: bool, tolerance: str) -> str:
    """A clause that compares the ϖ of the contact with the ϖ that the tolerance needs."""
    if needed.frequency_ratio is None:
        return _NO_CROSSING[needed.status]
    place = "above" if frequency_ratio >= needed.frequency_ratio else "below"
    text = (
        f"the contact's frequency ratio ϖ = {frequency_ratio:.4g} is {place} the "
        f"ϖ = {needed.frequency_ratio:.4g} from which on the error stays within {tolerance}"
    )
    if good and place == "below":
        text += "; it is small here only because it passes through zero near this ϖ"
    return text


def chosen(si: Mapping[str, float], needed: Needed, n: int) -> Verdict:
    """The verdict on the most compliant contact within the tolerance."""
    tolerance = percent(needed.tolerance)
    sentence = (
        f"A simulation needs a contact of at least {shown(si['stiffness'], 'N/m')}, with a contact "
        f"time of {shown(si['contact_time'], 's')} or less and a damping of "
        f"{shown(si['damping'], 'N s/m')} at that stiffness: {_subject(needed.quantity, n)} is "
        f"then within {tolerance} of the restitution model's."
    )
    if needed.frequency_ratio is None:
        return Verdict(True, sentence, _NO_CROSSING[needed.status])
    where = f"at the frequency ratio ϖ = {needed.frequency_ratio:.4g}"
    return Verdict(True, sentence, f"the error crosses {tolerance} for the last time {where}")


def _cost_of(law: Impedance, case: Case, family: Family) -> str:
    """A sentence on the change of the greatest height that an impedance causes."""
    about = "stiffness, damping, ϖ and ζ are those of the spring and damper of this solref"
    spring = SpringDamperModel(case.contact).orbit(family.n, case.table.amplitude)
    if family.greatest_compression is None or family.max_height is None or not spring.exists:
        return about
    depth = np.array(family.greatest_compression / case.table.length)
    off = float(relative(family.max_height, spring.max_height * case.table.length))
    return (
        f"{about}: at the orbit's depth of {shown(family.greatest_compression, 'm')}, where the "
        f"impedance is {float(law.impedance(depth)):.3g}, the ball bounces {shown(abs(off), '%')} "
        f"{'higher' if off > 0 else 'lower'} than with them"
    )


def notes(case: Case, family: Family, motion: Motion) -> tuple[str, ...]:
    """Sentences that a user should read in addition to the verdict."""
    found, contact, orbit = [], case.contact, f"{family.n}-T orbit"
    # The contact of a solref has the ϖ of its impedance, unlike one that was found for an impact.
    if isinstance(case.law, Impedance) and math.isclose(
        case.law.frequency_ratio, contact.frequency_ratio
    ):
        found.append(_cost_of(case.law, case, family))
    elif case.law is not None:
        hertz = isinstance(case.law, Tsuji)
        name = "Hertz contact with Tsuji's damping" if hertz else f"{case.law.name} contact"
        found.append(
            "stiffness, damping, ϖ and ζ, and the ϖ that is needed, are those of a linear contact: "
            f"it has the r of the {name}, and its duration at the impact"
        )
        if not np.all(case.has_its_restitution([family.n, family.n + 1])):
            found.append(
                "the restitution of this law depends on the speed: it is r at the speed of the "
                "restitution model's lowest stable orbit"
            )
    if math.isnan(case.permanent_contact):
        found.append(
            "no threshold of permanent contact was found, because the contact is weakly damped"
        )
    if not family.exists:
        found.append(f"at this Λ the contact has no {orbit}")
    elif motion.restitution_kind is not None:
        what = "unstable" if family.is_admissible else "inadmissible (an earlier impact occurs)"
        found.append(f"the {orbit} is {what}, so that no ball stays on it")
    if contact.frequency_ratio < 1:
        found.append("the contact is slower than the table: the ball oscillates on a spring")
    if case.law is None and contact.release is Release.DISPLACEMENT and contact.damping_ratio > 0:
        found.append(
            "before its release at δ = 0 the contact pulls the ball; a contact that cannot pull "
            "has the r of a release without force"
        )
    return tuple(found)
