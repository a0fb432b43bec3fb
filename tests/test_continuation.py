"""Continuation against the closed form of a branch, and against limits that are known."""

import numpy as np
import pytest
from tests import independent

from bouncing_ball import continuation, restitution
from bouncing_ball.continuation import MERGES
from bouncing_ball.orbits import OBSERVABLES, Family, NoOrbit
from bouncing_ball.spring_damper import (
    RELEASES,
    Contact,
    damping_ratio,
    free_restitution,
    permanent_contact,
)

# Newton's method ends with a step of less than this, relative to 1 + |y|.
CORRECTOR = 1e-11


def assert_on_closed_form(n, ratio, zeta, release, y):
    """Orbits are those of the closed form with the same durations of the contact.

    On stiff contacts Λ changes by ϖ times the change of θ: the tolerance is the difference that the
    corrector's tolerance makes to the closed form. The phase may differ by turns, and Λ may be
    negative if the phase is turned by half of one. Where the flight vanishes, the landing of the
    closed form is a difference that is small of second order in the flight.
    """
    error = CORRECTOR * (1 + np.abs(y).max())
    after = independent.orbit(n, ratio, zeta, release, (y[3] + error) / ratio)
    before = independent.orbit(n, ratio, zeta, release, (y[3] - error) / ratio)
    expected = independent.orbit(n, ratio, zeta, release, y[3] / ratio)

    def point(orbit):
        return np.stack([orbit[0] * np.cos(orbit[1]), orbit[0] * np.sin(orbit[1]), orbit[2]])

    flight = 2 * np.pi * n - y[3] / ratio
    tolerance = np.abs(point(after) - point(before)) + error + 1e-14 / flight**2
    assert np.all(np.abs(point(y) - point(expected)) < tolerance)


# n, ϖ, r, release, the largest Λ, and the number of points.
BRANCHES = [
    (1, 2.0, 0.85, "displacement", 1.3, 80),
    (2, 10.0, 0.65, "force", 3.0, 40),
    (3, 1e4, 0.85, "displacement", 1.5, 40),
    (1, 1e6, 0.85, "force", 1.3, 40),
    (20, 10.0, 0.85, "displacement", 6.0, 40),
    (1, 10.0, 0.05, "displacement", 4.0, 200),
    (1, 3.0, 0.05, "force", 3.0, 60),
    (1, 10.0, 0.999, "displacement", 1.5, 40),
]


@pytest.mark.parametrize(("n", "ratio", "r", "release", "amplitude_max", "points"), BRANCHES)
def test_a_branch_is_that_of_the_closed_form(n, ratio, r, release, amplitude_max, points):
    zeta = independent.restitution_to_damping(r)
    family = Family(n, Contact(ratio, zeta, release))
    branch = continuation.branch(family, amplitude_max, points)
    y = branch.orbits
    assert y.shape == (4, points)
    assert_on_closed_form(n, ratio, zeta, release, y)
    chords = np.linalg.norm(np.diff(y), axis=0)
    assert np.ptp(chords) < 1e-11 * chords.mean()
    # From the unstable side, with long contacts, to the stable one.
    angles = y[3, ::-1]
    assert np.all(np.diff(angles) > 0)
    assert y[0, -1] == pytest.approx(amplitude_max, rel=CORRECTOR)
    assert branch.ends[1].kind == "largest amplitude"
    if branch.ends[0] == MERGES:
        flight = 2 * np.pi * n - angles[-1] / ratio
        assert flight == pytest.approx(8e-4, rel=1e-6)
    else:
        assert branch.ends[0] == branch.ends[1]
        assert abs(y[0, 0]) == pytest.approx(amplitude_max, rel=CORRECTOR)

    # Every bifurcation, and its kind, from zeros of the test functions along the closed form.
    grid = np.interp(np.arange(0, points - 0.8, 0.25), np.arange(points), angles)
    expected = []
    for k, kind in enumerate(continuation.SPECIAL[:2]):

        def test_function(angle, k=k):
            return independent.test_functions(n, ratio, zeta, release, angle / ratio)[k]

        expected += [(angle, kind) for angle in independent.roots(test_function, grid)]
    expected.sort(reverse=True)
    bifurcations = [special for special in branch.special if special.kind != "grazing"]
    assert [special.kind for special in bifurcations] == [kind for _, kind in expected]
    for special, (angle, _) in zip(bifurcations, expected, strict=True):
        amplitude = independent.orbit(n, ratio, zeta, release, angle / ratio)[0]
        # Test functions have ten digits, and change of Λ with θ does not exceed ϖ.
        assert special.orbit[0] == pytest.approx(amplitude, rel=1e-9)

    for special in branch.special:
        assert_on_closed_form(n, ratio, zeta, release, special.orbit)
        if special.kind == "grazing":
            assert family.clearance(special.orbit) == pytest.approx(0, abs=1e-6)
        # Its place lies between points that are as far from it as the curve bends in a chord.
        place = special.place * (points - 1)
        between = [np.interp(place, np.arange(points), row) for row in y]
        assert np.linalg.norm(between - special.orbit) < 0.2 * chords.mean()
    places = [special.place for special in branch.special]
    assert places == sorted(places)


