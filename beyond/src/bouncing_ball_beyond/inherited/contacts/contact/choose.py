"""The second question: how stiff must a contact be for a restitution coefficient to be enough?

It is enough if the restitution model deviates from the contact by the tolerance at most, relative
to the value on the contact (:func:`~bouncing_ball_beyond.accuracy.errors.deviation`).
"""

import math
from dataclasses import dataclass, replace

from bouncing_ball_beyond.accuracy.errors import OF_ORBITS, QUANTITIES
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import RATIOS, ThresholdStatus
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.families import families
from bouncing_ball_beyond.inherited.contacts.contact.hertz import reduced_modulus
from bouncing_ball_beyond.inherited.contacts.contact.loss import of_loss
from bouncing_ball_beyond.inherited.contacts.contact.needed import Needed, needed
from bouncing_ball_beyond.inherited.contacts.contact.numbers_of_contact import NumbersOfImpact
from bouncing_ball_beyond.inherited.contacts.contact.quantities import check_kinds
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.remarks import remarks
from bouncing_ball_beyond.inherited.contacts.contact.resolve import first_stable_family, resolve
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.table import Table, TableMotion
from bouncing_ball_beyond.inherited.contacts.contact.texts import percent
from bouncing_ball_beyond.inherited.contacts.contact.verdict import judged_choice
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, suggesting
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

# The error falls as 1/ϖ or faster. A stiffness that is larger by a millionth therefore has it
# within the tolerance by half a millionth of this at least: more than the rounding errors of
# heights, 1e-15, for tolerances down to 1e-8.
_STIFFER = 1 + 1e-6


