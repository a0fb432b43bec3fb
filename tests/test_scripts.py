"""The stages of the workflow: what their functions compute, against independent formulas.

The orbits of `tests.independent` come from the closed form by the duration of the contact, and its
motions from an integration. `make replication` compares whole datasets with the reference.
"""

import numpy as np
import pytest
import xarray as xr
import yaml
from scipy.optimize import brentq, minimize_scalar
from tests import independent
from tests.checkout import ROOT
from tests.reference import CONFIG, reference, table_with_another_row

from bouncing_ball import errors
from bouncing_ball.orbits import NoOrbit
from bouncing_ball.spring_damper import RELEASES
from carbonelli2011 import claims
from carbonelli2011.paper import QUANTITIES
from carbonelli2011.stages import (
    apparent_restitution,
    continuation,
    error_thresholds,
    permanent_contact,
    printed_numbers,
    restitution_model,
    time_histories,
    validity,
)
from paper_replication.verdicts import against_print

ORBITS = 1e-9
"""Orbits are solved to 1e-11, and the closed form amplifies this on stiff contacts."""


FORMS = {"saddle-node": 0, "period doubling": 1}
"""Which test function vanishes at a bifurcation."""


def registered(section, name, **changed):
    """The parameters of a dataset in the configuration, with some changed."""
    return CONFIG[section][name] | changed


def start_of(y):
    """The start (ϖδ, δ′, w, w′, 1) of the contact of an orbit, for `independent.transfer`."""
    amplitude, phase, velocity, _ = y
    x = amplitude * np.cos(phase)
    return np.array([0, velocity - x, amplitude * np.sin(phase), x, 1])


def quantities(n, r, ratio, release, duration):
    """The quantities of the orbit with a given duration of contact, from the closed form."""
    zeta = independent.restitution_to_damping(r, release)
    y = independent.orbit(n, ratio, zeta, release, duration)
    start = start_of(y)
    gap, rate, table, speed, _ = independent.transfer(ratio, zeta, duration) @ start
    bounce = rate + speed
    tests = independent.test_functions(n, ratio, zeta, release, duration)
    return {
        "amplitude": y[0],
        "phase": y[1],
        "release_phase": y[1] + duration,
        "impact_velocity": y[2],
        "bounce_velocity": bounce,
        "apparent_restitution": -rate / start[1],
        "max_height": gap / ratio + table + bounce**2 / 2,
        "stable": min(tests) > 0,
    }


# The restitution model


def test_the_ball_of_figure_2_obeys_the_law_of_the_impact():
    given = {"n": 2, "restitution": 0.65, "amplitude": 1.8, "periods": 2, "samples": 401}
    data = restitution_model.STAGE["fig02"](given)
    impact = 2 * np.pi * given["n"]
    table_speed = given["amplitude"] * np.cos(float(data.phase))
    # Eq. 2, with the velocity before the impact from a fall over the whole flight.
    before = float(data.ball_velocity[0]) - impact
    assert float(data.ball_velocity[0]) - table_speed == pytest.approx(
        -given["restitution"] * (before - table_speed), abs=1e-12
    )
    assert float(data.ball[0]) == pytest.approx(float(data.table[0]), abs=1e-12)
    # It is on the table at each impact, and above it in between.
    landings = np.isclose(data.time % impact, 0) | np.isclose(data.time % impact, impact)
    assert int(landings.sum()) == 1 + given["periods"]
    assert (data.ball > data.table)[~landings].all()


def test_the_branches_of_figure_3_are_orbits_up_to_the_largest_amplitude():
    given = {"n": [1, 2, 3], "restitution": 0.85, "amplitude_max": 2.0, "points": 41}
    data = restitution_model.STAGE["fig03"](given)
    # Eq. 6: X = Λ cos φ is nπ(1 - r)/(1 + r) on a whole branch, at equal steps of Λ sin φ.
    x = data.n * np.pi * 0.15 / 1.85
    xr.testing.assert_allclose((data.amplitude * np.cos(data.phase) / x), 0 * data.amplitude + 1)
    impact_height = data.amplitude * np.sin(data.phase)
    steps = impact_height.diff("point")
    assert float((steps.max("point") / steps.min("point") - 1).max()) < 1e-9
    ends = data.amplitude.isel(point=[0, -1])
    assert ends.values == pytest.approx(np.full((3, 2), 2.0))


def test_the_three_balls_move_by_independent_flights_and_repeat_as_recorded():
    given = registered("restitution_model", "three_balls", impacts=256)
    data = restitution_model.STAGE["three_balls"](given)
    r = given["restitution"]
    assert data.amplitude.values.tolist() == given["amplitude"]
    for ball in (data.sel(amplitude=amplitude) for amplitude in given["amplitude"]):
        amplitude = float(ball.amplitude)
        time = given["phase"]
        velocity = amplitude * np.cos(time) + r * given["impact_speed"]
        times = []
        velocities = []
        for _ in range(60):
            times.append(time)
            velocities.append(velocity)
            height = amplitude * np.sin(time)
            flight = independent.first_landing(amplitude, time, height, velocity)
            time = time + flight
            table = amplitude * np.cos(time)
            velocity = table - r * (velocity - flight - table)
        # Rounding errors grow by a factor of about 2 at each impact of the chaotic ball.
        assert ball.impact_time.values == pytest.approx(times[:12], abs=1e-9)
        assert ball.impact_bounce.values == pytest.approx(velocities[:12], abs=1e-9)
        # The last impacts have come near the orbit to which the motion tends.
        count = int(ball.impacts)
        periods = int(ball.periods)
        near = [
            k
            for k in range(1, 7)
            if abs(velocities[-1] - velocities[-1 - k]) < 1e-3
            and abs(velocities[-2] - velocities[-2 - k]) < 1e-3
        ]
        assert near[:1] == [count] * bool(count)
        if count:
            passed = (times[-1] - times[-1 - count]) / (2 * np.pi)
            assert passed == pytest.approx(periods, abs=1e-3)
        assert int(ball.stickings) == 0
        assert bool(np.isfinite(ball.lyapunov_exponent)) == (count == 0)


