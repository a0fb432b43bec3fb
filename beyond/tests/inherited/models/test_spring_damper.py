"""The contact with a spring and a damper: its motion, its release, and their derivatives."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from bouncing_ball_beyond.inherited import spring_damper
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper, force, responses

EPS = np.finfo(float).eps
# A signal y is known to some units in the last place of its terms, which are of order 10 here.
NOISE = 1e-14

every_release = pytest.mark.parametrize("release", Release)
ratios = st.floats(np.log(0.05), np.log(50)).map(lambda x: float(np.exp(x)))
dampings = st.one_of(st.just(0.0), st.floats(0, 0.99))


def exact_responses(time, omega, zeta):
    """g, g′, G, Q and P in 130 digits; 1e-45 is added, so that no quotient is 0/0."""
    with mpmath.workdps(130):
        s, w, z = map(mpmath.mpf, map(float, (time, omega, zeta)))
        nudge = mpmath.mpf(10) ** -45
        a = z * w + nudge
        q = w * w + nudge / 3
        root = mpmath.sqrt(q - a * a)
        g = mpmath.exp(-a * s) * mpmath.sin(root * s) / root
        rate = mpmath.exp(-a * s) * mpmath.cos(root * s) - a * g
        gravity = (1 - rate - 2 * a * g) / q
        h = (mpmath.expj(s) - rate - (1j + 2 * a) * g) / (q - 1 + 2j * a)
        return [float(x) for x in (g, rate, gravity, h.real, h.imag)]


def test_the_responses_agree_with_130_digits_also_next_to_the_resonance():
    rng = np.random.default_rng(20110828)
    omega = 10 ** rng.uniform(-2, 4, 300)
    zeta = np.where(rng.random(300) < 0.3, 0.0, rng.uniform(0, 0.99, 300))
    time = 10 ** rng.uniform(-6, 1, 300)
    omega[:60] = rng.choice([1.0, 1 + 1e-9, 1 - 1e-9, 1 + 1e-4], 60)
    zeta[:60] = rng.choice([0.0, 1e-9, 1e-5], 60)
    found = np.array(responses(time, omega, zeta))
    for k in range(300):
        expected = np.array(exact_responses(time[k], omega[k], zeta[k]))
        s, w = time[k], omega[k]
        soft = min(s, 1 / max(w, 1))
        # g and g′ of the free oscillation; G, Q and P as large as the square of the shorter of s
        # and 1/ϖ.
        free = np.exp(-zeta[k] * w * s)
        sizes = np.array([free * min(s, 1 / w), free, min(s, 1 / w) ** 2, soft * soft, soft * soft])
        # The phase ϖ s is rounded; and some roundings of the formulas.
        allowed = 16 * EPS * (1 + w * s) * (sizes + np.abs(expected)) + 1e-290
        assert np.all(np.abs(found[:, k] - expected) <= allowed), (s, w, zeta[k])


@given(
    st.floats(-1, 1),
    st.floats(-5, 5),
    st.floats(-4, 4),
    st.floats(0, 3),
    ratios,
    dampings,
    st.floats(1e-4, 10),
)
def test_the_flow_is_that_of_the_matrix_exponential(
    reference, gap, velocity, phase, lam, omega, zeta, time
):
    found = SpringDamper(omega, zeta).flow(time, phase, velocity, lam, gap)
    expected = reference.contact_state(time, gap, velocity, phase, lam, omega, zeta)
    # The exponential loses about the norm of its argument in roundings, and works in the units of
    # ϖδ and δ′.
    size = 1 + lam + abs(velocity) + omega * abs(gap) + (1 + lam) * time
    allowed = 20 * EPS * (1 + 2 * (1 + zeta) * max(omega, 1) * time) * size
    assert abs(float(found.displacement) - expected[0]) <= allowed / min(omega, 1)
    assert abs(float(found.velocity) - expected[1]) <= allowed


@given(st.floats(-5, -0.1), st.floats(-4, 4), st.floats(0, 3), ratios, dampings, st.floats(0, 3))
def test_the_flow_is_the_papers_solution(reference, velocity, phase, lam, omega, zeta, time):
    if abs(omega - 1) < 0.05:  # the paper's form is singular at the resonance
        omega = 1.1
    found = SpringDamper(omega, zeta).flow(time, phase, velocity, lam)
    expected = reference.paper_contact(velocity, phase, lam, omega, zeta)(time)
    # The paper's constants lose 1/√γ at ϖ ≈ 1, and 1/√(1 - ζ²); δ is up to 1/ϖ² otherwise.
    size = (1 + lam + abs(velocity)) * (1 + 1 / omega) ** 2 * (1 + time) * 20
    assert found[:2] == pytest.approx(expected, abs=50 * EPS * size / (1 - zeta))


def test_the_acceleration_is_that_of_the_equation_of_motion():
    time = np.linspace(0, 3, 20)
    contact = SpringDamper(5.0, 0.2)
    state = contact.flow(time, 0.3, -1.0, 1.2, 0.1)
    pushed = force(5.0, 0.2, -state.displacement, -state.velocity)
    balance = pushed - 1 + 1.2 * np.sin(time + 0.3)
    assert state.acceleration == pytest.approx(balance, abs=200 * EPS)


@pytest.mark.parametrize(("omega", "zeta"), [(1.0, 0.0), (3.0, 0.1), (0.3, 0.6), (40.0, 0.02)])
def test_a_contact_loses_the_energy_that_its_damper_takes(omega, zeta):
    contact = SpringDamper(omega, zeta)
    phase, lam, velocity, end = 0.7, 1.3, -2.0, 1.9

    def energy(time):
        """Of the ball and the spring, in the frame of the laboratory."""
        state = contact.flow(time, phase, velocity, lam)
        height = state.displacement + lam * np.sin(phase + time)
        speed = state.velocity + lam * np.cos(phase + time)
        return speed**2 / 2 + height + omega**2 * state.displacement**2 / 2

    def power(time):
        """Of the damper, and of the table that moves the foot of spring and damper."""
        state = contact.flow(time, phase, velocity, lam)
        of_damper = -2 * zeta * omega * state.velocity**2
        pushed = force(omega, zeta, -state.displacement, -state.velocity)
        return of_damper + pushed * lam * np.cos(phase + time)

    work, _ = quad(power, 0.0, end, epsabs=1e-12, epsrel=1e-12, limit=400)
    assert float(energy(end) - energy(0.0)) == pytest.approx(work, abs=1e-10)


def first_release(contact, phase, velocity, lam):
    """The end of a contact by an integrator with dense output and root finding."""
    omega, zeta = contact.frequency_ratio, contact.damping_ratio
    lag = 2 * zeta / omega if contact.release is Release.FORCE else 0.0

    def motion(time, state):
        force = -(omega**2) * state[0] - 2 * zeta * omega * state[1]
        return [state[1], force - 1 + lam * np.sin(phase + time)]

    def ends(time, state):
        # A contact starts with δ = 0 as well.
        return -1.0 if time == 0 else state[0] + lag * state[1]

    ends.terminal = True
    ends.direction = 1
    precise = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.05 / omega}
    found = solve_ivp(motion, (0.0, 12.0), [0.0, velocity], events=ends, **precise)
    return found.t[-1], found.y[:, -1], found.status == 1


@every_release
def test_a_contact_ends_where_an_integrator_with_events_ends_it(release):
    rng = np.random.default_rng(5)
    ended = 0
    for _ in range(25):
        contact = SpringDamper(rng.uniform(0.5, 8.0), rng.uniform(0.0, 0.6), release)
        phase, velocity, lam = rng.uniform(-3, 3), -rng.uniform(0.3, 4.0), rng.uniform(0.0, 2.5)
        time, state, before = first_release(contact, phase, velocity, lam)
        found = contact.impact(*(np.full(1, x) for x in (phase, velocity, lam)))
        if not before:
            assert not found.duration[0] < 12.0
            continue
        ended += 1
        opening = float(contact.opening_rate(time, phase, velocity, lam))
        # The integrator's error, over the rate at which the contact opens.
        allowed = 1e-9 / min(1.0, abs(opening))
        assert found.duration[0] == pytest.approx(time, abs=allowed)
        assert found.displacement[0] == pytest.approx(state[0], abs=10 * allowed)
        assert found.velocity[0] == pytest.approx(state[1], abs=10 * allowed)
        assert found.status[0] == Status.BOUNCING
        of_duration = contact.released(found.duration[0], phase, velocity, lam)
        ends = found.displacement[0], found.velocity[0]
        assert ends == pytest.approx(of_duration, abs=100 * NOISE)
    assert ended > 15


@every_release
def test_the_derivative_of_a_contact_is_its_difference_quotient(release):
    rng = np.random.default_rng(2)
    size = 60
    contact = SpringDamper(rng.uniform(0.5, 30.0, size), rng.uniform(0.0, 0.8, size), release)
    phase = rng.uniform(-3, 3, size)
    velocity = -rng.uniform(1.0, 5.0, size)
    lam = rng.uniform(0.1, 2.0, size)
    duration = contact.impact(phase, velocity, lam).duration
    ends = np.where(np.isfinite(duration), duration, 0.0)
    opening = contact.opening_rate(ends, phase, velocity, lam)
    good = np.flatnonzero((ends > 0) & (opening > 0.3))
    assert good.size > 30
    contact, phase, velocity, lam = contact.take(good), phase[good], velocity[good], lam[good]
    duration = duration[good]
    step = 1e-5

    def ends(of_phase, of_velocity):
        found = contact.impact(of_phase, of_velocity, lam)
        return np.array([of_phase + found.duration, found.velocity])

    by_phase = ends(phase + step, velocity) - ends(phase - step, velocity)
    by_velocity = ends(phase, velocity + step) - ends(phase, velocity - step)
    expected = np.array([by_phase, by_velocity]).transpose(2, 1, 0) / (2 * step)
    found = contact.derivative(duration, phase, velocity, lam)
    # The square of the step times third derivatives, which are divided by the opening rate.
    size = np.abs(expected).max(axis=(-2, -1))
    assert np.all(np.abs(found - expected).max(axis=(-2, -1)) < 1e-5 * size)


@every_release
def test_areas_contract_in_contact_by_the_damping(release):
    """det = (δ′₀/y′) e^{-2ζϖD} × y′… at a release with δ_b = -κ δ′_b, by Liouville's formula."""
    contact = SpringDamper(np.array([2.0, 7.0, 30.0]), 0.15, release)
    phase, velocity, lam = np.array([0.3, 1.0, 2.0]), np.full(3, -2.5), 0.8
    departure = contact.impact(phase, velocity, lam + 0 * phase)
    found = np.linalg.det(contact.derivative(departure.duration, phase, velocity, lam))
    # The flow through the section δ = 0 is δ′₀, and that through the release is y′ = δ′ + κ δ″.
    opening = contact.opening_rate(departure.duration, phase, velocity, lam)
    flux = velocity / opening
    expected = contact.contraction(departure.duration) * flux
    assert found == pytest.approx(expected, rel=1e-11)


