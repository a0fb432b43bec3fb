"""Openings of stiff contacts: by another integrator, and against those of finite stiffness."""

import numpy as np
import pytest
from openings_found import motions, opening, threshold
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights, stiff_openings
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.job import typed
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper


def test_the_dataset_has_the_limits_of_each_restitution_and_their_ratios(described):
    given = {"restitution": [0.85, 0.65], "flights": 3}
    found = described(typed(cascade_of_flights)(given))
    for r in given["restitution"]:
        one = found.sel(restitution=r)
        limits = stiff_openings(float(damping_ratio(r)), 3)
        assert one.stiff_opening.values.tolist() == limits.tolist()
        growth = r**2 * limits[1:] / limits[:-1]
        np.testing.assert_allclose(one.stiff_opening_ratio, growth, rtol=1e-14)


@pytest.mark.parametrize("r", [0.3, 0.65, 0.85, 0.95])
@pytest.mark.parametrize("k", [1, 2])
def test_the_limits_are_reached_with_the_square_of_the_ratio(r, k):
    ratio = np.array([100.0, 200.0])
    amplitude = np.array([opening(r, each, k).amplitude for each in ratio.tolist()])
    excess = ratio**2 * (amplitude - threshold(r, ratio))
    off = stiff_openings(float(damping_ratio(r)), k)[-1] - excess
    # But for the next order, and for the weak oscillation that is left when the ball leaves again.
    np.testing.assert_allclose(off[0] / off[1], 4, atol=0.4)


def test_the_limit_is_that_of_its_equation_by_another_integrator():
    """At E_k contact k after the first landing just touches x = 0."""
    r = 0.65
    zeta = float(damping_ratio(r))
    for k, excess in enumerate(stiff_openings(zeta, 3), 1):
        level = excess + 2 * zeta**2 - 1

        def pull(s, y, held, level=level):
            return [y[1], level - s * s / 2 - held * (2 * zeta * y[1] + y[0])]

        def table(_, y, held):
            return y[0] if held >= 0 else 0.0

        rate = np.sqrt(2 * excess)
        s = 2 * zeta - rate
        y = [0.0, rate]
        exact = {"rtol": 1e-11, "atol": 1e-13}
        for leg in range(2 * k - 1):
            table.terminal = True
            table.direction = 1 if leg % 2 else -1
            y[0] = 1e-12 if leg % 2 == 0 else -1e-12
            run = solve_ivp(pull, (s, s + 99), y, args=(leg % 2,), events=table, **exact)
            s = run.t[-1]
            y = list(run.y[:, -1])
        run = solve_ivp(pull, (s, s + 6), y, args=(1,), max_step=0.01, **exact)
        rises = np.flatnonzero((run.y[1, :-1] > 0) & (run.y[1, 1:] <= 0))[0]
        assert abs(run.y[0, rises]) < 1e-4 * excess


@pytest.mark.parametrize(("r", "openings"), [(0.3, 11), (0.5, 15), (0.65, 16)])
def test_the_ratio_of_openings_tends_to_one_over_r_squared_with_an_error_of_order_k_r_to_the_k(
    r, openings
):
    excess = stiff_openings(float(damping_ratio(r)), openings)
    apart = excess[1:] / excess[:-1] * r**2 - 1
    k = np.arange(1, openings)
    share = apart / (k * r**k)
    assert np.all(share > 0) and np.all(np.diff(share) < 0)
    assert 0 < apart[-1] < 2e-3


@pytest.mark.parametrize(("r", "most"), [(0.3, 11), (0.5, 15)])
def test_chattering_multiplies_the_openings_by_the_square_of_the_restitution(r, most):
    """r² E_{k+1}/E_k = 1 + (a + b k) r^k: k contacts take a part of the chatter of order k r^k."""
    limits = stiff_openings(float(damping_ratio(r)), most)
    away = (r**2 * limits[1:] / limits[:-1] - 1) / r ** np.arange(1, most)
    slopes = np.diff(away)[-3:]
    assert 0 < slopes[-1] < 0.1
    np.testing.assert_allclose(slopes, slopes[-1], rtol=0.03)


@pytest.mark.parametrize("zeta", [0.0, 0.95, np.nan])
def test_without_an_oscillation_that_dies_out_there_is_no_limit(zeta):
    with pytest.raises(ModelError, match=r"in \(0, 0.9\]"):
        stiff_openings(zeta, 1)


def test_a_new_flight_changes_the_motion_by_the_power_of_three_halves():
    """The motion that opens at a height η above the table, against the one held in contact."""
    law = SpringDamper(20.0, 0.12)
    lam, phase, later = 1.1, 2.3, 3.0

    def held(velocity, time):
        return law.flow(time, 0.0, velocity, phase, lam)[:2]

    def top(velocity):
        time = np.linspace(0.05, 0.3, 20_001)
        return held(velocity, time)[0].max()

    touch = brentq(top, -0.2, -0.02)
    heights = []
    apart = []
    for part in (1e-2, 2.5e-3, 6.25e-4):
        velocity = touch * (1 + part)
        motion = ContactModel(law).simulate(lam, phase, lam * np.cos(phase) + velocity, 2)
        start = motion.time[1] - motion.time[0]
        flow = law.flow(later - start, 0.0, motion.relative_velocity[1], motion.phase[1], lam)
        heights.append(top(velocity))
        apart.append(np.subtract(flow[:2], held(velocity, later)))
    power = np.diff(np.log(np.abs(apart)), axis=0) / np.diff(np.log(heights))[:, np.newaxis]
    np.testing.assert_allclose(power, 1.5, atol=0.03)


def test_on_a_weakly_damped_contact_the_orbit_loses_its_stability_after_the_first_opening():
    """At ϖ = 27.1 the first opening is at E = 5.5."""
    r = 0.95
    ratio = 27.1
    seen = motions(r, ratio, [5.4, 5.6, 5.92], impacts=500)
    assert seen.periods[0] == 1 and seen.impacts[0] == 1 and np.exp(seen.exponent[2]) > 1
    excess = ratio**2 * (opening(r, ratio, 1, start=5.4).amplitude - threshold(r, ratio))
    assert 5.4 < excess < 5.6