# Orbits along the frequency ratio


@pytest.mark.parametrize(
    ("name", "release"),
    [("fig05", "displacement"), ("fig06", "force"), ("fig10", "force"), ("fig13", "displacement")],
)
def test_the_orbits_along_the_frequency_ratio_are_those_of_the_closed_form(name, release):
    ratios = {"min": 2.0, "max": 1000.0, "samples": 4}
    given = registered("apparent_restitution", name, frequency_ratio=ratios)
    data = apparent_restitution.STAGE[name](given, release)
    if "cases" in given:
        cases = [(case["restitution"], case["amplitude"]) for case in given["cases"]]
    else:
        cases = [(given["restitution"], amplitude) for amplitude in given["amplitude"]]
    assert [*zip(data.restitution.values, data.amplitude.values, strict=True)] == cases
    grid = np.geomspace(2, 1000, 4)
    assert all(np.isclose(data.frequency_ratio, ratio).any() for ratio in grid)
    points = data.stack(point=["case", "frequency_ratio"])
    for point in (points.isel(point=k) for k in range(points.sizes["point"])):
        r = float(point.restitution)
        ratio = float(point.frequency_ratio)
        expected = quantities(given["n"], r, ratio, release, float(point.contact_duration))
        for quantity in expected.keys() & set(point):
            off = abs(float(point[quantity]) - expected[quantity])
            assert off < ORBITS * max(10, ratio), (quantity, r, ratio)
        assert point.admissible


def test_figures_10_and_13_have_the_limits_of_a_stiff_contact():
    for name in ("fig10", "fig13"):
        ratios = {"min": 1e4, "max": 1e5, "samples": 2}
        given = registered("apparent_restitution", name, frequency_ratio=ratios)
        data = apparent_restitution.STAGE[name](given, "displacement")
        for quantity in ("phase", "bounce_velocity", "impact_velocity"):
            off = (data[quantity] - data[f"restitution_{quantity}"]).isel(frequency_ratio=[0, -1])
            # They differ by a term in 1/ϖ.
            assert (abs(off) < 1e-3).all()
            assert off[..., 0].values == pytest.approx(10 * off[..., 1].values, rel=1e-3)


# Branches


def test_branches_have_the_special_points_of_each_contact_and_nothing_else():
    """A stiff and a compliant contact, whose branches have different numbers of them."""
    given = registered("continuation", "fig08", frequency_ratio=[10.0, 2.0], points=61)
    data = continuation.STAGE["fig08"](given, "displacement", 0.2)
    zeta = independent.restitution_to_damping(given["restitution"])
    assert float(data.damping_ratio) == pytest.approx(zeta)
    counts = []
    for ratio in given["frequency_ratio"]:
        branch = data.sel(frequency_ratio=ratio)
        kinds = [kind for kind in branch.special_kind.values.tolist() if kind]
        count = len(kinds)
        counts.append(count)
        durations = branch.contact_duration.values
        at = (given["n"], ratio, zeta, "displacement")
        grid = np.interp(np.arange(0, 60.1, 0.25), np.arange(61), durations)
        expected = []
        for kind, k in FORMS.items():
            zeros = independent.roots(
                lambda duration, at=at, k=k: independent.test_functions(*at, duration)[k], grid
            )
            expected += [(duration, kind) for duration in zeros]
        # Along the branch contacts get shorter.
        expected.sort(reverse=True)
        assert kinds == [kind for _, kind in expected]
        special = branch.isel(special=slice(count))
        special_durations = special.special_contact_duration.values
        assert special_durations == pytest.approx([duration for duration, _ in expected], abs=1e-8)
        amplitudes = independent.orbit(*at, special_durations)[0]
        assert special.special_amplitude.values == pytest.approx(amplitudes, abs=1e-8)
        assert np.isnan(branch.special_amplitude.values[count:]).all()
        # The multipliers of each orbit have the sum and the product of its monodromy matrix.
        trace = np.trace(independent.monodromy(*at, durations), axis1=-2, axis2=-1)
        multipliers = branch.multiplier_real.values + 1j * branch.multiplier_imag.values
        assert multipliers.sum(axis=-1) == pytest.approx(trace, rel=1e-9, abs=1e-9)
        product = np.exp(-2 * zeta * ratio * durations)
        assert multipliers.prod(axis=-1) == pytest.approx(product, rel=1e-6)
        assert (branch.stable.values == (abs(multipliers).max(axis=-1) < 1)).all()
    assert counts[0] < counts[1] == data.sizes["special"]


