"""Suprema against closed forms, random orbits, and another maximiser."""

from functools import partial

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.accuracy.simple_models import SIMPLE, errors, exact_and_simple_models
from bouncing_ball.beyond.atlas.summary import (
    Largest,
    in_common_range,
    largest_error,
    suprema,
    tolerated,
)
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.periodic.one_impact import restitution_branch as restitution_orbit


def error(plan, row, r, place, kind, ratio=100.0):
    model, quantity = kind
    nodes = in_common_range(plan, row, model, ratio, np.asarray(r), np.asarray(place))
    every = errors(nodes.contact(ratio), nodes.n, nodes.amplitude, [quantity])
    return np.abs(every[SIMPLE.index(model), 0])


def test_the_suprema_with_a_closed_form_have_its_values(small):
    plan = small()
    span = (0.05, 1 - 1e-9)
    # Λ_SD = 1 - 1/ϖ² without damping; damping brings it closer to 1 while ζ² < 1/2.
    still = partial(largest_error, plan, 0, ("restitution", Quantity.PERMANENT_CONTACT))
    assert still(100.0, *span).error == pytest.approx(1e-4, rel=1e-6)


@pytest.mark.parametrize("model", SIMPLE)
@pytest.mark.parametrize("ratio", [30.0, 3000.0])
def test_the_relative_error_of_the_phase_is_unbounded(small, model, ratio):
    # The phase of the restitution model is 0 at the saddle-node. That of the corrected model is
    # negative there, and positive at the period doubling.
    for row in (0, small().rows[-1]):
        assert np.isinf(largest_error(small(), row, (model, Quantity.PHASE), ratio, 0.2, 0.9).error)


@pytest.mark.parametrize(("ratio", "expected"), [(27.0, 0.055), (100.0, 0.0147)])
def test_the_corrected_model_is_judged_below_the_saddle_node_of_the_restitution_model(
    small, ratio, expected
):
    """A referee's errors of the greatest height at r = 0.05, found with other programs."""
    found = largest_error(small(), 0, ("corrected", Quantity.MAX_HEIGHT), ratio, 0.05)
    assert found.error == pytest.approx(expected, rel=0.01)
    assert found.restitution == 0.05 and found.position < 1e-11
    contact = SpringDamper(ratio, float(damping_ratio(0.05)))
    exact, rigid, corrected = exact_and_simple_models(contact)
    higher = max(float(n_t.saddle_node(one, 1).amplitude) for one in (exact, corrected))
    assert higher < n_t.saddle_node(rigid, 1).amplitude
    # A grid over the whole range, from just above the higher saddle-node on.
    top = float(restitution_orbit.period_doubling(1, 0.05))
    lam = higher * (1 + 1e-12) + np.linspace(0, 1, 101) ** 2 * (top - higher)
    each = np.abs(errors(contact, 1, lam, [Quantity.MAX_HEIGHT])[1, 0])
    assert found.error == pytest.approx(each.max(), rel=1e-4)


def test_below_the_failing_restitution_the_height_exceeds_the_tolerance(small):
    # At ϖ = 100 and the saddle-node; recomputed with Newton's method on Eqs. 21-26.
    plan = small()
    at = partial(largest_error, plan, 0, ("restitution", Quantity.MAX_HEIGHT), 100.0)
    assert tolerated(lambda r: at(r).error, np.linspace(0.05, 0.95, 10), 0.01) == pytest.approx(
        0.54964, abs=5e-6
    )


@pytest.mark.parametrize("model", SIMPLE)
@pytest.mark.parametrize("quantity", [Quantity.MAX_HEIGHT, Quantity.APPARENT_RESTITUTION])
def test_no_orbit_exceeds_the_largest_error(small, model, quantity):
    plan = small()
    rng = np.random.default_rng(3)
    kind = (model, quantity)
    span = (0.05, 0.95)
    found = largest_error(plan, 0, kind, 100.0, *span).error
    r = rng.uniform(*span, 300)
    place = rng.uniform(0, 1, 300) ** 2
    assert np.all(error(plan, 0, r, place, kind) < found)
    # It is reached in a corner.
    corners = error(plan, 0, [0.05, 0.05, 0.95, 0.95], [1e-12, 1, 1e-12, 1], kind)
    assert found == corners.max()


def test_a_maximum_inside_is_found(small):
    # With the force release the velocity's error is largest at the saddle-node of a middle r.
    plan = small()
    row = plan.rows[-1]
    kind = ("restitution", Quantity.BOUNCE_VELOCITY)
    other = minimize_scalar(
        lambda r: -float(error(plan, row, r, 1e-12, kind)), bounds=(0.2, 0.9), method="bounded"
    )
    found = largest_error(plan, row, kind, 100.0, 0.2, 0.9)
    assert 0.3 < other.x < 0.8 and found.error == pytest.approx(-other.fun, rel=1e-6)
    assert found.restitution == pytest.approx(other.x, abs=1e-3)


def test_crossings_are_looked_for_from_the_first_ratio_on(small, monkeypatch):
    plan = small()
    first, second = plan.ratios[:2]
    middle = (first * second) ** 0.5
    monkeypatch.setattr(
        "bouncing_ball.beyond.atlas.summary.largest_error",
        lambda _, row, kind, ratio, *span, **more: Largest(middle / ratio, 0.25, 0.5),
    )
    found = suprema(plan, 100.0, 1.0)
    assert np.all(found["needed_restitution"][1] == 0.25)
    dims, needed = found["supremum_needed"]
    assert "n" in dims and np.allclose(needed, middle, rtol=1e-9)
