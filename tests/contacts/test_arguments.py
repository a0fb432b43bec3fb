"""Arguments of a wrong class in the questions about a contact."""

import pytest

import bouncing_ball
from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.question import EngineSetup, Question
from bouncing_ball.contacts.table import Table
from bouncing_ball.errors import ModelError, ParameterError

TABLE = Table(frequency="50 Hz", acceleration="0.8 g")
CONTACT = Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85)
BALL = bouncing_ball.rigid(restitution=0.5)


@pytest.mark.parametrize(("call", "arguments", "words"), [
    ("assess_contact", (CONTACT, TABLE), "table = Contact is not a Table"),
    ("assess_contact", (TABLE, CONTACT, 0.05), "question = 0.05 is not a Question"),
    ("assess_contact", (TABLE, CONTACT, 0), "question = 0 is not a Question"),
    ("assess_contact", (TABLE, BALL), "is not a Contact"),
    ("choose_contact", (TABLE, BALL), "is not a Contact"),
    ("choose_contact", (CONTACT, TABLE), "is not a Table"),
    ("describe_contact", (BALL,), "is not a Contact"),
    ("write_contact", (CONTACT, "mujoco"), "setup = 'mujoco' is not an EngineSetup"),
    ("write_contact", (CONTACT, EngineSetup(engine="mujoco"), 50.0), "table = 50.0 is not a Table"),
])  # fmt: skip
def test_an_argument_of_a_wrong_class_is_named_in_one_line(refusal, call, arguments, words):
    with refusal(ParameterError, words):
        getattr(bouncing_ball, call)(*arguments)


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
    (Question, {"n": "1"}, "index of the family n = '1' is not a whole number from 1 to 1000"),
    (Question, {"n": True}, "index of the family n = True is not a whole number"),
    (Question, {"balls": "7"}, "balls = 7 is not a whole number from 1 to 100000"),
    (Question, {"tolerance": True}, "tolerance = True is neither a number nor a text"),
    (Question, {"quantity": 3}, "unknown quantity 3: one of max_height"),
    (EngineSetup, {"engine": ["a"]}, "unknown engine ['a']: one of generic"),
    (EngineSetup, {"engine": "mujoco", "time_step": 0}, "time_step = 0 s is not a positive"),
    (Table, {"frequency": 50, "acceleration": True}, "acceleration = True is neither a number"),
])  # fmt: skip
def test_a_value_of_a_wrong_type_is_named_in_one_line(refusal, kind, given, words):
    with refusal(ModelError, words):
        kind(**given)
