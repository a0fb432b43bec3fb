"""The sentences on the judgement of a contact by an orbit, and on a contact that was chosen.

The error in a sentence is the deviation of a model from the contact, relative to the value on the
contact (:func:`~bouncing_ball_beyond.accuracy.errors.deviation`).
"""

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.accuracy.errors import QUANTITIES
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.contact.families import ComparedOrbit
from bouncing_ball_contacts.contact.judgement import Disagreement, OrbitJudgement
from bouncing_ball_contacts.contact.needed import NO_ORBIT, Needed
from bouncing_ball_contacts.contact.resolved import ResolvedContact
from bouncing_ball_contacts.contact.texts import in_place_of, percent, shown, signed
from bouncing_ball_contacts.contact.verdict_on_motion import Sentences

_UNITS = {Quantity.MAX_HEIGHT: "m", Quantity.BOUNCE_VELOCITY: "m/s"}
_NO_CROSSING = {
    ThresholdStatus.ALWAYS_WITHIN: "the error is within the tolerance at every ϖ scanned",
    ThresholdStatus.NEVER_WITHIN: "the error is outside the tolerance at the largest ϖ scanned",
    NO_ORBIT: "the restitution model has no such orbit",
}


def _subject(quantity: str, n: int) -> str:
    of_family = "" if quantity == Quantity.PERMANENT_CONTACT else f" of the {n}-T orbit"
    return f"the {QUANTITIES[Quantity(quantity)]}{of_family}"


def _in_words(judged: OrbitJudgement) -> str | None:
    """A clause on the disagreement of the restitution model's orbit with the exact one."""
    simple = judged.family.standing["restitution"]
    orbit = f"{judged.family.n}-T orbit"
    if judged.disagreement is Disagreement.EXISTENCE:
        missed = f"it misses the {orbit}, which the contact has"
        return missed if judged.family.exists else f"it has the {orbit}, which the contact has not"
    if judged.disagreement is Disagreement.ADMISSIBILITY:
        return _opposite(orbit, "free of other impacts", simple.is_admissible)
    if judged.disagreement is Disagreement.STABILITY:
        return _opposite(orbit, "stable", simple.is_stable)
    return None


def _opposite(orbit: str, word: str, of_model: bool) -> str:
    """A clause that the orbit of only one of the two, the model and the contact, is ``word``."""
    if of_model:
        return f"its {orbit} is {word}, and the contact's is not"
    return f"its {orbit} is not {word}, and the contact's is"


def said_of_orbit(
    judged: OrbitJudgement, linear: SpringDamper, law: ContactLaw | None = None
) -> Sentences:
    """The judgement on a contact by an orbit, in words; the contact is ``linear``, or of another
    ``law`` with the same r and duration.
    """
    needed = judged.needed
    tolerance = percent(needed.tolerance)
    if not judged.is_known:
        name = QUANTITIES[Quantity(needed.quantity)]
        sentence = f"Whether the restitution model is good enough in the {name} is not known."
        return Sentences(sentence, "the contact or the model has no value to compare")
    reason = _reason(judged, linear, tolerance, law)
    if judged.is_good_enough:
        found = _prediction(judged.family, needed)
        return Sentences(
            f"The restitution model is good enough: {found}, within {tolerance}.", reason
        )
    why = _in_words(judged) or f"{_prediction(judged.family, needed)}, beyond {tolerance}"
    return Sentences(f"The restitution model is not good enough: {why}{_instead(judged)}.", reason)


def _prediction(family: ComparedOrbit, needed: Needed) -> str:
    """A clause with the values of a quantity in the restitution model and on the contact, and the
    deviation of the model.
    """
    exact, predicted, *_ = family.values[needed.quantity].values()
    both = in_place_of(predicted, exact, _UNITS.get(Quantity(needed.quantity), ""))
    size = signed(family.errors[needed.quantity], needed.tolerance)
    return f"for {_subject(needed.quantity, family.n)} it predicts {both}, {size}"


def _instead(judged: OrbitJudgement) -> str:
    """A clause on whether the corrected model is good enough instead."""
    if judged.is_corrected_model_good_enough:
        size = signed(judged.corrected_error, judged.needed.tolerance)
        return f"; the corrected restitution model is good enough: its error is {size}"
    return "; nor is the corrected one: simulate the contact"


def _reason(
    judged: OrbitJudgement, linear: SpringDamper, tolerance: str, law: ContactLaw | None
) -> str:
    """A clause that compares the ϖ of the contact with the ϖ that the tolerance needs.

    That ϖ is one of linear contacts, so that it is no reason for a verdict on another law.
    """
    needed = judged.needed
    frequency_ratio = float(linear.frequency_ratio)
    if law is not None:
        text = f"both values are computed, that of the contact with the {law.name} law itself"
        if needed.frequency_ratio is None:
            return text
        return (
            f"{text}; of linear contacts with the {linear.release} release, those from "
            f"ϖ = {needed.frequency_ratio:.4g} on are within "
            f"{tolerance}, and that with its r and duration has ϖ = {frequency_ratio:.4g}"
        )
    if needed.frequency_ratio is None:
        return _NO_CROSSING[needed.status]
    place = "above" if frequency_ratio >= needed.frequency_ratio else "below"
    text = (
        f"the contact's frequency ratio ϖ = {frequency_ratio:.4g} is {place} the "
        f"ϖ = {needed.frequency_ratio:.4g} from which on the error stays within {tolerance}"
    )
    if judged.is_good_enough and place == "below":
        text += "; it is small here only because it passes through zero near this ϖ"
    return text


def judged_choice(case: ResolvedContact, needed: Needed, n: int) -> Sentences:
    """The most compliant contact within the tolerance, in words."""
    tolerance = percent(needed.tolerance)
    if not case.is_spring_damper:
        sentence = (
            f"A simulation needs a {case.law.name} contact whose free impact, at the speed of the "
            f"{n}-T orbit, takes {shown(case.contact_time, 's')} or less: the restitution model "
            f"then predicts {_subject(needed.quantity, n)} within {tolerance}."
        )
        why = f"the error of this contact is {tolerance}, and near it grows with the duration"
        return Sentences(sentence, why)
    sentence = (
        f"A simulation needs a contact of at least {shown(case.stiffness, 'N/m')}, with a contact "
        f"time of {shown(case.contact_time, 's')} or less and a damping of "
        f"{shown(case.damping, 'N s/m')} at that stiffness: the restitution model then predicts "
        f"{_subject(needed.quantity, n)} within {tolerance}."
    )
    if needed.frequency_ratio is None:
        return Sentences(sentence, _NO_CROSSING[needed.status])
    where = f"at the frequency ratio ϖ = {needed.frequency_ratio:.4g}"
    return Sentences(sentence, f"the error crosses {tolerance} for the last time {where}")
