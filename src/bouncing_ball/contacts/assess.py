"""The first question: is a restitution coefficient good enough for a contact on a table?"""

from dataclasses import replace

from bouncing_ball.accuracy.errors import OF_ORBITS
from bouncing_ball.contacts.case import PhysicalCase, TableMotion
from bouncing_ball.contacts.contact_data import case_of
from bouncing_ball.contacts.engine_data import Ready, ready
from bouncing_ball.contacts.families import families, finite, needed
from bouncing_ball.contacts.given import Contact, Question, Table
from bouncing_ball.contacts.lone_contact import drop_remarks, require_short, slowed
from bouncing_ball.contacts.motion import of_family
from bouncing_ball.contacts.results import (
    Assessment,
    Choice,
    Corrected,
    Family,
    TimeStep,
)
from bouncing_ball.contacts.verdict import (
    Verdict,
    aside,
    assessed,
    headline,
    judged_by_motion,
    notes,
)
from bouncing_ball.errors import ModelError, NoOrbitError, require
from bouncing_ball.models.damping import Release

STEPS = 50
"""Time steps in one contact, for the rule of the largest time step."""

STEP_RULE = f"a contact takes {STEPS} steps, the default of MFiX-Exa (mfix.tcoll_ratio)"
# Beyond this limit the squares of ϖ and Λ leave no digits. The other calls have the same limit.
_LARGEST = 1e8
# A contact law is integrated in time. At this Λ its motion takes up to eight seconds, and beyond it
# more, because a contact is then a small part of a flight.
_LARGEST_OF_LAW = 1e5


def assess_contact(table: Table, contact: Contact, question: Question | None = None) -> Assessment:
    """Whether the restitution model is good enough for a contact on a vibrating table.

    Parameters
    ----------
    table : Table
    contact : Contact
        With its stiffness and its loss, or the parameters of a physics engine.
    question : Question, optional
        By default the greatest height within 1 %, of the first family with a stable orbit.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.
    NoOrbitError
        If no model has the orbit of the ``n`` that is asked for.

    Examples
    --------
    >>> found = assess_contact(
    ...     Table(frequency="50 Hz", acceleration="0.8 g"),
    ...     Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85),
    ...     Question(tolerance="5 %"),
    ... )
    >>> found.n, found.is_good_enough, round(found.judged.errors["max_height"], 4)
    (1, True, 0.0122)
    """
    asked = question or Question()
    return of_contact(table.motion, ready(contact), asked)


def of_contact(table: TableMotion, given: Ready, question: Question) -> Assessment:
    """The assessment of a contact that is given."""
    require_range(table)
    case = given.case(case_of(given.contact, table, question.families), question.families)
    return of_case(case, question, given.remarks + drop_remarks(case, given.contact))


def require_range(table: TableMotion) -> None:
    """Refuse a table whose Λ leaves no digits.

    Raises
    ------
    ModelError
        The message gives the range.
    """
    require(table.amplitude < _LARGEST, table.amplitude, "Λ", f"below {_LARGEST:g}")


def of_case(
    case: PhysicalCase, question: Question, remarks: tuple[str, ...], choice: Choice | None = None
) -> Assessment:
    """The assessment of a case, or with ``choice`` of the contact that was chosen.

    If no model has an orbit and no n is asked for, it is about a ball laid on the table.
    """
    contact = case.contact
    ratio = float(contact.frequency_ratio)
    only = "below 1: on a vibrating table only underdamped contacts are computed"
    require(contact.damping_ratio < 1, contact.damping_ratio, "damping ratio ζ", only)
    require_short(case.in_si()["contact_time"])
    if case.law is not None and case.table.amplitude > _LARGEST_OF_LAW:
        raise ModelError(
            f"Λ = {case.table.amplitude:g} is above {_LARGEST_OF_LAW:g}, up to which a contact law "
            "is followed: give a lower acceleration, or a spring and a damper, which are faster"
        )
    no_orbit = ""
    try:
        found = families(case, question.families)
    except NoOrbitError as error:
        if question.n is not None:
            raise
        choice = None
        no_orbit = str(error)
        found = families(case, question.families, or_first=True)
    require(1 / _LARGEST < ratio < _LARGEST, ratio, "ϖ", f"between {1 / _LARGEST:g} and 1e8")
    one = _judged(found, choice)
    if choice is None:
        amplitude = case.table.amplitude
        need = needed(question.quantity, question.tolerance, contact, one.n, amplitude)
        verdict = assessed(one, need, ratio)
        before = ""
    else:
        need = choice.needed
        verdict = Verdict(True, choice.verdict, choice.reason)
        before = f"{choice.verdict} "
    motion = of_family(case, one, need.tolerance, question.balls)
    # A threshold, such as that of permanent contact, is not a property of one orbit.
    if need.quantity in OF_ORBITS:
        if motion.restitution_kind is None:
            said = f"{verdict.verdict[:-1]}{aside(motion, case.table.amplitude)}."
            verdict = verdict._replace(verdict=said)
        else:
            end = judged_by_motion(motion, need.tolerance, one.n)
            verdict = end._replace(verdict=before + end.verdict, reason=no_orbit or end.reason)
    si = case.in_si()
    signature = case.instant(one.n)
    return Assessment(
        frequency_ratio=ratio,
        damping_ratio=float(contact.damping_ratio),
        amplitude=case.table.amplitude,
        stiffness=si["stiffness"],
        damping=si["damping"],
        contact_time=si["contact_time"],
        time_step=TimeStep(si["contact_time"] / STEPS, STEP_RULE),
        static_deflection=si["static_deflection"],
        restitution={
            str(rule): float(replace(contact, release=rule).restitution) for rule in Release
        },
        measured_restitution=float(contact.restitution),
        slowed_speed=slowed(case),
        permanent_contact=finite(case.permanent_contact),
        law=case.law_in_si,
        corrected=Corrected(
            delay=float(signature.delay) * case.table.time,
            restitution=float(signature.restitution),
            load=float(signature.load) * case.table.time,
        ),
        orbits=found,
        needed=need,
        motion=motion,
        headline=headline(motion, one),
        is_good_enough=verdict.is_good_enough,
        verdict=verdict.verdict,
        reason=verdict.reason,
        notes=remarks + notes(case, one, motion),
        case=case,
        n=one.n,
    )


def _judged(found: tuple[Family, ...], choice: Choice | None) -> Family:
    """The family of the verdict: that of the choice, or the first whose orbit is stable and
    admissible, or else exists.
    """
    first = max(found, key=lambda one: (one.exists, one.is_stable and one.is_admissible))
    if choice is None:
        return first
    return next((each for each in found if each.n == choice.n), first)