def test_a_contact_without_orbits_has_a_row_of_nan_with_the_reason():
    """The saddle-node of the 5-T orbits rises on compliant contacts beyond this Λ."""
    given = {"n": 5, "restitution": 0.65, "amplitude_max": 3.5, "points": 5}
    compute = continuation.STAGE["fig08"]
    with np.errstate(invalid="ignore"):
        data = compute(given | {"frequency_ratio": [3.0, 1.0]}, "displacement", 0.2)
    reason = "no 5-T orbit is found at Λ = 3.5 and ϖ = 1: give a larger Λ or ϖ"
    assert set(data.end_reason.sel(frequency_ratio=1).values) == {reason}
    assert data.end_kind.values.tolist() == [["largest amplitude"] * 2, ["inside"] * 2]
    assert np.isnan(data.amplitude.sel(frequency_ratio=1)).all()
    assert np.isfinite(data.amplitude.sel(frequency_ratio=3)).all()
    with pytest.raises(ValueError, match=f"{reason}$"):
        compute(given | {"frequency_ratio": 1.0}, "displacement", 0.2)


def test_figure_15_has_the_orbits_of_the_restitution_model():
    given = registered("continuation", "fig15", points=15)
    data = continuation.STAGE["fig15"](given, "displacement", 0.2)
    n = given["n"]
    r = given["restitution"]
    x = n * np.pi * (1 - r) / (1 + r)
    phase = data.restitution_phase.values
    amplitude = data.restitution_amplitude.values
    assert amplitude * np.cos(phase) == pytest.approx(np.full(15, x))
    assert amplitude[[0, -1]] == pytest.approx(np.full(2, given["amplitude_max"]))
    # Stable from the saddle-node to the period doubling: 0 < Λ sin φ < 2(1 + r²)/(1 + r)².
    impact_height = amplitude * np.sin(phase)
    highest = 2 * (1 + r**2) / (1 + r) ** 2
    expected = (impact_height > 1e-9) & (impact_height < highest)
    assert (data.restitution_stable.values == expected).all()
    assert float(data.saddle_node_amplitude) == pytest.approx(x)
    doubling = float(data.period_doubling_amplitude)
    assert doubling == pytest.approx(np.hypot(x, highest))
    assert doubling * np.cos(float(data.period_doubling_phase)) == pytest.approx(x)


def end_of_range(n, ratio, zeta, release, bound):
    """The orbit at an end of a range of Table 1, from the closed form by the contact's duration."""
    k = FORMS[bound]
    half = np.pi / ratio / np.sqrt(1 - zeta**2)

    def test_function(duration):
        return independent.test_functions(n, ratio, zeta, release, duration)[k]

    durations = independent.roots(test_function, half * np.linspace(0.7, 1.3, 121))
    orbits = [independent.orbit(n, ratio, zeta, release, duration) for duration in durations]
    # The phase of this period doubling is positive.
    lowest = (-np.pi / 2, 0)[k]
    (orbit,) = (y for y in orbits if lowest < y[1] < np.pi / 2 and y[2] < 0)
    return orbit


def test_table_1_has_the_bifurcations_of_the_closed_form_and_the_printed_ends():
    """Also in a row that the paper does not print, whose printed ends are missing."""
    data = table_with_another_row()
    zeta = independent.restitution_to_damping(0.85)
    assert data.frequency_ratio.values.tolist() == [1e4, 50.0, 10.0, 2.0]
    for ratio in (50.0, 10.0, 2.0):
        for n in (1, 2, 3):
            for bound in data.bound.values:
                end = data.sel(frequency_ratio=ratio, n=n, bound=bound)
                y = end_of_range(n, ratio, zeta, "displacement", bound)
                assert float(end.computed) == pytest.approx(y[0], abs=1e-9)
                assert float(end.special_contact_duration) * ratio == pytest.approx(y[3], abs=1e-6)
    printed = {"frequency_ratio": [1e4, 10.0, 2.0]}
    expected = reference()["table1"].sel(printed)
    xr.testing.assert_allclose(data.sel(printed), expected, rtol=1e-9, atol=1e-12)
    assert np.isnan(data.printed.sel(frequency_ratio=50)).all()
    for other in ({"restitution": 0.65}, {"release": "force"}):
        few = {"n": [1], "restitution": 0.85, "frequency_ratio": [10.0], "release": "displacement"}
        alone = few | other
        data = continuation.table1(alone, alone["release"])
        assert np.isnan(data.printed).all()
    # The restitution model, to which the stiffest row tends.
    x = data.n * np.pi * 0.15 / 1.85
    exact = data.restitution_range.sel(impact_map="exact")
    assert exact.sel(bound="saddle-node").values == pytest.approx(x.values)
    highest = 2 * (1 + 0.85**2) / 1.85**2
    doublings = exact.sel(bound="period doubling").values
    assert doublings == pytest.approx(np.hypot(x, highest).values)


