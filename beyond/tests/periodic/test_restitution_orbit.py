"""The n-T orbits of the restitution model in closed form (Eqs. 6-8)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.periodic.orbit import Side
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import (
    ImpactMap,
    branch_points,
    period_doubling,
    period_doubling_lift,
    phase,
    saddle_node,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

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


def holmes_map(phase, velocity, amplitude, r):
    """P. J. Holmes, J. Sound Vib. 84 (1982) 173-189, in the paper's scaling."""
    landing = phase + 2 * velocity
    return landing, r * velocity + (1 + r) * amplitude * np.cos(landing)


def holmes_map_jacobian(phase, velocity, amplitude, r):
    slope = -(1 + r) * amplitude * np.sin(phase + 2 * velocity)
    return np.array([[1, 2], [slope, r + 2 * slope]])


@given(families, coefficients, excesses, sides)
def test_the_orbits_are_fixed_points_of_both_maps(n, r, excess, stable):
    lam = float(saddle_node(n, r)) + excess
    phi = float(phase(n, r, lam, Side.STABLE if stable else Side.UNSTABLE))
    v = n * np.pi
    s = 2 * np.pi * n
    assert (phi >= 0) if stable else (phi <= 0)
    # The sine of a full turn is good to eps · 2πn, times Λ.
    scale = EPS * (1 + lam) * s
    assert abs(float(landing_gap(s, phi, v, lam))) <= 4 * s * scale
    assert abs(float(bounce(s, phi, v, lam, r)) - v) <= 8 * scale
    landing, after = holmes_map(phi, v, lam, r)
    assert abs(float(landing) - phi - s) <= 4 * EPS * s
    assert abs(float(after) - v) <= 8 * scale


def floquet(kind, n, r, lam, phi):
    """Trace and determinant of either map at an n-T orbit."""
    if kind is ImpactMap.EXACT:
        return Orbit.of(RestitutionModel(r), n, lam, phi).trace_and_determinant()
    jacobian = holmes_map_jacobian(phi, n * np.pi, lam, r)
    return np.trace(jacobian), np.linalg.det(jacobian)


@given(families, coefficients)
def test_at_the_bifurcations_a_multiplier_is_plus_or_minus_one(n, r):
    node = float(saddle_node(n, r))
    for kind in ImpactMap:
        trace, det = floquet(kind, n, r, node, float(phase(n, r, node)))
        # Holmes' has the sine of a phase n turns on.
        assert abs(float(1 - trace + det)) <= 8 * EPS * (1 + 2 * np.pi * n * node)
        doubling = float(period_doubling(n, r, kind))
        phi = float(phase(n, r, doubling))
        trace, det = floquet(kind, n, r, doubling, phi)
        # Λ sin φ = √(Λ² - Λ_SN²) amplifies the rounding of Λ by Λ²/(Λ sin φ).
        allowed = 20 * EPS * (1 + doubling**2)
        assert abs(float(1 + trace + det)) <= allowed
        assert doubling * np.sin(phi) == pytest.approx(
            float(period_doubling_lift(r, kind)), abs=allowed
        )


def test_the_bifurcations_for_one_half_are_those_worked_out_by_hand():
    # Eqs. 7 and 8 worked out by hand for r = 1/2: nπ/3 and 2(5/4)/(9/4) = 10/9.
    assert float(saddle_node(3, 0.5)) == pytest.approx(np.pi, rel=4 * EPS)
    assert float(period_doubling(3, 0.5)) == pytest.approx(np.hypot(10 / 9, np.pi), rel=4 * EPS)


@pytest.mark.parametrize(("n", "r", "top"), [(1, 0.85, 2.0), (5, 0.85, 1.4), (2, 1.0, 1.5)])
def test_the_branch_has_equal_steps_of_the_lift_at_a_constant_cosine(n, r, top):
    amplitude, angle = branch_points(n, r, top, 41)
    assert amplitude[[0, -1]] == pytest.approx([top, top], rel=10 * EPS)
    # Every point solves Λ cos φ = Λ_SN, at equal steps of Λ sin φ.
    node = float(saddle_node(n, r))
    assert amplitude * np.cos(angle) == pytest.approx(np.full(41, node), abs=10 * EPS)
    lift = amplitude * np.sin(angle)
    assert np.diff(lift) == pytest.approx(np.full(40, (lift[-1] - lift[0]) / 40), abs=20 * EPS)
    assert angle[20] == 0 and amplitude[20] == pytest.approx(node, rel=4 * EPS, abs=0)
    assert angle[0] == -angle[-1] < 0


def test_a_branch_that_ends_below_the_saddle_node_is_refused(refusal):
    with refusal(NoOrbitError, "no 2-T orbit at Λ = 0.5", "saddle-node at Λ = 0.509447"):
        branch_points(2, 0.85, 0.5, 7)


@pytest.mark.parametrize("r", [0.0, 1.01, np.nan])
def test_a_restitution_coefficient_outside_its_range_is_refused(r, refusal):
    for call in (
        lambda: saddle_node(1, r),
        lambda: period_doubling(1, r),
        lambda: period_doubling_lift(r),
        lambda: phase(1, r, 1.0),
    ):
        with refusal(ModelError, f"r = {r}", "(0, 1]"):
            call()


@pytest.mark.parametrize("value", ["x", "0.5", True, None, ["1"], [[0.5], [0.5, 0.6]]])
def test_what_is_no_number_is_refused_where_the_model_is_made(value, refusal):
    with refusal(ModelError, f"restitution coefficient r = {value!r} is not in (0, 1]"):
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
