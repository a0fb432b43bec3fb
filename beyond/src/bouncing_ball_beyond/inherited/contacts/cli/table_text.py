"""The numbers of a contact on a table and of its families, as they are printed."""

from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS, OF_ORBITS, QUANTITIES
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.inherited.contacts.cli.contact_text import (
    contact_numbers,
    law_lines,
    line,
)
from bouncing_ball_beyond.inherited.contacts.cli.design_answer import DesignAnswer
from bouncing_ball_beyond.inherited.contacts.cli.options import option
from bouncing_ball_beyond.inherited.contacts.contact import rows
from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment
from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit, ErrorsByQuantity
from bouncing_ball_beyond.inherited.contacts.contact.needed import Needed
from bouncing_ball_beyond.inherited.contacts.contact.texts import percent, shown, signed

_SIMPLE = "error law", "corrected"


def table_numbers(given: DesignAnswer, found: Assessment) -> list[str]:
    """The numbers of the contact, the ϖ that the tolerance needs, and the families."""
    need = found.needed
    always = ThresholdStatus.ALWAYS_WITHIN
    asked = f"ϖ for {percent(need.tolerance)} in the {QUANTITIES[Quantity(need.quantity)]}"
    exact, corrected = (
        "any" if status == always else _ratio(value, status)
        for value, status in (
            (need.frequency_ratio, need.status),
            (need.corrected, need.corrected_status),
        )
    )
    models = {"exact": exact, "error law": _ratio(need.by_law, need.status), "corrected": corrected}
    return [
        *(line(*row) for row in contact_numbers(given)),
        f"Time step: {found.time_step.rule}.",
        *law_lines(found),
        "",
        line(asked, *models),
        line("", *models.values()),
        *(_whole(found) if given.whole else _short(found)),
    ]


def _ratio(value: float | None, status: str) -> str:
    """The ϖ that is needed, or the reason why there is none: the model may have no orbit."""
    return status if value is None else shown(value)


def _error(one: ComparedOrbit, quantity: Quantity) -> str:
    """The errors of a quantity in all models, or which of them has no orbit."""
    found = []
    for model, errors in (
        ("restitution", one.errors),
        ("error law", one.law_errors),
        ("corrected", one.corrected_errors),
    ):
        missing = _without(one, quantity, model)
        if errors[quantity] is None and missing:
            found.append("no contact orbit" if missing == "contact" else "no orbit")
        else:
            found.append(signed(errors[quantity]))
    return line(f"    {QUANTITIES[quantity]}", *found)


def _without(one: ComparedOrbit, quantity: str, model: str) -> str:
    """The first of contact and model that lacks the orbit of a quantity; empty if both have it."""
    if model == "error law":
        # The law starts from an orbit of the restitution model, for the limits of orbits as well.
        return "" if one.standing["restitution"].exists else "restitution"
    if quantity not in OF_ORBITS:
        return ""
    if not one.exists:
        return "contact"
    return "" if one.standing[model].exists else model


def _off(one: ComparedOrbit, need: Needed, model: str, errors: ErrorsByQuantity) -> str:
    """The error of the judged quantity, or the reason why there is none."""
    error = errors[need.quantity]
    missing = _without(one, need.quantity, model)
    if error is None and missing:
        return f"no orbit ({missing})"
    return signed(error, need.tolerance)


def _family_lines(one: ComparedOrbit) -> list[str]:
    lines = ["", f"{one.n}-T orbit", line("", *one.standing)]
    for columns in zip(*map(rows.texts, one.standing.values()), strict=True):
        lines.append(line(f"  {columns[0][0]}", *(text for _, text in columns)))
    if one.exists:
        lines += [line(f"  {name}", text) for name, text in rows.texts(one)]
    holds = "error law" if one.law_holds else "law, out of range"
    lines.append(line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def _short(found: Assessment) -> list[str]:
    """One line for each family, and a line on the options that print the other results."""
    need = found.needed
    error = f"{QUANTITIES[Quantity(need.quantity)]} off by"
    head = (
        f"{'orbit':<9}{'stable':<9}{'greatest height':<18}{'peak force':<13}{error:<40}corrected by"
    )
    about = f"{option('n')} {found.n} prints all results for one, {option('all_families')} for all"
    return ["", head, *(_one_line(one, need) for one in found.orbits), f"({about}.)"]


def _one_line(one: ComparedOrbit, need: Needed) -> str:
    of_contact = {row.key: row.text for row in rows.rows(one) if row.words}
    height, force = (
        of_contact[name,] if one.exists else "no orbit" for name in ("max_height", "peak_force")
    )
    return (
        f"{f'{one.n}-T':<9}{('no', 'yes')[one.is_stable]:<9}{height:<18}{force:<13}"
        f"{_off(one, need, 'restitution', one.errors):<40}"
        f"{_off(one, need, 'corrected', one.corrected_errors)}"
    )


def _whole(found: Assessment) -> list[str]:
    """All results for each family."""
    return [
        *(line for one in found.orbits for line in _family_lines(one)),
        "",
        # The error of the permanent contact is the same in all families.
        line("relative error", "restitution", *_SIMPLE),
        _error(found.orbits[0], Quantity.PERMANENT_CONTACT),
    ]
