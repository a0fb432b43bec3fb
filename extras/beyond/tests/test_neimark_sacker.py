"""Pairs of multipliers that leave the unit circle, where faster impacts lose less energy."""

import pickle

import numpy as np
import pytest

import bouncing_ball_beyond as bb


def force(p, v, k, c, w):
    return k * p + c * v / (1 + (v / w) ** 4)


LAW = bb.ForceLaw(force, {"k": 400.0, "c": 6.0, "w": 3.2})
GIVEN = {"frequency": 50.0, "acceleration": 7.5, "mass": 0.02, "stiffness": 1e8}
RISING = [(0.10, 0.5), (0.11, 0.64), (0.12, 0.75), (0.14, 0.883), (0.2, 0.985)]


@pytest.fixture(scope="module")
def torus():
    branch = bb.follow(bb.orbit(LAW, amplitude=0.7), along="w", to=1.5)
    assert np.diff(branch.stable.astype(int)).tolist().count(-1) == 1
    (special,) = branch.special
    return special


def test_a_pair_passes_the_unit_circle(torus):
    assert torus.kind == "Neimark-Sacker"
    assert np.abs(torus.multipliers) == pytest.approx(1, abs=1e-13)
    assert torus.multipliers[0].imag != 0
    for side, stable in ((-0.01, False), (0.01, True)):
        assert bb.follow(torus, to=torus.z[-1] + side).orbits[-1].stable == stable


def test_a_curve_ends_where_the_multipliers_are_real(torus):
    ranges = {"amplitude": (0.1, 2.0), "w": (0.5, 6.0)}
    curve = bb.special_curve(torus, along=("amplitude", "w"), ranges=ranges)
    assert curve.start.startswith("saddle-node") and curve.end.startswith("period doubling")
    for orbit in curve.orbits[1:-1]:
        assert np.abs(orbit.multipliers) == pytest.approx(1, abs=1e-12)
    for orbit, resonance in ((curve.orbits[0], "1:1"), (curve.orbits[-1], "1:2")):
        with pytest.raises(ValueError, match=f"strong resonance {resonance}, which has"):
            bb.normal_form(orbit)


def test_the_normal_form(torus):
    form = bb.normal_form(torus)
    assert form.supercritical and not form.opens_upwards
    # By a polynomial of degree 6 through an integration of the return map.
    assert form.coefficient == pytest.approx(-0.0173659, rel=1e-5)
    step = 1e-4
    sizes = [
        abs(bb.follow(torus, to=torus.z[-1] + side).orbits[-1].multipliers[0])
        for side in (-step, step)
    ]
    assert form.rate == pytest.approx((sizes[1] - sizes[0]) / (2 * step), rel=1e-6)


@pytest.mark.parametrize(
    ("w", "stable"), [(3.2, [(0.48791, 1.10858)]), (2.37, [(0.30449, 0.48361)]), (2.0, [])]
)
def test_ranges_of_stable_orbits(w, stable):
    limits = bb.limits(LAW.at(w=w))
    assert np.array(limits.stable_ranges) == pytest.approx(np.array(stable), abs=1e-5)
    assert ("stable" in repr(limits)) == (w != 3.2)


def test_a_shaker_asks_the_multipliers():
    answer = bb.on_shaker(**GIVEN, restitution=RISING, release="displacement")
    assert not answer.stable and not answer.is_good_enough
    assert np.abs(answer.multiplier) == pytest.approx((1.1730, 1.1728), abs=1e-4)
    assert "neighbouring motions turn away from the orbit in both models" in str(answer)
    assert abs(bb.on_shaker(**GIVEN, restitution=0.85).multiplier[0]) == pytest.approx(0.85)


def test_an_elastic_ball_passes_nothing():
    elastic = bb.limits(bb.Rigid(1.0), n=3)
    assert elastic.stable_ranges == ((1e-6, elastic.period_doubling.amplitude),)
    for orbit in bb.orbits(bb.SpringDamper(10.0, 1.0), impacts=2, periods=2, amplitude=1.6):
        kinds = {special.kind for special in bb.follow(orbit, to=0.6).special}
        assert "Neimark-Sacker" not in kinds