def test_the_special_points_of_figure_8():
    """At ϖ = 2 the family turns twice and ends where permanent contact does."""
    zeta = damping_ratio(0.85)
    branch = continuation.branch(Family(1, Contact(2.0, zeta)), 1.3, 20)
    points = [(special.kind, round(float(special.orbit[0]), 8)) for special in branch.special]
    # Known from computations with other methods and more digits.
    assert points == [
        ("period doubling", 1.09552888),
        ("period doubling", 1.16252707),
        ("saddle-node", 1.1763248),
        ("saddle-node", 0.18769784),
        ("period doubling", 1.08709592),
    ]
    assert branch.ends[0] == MERGES
    # The amplitude of permanent contact, and the square of the flight that is left.
    end = branch.orbits[0, 0]
    assert round(float(permanent_contact(2.0, zeta)), 6) == 0.751777
    assert 0 < end - permanent_contact(2.0, zeta) < 6.4e-7


LAID = [(0.65, 10.0, 0.9904, 1.1083), (0.85, 10.0, 0.9901, 1.0433), (0.65, 100.0, 0.9999, 1.0013)]
"""r, ϖ, and Λ at the ends of the first range of stable orbits from permanent contact."""


@pytest.mark.parametrize(("r", "ratio", "first", "last"), LAID)
def test_a_ball_near_an_orbit_of_a_long_contact_stays_there(r, ratio, first, last):
    """By an integration that shares nothing; Newton's method finds the same orbit."""
    zeta = independent.restitution_to_damping(r)
    family = Family(1, Contact(ratio, zeta))
    amplitude, duration = continuation.laid_ranges(family, 1.3)[0]
    assert amplitude.round(4).tolist() == [first, last]
    y = family.of_duration(np.array([duration.mean()]))
    again = continuation.correct(family, y * (1 + 1e-4), continuation.at_amplitude(y[0]))
    np.testing.assert_allclose(again, y, rtol=1e-7)
    size, phase, velocity = (unknown.item() for unknown in y[:3])
    distances = []
    landing = phase
    speed = velocity + 1e-5
    for _ in range(3):
        cycle = independent.cycle(ratio, zeta, "displacement", size, landing, speed)
        landing += cycle.time
        speed = cycle.velocity
        distances.append(abs(speed - velocity) + abs(np.angle(np.exp(1j * (landing - phase)))))
    # Half of the disturbance.
    assert distances[-1] < 5e-6


def test_a_branch_from_permanent_contact_may_have_no_stable_orbits():
    for n, ratio in [(2, 10.0), (3, 2.0)]:
        contact = Contact.of_restitution(ratio, 0.85)
        assert continuation.laid_ranges(Family(n, contact), 1.5).shape == (0, 2, 2)
    with pytest.raises(ValueError, match="needs the displacement release"):
        continuation.laid_ranges(Family(1, Contact.of_restitution(10.0, 0.65, "force")), 1.5)