def test_an_end_of_table_1_that_no_ball_follows_is_marked():
    """At r = 0.1, n = 2, ϖ = 0.7 the orbit touches the table before its landing."""
    given = registered("continuation", "table1", n=[2], restitution=0.1, frequency_ratio=[0.7])
    data = continuation.STAGE["table1"](given, "displacement").squeeze()
    doubling = data.sel(bound="period doubling")
    assert float(doubling.computed) == pytest.approx(7.62590, abs=1e-5)
    assert not doubling.admissible
    contact = 0.7, independent.restitution_to_damping(0.1), "displacement"
    duration = float(doubling.special_contact_duration)
    y = independent.orbit(2, *contact, duration)
    gap, rate, _, speed, _ = independent.transfer(*contact[:2], duration) @ start_of(y)
    phase = y[1] + duration
    height = y[0] * np.sin(phase)
    landing = independent.first_landing(y[0], phase, height + gap / 0.7, rate + speed)
    assert landing < 4 * np.pi - duration - 1e-3


# Permanent contact


def threshold_of_permanent_contact(ratio, zeta, release):
    """Λ at which δ or the force of the steady oscillation touches zero, by complex amplitudes."""
    response = 1 / (ratio**2 - 1 + 2j * zeta * ratio)
    pressed = response * (1 + 1j * independent.lag(ratio, zeta, release))
    # Gravity compresses the contact by 1/ϖ².
    return 1 / ratio**2 / abs(pressed)


@pytest.mark.parametrize("release", RELEASES)
def test_the_thresholds_of_permanent_contact_are_those_of_the_steady_oscillation(release):
    ratios = {"min": 0.5, "max": 100.0, "samples": 21}
    given = registered("permanent_contact", "fig16", frequency_ratio=ratios)
    data = permanent_contact.STAGE["fig16"](given, release)
    zeta = independent.restitution_to_damping(given["restitution"], release)

    def threshold(ratio):
        return threshold_of_permanent_contact(ratio, zeta, release)

    expected = threshold(np.geomspace(0.5, 100, 21))
    assert data.threshold_amplitude.values == pytest.approx(expected)
    # Eqs. 9 and 38: Λ of the restitution model is 1.
    assert data.relative_error.values == pytest.approx(abs(expected - 1), abs=1e-12)
    last = brentq(lambda ratio: abs(threshold(ratio) - 1) - given["tolerance"], 3, 90)
    assert float(data.error_threshold) == pytest.approx(last)
    assert data.threshold_status == "found"
    lowest = minimize_scalar(threshold, bounds=(0.1, 3), method="bounded", options={"xatol": 1e-9})
    assert float(data.minimum_threshold) == pytest.approx(lowest.fun)
    assert float(data.minimum_frequency_ratio) == pytest.approx(lowest.x, abs=1e-4)
    same = given | {"restitution": 0.65}
    fig11 = permanent_contact.STAGE["fig11"](same, release)
    xr.testing.assert_equal(fig11, data[[*fig11]])


# Thresholds of the error


def test_figure_14_has_the_heights_of_the_closed_form_and_the_threshold_of_their_error():
    ratios = {"min": 10.0, "max": 1000.0, "samples": 5}
    given = registered("error_thresholds", "fig14", frequency_ratio=ratios)
    data = error_thresholds.STAGE["fig14"](given, "displacement")
    r = given["restitution"]
    amplitude = given["amplitude"]
    x = np.pi * (1 - r) / (1 + r)
    highest = np.sqrt(amplitude**2 - x**2) + np.pi**2 / 2
    assert float(data.restitution_max_height) == pytest.approx(highest)
    for point in (data.isel(frequency_ratio=k) for k in range(5)):
        ratio = float(point.frequency_ratio)
        expected = quantities(1, r, ratio, "displacement", float(point.contact_duration))
        for quantity in ("phase", "impact_velocity", "max_height"):
            assert float(point[quantity]) == pytest.approx(expected[quantity], abs=ORBITS * ratio)
        error = abs(expected["max_height"] / highest - 1)
        assert float(point.relative_error) == pytest.approx(error, abs=ORBITS * ratio)
    threshold = float(data.error_threshold)
    zeta = independent.restitution_to_damping(r)
    assert error_of_the_height(threshold, r, zeta) == pytest.approx(given["tolerance"], abs=1e-9)
    assert data.threshold_status == "found"


def error_of_the_height(ratio, r, zeta):
    """The error of the height for n = 1 and Λ = 1, from an orbit of the closed form."""
    half = np.pi / ratio / np.sqrt(1 - zeta**2)
    x = np.pi * (1 - r) / (1 + r)
    highest = np.sqrt(1 - x**2) + np.pi**2 / 2

    def excess(duration):
        return independent.orbit(1, ratio, zeta, "displacement", duration)[0] - 1

    durations = independent.roots(excess, half * np.linspace(0.97, 1.03, 61))
    orbits = [independent.orbit(1, ratio, zeta, "displacement", duration) for duration in durations]
    (y,) = (orbit for orbit in orbits if 0 < orbit[1] < np.pi / 2 and orbit[2] < 0)
    moved = independent.cycle(ratio, zeta, "displacement", y[0], y[1], y[2])
    return abs(moved.greatest_height() / highest - 1)


