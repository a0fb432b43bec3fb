"""The branch and its bifurcations against 60-digit arithmetic (:mod:`sixty_digits`)."""

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact import spring_damper_bifurcations as bifurcations
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import branch_point

EPS = np.finfo(float).eps


def contacts(seed: int, count: int, low: float, high: float):
    random = np.random.default_rng(seed)
    omega = 10 ** random.uniform(low, high, count)
    restitution = random.uniform(0.05, 1.0, count)
    families = random.integers(1, 6, count)
    rules = random.permutation([*Release] * count)[:count]
    for w, r, n, rule in zip(omega, restitution, families, rules, strict=True):
        yield SpringDamper.from_restitution(float(r), float(w), Release(rule)), int(n), random


def test_the_branch_agrees_with_sixty_digits():
    errors = []
    with mpmath.workdps(60):
        for contact, n, random in contacts(1, 200, 0, 6):
            excess = float(random.uniform(-1, 1)) / float(contact.frequency_ratio)
            point = branch_point(excess, contact, n)
            exact = Exact(contact, n)
            _, u, x, y = exact.orbit(excess)
            amplitude = mp.hypot(x, y)
            numbers = zip((point.u, point.x, point.y), (u, x, y), strict=True)
            size = max(amplitude, abs(u))
            errors.append(float(max(abs(mpf(float(a)) - b) for a, b in numbers) / size))
    # A 3 × 3 solve whose condition costs up to two digits, on the median none.
    assert max(errors) < 1e-13
    assert np.median(errors) < 4 * EPS


def check_bifurcation(
    contact: SpringDamper, n: int, kind: str, closed: float | None = None
) -> bool:
    """Whether a reported bifurcation is one in 60 digits; False if none is reported."""
    # In double precision the trace loses three digits at most, and those of a long flight, whose
    # duration 2πn multiplies the deviations of its start.
    closed = EPS * max(1e3, 2 * np.pi * n) if closed is None else closed
    sign = 1 if kind == "saddle_node" else -1
    excess = float(getattr(bifurcations, kind)(contact, n))
    if np.isnan(excess):
        return False
    exact = Exact(contact, n)

    def test(x):
        return 1 - sign * exact.trace(x) + exact.determinant(x)

    _, u, x, y = exact.orbit(excess)
    # A grazing orbit would have u = 0, a pole an infinite Λ.
    assert abs(u) > 1e-6 and mp.hypot(x, y) < 1e8
    assert abs(test(excess)) < closed
    width = mpf(1e-6) * min(abs(excess), 1 / exact.omega)
    assert test(excess - width) * test(excess + width) < 0
    return True


NAMED = [(0.794141, 0.170932, 19), (0.775496, 0.244529, 13), (0.32412, 0.255791, 193)]


@pytest.mark.parametrize("kind", ["saddle_node", "period_doubling"])
@pytest.mark.parametrize(("restitution", "omega", "n"), NAMED)
def test_bifurcations_near_poles_and_grazing_orbits_are_those_of_sixty_digits(
    restitution, omega, n, kind
):
    # Reported at Λ = 6e17, at 1108 and at 7375: poles and one grazing orbit. The
    # zeros of the test functions have balls that rise at impact, and say so.
    contact = SpringDamper.from_restitution(restitution, omega)
    with mpmath.workdps(60):
        assert check_bifurcation(contact, n, kind)
    orbit = getattr(n_t, kind)(ContactModel(contact), n)
    assert orbit.relative_impact_velocity > 0
    assert not orbit.is_admissible()


@pytest.mark.parametrize("kind", ["saddle_node", "period_doubling"])
def test_random_bifurcations_agree_with_sixty_digits(kind):
    with mpmath.workdps(60):
        found = [check_bifurcation(c, n, kind) for c, n, _ in contacts(2, 20, -1, 5)]
    assert sum(found) > 15


@pytest.mark.long
@pytest.mark.parametrize("rule", LINEAR)
def test_no_bifurcation_of_the_whole_range_is_false(rule):
    random = np.random.default_rng(60)
    found = 0
    with mpmath.workdps(60):
        for _ in range(200):
            omega = 10 ** random.uniform(-1, 4)
            n = int(200 ** random.uniform())
            contact = SpringDamper.from_restitution(random.uniform(0.05, 0.999), omega, rule)
            for kind in ("saddle_node", "period_doubling"):
                # Of 723, a root was off by 3.5e-10 of itself at most, at n = 173 and ϖ = 0.3,
                # where the test function is steep. At a pole it is large.
                found += check_bifurcation(contact, n, kind, closed=1e-9)
    assert found > 350
