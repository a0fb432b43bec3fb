"""The restitution model's orbits as a problem of the continuation."""

import numpy as np
import pytest

from bouncing_ball.continuation.branch import continue_both_ways
from bouncing_ball.continuation.events import fold, parameter_bound
from bouncing_ball.orbits import restitution_orbit as restitution
from bouncing_ball.orbits.restitution_system import RestitutionSystem


@pytest.mark.parametrize(("n", "r"), [(1, 0.85), (3, 0.65)])
def test_bifurcations_are_those_of_the_formula(n, r):
    system = RestitutionSystem(n, r)
    node, doubling = (
        float(find(n, r)) for find in (restitution.saddle_node, restitution.period_doubling)
    )
    start = np.array([0.2, n * np.pi, node / np.cos(0.2)])
    events = (*system.events(), fold(system), parameter_bound(2 * doubling, True, "window"))
    branch = continue_both_ways(system, start, events=events)
    scale = 1 + n * np.pi
    for name, lam in (("saddle-node", node), ("fold", node), ("period doubling", doubling)):
        [found] = branch.named(name)
        phase = float(restitution.phase(n, r, max(lam, node)))
        # Newton's last step of 1e-12, converged quadratically.
        assert found == pytest.approx(np.array([phase, n * np.pi, lam]), abs=1e-12 * scale)


def test_broadcasting():
    system = RestitutionSystem(1, 0.85)
    y = np.array([0.5, np.pi, 0.9]) + np.linspace(0, 0.1, 6).reshape(2, 3, 1)
    assert system.residual(y).shape == (2, 3, 2)
    assert system.jacobian(y).shape == (2, 3, 2, 3)
    assert system.jacobian(y)[1, 0].tolist() == system.jacobian(y[1, 0]).tolist()