@pytest.mark.parametrize(
    ("n", "ratio", "release", "amplitude_max"),
    [(1, 2.0, "displacement", 1.3), (2, 1e4, "displacement", 1.5), (1, 8.0, "force", 1.4)],
)
def test_the_points_of_a_branch_do_not_depend_on_the_steps(n, ratio, release, amplitude_max):
    family = Family(n, Contact(ratio, damping_ratio(0.85), release))
    branch, other = (
        continuation.branch(family, amplitude_max, 60, largest_step) for largest_step in (0.1, 0.5)
    )
    # Chords are equal to 1e-12 of their mean, and so are the points over the whole length.
    np.testing.assert_allclose(branch.orbits, other.orbits, atol=1e-9)
    assert branch.ends == other.ends
    for point, same in zip(branch.special, other.special, strict=True):
        assert point.kind == same.kind
        np.testing.assert_allclose(point.orbit, same.orbit, atol=1e-9)
        assert point.place == pytest.approx(same.place, abs=1e-9)


@pytest.mark.parametrize(
    ("n", "ratio", "expected"),
    [(1, 0.61, 1.99987969629), (2, 2.2260684470825036, 1.04860831), (3, 3.7, None), (1, 1.0, None)],
)
def test_the_period_doubling_of_an_undamped_contact_is_known(n, ratio, expected):
    beside = ratio if ratio != 1 else 1 + 1e-9
    formula = abs(1 - 1 / beside**2) / abs(np.cos(np.pi / (2 * beside)))
    doubling = continuation.bifurcations(n, "period doubling", Contact(ratio, 0.0))
    # Both factors vanish at ϖ = 1, beside which the formula has seven digits.
    assert doubling[0, 0, 0] == pytest.approx(formula, rel=1e-10 if ratio != 1 else 1e-6)
    if expected is not None:
        # Half a unit of the last digit that is known.
        assert doubling[0, 0, 0] == pytest.approx(expected, abs=5e-9)


@pytest.mark.parametrize(
    ("n", "ratio", "amplitude_max"),
    [(1, 0.61, 2.1), (3, 3.7, 1.2), (1, 1.0, 2.1)],
)
def test_the_branch_of_an_undamped_contact_has_its_period_doubling(n, ratio, amplitude_max):
    branch = continuation.branch(Family(n, Contact(ratio, 0.0)), amplitude_max, 40)
    known = continuation.bifurcations(n, "period doubling", Contact(ratio, 0.0))[0, 0, 0]
    doublings = [
        special.orbit[0] for special in branch.special if special.kind == "period doubling"
    ]
    assert known == pytest.approx(doublings[-1], rel=1e-9)
    assert_on_closed_form(n, ratio, 0.0, "displacement", branch.orbits)
    assert branch.ends[0] == (MERGES if ratio <= 1 else continuation.VANISHES)


@pytest.mark.parametrize("release", RELEASES)
def test_bifurcations_along_the_frequency_ratio_are_those_of_the_closed_form(release):
    r = 0.65
    n = np.array([1, 2, 3])
    zeta = independent.restitution_to_damping(r)
    ratios = np.array([1.3, 7.77, 431.0, 1e4])
    contact = Contact(ratios, zeta, release)
    bifurcations = {
        kind: continuation.bifurcations(n, kind, contact) for kind in continuation.SPECIAL[:2]
    }
    for i in range(3):
        for j, ratio in enumerate(ratios):
            for k, kind in enumerate(continuation.SPECIAL[:2]):
                y = bifurcations[kind][:, i, j]
                assert_on_closed_form(n[i], ratio, zeta, release, y)
                values = independent.test_functions(n[i], ratio, zeta, release, y[3] / ratio)
                # The corrector's tolerance, times the slopes of the test functions along θ.
                assert values[k] == pytest.approx(0, abs=1e-9 * ratio)
            # What they bound is stable in between.
            ends = [bifurcations[kind][3, i, j] for kind in ("period doubling", "saddle-node")]
            inside = np.linspace(*ends, 50)[1:-1] / ratio
            assert ends[0] < ends[1]
            assert np.min(independent.test_functions(n[i], ratio, zeta, release, inside)) > 0


