"""One contact of any law: against an independent integrator, and against what is exact."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import beta

from bouncing_ball.contacts.collocation import contacts, path
from bouncing_ball.contacts.laws.contact_law import ContactLaw, slopes_of
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.linear import Linear
from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
from bouncing_ball.contacts.quadrature import node_of, scheme, share
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.contacts import simulate

LAWS = {
    "linear": Linear(10.0, 0.136),
    "linear, force release": Linear(10.0, 0.136, "force"),
    "hunt-crossley": HuntCrossley(1e3, 0.08),
    "hunt-crossley, strong": HuntCrossley(1e3, 0.5),
    "tsuji": Tsuji(1e3, 0.3),
    "tsuji, strong": Tsuji(200.0, 1.2),
    "kuwabara-kono": KuwabaraKono(1e3, 0.005),
    "kuwabara-kono, weak": KuwabaraKono(1e3, 2e-4),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
SPEED, PHASE, AMPLITUDE = 3.5, 0.8, 1.2
EPS = np.finfo(float).eps


def integrated(law, speed, phase, amplitude):
    """D, p and p′ at the release, by an independent integrator of order eight.

    In p and t it loses its order at p = 0; in q = p^{1/m} and ds = dt/(m q^{m-1}), as in
    :mod:`bouncing_ball.contacts.first_guess`, the right sides are smooth there.
    """
    m = law.root

    def rates(_, state):
        q, u, t = state
        lever, p = m * q ** (m - 1), np.float64(max(q, 0.0) ** m)
        force = float(law.force(p, np.float64(u))) if p > 0 or m == 1 else 0.0
        return [u, lever * (1 - amplitude * np.sin(phase + t) - force), lever]

    def released(_, state):
        q, u, _ = state
        if law.release is Release.DISPLACEMENT:
            return q
        return float(law.grip(np.float64(max(q, 0.0) ** m), np.float64(u)))

    released.terminal, released.direction = True, -1
    start = [0.0, speed, 0.0]
    found = solve_ivp(rates, (0, 1e3), start, "DOP853", rtol=3e-14, atol=1e-16, events=released)
    q, u, t = found.y_events[0][0]
    return np.array([t, max(q, 0.0) ** m, u])


@every_law
def test_the_end_against_an_independent_integrator(law):
    end = contacts(law, SPEED, PHASE, AMPLITUDE)
    computed = np.array([end.duration, end.penetration, end.rate])
    expected = integrated(law, SPEED, PHASE, AMPLITUDE)
    # A hundred steps, each of 3e-14 of a speed of 3.5.
    np.testing.assert_allclose(computed, expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_linear_contact_is_that_of_the_closed_form(release):
    rng = np.random.default_rng(3)
    speed, phase, lam = rng.uniform(2, 6, 20), rng.uniform(-3, 3, 20), rng.uniform(0, 1, 20)
    exact = simulate(SpringDamper(12.0, 0.15, release), lam, phase, lam * np.cos(phase) - speed, 1)
    end = contacts(Linear(12.0, 0.15, release), speed, phase, lam)
    # An absolute angle of some ϖD = 3 is what both round.
    np.testing.assert_allclose(end.duration, exact.contact_duration[0], rtol=1e-13)
    np.testing.assert_allclose(-end.rate, exact.relative_release_velocity[0], rtol=1e-13)
    np.testing.assert_allclose(-end.penetration, exact.release_displacement[0], atol=1e-14)


@pytest.mark.parametrize("law", [HuntCrossley(50.0, 0.0), Tsuji(50.0, 0.0), KuwabaraKono(50.0, 0)])
def test_the_elastic_hertz_impact(law):
    # (2/5) K p^{5/2} = v²/2 at the greatest penetration, and D = (4/5) B(2/5, 1/2) p/v.
    v = 2.0
    deepest = (5 * v * v / (4 * 50.0)) ** 0.4
    end = contacts(law, v, weight=0.0)
    assert float(end.duration) == pytest.approx(0.8 * beta(0.4, 0.5) * deepest / v, rel=1e-13)
    assert float(end.rate) == pytest.approx(-v, rel=1e-13)
    # Inside, the path is as exact as its coefficients have fallen.
    assert float(path(law, end, v, end.duration / 2)[0]) == pytest.approx(deepest, rel=1e-9)


@pytest.mark.parametrize("restitution", [0.95, 0.65, 0.3, 0.1])
def test_tsujis_damping_gives_its_restitution_at_every_speed(restitution):
    law = Tsuji(300.0, tsuji_damping(restitution))
    speed = np.array([1e-3, 1.0, 50.0])
    end = contacts(law, speed, weight=0.0)
    np.testing.assert_allclose(-end.rate / speed, restitution, rtol=1e-12)


@every_law
def test_the_derivatives_of_the_end(law):
    start = np.array([PHASE, SPEED, AMPLITUDE, 1.0])

    def ends(x):
        end = contacts(law, x[1], x[0], x[2], x[3])
        return np.array([end.duration, end.penetration, end.rate])

    h, weights = 1e-2, np.array([-1, 9, -45, 45, -9, 1]) / 60
    steps = (-3, -2, -1, 1, 2, 3)
    for k in range(4):
        moved = [ends(start + j * h * np.eye(4)[k]) for j in steps]
        slope = sum(w * x for w, x in zip(weights, moved, strict=True)) / h
        exact = contacts(law, SPEED, PHASE, AMPLITUDE).jacobian[:, k]
        # h⁶/140 times a seventh derivative of order one, and 1e-14 over h.
        assert np.abs(slope - exact).max() < 1e-11


@every_law
def test_the_contraction_is_that_of_the_flow(law):
    # Areas of the section (φ, v): dp and dp′ at a fixed time, by the ends' derivatives.
    end = contacts(law, SPEED, PHASE, AMPLITUDE)
    (d_time, d_depth, d_rate), depth, rate = end.jacobian[:, :2], end.penetration, end.rate
    load = 1 - AMPLITUDE * np.sin(PHASE + end.duration)
    # Back along the flight after the release, to one time: the start is moved by dφ too.
    moved = d_time + np.array([1.0, 0.0])
    depth_then, rate_then = d_depth - rate * moved, d_rate - load * moved
    area = depth_then[0] * rate_then[1] - depth_then[1] * rate_then[0]
    assert depth >= 0
    # At the start dp = -v dφ for a contact that starts later.
    assert area == pytest.approx(-SPEED * float(end.contraction), rel=1e-11)


@every_law
def test_the_path_starts_and_ends_and_solves_the_equation(law):
    end = contacts(law, SPEED, PHASE, AMPLITUDE)
    duration = float(end.duration)
    depth, rate = path(law, end, SPEED, [0.0, duration])
    np.testing.assert_allclose(depth, [0.0, end.penetration], rtol=0, atol=1e-14)
    np.testing.assert_allclose(rate, [SPEED, end.rate], rtol=0, atol=1e-12)
    h = 1e-4 * duration
    time = np.linspace(0.2, 0.8, 7) * duration
    (_, ahead), (_, behind) = (path(law, end, SPEED, time + s * h) for s in (1, -1))
    p, u = path(law, end, SPEED, time)
    push = 1 - AMPLITUDE * np.sin(PHASE + time) - law.force(p, u)
    # Second order: h²/6 times the third derivative of p′, v/D³.
    assert np.abs((ahead - behind) / (2 * h) - push).max() < 1e-6 * SPEED / duration


@every_law
def test_slopes_are_the_derivatives(law):
    p, u = np.array([0.01, 0.3]), np.array([2.0, -0.5])
    for exact, general in (
        (law.slopes(p, u), slopes_of(law.force, p, u)),
        (law.grip_slopes(p, u), slopes_of(law.grip, p, u)),
    ):
        np.testing.assert_allclose(exact.by_penetration, general.by_penetration, rtol=1e-13)
        np.testing.assert_allclose(exact.by_rate, general.by_rate, rtol=1e-13)


def test_a_contact_is_found_whatever_its_neighbours():
    law = HuntCrossley(np.array([1e2, 1e5, 1e8]), 0.1)
    together = contacts(law, [3.0, np.nan, 2.0], 0.5, 0.9)
    assert np.isnan(together.duration[1])
    for k in (0, 2):
        alone = contacts(law[k], [3.0, 0, 2.0][k], 0.5, 0.9)
        assert float(together.duration[k]) == pytest.approx(float(alone.duration), rel=1e-14)


def test_what_does_not_end_is_no_contact():
    # A ball put down slowly on a table at rest stays.
    assert np.isnan(contacts(HuntCrossley(100.0, 0.5), 0.01).duration)
    # No speed, no impact.
    assert np.all(np.isnan(contacts(Tsuji(100.0, 0.5), [0.0, -1.0]).duration))


class _Pulling(ContactLaw):
    name = "pulling"

    def force(self, penetration, rate):
        return -penetration


def test_a_force_that_does_not_stop_the_ball_is_refused():
    with pytest.raises(ModelError, match="pulling does not stop the ball"):
        contacts(_Pulling(), 1.0)


@pytest.mark.parametrize("root", [1, 2, 4])
def test_the_quadrature_is_exact_for_polynomials_in_its_variable(root):
    s = scheme(16, root)
    push = s.share**2
    rate, depth = s.rate @ push, s.path @ push
    rate[~s.early] += 1 / 3
    depth[~s.early] += 1 / 12 - s.rest[~s.early] / 3
    np.testing.assert_allclose(rate, s.share**3 / 3, atol=10 * EPS)
    np.testing.assert_allclose(depth, s.share**4 / 12, atol=10 * EPS)
    x = np.linspace(0, 1, 11)
    np.testing.assert_allclose(node_of(share(x, root), root), x, atol=1e-3 if root == 4 else 1e-7)
