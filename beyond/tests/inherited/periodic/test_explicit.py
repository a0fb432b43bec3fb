"""The branch in closed form of both models, against their equations and 60 digits."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf
from random_contacts import drawn_contacts
from scipy.optimize import minimize_scalar
from sixty_digits import Exact

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.explicit import (
    Absence,
    absence,
    explicit_branch,
    required_orbit,
)
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side, trace_and_determinant
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    ImpactMap,
    RestitutionBranch,
    period_doubling_lift,
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import (
    SpringDamperBranch,
    branch_point,
    excess_angle,
    nearest_excess,
)

EPS = np.finfo(float).eps

families = st.integers(1, 5)
coefficients = st.floats(0.05, 1.0)
every_release = pytest.mark.parametrize("release", Release)


def by_restitution(r, omega, release="displacement"):
    return SpringDamper(omega, damping_ratio(r), release)


# The restitution model.


@given(families, coefficients, st.floats(0.0, 2.0), st.sampled_from(Side))
def test_the_orbits_are_fixed_points_of_both_maps(n, r, excess, side):
    lam = float(restitution_saddle_node(n, r)) + excess
    orbit = RestitutionBranch(RestitutionModel(r)).orbit(n, lam, side)
    phase, speed, time = float(orbit.phase), float(orbit.bounce_velocity), 2 * np.pi * n
    assert phase >= 0 if side is Side.STABLE else phase <= 0
    # The sine of a full turn is good to eps · 2πn, times Λ.
    scale = EPS * (1 + lam) * time
    landing = lam * (np.sin(phase + time) - np.sin(phase)) - (speed * time - time**2 / 2)
    bounced = -r * (speed - time) + (1 + r) * lam * np.cos(phase + time)
    assert abs(landing) <= 4 * time * scale and abs(bounced - speed) <= 8 * scale
    # Holmes, J. Sound Vib. 84 (1982) 173-189, in the paper's scaling.
    after = r * speed + (1 + r) * lam * np.cos(phase + 2 * speed)
    assert abs(2 * speed - time) <= 4 * EPS * time and abs(after - speed) <= 8 * scale


@given(families, coefficients)
def test_at_the_bifurcations_a_multiplier_is_plus_or_minus_one(n, r):
    branch = RestitutionBranch(RestitutionModel(r))
    for kind in Bifurcation:
        orbit = branch.bifurcation(kind, n)
        # Λ sin φ = √(Λ² - Λ_SN²) amplifies the rounding of Λ by Λ²/(Λ sin φ).
        allowed = 40 * EPS * (1 + float(orbit.amplitude)) ** 2 * (1 + 2 * np.pi * n)
        assert abs(float(kind.test(*trace_and_determinant(orbit)))) <= allowed
    doubling = float(restitution_period_doubling(n, r))
    assert float(branch.bifurcation(Bifurcation.PERIOD_DOUBLING, n).amplitude) == doubling
    # Of Holmes' map: its Jacobian is [[1, 2], [c, r + 2c]], c = -(1 + r) Λ sin φ.
    holmes = float(restitution_period_doubling(n, r, ImpactMap.HOLMES))
    phase = float(branch.orbit(n, holmes).phase)
    c = -(1 + r) * holmes * np.sin(phase)
    assert abs(1 + (1 + r + 2 * c) + r) <= 40 * EPS * (1 + holmes**2)


def test_the_bifurcations_for_one_half_are_those_worked_out_by_hand():
    # nπ/3, and 2(5/4)/(9/4) = 10/9.
    assert float(restitution_saddle_node(3, 0.5)) == pytest.approx(np.pi, rel=4 * EPS)
    doubling = float(restitution_period_doubling(3, 0.5))
    assert doubling == pytest.approx(np.hypot(10 / 9, np.pi), rel=4 * EPS)


@pytest.mark.parametrize(("n", "r", "top"), [(1, 0.85, 2.0), (5, 0.85, 1.4), (2, 1.0, 1.5)])
def test_the_branch_has_equal_steps_of_the_lift_at_a_constant_cosine(n, r, top):
    along = RestitutionBranch(RestitutionModel(r)).along(n, top, 41)
    node = float(restitution_saddle_node(n, r))
    assert along.amplitude[[0, -1]] == pytest.approx([top, top], rel=10 * EPS)
    assert along.amplitude * np.cos(along.phase) == pytest.approx(np.full(41, node), abs=10 * EPS)
    lift = along.amplitude * np.sin(along.phase)
    assert np.diff(lift) == pytest.approx(np.full(40, (lift[-1] - lift[0]) / 40), abs=20 * EPS)
    assert along.phase[0] == -along.phase[-1] < 0
    assert np.all(along.bounce_velocity == n * np.pi)


def test_a_flight_on_the_unstable_side_grazes_the_table_where_samples_say_so():
    model = RestitutionModel(0.85)
    branch = RestitutionBranch(model)
    grazing = branch.grazing(1, 6.0)
    lam = float(grazing.amplitude)
    time = np.linspace(0, 2 * np.pi, 200_001)[1:-1]
    for factor, above in ((1 - 1e-6, True), (1 + 1e-6, False)):
        orbit = branch.orbit(1, lam * factor, Side.UNSTABLE)
        level = orbit.amplitude * (np.sin(orbit.phase + time) - np.sin(orbit.phase))
        assert ((np.pi * time - time**2 / 2 - level).min() > 0) is np.bool_(above)
        assert bool(orbit.admissible) is above
    assert not branch.grazing(1, lam - 0.01).exists
    # Both sides, and all orbits of one Λ.
    both = branch.orbits(1, 1.0)
    assert both.phase[0] == -both.phase[1] > 0
    assert branch.orbits(1, float(restitution_saddle_node(1, 0.85))).size == 1


@pytest.mark.parametrize("r", [-0.01, 1.01, np.nan])
def test_a_restitution_coefficient_outside_its_range_is_refused(r, refusal):
    for call in (restitution_saddle_node, restitution_period_doubling):
        with refusal(ModelError, f"r = {r}", "[0, 1]"):
            call(1, r)
    with refusal(ModelError, f"r = {r}", "[0, 1]"):
        period_doubling_lift(r)


@pytest.mark.parametrize("n", ["x", "0.5", 0, 1.5, np.inf])
def test_a_family_that_is_no_positive_integer_is_refused(n, refusal):
    for model in (RestitutionModel(0.5), SpringDamper(10.0, 0.1)):
        with refusal(ModelError, f"family n = {n!r} is not a positive integer"):
            explicit_branch(model).orbit(n, 1.0)


# The spring-damper model.


def contacts(seed, count, low, high):
    rng = np.random.default_rng(seed)
    omega = 10 ** rng.uniform(low, high, count)
    restitution = rng.uniform(0.05, 1.0, count)
    n = rng.integers(1, 6, count)
    rules = rng.permutation([*Release] * count)[:count]
    for w, r, family, rule in zip(omega, restitution, n, rules, strict=True):
        yield by_restitution(float(r), float(w), Release(rule)), int(family), rng


def test_the_branch_agrees_with_sixty_digits():
    errors = []
    with mpmath.workdps(60):
        for contact, n, rng in contacts(1, 200, 0, 6):
            excess = float(rng.uniform(-1, 1)) / float(contact.frequency_ratio)
            orbit = branch_point(excess, contact, n).orbit
            duration, u, x, y = Exact(contact, n).orbit(excess)
            amplitude = mp.hypot(x, y)
            lam = mpf(float(orbit.amplitude))
            phase = mpf(float(orbit.phase))
            found = (lam * mp.cos(phase), lam * mp.sin(phase), mpf(float(orbit.impact_velocity)))
            exact = (x, y, u + x)
            size = max(amplitude, abs(u))
            worst = max(abs(a - b) for a, b in zip(found, exact, strict=True)) / size
            assert abs(mpf(float(orbit.contact_duration)) / duration - 1) < 4 * EPS
            errors.append(float(worst))
    # A 3 × 3 solve whose condition costs up to two digits, on the median none.
    assert max(errors) < 1e-13
    assert np.median(errors) < 8 * EPS


@pytest.mark.parametrize("detuning", [0.0, 1e-6, 3e-5, 1e-4, 1e-3])
def test_next_to_the_undamped_resonance_a_point_has_all_its_digits(detuning):
    contact = SpringDamper(1 + detuning, 0.0)
    for excess in (-0.5, 0.1, 0.2, 0.7):
        orbit = branch_point(excess, contact, 1).orbit
        with mpmath.workdps(60):
            # The formulas of 60 digits are 0/0 at the resonance itself.
            omega = mpf(float(contact.frequency_ratio)) + mpf(10) ** -30
            duration, u, x, y = (float(v) for v in Exact(contact, 1, omega).orbit(excess))
        found = [
            orbit.contact_duration,
            orbit.relative_impact_velocity,
            orbit.amplitude * np.cos(orbit.phase),
            orbit.amplitude * np.sin(orbit.phase),
        ]
        expected = [duration, u, x, y]
        # Some twenty roundings of the largest of them.
        allowed = 5e-15 * np.max(np.abs(expected))
        np.testing.assert_allclose(found, expected, rtol=0, atol=allowed)


def checked_bifurcation(contact, n, kind, closed=None):
    """Whether a reported bifurcation is one in 60 digits; False if none is reported."""
    orbit = explicit_branch(contact).bifurcation(kind, n)
    if not orbit.exists:
        return False
    # In double precision the trace loses three digits at most, and those of a long flight, whose
    # duration 2πn multiplies the deviations of its start.
    closed = EPS * max(1e3, 2 * np.pi * n) if closed is None else closed
    excess = float(nearest_excess(orbit))
    exact = Exact(contact, n)
    sign = 1 if kind is Bifurcation.SADDLE_NODE else -1

    def test(x):
        return 1 - sign * exact.trace(x) + exact.determinant(x)

    # The orbit gives its place on the branch with fewer digits than the search had.
    width = mpf(1e-6) * min(abs(excess), 1 / exact.omega)
    low, high = test(excess - width), test(excess + width)
    assert low * high < 0
    root = mp.findroot(test, (excess - width, excess + width), solver="anderson", tol=1e-40)
    _, u, x, y = exact.orbit(root)
    # A grazing orbit would have u = 0, a pole an infinite Λ.
    assert abs(u) > 1e-6 and mp.hypot(x, y) < 1e8
    amplitude = float(mp.hypot(x, y))
    slope = abs(high - low) / (2 * width)
    assert float(abs(root - excess)) < closed / float(slope) + 1e-9 * float(width) / 1e-6
    assert float(orbit.amplitude) == pytest.approx(amplitude, rel=max(closed, 1e-13))
    return True


# Not all of these contacts have both bifurcations.
@pytest.mark.parametrize(("count", "least"), [(8, 6), pytest.param(20, 16, marks=pytest.mark.long)])
@pytest.mark.parametrize("kind", Bifurcation)
def test_random_bifurcations_agree_with_sixty_digits(kind, count, least):
    with mpmath.workdps(60):
        found = [checked_bifurcation(c, n, kind) for c, n, _ in contacts(2, count, -1, 5)]
    assert sum(found) >= least


@pytest.mark.parametrize("kind", Bifurcation)
@pytest.mark.parametrize(
    ("r", "omega", "n"),
    [(0.794141, 0.170932, 19), (0.775496, 0.244529, 13), (0.32412, 0.255791, 193)],
)
def test_a_bifurcation_beyond_poles_and_grazing_orbits_is_no_orbit_of_a_ball(r, omega, n, kind):
    # Λ once was 6e17, 1108 and 7375 there: poles and a grazing orbit.
    orbit = explicit_branch(by_restitution(r, omega)).bifurcation(kind, n)
    assert float(orbit.amplitude) < 1e4
    assert orbit.relative_impact_velocity > 0 and not orbit.admissible
    assert abs(kind.test(*trace_and_determinant(orbit))) < 1e-9


def residual(orbit):
    """The three equations of an orbit, in terms of the flow: release, velocity and landing."""
    contact = orbit.model
    start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
    gap, rate, _ = contact.flow(orbit.contact_duration, *start)
    off = orbit.phase + orbit.contact_duration
    lag = contact.lag
    flight = 2 * np.pi * orbit.n - orbit.contact_duration
    bounce = rate + orbit.amplitude * np.cos(off)
    height = -lag * rate + orbit.amplitude * np.sin(off) + bounce * flight - flight**2 / 2
    return np.array(
        [
            contact.frequency_ratio * (gap + lag * rate),
            bounce - flight - orbit.impact_velocity,
            (height - orbit.amplitude * np.sin(orbit.phase)) / flight,
        ]
    )


@given(
    st.floats(np.log(0.5), np.log(1e6)).map(lambda x: float(np.exp(x))),
    st.one_of(st.just(0.0), st.floats(0, 0.9)),
    families,
    st.sampled_from(Release),
    st.floats(-0.9, 1.0),
)
def test_every_point_satisfies_the_equations_of_an_orbit(omega, zeta, n, release, share):
    contact = SpringDamper(omega, zeta, release)
    start = float(contact.free_angle)
    # Contacts from a tenth of the free one up to ε = 1, or up to the end of the cycle, where the
    # three equations become dependent.
    end = 0.95 * (contact.damped_frequency * 2 * np.pi * n - start)
    excess = share * start if share < 0 else min(share, end)
    orbit = branch_point(excess, contact, n).orbit
    speed = 1 + abs(float(orbit.relative_impact_velocity)) + float(orbit.amplitude) + 2 * np.pi * n
    # A 3 × 3 solve, whose condition costs about two digits; and the rounding of the angle ϖD.
    allowed = 1e-13 * speed * (1 + omega * float(orbit.contact_duration))
    assert np.all(np.abs(residual(orbit)) < allowed)


@every_release
@pytest.mark.parametrize("zeta", [0.0, 0.0517, 0.4, 0.9])
@pytest.mark.parametrize("omega", [0.7, 1.0, 2.0, 10.0, 1e4])
def test_the_slope_of_the_branch_is_a_difference_quotient_of_the_amplitude(release, zeta, omega):
    contact = SpringDamper(omega, zeta, release)
    # The branch turns within 1/ϖ of ε; in these units all is of order one.
    unit = min(1.0, 1 / omega, float(contact.free_angle) / 2)
    step = 2e-3 * unit
    excess = np.array([-1.0, -0.3, 0.01, 0.2, 0.7]) * unit
    around = [branch_point(excess + k * step, contact, 2).orbit for k in (-2, -1, 1, 2)]
    squares = np.array([each.amplitude**2 / 2 for each in around])
    expected = np.array([1, -8, 8, -1]) / (12 * step) @ squares * contact.damped_frequency
    found = branch_point(excess, contact, 2).slope()
    # h⁴ times a fifth derivative of up to 1e3: 1e-8; the roundings eps/2e-3 are smaller.
    assert found == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())


@pytest.fixture(scope="module", params=Release)
def drawn(request):
    """Random contacts; n, r and shares for Λ."""
    omega, r, n, share = drawn_contacts(300)
    return by_restitution(r, omega, request.param), n, r, share


def test_the_saddle_node_is_the_lowest_amplitude_and_its_multiplier_is_one(drawn):
    contact, n, r, _ = drawn
    fold = SpringDamperBranch(contact).bifurcation(Bifurcation.SADDLE_NODE, n)
    excess = nearest_excess(fold)
    # Λ rises to both sides, in steps of the fold's own scale.
    steps = np.array([[-2], [-1], [1], [2]]) * 0.05 / contact.frequency_ratio
    around = branch_point(excess + steps, contact, n).orbit.amplitude
    assert np.all(around > fold.amplitude)
    assert np.all((around[0] > around[1]) & (around[3] > around[2]))
    # Λ vanishes at the fold of an elastic contact, and the phase is then undefined.
    test = Bifurcation.SADDLE_NODE.test(*trace_and_determinant(fold))
    assert np.all(np.abs(test[r < 0.999]) <= 1e-10)


def test_between_both_bifurcations_the_orbits_of_the_stable_side_are_stable(drawn):
    contact, n, r, share = drawn
    branch = SpringDamperBranch(contact)
    fold, flip = (branch.bifurcation(kind, n) for kind in Bifurcation)
    assert np.all(fold.amplitude < flip.amplitude)
    lam = fold.amplitude + share * (flip.amplitude - fold.amplitude)
    orbit = branch.orbit(n, lam)
    assert orbit.amplitude == pytest.approx(lam, rel=1e-12)
    # A contact without damping has the determinant 1, and no asymptotic stability.
    assert np.array_equal(orbit.stable, r < 1.0)
    test = Bifurcation.PERIOD_DOUBLING.test(*trace_and_determinant(flip))
    assert np.all(np.abs(test) <= 1e-10)
    assert not np.any(branch.orbit(n, flip.amplitude * 1.01).stable)
    other = branch.orbit(n, fold.amplitude * (1 + 1e-4), Side.UNSTABLE)
    assert not np.any(other.stable[other.exists]) and other.exists.mean() > 0.95
    # Of a stiff contact both durations are the same number.
    longer = other.contact_duration >= fold.contact_duration * (1 - 4 * EPS)
    assert np.all(longer[other.exists])


def test_a_required_orbit_that_does_not_exist_is_refused_with_its_reason(refusal):
    stiff = explicit_branch(by_restitution(0.85, 10.0))
    # The saddle-node of the model notes' table, 0.2400.
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 0.2 for ϖ = 10", "saddle-node at Λ = 0.239988"):
        required_orbit(stiff.model, 1, 0.2)
    rigid = explicit_branch(RestitutionModel(0.85))
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 0.2 for r = 0.85", "at Λ = 0.254724"):
        required_orbit(rigid.model, 1, 0.2)
    # Without a saddle-node Λ ends at permanent contact, 0.97, on its one side.
    soft = explicit_branch(by_restitution(0.0893, 2.592))
    assert not soft.bifurcation(Bifurcation.SADDLE_NODE, 1).exists
    assert required_orbit(soft.model, 1, 2.5).stable
    assert not required_orbit(soft.model, 1, 4.0).stable
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 0.5 for ϖ = 2.592", "does not reach this Λ"):
        required_orbit(soft.model, 1, 0.5)
    with refusal(NoOrbitError, "Λ = 2.5", "no saddle-node and therefore no other side"):
        required_orbit(soft.model, 1, 2.5, Side.UNSTABLE)
    # The unstable side of r = 0.85, ϖ = 2 turns at Λ = 1.176.
    with refusal(NoOrbitError, "Λ = 1.3", "does not reach this Λ"):
        required_orbit(by_restitution(0.85, 2.0), 1, 1.3, Side.UNSTABLE)


@pytest.mark.parametrize(
    ("n", "omega", "zeta", "release"),
    [(1, 2.0, 0.05, "force"), (2, 2.0, 0.05, "displacement"), (1, 10.0, 0.2, "displacement")],
)
def test_just_above_the_fold_there_are_two_orbits_and_just_below_none(n, omega, zeta, release):
    branch = SpringDamperBranch(SpringDamper(omega, zeta, release))
    fold = branch.bifurcation(Bifurcation.SADDLE_NODE, n)
    lam = float(fold.amplitude)
    for excess in (1e-6, 1e-10):
        stable, unstable = (branch.orbit(n, lam * (1 + excess), side) for side in Side)
        assert stable.contact_duration < fold.contact_duration < unstable.contact_duration
        assert branch.orbits(n, lam * (1 + excess)).size >= 2
    assert not branch.orbit(n, lam * (1 - 1e-10)).exists


def test_the_first_orbit_just_below_the_turn_of_the_unstable_side_is_found():
    # Two orbits next to the top of Λ, between two points of any grid; above it there is none.
    contact = by_restitution(0.85, 2.0)
    turn = minimize_scalar(
        lambda excess: -float(branch_point(excess, contact, 1).orbit.amplitude),
        bounds=(2.5, 3.5),
        method="bounded",
        options={"xatol": 1e-9},
    )
    lam = -turn.fun * (1 + np.array([-1e-9, 1e-9]))
    below, above = SpringDamperBranch(contact).orbit(1, lam, Side.UNSTABLE)
    assert not above.exists
    # On the fold's side of the turn, by a root of 1e-9 times a number of order one.
    assert -1e-3 < float(excess_angle(contact, below.contact_duration)) - turn.x < 0


def test_all_orbits_at_an_amplitude_are_the_crossings_of_a_fine_grid():
    contact = SpringDamper(3.3, 0.1)
    for lam in (0.9, 4.0):
        found = SpringDamperBranch(contact).orbits(1, lam)
        angle = np.linspace(0.01, 2 * np.pi * 3.3 * 0.99, 400_001)
        row = branch_point(angle - float(contact.free_angle), contact, 1).orbit
        crossed = (row.amplitude[:-1] < lam) != (row.amplitude[1:] < lam)
        smooth = np.abs(np.diff(row.amplitude)) < 0.1
        good = (row.relative_impact_velocity < 0) & (row.relative_bounce_velocity > 0)
        at = np.flatnonzero(crossed & smooth & good[:-1])
        assert found.size == at.size
        assert np.all(row.contact_duration[at] <= found.contact_duration)
        assert np.all(found.contact_duration <= row.contact_duration[at + 1])


@every_release
@pytest.mark.parametrize("ratio", [1e-8, 1e-4, 4.9e-4])
@pytest.mark.parametrize("amplitude", [1e-3, 1.0, 1e8])
def test_a_contact_that_is_too_soft_for_n_periods_has_no_orbits(ratio, amplitude, release):
    # Even a contact that fills the period is shorter than a thousandth of the free duration.
    assert SpringDamperBranch(SpringDamper(ratio, 0.05, release)).orbits(1, amplitude).size == 0


@pytest.mark.parametrize("omega", [0.18, 0.32])
def test_the_unstable_side_of_a_very_compliant_contact_has_an_orbit_or_none(omega):
    orbit = SpringDamperBranch(by_restitution(0.6, omega)).orbit(1, 40.0, Side.UNSTABLE)
    assert not orbit.exists or 0 < float(orbit.contact_duration) < 2 * np.pi


def test_a_side_may_be_given_by_its_name(refusal):
    branch = SpringDamperBranch(SpringDamper(10.0, 0.05))
    for side in Side:
        assert branch.orbit(1, 0.9, str(side)).phase == branch.orbit(1, 0.9, side).phase
    with refusal(ModelError, "unknown side 'upper'"):
        branch.orbit(1, 0.9, "upper")


def test_a_missing_orbit_has_its_reason_in_a_row_as_alone():
    r = np.array([0.3, 0.85, 0.85, 0.0893])
    omega = np.array([50.0, 10.0, 2.0, 2.592])
    lam = np.array([0.9, 0.2, 1.3, 2.5])
    contact = by_restitution(r, omega)
    for side in Side:
        many = absence(explicit_branch(contact), 1, lam, side)
        for k in range(4):
            assert many[k] == absence(explicit_branch(contact[k]), 1, lam[k], side)
    assert many.tolist() == [
        Absence.BELOW_SADDLE_NODE,
        Absence.BELOW_SADDLE_NODE,
        Absence.NOT_REACHED,
        Absence.NO_OTHER_SIDE,
    ]