def test_orbits_tend_to_the_restitution_model_to_first_order_in_the_stiffness():
    """The relative errors are K/ϖ, with the formulas of an impact at the centroid of its force."""
    n, r, amplitude = 2, 0.65, 1.6
    zeta = float(damping_ratio(r))
    duration = np.pi / np.sqrt(1 - zeta**2)
    x = float(restitution.saddle_node(n, r))
    phase = np.arccos(x / amplitude)
    impact_height = amplitude * np.sin(phase)
    load = ((1 - r) * duration - 2 * zeta * (1 + r)) / (1 + r)
    height = impact_height + (n * np.pi) ** 2 / 2
    delay = 2 * n * np.pi * r * duration / (1 + r) ** 2
    expected = {
        "max_height": -(delay - x * load * (1 - impact_height) / impact_height) / height,
        "bounce_velocity": -duration / (n * np.pi * (1 + r)),
        "phase": -(r * duration / (1 + r) - load * (1 - impact_height) / impact_height) / phase,
        "apparent_restitution": -2
        * zeta
        * (1 + r) ** 2
        * (1 - impact_height)
        / (2 * n * np.pi * r),
        "saddle_node": -load / x,
    }
    ratios = np.array([2e4, 4e4])
    y = continuation.upper_orbits(n, r, amplitude, ratios)[:, 0]
    observed = Family(n, Contact(ratios, zeta)).observables(y, OBSERVABLES)
    observed["saddle_node"] = continuation.bifurcations(n, "saddle-node", Contact(ratios, zeta))[
        0, 0
    ]
    limits = {
        "max_height": restitution.max_height(n, r, amplitude),
        "bounce_velocity": n * np.pi,
        "phase": phase,
        "apparent_restitution": r,
        "saddle_node": x,
    }
    for name, limit in limits.items():
        first, second = ratios * (observed[name] / limit - 1)
        # Extrapolation takes the next order away; rounding errors are 1e-15 times ϖ.
        assert 2 * second - first == pytest.approx(expected[name], rel=1e-5), name


@pytest.mark.parametrize("release", RELEASES)
def test_a_walk_along_the_frequency_ratio_follows_the_stable_orbits(release):
    # With the force release no contact has the r of 0.05.
    smallest = {"displacement": 0.05, "force": 0.15}[release]
    r = np.array([smallest, 0.65, 0.85, 0.999])
    amplitude = 1.01 * restitution.saddle_node(2, r) + np.array([0.4, 0.4, 0.8, 0.5])
    ratios = np.array([1.9, 2.0, 3.33, 50.0, 1e3, 1e6])
    orbits = continuation.upper_orbits(2, r, amplitude, ratios, release)
    assert orbits.shape == (4, 4, 6)
    np.testing.assert_allclose(orbits[0], np.outer(amplitude, np.ones(6)), rtol=CORRECTOR)
    for i in range(4):
        zeta = independent.restitution_to_damping(r[i], release)
        for j, ratio in enumerate(ratios):
            assert_on_closed_form(2, ratio, zeta, release, orbits[:, i, j])
            duration = orbits[3, i, j] / ratio
            saddle_node, _ = independent.test_functions(2, ratio, zeta, release, duration)
            assert saddle_node > 0


def test_where_there_is_no_orbit_there_is_none():
    # The saddle-node of the 5-T orbits rises again on compliant contacts.
    ratios = np.array([1.0, 1.05, 3.0, 100.0])
    y = continuation.upper_orbits(5, 0.65, 3.5, ratios)[0, 0]
    zeta = independent.restitution_to_damping(0.65)
    durations = np.linspace(2, 4.5, 400) / ratios[:, np.newaxis]
    lowest = [
        np.min(independent.orbit(5, ratio, zeta, "displacement", row)[0])
        for ratio, row in zip(ratios, durations, strict=True)
    ]
    np.testing.assert_array_equal(np.isnan(y), np.array(lowest) > 3.5)
    assert np.isnan(y).sum() == 2
    with pytest.raises(NoOrbit, match=r"no 5-T orbit is found at Λ = 3.5 and ϖ = 1: give a"):
        continuation.branch(Family(5, Contact(1.0, zeta)), 3.5, 20)


def test_below_the_saddle_node_of_the_restitution_model_there_is_no_orbit():
    orbits = continuation.upper_orbits(1, 0.85, [0.3, 0.25], [10.0])
    assert np.isfinite(orbits[:, 0]).all()
    assert np.isnan(orbits[:, 1]).all()
    message = r"1-T orbits on stiff contacts need Λ >= 0.254724 \(Eq. 7 .* r = 0.85\).* Λ is 0.25: "
    with pytest.raises(NoOrbit, match=message):
        continuation.upper_orbits(1, 0.85, [0.2, 0.25], [10.0])


