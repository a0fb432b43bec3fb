"""Simulated balls, by integrators with events, closed forms and other ways of following them."""

import importlib.util
import sys
from itertools import product

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.contacts import one_ball
from bouncing_ball_beyond.motions import bounces
from bouncing_ball_beyond.tables.table import PERIOD


def first_crossing(function, times):
    """The first zero through which a function of the time falls, by samples and a bracket."""
    values = function(times)
    first = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))[0]
    return brentq(function, times[first], times[first + 1], xtol=1e-15, rtol=1e-15)


def flight(amplitude, leaves, gap, w, kappa=0.0):
    """The next impact after a release, by samples of δ, or of δ + κδ′ below the level."""

    def position(t):
        table = amplitude * (np.sin(leaves) - np.sin(leaves + t))
        return gap + (w + amplitude * np.cos(leaves)) * t - t * t / 2 + table

    def rate(t):
        return w + amplitude * (np.cos(leaves) - np.cos(leaves + t)) - t

    def free(t):
        level = position(t)
        return np.where(level < 0, level + kappa * rate(t), 1.0) if kappa else level

    # No flight is longer than that of a ball that leaves and lands at the greatest distance.
    longest = 2 * (abs(w + amplitude * np.cos(leaves)) + np.sqrt(2 * amplitude) + 1)
    time = first_crossing(free, np.arange(1e-4, longest, 1e-3))
    return leaves + time, -rate(time)


def contact(amplitude, tau, u, acceleration, kappa=0.0):
    """The end of a contact with a given acceleration of (gap, rate), by an integrator with an
    event.
    """

    def motion(t, y):
        return [y[1], acceleration(y[0], y[1]) - 1 + amplitude * np.sin(t)]

    def release(t, y):
        return y[0] + kappa * y[1] if t > tau + 1e-9 else -1.0

    release.terminal = True
    release.direction = 1
    start = [kappa * min(u, 0.0), -u]
    solution = solve_ivp(
        motion, (tau, tau + 30), start, "DOP853", events=release, rtol=1e-12, atol=1e-14
    )
    return solution.t_events[0][0], solution.y_events[0][0][1]


def oscillator(ball):
    """The acceleration by a spring and a damper as a function of the gap and its rate."""
    stiffness = ball.frequency_ratio**2
    loss = 2 * float(ball.zeta) * ball.frequency_ratio
    return lambda gap, rate: -loss * rate - stiffness * gap


def reference(ball, amplitude, tau, u, impacts):
    """The times of impacts and their closing speeds, without a formula of the package."""
    states = [(tau, u)]
    for _ in range(impacts - 1):
        leaves, gap, w = tau, 0.0, None
        if isinstance(ball, bb.Rigid):
            w = ball.restitution * u
        else:
            leaves, w = contact(amplitude, tau, u, oscillator(ball), float(ball.kappa))
            gap = -ball.kappa * w
        tau, u = flight(amplitude, leaves, gap, w, 0.0 if ball.kappa == 0 else float(ball.kappa))
        states.append((tau, u))
    return np.array(states).T


BALLS = {
    "restitution": bb.Rigid(0.65),
    "displacement release": bb.SpringDamper(20.0, restitution=0.65),
    "force release": bb.SpringDamper(20.0, restitution=0.65, release="force"),
}


@pytest.mark.parametrize("name", BALLS)
def test_regular_motions_are_those_of_an_integrator_over_many_impacts(name):
    ball = BALLS[name]
    impacts = 1000
    simulated_impacts = bb.simulate(ball, amplitude=1.2, phase=0.5, velocity=-3.0, impacts=impacts)
    tau, u = reference(ball, 1.2, 0.5, 3.0 + 1.2 * np.cos(0.5), impacts)
    assert np.abs(simulated_impacts.time - (tau - 0.5)).max() < 1e-9
    assert np.abs(simulated_impacts.relative_impact_velocity + u).max() < 1e-10


