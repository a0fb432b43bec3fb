"""The n-T orbits of the restitution model in closed form (Eqs. 6-8)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import phase

EPS = np.finfo(float).eps

families = st.integers(1, 5)
coefficients = st.floats(0.05, 1.0)
excesses = st.floats(0.0, 2.0)
sides = st.booleans()


def landing_gap(s, phase, velocity, amplitude):
    """Height of the ball over the table a time s after an impact (Eq. 5)."""
    return s * velocity - s * s / 2 - amplitude * (np.sin(phase + s) - np.sin(phase))


def bounce(s, phase, velocity, amplitude, r):
    """Velocity after the impact that ends a flight (Eq. 5)."""
    return -r * (velocity - s) + (1 + r) * amplitude * np.cos(phase + s)


@given(families, coefficients, excesses, sides)
def test_the_orbits_are_fixed_points_of_the_map(n, r, excess, stable):
    lam = float(restitution_saddle_node(n, r)) + excess
    phi = float(phase(n, r, lam, Side.STABLE if stable else Side.UNSTABLE))
    v = n * np.pi
    s = 2 * np.pi * n
    assert (phi >= 0) if stable else (phi <= 0)
    # The sine of a full turn is good to eps · 2πn, times Λ.
    scale = EPS * (1 + lam) * s
    assert abs(float(landing_gap(s, phi, v, lam))) <= 4 * s * scale
    assert abs(float(bounce(s, phi, v, lam, r)) - v) <= 8 * scale


@given(families, coefficients)
def test_at_the_bifurcations_a_multiplier_is_plus_or_minus_one(n, r):
    model = RestitutionModel(r)
    for kind, found in zip(
        Bifurcation, (n_t.saddle_node(model, n), n_t.period_doubling(model, n)), strict=True
    ):
        # Λ sin φ = √(Λ² - Λ_SN²) amplifies the rounding of Λ by Λ²/(Λ sin φ).
        allowed = 20 * EPS * (1 + float(found.amplitude) ** 2)
        assert abs(float(kind.test(*found.trace_and_determinant()))) <= allowed


def test_without_restitution_orbits_are_followed_to_the_first_that_rests():
    """r = 0: the 1-T orbit that never rests is that of Λ from √(1 + π²) to √(4 + π²)."""
    ball = bb.rigid(restitution=0.0)
    whole = bb.follow(bb.orbit(ball, amplitude=3.5), to=(3.0, 3.9)).to_dataset()
    places = {kind: each.amplitude for kind, each in whole.special_states()}
    assert places["saddle-node"] == pytest.approx(np.pi, abs=1e-12)
    assert places["period doubling"] == pytest.approx(np.hypot(2, np.pi), abs=1e-12)
    lift = np.hypot(1, np.pi)
    rests = (whole.amplitude < lift - 1e-3) & whole.stable
    assert not whole.admissible.values[rests].any()
    for side in (-1, 1):
        assert bb.orbit(ball, amplitude=lift + side * 1e-6).is_admissible() == (side > 0)
    twice = bb.follow(whole.first("period doubling"), to=3.8).to_dataset()
    assert twice.attrs["impacts"] == 2 and twice.stable.all() and twice.admissible.all()
    # Below, every ball ends on the locked orbit, in the simulation.
    assert bb.motion_of(ball, amplitude=1.5).in_words.item().startswith("locked")
    # Along r the branch ends at 0 itself.
    along = bb.follow(
        bb.orbit(bb.rigid(restitution=0.1), amplitude=3.5), to=0.0, along="restitution"
    ).to_dataset()
    assert along.restitution[-1] == 0.0
    assert along.phase[-1, 0] == pytest.approx(bb.orbit(ball, amplitude=3.5).phase, abs=1e-12)


@pytest.mark.parametrize("r", [-0.01, 1.01, np.nan])
def test_a_restitution_coefficient_outside_its_range_is_refused(r, refusal):
    with refusal(ModelError, f"r = {r}", "[0, 1]"):
        phase(1, r, 1.0)


@pytest.mark.parametrize("value", ["x", "0.5", True, None, ["1"], [[0.5], [0.5, 0.6]]])
def test_what_is_no_number_is_refused_where_the_model_is_made(value, refusal):
    with refusal(ModelError, f"restitution coefficient r = {value!r} is not in [0, 1]"):
        RestitutionModel(value)
    with refusal(ModelError, f"family n = {value!r} is not a positive integer"):
        n_t.orbit(RestitutionModel(0.5), value, 1.0)
    with refusal(ModelError, f"amplitude Λ = {value!r} is not finite and ≥ 0"):
        RestitutionModel(0.5).simulate(value, 0.0, -1.0, 3)


@pytest.mark.parametrize("lam", [0.2, -1.0, np.nan, [1.0, 0.2]])
def test_the_phase_of_an_orbit_below_the_saddle_node_is_refused(lam, refusal):
    # Of several Λ the first one without an orbit is named.
    with refusal(
        NoOrbitError, f"no 1-T orbit at Λ = {np.ravel(lam)[-1]:g}", "saddle-node at Λ = 0.254724"
    ):
        phase(1, 0.85, lam)


def test_the_orbit_with_the_larger_phase_comes_first():
    phase = n_t.orbits(RestitutionModel(0.85), 1, 1.0).phase
    assert phase[0] == -phase[1] > 0
