"""Arguments of a wrong class in the questions about a contact."""

import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited import contacts
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.table import Table
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError

TABLE = Table(frequency="50 Hz", acceleration="0.8 g")
CONTACT = Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85)
BALL = bouncing_ball_beyond.rigid(restitution=0.5)


@pytest.mark.parametrize(("call", "arguments", "words"), [
    ("assess_contact", (CONTACT, TABLE), "table = Contact(mass=0.02, stiffness=10000000.0, rest"),
    ("assess_contact", (TABLE, CONTACT, 0.05), "question = 0.05 is not a Question"),
    ("assess_contact", (TABLE, CONTACT, 0), "question = 0 is not a Question"),
    ("assess_contact", (TABLE, BALL), "is not a Contact"),
    ("choose_contact", (TABLE, BALL), "is not a Contact"),
    ("choose_contact", (CONTACT, TABLE), "is not a Table"),
    ("describe_contact", (BALL,), "is not a Contact"),
])  # fmt: skip
def test_an_argument_of_a_wrong_class_is_named_in_one_line(refusal, call, arguments, words):
    with refusal(ParameterError, words):
        getattr(contacts, call)(*arguments)


@pytest.mark.parametrize(("call", "arguments", "order"), [
    ("assess_contact", (CONTACT, TABLE), "assess_contact(table, contact, question)"),
    ("choose_contact", (CONTACT, TABLE), "choose_contact(table, contact, question)"),
])  # fmt: skip
def test_swapped_arguments_are_answered_with_their_order(refusal, call, arguments, order):
    with refusal(ParameterError, f"write {order}, in this order"):
        getattr(contacts, call)(*arguments)


@pytest.mark.parametrize(("call", "given", "words"), [
    ("Contact", {"stifness": 1e5}, "'stifness'; did you mean stiffness?"),
    ("Table", {"freq": 50}, "'freq'; did you mean frequency?"),
    ("Question", {"tolerence": 5}, "'tolerence'; did you mean tolerance?"),
    ("assess_contact", {"tables": TABLE}, "'tables'; did you mean table?"),
])  # fmt: skip
def test_an_unknown_keyword_is_answered_with_the_one_that_it_resembles(call, given, words):
    with pytest.raises(TypeError) as wrong:
        getattr(contacts, call)(**given)
    assert str(wrong.value).startswith(f"{call}() got an unexpected keyword argument")
    assert words in str(wrong.value) and "\n" not in str(wrong.value)


def test_every_public_function_answers_an_unknown_keyword():
    for name in contacts.__all__:
        call = getattr(contacts, name)
        if not isinstance(call, type):
            with pytest.raises(
                TypeError, match=r"unexpected keyword argument 'zzz': it has|has no"
            ):
                call(zzz=1)


def test_an_acceleration_without_its_unit_has_the_hint_of_the_command_line(refusal):
    bare = Table(frequency="50 Hz", acceleration=0.8)
    found = contacts.assess_contact(bare, CONTACT)
    assert found.reason.endswith("; perhaps 0.8 g was meant")
    with refusal(NoOrbitError, "perhaps 0.8 g was meant"):
        contacts.assess_contact(bare, CONTACT, Question(n=1))
    with refusal(NoOrbitError, "perhaps 0.8 g was meant"):
        contacts.choose_contact(bare, Contact(mass="20 g", restitution=0.85))
    for other in (TABLE, Table(frequency="50 Hz", acceleration=0.8, gravity=9.81)):
        assert not other.hint


def test_an_assessment_is_shown_by_its_verdict():
    found = contacts.assess_contact(TABLE, CONTACT, Question(n=1))
    assert repr(found).startswith("Assessment(n=1, is_good_enough=False, verdict='The restitution")
    assert len(repr(found)) < 400


LAMMPS = {"mass": "20 g", "from_engine": "lammps"}


@pytest.mark.parametrize(("kind", "given", "words"), [
    (Contact, LAMMPS | {"parameters": "kn=1e5"}, "parameters = 'kn=1e5' is not a mapping from"),
    (Contact, LAMMPS | {"parameters": [("kn", 1e5)]}, "is not a mapping from names to numbers"),
    (Contact, LAMMPS | {"parameters": {"kn": "a"}}, "parameters kn = 'a' is not a number"),
    (Contact, LAMMPS | {"parameters": {"kn": "1 N/m"}}, "give it in the unit of the engine"),
    (Contact, LAMMPS | {"parameters": {"kn": True}}, "parameters kn = True is not a number"),
    (Contact, LAMMPS | {"parameters": {1: 2}}, "parameters has the name 1, which is not a text"),
    (Contact, {"mass": True}, "mass = True is neither a number nor a text"),
    (Contact, {"mass": [1, 2]}, "mass = [1, 2] is neither a number nor a text"),
    (Contact, {"mass": 1, "from_engine": ["a"]}, "from_engine = ['a'] is not a name"),
    (Question, {"n": "1"}, "index of the orbits n = '1' is not a whole number from 1 to 1000"),
    (Question, {"n": True}, "index of the orbits n = True is not a whole number"),
    (Question, {"tolerance": True}, "tolerance = True is neither a number nor a text"),
    (Question, {"quantity": 3}, "unknown quantity 3: one of max_height"),
    (Table, {"frequency": 50, "acceleration": True}, "acceleration = True is neither a number"),
])  # fmt: skip
def test_a_value_of_a_wrong_type_is_named_in_one_line(refusal, kind, given, words):
    with refusal(ModelError, words):
        kind(**given)


@pytest.mark.parametrize("huge", [10**5000, -(10**5000), [10**5000]], ids=["+", "-", "list"])
def test_a_number_of_too_many_digits_is_refused_in_one_line(huge, refusal):
    with refusal(ModelError, "acceleration"):
        contacts.Table(frequency="50 Hz", acceleration=huge)