@pytest.mark.parametrize("ball", [*BALLS.values(), bb.SpringDamper(3.0, restitution=0.9)])
def test_chaotic_motions_are_those_of_an_integrator_as_long_as_digits_last(ball):
    """They part from it no faster than from a ball that starts with a speed changed by 10⁻¹¹."""
    start = {"amplitude": 3.0, "phase": 0.5, "impacts": 14}
    times, beside = (bb.simulate(ball, velocity=-3.0 + d, **start).time for d in (0.0, 1e-11))
    tau, _ = reference(ball, 3.0, 0.5, 3.0 + 3.0 * np.cos(0.5), 14)
    parted = np.maximum.accumulate(np.abs(times - beside).values)
    assert parted[-1] > 1e-9
    assert (np.abs(times.values - (tau - 0.5)) < 1e-10 + 10 * parted).all()


def test_both_lines_of_the_restitution_map():
    """Λ(sin τ₁ - sin τ₀) = s v₀ - s²/2 and v₁ = -r(v₀ - s) + (1 + r)Λ cos τ₁ (Eq. 5)."""
    r, amplitude = 0.85, 2.5
    impacts = bb.simulate(bb.Rigid(r), amplitude=amplitude, impacts=300)
    tau, v, s = (
        impacts.impact_phase.values,
        impacts.bounce_velocity.values,
        impacts.flight_time.values,
    )
    # The motion is chaotic: rounding decides whether the ball also rests on the table.
    instant = impacts.contact_duration.values == 0
    assert instant.sum() > 200
    height = amplitude * (np.sin(tau[1:]) - np.sin(tau[:-1]))
    wrong = height - (s * v - s**2 / 2)[:-1]
    assert np.abs(wrong[instant[:-1]]).max() < 1e-12
    after = -r * (v - s)[:-1] + (1 + r) * amplitude * np.cos(tau[1:])
    wrong = v[1:] - after
    assert np.abs(wrong[instant[:-1] & instant[1:]]).max() < 1e-13
    tau, v, s = (quantity[instant, np.newaxis] for quantity in (tau, v, s))
    part = np.linspace(1e-3, 1 - 1e-3, 500) * s
    ball = amplitude * np.sin(tau) + v * part - part**2 / 2
    assert (ball > amplitude * np.sin(tau + part)).all()


def test_a_history_from_a_late_phase_lasts_to_its_end():
    start = {"amplitude": 1.2, "phase": 6.0, "velocity": -3.0}
    longer = bb.history(bb.Rigid(0.5), **start, periods=50)
    # Impacts are computed 32 at once.
    for periods in range(28, 40):
        history = bb.history(bb.Rigid(0.5), **start, periods=periods)
        np.testing.assert_allclose(history.ball, longer.ball[: history.time.size], atol=1e-9)


@pytest.mark.parametrize("r", [0.0, 0.5, 0.9, 0.99])
def test_a_ball_on_a_fixed_table_rests_when_its_bounces_end(r):
    """Bounce k lasts 2 u rᵏ, and all together 2 u r/(1 - r)."""
    impacts = bb.simulate(bb.Rigid(r), amplitude=0.0, velocity=-4.0, impacts=3000)
    number = int(impacts.time.notnull().sum())
    assert impacts.status == "permanent contact"
    assert np.isinf(impacts.contact_duration[number - 1])
    times = 8 * r * (1 - r ** np.arange(number)) / (1 - r)
    assert np.abs(impacts.time[:number] - times).max() < 1e-12
    assert abs(impacts.time[number - 1] - 8 * r / (1 - r)) < 2e-5 / (1 - r)


def test_bounces_that_end_are_summed_up_as_if_they_were_followed():
    """The sum of the flights from speeds ten thousand times smaller on, by landings one by one."""
    amplitude, phase, r = 2.0, 3.0, 0.7
    x, y = amplitude * np.cos(phase), amplitude * np.sin(phase)
    w = 0.3e-5 * (1 - y) ** 2 * (1 - r) / 2
    summed = one_ball.settling(w, r, x, y, amplitude)
    time = 0.0
    while w > 1e-14:
        now = amplitude * np.cos(phase + time), amplitude * np.sin(phase + time)
        flown, u = one_ball.landing(one_ball.earliest(w, *now, amplitude), 0.0, w, *now, amplitude)
        time += flown
        w = r * u
    assert summed > 1e-6
    assert abs(summed - time) < 1e-13


