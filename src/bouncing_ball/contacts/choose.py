"""The second question: how stiff must a contact be for a restitution coefficient to be enough?"""

import math
from dataclasses import replace

from bouncing_ball.accuracy.errors import OF_ORBITS, QUANTITIES, Quantity
from bouncing_ball.accuracy.thresholds import RATIOS, ThresholdStatus
from bouncing_ball.contacts.assess import require_range
from bouncing_ball.contacts.case import PhysicalCase, TableMotion
from bouncing_ball.contacts.contact_data import (
    law_type,
    loss,
    meant,
    reduced_modulus,
    require_pairs,
    rule_of,
    same_omega,
)
from bouncing_ball.contacts.engine_data import Ready, ready
from bouncing_ball.contacts.families import needed
from bouncing_ball.contacts.given import Contact, Question, Table, given
from bouncing_ball.contacts.lone_contact import drop_remarks
from bouncing_ball.contacts.results import Choice, Needed
from bouncing_ball.contacts.units import percent
from bouncing_ball.contacts.verdict import chosen
from bouncing_ball.errors import NoOrbitError, ParameterError
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic import n_t

# Largest number of times that the damping of a drop test is fitted to the stiffness chosen.
_REFITS = 12


def choose_contact(table: Table, contact: Contact, question: Question | None = None) -> Choice:
    """The most compliant contact for which the restitution model is within a tolerance.

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
    >>> found = choose_contact(
    ...     Table(frequency="50 Hz", acceleration="1 g"), Contact(mass="20 g", restitution=0.65)
    ... )
    >>> f"{found.stiffness:.4g} N/m, {found.contact_time:.3g} s", round(found.frequency_ratio, 2)
    ('1.36e+07 N/m, 0.000122 s', 83.0)
    """
    return of_loss(table.motion, ready(contact), question or Question())


def of_loss(table: TableMotion, ready: Ready, question: Question) -> Choice:
    """The contact with the loss of a contact that has no stiffness."""
    contact = ready.contact
    if contact.is_stiff:
        raise ParameterError("a contact with a stiffness is not chosen: leave its stiffness out")
    # A law is fitted to a free impact, so that it is never chosen.
    law_type(contact)
    data = given(contact)
    require_pairs(data)
    # A radius alone is a Hertz contact whose modulus is missing.
    reduced_modulus(data)
    require_range(table)
    # A contact with the ζ of the given loss, whose ϖ is still to be found.
    rule = rule_of(contact)
    unit = SpringDamper(1.0, loss(data, rule), rule)
    case, need = _with_ratio(unit, contact.mass, table, question)
    if contact.rebound_height is not None:
        # By gravity the ζ of a drop test depends on the stiffness, though hardly for a stiff one.
        for _ in range(_REFITS):
            before = float(case.contact.frequency_ratio)
            zeta = loss(data, rule, same_omega(before * table.angular_frequency), table.gravity)
            unit = SpringDamper(1.0, zeta, rule)
            case, need = _with_ratio(unit, contact.mass, table, question)
            if math.isclose(case.contact.frequency_ratio, before, rel_tol=1e-12):
                break
    n = meant(question.families, float(case.contact.restitution), table.amplitude)
    numbers = case.in_si()
    verdict = chosen(numbers, need, n)
    return Choice(
        mass=case.mass,
        stiffness=numbers["stiffness"],
        damping=numbers["damping"],
        frequency_ratio=float(case.contact.frequency_ratio),
        damping_ratio=float(case.contact.damping_ratio),
        contact_time=numbers["contact_time"],
        release=str(rule),
        measured_restitution=float(case.contact.restitution),
        n=n,
        needed=need,
        verdict=verdict.verdict,
        reason=verdict.reason,
        notes=drop_remarks(case, contact),
        case=case,
    )


def _with_ratio(
    unit: SpringDamper, mass: float, table: TableMotion, question: Question
) -> tuple[PhysicalCase, Needed]:
    """The case with the smallest ϖ within the tolerance for the ζ of a contact, and this ϖ."""
    quantity = question.quantity
    r = float(unit.restitution)
    n = meant(question.families, r, table.amplitude)
    if quantity in OF_ORBITS:
        n_t.require_orbit(RestitutionModel(r), n, table.amplitude)
    need = needed(quantity, question.tolerance, unit, n, table.amplitude)
    if need.status == ThresholdStatus.NEVER_WITHIN:
        raise NoOrbitError(
            f"no contact up to ϖ = {RATIOS[-1]:g} has its {QUANTITIES[Quantity(quantity)]} "
            f"predicted within {percent(need.tolerance)} by the restitution model with r = {r:.4g}"
        )
    stiff = replace(unit, frequency_ratio=need.frequency_ratio or float(RATIOS[0]))
    return PhysicalCase(mass, table, stiff), need
