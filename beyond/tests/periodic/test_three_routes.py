"""Formula, Newton's method and simulation on 10⁵ random parameter sets."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics.corrector import NewtonSettings, newton, plane
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.n_t import Absence
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at

EPS = np.finfo(float).eps
# For each of two rules and two sides.
SIZES = [1_000, pytest.param(25_000, marks=pytest.mark.long)]


def sample(seed, size):
    """Random contacts, families and amplitudes around the existence of the orbits."""
    rng = np.random.default_rng(seed)
    r = rng.uniform(0.05, 0.999, size)
    n = rng.integers(1, 6, size)
    omega = 10 ** rng.uniform(0.0, 5.0, size)
    fold = restitution_saddle_node(n, r)
    doubling = restitution_period_doubling(n, r)
    # From half the saddle-node to well beyond the period doubling.
    amplitude = fold / 2 + rng.uniform(0.0, 1.0, size) * (1.5 * doubling - fold / 2)
    return damping_ratio(r), n, omega, amplitude


@pytest.fixture(scope="module", params=LINEAR)
def rule(request):
    return request.param


@pytest.fixture(scope="module", params=Side)
def side(request):
    return request.param


@pytest.fixture(scope="module", params=SIZES)
def drawn(request, rule, side):
    seed = [LINEAR.index(rule), list(Side).index(side)]
    zeta, n, omega, lam = sample(seed, request.param)
    contact = SpringDamper(omega, zeta, rule)
    return contact, n, lam, side, orbit_at(contact, n, lam, side)


def test_every_missing_orbit_has_its_reason(drawn):
    contact, n, lam, side, orbit = drawn
    missing = np.isnan(orbit.contact_duration)
    reasons = n_t.absence(ContactModel(contact), n, lam, side)
    assert np.all((reasons == Absence.NONE) == ~missing)
    # The sample reaches below the saddle-nodes, and most of it lies above.
    assert np.mean(reasons == Absence.BELOW_SADDLE_NODE) > 1 / 50
    assert np.mean(~missing) > 1 / 2


def test_newtons_method_on_the_full_system_returns_to_the_branch(drawn):
    every = drawn[-1]
    orbit = every[every.exists]
    system = PaperUnknowns.of(orbit)
    y = system.point(orbit)
    # Off the branch by a thousandth, back onto it in the plane across it: at a
    # fixed Λ the fold would amplify rounding to its square root.
    normal = np.linalg.svd(system.jacobian(y))[2][..., -1, :]
    rng = np.random.default_rng(0)
    guess = y + 1e-3 * rng.uniform(-1, 1, y.shape) * np.minimum(1, np.abs(y))
    found = newton(system, guess, plane(normal, y), NewtonSettings(max_iterations=20))
    # The formula's own error, a few 1e-15 of quantities up to 1e2, over the
    # smallest pivot of the system.
    scale = 1 + np.abs(y)
    returns = found.converged & (np.max(np.abs(found.point - y) / scale, axis=-1) < 1e-11)
    # A release without speed is a double zero, whose time keeps half the digits and has no slope.
    slow = np.abs(orbit.relative_bounce_velocity) < 10 * np.sqrt(EPS)
    assert np.all(returns | slow) and np.mean(returns) > 0.9999


def test_the_simulation_returns_to_every_admissible_orbit(drawn):
    every = drawn[-1]
    orbit = every[every.is_admissible()]
    assert orbit.size > every.size / 4
    u = orbit.relative_impact_velocity
    cycle = orbit.model.cycle(orbit.amplitude, orbit.phase, u)
    turn = np.angle(np.exp(1j * (cycle.phase - orbit.phase)))
    late = cycle.time - 2 * np.pi * orbit.n
    off = np.max(np.abs([turn, late, (cycle.relative_velocity - u)]), axis=0)
    # Rounding of the start, amplified by one cycle.
    amplification = 1 + np.linalg.norm(orbit.monodromy(), axis=(-2, -1))
    size = 1 + np.abs(u) + np.abs(orbit.phase) + 2 * np.pi * orbit.n
    assert np.max(off / (amplification * size)) < 1e-13