def test_a_ball_that_rests_leaves_where_the_table_falls_faster_than_it():
    amplitude = 2.0
    lift_off = np.arcsin(1 / amplitude)
    ball = bb.Rigid(0.4)
    impacts = bb.simulate(ball, amplitude=amplitude, phase=3.0, relative_velocity=-0.1, impacts=60)
    rests = int(np.argmax(impacts.contact_duration.values > 0))
    leaves = (impacts.impact_phase + impacts.contact_duration)[rests] % PERIOD
    assert abs(leaves - lift_off) < 1e-13
    assert impacts.relative_bounce_velocity[rests] == 0
    lands, u = flight(amplitude, lift_off, 0.0, 0.0)
    assert abs(impacts.flight_time[rests] - (lands - lift_off)) < 1e-12
    assert abs(impacts.relative_impact_velocity[rests + 1] + u) < 1e-12


@pytest.mark.parametrize("speed", [1e-5, 1e-7, 1e-9, 1e-13])
@pytest.mark.parametrize("many", [1, 100])
def test_a_ball_that_leaves_slowly_lands_and_rests(speed, many):
    """The first flight lasts 2w/(1 - Λ sin τ), but for changes of this gravity."""
    phase = xr.DataArray(np.full(many, 0.3), dims="ball")
    start = {"amplitude": 0.5, "phase": phase, "relative_velocity": -speed}
    impacts = bb.simulate(bb.Rigid(0.8), **start, impacts=60)
    assert (impacts.status == "permanent contact").all()
    assert (impacts.time.max("impact") < 20 * speed).all()
    assert bb.motion_of(bb.Rigid(0.8), **start).kind[0] == "permanent contact"
    if speed == 1e-5:
        flown = 2 * 0.8 * speed / (1 - 0.5 * np.sin(0.3))
        assert abs(impacts.flight_time[0, 0] / flown - 1) < 1e-4


# Without a speed a ball leaves only where the table falls away, Λ sin τ ≥ 1.
@pytest.mark.parametrize(
    ("w", "phase"),
    [
        *product([1e-12, 1e-8, 1e-4, 0.3], [0.2, 0.9, 1.6, 2.2]),
        *product([0.0], [0.9, 1.6, 2.2]),
    ],
)
def test_the_first_landing_is_found_where_the_table_falls_away_or_pushes(w, phase):
    """Flights at Λ = 1.8, also those that begin slowly; a landing within 10⁻³ is a short flight."""
    amplitude = 1.8
    x, y = amplitude * np.cos(phase), amplitude * np.sin(phase)
    flown, u = one_ball.landing(one_ball.earliest(w, x, y, amplitude), 0.0, w, x, y, amplitude)
    if y < 1 and w < 1e-2:
        assert abs(flown * (1 - y) / (2 * w) - 1) < 1e-3
        assert abs(u / w - 1) < 1e-3
    else:
        lands, speed = flight(amplitude, phase, 0.0, w)
        assert abs(phase + flown - lands) < 1e-12
        assert abs(u - speed) < 1e-12


def test_a_flight_that_nearly_touches_the_table_goes_on():
    """A ball that touches the table at Λ = 2 and τ = 1.2, where Λ sin τ > 1, is followed back to
    the release from which it came. Thrown faster, it clears the table by 10⁻¹⁰ there, and goes on.
    """
    amplitude, touch = 2.0, 1.2

    def below(t):
        """The table above the ball, a time t before it touches."""
        ball = amplitude * np.sin(touch) - amplitude * np.cos(touch) * t - t * t / 2
        return ball - amplitude * np.sin(touch - t)

    t = first_crossing(below, np.arange(1e-3, 20, 1e-3))
    phase = touch - t
    x, y = amplitude * np.cos(phase), amplitude * np.sin(phase)
    w = amplitude * np.cos(touch) + t - x
    for clearance in (1e-10, -1e-10):
        thrown = w + clearance / t
        start = one_ball.earliest(thrown, x, y, amplitude)
        flown, speed = one_ball.landing(start, 0.0, thrown, x, y, amplitude)
        # It lands a time √(2d/(Λ sin τ - 1)) before it would touch, with a speed proportional to
        # it.
        assert (abs(flown - t) < 1e-4) == (clearance < 0)
        assert flown > t - 1e-4
        assert speed > (0 if clearance < 0 else 0.1)


