"""The walks against the root finding of the bifurcations of the spring-damper model."""

import numpy as np
import pytest

from bouncing_ball.beyond.atlas.walk import REACHED, extrapolated_values, stiff_start, walk
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.periodic.one_impact import spring_damper_bifurcations as bifurcations
from bouncing_ball.periodic.one_impact.spring_damper_branch import branch_point

COMPARED = [3.0, 10.0, 100.0, 1e4]


def rows(plan, count):
    random = np.random.default_rng(5)
    return random.choice(plan.rows, count, replace=False)


def test_the_walk_gives_the_orbits_that_root_finding_gives(small, every_node):
    plan = small(examined=COMPARED)
    for row in rows(plan, 4):
        nodes = every_node(plan, row)
        for step in walk(nodes, plan.ratios):
            off = np.abs(step.orbit.amplitude / nodes.amplitude - 1)
            assert np.all((off <= REACHED) | np.isnan(off))
            for k in np.nonzero(np.isin(step.frequency_ratio, COMPARED))[0]:
                orbit = step.orbit[k]
                contact = nodes.contact(step.frequency_ratio[k])
                # At the Λ where the walk is, so that both have the same orbit.
                lam = np.where(np.isnan(off[k]), nodes.amplitude, orbit.amplitude)
                found = bifurcations.orbit_at(contact, nodes.n, lam)
                assert np.array_equal(found.exists, orbit.exists)
                # The phase turns by a root of Λ next to the saddle-node.
                assert np.nanmax(orbit.distance(found)) < 1e-8
                assert np.array_equal(found.is_stable(), step.stable[k])


def test_what_the_walk_loses_is_looked_for(small, every_node, monkeypatch):
    plan = small(examined=COMPARED)
    nodes = every_node(plan, plan.rows[0])
    few = plan.ratios[-3:]
    (expected,) = walk(nodes, few)
    # As if the walk reached nothing.
    monkeypatch.setattr("bouncing_ball.beyond.atlas.walk.REACHED", -1.0)
    (step,) = walk(nodes, few)
    assert np.all(step.sought) and not np.any(expected.sought)
    assert np.max(step.orbit.distance(expected.orbit)) < 1e-8


def test_an_orbit_that_is_not_at_its_node_to_six_digits_is_lost(small, every_node, monkeypatch):
    # An extrapolation so bad that one correction leaves some orbits farther off, and others not.
    monkeypatch.setattr(
        "bouncing_ball.beyond.atlas.walk.extrapolated_values",
        lambda *x: 0.8 * extrapolated_values(*x),
    )
    plan = small()
    for row in rows(plan, 4):
        nodes = every_node(plan, row)
        steps = list(walk(nodes, plan.ratios))
        off = [np.max(np.abs(step.orbit.amplitude / nodes.amplitude - 1)) for step in steps]
        assert max(off) <= 1e-6
        assert any(np.any(step.sought) for step in steps)


@pytest.mark.parametrize("ratio", [1e5, 1e7])
def test_the_start_is_the_limit_of_stiff_contacts(small, every_node, ratio):
    plan = small()
    for row in rows(plan, 4):
        nodes = every_node(plan, row)
        point = branch_point(stiff_start(nodes) / ratio, nodes.contact(ratio), nodes.n)
        expected = n_t.orbit(RestitutionModel(nodes.restitution), nodes.n, nodes.amplitude)
        lift = expected.amplitude * np.sin(expected.phase)
        # Of the order of 1/ϖ, with the load over the speed of the ball that leaves.
        assert np.max(np.abs(point.y - lift)) < 200 / ratio
