"""Returns from the lift-off, against the mapper and discontinuities."""

import numpy as np

from bouncing_ball.beyond.motions.lift_off import laps
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.rigid import RestitutionModel

LYING = -np.pi / 2, 0.0


def test_a_return_is_the_mappers_locked_orbit():
    r = np.linspace(0.2, 0.6, 9)
    lam = np.linspace(2.0, 4.6, 9)
    found = laps(r, lam, 300)
    mapped = final_motions(RestitutionModel(r), lam, *LYING, impacts=600)
    locked = (mapped.kind == "locked") & ~mapped.is_unresolved()
    assert locked.sum() > 5
    assert np.array_equal(found.periods[locked], mapped.periods[locked])
    assert np.array_equal(found.impacts[locked], mapped.impacts[locked])
    assert laps(0.5, 1.3, 5).periods == 0  # no sticking within so few impacts


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