def test_each_threshold_is_the_last_crossing_of_its_error_and_of_its_tolerance():
    ratios = {"min": 1.0, "max": 1e4, "samples": 13}
    changes = {"frequency_ratio": ratios, "tolerances": [0.1, 0.01]}
    given = registered("error_thresholds", "thresholds", **changes)
    data = error_thresholds.STAGE["thresholds"](given, "displacement")
    assert data.quantity.values.tolist() == given["quantities"]
    thresholds = data.error_threshold.where(data.threshold_status == "found")
    assert int(thresholds.notnull().sum()) > 10
    beyond = data.relative_error > data.tolerance
    last = data.frequency_ratio.where(beyond).max("frequency_ratio")
    # It lies between the last ratio of the scan at which the error is too large and the next one.
    step = 1e4 ** (1 / 12)
    inside = (thresholds >= last) & (thresholds <= last * step)
    assert inside.where(thresholds.notnull(), True).all()
    # The error is within the tolerance everywhere without such a ratio.
    assert ((data.threshold_status == "within") == last.isnull()).all()
    zeta = independent.restitution_to_damping(given["restitution"])
    resting = thresholds.sel(quantity="permanent_contact").dropna("tolerance")
    at = threshold_of_permanent_contact(resting.values, zeta, "displacement")
    assert abs(at - 1) == pytest.approx(resting.tolerance.values)
    height = float(thresholds.sel({"quantity": "max_height", "tolerance": 0.01}))
    assert height == pytest.approx(float(reference()["fig14"].error_threshold), rel=1e-9)


# Motions over a cycle


@pytest.mark.parametrize("release", RELEASES)
def test_the_cycle_of_figure_7_is_that_of_the_integrated_motion(release):
    given = {"n": 2, "restitution": 0.65, "amplitude": 1.8, "frequency_ratio": 20.0}
    data = time_histories.STAGE["fig07"](given | {"samples": 800}, release)
    zeta = independent.restitution_to_damping(0.65, release)
    state = float(data.phase), float(data.impact_velocity)
    moved = independent.cycle(20.0, zeta, release, 1.8, *state)
    assert moved.time == pytest.approx(4 * np.pi, abs=1e-9)
    assert data.time.values[-1] == pytest.approx(4 * np.pi)
    assert int(data.contact.sum()) == 400
    # The first half of the samples of both are in contact, at equal steps.
    assert data.time.values[:400] == pytest.approx(moved.times[:400], abs=1e-9)
    assert data.ball.values[:400] == pytest.approx(moved.heights[:400], abs=1e-9)
    assert data.ball_velocity.values[:400] == pytest.approx(moved.velocities[:400], abs=1e-8)
    flown = data.time.values[400:] - moved.contact.duration
    fall = moved.heights[400] + moved.bounce * flown - flown**2 / 2
    assert data.ball.values[400:] == pytest.approx(fall, abs=1e-8)
    assert data.ball[-1] == pytest.approx(float(data.ball[0]), abs=1e-8)


@pytest.mark.parametrize("release", RELEASES)
def test_depth_and_rise_of_the_table_are_the_difference_of_the_heights(release):
    """The terms are those of an integrated contact, whose flights meet at the centroid with the
    velocities of the restitution model, and no other term is left.
    """
    places = [(0.65, 1.0, 5.0), (0.65, 0.6667, 100.0), (0.2, 2.2, 30.0), (0.65, 3.0, 5.0)]
    names = ("restitution", "amplitude", "frequency_ratio")
    given = [dict(zip(names, place, strict=True)) for place in places]
    data = time_histories.STAGE["impact_instant"]({"n": 1, "cases": given, "samples": 401}, release)
    higher = data.summit - data.restitution_max_height
    assert (data.depth + data.table_rise).values == pytest.approx(higher.values, abs=1e-12)
    outside = data.time.where((data.time < data.touch) | (data.time > data.release))
    assert outside.notnull().sum("sample").values.tolist() == [200] * len(places)
    apart = (data.ball - data.instant_ball).where(outside.notnull())
    assert abs(apart).max().item() < 1e-12
    for k, (r, amplitude, ratio) in enumerate(places):
        case = data.isel(case=k)
        rigid = np.arccos(np.pi * (1 - r) / (1 + r) / amplitude)
        phase = rigid + float(case.touch)
        zeta = independent.restitution_to_damping(r, release)
        velocity = -np.pi + float(case.centroid - case.touch)
        moved = independent.cycle(ratio, zeta, release, amplitude, phase, velocity)
        since = moved.contact.centroid(zeta)
        assert moved.time == pytest.approx(2 * np.pi, abs=1e-8)
        assert float(case.centroid - case.touch) == pytest.approx(since, abs=1e-7)
        before = moved.contact.duration - since
        assert moved.bounce + before == pytest.approx(np.pi, abs=1e-7)
        turn = moved.heights[400] - moved.bounce * before - before**2 / 2
        there = amplitude * np.sin(phase + since)
        assert float(case.depth) == pytest.approx(turn - there, abs=1e-6)
        assert float(case.table_rise) == pytest.approx(there - amplitude * np.sin(rigid), abs=1e-6)
        assert case.force.sum() > 0 and float(case.force[0]) == float(case.force[-1]) == 0


