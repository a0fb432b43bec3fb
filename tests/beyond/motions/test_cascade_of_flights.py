"""The cascade of flights above Λ_SD: by simulation, in its limit, and by another program."""

from functools import cache

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from sixty_digits import Exact

from bouncing_ball.beyond.motions.cascade_of_flights import Openings, openings, stiff_openings
from bouncing_ball.errors import ModelError
from bouncing_ball.long_run.destination import IMPACTS, final_motions
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper


def motions(r, ratio, excess, impacts=IMPACTS):
    """What a ball that is set down after the top of the table ends on, at E."""
    zeta = damping_ratio(r)
    excess = np.asarray(excess)
    lam = permanent_contact_threshold(ratio, zeta) + excess / np.square(ratio)
    phase = np.pi / 2 + 3 / ratio
    slow = lam * np.cos(phase) - 0.1 / np.square(ratio)
    model = ContactModel(SpringDamper(ratio, zeta))
    return final_motions(model, lam, phase, slow, impacts=impacts)


# ϖ = 27.1 lies between the ratios at which the second opening of r = 0.95 exists.
WEAK = 200 ** (1 - 13 / 24) * 5 ** (13 / 24)
# Simulations of several contacts take as long as those of the slowest one, so that contacts of one
# speed are computed at once; each group is computed when a test asks for it.
STIFF = (0.3, 0.65, 0.85), (31.6, 100.0, 200.0), 3
WEAKLY_DAMPED = (0.95,), (100.0, 200.0), 2
HARDLY_STIFF = (0.95,), (WEAK,), 1
COMPLIANT = (0.85,), (12.0,), 2


@cache
def computed(r, ratio, most):
    return openings(damping_ratio(np.array(r)), np.array(ratio), most)


def opened(r, ratio):
    """The openings at (r, ϖ), of contacts of one group."""
    for group in (STIFF, WEAKLY_DAMPED, HARDLY_STIFF, COMPLIANT):
        rows, columns, most = group
        if set(r) <= set(rows) and set(ratio) <= set(columns):
            of_ratio = [columns.index(x) for x in ratio]
            where = np.ix_([rows.index(x) for x in r], range(most), of_ratio)
            return Openings(*(x[where] for x in computed(*group)))
    raise KeyError(r, ratio)


@pytest.mark.parametrize(
    ("r", "ratio", "excess", "flights", "multipliers"),
    [
        (0.65, 10.3, [12.5, 25.0], [2, 2], [0.041, 0.330]),
        (0.85, 20.0, [9.5, 20.0], [2, 3], [0.072, 0.245]),
        (0.85, 100.0, [9.5], [2], [0.0]),
    ],
)
def test_the_flights_and_multipliers_are_those_that_another_program_found(
    r, ratio, excess, flights, multipliers
):
    found = motions(r, ratio, excess)
    assert (found.periods == 1).all() and found.impacts.tolist() == flights
    np.testing.assert_allclose(np.exp(found.exponent), multipliers, atol=5e-4)


def test_balls_have_as_many_flights_as_the_cascade_says():
    r, ratio, most = STIFF
    found = opened(r, ratio)
    r, ratio = map(np.array, (r, ratio))
    held = permanent_contact_threshold(ratio, damping_ratio(r)[:, np.newaxis])
    top = ratio**2 * (found.amplitude - held[:, np.newaxis])
    stable = found.multiplier < 1
    assert stable.sum() >= 25
    below = np.concatenate([np.zeros_like(top[:, :1]), top[:, :-1]], axis=1)
    flights = np.broadcast_to(np.arange(1, most + 1)[:, np.newaxis], top.shape)
    # Balls between two openings, below one, and above it: all of them at once.
    excess = np.stack([(below + top) / 2, 0.999 * top, 1.0001 * top])
    seen = motions(*(np.broadcast_to(x, excess.shape)[:, stable] for x in
                     (r[:, np.newaxis, np.newaxis], ratio, excess)))  # fmt: skip
    assert (seen.periods == 1).all()
    more = np.array([0, 0, 1])[:, np.newaxis]
    np.testing.assert_array_equal(seen.impacts, flights[stable] + more)
    # The power 3/2 of the new flight changes the multipliers by the root of the excess: near the
    # opening they are still those of the opening.
    off = np.exp(seen.exponent[-1]) - found.multiplier[stable]
    assert np.abs(off).max() < 0.05


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


def missed(exact, amplitude, touch, *impacts):
    """The defects of an orbit whose last contact touches the level of the table at a time.

    The impacts are θ, v and the duration of each contact, one after another.
    """
    found = []
    for i in range(0, len(impacts), 3):
        phase, velocity, duration = impacts[i : i + 3]
        start = velocity, amplitude * mp.cos(phase), amplitude * mp.sin(phase)
        height, rate = exact.state(duration, *start)
        later = (*impacts[i + 3 :], impacts[0] + 2 * mp.pi, *impacts[1:])
        time = later[0] - phase - duration
        leaves = phase + duration
        fallen = mp.sin(leaves) + time * mp.cos(leaves) - mp.sin(leaves + time)
        slowed = mp.cos(leaves) - mp.cos(leaves + time)
        landing = rate * time - time**2 / 2 + amplitude * fallen
        found += [height, landing, rate - time + amplitude * slowed - later[1]]
    return [*found, *exact.state(touch, *start)]


