"""Contacts so soft that the ball lives on its spring: they are answered, and none is refused."""

import math
from itertools import product

import pytest
from asked_contacts import assessed

from bouncing_ball_beyond.inherited.contacts.contact.judgement import MotionJudgement
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion
from bouncing_ball_beyond.inherited.contacts.contact.verdict import said_of_motion
from bouncing_ball_beyond.motions.motions import Kind

pytestmark = pytest.mark.usefixtures("short_runs")

MASS = 0.02


# Each number with each ball that rests and with each that does not; all together weekly.
TRIED = [(5, 0.6, 2.0), (50, 0.1, 0.8), (1000, 0.1, 2.0), (1000, 0.6, 0.8)]
OTHERS = [x for x in product((5, 50, 1000), (0.1, 0.6), (0.8, 2.0)) if x not in TRIED]


@pytest.mark.parametrize(
    ("stiffness", "restitution", "acceleration"),
    [*TRIED, *(pytest.param(*x, marks=pytest.mark.long) for x in OTHERS)],
)
def test_a_soft_contact_is_answered(stiffness, restitution, acceleration):
    """The forced oscillation in contact is a closed form: it pulls above the threshold only."""
    found = assessed(
        mass=MASS,
        stiffness=stiffness,
        restitution=restitution,
        frequency="50 Hz",
        acceleration=f"{acceleration} g",
    )
    natural = math.sqrt(stiffness / MASS)
    logarithm = math.log(restitution)
    damping = -logarithm / math.hypot(math.pi, logarithm)
    ratio = 2 * math.pi * 50 / natural
    threshold = abs(1 - ratio**2 + 2j * damping * ratio)
    assert found.permanent_contact == pytest.approx(threshold, rel=1e-12)
    assert found.static_deflection == pytest.approx(9.80665 / natural**2, rel=1e-12)
    # No ball of the restitution model rests above Λ = 1; a soft contact hardly feels the table.
    rests = acceleration <= threshold
    assert (Kind.PERMANENT_CONTACT in (found.motion.kind, found.motion.laid)) is rests
    if rests and acceleration > 1:
        assert not found.is_good_enough and "not known" not in found.verdict


def test_a_ball_that_rests_differs_from_one_that_is_thrown_off():
    """Above Λ = 1 no ball of the restitution model rests, also if its motion is not known."""
    undecided = FinalMotion(Kind.PERMANENT_CONTACT, 1, 0, restitution_kind=Kind.UNDECIDED)
    below, above = (MotionJudgement(undecided, 0.01, 1, None, x) for x in (0.9, 2.0))
    assert not below.is_decided and "not known" in said_of_motion(below).verdict
    assert above.is_decided and "with Λ = 2 times gravity" in said_of_motion(above).verdict
    assert not above.is_good_enough


def test_a_ball_that_sinks_in_too_far_is_noted_without_a_radius(said):
    text = said("design", "--mass=500", "--stiffness=100", "--restitution=0.8")
    assert "Note: at rest the ball sinks in by 49.03 m: check the stiffness, the mass" in text
    text = said("design", "--mass=0.5", "--stiffness=100", "--restitution=0.8")
    assert "sinks in by" not in text
