"""Drake's contact with Hunt and Crossley's damping, at a time step that is given."""

import re
from dataclasses import replace

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import Trial, drake, only_if_installed
from scipy.optimize import brentq

from bouncing_ball.contacts.engines.drake import HuntCrossleyDrake
from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.errors import ModelError
from bouncing_ball.models.damping import Release

GIVEN = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}
ASKED = {"mass": 0.5, "from_engine": "drake", "parameters": GIVEN}


def impact(speed, step, fraction, damping=0.5):
    """r of one impact, by the equation of each step as it is written, solved by bisection."""
    x = -fraction * step * speed
    v = -speed
    for _ in range(10_000):
        if x >= 0:
            return v / speed
        p = -x

        def rest(after, p=p, before=v):
            force = 1e5 * max(p - step * after, 0.0) * max(1 - damping * after, 0.0)
            return 0.5 * (after - before) - step * force

        v = brentq(rest, v, p / step + 1 / damping + abs(v), xtol=1e-15)
        x += step * v
    return 0.0


@pytest.mark.parametrize("speed", [0.3, 2.0])
@pytest.mark.parametrize("step", [1e-4, 1e-3, 3e-3])
def test_the_range_is_that_of_single_impacts(step, speed):
    at = answered(**ASKED, time_step=step, speed=speed).at_step
    many = np.array([impact(speed, step, f) for f in np.linspace(1e-6, 1.0, 401)])
    # Instants 2.5e-3 apart; r changes by less than 2 over one step.
    assert at.least == pytest.approx(many.min(), abs=5e-3)
    assert at.most == pytest.approx(many.max(), abs=5e-3)
    assert at.mean == pytest.approx(many.mean(), abs=5e-3)
    assert at.least <= many.min() + 1e-9 and at.most >= many.max() - 1e-9


def test_the_retuned_damping_restores_the_mean():
    at = answered(**ASKED, time_step="0.1 ms", speed="1 m/s").at_step
    tuned = ASKED | {"parameters": GIVEN | {"hunt_crossley_dissipation": at.retuned}}
    again = answered(**tuned, time_step="0.1 ms", speed="1 m/s").at_step
    assert not at.is_within and again.mean == pytest.approx(at.restitution, abs=1e-8)


def test_a_step_among_the_parameters_and_one_beside_them_are_one_question(said, refusal):
    beside = answered(**ASKED, time_step="1 ms", speed="1 m/s").at_step
    among = ASKED | {"parameters": GIVEN | {"time_step": 1e-3}}
    found = answered(**among, speed="1 m/s").at_step
    assert found == replace(beside, is_of_parameters=True)
    # On a table the speed is that of the orbit.
    shaken = answered(**ASKED, time_step="1 ms", frequency="20 Hz", acceleration="0.8 g", n=1)
    assert shaken.at_step.speed == shaken.found.judged.impact_speed
    options = ("--from=drake", "--mass=0.5", "--time-step=1 ms", "--speed=1 m/s")
    sets = [f"--set={name}={value}" for name, value in GIVEN.items()]
    text = said("design", *options, *sets)
    assert "a free impact at 1 m/s has r = 0.4218 to 0.5201 in place of 0.7484" in text
    with refusal(ModelError, "check the units"):
        answered(**ASKED, time_step="100 s", speed="1 m/s")


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("step", [1e-4, 1e-3, 3e-3])
def test_drake_itself_has_this_range(step):
    only_if_installed("drake")
    ball = Physical(0.5, 1e5, 1.0)
    settings = HuntCrossleyDrake({"stiffness": 1e5, "damping": 0.5}).settings(ball)
    text = re.sub(r"time_step=[^)]*", f"time_step={step!r}", settings.snippet)
    settings = replace(settings, time_step=step, snippet=text, release=str(Release.FORCE))
    at = answered(**ASKED, time_step=step, speed="1 m/s").at_step
    for fraction in (0.02, 0.3, 0.7, 0.98):
        away, _ = drake(Trial(settings, 0.5, fraction * step, -1.0, 12 + int(0.05 / step)))
        r = (away[-1] - away[-2]) / step
        # The ball arrives at this fraction of the step after the one before the contact.
        assert at.least - 1e-5 <= r <= at.most + 1e-5
        assert r == pytest.approx(impact(1.0, step, 1 - fraction), abs=1e-5)