def test_two_points_in_one_step_are_found():
    """Along w, the determinant rises above 1 and falls again between two orbits of the branch."""
    law = bb.ForceLaw(
        lambda p, v, k, c, w, d: force(p, v, k, c, w) + d * v,
        {"k": 400.0, "c": 6.0, "w": 3.2, "d": 0.33},
    )
    for w in (2.6, 3.2, 4.4):
        branch = bb.follow(bb.orbit(law.at(w=w), amplitude=0.9), along="w", to=1.0)
        places = [special.z[-1] for special in branch.special]
        assert places == pytest.approx([1.88080, 1.72288], abs=1e-5)


def test_thresholds_and_errors_say_where_the_orbit_is_unstable():
    ball = bb.SpringDamper(1.0, restitution=0.65)
    known = {"amplitude": [1.0, 1.2385, 1.6], "quantities": ["max_height", "saddle_node"]}
    thresholds = bb.error_thresholds(ball, **known)
    height = thresholds["max_height"]
    assert height.unstable.tolist() == ["", "on the contact", "in both models"]
    assert (thresholds["saddle_node"].unstable == "").all()
    for amplitude, ratio, text in zip(
        known["amplitude"], height.ratio, height.unstable, strict=True
    ):
        one = bb.orbit(ball.at(frequency_ratio=float(ratio)), amplitude=amplitude)
        assert one.stable == (text == "")
    corrected = bb.error_thresholds(ball, simple=bb.Corrected, **known | {"amplitude": 1.6})
    assert corrected["max_height"].unstable == "in both models"
    law = LAW.at(w=2.0)
    assert bb.exact_errors(law, amplitude=0.7).unstable == "in both models"
    assert bb.law_errors(law, amplitude=0.7).unstable == "in the simple model"


def test_ranges_on_a_table_with_several_saddle_nodes():
    """In the restitution model w′ = C, and orbits with -w″ between 0 and 2(1 + r²)/(1 + r)² are."""
    table, r = bb.Table([(1, 1.0, 0.0), (2, 0.3, 2.2)]), 0.6
    assert table.next_low_slope > 0
    ranges = bb.limits(bb.Rigid(r), table=table).stable_ranges
    phase = np.linspace(0, 2 * np.pi, 100_001)
    slopes, pushes = table(phase, 1), -table(phase, 2)
    line, most = np.pi * (1 - r) / (1 + r), 2 * (1 + r**2) / (1 + r) ** 2
    for amplitude in np.linspace(1.01 * line / table.slope, 1.2 * max(ranges)[1], 23):
        at = np.diff(np.sign(slopes - line / amplitude)) != 0
        push = amplitude * pushes[:-1][at]
        expected = np.any((push > 0) & (push < most))
        assert expected == any(low < amplitude < high for low, high in ranges)


@pytest.mark.parametrize(("ratio", "r"), [(1.0, 0.5), (2.5, 0.1)])
def test_a_range_without_a_saddle_node_begins_where_the_flight_vanishes(ratio, r):
    """At the threshold of permanent contact, Eq. 33."""
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
    threshold = np.sqrt(1 + (4 * zeta**2 - 2) / ratio**2 + 1 / ratio**4)
    low, _ = bb.limits(bb.SpringDamper(ratio, restitution=r)).stable_ranges[0]
    assert low == pytest.approx(threshold, rel=1e-10)


def test_limits_are_two_values_one_list_of_ranges_for_each_ball():
    fold, doubling = bb.limits(bb.Rigid(0.5))
    several = bb.limits(bb.Rigid([0.5, 0.7]))
    both = [fold.amplitude, doubling.amplitude]
    assert several[0].stable_ranges[0] == pytest.approx(both)
    again = pickle.loads(pickle.dumps(several[1]))
    assert again.stable_ranges == several[1].stable_ranges and len(again) == 2


def test_a_steep_fall_of_r_makes_the_determinant_negative():
    """r r̂ of the restitution model at the closing speed, where r falls faster than 1/u."""
    ball = bb.Rigid(lambda u: 0.1 + 0.4 / (1 + np.exp(1.5 * (u - 4.8))))
    impact = bb.free_impact(ball)
    expected = float(impact.restitution * impact.slope)
    low, _ = bb.limits(ball).stable_ranges[0]
    one = bb.orbit(ball, amplitude=1.01 * low)
    assert one.trace_and_determinant[1] == pytest.approx(expected) and expected < -0.05
    assert one.stable