def test_a_stiff_contact_becomes_an_impact_with_a_restitution_coefficient():
    r = 0.7
    errors = []
    for omega in (1e3, 1e4, 1e5):
        contact = SpringDamper.from_restitution(r, omega)
        found = contact.impact(np.full(1, 0.4), np.full(1, -2.0), np.full(1, 0.9))
        assert found.duration[0] * omega == pytest.approx(np.pi, rel=0.02)
        errors.append(abs(found.velocity[0] / (2.0 * r) - 1))
        of_impact = contact.derivative(found.duration[0], 0.4, -2.0, 0.9)
        assert of_impact[1, 1] == pytest.approx(-r, abs=20 / omega)
    # The first correction is of the order 1/ϖ.
    assert errors[1] < errors[0] / 8 and errors[2] < errors[1] / 8


def peaks(release, seed=0):
    """Contacts whose y = δ + κ δ′ rises to 0 at a time and no further, as functions of the value
    there: time, -y″, φ, ϖ, ζ and (u, Λ) by this value, and y at times.
    """
    rng = np.random.default_rng(seed)
    omega, zeta = 3.0, 0.1
    lag = 2 * zeta / omega if release is Release.FORCE else 0.0
    contact = SpringDamper(omega, zeta, release)
    made = []
    for _ in range(60):
        phase = rng.uniform(-np.pi, np.pi)
        s0 = rng.uniform(1.2, 6.0)

        def observed(u, lam, s=s0, phase=phase):
            gap, rate, acceleration = contact.flow(s, phase, u, lam)
            jerk = -2 * zeta * omega * acceleration - omega**2 * rate + lam * np.cos(s + phase)
            return gap + lag * rate, rate + lag * acceleration, acceleration + lag * jerk

        zero = np.array(observed(0.0, 0.0)[:2])
        columns = [np.array(observed(*unit)[:2]) - zero for unit in ((1.0, 0.0), (0.0, 1.0))]
        matrix = np.array(columns).T

        def start(value, matrix=matrix, zero=zero):
            return np.linalg.solve(matrix, np.array([value, 0.0]) - zero)

        u, lam = start(0.0)
        grid = np.linspace(0, 1, 2001)[1:-3] * s0
        curvature = float(observed(u, lam)[2])
        if u < -0.1 and 0 < lam < 20 and curvature < -0.1:
            if np.all(observed(u, lam, grid)[0] < 0):
                made.append((s0, -curvature, phase, start, observed))
    assert len(made) > 3
    return contact, made


