"""The answer in one sentence, and why."""

from typing import NamedTuple

from bouncing_ball.calculator.family import Family
from bouncing_ball.calculator.needed import Needed
from bouncing_ball.orbits.stability import Bifurcation

QUANTITIES = {
    "max_height": "greatest height",
    "bounce_velocity": "bouncing-off velocity",
    "phase": "phase of impact",
    "apparent_restitution": "apparent restitution",
    "saddle_node": str(Bifurcation.SADDLE_NODE),
    "period_doubling": str(Bifurcation.PERIOD_DOUBLING),
    "permanent_contact": "threshold of permanent contact",
}
"""The quantities as a sentence calls them."""


class Judgement(NamedTuple):
    """Whether the restitution model is good enough, in one sentence, and the reason."""

    is_good_enough: bool
    sentence: str
    reason: str


def percent(share: float) -> str:
    """A share in percent, two digits; what is very little as such.

    Examples
    --------
    >>> percent(0.0123), percent(2.5e-5), percent(1e-9), percent(0.996)
    ('1.2 %', '0.0025 %', 'less than 0.001 %', '100 %')
    """
    if 0 < share < 1e-5:
        return "less than 0.001 %"
    return f"{100 * share:.2g} %" if share < 0.995 else f"{100 * share:.0f} %"


def _disagreement(family: Family) -> str | None:
    """What the restitution model says of the orbit that is not so, before any number."""
    exact, simple = next(iter(family.standing.values())), family.standing["restitution"]
    orbit = f"{family.n}-T orbit"
    if exact.exists != simple.exists:
        missed = f"it misses the {orbit}, which the contact has"
        return missed if exact.exists else f"it has the {orbit}, which the contact has not"
    for name, word in (("is_admissible", "free of other impacts"), ("is_stable", "stable")):
        real, claimed = getattr(exact, name), getattr(simple, name)
        if real != claimed:
            own, other = ("is", "is not") if claimed else ("is not", "is")
            return f"its {orbit} {own} {word}, and the contact's {other}"
    return None


def assess(family: Family, needed: Needed, frequency_ratio: float) -> Judgement:
    """The verdict on a given contact."""
    name, tolerance = QUANTITIES[needed.quantity], percent(needed.tolerance)
    found = family.errors[needed.quantity]
    wrong = _disagreement(family)
    good = wrong is None and found is not None and found <= needed.tolerance
    own = "" if needed.quantity == "permanent_contact" else f" of the {family.n}-T orbit"
    subject = f"the {name}{own}"
    if good:
        sentence = (
            f"The restitution model is good enough: {subject} is {percent(found or 0.0)} off, "
            f"within {tolerance}."
        )
    else:
        if wrong is None and found is None:
            sentence = f"Whether the restitution model is good enough in {subject} is not known."
            return Judgement(False, sentence, "this contact, or the model, has no value to compare")
        what = wrong or f"{subject} is {percent(found or 0.0)} off, beyond {tolerance}"
        sentence = f"The restitution model is not good enough: {what}{_instead(family, needed)}."
    return Judgement(good, sentence, _reason(needed, frequency_ratio, good, tolerance))


def _instead(family: Family, needed: Needed) -> str:
    """Whether the corrected model will do."""
    found = family.corrected_errors[needed.quantity]
    exact, corrected = next(iter(family.standing.values())), family.standing["corrected"]
    same = (exact.exists, exact.is_stable) == (corrected.exists, corrected.is_stable)
    if same and found is not None and found <= needed.tolerance:
        return f"; the corrected restitution model is, with {percent(found)}"
    return "; nor is the corrected one: simulate the contact"


def _reason(needed: Needed, frequency_ratio: float, good: bool, tolerance: str) -> str:
    """The contact's ϖ against the one that the tolerance needs."""
    if needed.frequency_ratio is None:
        return f"the error is {needed.status}"
    place = "above" if frequency_ratio >= needed.frequency_ratio else "below"
    text = (
        f"the contact's frequency ratio ϖ = {frequency_ratio:.4g} is {place} the "
        f"ϖ = {needed.frequency_ratio:.4g} from which on the error stays within {tolerance}"
    )
    if good and place == "below":
        text += ": that it is small here is an accident of its passing through zero"
    return text