@dataclass(frozen=True, repr=False)
class Choice(NumbersOfImpact):
    """The most compliant contact whose restitution model is within a tolerance, in SI units.

    ``n`` is the family of the orbit, and ``needed`` the ϖ that the tolerance needs. As an argument
    of other calls it is ``contact``.
    """

    n: int
    needed: Needed
    case: ResolvedContact

    def __repr__(self) -> str:
        """The family and the contact with its units, in a sentence."""
        return f"Choice(n={self.n}, verdict={self.verdict!r})"

    @property
    def contact(self) -> Contact:
        """The contact that was given, with the stiffness that was chosen, or for another law the
        contact time, to be assessed or written.

        The error at ``stiffness`` is the tolerance up to rounding errors, which may be on either
        side of it. Here the stiffness is larger by a millionth, so that the error is within.
        """
        if self.case.is_spring_damper:
            return replace(self.case.given, stiffness=self.stiffness * _STIFFER)
        return replace(self.case.given, contact_time=self.contact_time)

    @property
    def verdict(self) -> str:
        """What a simulation needs, in one sentence."""
        return judged_choice(self.case, self.needed, self.n).verdict

    @property
    def reason(self) -> str:
        """Why no more compliant contact is enough."""
        return judged_choice(self.case, self.needed, self.n).reason

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how the contact was read."""
        return remarks(self.case)


@suggesting
def choose_contact(table: Table, contact: Contact, question: Question | None = None) -> Choice:
    """The most compliant contact for which the restitution model is within a tolerance.

    The tolerance is relative to the value on the contact, as that of
    :func:`bouncing_ball_beyond.inherited.contacts.assess_contact`.

    Parameters
    ----------
    table : Table
    contact : Contact
        With its mass and its loss, without a stiffness.
    question : Question, optional
        By default the greatest height within 1 %.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or gives the stiffness.
    NoOrbitError
        If the restitution model has no such orbit, or no contact is within the tolerance.

    Examples
    --------
    >>> table = Table(frequency="50 Hz", acceleration="1 g")
    >>> found = choose_contact(table, Contact(mass="20 g", restitution=0.65))
    >>> f"{found.stiffness:.4g} N/m, {found.contact_time:.3g} s", round(found.frequency_ratio, 2)
    ('1.36e+07 N/m, 0.000122 s', 83.0)

    It is assessed, or written for an engine, as ``found.contact``:

    >>> from bouncing_ball_beyond.inherited.contacts.contact.assess import assess_contact
    >>> assess_contact(table, found.contact).is_good_enough
    True
    """
    asked = Question() if question is None else question
    of = {"table": (table, Table), "contact": (contact, Contact), "question": (asked, Question)}
    check_kinds("choose_contact", **of)
    with table.hinting():
        return choose(contact, table.motion, asked)


def choose(
    contact: Contact, table: TableMotion, question: Question, written: str | None = None
) -> Choice:
    """The most compliant contact on a table, which may be written for the engine with this name.

    Raises
    ------
    ModelError, NoOrbitError
        See :func:`choose_contact`.
    """
    plain = contact.by_stiffness_and_loss(written)
    if plain.is_stiff:
        raise ParameterError("a contact with a stiffness is not chosen: leave its stiffness out")
    if plain.law_unless_spring_damper is not None:
        return _of_law(contact, plain.rule, table, question, written)
    # A radius alone is a Hertz contact whose modulus is missing.
    reduced_modulus(plain)
    if not plain.rule.is_linear:
        raise ParameterError(
            f"no contact is chosen with the release {plain.rule}, whose thresholds are not known: "
            "give {stiffness}"
        )

    def stiffness(zeta: float) -> tuple[float, tuple[SpringDamper, Needed]]:
        unit = SpringDamper(1.0, zeta, plain.rule)
        need = _needed(unit, table.amplitude, question)
        ratio = need.frequency_ratio or float(RATIOS[0])
        return ratio * table.angular_frequency, (SpringDamper(ratio, zeta, plain.rule), need)

    spring, need = of_loss(plain, table.gravity, stiffness)
    case = ResolvedContact(plain, table, spring, spring, given=contact, written=written)
    n = first_stable_family(question.families, float(spring.restitution), table.amplitude)
    return Choice(n, need, case)


# Steps of the search for the duration of a law, and how closely it is found.
_STEPS = 20
_CLOSE = 1e-4


def _of_law(
    contact: Contact, rule: Release, table: TableMotion, question: Question, written: str | None
) -> Choice:
    """The contact of a law whose free impact, at the speed of the orbit, is the longest one near
    that of the linear contact for which the restitution model is within the tolerance.

    The search answers how long an impact with this r may take;
    :func:`~bouncing_ball_beyond.inherited.contacts.contact.resolve.resolve` finds the law with this
    r and each duration. The error grows about as the duration: the secant method in logarithms
    needs a few steps.
    """
    measured = replace(contact.with_measured_restitution(), law=None, release=str(rule))
    linear = choose(replace(measured, radius=None), table, question)
    n = linear.n
    quantity = question.quantity

    def case_of(logarithm: float) -> ResolvedContact:
        one = replace(contact, contact_time=math.exp(logarithm))
        return resolve(one, table, [n], written)

    def surplus(logarithm: float) -> float:
        """ln |d/ε| of the deviation d, or that of a large one where the contact has no orbit."""
        try:
            (found,) = families(case_of(logarithm), [n])
        except NoOrbitError:
            return math.log(2)
        error = found.errors[quantity]
        if error is None:
            return math.log(2)
        return math.log(max(abs(error), 1e-12) / question.tolerance)

    place = math.log(linear.contact_time)
    value = surplus(place)
    slope = 1.0
    for _ in range(_STEPS):
        # The last step is one to the side on which the error is within the tolerance.
        if -_CLOSE <= value <= 0:
            break
        before = place
        value_before = value
        place = before - (value + _CLOSE / 2) / slope
        value = surplus(place)
        if place != before and value != value_before:
            slope = min(max((value - value_before) / (place - before), 0.2), 5.0)
    else:
        raise NoOrbitError(
            f"no {contact.law} contact was found whose {QUANTITIES[Quantity(quantity)]} crosses "
            f"{percent(question.tolerance)}: give {{contact_time}}"
        )
    return Choice(n, linear.needed, replace(case_of(place), given=contact))


def _needed(unit: SpringDamper, amplitude: float, question: Question) -> Needed:
    """The ϖ that the tolerance needs for the ζ of a contact at Λ.

    Raises
    ------
    NoOrbitError
        If the restitution model has no such orbit, or no contact is within the tolerance.
    """
    quantity = question.quantity
    r = float(unit.restitution)
    n = first_stable_family(question.families, r, amplitude)
    if quantity in OF_ORBITS:
        n_t.require_orbit(RestitutionModel(r), n, amplitude)
    found = needed(quantity, question.tolerance, unit, n, amplitude)
    if found.status == ThresholdStatus.NEVER_WITHIN:
        raise NoOrbitError(
            f"no contact up to ϖ = {RATIOS[-1]:g} has its {QUANTITIES[Quantity(quantity)]} "
            f"predicted within {percent(found.tolerance)} by the restitution model with r = {r:.4g}"
        )
    return found