@pytest.mark.parametrize("ratio", [1.0, 2.0, 30.0])
def test_an_undamped_contact_on_a_fixed_table_keeps_the_energy(ratio):
    ball = bb.SpringDamper(ratio, damping_ratio=0.0)
    impacts = bb.simulate(ball, amplitude=0.0, velocity=-2.0, impacts=60)
    assert np.abs(impacts.bounce_velocity - 2).max() < 1e-11
    # A half oscillation about the depth 1/ϖ² at rest, and the part of the period above it.
    duration = (2 * np.pi - 2 * np.arctan(2 * ratio)) / ratio
    assert np.abs(impacts.contact_duration - duration).max() < 1e-11


def test_contacts_last_below_the_limit_of_permanent_contact():
    """Λ_SD = √γ/ϖ²: slow balls stay below it, and leave above it."""
    ball = bb.SpringDamper(5.0, restitution=0.5)
    zeta = float(ball.zeta)
    limit = np.sqrt((25 - 1) ** 2 + (2 * zeta * 5) ** 2) / 25
    start = {"phase": 3.0, "relative_velocity": -1e-6, "impacts": 40}
    impacts = bb.simulate(ball, amplitude=[0.99 * limit, 1.01 * limit], **start)
    assert impacts.status.values.tolist() == ["permanent contact", "bouncing"]


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_one_by_one_side_by_side_and_by_the_general_contact(release):
    """Scalar loops, arrays, and releases found by another bound give the same impacts."""
    rng = np.random.default_rng(3)
    ball = bb.SpringDamper(rng.uniform(1.5, 60, 80), restitution=0.6, release=release)
    balls = bounces.Balls(
        ball, rng.uniform(0.1, 3, 80), np.zeros(80), rng.uniform(-3, 3, 80), rng.uniform(0, 5, 80)
    )
    side_by_side, going, _ = bounces.bounce(balls, 5)
    columns = [bounces.bounce(balls.take([j]), 5)[0][..., 0] for j in range(80)]
    one_by_one = np.stack(columns, axis=-1)
    assert np.array_equal(np.isnan(one_by_one), np.isnan(side_by_side))
    assert np.allclose(one_by_one, side_by_side, rtol=1e-8, atol=1e-8, equal_nan=True)
    assert np.array_equal(going, np.flatnonzero(np.isfinite(side_by_side[-1, 7])))
    general = ball.first_release(balls.phase, balls.speed, balls.amplitude)
    assert np.array_equal(np.isnan(general), np.isnan(side_by_side[0, 3]))
    assert np.nanmax(np.abs(general - side_by_side[0, 3])) < 1e-10


@pytest.mark.parametrize("many", [1, 60])
@pytest.mark.parametrize(
    "ratio, zeta, amplitude, phase, speed",
    [
        (8.0, 0.3579, 2.7, -0.5, 0.47),
        (5.0, 0.1128, 2.95, -1.6, 0.51),
        (2.0, 0.2155, 1.25, 1.3, 0.57),
    ],
)
def test_contacts_resume_on_the_line_of_zero_force(many, ratio, zeta, amplitude, phase, speed):
    """A ball released by the force falls back to δ + κδ′ = 0 below the level, where u < 0."""
    ball = bb.SpringDamper(ratio, damping_ratio=zeta, release="force")
    start = xr.DataArray(np.full(many, phase), dims="ball")
    given = {"amplitude": amplitude, "phase": start, "relative_velocity": -speed}
    impacts = bb.simulate(ball, **given, impacts=5).isel(ball=0)
    tau, u = reference(ball, amplitude, phase, speed, 5)
    assert impacts.relative_impact_velocity[1] > 1e-2
    assert np.abs(impacts.time - (tau - phase)).max() < 1e-8
    assert np.abs(impacts.relative_impact_velocity + u).max() < 1e-8


