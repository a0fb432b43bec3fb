"""The contact that was chosen, as an argument of the other calls."""

import pytest

from bouncing_ball_beyond.inherited.contacts import (
    Contact,
    Question,
    Table,
    assess_contact,
    choose_contact,
)

pytestmark = pytest.mark.usefixtures("short_runs")

TABLE = Table(frequency="50 Hz", acceleration="0.8 g")


LOSS = {"restitution": 0.85}


@pytest.mark.parametrize(("loss", "question"), [
    (LOSS, {}),
    ({"restitution": 0.6, "release": "force"}, {"tolerance": 1e-6, "n": 1}),
    ({"drop_height": "1 m", "rebound_height": "70 cm"}, {}),
    (LOSS, {"quantity": "saddle_node"}),
    (LOSS, {"quantity": "permanent_contact"}),
])  # fmt: skip
def test_a_chosen_contact_is_within_the_tolerance_when_it_is_assessed(loss, question):
    asked = Question(**question)
    chosen = choose_contact(TABLE, Contact(mass="20 g", **loss), asked)
    found = assess_contact(TABLE, chosen.contact, asked)
    assert found.on_orbit.is_good_enough and found.n == chosen.n
    # The error is not far within, either.
    assert abs(found.on_orbit.error) == pytest.approx(asked.tolerance, rel=1e-5)
    assert found.stiffness == pytest.approx(chosen.stiffness, rel=1.01e-6)
    assert found.damping_ratio == pytest.approx(chosen.damping_ratio, rel=1e-9)


def test_a_chosen_law_is_assessed():
    asked = Question(tolerance="2 %", n=1)
    ball = Contact(mass="20 g", restitution=0.8, law="hunt-crossley")
    chosen = choose_contact(TABLE, ball, asked)
    assert assess_contact(TABLE, chosen.contact, asked).on_orbit.is_good_enough


def test_a_chosen_contact_says_its_stiffness():
    chosen = choose_contact(TABLE, Contact(mass="20 g", restitution=0.85))
    assert repr(chosen).startswith("Choice(n=1, verdict='A simulation needs a contact of at least")
    assert "14.89 MN/m" in repr(chosen) and len(repr(chosen)) < 300
