"""The closed form, continuation and simulation have the same orbits."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.simulation import next_impact
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.continuation import PaperEquations
from bouncing_ball_beyond.inherited.periodic.explicit import Absence, absence
from bouncing_ball_beyond.inherited.periodic.orbit import Side, monodromy
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import SpringDamperBranch

# For each of two rules and two sides.
SIZES = [500, pytest.param(25_000, marks=pytest.mark.long)]


@pytest.fixture(scope="module", params=SIZES)
def size(request):
    return request.param


@pytest.fixture(scope="module", params=[(rule, side) for rule in Release for side in Side])
def drawn(request, size):
    """Random contacts, families and amplitudes around the existence of the orbits."""
    rule, side = request.param
    rng = np.random.default_rng([list(Release).index(rule), list(Side).index(side)])
    r = rng.uniform(0.05, 0.999, size)
    n = rng.integers(1, 6, size)
    contact = SpringDamper(10 ** rng.uniform(0.0, 5.0, size), damping_ratio(r), rule)
    fold = restitution_saddle_node(n, r)
    # From half the saddle-node to well beyond the period doubling.
    doubling = np.hypot(2 * (1 + r * r) / (1 + r) ** 2, fold)
    lam = fold / 2 + rng.uniform(0.0, 1.0, size) * (1.5 * doubling - fold / 2)
    branch = SpringDamperBranch(contact)
    return branch, n, lam, side, branch.orbit(n, lam, side)


def test_every_missing_orbit_has_its_reason(drawn):
    branch, n, lam, side, orbit = drawn
    reasons = absence(branch, n, lam, side)
    assert np.array_equal(reasons == Absence.NONE, orbit.exists)
    # The sample reaches below the saddle-nodes, and most of it lies above.
    assert np.mean(reasons == Absence.BELOW_SADDLE_NODE) > 1 / 50
    assert np.mean(orbit.exists) > 1 / 2


def test_the_simulation_returns_to_every_admissible_orbit(drawn):
    *_, every = drawn
    orbit = every[np.flatnonzero(every.admissible)]
    assert orbit.size > every.size / 4
    closing = orbit.relative_impact_velocity
    leg = next_impact(orbit.model, orbit.phase, closing, orbit.amplitude)
    turn = np.angle(np.exp(1j * (leg.phase - orbit.phase)))
    late = leg.time - 2 * np.pi * orbit.n
    off = np.max(np.abs([turn, late, leg.velocity - closing]), axis=0)
    # Rounding of the start, amplified by one cycle.
    amplification = 1 + np.linalg.norm(monodromy(orbit), axis=(-2, -1))
    size = 1 + np.abs(closing) + np.abs(orbit.phase) + 2 * np.pi * orbit.n
    assert np.max(off / (amplification * size)) < 1e-13


def test_the_orbits_solve_the_equations_that_the_continuation_solves(drawn):
    *_, every = drawn
    # The paper's constants lose their digits at the resonance.
    orbit = every[np.flatnonzero(every.exists & (every.model.frequency_ratio > 1.2))]
    system = PaperEquations(orbit.model, orbit.n)
    defect = np.abs(system.residual(system.point(orbit))).max(axis=-1)
    size = (1 + np.abs(orbit.impact_velocity) + orbit.amplitude) * 2 * np.pi * orbit.n
    assert np.max(defect / size) < 1e-12
