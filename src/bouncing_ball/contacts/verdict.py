"""The verdict on a contact on a periodic orbit, and its reason."""

from bouncing_ball.accuracy.errors import QUANTITIES, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.contacts.families import ComparedOrbit
from bouncing_ball.contacts.needed import NO_ORBIT, Needed
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.contacts.texts import in_place_of, percent, shown, signed
from bouncing_ball.contacts.verdict_on_motion import Judgement

_UNITS = {Quantity.MAX_HEIGHT: "m", Quantity.BOUNCE_VELOCITY: "m/s"}
_NO_CROSSING = {
    ThresholdStatus.ALWAYS_WITHIN: "the error is within the tolerance at every ϖ scanned",
    ThresholdStatus.NEVER_WITHIN: "the error is outside the tolerance at the largest ϖ scanned",
    NO_ORBIT: "the restitution model has no such orbit",
}


def _subject(quantity: str, n: int) -> str:
    of_family = "" if quantity == Quantity.PERMANENT_CONTACT else f" of the {n}-T orbit"
    return f"the {QUANTITIES[Quantity(quantity)]}{of_family}"


def _disagreement(family: ComparedOrbit) -> str | None:
    """The first qualitative disagreement between the restitution model's orbit and the exact one:
    in existence, admissibility or stability. None if they agree.
    """
    simple = family.standing["restitution"]
    orbit = f"{family.n}-T orbit"
    if family.exists != simple.exists:
        missed = f"it misses the {orbit}, which the contact has"
        return missed if family.exists else f"it has the {orbit}, which the contact has not"
    if family.is_admissible != simple.is_admissible:
        return _opposite(orbit, "free of other impacts", simple.is_admissible)
    if family.is_stable != simple.is_stable:
        return _opposite(orbit, "stable", simple.is_stable)
    return None


def _opposite(orbit: str, word: str, of_model: bool) -> str:
    """A clause that the orbit of only one of the two, the model and the contact, is ``word``."""
    if of_model:
        return f"its {orbit} is {word}, and the contact's is not"
    return f"its {orbit} is not {word}, and the contact's is"


def assessed(
    family: ComparedOrbit, needed: Needed, frequency_ratio: float, law: str | None = None
) -> Judgement:
    """The verdict on a given contact, which may be of another ``law`` than the linear one.

    The model is good enough if its orbit agrees with the exact one in existence, admissibility and
    stability, and if the error is within the tolerance.
    """
    tolerance = percent(needed.tolerance)
    error = family.errors[needed.quantity]
    wrong = _disagreement(family)
    if wrong is None and error is None:
        name = QUANTITIES[Quantity(needed.quantity)]
        sentence = f"Whether the restitution model is good enough in the {name} is not known."
        return Judgement(False, sentence, "the contact or the model has no value to compare")
    good = wrong is None and error is not None and abs(error) <= needed.tolerance
    reason = _reason(needed, frequency_ratio, good, tolerance, law)
    if good:
        found = _prediction(family, needed)
        sentence = f"The restitution model is good enough: {found}, within {tolerance}."
        return Judgement(True, sentence, reason)
    why = wrong or f"{_prediction(family, needed)}, beyond {tolerance}"
    instead = _instead(family, needed)
    return Judgement(False, f"The restitution model is not good enough: {why}{instead}.", reason)


def _prediction(family: ComparedOrbit, needed: Needed) -> str:
    """A clause with the values of a quantity in the restitution model and on the contact, and the
    error of the model.
    """
    exact, predicted, *_ = family.values[needed.quantity].values()
    both = in_place_of(predicted, exact, _UNITS.get(Quantity(needed.quantity), ""))
    size = signed(family.errors[needed.quantity], needed.tolerance)
    return f"for {_subject(needed.quantity, family.n)} it predicts {both}, {size}"


def _instead(family: ComparedOrbit, needed: Needed) -> str:
    """A clause on whether the corrected model is good enough instead."""
    error = family.corrected_errors[needed.quantity]
    corrected = family.standing["corrected"]
    same = (family.exists, family.is_stable) == (corrected.exists, corrected.is_stable)
    if same and error is not None and abs(error) <= needed.tolerance:
        size = signed(error, needed.tolerance)
        return f"; the corrected restitution model is good enough: its error is {size}"
    return "; nor is the corrected one: simulate the contact"


def _reason(
    needed: Needed, frequency_ratio: float, good: bool, tolerance: str, law: str | None
) -> str:
    """A clause that compares the ϖ of the contact with the ϖ that the tolerance needs.

    That ϖ is one of linear contacts, so that it is no reason for a verdict on another law.
    """
    if law is not None:
        text = f"both values are computed, that of the contact with the {law} law itself"
        if needed.frequency_ratio is None:
            return text
        return (
            f"{text}; of linear contacts those from ϖ = {needed.frequency_ratio:.4g} on are within "
            f"{tolerance}, and that with its r and duration has ϖ = {frequency_ratio:.4g}"
        )
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


def judged_choice(case: ResolvedContact, needed: Needed, n: int) -> Judgement:
    """The verdict on the most compliant contact within the tolerance."""
    tolerance = percent(needed.tolerance)
    if case.law is not None:
        sentence = (
            f"A simulation needs a {case.law.name} contact whose free impact, at the speed of the "
            f"{n}-T orbit, takes {shown(case.contact_time, 's')} or less: the restitution model "
            f"then predicts {_subject(needed.quantity, n)} within {tolerance}."
        )
        why = f"the error of this contact is {tolerance}, and near it grows with the duration"
        return Judgement(True, sentence, why)
    sentence = (
        f"A simulation needs a contact of at least {shown(case.stiffness, 'N/m')}, with a contact "
        f"time of {shown(case.contact_time, 's')} or less and a damping of "
        f"{shown(case.damping, 'N s/m')} at that stiffness: the restitution model then predicts "
        f"{_subject(needed.quantity, n)} within {tolerance}."
    )
    if needed.frequency_ratio is None:
        return Judgement(True, sentence, _NO_CROSSING[needed.status])
    where = f"at the frequency ratio ϖ = {needed.frequency_ratio:.4g}"
    return Judgement(True, sentence, f"the error crosses {tolerance} for the last time {where}")
