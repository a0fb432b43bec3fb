"""Errors and thresholds against formulas, a dense scan and orbits of the closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar
from tests import independent

from bouncing_ball import errors, restitution
from bouncing_ball.errors import Error
from bouncing_ball.orbits import Family, NoOrbit
from bouncing_ball.spring_damper import (
    RELEASES,
    Contact,
    damping_ratio,
    free_duration,
    permanent_contact_ratios,
)

RATIOS = np.geomspace(1, 1e3, 61)


def test_a_threshold_is_the_last_crossing_of_the_tolerance():
    # Three crossings of 0.1: at 2, 5 and 20.
    def error(ratio):
        return 0.1 + 1e-3 * (2 - ratio) * (5 - ratio) * (20 - ratio) / ratio**2

    grid = np.linspace(1.3, 31.3, 31)
    threshold = errors.threshold(
        grid, Error(error(grid), lambda ratio, below, curve: error(ratio)), 0.1
    )
    assert threshold.status == "found"
    assert threshold.ratio == pytest.approx(20, rel=1e-12)
    # A ratio at which the error is the tolerance is within it.
    exact = Error(1 / grid, lambda ratio, below, curve: 1 / ratio)
    assert errors.threshold(grid, exact, 1 / grid[10]).ratio == pytest.approx(grid[10], rel=1e-12)


def test_a_threshold_outside_of_the_scan_has_a_status():
    grid = np.array([1.0, 2.0, 3.0])

    def status(*values):
        threshold = errors.threshold(grid, Error(np.array(values), None), 0.1)
        assert np.isnan(threshold.ratio)
        return threshold.status

    assert status(0.1, 0.05, 0.02) == "within"
    assert status(0.01, 0.05, 0.2) == "exceeded"
    # Without an orbit there is no threshold to be located next to it.
    assert status(np.inf, np.inf, 0.02) == "first orbit"
    assert status(0.01, np.nan, 0.02) == "first orbit"
    assert status(0.01, 0.05, np.inf) == "no orbit"


def test_the_threshold_of_permanent_contact_is_that_of_equation_34():
    zeta = float(damping_ratio(0.65))
    error = errors.permanent_contact_error(RATIOS, zeta, "displacement")
    threshold = errors.threshold(RATIOS, error, 0.01)
    expected = permanent_contact_ratios(0.99, zeta)[1]
    assert round(expected, 4) == 9.8118
    # The error is the difference of two numbers near 1, and falls with the square of ϖ.
    assert threshold.ratio == pytest.approx(expected, rel=1e-12)
    forced = errors.threshold(
        RATIOS, errors.permanent_contact_error(RATIOS, zeta, "force"), 0.01
    ).ratio
    amplitude = np.hypot(forced**2 - 1, 2 * zeta * forced) / np.hypot(forced**2, 2 * zeta * forced)
    assert amplitude == pytest.approx(0.99, rel=1e-12)


def stable_orbit(n, r, amplitude, ratio, release):
    """The stable orbit of the closed form, between the first period doubling and saddle-node."""
    zeta = independent.restitution_to_damping(r, release)
    angles = np.linspace(2.4, 4.5, 40)

    def bifurcation(k, grid):
        return independent.roots(
            lambda angle: independent.test_functions(n, ratio, zeta, release, angle / ratio)[k],
            grid,
        )[0]

    doubling = bifurcation(1, angles)
    fold = bifurcation(0, np.append(doubling, angles[angles > doubling]))
    (angle,) = independent.roots(
        lambda angle: independent.orbit(n, ratio, zeta, release, angle / ratio)[0] - amplitude,
        np.array([doubling, fold]),
    )
    return independent.orbit(n, ratio, zeta, release, angle / ratio)


def quantities(n, r, amplitude, ratio, release):
    """Errors from an orbit of the closed form, and its flight."""
    y = stable_orbit(n, r, amplitude, ratio, release)
    zeta = independent.restitution_to_damping(r, release)
    x = y[0] * np.cos(y[1])
    start = [0, y[2] - x, y[0] * np.sin(y[1]), x, 1]
    gap, rate, table, speed, _ = independent.transfer(ratio, zeta, y[3] / ratio) @ start
    bounce = rate + speed
    phase = np.arccos(n * np.pi * (1 - r) / (1 + r) / amplitude)
    height = amplitude * np.sin(phase) + (n * np.pi) ** 2 / 2
    return {
        "max_height": abs(gap / ratio + table + bounce**2 / 2 - height) / height,
        "bounce_velocity": abs(bounce / (n * np.pi) - 1),
        "phase_in_periods": abs(y[1] - phase) / (2 * np.pi),
        "apparent_restitution": abs(-rate / start[1] / r - 1),
    }


# The quantities, and their thresholds of 1 % for n = 1, r = 0.65 and Λ = 1 as they are known.
KNOWN = {
    "max_height": 82.177,
    "bounce_velocity": 61.22,
    "phase_in_periods": 18.05,
    "apparent_restitution": 4.78,
    "saddle_node": 59.87,
    "period_doubling": 13.75,
}


@pytest.fixture(scope="module")
def known_errors():
    names = [*KNOWN, "permanent_contact"]
    by_quantity = errors.errors(names, 1, 0.65, 1.0, RATIOS, "displacement")
    assert list(by_quantity) == names
    return by_quantity


@pytest.mark.parametrize("name", KNOWN)
def test_known_thresholds(known_errors, name):
    threshold = errors.threshold(RATIOS, known_errors[name], 0.01)
    digits = len(f"{KNOWN[name]}".partition(".")[2])
    assert round(threshold.ratio, digits) == KNOWN[name]
    assert threshold.status == "found"
    if name in ("saddle_node", "period_doubling"):
        zeta = independent.restitution_to_damping(0.65)
        k = ("saddle_node", "period_doubling").index(name)
        (angle,) = independent.roots(
            lambda angle: independent.test_functions(
                1, threshold.ratio, zeta, "displacement", angle / threshold.ratio
            )[k],
            np.linspace(2.9, 3.4, 50),
        )
        amplitude = independent.orbit(
            1, threshold.ratio, zeta, "displacement", angle / threshold.ratio
        )[0]
        limit = {
            "saddle_node": restitution.saddle_node(1, 0.65),
            "period_doubling": restitution.period_doubling(1, 0.65),
        }
        error = abs(amplitude / limit[name] - 1)
    else:
        error = quantities(1, 0.65, 1.0, threshold.ratio, "displacement")[name]
    # The corrector's tolerance of 1e-11 in Λ is one of some ϖ in the error times 1e-11.
    assert error == pytest.approx(0.01, rel=1e-7)


def test_permanent_contact_needs_no_orbit():
    # There is no orbit with this amplitude.
    by_quantity = errors.errors(["permanent_contact"], 1, 0.65, 0.1, RATIOS, "displacement")
    assert list(by_quantity) == ["permanent_contact"]


@pytest.mark.parametrize("release", RELEASES)
def test_a_dense_scan_has_the_same_errors_and_threshold(release):
    n, r, amplitude = 2, 0.85, 1.0
    coarse = np.geomspace(20, 200, 5)
    by_quantity = errors.errors(list(KNOWN)[:4], n, r, amplitude, coarse, release)
    expected = {
        ratio: quantities(n, r, amplitude, ratio, release) for ratio in np.geomspace(20, 200, 17)
    }
    for name, error in by_quantity.items():
        for i, ratio in enumerate(coarse):
            # The errors are differences of numbers that are known to 1e-11 times ϖ.
            assert error.values[i] == pytest.approx(expected[ratio][name], abs=1e-8)
        for k, ratio in enumerate(expected):
            if k % 4:
                assert error.between(ratio, k // 4, 0) == pytest.approx(
                    expected[ratio][name], abs=1e-8
                )
    scan = list(expected)
    threshold = errors.threshold(coarse, by_quantity["max_height"], 0.01).ratio
    # The same root by a method for one curve, in the interval that the scan encloses.
    below = int(np.flatnonzero(by_quantity["max_height"].values > 0.01)[-1])

    def excess(ratio):
        return float(by_quantity["max_height"].between(ratio, below, 0)) - 0.01

    # The orbits are known to about 1e-12.
    assert threshold == pytest.approx(brentq(excess, *coarse[below : below + 2]), rel=1e-10)
    outside = [expected[ratio]["max_height"] > 0.01 for ratio in scan]
    assert outside == sorted(outside, reverse=True)
    assert scan[sum(outside) - 1] < threshold < scan[sum(outside)]


@pytest.mark.parametrize(
    ("n", "r", "amplitude", "ratio", "release", "message"),
    [
        # A stroke of 1.5 mm at 30 Hz, a contact of 2 ms: above the period doubling.
        (1, 0.8, 2.717, 7.96, "force", r"from 0.349066 to 1.07084 \(Eqs. 7 and R1\); those with ϖ"),
        # Below the saddle-node; a compliant contact may have no range.
        (3, 0.05, 8.515, 100.0, "displacement", "to 8.71895 .* ϖ = 100 need 8.50199 to 8.6949"),
        (1, 0.65, 0.6, 0.5, "displacement", r"from 0.666398 to 1.2394 \(Eqs. 7 and R1\)$"),
        # Stable in the restitution model only: the contact has doubled its period.
        (1, 0.65, 1.239, 100.0, "force", "to 1.2394 .* ϖ = 100 need 0.662677 to 1.23761$"),
        (1, 0.1, 2.6, 100.0, "force", "r = 0.1: with the force release, r must be above e⁻²"),
    ],
)
def test_without_a_stable_orbit_the_error_is_one_line(n, r, amplitude, ratio, release, message):
    with pytest.raises(NoOrbit, match=message) as raised:
        errors.errors(["max_height"], n, r, amplitude, np.array([ratio]), release)
    assert "\n" not in str(raised.value)


def test_an_error_is_infinite_where_the_contact_has_no_stable_orbit():
    """At ϖ = 100 the period has doubled at Λ = 1.2375, on the stiffer contact at 1.2394."""
    ratios = np.array([100.0, 1e4])
    by_quantity = errors.errors(
        ["max_height", "phase_in_periods"], 1, 0.65, 1.239, ratios, "displacement"
    )
    for error in by_quantity.values():
        assert np.isinf(error.values[0]) and error.values[1] < 1e-4
        assert error.admissible.tolist() == [False, True]
    with pytest.raises(NoOrbit):
        errors.errors(["max_height"], 1, 0.65, restitution.saddle_node(1, 0.65), 100, "force")


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("ratio", [3.0, 4.0, 10.0, 100.0, 1000.0])
def test_the_error_by_hand_is_that_of_the_stable_orbits_of_its_domain(release, ratio):
    """docs/your-ball.md: r ≥ 0.5, n ≤ 6, ϖ ≥ 3, positions from 0.1 to 1 - 1.1 n/ϖ."""
    sizes = [1, 2, 3, 4, 5, 6]
    parts = np.linspace(0, 1, 7)
    n, r, part = (grid.reshape(-1, 1) for grid in np.meshgrid(sizes, 0.5 + 0.499 * parts, parts))
    last = 1 - 1.1 * n / ratio
    n, r, part, last = (column[last > 0.1].reshape(-1, 1) for column in (n, r, part, last))
    x = restitution.saddle_node(n, r)
    position = 0.1 + part * (last - 0.1)
    amplitude = x + position * (restitution.period_doubling(n, r) - x)
    family = Family(n, Contact.of_restitution([ratio], r, release))
    y = errors.orbits_along(family, amplitude)
    assert restitution.is_stable(*family.trace_and_determinant(y)).all()
    assert (family.clearance(y) > 0).all()
    size = (family.max_height(y) / restitution.max_height(n, r, amplitude) - 1) * n * ratio
    assert y.size and -1 <= size.min() and size.max() <= -0.58


@pytest.mark.parametrize(("release", "least"), [("displacement", 0.05), ("force", 0.14)])
def test_contacts_on_stiff_orbits_last_as_long_as_free_impacts(release, least):
    """Within 0.7 % at ϖ = 100, as docs/your-ball.md says beside its formula for a duration."""
    mesh = np.meshgrid([1, 2, 3], np.linspace(least, 0.95, 7), [0, 0.01, 0.3, 1], indexing="ij")
    n, r, place = (grid.reshape(-1, 1) for grid in mesh)
    first = restitution.saddle_node(n, r)
    amplitude = first + place * (restitution.period_doubling(n, r) - first)
    zeta = damping_ratio(r, release)
    family = Family(n, Contact(np.array([100.0]), zeta, release))
    lasting = errors.orbits_along(family, amplitude)[3] / free_duration(zeta, release)
    assert 0.005 < np.abs(lasting - 1).max() < 0.007


@pytest.mark.parametrize("n", [1, 3])
def test_the_error_of_the_height_of_elastic_impacts_is_that_of_half_a_contact(n):
    """As r tends to 1, n ϖ times the error tends to 1/(1 + 2Λ sin φ/(nπ)²)."""
    r = 1 - 1e-5
    amplitude = 0.5
    impact_height = amplitude * np.sin(restitution.impact_phase(n, r, amplitude))
    ratios = np.array([1e3, 2e3])
    error = errors.errors(["max_height"], n, r, amplitude, ratios, "displacement")["max_height"]
    first, second = n * ratios * error.values
    # Extrapolation takes the next order in 1/ϖ away, and leaves 1 - r and the square, 1e-6.
    expected = 1 / (1 + 2 * impact_height / (n * np.pi) ** 2)
    assert 2 * second - first == pytest.approx(expected, abs=2e-5)


def test_the_lowest_period_doublings():
    ratios = np.geomspace(2, 100, 41)
    r = 0.85
    ratios_at_lowest, amplitudes = errors.lowest_period_doublings(
        [1, 2, 3], r, ratios, "displacement"
    )
    np.testing.assert_allclose(ratios_at_lowest, [15.01, 8.14, 6.65], atol=0.005)
    zeta = independent.restitution_to_damping(r)

    def doubling(logarithm, n):
        ratio = np.exp(logarithm)
        angle = brentq(
            lambda angle: independent.test_functions(n, ratio, zeta, "displacement", angle / ratio)[
                1
            ],
            3.12,
            3.155,
            xtol=1e-15,
        )
        return independent.orbit(n, ratio, zeta, "displacement", angle / ratio)[0]

    for n, ratio, amplitude in zip((1, 2, 3), ratios_at_lowest, amplitudes, strict=True):
        near = np.log(ratio)
        best = minimize_scalar(
            lambda x, n=n: doubling(x, n),
            bounds=(near - 0.1, near + 0.1),
            method="bounded",
            options={"xatol": 1e-8},
        )
        # The minimum is as exact as the amplitudes, its place half as exact.
        assert amplitude == pytest.approx(best.fun, rel=1e-11)
        assert near == pytest.approx(best.x, abs=1e-4)


# Its lowest place, near ϖ = 15, is beyond either end, or next to a ϖ without a period doubling.
@pytest.mark.parametrize("ratios", [(100, 300, 1000), (2, 3, 5), (0.3, 10, 1000)])
def test_a_period_doubling_that_is_lowest_at_an_end_has_no_lowest_place(ratios):
    ratios = np.array(ratios, dtype=float)
    place, amplitude = errors.lowest_period_doublings([1], 0.85, ratios, "displacement")
    assert np.isnan(place).all()
    assert np.isnan(amplitude).all()


NODES = {
    # n, r, and the place of Λ between saddle-node and period doubling
    "at the saddle-node": (1, 0.05, 0.0),
    "beside the saddle-node": (1, 0.31, 0.004),
    "in the middle": (2, 0.57, 0.5),
    "at the period doubling": (3, 0.83, 1.0),
}


def orbit_at(n, r, place, ratios):
    """A family, its orbits along ϖ and their Λ, as `errors.enough_from` takes them."""
    first = restitution.saddle_node(n, r)
    amplitude = np.array([[first + place * (restitution.period_doubling(n, r) - first)]])
    contact = Contact(ratios, np.array([[damping_ratio(r)]]))
    family = Family(np.array([[n]]), contact)
    return family, errors.orbits_along(family, amplitude), amplitude


def integrated_errors(n, r, amplitude, ratio, y):
    """The errors of the orbit y by an integration with events, and how much it fails to repeat."""
    zeta = independent.restitution_to_damping(r)
    moved = independent.cycle(ratio, zeta, "displacement", amplitude, y[1], y[2])
    x = n * np.pi * (1 - r) / (1 + r)
    impact_height = np.sqrt(max(amplitude**2 - x**2, 0.0))
    deviations = [
        moved.greatest_height() / (impact_height + (n * np.pi) ** 2 / 2) - 1,
        moved.bounce / (n * np.pi) - 1,
        -moved.contact.rate / (y[2] - amplitude * np.cos(y[1])) / r - 1,
        (y[1] - np.arctan2(impact_height, x)) / (2 * np.pi),
    ]
    return np.abs(deviations), max(abs(moved.time - 2 * np.pi * n), abs(moved.velocity - y[2]))


@pytest.mark.parametrize("node", NODES)
def test_the_error_is_the_tolerance_where_it_is_enough_by_integration_and_less_beyond(node):
    n, r, place = NODES[node]
    ratios = np.geomspace(10, 1e4, 31)
    family, orbits, amplitude = orbit_at(n, r, place, ratios)
    enough = errors.enough_from(family, orbits, np.array([[r]]), amplitude, 0.01)[:, 0]
    assert (enough > 10).any()
    for quantity in np.flatnonzero(enough > 10):
        along = enough[quantity] * np.array([0.97, 1.0, 1.03, 10.0])
        y = orbit_at(n, r, place, along)[1][:, 0]
        below, at, above, far = (
            integrated_errors(n, r, float(amplitude[0, 0]), ratio, y[:, k])
            for k, ratio in enumerate(along)
        )
        assert max(repeats for _, repeats in (below, at, above, far)) < 1e-10
        assert at[0][quantity] == pytest.approx(0.01, abs=1e-10)
        assert below[0][quantity] > 0.01 > max(above[0][quantity], far[0][quantity])


def test_an_error_that_is_never_within_the_tolerance_has_no_ratio_from_which_it_is():
    ratios = np.geomspace(10, 1e3, 13)
    family, orbits, amplitude = orbit_at(1, 0.05, 0.0, ratios)
    enough = errors.enough_from(family, orbits, np.array([[0.05]]), amplitude, 0.01)[:, 0]
    # At the saddle-node the height needs a contact stiffer than the stiffest of this scan.
    assert np.isnan(enough[0])
    assert np.isfinite(enough[1:]).all()
    # An orbit that ceases below the first ratio that is enough is no answer either.
    ceased = orbits.copy()
    ceased[..., :6] = np.nan
    lost = errors.enough_from(family, ceased, np.array([[0.05]]), amplitude, 0.9)
    assert np.isnan(lost).all()
    assert (errors.enough_from(family, orbits, np.array([[0.05]]), amplitude, 0.9) == 10).all()


@pytest.mark.parametrize(("n", "r"), [(1, 0.05), (3, 0.5)])
def test_the_summit_of_a_stiff_contact_is_the_greatest_height(n, r):
    family, orbits, _ = orbit_at(n, r, 0.3, np.geomspace(10, 1e3, 5))
    assert family.summit(orbits) == pytest.approx(family.max_height(orbits), rel=1e-14)
