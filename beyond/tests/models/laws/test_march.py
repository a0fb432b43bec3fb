"""The lengths of panels in the march of contacts."""

import numpy as np
import pytest

from bouncing_ball_beyond.models.laws import march
from bouncing_ball_beyond.models.laws.panel import BallsInContact, Panel, lever_of
from bouncing_ball_beyond.models.laws.sweeps import LONGER


def longest(m, *, depth, rate, passed, length, speed):
    """The greatest length of the panels that follow panels of a duration ``passed``."""
    start = np.full_like(rate, 3.0)
    now = BallsInContact(*[None] * 8)._replace(time=start, length=length, speed=speed)
    panel = Panel(*[None] * len(Panel._fields))
    rows = {"root": depth ** (1 / m), "rate": rate, "time": start + passed}
    panel = panel._replace(**{name: row[np.newaxis] for name, row in rows.items()})
    # A march ignores warnings.
    with np.errstate(all="ignore"):
        return march._longest(m, now, panel)


@pytest.mark.parametrize("m", [2, 3])
def test_a_descending_ball_may_go_on_for_a_little_longer_than_before(m):
    random = np.random.default_rng(4)
    depth, rate, passed, length, speed = np.exp(random.normal(size=(5, 200)))
    # At p = 0, where λ = 0, the length is that of the whole descent.
    depth[:5] = 0.0
    found = longest(m, depth=depth, rate=rate, passed=passed, length=length, speed=speed)
    # With dq/ds = p′ at its last value, the depth is then that of a descent of this time.
    time = np.where(LONGER * passed > 0.7 * length / speed, LONGER * passed, 0.7 * length / speed)
    then = (depth ** (1 / m) + rate * found) ** m
    assert then - depth == pytest.approx(rate * time, rel=1e-9)
    assert 20 < np.count_nonzero(time > LONGER * passed) < 180


def test_a_ball_that_hardly_sinks_takes_its_time_and_a_rising_ball_any():
    one = np.ones(3)
    depth = np.full(3, 4.0)
    # 4 + 1e-30 is 4: then ds = dt/λ, with λ = 3 p^{2/3}.
    rate = np.array([1e-30, 0.0, -1.0])
    found = longest(3, depth=depth, rate=rate, passed=2 * one, length=one, speed=one)
    assert found[0] == pytest.approx(LONGER * 2 / lever_of(3, depth ** (1 / 3))[0], rel=1e-12)
    assert found[1:].tolist() == [np.inf, np.inf]