def test_a_force_release_has_orbits_from_the_saddle_node_of_its_stiff_limit():
    zeta = independent.restitution_to_damping(0.15, "force")
    assert zeta > 1.7 * damping_ratio(0.15)
    lowest = restitution.saddle_node(1, 0.15)
    y = continuation.upper_orbits(1, 0.15, 1.01 * lowest, [1e3, 1e6], "force")[:, 0]
    for j, ratio in enumerate([1e3, 1e6]):
        assert_on_closed_form(1, ratio, zeta, "force", y[:, j])
    with pytest.raises(NoOrbit):
        continuation.upper_orbits(1, 0.15, 0.99 * lowest, [1e3], "force")
    some = continuation.upper_orbits(1, [0.05, 0.15], 1.01 * lowest, [1e3], "force")
    np.testing.assert_array_equal(np.isnan(some[0, :, 0]), [True, False])


@pytest.mark.parametrize(
    ("n", "r", "release", "amplitude"),
    [
        (4, 0.437, "displacement", 4.957),
        (2, 0.189, "force", 4.851),
        # Newton's method finds another branch beyond the end of this walk.
        (2, 0.411, "force", 2.819),
    ],
)
def test_a_walk_ends_where_its_orbits_cease(n, r, release, amplitude):
    ratios = np.geomspace(0.4, 100, 60)
    contact = Contact.of_restitution(ratios, r, release)
    walks = [continuation.upper_orbits(n, r, amplitude, ratios, release)[:, 0]]
    for kind in continuation.SPECIAL[:2]:
        walks.append(continuation.bifurcations(n, kind, contact)[:, 0])
    for y in walks:
        reached = np.isfinite(y).all(axis=0)
        assert reached[-1]
        # From one ratio on, there is an orbit at each.
        assert not np.any(reached[:-1] & ~reached[1:])
        assert np.all(Family(n, contact).possible(y) == reached)
        # Neighbours are neighbours: their durations differ by less than half a radian.
        assert np.abs(np.diff(y[3, reached])).max() < 0.5


def test_the_tangent_turns_by_at_most_14_degrees_in_a_step():
    family = Family(1, Contact.of_restitution(2.0, 0.85))
    start = continuation.upper_orbits(1, 0.85, 1.3, 2.0)[:, 0, 0]
    path, _ = continuation._follow(family, start, 1.3, largest_step=5.0)
    _, _, vectors = np.linalg.svd(np.moveaxis(family.jacobian(path), -1, 0))
    tangents = vectors[:, -1]
    turns = np.abs(np.sum(tangents[1:-1] * tangents[:-2], axis=1))
    assert np.degrees(np.arccos(turns.min())) < 14.1


def test_a_continuation_has_a_limit_and_says_so(monkeypatch):
    monkeypatch.setattr(continuation, "MOST_ORBITS", 9)
    family = Family(1, Contact.of_restitution(2.0, 0.85))
    branch = continuation.branch(family, 1.3, 20)
    expected = f"stops after 9 orbits at amplitude = {branch.orbits[0, 0]:.6g}"
    assert branch.ends[0] == ("inside", f"the continuation {expected}")


def test_the_corrector_gives_nan_where_it_fails_and_only_there():
    family = Family(1, Contact.of_restitution(10.0, 0.85))
    guess = continuation.stiff_guess(family, 0.25, 0.8)
    # There is no orbit with the first amplitude. The phase is not defined at the last one, so that
    # the matrix is singular.
    guesses = np.stack([guess, guess, [0.0, 0.0, -3.0, 3.1]], axis=1)
    y = continuation.correct(family, guesses, continuation.at_amplitude(np.array([0.1, 0.8, 0.0])))
    np.testing.assert_array_equal(np.isnan(y), np.outer(np.ones(4), [True, False, True]))


@pytest.mark.parametrize("release", RELEASES)
def test_the_guess_for_a_stiff_contact_is_right_to_the_first_order(release):
    zeta = 0.2
    x = restitution.saddle_node(2, free_restitution(zeta, release))
    family = Family(2, Contact(1e5, zeta, release))
    guess = continuation.stiff_guess(family, x, 0.7)
    y = continuation.correct(family, guess, continuation.at_amplitude(guess[0]))
    np.testing.assert_allclose(guess, y, atol=20 / 1e5)
