"""Balls that lose no energy on a table at rest hop on for ever."""

import math

import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.motions import over_time

BALLS = {
    "rigid": bb.rigid(restitution=1.0),
    "spring": bb.spring_damper(restitution=1.0, frequency_ratio=1e4),
    "law": bb.contact_law("linear", frequency_ratio=1e4, damping_ratio=0.0),
    "corrected": bb.corrected(bb.spring_damper(restitution=1.0, frequency_ratio=1e4)),
}


@pytest.fixture
def simulated(monkeypatch):
    """The numbers of impacts that are simulated."""
    numbers = []
    simulate = Model.simulate

    def counted(model, amplitude, phase, velocity, impacts):
        numbers.append(impacts)
        return simulate(model, amplitude, phase, velocity, impacts)

    monkeypatch.setattr(Model, "simulate", counted)
    return numbers


@pytest.mark.parametrize("ball", BALLS)
def test_too_many_hops_are_refused_after_the_first_impacts(ball, simulated, refusal):
    # Each hop lasts 2√(2h) = 0.09, and a contact π/ϖ: 700,000 impacts in 10,000 periods.
    with refusal(ModelError, "more than 65536 impacts", "fewer periods"):
        bb.drop(BALLS[ball], height=1e-3, periods=10_000.0, samples=1)
    assert simulated == [4]


@pytest.mark.parametrize(("restitution", "amplitude"), [(1.0, 0.01), (0.9999, 0.0)])
def test_other_balls_are_followed(restitution, amplitude, simulated, monkeypatch, refusal):
    monkeypatch.setattr(over_time, "_MOST", 64)
    ball = bb.rigid(restitution=restitution)
    with refusal(ModelError, "more than 64 impacts"):
        # On the moving table the orbit of one period is unstable: a ball may leave it later.
        bb.history(ball, amplitude=amplitude, phase=math.pi / 2, periods=70.0, samples=1)
    assert simulated == [4, 16, 64]


def test_as_many_hops_as_are_allowed_are_answered(simulated, monkeypatch, refusal):
    monkeypatch.setattr(over_time, "_MOST", 64)
    ball = bb.rigid(restitution=1.0)
    # Hops of 2; impact 64 is at τ = 126, and two impacts more are above the limit by any count.
    for end, rounds in ((125.9, [4, 16, 64]), (130.1, [4])):
        simulated.clear()
        arguments = {"velocity": -1.0, "periods": end / (2 * math.pi), "samples": 10}
        if end < 126:
            assert bb.history(ball, amplitude=0.0, **arguments).ball.notnull().all()
        else:
            with refusal(ModelError, "more than 64 impacts"):
                bb.history(ball, amplitude=0.0, **arguments)
        assert simulated == rounds