@every_release
@pytest.mark.parametrize("height", [1e-12, 1e-9, 1e-6])
def test_a_contact_that_just_reaches_its_release_ends_and_one_that_just_misses_it_lasts(
    release, height
):
    contact, made = peaks(release)
    for s0, curvature, phase, start, observed in made:
        width = np.sqrt(2 * height / curvature)
        u, lam = start(height)
        ended = contact.impact(*(np.full(1, x) for x in (phase, u, lam)))
        # Of the local parabola, and of the rounding of y over its slope.
        slack = 100 * width**2 + 10 * NOISE / (curvature * width)
        assert abs(ended.duration[0] - (s0 - width)) < slack
        u, lam = start(-height)
        later = contact.impact(*(np.full(1, x) for x in (phase, u, lam))).duration[0]
        assert later > s0 + width
        if np.isfinite(later):
            grid = np.linspace(0, 1, 5001)[1:-1] * later
            assert np.all(observed(u, lam, grid)[0] < NOISE)
            assert abs(observed(u, lam, later)[0]) < NOISE


@pytest.mark.parametrize(("omega", "zeta"), [(1.0, 0.0), (1.0, 1e-4), (1.01, 0.0), (0.98, 0.01)])
def test_next_to_the_undamped_resonance_the_first_release_is_found(omega, zeta):
    rng = np.random.default_rng(9)
    contact = SpringDamper(omega, zeta)
    phase, velocity, lam = (
        rng.uniform(-3, 3, 40),
        -rng.uniform(0.05, 3, 40),
        rng.uniform(0.1, 2, 40),
    )
    found = contact.impact(phase, velocity, lam)
    assert np.all(found.status == Status.BOUNCING)
    time = np.linspace(0, 1, 4001)[1:-1, None] * found.duration
    inside, _ = contact.in_contact(time, phase, velocity, lam)
    assert np.all(inside < NOISE)
    ends, _ = contact.in_contact(found.duration, phase, velocity, lam)
    assert np.all(np.abs(ends) < 100 * NOISE)


