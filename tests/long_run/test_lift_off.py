"""Returns from the lift-off, against the mapper, the corrected model and discontinuities."""

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.lift_off import laps
from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel

LYING = -np.pi / 2, 0.0


def test_a_return_is_the_mappers_locked_orbit():
    r = np.linspace(0.2, 0.6, 9)
    lam = np.linspace(2.0, 4.6, 9)
    found = laps(r, lam, 300)
    mapped = final_motions(RestitutionModel(r), lam, *LYING, impacts=600)
    locked = (mapped.kind == "locked") & ~mapped.is_unresolved()
    assert locked.sum() > 5 and mapped.is_unresolved().any()
    # Where the mapper does not know the period, the delay exceeds the digits of a double.
    unresolved = mapped.is_unresolved()
    assert np.all(found.sensitivity[unresolved] * np.finfo(float).eps > 1e-8)
    assert np.array_equal(found.periods[locked], mapped.periods[locked])
    assert np.array_equal(found.impacts[locked], mapped.impacts[locked])
    assert laps(0.5, 1.3, 5).periods == 0  # no sticking within so few impacts


def test_the_sensitivity_is_the_corrected_models_to_first_order():
    """The phase at which chattering ends, from one of its bounces, in both models."""
    r, lam = 0.5, 2.5
    found = laps(r, lam, 100)
    late = []
    for ratio in (1e4, 2e4):
        ends = []
        for model in three_models(np.array(r), ratio, Release.DISPLACEMENT)[:2]:
            path = model.simulate(lam, *LYING, 20)
            # Bounce 14 of 25, which is followed by T = 2 r v/(g (1 - r)) of chattering.
            phase = path.phase[14]
            speed = -path.relative_velocity[14]
            ends.append(phase + 2 * r * speed / ((1 - lam * np.sin(phase)) * (1 - r)))
        late.append(ratio * abs(ends[1] - ends[0]))
    # Richardson; the bounces after the 14th delay it by a few of their durations over T.
    assert 2 * late[1] - late[0] == pytest.approx(float(found.sensitivity), rel=0.02)


def test_a_contact_has_the_orbit_where_it_is_stiff_enough():
    """The case of which no stiffness up to 5120 was enough, far on both sides of S/w."""
    found = laps(0.6, 3.0, 100)
    wanted = float(found.sensitivity / found.wait)
    contact = three_models(np.array(0.6), wanted * np.array([0.01, 10.0]), Release.DISPLACEMENT)[-1]
    mapped = final_motions(contact, 3.0, *LYING, impacts=400)
    assert wanted > 1e5 and mapped.periods[1] == found.periods != mapped.periods[0]


def test_at_a_discontinuity_the_wait_vanishes():
    """The chattering ends at the lift-off there; beyond, the ball misses it."""
    r, low, high = 0.3, 3.9, 4.1
    period = laps(r, low, 50).periods
    assert laps(r, high, 50).periods != period
    for _ in range(4):
        grid = np.linspace(low, high, 1025)
        last = np.argmin(laps(r, grid, 50).periods == period)
        low = grid[last - 1]
        high = grid[last]
    waits = [laps(r, x, 50).wait for x in (low, high)]
    assert np.nanmin(waits) < 1e-4 < laps(r, low - 0.01, 50).wait
