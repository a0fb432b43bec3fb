"""Random contacts over the entire range: no bifurcation is false, and none is missing."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import branch_point

EPS = np.finfo(float).eps
SIZES = [
    pytest.param(500, 15, id="quick"),
    pytest.param(10_000, 150, id="all", marks=pytest.mark.long),
]
KINDS = {kind.replace("-", "_").replace(" ", "_"): kind.test for kind in Bifurcation}


def sample(seed: int, count: int, release: Release):
    random = np.random.default_rng(seed)
    omega = 10 ** random.uniform(-1, 6, count)
    contact = SpringDamper.from_restitution(random.uniform(0.02, 1, count), omega, release)
    # Small families and large ones alike.
    n = np.where(
        random.random(count) < 0.5,
        random.integers(1, 6, count),
        (10 ** random.uniform(0, 2.3, count)).astype(int),
    )
    return contact, n


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize(("count", "_"), SIZES)
def test_every_bifurcation_found_has_a_multiplier_of_plus_or_minus_one(release, kind, count, _):
    contact, n = sample(7, count, release)
    orbit = getattr(n_t, kind)(ContactModel(contact), n)
    orbit = orbit[orbit.exists]
    assert orbit.size > 0.85 * count
    # The trace from the flow's Jacobian, which the search does not use. Its
    # entries cancel, and lose what they are larger than their sum.
    matrix = orbit.monodromy()
    trace = np.trace(matrix, axis1=-2, axis2=-1)
    size = 1 + np.abs(matrix).max(axis=(-2, -1))
    lost = np.maximum(size, orbit.amplitude) * orbit.n * np.maximum(1, orbit.law.frequency_ratio)
    # The rounding of a phase after n turns moves the speed of the table by Λ 2πn ε, of which the
    # entries have the part over the slowest speed of the ball.
    slowest = np.minimum(-orbit.relative_impact_velocity, orbit.relative_bounce_velocity)
    value = np.abs(KINDS[kind](trace, orbit.trace_and_determinant()[1]))
    # Balls that rise at the impact, or fall at the release, follow no orbit, and land with another
    # rounding.
    bounces = slowest > 0
    lost = lost * (1 + 2 * np.pi * orbit.n * orbit.amplitude / np.abs(slowest))
    assert np.mean(bounces) > 0.9 and np.max((value / lost)[bounces]) < 200 * EPS
    # Where nothing changes sign but a pole or a grazing orbit it is of order one.
    assert np.all(value < 1e-6 + 200 * EPS * lost)


def first_zero(contact: SpringDamper, n: int, kind: str, edges) -> tuple[float, float]:
    """Neighbouring points of a fine grid around the wanted zero; NaN without."""
    values = branch_point(edges, contact, n)
    test = KINDS[kind](values.trace, values.determinant)
    at = np.nonzero((test[:-1] >= 0) != (test[1:] >= 0))[0]
    if not len(at):
        return np.nan, np.nan
    k = at[0 if kind == "saddle_node" else -1]
    return edges[k], edges[k + 1]


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize(("_", "count"), SIZES)
def test_no_bifurcation_of_a_fine_grid_is_missing(release, _, count):
    contacts, families = sample(8, count, release)
    for contact, n in ((contacts[k], families[k]) for k in range(count)):
        model = ContactModel(contact)
        start = float(contact.free_angle)
        frequency = float(contact.damped_frequency)
        full = frequency * 2 * np.pi * n - start
        # Both time scales of the branch: the contact's and the fold's, 1/ϖ.
        near = np.geomspace(1e-7, 1, 1500) * min(1 / frequency, start / 2)
        top = min(full, 20.0) * (1 - 1e-6)
        wide = np.linspace(-start * (1 - 1e-3), top, 3000)
        edges = np.unique(np.concatenate([-near[-near > wide[0]], near[near < top], wide]))
        for kind in KINDS:
            orbit = getattr(n_t, kind)(model, n)
            excess = orbit.contact_duration * frequency - start
            if kind == "period_doubling" and n_t.saddle_node(model, n).exists:
                edges = edges[
                    edges < float(n_t.saddle_node(model, n).contact_duration) * frequency - start
                ]
            low, high = first_zero(contact, int(n), kind, edges)
            assert np.isnan(low) == np.isnan(excess), (contact, n, kind)
            if not np.isnan(low):
                slack = 1e-9 * start
                assert low - slack <= excess <= high + slack, (contact, n, kind)