def test_balls_rest_side_by_side_as_one_by_one():
    """Sixty slow balls at Λ = 2 all rest and lift off at the same phase, after other turns."""
    ball = bb.Rigid(0.4)
    phase = xr.DataArray(np.linspace(-3, 3, 60), dims="ball")
    amplitude = xr.DataArray(np.linspace(1.5, 2.5, 60), dims="ball")
    given = {"relative_velocity": -0.05, "impacts": 15}
    impacts = bb.simulate(ball, amplitude=amplitude, phase=phase, **given)
    rests = impacts.contact_duration > 0
    assert rests.any("impact").mean() > 0.5
    leaves = (impacts.impact_phase + impacts.contact_duration).where(rests) % PERIOD
    falls = amplitude * np.sin(leaves) > 1 + 1e-9
    assert np.abs(leaves - np.arcsin(1 / amplitude)).where(~falls).max() < 1e-12
    # The time to the next impact is that of the rest and of the flight.
    lasts = impacts.contact_duration + impacts.flight_time
    assert np.abs(impacts.time.diff("impact") - lasts.values[:, :-1]).max() < 1e-12
    for j in range(0, 60, 7):
        alone = bb.simulate(ball, amplitude=float(amplitude[j]), phase=float(phase[j]), **given)
        assert np.abs(alone.time.values - impacts.time.values[j]).max() < 1e-6


@pytest.mark.parametrize("many", [1, 50])
def test_a_ball_that_is_laid_on_the_table(many):
    """At Λ = 2 it is thrown off when the contact is first released, at Λ = 0.3 it stays."""
    ball = bb.SpringDamper(10.0, restitution=0.5)
    amplitude = xr.DataArray(np.repeat([0.3, 2.0], many), dims="ball")
    given = {"amplitude": amplitude, "phase": 3.0, "relative_velocity": 0.0, "impacts": 2}
    impacts = bb.simulate(ball, **given)
    assert (impacts.status[:many] == "permanent contact").all()
    end, _ = contact(2.0, 3.0, 1e-12, oscillator(ball))
    assert np.abs(impacts.contact_duration[many:, 0] - (end - 3.0)).max() < 1e-8
    stays = bb.simulate(bb.Rigid(0.5), **given)
    assert (stays.status[:many] == "permanent contact").all()
    lift_off = np.arcsin(0.5) + PERIOD
    assert np.abs(stays.contact_duration[many:, 0] - (lift_off - 3.0)).max() < 1e-13


def test_contacts_near_the_resonance_and_overdamped_ones_are_simulated():
    near = bb.simulate(bb.SpringDamper(1 + 1e-9, damping_ratio=0.0), amplitude=0.7, impacts=4)
    far = bb.simulate(bb.SpringDamper(1 + 1e-7, damping_ratio=0.0), amplitude=0.7, impacts=4)
    assert np.abs(near.time - far.time).max() < 1e-4
    over = bb.SpringDamper(10.0, damping_ratio=1.5)
    impacts = bb.simulate(over, amplitude=2.0, phase=0.5, impacts=3)
    tau, u = 0.5, np.pi + 2 * np.cos(0.5)
    for k in range(2):
        leaves, w = contact(2.0, tau, u, lambda gap, rate: -30 * rate - 100 * gap)
        tau, u = flight(2.0, leaves, 0.0, w)
        assert abs(impacts.time[k + 1] - (tau - 0.5)) < 1e-8


def test_plain_python_gives_the_numbers_of_compiled_loops(monkeypatch):
    """The file of the loops, loaded again as if numba were not installed."""
    monkeypatch.setitem(sys.modules, "numba", None)
    spec = importlib.util.spec_from_file_location("plain_loops", one_ball.__file__)
    plain = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(plain)
    for given in ((0.65, 0.0, 0.0, 0.0), (0.0, 20.0, 0.1, 0.0), (0.0, 20.0, 0.1, 0.01)):
        both = np.empty((2, 200, len(one_ball.COLUMNS)))
        plain.impacts(0.0, 0.5, 3.0, 1.2, *given, both[0])
        one_ball.impacts(0.0, 0.5, 3.0, 1.2, *given, both[1])
        assert np.abs(both[0] - both[1]).max() < 1e-12


