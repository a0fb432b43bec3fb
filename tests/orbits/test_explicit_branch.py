"""A whole branch from the formula, with every bifurcation."""

import numpy as np
import pytest

from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.spring_damper import Contact, Release
from bouncing_ball.orbits.closed_form import branch_point
from bouncing_ball.orbits.explicit_branch import explicit_branch
from bouncing_ball.orbits.limits import period_doubling, saddle_node


@pytest.mark.parametrize("release", list(Release))
@pytest.mark.parametrize(("n", "omega", "r"), [(1, 1e4, 0.85), (2, 10.0, 0.65)])
def test_same_bifurcations_as_the_scalar_searches(n, omega, r, release):
    contact = Contact(omega, float(damping_ratio(r)), release)
    node, doubling = float(saddle_node(contact, n)), float(period_doubling(contact, n))
    width = node - doubling
    branch = explicit_branch(contact, n, doubling - width, node + width)
    # Two methods for the root of one function, both to its last digits: where
    # the function is flat its rounding moves the root by some eps · scale.
    assert branch.saddle_nodes == pytest.approx([node], abs=1e-13 * (1 + abs(node) + 1 / omega))
    assert branch.period_doublings == pytest.approx([doubling], abs=1e-13 * (1 + 1 / omega))
    assert branch.excess[[0, -1]] == pytest.approx([doubling - width, node + width], rel=1e-15)
    expected = branch_point(branch.excess, contact, n)
    for ours, theirs in zip(branch.points, expected, strict=True):
        assert ours == pytest.approx(theirs, rel=1e-14, abs=1e-14)


def test_every_bifurcation_of_a_soft_contact():
    # Figure 8, ϖ = 2: two saddle-nodes and three period doublings, the ones the
    # continuation finds (tests of the studies), here by counting sign changes
    # on a fine grid.
    contact = Contact(2.0, float(damping_ratio(0.85)))
    branch = explicit_branch(contact, 1, -2.0, 9.0)
    amplitudes = [
        np.sort(branch_point(roots, contact, 1).amplitude)
        for roots in (branch.saddle_nodes, branch.period_doublings)
    ]
    assert amplitudes[0] == pytest.approx([0.187698, 1.176325], abs=1e-6)
    assert amplitudes[1] == pytest.approx([1.087096, 1.095529, 1.162527], abs=1e-6)
    fine = branch_point(np.linspace(-2.0, 9.0, 20001), contact, 1)
    assert np.count_nonzero(np.diff(np.sign(fine.fold))) == 2
    assert np.count_nonzero(np.diff(np.sign(1 + fine.trace + fine.determinant))) == 3


def test_a_range_without_bifurcations():
    contact = Contact(10.0, 0.05)
    node = float(saddle_node(contact, 1))
    branch = explicit_branch(contact, 1, node + 0.01, node + 0.02, points=11)
    assert branch.points.amplitude.shape == (11,)
    assert branch.saddle_nodes.size == branch.period_doublings.size == 0
