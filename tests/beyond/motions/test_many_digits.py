"""Balls followed with many digits, against mpmath with other formulas and against doubles."""

import math

import mpmath
import numpy as np
import pytest

from bouncing_ball.beyond.motions.lift_off import laps
from bouncing_ball.beyond.motions.many_digits import ManyDigits
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.rigid import RestitutionModel


def landing(height, speed, phase, lam):
    """The time until the ball meets the table again: small steps, halving, and Newton's method."""

    def gap(s):
        return height + speed * s - s * s / 2 - lam * mpmath.sin(phase + s)

    def rate(s):
        return speed - s - lam * mpmath.cos(phase + s)

    start = [float(x) for x in (height, speed, phase, lam)]
    above, rising, at, amplitude = start
    relative = rising - amplitude * math.cos(at)
    # At the lift-off the table recedes, so that a ball at rest on it is in the air after any step.
    step = min(0.01, relative / (1 + amplitude) / 4) if relative > 1e-9 else 0.01
    after = step
    low = step
    while above + rising * after - after**2 / 2 - amplitude * math.sin(at + after) > 0:
        low = after
        after = max(after + 0.01, 2 * after) if after < 0.005 else after + 0.01
    after = mpmath.mpf(after)
    low = mpmath.mpf(low)
    for _ in range(40):
        middle = (low + after) / 2
        low, after = (middle, after) if gap(middle) > 0 else (low, middle)
    for _ in range(12):
        after -= gap(after) / rate(after)
    return after, rate(after)


def lap(r, lam, digits, most=400):
    """Impacts and periods from the lift-off to the next one, in absolute coordinates."""
    with mpmath.workdps(digits):
        r = mpmath.mpf(r)
        lam = mpmath.mpf(lam)
        phase = mpmath.asin(1 / lam)
        speed = lam * mpmath.cos(phase)
        lift = phase
        for count in range(1, most):
            flown, relative = landing(lam * mpmath.sin(phase), speed, phase, lam)
            phase += flown
            load = 1 - lam * mpmath.sin(phase)
            speed = lam * mpmath.cos(phase) - r * relative
            bounces = -2 * r * relative / (load * (1 - r))
            if load > 0 and bounces < 1e-5 * load / max(lam, 1):
                periods = mpmath.ceil((phase + bounces - lift) / (2 * mpmath.pi))
                return count, int(periods)
    return None


@pytest.mark.parametrize(("r", "lam", "digits"), [(0.6, 3.0, 60), (0.4, 2.1, 250)])
def test_the_lap_is_that_of_mpmath(r, lam, digits):
    stop = ManyDigits(r, lam).after_lift_off(400)
    assert (stop.impacts, round(stop.time / (2 * math.pi))) == lap(r, lam, digits)


def test_the_lap_has_the_periods_of_doubles_where_these_suffice():
    rng = np.random.default_rng(4)
    r, lam = rng.uniform([[0.2], [1.5]], [[0.6], [4.5]], (2, 30))
    found = laps(r, lam, 60)
    stops = [ManyDigits(float(r[k]), float(lam[k])).after_lift_off(100) for k in range(30)]
    # Three of a double's digits are left.
    kept = [k for k, s in enumerate(stops) if s is not None and s.impacts < 60 and s.digits < 13]
    assert len(kept) > 10
    for k in kept:
        assert stops[k].impacts == found.impacts[k]
        assert round(stops[k].time / (2 * math.pi)) == found.periods[k]


def test_a_ball_that_lands_on_the_table_sticks_where_doubles_see_it():
    start = 2.0, -1.5
    table = ManyDigits(0.4, 2.1)
    stop = table.after_impact(*start, 100)
    # The motion is known to be locked at the second sticking; the end is that of the first one.
    found = final_motions(RestitutionModel(0.4), 2.1, *start)
    path = RestitutionModel(0.4).simulate(2.1, *start, stop.impacts + 1)
    assert path.phase[stop.impacts] == pytest.approx(float(found.end_phase), abs=1e-12)
    assert table.after_lift_off(100) is None
    assert table.after_lift_off(400).digits > 100
