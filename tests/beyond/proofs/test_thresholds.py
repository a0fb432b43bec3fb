"""Certified thresholds against those of double precision, and their closed forms."""

from fractions import Fraction

import numpy as np
import pytest

from bouncing_ball.beyond.corrected.errors import search
from bouncing_ball.beyond.proofs.certificates import Problem, ProofError, decimal, precision
from bouncing_ball.beyond.proofs.thresholds import (
    CONDITIONS,
    error_threshold,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.paper.contact.damping import Release, damping_ratio

R = Fraction(65, 100)
TOLERANCE = Fraction(1, 100)


@pytest.fixture(scope="module")
def approximate():
    grid = np.geomspace(1.0, 1e4, 101)
    zeta = damping_ratio(0.65)
    found = search(
        zeta,
        Release.DISPLACEMENT,
        n=1,
        amplitude=1.0,
        ratios=grid,
        tolerance=0.01,
        quantities=list(CONDITIONS),
    )
    return dict(zip(CONDITIONS, found.threshold[0, :, 0], strict=True))


@pytest.mark.parametrize("quantity", CONDITIONS)
def test_the_certified_threshold_is_that_of_double_precision(approximate, quantity):
    sign = 1 if quantity == "apparent_restitution" else -1
    start = float(approximate[quantity])
    found = error_threshold(quantity, R, 1, Fraction(1), sign * TOLERANCE, start)
    with precision(found.bits):
        text, radius = decimal(found.frequency_ratio, 30)
    # The search in double precision ends at 1e-9 of ϖ, and balls at 2e-28 for the flattest error.
    assert abs(float(text) / start - 1) < 1e-9
    assert float(radius) < 1e-27


def test_with_the_other_sign_of_the_error_nothing_is_certified(approximate):
    with pytest.raises(ProofError):
        error_threshold("max_height", R, 1, Fraction(1), TOLERANCE, approximate["max_height"])


def test_the_threshold_of_permanent_contact_and_the_minimum_of_figure_11():
    found = permanent_contact_threshold(R, TOLERANCE)
    with precision(found.bits):
        text, _ = decimal(found.frequency_ratio, 20)
    assert text.startswith("9.8117")
    least = permanent_contact_minimum(Problem(Fraction(10), restitution=R))
    zeta = float(damping_ratio(0.65))
    assert abs(float(least.mid()) - 2 * zeta * np.sqrt(1 - zeta**2)) < 1e-15
