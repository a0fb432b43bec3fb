"""An orbit: its observables, its motion, its monodromy, and its margins."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq, minimize_scalar

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.simulation import next_impact
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch, required_orbit
from bouncing_ball_beyond.inherited.periodic.orbit import (
    Bifurcation,
    Orbit,
    Side,
    check_index,
    difference,
    flight_margin,
    monodromy,
    multipliers,
    path,
    release_margin,
    trace_and_determinant,
)
from bouncing_ball_beyond.inherited.periodic.restitution_branch import RestitutionBranch
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import branch_point

EPS = np.finfo(float).eps
SHARES = np.linspace(0, 1, 2001)[1:-1, np.newaxis]
MODELS = [
    RestitutionModel(0.85),
    SpringDamper(10.0, 0.05),
    SpringDamper(10.0, 0.05, "force"),
    SpringDamper(2.0, 0.2),
]
every_model = pytest.mark.parametrize("model", MODELS, ids=str)
every_release = pytest.mark.parametrize("release", Release)


@every_model
def test_the_observables_are_those_of_the_simulated_cycle(model):
    orbit = required_orbit(model, 1, 1.0)
    leg = next_impact(model, orbit.phase, orbit.relative_impact_velocity, 1.0)
    assert float(leg.time) == pytest.approx(2 * np.pi, abs=1e-12)
    assert float(leg.departure.duration) == pytest.approx(float(orbit.contact_duration), abs=1e-12)
    left = float(leg.departure.velocity)
    assert float(orbit.relative_bounce_velocity) == pytest.approx(left, abs=1e-12)
    ratio = -left / float(orbit.relative_impact_velocity)
    assert float(orbit.apparent_restitution) == pytest.approx(ratio, abs=1e-12)
    release = float(orbit.phase + leg.departure.duration)
    assert float(orbit.release_phase) == pytest.approx(release, abs=1e-12)
    height = np.sin(release) + float(leg.departure.displacement)
    assert float(orbit.bounce_height) == pytest.approx(height, abs=1e-12)
    bounce = left + np.cos(release)
    assert float(orbit.bounce_velocity) == pytest.approx(bounce, abs=1e-12)
    assert float(orbit.max_height) == pytest.approx(height + bounce**2 / 2, abs=1e-12)


@every_model
def test_the_path_is_periodic_and_its_velocity_is_the_rate_of_its_height(model):
    orbit = required_orbit(model, 1, 1.0)
    time = np.linspace(0.01, 2 * np.pi - 0.01, 500)
    # Away from the ends of the contact, where the acceleration jumps.
    time = time[np.abs(time - float(orbit.contact_duration)) > 1e-3]
    step = 1e-4
    rate = (path(orbit, time + step)[0] - path(orbit, time - step)[0]) / (2 * step)
    # The square of the step times ϖ³.
    assert path(orbit, time)[1] == pytest.approx(rate, abs=1e-4)
    again = path(orbit, time + 4 * np.pi)
    assert again[0] == pytest.approx(path(orbit, time)[0], abs=1e-11)
    assert again[1] == pytest.approx(path(orbit, time)[1], abs=1e-10)
    over = path(orbit, time)[0] - np.sin(orbit.phase + time)
    end = float(orbit.contact_duration)
    # After a release by force the ball is below the table's level for a moment.
    assert np.all(over[time < end] < 0) and np.all(over[time > end + 0.05] > 0)


def test_the_greatest_height_of_a_ball_released_downwards_is_in_contact():
    # A stable orbit of a compliant contact: the ball turns round before its release.
    contact = SpringDamper(0.3691, damping_ratio(0.1546))
    orbit = required_orbit(contact, 1, 10.5378)
    assert float(orbit.bounce_velocity) < 0
    time = np.linspace(0, float(orbit.contact_duration), 201)
    k = np.argmax(path(orbit, time)[0])
    top = brentq(lambda at: path(orbit, at)[1], time[k - 1], time[k + 1])
    # A height of order one, with the square of the time's error.
    assert float(orbit.max_height) == pytest.approx(float(path(orbit, top)[0]), abs=1e-11)


@every_model
@pytest.mark.parametrize("side", Side)
def test_the_monodromy_is_the_difference_quotient_of_the_simulated_return(model, side):
    for lam in (0.5, 0.9):
        orbit = explicit_branch(model).orbit(1, lam, side)
        if not orbit.exists:
            continue
        step = 1e-5
        start = np.array([float(orbit.phase), float(orbit.relative_impact_velocity)])

        def after(state, lam=lam):
            leg = next_impact(model, state[0], state[1], lam)
            return np.array([state[0] + float(leg.time), float(leg.velocity)])

        columns = [
            (after(start + step * unit) - after(start - step * unit)) / (2 * step)
            for unit in np.eye(2)
        ]
        expected = np.array(columns).T
        # The square of the step times third derivatives, up to ϖ³.
        assert monodromy(orbit) == pytest.approx(expected, abs=2e-5 * np.abs(expected).max())
        trace, determinant = trace_and_determinant(orbit)
        assert float(trace) == pytest.approx(np.trace(expected), abs=4e-5 * np.abs(expected).max())
        exact = np.linalg.det(monodromy(orbit))
        assert float(determinant) == pytest.approx(exact, abs=1e-12 * np.abs(expected).max() ** 2)


def test_the_trace_of_the_restitution_model_is_that_of_its_formula():
    model = RestitutionModel(np.array([0.3, 0.85, 1.0]))
    orbit = explicit_branch(model).orbit(2, 3.5)
    r = model.restitution
    trace, determinant = trace_and_determinant(orbit)
    lift = 3.5 * np.sin(orbit.phase)
    assert trace == pytest.approx(1 + r**2 - (1 + r) ** 2 * lift, rel=1e-12)
    assert determinant == pytest.approx(r**2, rel=4 * EPS)


@given(st.floats(-4, 4), st.floats(0, 1.2))
def test_the_multipliers_are_the_eigenvalues_and_decide_the_stability(trace, determinant):
    # The multipliers follow from these two numbers alone; a restitution model has both of them.
    r = np.sqrt(determinant) if 0 < determinant <= 1 else 1.0
    lift = (1 + r * r - trace) / (1 + r) ** 2
    orbit = RestitutionBranch(RestitutionModel(float(r))).at(1, lift)
    found = multipliers(orbit)
    numbers = trace_and_determinant(orbit)
    assert np.sum(found).real == pytest.approx(float(numbers[0]), abs=1e-12)
    assert np.prod(found).real == pytest.approx(float(numbers[1]), abs=1e-12)
    assert abs(found[0]) >= abs(found[1]) * (1 - 4 * EPS)
    inside = np.abs(found).max()
    if abs(inside - 1) > 1e-7:
        assert bool(orbit.stable) == (inside < 1)


def test_a_second_multiplier_that_is_far_smaller_keeps_its_digits():
    orbit = RestitutionBranch(RestitutionModel(1e-6)).at(1, -0.5)
    large, small = multipliers(orbit)
    _, determinant = trace_and_determinant(orbit)
    assert small.real == pytest.approx(float(determinant) / large.real, rel=4 * EPS)
    assert small.real == pytest.approx(1e-12 / 1.5, rel=1e-5)


def test_at_a_bifurcation_a_multiplier_is_one_or_minus_one():
    for model in MODELS:
        for kind, value in zip(Bifurcation, (1, -1), strict=True):
            orbit = explicit_branch(model).bifurcation(kind, 1)
            assert np.abs(multipliers(orbit) - value).min() < 1e-7
            assert float(kind.test(*trace_and_determinant(orbit))) == pytest.approx(0, abs=1e-11)


def test_without_dissipation_no_orbit_is_asymptotically_stable():
    for model in (RestitutionModel(1.0), SpringDamper(7.0, 0.0), SpringDamper(40.0, 0.0, "force")):
        orbit = required_orbit(model, 1, 0.5)
        assert float(trace_and_determinant(orbit)[1]) == 1.0
        assert not orbit.stable


def test_a_contact_that_only_touches_its_release_has_no_derivatives():
    # δ′ = 0 at the impact and at the release of a contact without duration.
    orbit = Orbit(SpringDamper(10.0, 0.05), 1, 1.0, 0.0, 0.0, 1.0)
    assert np.all(np.isnan(trace_and_determinant(orbit)))
    assert np.isnan(orbit.apparent_restitution)
    assert not orbit.stable and not orbit.admissible


def test_where_there_is_no_orbit_all_is_missing():
    none = explicit_branch(RestitutionModel(0.85)).orbit(1, [0.1, 1.0])
    assert none.exists.tolist() == [False, True]
    for name in ("bounce_velocity", "max_height", "apparent_restitution"):
        assert np.isnan(getattr(none, name)).tolist() == [True, False]
    assert none.stable.tolist() == none.admissible.tolist() == [False, True]
    assert np.isnan(multipliers(none)).any(axis=-1).tolist() == [True, False]


# Admissibility, against samples.


def sampled(orbit):
    """Whether no event precedes the release and the landing, on 2000 samples of both motions."""
    contact = orbit.model
    lag, lam = contact.lag, orbit.amplitude
    start = orbit.phase, orbit.relative_impact_velocity, lam
    gap, rate, _ = contact.flow(SHARES * orbit.contact_duration, *start)
    time = orbit.contact_duration + SHARES * orbit.flight_time
    since = SHARES * orbit.flight_time
    velocity = orbit.bounce_velocity - since
    height = orbit.bounce_height + orbit.bounce_velocity * since - since**2 / 2
    over = height - lam * np.sin(orbit.phase + time)
    relative = velocity - lam * np.cos(orbit.phase + time)
    # After a release by force the contact resumes where δ + κ δ′ falls to 0 while δ < 0.
    rising = np.logical_and.accumulate(over < 0, axis=0)
    over = np.where(rising, over + lag * relative, over)
    closing = orbit.relative_impact_velocity
    possible = (closing < 0) & (orbit.contact_duration > 0) & (orbit.flight_time > 0)
    return possible & ((gap + lag * rate).max(axis=0) < 0) & (over.min(axis=0) > 0)


@every_release
def test_admissible_orbits_are_those_without_an_earlier_event_in_dense_samples(release):
    # Contacts from short to as long as the cycle; samples can only miss events between them, at
    # orbits that nearly graze: none in this sample.
    rng = np.random.default_rng(0)
    size = 150
    contact = SpringDamper(
        10 ** rng.uniform(0.05, 1.5, size), rng.uniform(0.01, 0.8, size), release
    )
    n = rng.integers(1, 4, size)
    longest = np.where(rng.random(size) < 0.5, 2 * np.pi * n, 4 / contact.frequency_ratio)
    duration = rng.uniform(0.1, 1.0, size) * longest
    excess = duration * contact.damped_frequency - contact.free_angle
    orbit = branch_point(excess, contact, n).orbit
    expected = sampled(orbit)
    assert np.array_equal(orbit.admissible, expected)
    assert 0.2 < expected.mean() < 0.8


@every_release
def test_the_margins_change_their_signs_where_an_orbit_stops_being_admissible(release):
    """A margin is negative where the samples say that an earlier event precedes."""
    contact = SpringDamper(10.0, 0.05, release)
    excess = np.linspace(0.01, 2 * np.pi * 9.98 - float(contact.free_angle) - 0.5, 700)
    row = branch_point(excess, contact.take(np.zeros(700, int)), np.ones(700, int)).orbit
    possible = (row.relative_impact_velocity < 0) & (row.relative_bounce_velocity > 0)
    row = row[np.flatnonzero(possible & (row.amplitude < 50))]
    good = (flight_margin(row) > 0) & (release_margin(row) > 0)
    assert 0.1 < row.admissible.mean() < 0.9
    assert np.array_equal(good, row.admissible)


def test_the_margin_of_a_flight_is_its_lowest_minimum_over_the_table():
    branch = RestitutionBranch(RestitutionModel(0.85))
    row = branch.orbit(np.ones(4, int), [2.2, 2.5, 3.0, 4.0], Side.UNSTABLE)
    for k, margin in enumerate(flight_margin(row)):
        orbit = row[k]

        def over(at, orbit=orbit):
            return path(orbit, at)[0] - orbit.amplitude * np.sin(orbit.phase + at)

        time = np.linspace(0.5, 6.0, 1001)
        inner = over(time)[1:-1]
        (at,) = np.flatnonzero((inner < over(time)[:-2]) & (inner < over(time)[2:]))
        bounds = time[at], time[at + 2]
        lowest = minimize_scalar(over, bounds=bounds, method="bounded", options={"xatol": 1e-10})
        assert margin == pytest.approx(lowest.fun, abs=1e-12)


@every_release
def test_the_margin_of_a_release_is_its_highest_maximum_below_zero(release):
    contact = SpringDamper(10.0, 0.05, release)
    # Contacts of several oscillations.
    excess = np.array([6.0, 9.0, 11.0, 20.0])
    row = branch_point(excess, contact.take(np.zeros(4, int)), np.ones(4, int)).orbit
    for k, margin in enumerate(release_margin(row)):
        orbit = row[k]
        start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude

        def height(at, start=start):
            gap, rate = contact.in_contact(at, *start)
            return gap + contact.lag * rate

        time = np.linspace(0, float(orbit.contact_duration), 4001)
        value = height(time)
        tops = np.flatnonzero((value[1:-1] > value[:-2]) & (value[1:-1] > value[2:]))
        highest = [
            minimize_scalar(
                lambda at: -float(height(at)),
                bounds=(time[at], time[at + 2]),
                method="bounded",
                options={"xatol": 1e-9},
            ).fun
            for at in tops
        ]
        # The height of a maximum is certain to the square of the error of its time.
        assert margin == pytest.approx(min(highest), abs=1e-12)


def test_an_orbit_that_does_not_return_to_its_start_is_inadmissible():
    # By less than what an overlooked event would do, and by more than rounding.
    model = RestitutionModel(0.85)
    phase = float(required_orbit(model, 1, 1.0).phase)
    for off, same in ((0.0, True), (1e-9, True), (1e-4, False)):
        late = Orbit(model, 1, 1.0, phase + off, 0.0, -np.pi)
        fast = Orbit(model, 1, 1.0, phase, 0.0, -np.pi * (1 + off))
        assert bool(late.admissible) == bool(fast.admissible) == same
    # Thrown up at π from an earlier phase the ball lands in time, and with another velocity.
    pace = np.cos(phase - 0.1)
    early = Orbit(model, 1, 1.0, phase - 0.1, 0.0, pace - (np.pi - pace) / 0.85)
    assert not early.admissible


def test_the_difference_of_orbits_is_their_largest_one():
    contact = SpringDamper(10.0, 0.05)
    orbit = branch_point(0.02, contact, 1).orbit
    base = {
        "amplitude": float(orbit.amplitude),
        "phase": float(orbit.phase) + 2 * np.pi,  # the same table
        "contact_duration": float(orbit.contact_duration),
        "impact_velocity": float(orbit.impact_velocity),
    }
    assert float(difference(Orbit(contact, 1, **base), orbit)) < 1e-14
    for name, value in base.items():
        moved = Orbit(contact, 1, **base | {name: value + 1e-3})
        size = np.pi / moved.contact_duration if name == "contact_duration" else 1.0
        assert float(difference(moved, orbit)) == pytest.approx(size * 1e-3, rel=1e-9)


def test_an_index_that_is_no_positive_integer_is_refused(refusal):
    for n in (0, -1, 1.5, np.nan, "x", True):
        with refusal(ModelError, f"family n = {n!r} is not a positive integer"):
            check_index(n)
