"""The bounces after a drop: each arrives with the speed of the rise before it."""

import math

import pytest

from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.drops import drop_at_rest
from bouncing_ball_contacts.contact.resolve import resolve
from bouncing_ball_contacts.contact.table import TableMotion

G = 9.81


def test_each_rise_is_the_first_one_of_a_drop_from_the_height_before():
    ball = Contact(mass=0.02, stiffness=1e4, damping=4.0, release="force")
    case = resolve(ball, TableMotion.at_rest(G))
    found = drop_at_rest(case, 2.0)
    again = drop_at_rest(case, math.sqrt(2 * G * found.rebound_height))
    assert found.second_rise == pytest.approx(again.rebound_height, rel=1e-12)
    assert found.third_rise == pytest.approx(again.second_rise, rel=1e-12)
    assert 0 < found.third_rise < found.second_rise < found.rebound_height
