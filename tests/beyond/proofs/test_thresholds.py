"""Certified thresholds against double precision, 60 digits, and proofs that must fail."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from flint import arb
from mpmath import mp, mpf
from sixty_digits import Exact

from bouncing_ball.accuracy.simple_models import errors, search
from bouncing_ball.beyond.proofs import newton
from bouncing_ball.beyond.proofs import thresholds as proofs
from bouncing_ball.beyond.proofs.balls import ProofError, decimal_with_bound, precision
from bouncing_ball.beyond.proofs.branch import EnclosedContact, Point
from bouncing_ball.beyond.proofs.certificates import Proved
from bouncing_ball.beyond.proofs.newton import certified_box
from bouncing_ball.beyond.proofs.problem import damping_of
from bouncing_ball.beyond.proofs.simple_models import SimpleModel
from bouncing_ball.beyond.proofs.thresholds import (
    MEASURED,
    Comparison,
    error_threshold,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper

R = Fraction(65, 100)
ZETA = damping_ratio(0.65)
TOLERANCE = Fraction(1, 100)
MODELS = (False, True)


def compared(quantity, corrected=False):
    return Comparison(quantity, R, 1, Fraction(1), corrected)


@pytest.fixture(scope="module")
def found():
    """ϖ in double precision by (quantity, corrected), and the zeros of the error."""
    result = search(
        ZETA,
        Release.DISPLACEMENT,
        n=1,
        amplitude=1.0,
        ratios=np.geomspace(1.0, 1e4, 101),
        tolerance=0.01,
        quantities=list(MEASURED),
    )
    ratios = {
        (quantity, corrected): float(result.threshold[int(corrected), k, 0])
        for k, quantity in enumerate(MEASURED)
        for corrected in MODELS
    }
    return ratios, dict(zip(MEASURED, result.zero[0, :, 0], strict=True))


def signed(quantity, corrected, ratio):
    """The tolerance with the sign that the error has in double precision."""
    contact = SpringDamper(ratio, ZETA, Release.DISPLACEMENT)
    return TOLERANCE * int(np.sign(errors(contact, 1, 1.0, [quantity])[int(corrected), 0]))


@pytest.mark.parametrize("corrected", MODELS)
@pytest.mark.parametrize("quantity", MEASURED)
def test_the_certified_threshold_is_that_of_double_precision(found, quantity, corrected):
    start = found[0][quantity, corrected]
    proof = error_threshold(
        compared(quantity, corrected), signed(quantity, corrected, start), start
    )
    with precision(proof.bits):
        text, radius = decimal_with_bound(proof.ball, 30)
    # The search in double precision ends at 1e-9 of ϖ, and balls at 2e-28 for the flattest error.
    assert abs(float(text) / start - 1) < 1e-9
    assert float(radius) < 2e-28
    assert {Proved.UNIQUE, Proved.FALLS, Proved.ADMISSIBLE} <= {*proof.proved}


@pytest.mark.parametrize("quantity", ["apparent_restitution", "period_doubling"])
def test_the_zeros_of_the_error_are_certified(found, quantity):
    start = float(found[1][quantity])
    proof = error_threshold(compared(quantity), Fraction(0), start)
    assert abs(float(proof.ball.mid()) / start - 1) < 1e-9
    assert Proved.SIGN in proof.proved


def simple_in_sixty_digits(corrected, ratio, r, zeta):
    """The quantities of a simple model at Λ = 1 from its impact and flight, by Newton's method."""
    n_pi = mp.pi
    duration = mp.pi / (ratio * mp.sqrt(1 - zeta**2)) if corrected else mpf(0)
    delay = r * duration / (1 + r)
    load = (1 - r) * duration - 2 * zeta * (1 + r) / ratio if corrected else mpf(0)

    def balance(psi):
        # The velocity after the impact is that before the next one, with the other sign.
        x = mp.cos(psi)
        y = mp.sin(psi)
        return x + r * (n_pi + x) + load * (1 - y) - n_pi

    psi = mp.findroot(balance, mp.acos(n_pi * (1 - r) / (1 + r)), tol=mpf(10) ** -110)
    x = mp.cos(psi)
    y = mp.sin(psi)
    phase = psi - delay
    impact = -n_pi + delay - mp.cos(phase)
    release = n_pi - (duration - delay) - mp.cos(phase + duration)
    return {
        "max_height": y - (n_pi + x) * delay + n_pi**2 / 2,
        "bounce_velocity": n_pi - (duration - delay),
        "phase": phase,
        "apparent_restitution": -release / impact,
    }


@pytest.mark.parametrize("corrected", MODELS)
@pytest.mark.parametrize("quantity", list(MEASURED)[:4])
def test_the_error_at_the_certified_threshold_is_the_tolerance_in_sixty_digits(
    found, quantity, corrected
):
    start = found[0][quantity, corrected]
    error = signed(quantity, corrected, start)
    proof = error_threshold(compared(quantity, corrected), error, start)
    begin = compared(quantity, corrected).start(start)
    with mpmath.workdps(60):
        ratio = mpf(proof.ball.mid().str(60, radius=False))
        r = mpf(65) / 100
        zeta = -mp.log(r) / mp.sqrt(mp.pi**2 + mp.log(r) ** 2)
        contact = SpringDamper(start, ZETA, Release.DISPLACEMENT)
        exact = Exact(contact, 1, ratio, zeta)

        def off(excess):
            _, _, x, y = exact.orbit(excess)
            return x**2 + y**2 - 1

        excess = mp.findroot(off, (begin, begin + mpf(10) ** -12), tol=mpf(10) ** -110)
        duration, u, x, y = exact.orbit(excess)
        flight = 2 * mp.pi - duration
        bounce = u + x + flight
        _, rate = exact.state(duration, u, x, y)
        of_contact = {
            # The apex of the flight that ends at the height Y with the velocity u + X.
            "max_height": y + (u + x) ** 2 / 2,
            "bounce_velocity": bounce,
            "phase": mp.atan2(y, x),
            "apparent_restitution": -rate / u,
        }
        simple = simple_in_sixty_digits(corrected, ratio, r, zeta)[quantity]
        measured = of_contact[quantity] / simple - 1
        assert abs(measured - mpf(error.numerator) / error.denominator) < mpf(10) ** -50


