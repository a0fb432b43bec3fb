"""Certified thresholds against double precision, 60 digits, and proofs that must fail."""

from fractions import Fraction

import mpmath
import pytest
from flint import arb
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball_beyond import error_thresholds, rigid
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.proofs import newton
from bouncing_ball_beyond.proofs import thresholds as proofs
from bouncing_ball_beyond.proofs.balls import ProofError, decimal_with_bound, precision
from bouncing_ball_beyond.proofs.branch import Point
from bouncing_ball_beyond.proofs.certificates import Proved
from bouncing_ball_beyond.proofs.newton import certified_box
from bouncing_ball_beyond.proofs.problem import damping_of
from bouncing_ball_beyond.proofs.thresholds import (
    ComparedOrbit,
    height_threshold,
    permanent_contact_threshold,
)

R = Fraction(65, 100)
TOLERANCE = Fraction(1, 100)
COMPARED = ComparedOrbit(R, 1, Fraction(1))


@pytest.fixture(scope="module")
def start():
    """ϖ in double precision; the error there is negative."""
    found = error_thresholds(rigid(restitution=0.65), amplitude=1.0, quantities=["max_height"])
    return float(found.error_threshold.sel(simple="restitution").item())


def test_the_certified_threshold_is_that_of_double_precision(start):
    proof = height_threshold(COMPARED, -TOLERANCE, start)
    with precision(proof.bits):
        text, radius = decimal_with_bound(proof.ball, 30)
    # The search in double precision ends at 1e-9 of ϖ.
    assert abs(float(text) / start - 1) < 1e-9
    assert float(radius) < 1e-28
    assert {Proved.UNIQUE, Proved.FALLS, Proved.ADMISSIBLE} <= {*proof.proved}


def test_the_error_at_the_certified_threshold_is_the_tolerance_in_sixty_digits(start):
    proof = height_threshold(COMPARED, -TOLERANCE, start)
    begin = COMPARED.start(start)
    with mpmath.workdps(60):
        ratio = mpf(proof.ball.mid().str(60, radius=False))
        r = mpf(65) / 100
        zeta = -mp.log(r) / mp.sqrt(mp.pi**2 + mp.log(r) ** 2)
        exact = Exact(SpringDamper(start, damping_ratio(0.65)), 1, ratio, zeta)

        def off(excess):
            _, _, x, y = exact.orbit(excess)
            return x**2 + y**2 - 1

        excess = mp.findroot(off, (begin, begin + mpf(10) ** -12), tol=mpf(10) ** -110)
        _, u, x, y = exact.orbit(excess)
        # The apex of the flight that ends at the height Y with the velocity u + X.
        height = y + (u + x) ** 2 / 2
        # The ball of the restitution model leaves the table, at the phase of Eq. 6, with nπ.
        simple = mp.sin(mp.acos(mp.pi * (1 - r) / (1 + r))) + mp.pi**2 / 2
        assert abs(height / simple - 1 + mpf(1) / 100) < mpf(10) ** -50


def test_with_the_other_sign_of_the_error_nothing_is_certified(start):
    with pytest.raises(ProofError):
        height_threshold(COMPARED, TOLERANCE, start)


def test_a_shifted_start_is_refused(start):
    with pytest.raises(ProofError, match="another solution"):
        height_threshold(COMPARED, -TOLERANCE, 1.01 * start)


def test_a_box_that_is_too_wide_is_not_certified(monkeypatch, start):
    monkeypatch.setattr(newton, "_WIDER", (2**300,))
    with pytest.raises(ProofError, match="mapped into its interior"):
        height_threshold(COMPARED, -TOLERANCE, start)


def test_two_equations_that_touch_are_not_certified():
    def tangent(box):
        x, y = (proofs.Series.variable(value, k, 1) for k, value in enumerate(box))
        return y - x * x, y

    with precision(200), pytest.raises(ProofError):
        certified_box(tangent, [1e-9, 1e-9])


def test_an_error_whose_modulus_does_not_fall_with_the_frequency_ratio_is_refused():
    """Along orbits that do not depend on ϖ the slope of the error is its derivative by ϖ."""
    orbit = proofs.Series([arb(0), arb(1), arb(0)], 1)

    def require(slope, value):
        proofs._require_falling(orbit, proofs.Series([arb(0), arb(0), arb(slope)], 1), value)

    require("1", -TOLERANCE)
    require("-1", TOLERANCE)
    for slope, value in (("-1", -TOLERANCE), ("1", TOLERANCE), ("1 +/- 2", -TOLERANCE)):
        with pytest.raises(ProofError, match="fall with rising"):
            require(slope, value)


def test_the_apex_must_lie_in_the_flight_and_above_the_table():
    numbers = dict.fromkeys(Point._fields, arb(0)) | {"flight": arb(6), "x": arb(0), "y": arb(1)}
    good = Point(**numbers | {"u": arb(-3)})
    proofs._require_apex(good)
    for wrong in (
        good._replace(u=arb(-7)),  # it never rises
        good._replace(u=arb(1)),  # it rises until it lands
        good._replace(x=arb(3), u=arb(-6), y=arb(-40)),  # below the table's largest height
    ):
        with pytest.raises(ProofError, match="apex"):
            proofs._require_apex(wrong)


@pytest.mark.parametrize("name", ["_require_apex", "_require_falling"])
def test_a_threshold_needs_its_apex_and_an_error_that_falls(monkeypatch, start, name):
    def refuse(*_):
        raise ProofError("not this one")

    monkeypatch.setattr(proofs, name, refuse)
    with pytest.raises(ProofError, match="not this one"):
        height_threshold(COMPARED, -TOLERANCE, start)


def test_the_threshold_of_permanent_contact():
    threshold = permanent_contact_threshold(R, TOLERANCE)
    with precision(threshold.bits):
        text, _ = decimal_with_bound(threshold.ball, 20)
        t = 1 / threshold.ball**2
        zeta = damping_of(R)
        # Eq. 33 at this ϖ gives 0.99.
        assert (1 - 2 * (1 - 2 * zeta**2) * t + t * t).overlaps((1 - arb(1) / 100) ** 2)
    assert text.startswith("9.8117")


# At r = 0.017 ζ = 0.79, and Λ_SD has no minimum at a finite ϖ.
@pytest.mark.parametrize(
    ("restitution", "tolerance"), [(R, Fraction(9, 10)), (Fraction(17, 1000), TOLERANCE)]
)
def test_permanent_contact_without_a_threshold_is_refused(restitution, tolerance):
    with pytest.raises(ProofError, match="so far below 1"):
        permanent_contact_threshold(restitution, tolerance)