def test_the_heights_of_figure_12_are_those_of_the_closed_form_with_both_ends_of_each_contact():
    given = registered("time_histories", "fig12", samples=101)
    data = time_histories.STAGE["fig12"](given, "displacement")
    zeta = independent.restitution_to_damping(given["restitution"])
    for one in (data.sel(frequency_ratio=ratio) for ratio in given["frequency_ratio"]):
        ratio, phase, duration = (
            float(one[name]) for name in ("frequency_ratio", "phase", "contact_duration")
        )
        touching = one.contact.values
        during = one.table_phase.values[touching]
        assert (during[0], during[-1]) == pytest.approx((phase, phase + duration), abs=1e-12)
        y = independent.orbit(1, ratio, zeta, "displacement", duration)
        state = (given["amplitude"], phase, float(one.impact_velocity))
        assert y[:3] == pytest.approx(state, abs=1e-8)
        times = np.append(during - phase, duration)
        states = independent.transfer(ratio, zeta, times) @ start_of(y)
        heights = states[:, 0] / ratio + states[:, 2]
        assert one.ball.values[touching] == pytest.approx(heights[:-1], abs=1e-8)
        flown = (one.table_phase.values[~touching] - phase) % (2 * np.pi) - duration
        bounce = states[-1, 1] + states[-1, 3]
        fall = heights[-1] + bounce * flown - flown**2 / 2
        assert one.ball.values[~touching] == pytest.approx(fall, abs=1e-8)
    start = float(data.restitution_phase)
    flown = (data.table_phase.values - start) % (2 * np.pi)
    fall = given["amplitude"] * np.sin(start) + np.pi * flown - flown**2 / 2
    assert data.restitution_ball.values == pytest.approx(fall, abs=1e-12)


# The printed numbers under hypotheses


NUMBERS = printed_numbers


@pytest.fixture(scope="module")
def hypotheses():
    """The printed numbers under each hypothesis, computed from what is printed."""
    return NUMBERS.STAGE["hypotheses"]({})


@pytest.mark.parametrize(
    ("hypothesis", "release"),
    [("equations as they stand", "displacement"), ("force release", "force")],
)
def test_a_hypothesis_has_the_bifurcations_of_its_release(hypotheses, hypothesis, release):
    zeta = independent.restitution_to_damping(0.85)
    numbers = hypotheses.found.sel(hypothesis=hypothesis)
    for n in (1, 2):
        for ratio in (10.0, 2.0):
            expected = end_of_range(n, ratio, zeta, release, "saddle-node")[0]
            end = numbers.sel(number=f"Table 1: {ratio:g}, {n}, saddle-node")
            assert float(end) == pytest.approx(expected, abs=1e-9)


def test_the_numbers_of_a_hypothesis_are_those_of_its_contact(hypotheses):
    """The equations as they stand, and damping to first order by orbits of the closed form."""
    every = [*claims.CLAIMS, *claims.table1_ends()]
    printed = {claim.name: claim.printed for claim in every if claim.printed}
    # A claim of one's own may have a printed number that no hypothesis is asked for.
    assert hypotheses.printed_text.to_series().to_dict().items() <= printed.items()
    judged = reference()["claims"].set_index(claim="claim")
    plain = hypotheses.sel(hypothesis="equations as they stand")
    for name in hypotheses.number.values:
        number = float(judged.found.sel(claim=name))
        assert float(plain.found.sel(number=name)) == pytest.approx(number, rel=1e-8)
        # Its row of Table 1, which its name has as text.
        row = float(hypotheses.row.sel(number=name))
        assert np.isnan(row) or name.startswith(f"Table 1: {row:g},")
    assert int(hypotheses.row.notnull().sum()) == len(claims.table1_ends())

    r = NUMBERS.R_OF_THRESHOLDS
    zeta = -np.log(r) / np.pi
    first = hypotheses.found.sel(hypothesis="damping to first order")
    threshold = float(first.sel(number="height threshold"))
    assert error_of_the_height(threshold, r, zeta) == pytest.approx(0.01, abs=1e-9)


def test_hypotheses_are_in_the_order_of_the_numbers_that_they_reproduce(hypotheses):
    printed = hypotheses.printed_text.values
    for k in range(hypotheses.sizes["hypothesis"]):
        line = hypotheses.isel(hypothesis=k)
        pairs = zip(line.found.values, printed, strict=True)
        verdicts = [against_print(number, text).verdict for number, text in pairs]
        assert int(line.reproduced) == verdicts.count("reproduced")
        assert (line.agrees == [verdict == "reproduced" for verdict in verdicts]).all()
    assert (hypotheses.reproduced.diff("hypothesis") <= 0).all()


def test_the_counts_of_the_hypotheses_follow_from_their_distances(hypotheses):
    units = hypotheses.deviation_units
    compliant = abs(units[:, hypotheses.row.isin([10.0, 2.0]).values])
    assert (hypotheses.compliant_reproduced == (compliant <= 0.5).sum("number")).all()
    assert hypotheses.largest_difference.values == pytest.approx(compliant.max("number").values)
    assert hypotheses.rms_difference.values == pytest.approx(
        np.sqrt((compliant**2).mean("number")).values
    )
    nodes = hypotheses.number.str.endswith("saddle-node").values
    plain = units.sel(hypothesis="equations as they stand")
    assert int(hypotheses.below_orbits) == int((plain[nodes] > 0.5).sum())
    # The stiffest row is computed with the largest ϖ that is likely, 10⁴.
    stiff = hypotheses.agrees.sel(hypothesis="high-bounce stability of the stiff row")
    count = int(stiff[(hypotheses.row == 1e4).values].sum())
    assert int(hypotheses.stiff_reproduced.sel(exponent=[4])[0]) == count == 6