@every_release
def test_below_the_threshold_a_ball_in_steady_contact_never_leaves_and_above_it_it_does(release):
    contact = SpringDamper(np.array([0.6, 1.0, 2.0, 9.0]), np.array([0.3, 0.1, 0.05, 0.2]), release)
    threshold = contact.permanent_contact_threshold()
    # In the steady motion, hundreds of periods after any start, at a phase where the ball is below
    # the table's level for all these contacts.
    time = 600 * np.pi

    def steady(lam):
        gap, rate = contact.in_contact(time, 0.5, 0.0, lam)
        return contact.impact(np.full(4, 0.5), rate, lam, gap)

    below = steady(0.99 * threshold)
    assert np.all(below.status == Status.PERMANENT_CONTACT)
    assert np.all(np.isinf(below.duration)) and np.all(np.isnan(below.velocity))
    above = steady(1.01 * threshold)
    assert np.all(above.status == Status.BOUNCING)


def test_the_contact_of_an_undamped_ball_that_is_not_decided_is_said_to_be():
    # Without damping the transient never decays: no bound proves that the ball stays.
    found = SpringDamper(50.0, 0.0).impact(np.ones(1), np.full(1, -1e-4), np.full(1, 1e-3))
    assert found.status[0] in (Status.UNDECIDED, Status.BOUNCING)


def test_parameters_out_of_range_are_refused_in_one_line(refusal):
    with refusal(ModelError, "ϖ = 0.0", "> 0"):
        SpringDamper(0.0, 0.1)
    with refusal(ModelError, "ζ = 1.0", "[0, 1)"):
        SpringDamper(2.0, 1.0)
    parts = "frequency_ratio of shape (2,)", "damping_ratio of shape (3,)", "do not broadcast"
    with refusal(ModelError, *parts):
        SpringDamper([2.0, 3.0], [0.1, 0.2, 0.3])


def test_a_ball_is_made_from_one_measure_of_its_loss(refusal):
    by_restitution = spring_damper(frequency_ratio=10.0, restitution=0.7)
    assert by_restitution.damping_ratio == float(damping_ratio(0.7))
    measured = spring_damper(frequency_ratio=10.0, measured_restitution=0.7, release="force")
    assert measured.damping_ratio == float(damping_ratio(0.7, "force"))
    other = spring_damper(frequency_ratio=10.0, restitution=0.7, release="force")
    assert other.damping_ratio == by_restitution.damping_ratio
    with refusal(ModelError, "one of the arguments restitution damping_ratio"):
        spring_damper(frequency_ratio=10.0)
    with refusal(ModelError, "argument damping_ratio: not allowed with argument restitution"):
        spring_damper(frequency_ratio=10.0, restitution=0.7, damping_ratio=0.1)
