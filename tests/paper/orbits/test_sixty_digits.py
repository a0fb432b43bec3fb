"""The branch and its bifurcations against 60-digit arithmetic.

Nothing is shared with the code but the model: the contact's response is
written with complex exponentials, the orbit solves the three conditions of
``docs/closed-form.md`` by elimination, and the monodromy is a difference
quotient of the return map, whose events are found by the secant method. With a
step of 1e-20 in 60 digits, 35 digits are left.
"""

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf

from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits import spring_damper_bifurcations as limits
from bouncing_ball.paper.orbits.spring_damper_branch import branch_point
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel

EPS = np.finfo(float).eps
STEP = mpf(10) ** -20


class Exact:
    """One contact and family in 60 digits."""

    def __init__(self, contact: SpringDamper, n: int):
        self.omega, self.zeta = (
            mpf(float(contact.frequency_ratio)),
            mpf(float(contact.damping_ratio)),
        )
        self.a, self.q, self.n = self.zeta * self.omega, self.omega**2, int(n)
        self.damped = self.omega * mp.sqrt(1 - self.zeta**2)
        force = contact.release is Release.FORCE
        self.lag = 2 * self.zeta / self.omega if force else mpf(0)
        self.free_angle = mp.pi - 2 * mp.asin(self.zeta if force else 0)

    def responses(self, s):
        """(g, g′), (G, G′), and the responses to sin and cos with their rates."""
        decay = mp.exp(-self.a * s)
        sine = mp.sin(self.damped * s) / self.damped
        g = decay * sine
        g_rate = decay * (mp.cos(self.damped * s) - self.a * sine)
        weight = (1 - g_rate - 2 * self.a * g) / self.q
        h = (mp.expj(s) - g_rate - (1j + 2 * self.a) * g) / (self.q - 1 + 2j * self.a)
        h_rate = 1j * h + g
        return (g, g_rate), (weight, g), (h.imag, h_rate.imag), (h.real, h_rate.real)

    def state(self, s, u, x, y):
        """δ and δ′ a time s after an impact with δ′ = u."""
        push, weight, sine, cosine = self.responses(s)
        return tuple(u * push[k] - weight[k] + x * sine[k] + y * cosine[k] for k in (0, 1))

    def orbit(self, excess):
        """D and (u, X, Y) from the release, the velocity and the landing."""
        duration = (self.free_angle + mpf(excess)) / self.damped
        flight = 2 * mp.pi * self.n - duration
        push, weight, sine, cosine = self.responses(duration)
        c, s = mp.cos(duration), mp.sin(duration)
        columns = (push, sine, cosine)
        matrix = mp.matrix(
            [
                [k[0] + self.lag * k[1] for k in columns],
                [push[1] - 1, sine[1] + c - 1, cosine[1] - s],
                [push[0] + flight, sine[0] + s + flight, cosine[0] + c - 1],
            ]
        )
        right = [weight[0] + self.lag * weight[1], weight[1] + flight, weight[0] - flight**2 / 2]
        return duration, *mp.lu_solve(matrix, mp.matrix(right))

    def cycle(self, duration, phase, u, amplitude):
        """The return map, for events near those of the orbit."""
        x, y = amplitude * mp.cos(phase), amplitude * mp.sin(phase)

        def released(s):
            gap, rate = self.state(s, u, x, y)
            return gap + self.lag * rate

        width = STEP / self.omega
        stay = mp.findroot(released, (duration - width, duration + width), tol=1e-100, verify=False)
        gap, rate = self.state(stay, u, x, y)
        off = phase + stay

        def above(s):
            moved = amplitude * (mp.sin(off + s) - mp.sin(off) - s * mp.cos(off))
            return gap + rate * s - s * s / 2 - moved

        hang = 2 * mp.pi * self.n - duration
        hang = mp.findroot(above, (hang - STEP, hang + STEP), tol=1e-100, verify=False)
        landing = off + hang
        speed = rate - hang - amplitude * (mp.cos(landing) - mp.cos(off))
        return landing, speed

    def trace(self, excess):
        """Trace of the monodromy, by central differences."""
        duration, u, x, y = self.orbit(excess)
        amplitude, phase = mp.hypot(x, y), mp.atan2(y, x)
        total = mpf(0)
        for k, (by_phase, by_speed) in enumerate(((STEP, 0), (0, STEP))):
            ends = [
                self.cycle(duration, phase + s * by_phase, u + s * by_speed, amplitude)[k]
                for s in (1, -1)
            ]
            total += (ends[0] - ends[1]) / (2 * STEP)
        return total

    def determinant(self, excess):
        return mp.exp(-2 * self.a * (self.free_angle + mpf(excess)) / self.damped)


