"""Mistakes drawn at random from what the contacts declare.

These are the ranges and choices of options, and the units of quantities. Each is refused with one
line, which names what is wrong and says what is allowed. How each way of refusing words it is
tested where this way is defined.
"""

import math

from hypothesis import given
from hypothesis import strategies as st
from random_mistakes import (
    WORDS,
    options_are_refused,
    outside,
    typed_options,
)

from bouncing_ball_beyond.inherited.contacts.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.quantities import quantities
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.table import Table
from bouncing_ball_beyond.inherited.errors import ModelError

# The command line.


# The commands of the contacts.
TestOptions = options_are_refused(COMMANDS)


# Quantities with units.

MEASURED = [
    (kind, name, quantity)
    for kind in (Contact, Table, Question)
    for name, quantity in quantities(kind).items()
]


def example_of_another_unit(unit: str) -> st.SearchStrategy:
    """Quantities in units that are not those of a parameter, by any meaning of g and of a turn."""
    same = next((pair for pair in ({"Hz", "rad/s"}, {"kg", "m/s^2"}) if unit in pair), {unit})
    return st.sampled_from([x.example for *_, x in MEASURED if x.name and x.name not in same])


@given(st.data(), st.sampled_from(MEASURED))
def test_a_wrong_quantity_is_refused(refusal, data, case):
    kind, name, quantity = case
    number = outside(quantity.allowed).filter(lambda x: abs(x) < 1e300)
    wrong = data.draw(number | WORDS | example_of_another_unit(quantity.name))
    if isinstance(wrong, str):
        with refusal(ModelError, name, "write it as", quantity.example):
            kind(**{name: wrong})
    else:
        said = "not a finite number" if math.isnan(wrong) else f"is not {quantity.allowed}"
        if wrong <= 0 < quantity.allowed.low:
            said = "is not a positive number"
        if wrong < 0 == quantity.allowed.low:
            said = "is negative"
        with refusal(ModelError, name, said):
            kind(**{name: wrong})


def test_the_declarations_are_found():
    assert len(typed_options(COMMANDS)) >= 3 and len(MEASURED) > 20
