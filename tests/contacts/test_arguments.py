"""Arguments of a wrong class in the questions about a contact."""

import pytest

import bouncing_ball
from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.question import EngineSetup
from bouncing_ball.contacts.table import Table
from bouncing_ball.errors import ParameterError

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
