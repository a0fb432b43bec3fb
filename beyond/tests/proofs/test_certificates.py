"""Certificates against 60 digits, and proofs that must fail because the problem was changed."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from flint import arb
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball_beyond.periodic.one_impact import spring_damper_bifurcations as double
from bouncing_ball_beyond.proofs import certificates, newton
from bouncing_ball_beyond.proofs.balls import ProofError, decimal_with_bound, precision, rational
from bouncing_ball_beyond.proofs.branch import EnclosedContact, Point, point
from bouncing_ball_beyond.proofs.certificates import (
    Proved,
    certified_orbit,
    fold_test,
    period_doubling,
    saddle_node,
)
from bouncing_ball_beyond.proofs.newton import certified_zero
from bouncing_ball_beyond.proofs.problem import RationalProblem, damping_of
from bouncing_ball_beyond.proofs.series import Series

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
    found = check(RationalProblem(Fraction(ratio), Fraction(85, 100), n), kind)
    text, radius = found.texts(30)
    assert float(radius) < 1e-28 and len(text.replace(".", "").lstrip("0")) == 30
    assert {Proved.UNIQUE, Proved.INSIDE, Proved.ADMISSIBLE} <= {*found.proved}


def random_problems(seed, count):
    random = np.random.default_rng(seed)
    for _ in range(count):
        ratio = Fraction(round(1e4 * 10 ** random.uniform(0, 5)), 10_000)
        restitution = Fraction(int(random.integers(50, 990)), 1000)
        yield RationalProblem(ratio, restitution, int(random.integers(1, 6)))


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
def test_both_limits_of_a_thousand_random_balls_are_right_or_refused_with_the_reason():
    certified, refused = outcomes(39, 1000)
    assert certified + len(refused) == 2000 and certified > 1400


def test_an_orbit_at_a_given_amplitude_has_this_amplitude():
    found = certified_orbit(RationalProblem(Fraction(10), Fraction(85, 100)), Fraction(1))
    with precision(found.bits):
        assert found.amplitude.contains(1) and found.amplitude.rad() < 1e-29


GIVEN = RationalProblem(Fraction(10), Fraction(85, 100))


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


def test_a_ball_that_is_too_wide_is_not_certified(monkeypatch):
    monkeypatch.setattr(newton, "_WIDER", (2**300,))
    with pytest.raises(ProofError, match="mapped into its interior"):
        certify(fold_test)


@pytest.mark.parametrize("shift", [-3.0, 0.01, 0.5, 2.0])
@pytest.mark.parametrize("proof", [saddle_node, period_doubling])
def test_a_shifted_start_is_refused(monkeypatch, proof, shift):
    start = certificates._start
    monkeypatch.setattr(certificates, "_start", lambda *given: start(*given) + shift)
    with pytest.raises(ProofError, match=r"another solution|did not converge|singular"):
        proof(GIVEN)


TESTS = [("fold_test", saddle_node), ("doubling_test", period_doubling)]


def test_a_flight_that_begins_or_ends_in_the_wrong_direction_is_noticed():
    """Above a table that falls at ten times gravity, the gap is -t²/2 + rate t + 10(1 - cos t)."""
    numbers = dict.fromkeys(Point._fields, arb(0)) | {"y": arb(10), "flight": arb("4.5")}
    leaving = Point(**numbers | {"rate": arb("0.001")})
    with precision(80):
        assert certificates.flight_is_free(leaving)
        # The ball would first sink below the table, or end its flight upwards.
        assert not certificates.flight_is_free(leaving._replace(rate=arb("-0.001")))
        assert not certificates.flight_is_free(leaving._replace(flight=arb(2)))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"matrix": arb("0 +/- 0.5")}, "linear system"),
        ({"duration": arb(0)}, "contact's duration"),
        ({"flight": arb(0)}, "flight time"),
        ({"u": arb("-0.1 +/- 0.2")}, "approach the table"),
        ({"rate": arb("nan")}, "leave the table"),
    ],
)
def test_an_orbit_that_may_be_singular_or_graze_is_refused(change, reason):
    orbit = saddle_node(GIVEN).orbit
    certificates._require_regular(orbit)
    with pytest.raises(ProofError, match=reason):
        certificates._require_regular(orbit._replace(**change))


def test_an_inadmissible_bifurcation_is_refused(monkeypatch):
    for name in ("contact_holds", "flight_is_free"):
        monkeypatch.setattr(certificates, name, lambda *given: False)
        for proof in (saddle_node, period_doubling):
            with pytest.raises(ProofError, match="may be inadmissible"):
                proof(GIVEN)
        monkeypatch.undo()


@pytest.mark.parametrize("name", ["fold_test", "doubling_test"])
def test_a_period_doubling_whose_multiplier_may_touch_is_refused(monkeypatch, name):
    found = period_doubling(GIVEN)
    right = getattr(certificates, name)
    monkeypatch.setattr(certificates, name, lambda *given: right(*given) * arb("0 +/- 1"))
    with precision(found.bits), pytest.raises(ProofError, match="without crossing"):
        certificates.period_doubling_properties(GIVEN.contact(), 1, found.excess)


def test_at_a_saddle_node_an_orbit_is_called_neither_stable_nor_unstable():
    found = saddle_node(GIVEN)
    with precision(found.bits):
        proved = certificates.orbit_properties(GIVEN.contact(), 1, found.excess)
    assert proved == [Proved.ADMISSIBLE]


@pytest.mark.parametrize("x", [arb("0 +/- 1e-9"), arb("nan"), arb("inf")])
def test_an_amplitude_that_may_be_zero_or_infinite_is_refused(x):
    orbit = saddle_node(GIVEN).orbit
    with pytest.raises(ProofError, match="0 or infinite"):
        certificates._amplitude(orbit._replace(x=x, y=arb(0)))


@pytest.mark.parametrize("slope", ["1 +/- 0.99999999", "0 +/- 1"])
def test_a_ball_on_which_the_slope_varies_too_much_is_not_certified(slope):
    with precision(200):
        # Just below the size at which Newton's method ends, 2^-150.
        error = (arb(2) ** -150).union(-(arb(2) ** -150)) * arb("0.8")

        def uncertain(x):
            """x with an error, whose derivative is 1 at a point and uncertain in a ball."""
            at_a_point = x.value.is_exact()
            return Series([x.value + error, arb(1) if at_a_point else arb(slope), arb(0)], 1)

        with pytest.raises(ProofError, match="mapped into its interior"):
            certified_zero(uncertain, 1e-9)


def test_with_a_negative_damping_the_other_multiplier_is_not_inside_the_unit_circle():
    with precision(200):
        wrong = EnclosedContact(arb(10), -damping_of(GIVEN.restitution))
        orbit = point(wrong, 1, arb(0))
        with pytest.raises(ProofError, match="other multiplier"):
            certificates._other_multiplier(wrong, orbit)


def test_a_fold_whose_second_derivative_may_vanish_is_refused():
    found = saddle_node(GIVEN)
    with precision(found.bits):
        wide = found.excess.union(found.excess + arb("0.5"))
        assert Proved.FOLD in certificates.saddle_node_properties(GIVEN.contact(), 1, found.excess)
        with pytest.raises(ProofError):
            certificates.saddle_node_properties(GIVEN.contact(), 1, wide)


@pytest.mark.parametrize(("name", "proof"), TESTS)
def test_a_degenerate_bifurcation_is_refused(monkeypatch, name, proof):
    """The slopes that a genuine bifurcation needs are set to 0 in the last step of the proof."""
    right = getattr(certificates, name)
    found = proof(GIVEN)
    reasons = {"fold_test": "second derivative", "doubling_test": "without crossing"}

    def flat(*given):
        series = right(*given)
        return Series([series.value, *[arb(0)] * (len(series.terms) - 1)], series.order)

    monkeypatch.setattr(certificates, name, flat)
    properties = getattr(certificates, f"{proof.__name__}_properties")
    with precision(found.bits), pytest.raises(ProofError, match=reasons[name]):
        properties(GIVEN.contact(), 1, found.excess)


def test_a_contact_that_has_been_released_earlier_is_noticed():
    found = saddle_node(GIVEN)
    with precision(80):
        contact = GIVEN.contact()
        orbit = found.orbit
        assert certificates.contact_holds(contact, orbit)
        assert not certificates.contact_holds(contact, orbit._replace(duration=orbit.duration * 3))
        # The equations of the orbit hold for the third zero of δ, too.
        third = point(contact, 1, 2 * arb.pi())
        assert not certificates.contact_holds(contact, third)
        with pytest.raises(ProofError):
            certificates.orbit_properties(contact, 1, 2 * arb.pi())


def test_a_contact_is_not_accepted_to_a_release_that_is_too_early():
    """Before its release δ is negative, and does not rise towards 0 at every time."""
    found = saddle_node(GIVEN)
    with precision(80):
        orbit = found.orbit
        early = orbit._replace(duration=orbit.duration / 4)
        assert not certificates.contact_holds(GIVEN.contact(), early)
        # A ball that starts upwards is released at once.
        upwards = orbit._replace(u=arb("1e-3"))
        assert not certificates.contact_holds(GIVEN.contact(), upwards)


def test_a_flight_in_which_the_ball_lands_earlier_is_noticed():
    found = saddle_node(GIVEN)
    with precision(80):
        orbit = found.orbit
        assert certificates.flight_is_free(orbit)
        later = orbit._replace(flight=orbit.flight + 2 * arb.pi())
        assert not certificates.flight_is_free(later)
        sinking = orbit._replace(rate=-orbit.rate)
        assert not certificates.flight_is_free(sinking)


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"restitution": Fraction(1)}, "without dissipation"),
        ({"restitution": Fraction(0)}, "between 0 and 1$"),
        ({"restitution": Fraction(3, 2)}, "between 0 and 1$"),
        ({"n": 0}, "at least 1"),
        ({"frequency_ratio": Fraction(0)}, "above 0"),
    ],
)
def test_what_cannot_be_proved_is_refused_with_the_reason(given, reason):
    with pytest.raises(ProofError, match=reason):
        RationalProblem(
            **({"frequency_ratio": Fraction(10), "restitution": Fraction(1, 2)} | given)
        )


def test_below_the_saddle_node_no_orbit_is_certified():
    with pytest.raises(ProofError, match="no 1-T orbit"):
        certified_orbit(GIVEN, Fraction(1, 10))


def test_before_the_first_admissible_orbit_nothing_is_certified():
    problem = RationalProblem(Fraction(3), Fraction(5, 100), 2)

    def admissible(amplitude):
        return bool(double.orbit_at(problem.approximate(), 2, amplitude).is_admissible())

    # The flight grazes the table at a Λ between these two.
    low, high = 4.5, 4.7
    while high - low > 1e-9:
        middle = (low + high) / 2
        low, high = (low, middle) if admissible(middle) else (middle, high)
    assert admissible(4.7) and not admissible(4.5)
    # Both sides of the first orbit are decided; nearer to it the search for an impact is too long.
    assert Proved.ADMISSIBLE in certified_orbit(problem, Fraction(high + 1e-5)).proved
    with pytest.raises(ProofError, match="may be inadmissible"):
        certified_orbit(problem, Fraction(low - 1e-5))


def test_the_stability_of_an_orbit_is_certified():
    assert Proved.STABLE in certified_orbit(GIVEN, Fraction(1, 2)).proved
    beyond_the_period_doubling = certified_orbit(GIVEN, Fraction(11, 10)).proved
    assert Proved.STABLE not in beyond_the_period_doubling


def test_the_radius_covers_the_rounding_of_the_decimal_number():
    with precision(200):
        for number in (arb(2) / 3, arb("0.1"), arb(10) ** 20 / 7, arb(1) / 4):
            for digits in (1, 3, 10, 30):
                text, radius = decimal_with_bound(number, digits)
                # Both texts are exact fractions; the number is a ball.
                off = abs(rational(Fraction(text)) - number)
                assert off <= rational(Fraction(radius)) + arb(2) ** -120