def test_late_impacts_keep_the_digits_of_the_phase():
    """After a transient the ball is on the 1-T orbit, also after 80,000 periods."""
    balls = bounces.Balls(bb.Rigid(0.65), *(np.array([x]) for x in (1.0, 0.0, 1.0, 3.0)))
    for _ in range(4):
        record, _, balls = bounces.bounce(balls, 20_000)
    orbit = bb.orbit(bb.Rigid(0.65), amplitude=1.0)
    assert np.abs(record[1000:, 1] - orbit.phase).max() < 1e-13
    assert abs(record[-1, 0, 0] - 80_000) < 100


def test_a_ball_over_time():
    ball = bb.SpringDamper(5.0, restitution=0.6)
    start = {"amplitude": 1.2, "phase": 0.5}
    history = bb.history(ball, **start, periods=4.0, samples=100)
    impacts = bb.simulate(ball, **start, impacts=5)

    def motion(t, y):
        gap, rate = y[0] - 1.2 * np.sin(t), y[1] - 1.2 * np.cos(t)
        force = -2 * float(ball.zeta) * 5 * rate - 25 * gap
        return [y[1], force - 1]

    # The first contact, and the flight after it.
    end = 0.5 + float(impacts.contact_duration[0])
    inside = history.time.values < end - 0.5
    begin = [1.2 * np.sin(0.5), -np.pi]
    exact = solve_ivp(
        motion, (0.5, end), begin, rtol=1e-12, atol=1e-12, t_eval=0.5 + history.time.values[inside]
    )
    assert np.abs(history.ball.values[inside] - exact.y[0]).max() < 1e-9
    assert np.abs(history.ball_velocity.values[inside] - exact.y[1]).max() < 1e-8
    assert history.contact.values[inside].all()
    speed = np.gradient(history.ball.values, history.time.values)
    assert np.abs(speed - history.ball_velocity.values)[1:-1].max() < 0.3
    assert ((history.ball - history.table > -1e-12) | history.contact).all()


def test_a_dropped_ball_falls_freely_and_comes_to_rest():
    history = bb.drop(bb.Rigid(0.5), height=[2.0, 8.0], periods=4.0)
    falls = history.time <= 2.0
    assert (
        np.abs(history.ball.sel(height=2.0) - (2 - history.time**2 / 2)).where(falls).max() < 1e-12
    )
    # It lands with √(2h), and rests after √(2h) (1 + 2r/(1 - r)).
    assert not history.contact.sel(height=2.0, time=slice(0, 5.9)).any()
    assert history.contact.sel(height=2.0, time=slice(6.01, None)).all()
    moving = bb.drop(bb.Rigid(0.5), height=3.0, amplitude=0.5, phase=1.0, periods=2.0)
    assert float(moving.ball[0]) == 3.0
    assert abs(float(moving.table[0]) - 0.5 * np.sin(1.0)) < 1e-15
    assert float((moving.ball - moving.table).min()) > -1e-12


def test_lists_span_a_grid_and_arrays_of_a_ball_vary_together():
    ball = bb.SpringDamper([5.0, 10.0, 20.0], restitution=[0.5, 0.6, 0.7])
    impacts = bb.simulate(ball, amplitude=[1.0, 1.2], impacts=3)
    assert impacts.time.dims == ("amplitude", "ball", "impact")
    assert impacts.restitution.dims == ("ball",)
    alone = bb.simulate(bb.SpringDamper(10.0, restitution=0.6), amplitude=1.2, impacts=3)
    assert np.abs(impacts.time.sel(amplitude=1.2).isel(ball=1) - alone.time).max() < 1e-13
    assert alone.time.attrs == {"long_name": "time since the start", "symbol": "τ", "units": "1"}
    one = bb.simulate(bb.Rigid([0.5, 0.6]), amplitude=1.0, phase=[0.1, 0.2, 0.3], impacts=2)
    assert one.time.dims == ("phase", "restitution", "impact")
    pairs = {"phase": xr.DataArray([0.1, 0.2], dims="start")}
    pairs["velocity"] = xr.DataArray([-2.0, -3.0], dims="start")
    assert bb.simulate(bb.Rigid(0.5), amplitude=1.0, **pairs).time.dims == ("start", "impact")


