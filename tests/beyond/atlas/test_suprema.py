"""Suprema against closed forms, random orbits, and another maximiser."""

from functools import partial

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from bouncing_ball.beyond.atlas.summary import largest, suprema, tolerated
from bouncing_ball.beyond.corrected.errors import SIMPLE, errors
from bouncing_ball.paper.comparison.errors import Quantity


def error(plan, row, r, place, kind, ratio=100.0):
    nodes = plan.placed(row, np.asarray(r), np.asarray(place))
    model, quantity = kind
    every = errors(nodes.contact(ratio), nodes.n, nodes.amplitude, [quantity])
    return np.abs(every[SIMPLE.index(model), 0])


def test_the_suprema_with_a_closed_form_have_its_values(small):
    plan = small()
    span = (0.05, 1 - 1e-9)
    # Λ_SD = 1 - 1/ϖ² without damping; damping brings it closer to 1 while ζ² < 1/2.
    still = partial(largest, plan, 0, ("restitution", Quantity.PERMANENT_CONTACT))
    assert still(100.0, *span) == pytest.approx(1e-4, rel=1e-6)
    # The phase of the restitution model is 0 at the saddle-node.
    assert np.isinf(largest(plan, 0, ("restitution", Quantity.PHASE), 100.0, *span))


def test_below_the_failing_restitution_the_height_exceeds_the_tolerance(small):
    # At ϖ = 100 and the saddle-node; recomputed with Newton's method on Eqs. 21-26.
    plan = small()
    at = partial(largest, plan, 0, ("restitution", Quantity.MAX_HEIGHT), 100.0)
    assert tolerated(at, np.linspace(0.05, 0.95, 10), 0.01) == pytest.approx(0.54964, abs=5e-6)


@pytest.mark.parametrize("model", SIMPLE)
@pytest.mark.parametrize("quantity", [Quantity.MAX_HEIGHT, Quantity.APPARENT_RESTITUTION])
def test_no_orbit_exceeds_the_largest_error(small, model, quantity):
    plan = small()
    rng = np.random.default_rng(3)
    kind = (model, quantity)
    span = (0.05, 0.95)
    found = largest(plan, 0, kind, 100.0, *span)
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
    found = largest(plan, row, kind, 100.0, 0.2, 0.9)
    assert 0.3 < other.x < 0.8 and found == pytest.approx(-other.fun, rel=1e-6)


def test_crossings_are_looked_for_from_the_first_ratio_on(small, monkeypatch):
    plan = small()
    first, second = plan.ratios[:2]
    middle = (first * second) ** 0.5
    monkeypatch.setattr(
        "bouncing_ball.beyond.atlas.summary.largest",
        lambda _, row, kind, ratio, *span, **more: middle / ratio,
    )
    dims, needed = suprema(plan, 100.0, 1.0)["supremum_needed"][:2]
    assert "n" in dims and np.allclose(needed, middle, rtol=1e-9)
