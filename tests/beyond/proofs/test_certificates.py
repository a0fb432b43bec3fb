"""Certificates against 60 digits, and proofs that must fail because the problem was changed."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from flint import arb
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball.beyond.proofs import certificates
from bouncing_ball.beyond.proofs.branch import Contact, point
from bouncing_ball.beyond.proofs.certificates import (
    Problem,
    ProofError,
    Proved,
    certified_zero,
    doubling_test,
    fold_test,
    orbit_at,
    period_doubling,
    precision,
    saddle_node,
)
from bouncing_ball.beyond.proofs.return_map import return_map
from bouncing_ball.beyond.proofs.series import Series
from bouncing_ball.paper.contact.damping import Release

TABLE_1 = [(ratio, n) for ratio in (10_000, 10, 2) for n in (1, 2, 3)]


def number(ball):
    """The midpoint of a ball in the digits of mpmath."""
    return mpf(ball.mid().str(60, radius=False))


def exact(problem):
    """The problem in 60 digits, with ζ from Eq. 16 in these digits."""
    r = problem.restitution
    ratio = mpf(problem.frequency_ratio.numerator) / problem.frequency_ratio.denominator
    decrement = -mp.log(mpf(r.numerator) / r.denominator)
    zeta = decrement / mp.sqrt(mp.pi**2 + decrement**2)
    return Exact(problem.approximate(), problem.n, ratio, zeta)


def check(problem, kind):
    """The certified number in 60 digits: Λ, and a change of sign across the certified ε."""
    found = {"saddle-node": saddle_node, "period doubling": period_doubling}[kind](problem)
    sign = 1 if kind == "saddle-node" else -1
    with mpmath.workdps(60):
        with precision(found.bits):
            excess = number(found.excess)
            radius = mpf(found.excess.rad().str(5, radius=False))
        amplitude, bound = (mpf(text) for text in found.texts(30))
        one = exact(problem)
        _, _, x, y = one.orbit(excess)
        # Λ is within its bound, and the digits of both computations.
        assert abs(mp.hypot(x, y) - amplitude) <= bound + mpf(10) ** -29
        width = mpf(10) ** -22 * (1 + abs(excess)) + radius
        ends = [
            1 - sign * one.trace(excess + side * width) + one.determinant(excess + side * width)
            for side in (-1, 1)
        ]
        assert ends[0] * ends[1] < 0
    return found


@pytest.mark.parametrize("kind", ["saddle-node", "period doubling"])
@pytest.mark.parametrize(("ratio", "n"), TABLE_1)
def test_the_ends_of_table_1_are_certified_to_thirty_digits(ratio, n, kind):
    found = check(Problem(Fraction(ratio), restitution=Fraction(85, 100), n=n), kind)
    text, radius = found.texts(30)
    assert float(radius) < 1e-28 and len(text.replace(".", "").lstrip("0")) == 30
    assert {Proved.UNIQUE, Proved.INSIDE, Proved.ADMISSIBLE} <= {*found.proved}


def random_problems(seed, count):
    random = np.random.default_rng(seed)
    for _ in range(count):
        ratio = Fraction(round(1e4 * 10 ** random.uniform(0, 5)), 10_000)
        restitution = Fraction(int(random.integers(50, 990)), 1000)
        rule = list(Release)[int(random.integers(2))]
        yield Problem(ratio, restitution=restitution, n=int(random.integers(1, 6)), release=rule)


def outcomes(seed, count):
    """How many random problems are certified and how many are refused; none is wrong."""
    certified = 0
    refused = []
    for problem in random_problems(seed, count):
        for kind in ("saddle-node", "period doubling"):
            try:
                check(problem, kind)
                certified += 1
            except ProofError as error:
                refused.append(str(error))
    return certified, refused


def test_random_certificates_are_right_or_refused_with_the_reason():
    certified, refused = outcomes(38, 10)
    assert certified + len(refused) == 20 and certified > 12
    assert all(refused)


@pytest.mark.long
def test_a_thousand_random_certificates_are_right_or_refused_with_the_reason():
    certified, refused = outcomes(39, 500)
    assert certified + len(refused) == 1000 and certified > 700


def test_an_orbit_at_a_given_amplitude_has_this_amplitude():
    problem = Problem(Fraction(10), restitution=Fraction(85, 100))
    for side in ("stable", "unstable"):
        found = orbit_at(problem, Fraction(1), side)
        with precision(found.bits):
            assert found.amplitude.contains(1) and found.amplitude.rad() < 1e-29


def test_the_determinant_of_the_return_map_is_that_of_the_contact():
    problem = Problem(Fraction(2), restitution=Fraction(65, 100))
    found = orbit_at(problem, Fraction(1))
    with precision(found.bits):
        contact = problem.contact()
        (a, b), (c, d) = return_map(contact, found.orbit).monodromy
        determinant = (-2 * contact.decay * found.orbit.duration).exp()
        assert (a * d - b * c).overlaps(determinant)
        # And its trace is that of the formula.
        test = doubling_test(contact, 1, Series.variable(found.excess, 0, 2)).value
        assert (1 + a + d + determinant).overlaps(test)


GIVEN = Problem(Fraction(10), restitution=Fraction(85, 100))


def certify(test, start=None, contact=None):
    with precision(200):
        one = contact or GIVEN.contact()
        begin = float(saddle_node(GIVEN).excess.mid()) if start is None else start
        return certified_zero(lambda e: test(one, 1, e), begin)


def test_a_tangency_is_not_certified():
    # The square of the test function touches zero where the fold lies.
    with pytest.raises(ProofError):
        certify(lambda *given: fold_test(*given) * fold_test(*given))


def test_a_function_without_a_zero_is_not_certified():
    with pytest.raises(ProofError):
        certify(lambda *given: fold_test(*given) * fold_test(*given) + 1)


def test_a_box_that_is_too_wide_is_not_certified(monkeypatch):
    monkeypatch.setattr(certificates, "_WIDER", (2**300,))
    with pytest.raises(ProofError, match="mapped into its interior"):
        certify(fold_test)


@pytest.mark.parametrize("shift", [-3.0, 0.5, 2.0])
def test_a_shifted_start_is_refused_or_leads_to_the_same_saddle_node(monkeypatch, shift):
    same = saddle_node(GIVEN)
    start = certificates._start
    monkeypatch.setattr(certificates, "_start", lambda *given: start(*given) + shift)
    try:
        found = saddle_node(GIVEN)
    except ProofError:
        return
    assert found.excess.overlaps(same.excess)


@pytest.mark.parametrize(
    ("name", "proof"), [("fold_test", saddle_node), ("doubling_test", period_doubling)]
)
def test_a_wrong_sign_in_the_test_function_contradicts_the_return_map(monkeypatch, name, proof):
    right = getattr(certificates, name)

    def wrong(*given):
        # The zeros of this function are no bifurcations.
        return right(*given) - arb("0.001")

    monkeypatch.setattr(certificates, name, wrong)
    with pytest.raises(ProofError, match=r"contradicts|proved|excluded"):
        proof(GIVEN)


def test_a_wrong_sign_of_the_damping_is_noticed():
    # With a negative damping the determinant exceeds 1.
    with precision(200):
        zeta = -GIVEN.damping()
        wrong = Contact(arb(10), zeta, arb(0))
        orbit = point(wrong, 1, arb(0))
        with pytest.raises(ProofError):
            certificates._regular(wrong, orbit)


def test_a_release_that_is_too_early_is_noticed():
    found = saddle_node(GIVEN)
    with precision(80):
        contact = GIVEN.contact()
        orbit = found.orbit
        early = orbit._replace(duration=orbit.duration * 3)
        assert certificates.contact_holds(contact, orbit)
        assert not certificates.contact_holds(contact, early)


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"restitution": Fraction(1)}, "without dissipation"),
        ({"damping_ratio": Fraction(0)}, "without dissipation"),
        ({"restitution": Fraction(1, 2), "damping_ratio": Fraction(1, 10)}, "either"),
        ({"restitution": Fraction(1, 2), "n": 0}, "at least 1"),
    ],
)
def test_what_cannot_be_proved_is_refused_with_the_reason(given, reason):
    with pytest.raises(ProofError, match=reason):
        Problem(Fraction(10), **given)


def test_below_the_saddle_node_no_orbit_is_certified():
    with pytest.raises(ProofError, match="no 1-T orbit"):
        orbit_at(GIVEN, Fraction(1, 10))