@pytest.mark.parametrize(
    ("r", "ratio", "k"),
    [(0.3, 100.0, 2), (0.65, 31.6, 3), pytest.param(0.95, 100.0, 2, marks=pytest.mark.long)],
)
def test_an_opening_is_that_of_its_equations_in_sixty_digits(r, ratio, k):
    """By equations of their own: the touch is a time with δ = δ′ = 0 there, and an unknown."""
    zeta = damping_ratio(r)
    amplitude = opened([r], [ratio]).amplitude[0, k - 1, 0]
    law = SpringDamper(ratio, zeta)
    threshold = permanent_contact_threshold(ratio, zeta)
    below = (1 - 1e-6) * (amplitude - threshold)
    seen = motions(r, ratio, ratio**2 * below)
    impacts = ContactModel(law).simulate(
        threshold + below, float(seen.end_phase), float(seen.end_velocity), k
    )
    rows = np.array([impacts.phase[0] + impacts.time, impacts.relative_velocity,
                     impacts.contact_duration])  # fmt: skip
    # The orbit starts with the impact after the longest contact.
    last = int(rows[2].argmax())
    rows[0, : last + 1] += 2 * np.pi
    rows = np.roll(rows, -1 - last, axis=1)
    time = np.linspace(0, 3 * np.pi / ratio, 10_001)
    heights = law.flow(time, 0.0, rows[1, -1], rows[0, -1], amplitude).displacement
    top = time[1:-1][(heights[1:-1] > heights[:-2]) & (heights[1:-1] >= heights[2:])][0]
    with mp.workdps(60):
        exact = Exact(law, 1)
        y = mp.matrix([float(x) for x in (amplitude, top, *rows.T.ravel())])
        step = mpf(10) ** -25
        for _ in range(7):
            here = mp.matrix(missed(exact, *y))
            matrix = mp.matrix(len(y), len(y))
            for column in range(len(y)):
                moved = y.copy()
                moved[column] += step
                matrix[:, column] = (mp.matrix(missed(exact, *moved)) - here) / step
            y -= mp.lu_solve(matrix, here)
        assert mp.norm(mp.matrix(missed(exact, *y))) < 1e-50
        # The budget of Λ in the record, in units of its range.
        assert abs(y[0] - mpf(float(amplitude))) < 1e-14


def test_the_multipliers_are_those_of_the_motion():
    found = Openings(*(x[0, :2, 0] for x in opened([0.85], [31.6])))
    held = permanent_contact_threshold(31.6, damping_ratio(0.85))
    excess = 31.6**2 * (found.amplitude - held)
    seen = motions(0.85, 31.6, (1 - 1e-9) * excess)
    np.testing.assert_allclose(np.exp(seen.exponent), found.multiplier, rtol=1e-3)


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


@pytest.mark.parametrize("r", [0.3, 0.65, 0.85, 0.95])
def test_the_limits_are_reached_with_the_square_of_the_ratio(r):
    zeta = float(damping_ratio(r))
    ratio = np.array([100.0, 200.0])
    found = opened([r], ratio).amplitude[0, :2]
    excess = ratio**2 * (found - permanent_contact_threshold(ratio, zeta))
    off = stiff_openings(zeta, 2)[:, np.newaxis] - excess
    # But for the next order, and for the weak oscillation that is left when the ball leaves again.
    np.testing.assert_allclose(off[:, 0] / off[:, 1], 4, atol=0.4)


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


def test_on_a_weakly_damped_contact_the_orbit_loses_its_stability_between_two_openings():
    """At ϖ = 27.1 the first opening is at E = 5.5, and the equations have another one at 6.0."""
    r = 0.95
    seen = motions(r, WEAK, [5.4, 5.6, 5.92], impacts=500)
    assert seen.periods[0] == 1 and seen.impacts[0] == 1 and np.exp(seen.exponent[2]) > 1
    found = opened([r], [WEAK]).amplitude[0, 0, 0]
    excess = WEAK**2 * (found - permanent_contact_threshold(WEAK, damping_ratio(r)))
    assert 5.4 < excess < 5.6


@pytest.mark.long
def test_the_second_opening_of_a_weakly_damped_contact_has_no_stable_orbit_below_it():
    first, second = computed((0.95,), (WEAK,), 2).amplitude[0, :, 0]
    assert np.isfinite(first) and np.isnan(second)
    # Stiffer ones have it.
    assert np.isfinite(opened([0.95], [100.0]).amplitude).all()


def test_an_opening_is_the_first_from_below_and_does_not_depend_on_the_other_contacts():
    """At ϖ = 12 the flights rise from 2 to 3 at Λ = 1.06155 and again at 1.07511."""
    zeta = damping_ratio(0.85)
    lam = np.array([1.0614, 1.0617, 1.0745, 1.0755])
    excess = 144 * (lam - permanent_contact_threshold(12.0, zeta))
    assert motions(0.85, 12.0, excess).impacts.tolist() == [2, 3, 2, 3]
    assert opened([0.85], [12.0]).amplitude[0, 1, 0] == pytest.approx(1.06155, abs=1e-5)
    among_others = opened([0.65], [31.6])
    alone = openings(damping_ratio(np.array([0.65])), np.array([31.6]), 1)
    for x, y in zip(among_others, alone, strict=True):
        np.testing.assert_allclose(x[0, :1], y[0], rtol=0, atol=1e-12)


@pytest.mark.long
def test_no_compliant_contact_has_a_second_opening():
    compliant, stiffer = computed((0.85,), (6.3, 12.0), 2).amplitude[0].T
    assert np.isnan(compliant[1]) and np.isfinite(stiffer).all()
    # Still stiffer ones have it, too.
    assert np.isfinite(opened([0.85], STIFF[1]).amplitude).all()
