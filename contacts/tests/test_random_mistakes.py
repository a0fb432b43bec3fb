"""Mistakes drawn at random from what the contacts declare.

These are the ranges and choices of options, and the units of quantities. Each is refused with one
line, which names what is wrong and says what is allowed. How each way of refusing words it is
tested where this way is defined.
"""

import argparse
import inspect
import math
import shlex

from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.cli.answers import parser
from bouncing_ball.errors import ModelError, Range
from bouncing_ball_contacts.cli.commands import COMMANDS
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.quantities import quantities
from bouncing_ball_contacts.contact.question import EngineSetup, Question
from bouncing_ball_contacts.contact.table import Table

NUMBERS = st.floats() | st.integers() | st.sampled_from([10**400, -1, 0, 1.5, 5e-324, 1e300])
# Words that begin no number, no name and no choice.
WORDS = st.text("qxyz#_ ", min_size=1, max_size=30).filter(str.strip)


def outside(allowed: Range) -> st.SearchStrategy:
    """Numbers outside a range, often just beyond its ends."""
    low = allowed.low
    high = allowed.high
    ends = [math.nextafter(low, -math.inf), math.nextafter(high, math.inf)]
    if allowed.ends[0] == "(":
        ends.append(low)
    if allowed.ends[1] == ")":
        ends.append(high)
    if allowed.whole:
        ends.append(low + 0.5)
    return st.sampled_from(ends) | NUMBERS.filter(lambda value: value not in allowed)


# The command line.


def options(command: str) -> dict[str, argparse.Action]:
    """The options of a command that take a number in a range, or one of several names."""
    (commands,) = parser([command])._subparsers._group_actions
    found = commands.choices[command]._option_string_actions
    return {k: each for k, each in found.items() if each.choices or range_of(each)}


def range_of(action: argparse.Action) -> Range | None:
    """The range that the parser of a number holds."""
    if not inspect.isfunction(action.type):
        return None
    return inspect.getclosurevars(action.type).nonlocals.get("allowed")


TYPED = [
    (about.examples[0], name, action)
    for command, about in COMMANDS.items()
    for name, action in options(command).items()
]


@given(st.data(), st.sampled_from(TYPED))
def test_a_wrong_option_is_refused(refused, data, case):
    example, name, action = case
    allowed = range_of(action)
    wrong = WORDS if allowed is None else WORDS | outside(allowed).map(repr)
    if action.nargs == 2:
        more = [name, "1", data.draw(wrong.filter(lambda text: not text.startswith("-")))]
    else:
        # After a sign of equality any text is a value, even if it begins with a dash.
        more = [f"{name}={data.draw(wrong)}"]
    words = shlex.split(example) + more
    status, line = refused(*words)
    assert status == 2 and line.startswith(f"bouncing-ball: argument {name}: ")
    assert all(choice in line for choice in action.choices or [str(allowed)]), line


@given(st.sampled_from(sorted(COMMANDS)), st.text("qxyz", min_size=1, max_size=12))
def test_an_unknown_option_is_refused(refused, command, word):
    status, line = refused(*shlex.split(COMMANDS[command].examples[0]), f"--{word}=1")
    assert status == 2 and f"unrecognized arguments: --{word}=1" in line


# Quantities with units.

MEASURED = [
    (kind, name, quantity)
    for kind in (Contact, Table, Question, EngineSetup)
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
    engine = {"engine": "mujoco"} if kind is EngineSetup else {}
    if isinstance(wrong, str):
        with refusal(ModelError, name, "write it as", quantity.example):
            kind(**engine, **{name: wrong})
    else:
        said = "not a finite number" if math.isnan(wrong) else f"is not {quantity.allowed}"
        if wrong <= 0 < quantity.allowed.low:
            said = "is not a positive number"
        if wrong < 0 == quantity.allowed.low:
            said = "is negative"
        with refusal(ModelError, name, said):
            kind(**engine, **{name: wrong})


def test_the_declarations_are_found():
    assert len(TYPED) >= 3 and len(MEASURED) > 20
