"""Locked orbits of compliant contacts: the ball rests in one long contact between two chatters."""

import numpy as np
import pytest
from orbits_found import balls, legs_of

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.motions.motions import Kind
from bouncing_ball_beyond.motions.orbit_of_motion import of_impact

# Digits that a ball may lose from rest to rest so that Newton's method settles: half of those of a
# double, because the steps must fall below 1e-12 times the phases, and the residual has an error of
# some roundings.
_DIGITS = 8.0


# A stiff contact, and more compliant ones weekly.
SELDOM = [pytest.param(ratio, marks=pytest.mark.long) for ratio in (10.0, 32.0)]


@pytest.mark.parametrize("ratio", [100.0, *SELDOM])
def test_the_locked_orbits_on_which_balls_end_are_orbits_of_the_equations(ratio):
    """At random places of (Λ, r), from the motions on which balls end."""
    random = np.random.default_rng(61)
    r = random.uniform(0.1, 0.7, 25)
    lam = random.uniform(1.2, 5.0, 25)
    model = balls("spring-damper", lam, r, ratio).model
    motion = final_motions(model, lam, -np.pi / 2, 0.0, impacts=200)
    locked = np.flatnonzero((motion.kind == Kind.LOCKED) & (motion.periods > 0))
    found = []
    for k in locked:
        ball = balls("spring-damper", lam[k], r[k], ratio)
        start = float(motion.end_phase[k]), float(motion.end_velocity[k]), int(motion.impacts[k])
        try:
            orbit = of_impact(ball, *start)
        except NoOrbitError:
            assert motion.digits_lost[k] > _DIGITS
            continue
        assert orbit.periods == motion.periods[k] and orbit.is_admissible()
        assert orbit.defect() < 1e-12 and legs_of(orbit).departure.sticks.any()
        found.append(k)
    assert len(found) > 6
