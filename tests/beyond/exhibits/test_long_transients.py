"""After how many impacts balls lock that seem chaotic at first, against their impacts."""

import numpy as np

from bouncing_ball.beyond.exhibits.long_transients import LongTransients, transients_at_nodes
from bouncing_ball.models.rigid import RestitutionModel


def test_a_ball_locks_where_its_simulation_sticks_for_the_second_time():
    parameters = LongTransients(
        amplitude={"min": 3.0, "max": 4.5, "samples": 6},
        restitution={"min": 0.45, "max": 0.7, "samples": 3},
        phase=1.0,
        impact_speed=10.0,
        followed=[200, 500],
        bands=[0.5],
        resolved=0.01,
        resolved_impacts=200,
        seed=1,
        confidence=0.95,
    )
    found = transients_at_nodes(parameters)
    r, lam = parameters.places()
    velocity = lam * np.cos(1.0) - 10.0
    balls = RestitutionModel(r).simulate(lam, 1.0, velocity, 500)
    sticks = (balls.relative_bounce_velocity == 0) & (balls.contact_duration > 0)
    expected = [next(iter(np.flatnonzero(each)[1:]), 0) for each in sticks.T]
    chaotic = found["seems_chaotic"]
    assert np.array_equal(found["locks_after"], np.where(chaotic, expected, 0))
    # Some of the balls do not lock, or do not even seem chaotic.
    assert 0 < np.count_nonzero(found["locks_after"]) < np.count_nonzero(chaotic) <= r.size