def test_the_damping_of_82_has_thresholds_that_round_to_it(hypotheses):
    for zeta, ratio in zip(hypotheses.damping_of_82.values, (81.5, 82.5), strict=True):
        height = error_of_the_height(ratio, NUMBERS.R_OF_THRESHOLDS, zeta)
        assert height == pytest.approx(0.01, abs=1e-9)


# The names of quantities


def test_the_quantities_of_the_configuration_are_those_that_are_computed_and_named():
    schema = yaml.safe_load((ROOT / "config/schema.yaml").read_text("utf-8"))
    given = schema["properties"]["error_thresholds"]["properties"]["thresholds"]["properties"]
    allowed = given["quantities"]["items"]["enum"]
    of_orbits = schema["properties"]["validity"]["properties"]["regimes"]["properties"]["quantity"]
    assert of_orbits["enum"] == [*errors.COMPARED]
    by_quantity = errors.errors(allowed, 1, 0.65, 1.0, np.array([50.0, 100.0]), "displacement")
    assert [*by_quantity] == allowed
    assert {*allowed, *errors.COMPARED} == {*QUANTITIES}


# Where a frequency ratio is enough


MAP = CONFIG["validity"]["validity_map"]


def few(**changed):
    """Parameters of the validity map with few orbits."""
    small = {"restitution": {"min": 0.05, "max": 0.95, "samples": 7}, "places": 6}
    return MAP | small | changed


def test_the_failures_of_known_errors():
    """One quantity exceeds 0.01 below a line in r and √place, another one has an unknown error."""
    r = np.linspace(0.1, 0.8, 15)
    place = np.linspace(0, 1, 26) ** 3
    log = np.log(r)[:, np.newaxis]
    one = -0.01 * (1 - log + np.log(0.3) - np.sqrt(place))
    errors = np.stack([one, one + 0.02])[:, np.newaxis, ..., np.newaxis] * [1.0, 0.5]
    errors[1, 0, 3, 2, 1] = np.nan
    failures = validity.failures
    share, mean, up_to, largest = failures(errors, r, place, np.ones((1, r.size)), 0.01)
    # |error| > 0.01 where √place < ln(0.3/r): up to r = 0.3 for the place 0.
    assert up_to[0, 0] == pytest.approx(0.3, abs=1e-5)
    exact = np.minimum(np.maximum(np.log(0.3 / r), 0) ** 2, 1)
    assert share[0, 0] == pytest.approx(exact, abs=1e-4)
    # The integral of ln²(0.3/r) from 0.3/e to 0.3, and 1 below.
    assert mean[0, 0] == pytest.approx((0.3 * (2 - 5 / np.e) + 0.3 / np.e - 0.1) / 0.7, abs=1e-4)
    assert largest[0, 0] == pytest.approx(0.01 * (1 + np.log(3)), rel=1e-9)
    for measure in (share, mean, up_to, largest):
        assert np.isnan(measure[1]).all()
    # Stability ends at the place 0.1 below r = 0.3/e, where every place failed.
    share, mean, _, _ = failures(errors[:1], r, place, np.full((1, r.size), 0.1), 0.01)
    assert share[0, 0] == pytest.approx(np.minimum(exact, 0.1), abs=1e-4)
    assert mean[0, 0] == pytest.approx(np.trapezoid(np.minimum(exact, 0.1), r) / 0.7, abs=3e-4)


@pytest.mark.parametrize("most", [1.0, 0.4, np.inf])
def test_the_mean_of_shares_is_their_integral_over_r(most):
    r = np.linspace(0.2, 1.2, 11)
    values = 6 * (r - 0.3) * (r - 0.8) * (r - 1.3)
    # A cubic spline through values of a cubic polynomial is the polynomial.
    fine = np.linspace(0.2, 1.2, 100_001)
    cut = np.clip(6 * (fine - 0.3) * (fine - 0.8) * (fine - 1.3), 0, most)
    mean = validity.mean_share(r, 10 * values, 10 * most) / 10
    assert mean == pytest.approx(np.trapezoid(cut, fine), abs=1e-8) and mean > 0
    assert np.isnan(validity.mean_share(r, np.where(r > 1, np.nan, values), most))


def test_the_shares_of_the_validity_map_are_those_of_its_errors():
    data = validity.validity_map(few(), "displacement")
    fails = (data.stiff_error.where(data.stable) > 0.01).any("place")
    assert (data.failing_share > 0).where(fails, True).all()
    inside = data.stiff_error.where(data.stable).max(["restitution", "place"])
    every = data.stiff_error.max(["restitution", "place"])
    assert (inside <= data.largest_error).all() and (data.largest_error < every * 1.001).all()
    # At the advised ratio or above an error exceeds the tolerance if more than it is needed.
    clear = abs(data.stiff_error - 0.01) > 1e-6
    assert ((data.stiff_error > 0.01) == (data.enough_from > 100)).where(clear, True).all()
    assert (data.not_reached == 0).all()


def test_orbits_that_need_more_than_the_scan_are_counted_and_have_no_answer():
    given = few(frequency_ratio={"min": 10.0, "max": 1000.0, "samples": 21})
    data = validity.validity_map(given, "displacement")
    absent = data.enough_from.isnull().sum(["restitution", "place"])
    assert (data.not_reached == absent).all()
    # The height of the 1-T orbits beside their saddle-nodes, at small r.
    assert int(data.not_reached.sel(quantity="summit", n=1)) > 0
    assert float(data.enough_from.sel(n=3).max()) < 1000


