"""Mean lives against known rates, and when a ball has reached the motion on which it locks."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import poisson

from bouncing_ball.beyond.exhibits import lives
from bouncing_ball.beyond.exhibits.motion_samples import ThreeModels
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release


def test_the_limits_of_a_mean_life_contain_the_known_value():
    life = np.random.default_rng(3).exponential(30.0, 4000)
    mean, low, high = lives.mean_life(np.minimum(life, 40.0), life < 40.0, 0.95)
    assert low < 30 < high and low < mean < high
    nothing = lives.mean_life(np.ones(5), np.zeros(5, dtype=bool), 0.95)
    assert nothing[::2] == (np.inf, np.inf)


def test_a_ball_has_arrived_where_phase_and_velocity_agree(monkeypatch):
    # Impacts a period apart: at the phase of the end, at its velocity, and then at both.
    times = 2 * np.pi * np.arange(1, 4)
    kind = np.full((1, 1, 10), Kind.LOCKED)

    def final_motions(*_, path, **__):
        path[:, :3] = np.reshape([times, [1, 2, 1], [-5, -4, -4]], (3, 3, 1, 1, 1))
        return SimpleNamespace(end_phase=1.0, end_velocity=-4.0, kind=kind)

    model = SimpleNamespace(impact_law=None, shape=())
    monkeypatch.setattr(lives, "three_models", lambda *_: ThreeModels(*[model] * 3))
    monkeypatch.setattr(lives, "final_motions", final_motions)
    case = {"cases": [{"restitution": 0.5, "amplitude": 2.5}], "frequency_ratio": [10.0]}
    asked = lives.Transients(**case, balls=10, impacts=50, confidence=0.95, seed=1)
    data = lives.transients(asked, Release.DISPLACEMENT)
    assert np.all(data.mean_life == 3)


@pytest.mark.parametrize("count", [1, 4, 30])
def test_the_limits_of_a_mean_life_are_those_of_a_number_of_ends(count):
    """At a limit, as few or as many ends as observed have half the probability that is left."""
    total = 250.0
    times = np.full(50, total / 50)
    ends = np.arange(50) < count
    for confidence in (0.9, 0.95):
        mean, low, high = lives.mean_life(times, ends, confidence)
        rest = (1 - confidence) / 2
        assert mean == pytest.approx(total / count)
        assert poisson.cdf(count, total / low) == pytest.approx(rest, rel=1e-9)
        assert poisson.sf(count - 1, total / high) == pytest.approx(rest, rel=1e-9)