def contacts(seed: int, count: int, low: float, high: float):
    random = np.random.default_rng(seed)
    omega = 10 ** random.uniform(low, high, count)
    restitution = random.uniform(0.05, 1.0, count)
    families = random.integers(1, 6, count)
    rules = random.permutation([*Release] * count)[:count]
    for w, r, n, rule in zip(omega, restitution, families, rules, strict=True):
        yield SpringDamper.from_restitution(float(r), float(w), Release(rule)), int(n), random


def test_the_branch_in_sixty_digits():
    errors = []
    with mpmath.workdps(60):
        for contact, n, random in contacts(1, 200, 0, 6):
            excess = float(random.uniform(-1, 1)) / float(contact.frequency_ratio)
            point, exact = branch_point(excess, contact, n), Exact(contact, n)
            _, u, x, y = exact.orbit(excess)
            amplitude = mp.hypot(x, y)
            numbers = zip((point.u, point.x, point.y), (u, x, y), strict=True)
            size = max(amplitude, abs(u))
            errors.append(float(max(abs(mpf(float(a)) - b) for a, b in numbers) / size))
    # A 3 × 3 solve whose condition costs up to two digits, on the median none.
    assert max(errors) < 1e-13
    assert np.median(errors) < 4 * EPS


def check_bifurcation(contact: SpringDamper, n: int, kind: str, closed: float = 1e3 * EPS) -> bool:
    """Whether a reported bifurcation is one in 60 digits; False if none is reported."""
    sign = 1 if kind == "saddle_node" else -1
    excess = float(getattr(limits, kind)(contact, n))
    if np.isnan(excess):
        return False
    exact = Exact(contact, n)

    def test(x):
        return 1 - sign * exact.trace(x) + exact.determinant(x)

    _, u, x, y = exact.orbit(excess)
    # A grazing orbit would have u = 0, a pole an infinite Λ.
    assert abs(u) > 1e-6 and mp.hypot(x, y) < 1e8
    # Closed in double precision, where the trace has lost three digits at most.
    assert abs(test(excess)) < closed
    width = mpf(1e-6) * min(abs(excess), 1 / exact.omega)
    assert test(excess - width) * test(excess + width) < 0
    return True


NAMED = [(0.794141, 0.170932, 19), (0.775496, 0.244529, 13), (0.32412, 0.255791, 193)]


@pytest.mark.parametrize("kind", ["saddle_node", "period_doubling"])
@pytest.mark.parametrize(("restitution", "omega", "n"), NAMED)
def test_what_once_was_a_pole_or_a_grazing_orbit(restitution, omega, n, kind):
    # Reported at Λ = 6e17, at 1108 and at 7375: poles and one grazing orbit. The
    # zeros of the test functions have balls that rise at impact, and say so.
    contact = SpringDamper.from_restitution(restitution, omega)
    with mpmath.workdps(60):
        assert check_bifurcation(contact, n, kind)
    orbit = getattr(SpringDamperModel(contact), kind)(n)
    assert orbit.relative_impact_velocity > 0
    assert not orbit.is_admissible()


@pytest.mark.parametrize("kind", ["saddle_node", "period_doubling"])
def test_bifurcations_in_sixty_digits(kind):
    with mpmath.workdps(60):
        found = [check_bifurcation(c, n, kind) for c, n, _ in contacts(2, 20, -1, 5)]
    assert sum(found) > 15


@pytest.mark.long
@pytest.mark.parametrize("rule", list(Release))
def test_no_bifurcation_of_the_whole_range_is_false(rule):
    random, found = np.random.default_rng(60), 0
    with mpmath.workdps(60):
        for _ in range(200):
            omega, n = 10 ** random.uniform(-1, 4), int(200 ** random.uniform())
            contact = SpringDamper.from_restitution(random.uniform(0.05, 0.999), omega, rule)
            for kind in ("saddle_node", "period_doubling"):
                # Of 723, a root was off by 3.5e-10 of itself at most, at n = 173 and ϖ = 0.3,
                # where the test function is steep. At a pole it is large.
                found += check_bifurcation(contact, n, kind, closed=1e-9)
    assert found > 350