@pytest.mark.parametrize("corrected", MODELS)
def test_with_the_other_sign_of_the_error_nothing_is_certified(found, corrected):
    start = found[0]["max_height", corrected]
    with pytest.raises(ProofError):
        error_threshold(compared("max_height", corrected), TOLERANCE, start)


def test_a_shifted_start_is_refused(found):
    start = found[0]["max_height", False]
    with pytest.raises(ProofError, match="another solution"):
        error_threshold(compared("max_height"), -TOLERANCE, 1.01 * start)


def test_a_box_that_is_too_wide_is_not_certified(monkeypatch, found):
    monkeypatch.setattr(newton, "_WIDER", (2**300,))
    with pytest.raises(ProofError, match="mapped into its interior"):
        error_threshold(compared("phase"), -TOLERANCE, found[0]["phase", False])


def test_two_equations_that_touch_are_not_certified():
    def tangent(box):
        x, y = (proofs.Series.variable(value, k, 1) for k, value in enumerate(box))
        return y - x * x, y

    with precision(200), pytest.raises(ProofError):
        certified_box(tangent, [1e-9, 1e-9])


def test_a_wrong_sign_in_the_measured_quantity_is_refused(monkeypatch, found):
    wrong = MEASURED | {"apparent_restitution": lambda orbit: orbit.rate / orbit.u}
    monkeypatch.setattr(proofs, "MEASURED", wrong)
    start = found[0]["apparent_restitution", False]
    with pytest.raises(ProofError):
        error_threshold(compared("apparent_restitution"), TOLERANCE, start)


def test_an_error_that_grows_with_the_frequency_ratio_is_refused():
    """The error of r_a grows to a maximum above its zero, and falls from there."""
    ratio = 11.0
    contact = SpringDamper(ratio, ZETA, Release.DISPLACEMENT)
    error = float(errors(contact, 1, 1.0, ["apparent_restitution"])[0, 0])
    with pytest.raises(ProofError, match="fall with rising"):
        error_threshold(compared("apparent_restitution"), Fraction(error), ratio)


def test_a_zero_of_the_error_that_may_be_a_tangency_is_refused():
    orbit = proofs.Series([arb(0), arb(1), arb(0)], 1)
    error = proofs.Series([arb(0), arb(0), arb("1 +/- 2")], 1)
    with pytest.raises(ProofError, match="fall with rising"):
        proofs._crossing(orbit, error, Fraction(0))


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


def test_a_threshold_of_the_height_needs_its_apex(monkeypatch, found):
    def refuse(orbit):
        raise ProofError("no apex")

    monkeypatch.setattr(proofs, "_require_apex", refuse)
    start = found[0]["max_height", False]
    with pytest.raises(ProofError, match="no apex"):
        error_threshold(compared("max_height"), -TOLERANCE, start)


def test_the_corrected_model_without_delay_and_load_is_the_restitution_model():
    with precision(200):
        zeta = damping_of(R)
        stiff = EnclosedContact(arb(10) ** 40, zeta, arb(0))
        r = arb(65) / 100
        simple = SimpleModel.restitution_model(stiff, r, 2)
        limit = SimpleModel.corrected(stiff, r, 2)
        for name in MEASURED:
            pair = [getattr(model, name)(arb(2)) for model in (simple, limit)]
            assert abs(pair[0] - pair[1]) < 1e-38
        fold = 2 * arb.pi() * (1 - r) / (1 + r)
        assert simple.saddle_node(arb(2)).overlaps(fold)
        # Eq. 8 with the exact map, and the fixed point of Eq. 6.
        doubling = ((2 * (1 + r * r) / (1 + r) ** 2) ** 2 + fold * fold).sqrt()
        assert simple.period_doubling(arb(2)).overlaps(doubling)
        assert simple.phase(arb(2)).overlaps((fold / 2).acos())
        assert simple.apparent_restitution(arb(2)).overlaps(r)


def test_the_threshold_of_permanent_contact_and_the_minimum_of_figure_11():
    threshold = permanent_contact_threshold(R, TOLERANCE)
    with precision(threshold.bits):
        text, _ = decimal_with_bound(threshold.ball, 20)
        t = 1 / threshold.ball**2
        zeta = damping_of(R)
        # Eq. 33 at this ϖ gives 0.99.
        assert (1 - 2 * (1 - 2 * zeta**2) * t + t * t).overlaps((1 - arb(1) / 100) ** 2)
    assert text.startswith("9.8117")
    least = permanent_contact_minimum(R)
    zeta = float(ZETA)
    assert abs(float(least.ball.mid()) - 2 * zeta * np.sqrt(1 - zeta**2)) < 1e-15


def test_permanent_contact_without_a_threshold_or_a_minimum_is_refused():
    with pytest.raises(ProofError, match="so far below 1"):
        permanent_contact_threshold(R, Fraction(9, 10))
    # ζ = 0.79 at r = 0.017.
    with pytest.raises(ProofError, match="no minimum"):
        permanent_contact_minimum(Fraction(17, 1000))