def test_the_map_of_the_force_release_has_the_restitutions_of_its_contacts():
    given = few(n=[1], restitution={"min": 0.05, "max": 0.95, "samples": 16})
    data = validity.validity_map(given, "force")
    assert data.restitution.min() > np.exp(-2) and data.sizes["restitution"] == 14
    assert not data.failing_mean.isnull().any() and not data.doubled_mean.isnull().any()
    # Known from another code.
    assert data.failing_up_to.sel(quantity="summit").item() == pytest.approx(0.53, abs=0.01)
    with pytest.raises(NoOrbit, match=r"restitution = .*0\.1353"):
        validity.validity_map(few(restitution={"min": 0.05, "max": 0.1, "samples": 7}), "force")


ANOTHER_CODE = {
    "summit": ((0.953, 0.079, 0), (5.974, 1.855, 0.902), (0.5497, 0.2383, 0)),
    "bounce_velocity": ((11.75, 0, 0), (1.322, 0.659, 0.439), (0.1602, 0, 0)),
    "apparent_restitution": (
        (3.715, 0.932, 0.240),
        (4.046, 2.077, 1.419),
        (0.1533, 0.0865, 0.0656),
    ),
    "phase_in_periods": ((0.202, 0.0005, 0), (1.691, 1.063, 0.784), (0.95, 0.1666, 0)),
}
"""For n = 1, 2, 3: the mean share of orbits that fail, in per cent, their largest error, in per
cent, and their largest r. The code follows each orbit by its duration, and finds bifurcations and
crossings as roots. It has a step of r of 0.0025, at which a share of 1 may end.
"""


@pytest.mark.parametrize("quantity", ANOTHER_CODE)
def test_the_numbers_of_the_map_are_those_of_another_code(quantity):
    map_ = reference()["validity_map"]
    at = map_.sel(quantity=quantity)
    shares, largest, up_to = ANOTHER_CODE[quantity]
    off = 0.01 if quantity == "bounce_velocity" else 1e-3
    assert 100 * at.failing_mean.values == pytest.approx(shares, abs=off)
    assert 100 * at.largest_error.values == pytest.approx(largest, abs=1e-3)
    assert at.failing_up_to.values == pytest.approx(up_to, abs=1e-4)
    assert 100 * map_.doubled_mean.values == pytest.approx([1.083, 2.606, 4.054], abs=1e-3)
    assert 100 * map_.below_mean.values == pytest.approx([1.652, 2.957, 4.306], abs=1e-3)


@pytest.mark.parametrize("quantity", errors.COMPARED)
@pytest.mark.parametrize("release", RELEASES)
def test_the_regimes_of_a_ball_are_those_of_each_orbit_alone(release, quantity):
    given = registered("validity", "regimes", places=5, quantity=quantity)
    # The ball of these orbits flies higher than the table is.
    alone = "max_height" if quantity == "summit" else quantity
    data = validity.regimes(given, release)
    ratios = data.frequency_ratio.values
    for k in (1, 2, 3):
        at = float(data.amplitude[k])
        error = errors.errors([alone], 1, 0.65, at, ratios, release)[alone]
        enough = errors.threshold(ratios, error, 0.01)
        assert float(data.enough_from[k]) == pytest.approx(float(enough.ratio), rel=1e-9)
    zeta = independent.restitution_to_damping(0.65, release)
    near = data.sel(frequency_ratio=10, method="nearest")
    ratio = float(near.frequency_ratio)
    for kind in FORMS:
        name = kind.replace("-", "_").replace(" ", "_") + "_amplitude"
        end = end_of_range(1, ratio, zeta, release, kind)[0]
        assert float(near[name]) == pytest.approx(end, rel=1e-8)


@pytest.mark.parametrize(("n", "r"), [(1, 0.05), (1, 0.6), (3, 0.05), (3, 0.95)])
def test_below_the_saddle_node_of_the_simple_model_a_stiff_contact_has_a_stable_orbit(n, r):
    """The motion that is integrated from it repeats itself, with a clear flight."""
    zeta = independent.restitution_to_damping(r)
    half = np.pi / 100 / np.sqrt(1 - zeta**2)
    node = end_of_range(n, 100.0, zeta, "displacement", "saddle-node")
    x = n * np.pi * (1 - r) / (1 + r)
    amplitude = (node[0] + x) / 2
    if (n, r) == (3, 0.05):
        assert (node[0], x) == pytest.approx((8.50199, 8.52718), abs=5e-6)
    (duration,) = independent.roots(
        lambda duration: independent.orbit(n, 100.0, zeta, "displacement", duration)[0] - amplitude,
        np.linspace(0.9 * half, node[3] / 100, 400),
    )[-1:]
    y = independent.orbit(n, 100.0, zeta, "displacement", duration)
    assert min(independent.test_functions(n, 100.0, zeta, "displacement", duration)) > 0
    moved = independent.cycle(100.0, zeta, "displacement", amplitude, y[1], y[2])
    assert moved.time == pytest.approx(2 * np.pi * n, abs=1e-9)
    assert moved.velocity == pytest.approx(y[2], abs=1e-9)
