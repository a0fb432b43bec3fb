"""Figures 2 and 3: the restitution model's orbits."""

import numpy as np
import pytest

from bouncing_ball.paper.exhibits.restitution_model import restitution_history, restitution_orbits
from bouncing_ball.pipeline.job import typed

# As the configuration gives them.
restitution_history, restitution_orbits = map(typed, (restitution_history, restitution_orbits))

DOMAINS = {"n": [1, 2, 3], "restitution": 0.85, "amplitude_max": 2.0, "points": 81}


def landing_gap(s, phase, velocity, amplitude):
    """Height of the ball over the table a time s after an impact (Eq. 5)."""
    return s * velocity - s * s / 2 - amplitude * (np.sin(phase + s) - np.sin(phase))


def bounce(s, phase, velocity, amplitude, r):
    """Velocity after the impact that ends a flight (Eq. 5)."""
    return -r * (velocity - s) + (1 + r) * amplitude * np.cos(phase + s)


def test_the_points_of_fig_3_are_fixed_points_of_the_exact_map(described):
    data = described(restitution_orbits(DOMAINS))
    assert data.phase.dims == ("n", "point") and data.phase.shape == (3, 81)
    assert data.n.values.tolist() == [1, 2, 3]
    assert data.impact_map.values.tolist() == ["exact", "holmes"]
    for n in DOMAINS["n"]:
        row = data.sel(n=n)
        # Every point is a fixed point of the exact map: lands after n periods
        # with the velocity it started with. Roundings of 2πn and (2πn)²/2.
        s = 2 * np.pi * n
        v = np.pi * n
        phi = row.phase.values
        lam = row.amplitude.values
        assert landing_gap(s, phi, v, lam) == pytest.approx(np.zeros(81), abs=1e-12)
        assert bounce(s, phi, v, lam, 0.85) == pytest.approx(np.full(81, v), abs=1e-13)
        assert row.amplitude.values[[0, -1]] == pytest.approx([2.0, 2.0], rel=1e-14)
        # Stable exactly between the saddle-node and the exact period doubling.
        doubling = float(row.period_doubling_phase.sel(impact_map="exact"))
        inside = (row.phase.values > 0) & (row.phase.values < doubling)
        assert np.array_equal(row.stable.values, inside)
        assert float(row.saddle_node_amplitude) == row.amplitude.values.min()
        assert float(row.saddle_node_phase) == 0.0
        for kind in ("exact", "holmes"):
            at = row.sel(impact_map=kind)
            lam = float(at.period_doubling_amplitude)
            phi = float(at.period_doubling_phase)
            assert lam * np.cos(phi) == pytest.approx(float(row.saddle_node_amplitude), rel=1e-14)
    # The printed Table 1 (ϖ = 10⁴) is Holmes' map; the exact map is above it.
    holmes = data.period_doubling_amplitude.sel(impact_map="holmes").values
    assert holmes == pytest.approx([1.032, 1.122, 1.259], abs=5e-4)
    assert np.all(data.period_doubling_amplitude.sel(impact_map="exact").values > holmes)


def test_admissible_points_fly_over_the_table():
    data = restitution_orbits(DOMAINS | {"amplitude_max": 6.0, "n": [1, 2]})
    assert data.admissible.all("point").values.tolist() == [False, True]
    for n in (1, 2):
        row = data.sel(n=n)
        s = np.linspace(0, 2 * np.pi * n, 4001)[1:-1, np.newaxis]
        gap = landing_gap(s, row.phase.values, np.pi * n, row.amplitude.values).min(axis=0)
        # A fine grid sees every dip deeper than (step)² times the curvature;
        # next to take-off the gap falls to Λ's own small step.
        clear = np.abs(gap) > 1e-4
        assert np.array_equal(row.admissible.values[clear], (gap > 0)[clear])
        assert clear.mean() > 0.5
    # The grazing orbit divides the unstable side; where there is none, it is NaN.
    row = data.sel(n=1)
    lam = float(row.grazing_amplitude)
    phase = float(row.grazing_phase)
    assert np.array_equal(row.admissible.values, row.phase.values > phase)
    s = np.linspace(0.3, 2 * np.pi - 0.3, 40001)
    # It touches the table: a minimum of zero, seen to (step)²/8 · Λ.
    assert abs(float(landing_gap(s, phase, np.pi, lam).min())) < 1e-8
    assert np.isnan(float(data.grazing_amplitude.sel(n=2)))


def test_elastic_domains_reach_the_top():
    # r = 1: Λ cos φ = 0, and the branch is φ = ±π/2 at any Λ.
    data = restitution_orbits({"n": [1], "restitution": 1.0, "amplitude_max": 2.0, "points": 11})
    assert data.amplitude.values[0, [0, -1]].tolist() == [2.0, 2.0]
    assert np.abs(data.phase.values[0, [0, -1]]) == pytest.approx(np.full(2, np.pi / 2), rel=1e-15)


HISTORY = {"n": 1, "restitution": 0.85, "amplitude": 1.0, "periods": 2, "samples": 401}


def test_the_ball_of_fig_2_touches_the_table_at_its_impacts_only(described):
    data = described(restitution_history(HISTORY))
    assert data.ball.dims == ("time",) and data.sizes["time"] == 401
    assert float(data.time[-1]) == pytest.approx(4 * np.pi, rel=1e-15)
    phase = float(data.phase)
    assert np.cos(phase) == pytest.approx(np.pi * 0.15 / 1.85, rel=1e-14)  # Eq. 6
    assert data.table.values == pytest.approx(np.sin(data.time.values + phase), abs=1e-15)
    # Above the table but for the impacts, on it there.
    gap = (data.ball - data.table).values
    assert gap[[0, 200]] == pytest.approx(np.zeros(2), abs=1e-13)
    assert np.all(np.delete(gap, [0, 200, 400]) > 0)
    # Flight from the first impact, by hand.
    s = data.time.values[:200]
    flight = np.sin(phase) + np.pi * s - s**2 / 2
    assert data.ball.values[:200] == pytest.approx(flight, abs=1e-13)
    assert data.ball_velocity.values[:200] == pytest.approx(np.pi - s, abs=1e-14)
