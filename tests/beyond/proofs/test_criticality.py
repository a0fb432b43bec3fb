"""The certified criticality against derivatives of the return map in 90 digits."""

from fractions import Fraction

import mpmath
import pytest
from flint import arb
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball.beyond.proofs.balls import precision
from bouncing_ball.beyond.proofs.certificates import Proved, period_doubling
from bouncing_ball.beyond.proofs.problem import RationalProblem
from bouncing_ball.beyond.proofs.return_map import flip_coefficient, return_map
from bouncing_ball.beyond.proofs.series import Series, angle
from bouncing_ball.models.damping import Release

SPRING = {"frequency_ratio": Fraction(10), "restitution": Fraction(85, 100)}
SOFT = {"frequency_ratio": Fraction(44, 100), "restitution": Fraction(144, 10_000)}
# The truncation of central differences is about the square of this step, times higher derivatives.
STEP = mpf(10) ** -10


def test_the_angle_of_a_point_has_the_taylor_series_of_the_arctangent():
    """Along a line on which x and y change together, so that all terms of a degree add up."""
    with precision(120), mp.workdps(60):
        x = Series.variable(arb("1.25"), 0, 3)
        y = Series.variable(arb("0.5"), 1, 3)
        found = [number(term) for term in angle(x, 2 * x + y).terms]
        expected = mp.taylor(lambda t: mp.atan2(2 * (1.25 + t) + 0.5 + t, 1.25 + t), 0, 3)
        # The terms of the degrees 0 to 3: 1, 2, 3 and 4 of them.
        degrees = [mp.fsum(found[k * (k + 1) // 2 : (k + 1) * (k + 2) // 2]) for k in range(4)]
        assert max(abs(a - b) for a, b in zip(degrees, expected, strict=True)) < 1e-20


def number(ball):
    """The midpoint of a ball in the digits of mpmath."""
    return mpf(ball.mid().str(60, radius=False))


def deviations(problem, found):
    """The return map of deviations from the certified orbit, which takes and returns columns."""
    with precision(found.bits):
        zeta = number(problem.damping())
        excess = number(found.excess)
    ratio = mpf(problem.frequency_ratio.numerator) / problem.frequency_ratio.denominator
    one = Exact(problem.approximate(), problem.n, ratio, zeta)
    duration, u, x, y = one.orbit(excess)
    amplitude = mp.hypot(x, y)
    phase = mp.atan2(y, x)

    def mapped(away):
        return mp.matrix(one.cycle(duration, phase + away[0], u + away[1], amplitude))

    return mapped


def cubic_coefficient(mapped):
    """c of ξ → -ξ + c ξ³ by central differences (Kuznetsov, Section 5.4)."""
    here = mapped(mp.zeros(2, 1))

    def curvature(along):
        ends = mapped(STEP * along) + mapped(-STEP * along)
        return (ends - 2 * here) / STEP**2

    def mixed(first, second):
        return (curvature(first + second) - curvature(first - second)) / 4

    linear = mp.zeros(2)
    for k in (0, 1):
        along = mp.zeros(2, 1)
        along[k] = STEP
        linear[:, k] = (mapped(along) - mapped(-along)) / (2 * STEP)
    q = mp.matrix([linear[0, 1], -1 - linear[0, 0]])
    p = mp.matrix([linear[1, 0], -1 - linear[0, 0]])
    bent = mp.lu_solve(mp.eye(2) - linear, curvature(q))
    odd = [mapped(k * STEP * q) - mapped(-k * STEP * q) for k in (1, 2)]
    third = (odd[1] - 2 * odd[0]) / (2 * STEP**3)
    total = third / 6 + mixed(q, bent) / 2
    return (p.T * total)[0] / (p.T * q)[0]


@pytest.mark.parametrize(
    ("given", "release", "kind"),
    [
        (SPRING, Release.DISPLACEMENT, Proved.SUPERCRITICAL),
        (SPRING, Release.FORCE, Proved.SUPERCRITICAL),
        (SOFT, Release.FORCE, Proved.SUBCRITICAL),
    ],
)
def test_the_criticality_is_that_of_a_return_map_in_ninety_digits(given, release, kind):
    problem = RationalProblem(**given, release=release)
    found = period_doubling(problem)
    assert kind in found.proved
    with mpmath.workdps(90):
        coefficient = cubic_coefficient(deviations(problem, found))
        with precision(found.bits):
            contact = problem.contact()
            determinant = (-2 * contact.decay * found.orbit.duration).exp()
            ball = flip_coefficient(return_map(contact, found.orbit), determinant)
        assert abs(coefficient / number(ball) - 1) < 1e-16
    assert (coefficient > 0) is (kind is Proved.SUPERCRITICAL)
