"""The balls against an integrator, 60 digits, finite differences and their definitions."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond.contacts.balls import (
    Corrected,
    H,
    Rigid,
    SpringDamper,
    damping_of,
)
from bouncing_ball_beyond.contacts.one_ball import PATIENCE
from bouncing_ball_beyond.contacts.oscillator import motion
from bouncing_ball_beyond.tables.table import SINE

RELEASES = ["displacement", "force"]
# Errors of the integrator, whose tolerance is 1e-13, over some tens of steps.
INTEGRATED = 1e-11


def integrated(ball, tau, u, amplitude, end):
    """The release of a contact by DOP853: the time, δ and δ′, or None if it lasts to ``end``."""
    ratio, zeta, kappa = ball.frequency_ratio, ball.zeta, ball.kappa

    def motion(s, y):
        return [y[1], -1 + amplitude * np.sin(tau + s) - ratio * (2 * zeta * y[1] + ratio * y[0])]

    def release(s, y):
        return y[0] + kappa * y[1] if s > 0 else -1.0

    release.terminal, release.direction = True, 1
    shortest = min(1.0, 1 / ratio)
    start = [float(ball.start(u)), -u]
    options = {"rtol": 1e-13, "atol": 1e-16, "first_step": 1e-3 * shortest * min(abs(u), 1)}
    solution = solve_ivp(
        motion, (0, end), start, "DOP853", events=release, max_step=shortest / 4, **options
    )
    return (
        (solution.t_events[0][0], *solution.y_events[0][0]) if solution.t_events[0].size else None
    )


def random_balls(seed, number):
    """Contacts from compliant to stiff, some undamped or with ζ ≥ 1, and impacts on them."""
    rng = np.random.default_rng(seed)
    for count in range(number):
        ratio = 10 ** rng.uniform(-0.3, 1.7)
        zeta = [rng.uniform(0, 0.9), rng.uniform(0, 0.3), rng.choice([0.0, 1.0, 1.7])][count % 3]
        ball = SpringDamper(ratio, damping_ratio=zeta, release=RELEASES[count % 2])
        yield ball, rng.uniform(0, 2 * np.pi), 10 ** rng.uniform(-2, 1), 4 * rng.uniform() ** 2


def test_contacts_against_an_integrator():
    """First releases and what they leave, of contacts that end and of contacts that last."""
    lasting = 0
    for ball, tau, u, amplitude in random_balls(1, 36):
        T = ball.first_release(tau, u, amplitude)
        duration = T / ball.frequency_ratio
        if np.isnan(T):
            lasting += 1
            assert integrated(ball, tau, u, amplitude, 30.0) is None
            continue
        expected = integrated(ball, tau, u, amplitude, 1.1 * duration + 0.1)
        impact = ball.contact(tau, u, T, amplitude)
        scale = duration, u / ball.frequency_ratio + duration**2, u + amplitude + 1
        errors = np.subtract(impact[:3], expected) / scale
        assert np.abs(errors).max() < INTEGRATED * max(1, duration)
        assert abs(impact.release) < 1e-13 * (u + 1 / ball.frequency_ratio)
    assert 3 < lasting < 25


def release_function(ball, tau, u, amplitude, times):
    return ball.contact(tau, u, times * ball.frequency_ratio, amplitude).release


@pytest.mark.parametrize("release", RELEASES)
def test_no_release_is_passed_where_a_contact_almost_touches_it(release):
    """Λ is bisected to where the first release jumps, because an earlier rise just misses zero."""
    ball = SpringDamper(8.0, restitution=0.6, release=release)
    rng = np.random.default_rng(3)
    jumps = 0
    for tau, u in rng.uniform([0, 0.01], [2 * np.pi, 0.5], (8, 2)):
        amplitudes = np.linspace(1.0, 4.0, 31)
        T = ball.first_release(tau, u, amplitudes)
        (places,) = np.nonzero(np.abs(np.diff(T)) > 1.0)
        if not places.size:
            continue
        jumps += 1
        low, high = amplitudes[places[0] : places[0] + 2]
        first = T[places[0]]
        for _ in range(45):
            middle = (low + high) / 2
            same = abs(ball.first_release(tau, u, middle) - first) < 0.5
            low, high = (middle, high) if same else (low, middle)
        ends = ball.first_release(tau, u, np.array([low, high])) / ball.frequency_ratio
        for amplitude, end in zip((low, high), ends, strict=True):
            times = end * np.linspace(1e-6, 1 - 1e-6, 20_000)
            assert (release_function(ball, tau, u, amplitude, times) < 0).all()
    assert jumps > 2


def test_contacts_that_last():
    """Where there is no release, the release function is negative for a hundred periods."""
    times = np.linspace(1e-3, PATIENCE, 200_000)
    ratios, dampings = [0.7, 1.0, 6.0], [0.02, 0.4, 1.5]
    for ratio, zeta in zip(ratios, dampings, strict=True):
        for release in RELEASES:
            ball = SpringDamper(ratio, damping_ratio=zeta, release=release)
            assert np.isnan(ball.first_release(1.0, 0.01, 0.03))
            assert (release_function(ball, 1.0, 0.01, 0.03, times) < 0).all()


def test_first_releases_side_by_side():
    """Arrays of balls and impacts broadcast, and give the numbers that each gives alone."""
    balls = SpringDamper(np.array([1.0, 4.0, 30.0]), restitution=np.array([0.9, 0.5, 0.7]))
    tau, u = np.linspace(0, 6, 5)[:, None], np.array([2.0, 0.1, 1.0])
    releases = balls.first_release(tau, u, 1.5)
    assert releases.shape == (5, 3)
    for (row, column), T in np.ndenumerate(releases):
        values = {name: value[column] for name, value in balls.parameters.items()}
        alone = balls.at(**values).first_release(tau[row, 0], u[column], 1.5)
        np.testing.assert_allclose(alone, T, rtol=1e-12)


def test_a_ball_that_is_laid_on_the_table():
    """It leaves at once where the table falls away, and otherwise as after a very slow impact."""
    ball = SpringDamper(10.0, restitution=0.5)
    assert ball.first_release(1.0, 0.0, 2.0) < 1e-9
    laid, slow = ball.first_release(0.3, np.array([0.0, 1e-10]), 2.0)
    assert laid == pytest.approx(slow, rel=1e-8)
    assert np.isnan(ball.first_release(0.3, 0.0, 0.5))
    assert np.isnan(ball.first_release(np.nan, 1.0, 0.5))


def test_a_resumed_contact_starts_where_its_force_vanishes():
    """A ball that rises below the level, u < 0, meets the line of zero force again."""
    ball = SpringDamper(5.0, restitution=0.3, release="force")
    u = -0.2
    assert ball.start(u) == ball.kappa * u < 0
    start = ball.contact(4.0, u, 0.0, 2.0)
    assert (start.gap, start.speed) == (ball.start(u), -u)
    assert abs(start.release) < 1e-16
    T = ball.first_release(4.0, u, 2.0)
    assert (release_function(ball, 4.0, u, 2.0, T / 5.0 * np.linspace(0.01, 0.99, 500)) < 0).all()
    time, gap, speed = integrated(ball, 4.0, u, 2.0, 5.0)
    np.testing.assert_allclose((time, gap, speed), ball.contact(4.0, u, T, 2.0)[:3], rtol=1e-9)


def sixty_digits(s, tau, gap, u, amplitude, gravity, ratio, zeta):
    """δ and δ′ by Eqs. 12 and 13; at ϖ = 1, ζ = 0 and at ζ = 1 next to these values, by 1e-25."""
    s, tau, gap, u, amplitude, gravity, ratio, zeta = (
        mpmath.mpf(number) for number in (s, tau, gap, u, amplitude, gravity, ratio, zeta)
    )
    zeta += mpmath.mpf(10) ** -25
    decay, stiffness = zeta * ratio, ratio**2
    omega = ratio * mpmath.sqrt(mpmath.mpc(1 - zeta**2))
    steady = amplitude / (stiffness - 1 + 2j * decay)
    rest = -gravity / stiffness
    start, end = steady * mpmath.expj(tau), steady * mpmath.expj(tau + s)
    c = gap - rest - start.imag
    d = (-u - start.real + decay * c) / omega
    cos, sin, envelope = mpmath.cos(omega * s), mpmath.sin(omega * s), mpmath.exp(-decay * s)
    position = envelope * (c * cos + d * sin) + rest + end.imag
    falling = (omega * d - decay * c) * cos - (omega * c + decay * d) * sin
    return [mpmath.re(position), mpmath.re(envelope * falling) + end.real]


def in_contact(s, tau, gap, u, amplitude, gravity, ratio, zeta):
    """δ and δ′ of the linear contact on the sine."""
    return motion(s, gap, u, SINE, SINE.waves(tau, amplitude), gravity, ratio, zeta)


DELICATE = [
    (1.0, 0.0),
    (1 + 1e-8, 0.0),
    (1 - 1e-8, 1e-9),
    (1.0, 1e-13),
    (1.001, 0.0),
    (1.02, 0.0),
    (0.9, 0.05),
    (0.5, 0.0),
    (2.0, 1.0),
    (3.0, 1 - 1e-5),
    (3.0, 1 - 1e-8),
    (3.0, 1 + 1e-8),
    (7.0, 1.01),
    (40.0, 2.5),
    (1e4, 0.05),
]


@pytest.mark.parametrize(("ratio", "zeta"), DELICATE)
def test_all_digits_near_resonance_and_critical_damping(ratio, zeta):
    """Values and all first derivatives of contacts against 60 digits, from short to long."""
    with mpmath.workdps(60):
        step = mpmath.mpf(10) ** -18
        for scaled_duration in (1e-6, 0.8, 3.0, np.pi, 9.0):
            given = [scaled_duration / ratio, 0.7, -0.1 / ratio, 1.3, 1.8, 1.0, ratio, zeta]
            state = np.array(in_contact(*given))
            expected = sixty_digits(*given)
            derivatives = np.empty((len(given), 2))
            errors = np.empty((len(given), 2))
            for i in range(len(given)):
                up, down, complex_step = list(given), list(given), list(given)
                up[i], down[i] = mpmath.mpf(given[i]) + step, mpmath.mpf(given[i]) - step
                complex_step[i] = given[i] + 1j * H
                ends = sixty_digits(*up), sixty_digits(*down)
                exact = [(high - low) / (2 * step) for high, low in zip(*ends, strict=True)]
                by_step = np.imag(in_contact(*complex_step)) / H
                derivatives[i] = [float(slope) for slope in exact]
                errors[i] = [float(a - b) for a, b in zip(by_step, exact, strict=True)]
            # Arguments have rounding errors of 1e-16, which a value has times its derivatives. Each
            # of up to seven doublings adds some.
            scale = np.abs(derivatives * np.array(given)[:, None]).max(axis=0)
            assert (
                np.abs([float(a - b) for a, b in zip(state, expected, strict=True)]) < 8e-15 * scale
            ).all()
            # Those of derivatives are of the size of the largest change of the motion itself.
            natural = scale / np.maximum(np.abs(given), 1e-3)[:, None] + np.abs(derivatives)
            assert (np.abs(errors) < 1e-13 * natural).all()


@pytest.mark.parametrize("zeta", [0.0, 0.5, 0.8, 1 - 1e-6, 1.0, 1 + 1e-6, 1.3, 20.0])
def test_free_contacts_that_end_by_the_force(zeta):
    """T = 2 arccos ζ/√(1 - ζ²) and its derivative by 60 digits, through ζ = 1."""

    def exact(zeta):
        zeta = mpmath.mpc(zeta) + mpmath.mpf(10) ** -25
        return mpmath.re(2 * mpmath.acos(zeta) / mpmath.sqrt(1 - zeta**2))

    with mpmath.workdps(60):
        slope = mpmath.diff(exact, mpmath.mpf(zeta), h=mpmath.mpf(10) ** -18)
        expected = float(exact(zeta)), float(slope)
    ball = SpringDamper(1.0, damping_ratio=0.5, release="force")
    T = ball.at(damping_ratio=zeta + 1j * H).free(1.0)
    np.testing.assert_allclose((T.real, T.imag / H), expected, rtol=4e-15)


def test_derivatives_by_complex_steps():
    """Derivatives of contacts and signatures along parameters are those of finite differences."""
    ball = SpringDamper(6.0, restitution=0.7, release="force")
    names = {"frequency_ratio": 6.0, "restitution": 0.7}
    for name, value in names.items():
        step = 1e-6

        def seen(x, name=name):
            other = ball.at(**{name: x})
            return np.array([*other.contact(0.4, 2.0, 2.9, 1.2), *other.signature(1.0)])

        central = (seen(value + step) - seen(value - step)) / (2 * step)
        np.testing.assert_allclose(seen(value + 1j * H).imag / H, central, rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.3, 0.7, 1.0, 1.000001, 1.2, 3.0])
def test_signature_by_its_definition(release, zeta):
    """r, D and the centroid by the integral of the force, σ by small constant loads."""
    ball = SpringDamper(2.5, damping_ratio=zeta, release=release)
    v = 1.7
    r, duration, centroid, loss = ball.signature(v)
    if release == "displacement" and zeta >= 1:
        assert np.isnan([r, duration, centroid, loss]).all()
        return
    end = ball.contact(0.0, v, ball.free(v), 0.0, 0.0)
    assert abs(end.release) < 1e-14
    assert end.speed / v == pytest.approx(r, rel=1e-13)
    assert end.duration == pytest.approx(duration, rel=1e-15)

    def force(s):
        gap, rate = in_contact(s, 0.0, 0.0, v, 0.0, 0.0, 2.5, zeta)
        return -2.5 * (2.5 * gap + 2 * zeta * rate)

    impulse = quad(force, 0, duration, epsabs=1e-13)[0]
    moment = quad(lambda s: s * force(s), 0, duration, epsabs=1e-13)[0]
    assert impulse == pytest.approx((1 + r) * v, rel=1e-11)
    assert centroid == pytest.approx(moment / impulse, rel=1e-10)

    T_free, step = float(ball.free(v)), 1e-5

    def impulse_under(load):
        u = v - load * centroid
        end = 0.99 * T_free, 1.01 * T_free
        T = brentq(lambda T: ball.contact(0.0, u, T, 0.0, load).release, *end, xtol=1e-15)
        return u + ball.contact(0.0, u, T, 0.0, load).speed + load * T / 2.5

    # Differences are wrong by 1e-15/step for rounding, and by step² times the third derivative.
    slope = (impulse_under(step) - impulse_under(-step)) / (2 * step)
    assert loss == pytest.approx(slope, abs=1e-7)


def test_signature_of_a_restitution_coefficient_that_depends_on_the_speed():
    """r(u) is that of the impact, and σ, D and t_c are zero."""
    ball = Rigid(lambda u: 0.9 / (1 + 0.1 * u))
    u = np.array([0.5, 2.0])
    signature = ball.signature(u)
    np.testing.assert_allclose(signature.restitution, 0.9 / (1 + 0.1 * u))
    assert not np.any(signature[1:])
    np.testing.assert_allclose(ball.contact(0.0, u, None, 1.0).speed, signature.restitution * u)
    slope = ball.contact(0.0, 2.0 + 1j * H, None, 1.0).speed.imag / H
    assert slope == pytest.approx(0.9 / 1.2**2)
    assert ball.parameters == {}


@pytest.mark.parametrize("release", RELEASES)
def test_instants_are_right_to_second_order(release):
    """From the same flight, the flights after contact and instant differ by O(1/ϖ²)."""
    tau, v, amplitude = 0.6, 2.0, 1.4

    def flight_after(time, gap, speed, at):
        """δ and δ′ at the time ``at`` of a flight that is continued from ``time``."""
        rest = at - time
        absolute = speed + amplitude * np.cos(time)
        height = gap + amplitude * np.sin(time) + absolute * rest - rest**2 / 2
        return np.array([height - amplitude * np.sin(at), absolute - rest - amplitude * np.cos(at)])

    def difference(ratio):
        contact = SpringDamper(ratio, restitution=0.6, release=release)
        instant = Corrected(contact)
        impact = instant.contact(tau, v, None, amplitude)
        assert impact.gap == instant.start(v) and impact.duration == 0 and impact.release == 0
        after = flight_after(tau, impact.gap, impact.speed, tau + 1)
        # The same flight before, at the level of the table.
        start = brentq(lambda t: flight_after(tau, impact.gap, -v, t)[0], tau - 3 / ratio, tau)
        u = -flight_after(tau, impact.gap, -v, start)[1]
        end = contact.contact(start, u, contact.first_release(start, u, amplitude), amplitude)
        return np.abs(flight_after(start + end.duration, end.gap, end.speed, tau + 1) - after).max()

    orders = np.log2([difference(ratio) / difference(2 * ratio) for ratio in (50.0, 100.0)])
    np.testing.assert_allclose(orders, 2, atol=0.1)


def test_parameters_and_other_values():
    """Balls at other values, real or complex, in arrays, and of the ball of a corrected model."""
    ball = SpringDamper(10.0, restitution=0.85)
    assert ball.parameters == {"frequency_ratio": 10.0, "restitution": 0.85}
    assert ball.zeta == damping_of(0.85)
    damped = ball.at(damping_ratio=0.1)
    assert damped.parameters == {"frequency_ratio": 10.0, "damping_ratio": 0.1}
    assert damped.at(restitution=0.85) == ball
    instant = Corrected(ball).at(frequency_ratio=np.array([5.0, 6.0]))
    assert instant.start(1.0).shape == (2,)
    assert Corrected(ball).parameters == ball.parameters
    assert Rigid(0.5).at(restitution=0.6) == Rigid(0.6)
    assert isinstance(Rigid([0.5, 0.6]).restitution, np.ndarray)
    assert [model.has_duration for model in (ball, instant, Rigid(0.5))] == [True, False, False]


def test_a_restitution_of_one_is_no_damping():
    """r = 1 has ζ = 0, and at ϖ = 1 the contact is finite with its derivatives."""
    ball = SpringDamper(1.0, restitution=1.0)
    assert ball.zeta == 0
    impact = ball.at(frequency_ratio=1 + 1j * H).contact(0.3, 1.0, np.pi, 1.0)
    assert np.isfinite(impact).all()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Rigid(1.2), r"restitution = 1.2: must be in \[0, 1\]"),
        (lambda: Rigid([0.5, np.nan]), r"restitution = nan: must be in \[0, 1\]"),
        (lambda: Rigid("hard"), r"restitution = 'hard': must be a number or an array"),
        (lambda: Rigid(None), r"restitution = None: must be a number or an array"),
        (lambda: SpringDamper("20", 0.5), r"frequency_ratio = '20': must be a number or an array"),
        (lambda: SpringDamper(20.0, ".5"), r"restitution = '\.5': must be a number or an array"),
        (lambda: Rigid(lambda u: np.abs(u) / 9), r"restitution: r\(u\) must be analytic"),
        (lambda: Rigid(lambda u: 0.9 if u > 1 else 0.8), r"restitution: r\(u\) must accept arrays"),
        (lambda: Rigid(lambda u: 1 + u), r"restitution at u = .* = 1.5: must be in \[0, 1\]"),
        (lambda: SpringDamper(0.0, restitution=0.5), r"frequency_ratio = 0: must be in \(0, ∞\)"),
        (lambda: SpringDamper(np.inf, restitution=0.5), r"frequency_ratio = inf: must be in"),
        (lambda: SpringDamper(1.0, restitution=0.0), r"restitution = 0: must be in \(0, 1\]"),
        (lambda: SpringDamper(1.0, damping_ratio=-0.1), r"damping_ratio = -0.1: must be in \[0"),
        (
            lambda: SpringDamper([1.0, 2.0], [0.5, 0.6, 0.7]),
            "frequency_ratio has .2,., restitution has .3,.",
        ),
        (lambda: SpringDamper(1.0), "exactly one of them must be given"),
        (lambda: SpringDamper(1.0, 0.5, 0.1), "exactly one of them must be given"),
        (lambda: SpringDamper(1.0, 0.5, release="gap"), "release = 'gap': must be 'displacement'"),
        (lambda: SpringDamper(1.0, 0.5).at(zeta=0.1), "zeta: no parameter of SpringDamper"),
        (lambda: Corrected(0.5), "ball = 0.5: must be a ball"),
        (lambda: Corrected(SpringDamper(1.0, damping_ratio=1.5)), "its free impacts do not end"),
    ],
)
def test_what_is_refused(make, message):
    """Errors are one line with the name, the value and what is allowed."""
    with pytest.raises(ValueError, match=message) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_an_instant_has_no_duration_in_its_own_time_either():
    assert float(Rigid(0.5).free(2.0)) == 0