def test_mistakes_have_one_line():
    ball = bb.Rigid(0.5)
    with pytest.raises(ValueError, match="velocity = 3: the ball rises from the table"):
        bb.simulate(ball, amplitude=1.0, velocity=3.0)
    with pytest.raises(ValueError, match="amplitude = -1: must be at least 0"):
        bb.simulate(ball, amplitude=[1.0, -1.0])
    with pytest.raises(ValueError, match=r"amplitude = '1\.0': must be a number"):
        bb.simulate(ball, amplitude="1.0")
    with pytest.raises(ValueError, match=r"ball = 0\.7: must be a ball, such as Rigid\(0\.7\)"):
        bb.simulate(0.7, amplitude=1.0)
    with pytest.raises(ValueError, match=r"phase = nan: must be in \(-∞, ∞\)"):
        bb.simulate(ball, amplitude=1.0, phase=np.nan)
    with pytest.raises(ValueError, match="height = 0: is below the table"):
        bb.drop(ball, height=0.0, amplitude=1.0, phase=1.0)


ONE = bb.Rigid(0.5)
TWO = bb.orbit(ONE, amplitude=1.3)
TEXT = {"quantities": "max_height"}


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: bb.simulate(ONE, amplitude=1.0, impacts=2.5), r"impacts = 2\.5: must be a whole"),
        (lambda: bb.motion_of(ONE, amplitude=1.0, impacts=0), "impacts = 0: must be a whole nu"),
        (lambda: bb.basins(ONE, amplitude=-1.0, starts=2), "amplitude = -1: must be in"),
        (
            lambda: bb.orbit_diagram(ONE, amplitude=[-1.0, 1.0]),
            "amplitude = -1: must be at least 0",
        ),
        (lambda: bb.law_errors(bb.SpringDamper(9.0, restitution=0.5), amplitude=-1), "must be in"),
        (lambda: bb.basins(ONE, amplitude=1.2, starts=0), "starts = 0: must be a whole number"),
        (lambda: bb.history(ONE, amplitude=1.0, periods=0), r"periods = 0: must be in \(0, ∞\)"),
        (
            lambda: bb.simulate(ONE, amplitude=1.0, velocity=-1.0, relative_velocity=-1.0),
            "velocity, relative_velocity: give at most one of them",
        ),
        (
            lambda: bb.Rigid("0.5"),
            r"restitution = '0\.5': must be a number or an array in \[0, 1\]",
        ),
        (lambda: bb.Rigid([]), r"restitution = \[\]: must be a number or an array in \[0, 1\]"),
        (lambda: bb.law_thresholds(ONE, amplitude=1.0), r"contacts = Rigid\(.*\): must be a Spri"),
        (
            lambda: bb.exact_errors(bb.SpringDamper(9.0, restitution=0.5), amplitude=1, **TEXT),
            "quantities = 'max_height': must be a list of names",
        ),
        (
            lambda: bb.follow([TWO, TWO], to=[1.2, 1.3, 1.4]),
            r"to = \[1\.2, .*: must be a number, a",
        ),
        (lambda: bb.follow(TWO, to=(1.2, 1.3, 1.4)), r"to = \(1\.2, .*: must be a number, a tuple"),
        (lambda: bb.cascade(TWO, to=2.0, impacts=1), "impacts = 1: must be a whole number from 2"),
        (
            lambda: bb.simulate(ONE, amplitude=xr.DataArray([1.0], dims="impact")),
            "impact: is an axis of the result",
        ),
    ],
)
def test_arguments_that_make_no_sense_are_named_in_one_line(call, text):
    with pytest.raises(ValueError, match=text) as raised:
        call()
    assert "\n" not in str(raised.value)


LAID = {
    "restitution": bb.Rigid(0.5),
    "spring and damper": bb.SpringDamper(20.0, restitution=0.65),
    "hertz": bb.tsuji(restitution=0.65, duration=0.1, speed=3.8),
}


@pytest.mark.parametrize("name", LAID)
def test_a_ball_that_is_dropped_from_the_table_itself_lies_on_it(name):
    """At rest, while the table rises, and while it falls as fast as a ball of the same speed."""
    ball = LAID[name]
    history = bb.drop(ball, height=0.0, periods=0.3, samples=20)
    assert history.contact[1:].all()
    # At most twice the static penetration, which is 1/ϖ² for the spring, (1/K)^(2/3) for the law.
    assert (np.abs(history.ball) < 2 * 3400 ** (-2 / 3)).all()
    rising = bb.drop(ball, height=0.5 * np.sin(0.3), amplitude=0.5, phase=0.3, periods=0.3)
    assert np.isfinite(rising.ball).all()
    assert (rising.ball > rising.table - 0.1).all()
    # A height that the user has computed is that of the table but for rounding.
    level = np.nextafter(0.5 * np.sin(0.3), 0.0)
    assert bb.drop(ball, height=level, amplitude=0.5, phase=0.3, periods=0.3).identical(rising)


@pytest.mark.parametrize("phase", [0.5, 2.5, -2.0, 4.0])
def test_the_first_sample_of_a_drop_is_its_height(phase):
    """Also where rounding puts the beginning of the fall after the time 0."""
    for height in np.linspace(1.6, 9.0, 40):
        history = bb.drop(bb.Rigid(0.5), height=height, amplitude=1.5, phase=phase, periods=0.1)
        assert history.ball[0] == pytest.approx(height, abs=1e-12)


def test_a_ball_of_a_law_that_is_laid_on_the_table_is_followed_in_time():
    """Its root time is a million where that of an impact is one; an integrator has the same."""
    law = LAID["hertz"]
    history = bb.history(law, amplitude=0.5, phase=0.3, relative_velocity=0.0, periods=0.5)

    def motion(t, y):
        force = law.force(max(-y[0], 0.0), -y[1], **law.values)
        return [y[1], -1 + 0.5 * np.sin(t + 0.3) + force]

    times = history.time.values
    known = {"t_eval": times, "rtol": 1e-11, "atol": 1e-13}
    solution = solve_ivp(motion, (0, times[-1]), [0.0, -1e-12], "Radau", **known)
    np.testing.assert_allclose(history.ball - history.table, solution.y[0], atol=1e-9)


@pytest.mark.parametrize(
    "table", [bb.tables.table.SINE, bb.Table([(1, 1.5, 0.0)])], ids=["loop", "rows"]
)
def test_landings_just_before_a_lift_off_take_few_steps(monkeypatch, table):
    """δ = vt - gt²/2 - w‴t³/6 for short flights; the gravity g on the table nearly vanishes.

    Rounding errors of t, relative to vt, limit the digits.
    """
    speed = 1e-12
    steps = []

    def counted(t, f, slope, second, bend, jerk):
        steps.append(t)
        assert len(steps) < 100
        return whole(t, f, slope, second, bend, jerk)

    gravity = 1e-7
    scale = 1.5 if table is bb.tables.table.SINE else 1.0
    phase = np.pi - np.arcsin((1 - gravity) / 1.5)
    waves = table.waves(phase, scale)
    x = 1.5 * np.cos(phase)
    if table is bb.tables.table.SINE:
        whole = getattr(one_ball.safe_step, "py_func", one_ball.safe_step)
        landing = getattr(one_ball.landing, "py_func", one_ball.landing)
        monkeypatch.setattr(one_ball, "safe_step", counted)
        time, _ = landing(0.0, 0.0, speed, *waves, 1.5)
    else:
        whole = bounces.safe_steps
        monkeypatch.setattr(bounces, "safe_steps", counted)
        given = (np.array([number]) for number in (0.0, 1.0, 0.0, speed, *waves))
        time = bounces.landings(table, *given)[0]
    known = 2 * speed / (gravity / 2 + np.sqrt(gravity**2 / 4 - 2 * speed * x / 3))
    assert time == pytest.approx(known, rel=np.finfo(float).eps / speed)


def test_results_that_do_not_fit_into_memory():
    for call, given, text in (
        (bb.simulate, {"impacts": 10**15}, "impacts = 1000000000000000: the results do not fit"),
        (bb.history, {"periods": 1e13}, r"periods = 1e\+13, samples = 200: the results do not fit"),
    ):
        with pytest.raises(ValueError, match=text):
            call(bb.Rigid(0.5), amplitude=1.2, **given)
