"""Orbits of the spring-damper model against an integration with events and a closed form."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq
from tests import independent

from bouncing_ball.orbits import OBSERVABLES, Family
from bouncing_ball.spring_damper import RELEASES, Contact

# The tolerance of what takes some hundred roundings: a few hundred units of 1e-16.
ROUNDING = 1e-12


@dataclass
class Case:
    """A random contact, its family and an orbit from the closed form."""

    n: int
    ratio: float
    zeta: float
    release: str
    y: np.ndarray

    @property
    def family(self):
        return Family(self.n, Contact(self.ratio, self.zeta, self.release))

    def cycle(self):
        return independent.cycle(self.ratio, self.zeta, self.release, *self.y[:3])


def case(seed, parts=(0.9, 1.01)):
    """A contact with ϖ from 0.5 to 1000, r from 0.05 to 1 and n from 1 to 3.

    The duration of its contact is a part of that of a free impact, or of the whole period.
    """
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 4))
    ratio = 10 ** rng.uniform(np.log10(0.5), 3)
    zeta = independent.restitution_to_damping(rng.uniform(0.05, 1))
    release = RELEASES[seed % 2]
    angle = np.pi / np.sqrt(1 - zeta**2)
    if release == "force":
        angle -= np.arctan2(2 * zeta * np.sqrt(1 - zeta**2), 1 - 2 * zeta**2) / np.sqrt(1 - zeta**2)
    angle = min(angle * rng.uniform(*parts), 0.9 * 2 * np.pi * n * ratio)
    return Case(n, ratio, zeta, release, independent.orbit(n, ratio, zeta, release, angle / ratio))


def turned(one, cycle):
    """Time and height of the impact that is equivalent to an integrated contact outside of it: at
    the centroid of the integrated force, on the flight after the contact.
    """
    since = cycle.contact.centroid(one.zeta)
    before = cycle.contact.duration - since
    ball = cycle.heights[400] - cycle.bounce * before - before**2 / 2
    amplitude, phase = one.y[:2]
    return {"centroid": since, "centroid_gap": ball - amplitude * np.sin(phase + since)}


@pytest.mark.parametrize("seed", range(16))
def test_an_orbit_and_all_that_is_said_of_it(seed):
    """An orbit of the closed form meets the equations, and an integration over a cycle ends where
    it began if and only if the orbit is admissible.
    """
    one = case(seed)
    family = one.family
    y = one.y
    # z′_i is up to 20; the equations are sums of terms of ϖδ′ κ ~ z′_i and of heights ~ z′_i².
    scale = np.abs(y).max() + (np.pi * one.n) ** 2
    np.testing.assert_allclose(family.equations(y), 0, atol=ROUNDING * scale)
    cycle = one.cycle()
    amplitude, phase, velocity, angle = y
    observed = family.observables(y, OBSERVABLES)
    multipliers = np.linalg.eigvals(
        independent.monodromy(one.n, one.ratio, one.zeta, one.release, angle / one.ratio)
    )
    returns = abs(cycle.time - 2 * np.pi * one.n) < 1e-6
    expected = {
        "amplitude": amplitude,
        "phase": phase,
        "impact_velocity": velocity,
        "contact_duration": cycle.contact.duration,
        "release_phase": phase + cycle.contact.duration,
        "bounce_velocity": cycle.bounce,
        "apparent_restitution": -cycle.contact.rate / (velocity - amplitude * np.cos(phase)),
        "max_height": cycle.greatest_height(),
        "summit": max(cycle.heights[400], cycle.heights[400] + cycle.bounce**2 / 2),
        **turned(one, cycle),
        "stable": np.abs(multipliers).max() < 1,
        "admissible": returns,
    }
    assert expected.keys() == OBSERVABLES.keys()
    assert observed["admissible"] == returns == (family.clearance(y) > 0)
    assert observed["stable"] == expected["stable"]
    end = family.contact_end(y)
    assert end.velocity == pytest.approx(family.bounce_velocity(y))
    if cycle.contact.duration != pytest.approx(angle / one.ratio, rel=1e-6):
        return
    # The integration has some 1e-12 for each of its steps, magnified by the size of the numbers.
    tight = {"abs": 1e-10 * scale}
    assert end.gap_velocity == pytest.approx(cycle.contact.rate, **tight)
    # The interpolant of the integration has seven digits or more.
    in_flight = {"max_height", "summit"}
    sampled = {"max_height": 1e-7, "centroid": 1e-7, "centroid_gap": 1e-7 * scale}
    for name in OBSERVABLES.keys() - (set() if returns else in_flight):
        error = sampled.get(name, 1e-10 * scale)
        assert observed[name] == pytest.approx(expected[name], abs=error), name
    if not returns:
        return
    assert cycle.time == pytest.approx(2 * np.pi * one.n, **tight)
    assert cycle.velocity == pytest.approx(velocity, **tight)
    # The interpolant of the integration has seven digits or more.
    height, speed, touching = family.motion(y[:, np.newaxis], cycle.times[1:-1])
    np.testing.assert_allclose(height, cycle.heights[1:-1], atol=1e-8 * scale)
    np.testing.assert_allclose(speed, cycle.velocities[1:-1], atol=1e-7 * scale)
    np.testing.assert_array_equal(touching[:398], True)
    np.testing.assert_array_equal(touching[400:], False)


@pytest.mark.parametrize("seed", range(100, 130))
def test_an_orbit_is_admissible_if_the_integration_returns_to_its_start(seed):
    one = case(seed, (1.0, 3.0))
    returns = abs(one.cycle().time - 2 * np.pi * one.n) < 1e-6
    assert (one.family.clearance(one.y) > 0) == returns


def differences(function, y, steps):
    """Derivatives of a function by central differences of the fourth order."""
    columns = []
    for k, step in enumerate(steps):
        shift = np.zeros_like(y)
        shift[k] = step
        near = function(y + shift) - function(y - shift)
        far = function(y + 2 * shift) - function(y - 2 * shift)
        columns.append((8 * near - far) / (12 * step))
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("seed", range(8))
def test_derivatives_of_the_equations(seed):
    one = case(seed)
    # Not at an orbit, so that nothing is hidden that vanishes there.
    y = one.y + np.array([0.1, 0.2, -0.3, 0.4])
    expected = differences(one.family.equations, y, [1e-3] * 4)
    # Rounding errors of 1e-16, divided by the step, and its fourth power, 1e-12.
    scale = np.abs(expected).max() + np.abs(y).max() ** 2
    np.testing.assert_allclose(one.family.jacobian(y), expected, atol=1e-10 * scale)


@pytest.mark.parametrize("flight", [3e-4, 0.99e-3, 1.01e-3, 0.1])
@pytest.mark.parametrize("release", RELEASES)
def test_derivatives_of_the_equations_where_the_flight_vanishes(release, flight):
    family = Family(1, Contact(1.7, 0.1, release))
    y = np.array([0.8, 0.6, -0.2, 1.7 * (2 * np.pi - flight)])
    expected = differences(family.equations, y, [1e-3, 1e-3, 1e-3, 2e-2 * flight])
    # After a force release δ_b is divided by the flight, whose derivatives by it grow with its
    # powers: the fourth order of a step of a hundredth of it.
    np.testing.assert_allclose(family.jacobian(y), expected, rtol=1e-6, atol=1e-9)


@cache
def admissible_cases():
    cases = [case(seed, (0.97, 1.0)) for seed in range(30)]
    return [one for one in cases if one.family.clearance(one.y) > 1]


def test_the_return_map_is_that_of_the_integration():
    # Maps of stiffer contacts are too steep for differences; the multipliers are tested below.
    cases = [one for one in admissible_cases() if one.ratio < 50][:8]
    assert {one.release for one in cases} == {*RELEASES}
    for one in cases:

        def following(start, one=one):
            end = independent.cycle(one.ratio, one.zeta, one.release, one.y[0], *start)
            return np.array([start[0] + end.time, end.velocity])

        step = 2e-3 / one.ratio
        expected = differences(following, one.y[1:3], [step, step])
        # Errors of the integration, 1e-12 times the size of the numbers, over the step, and the
        # fourth power of the part of the contact that the step is.
        scale = np.abs(expected).max()
        np.testing.assert_allclose(one.family.return_map(one.y), expected, atol=1e-7 * scale)


def test_multipliers_are_those_of_the_motion_over_a_cycle():
    moduli = []
    for one in admissible_cases():
        expected = independent.monodromy(
            one.n, one.ratio, one.zeta, one.release, one.y[3] / one.ratio
        )
        trace, determinant = one.family.trace_and_determinant(one.y)
        size = np.abs(expected).max()
        assert trace == pytest.approx(np.trace(expected), abs=ROUNDING * size)
        assert determinant == pytest.approx(np.linalg.det(expected), abs=ROUNDING * size**2)
        matrix = one.family.return_map(one.y)
        assert np.linalg.det(matrix) == pytest.approx(
            determinant, abs=ROUNDING * np.abs(matrix).max() ** 2
        )
        assert determinant == pytest.approx(np.exp(-2 * one.zeta * one.y[3]))
        assert one.family.saddle_node_test(one.y) == pytest.approx(1 - trace + determinant)
        assert one.family.period_doubling_test(one.y) == pytest.approx(1 + trace + determinant)
        multipliers = one.family.multipliers(one.y)
        assert abs(multipliers[0]) >= abs(multipliers[1]) * (1 - ROUNDING)
        np.testing.assert_allclose(multipliers.sum(), trace, atol=ROUNDING * size)
        np.testing.assert_allclose(multipliers.prod(), determinant, rtol=1e-10)
        moduli.append(abs(multipliers[0]))
        assert one.family.observables(one.y, ["stable"])["stable"] == (moduli[-1] < 1)
    assert min(moduli) < 1 < max(moduli)


def test_multipliers_of_each_kind():
    """On one branch they are negative, a complex pair and positive in turn."""
    angles = np.linspace(3.13, 3.8, 60)
    y = independent.orbit(1, 2.0, 0.05166, "displacement", angles / 2)
    family = Family(1, Contact(2.0, 0.05166))
    trace, determinant = family.trace_and_determinant(y)
    multipliers = family.multipliers(y)
    expected = np.stack([np.roots([1, -t, d]) for t, d in zip(trace, determinant, strict=True)])
    real = np.isreal(expected).all(axis=1)
    assert {*np.sign(trace[real])} == {-1, 1}
    assert not real.all()
    larger = np.abs(expected).argmax(axis=1)
    for multiplier, index in zip(multipliers, (larger, 1 - larger), strict=True):
        picked = np.take_along_axis(expected, index[:, np.newaxis], axis=1)[:, 0]
        # Of a pair either comes first. Near a double root half of the digits are lost.
        np.testing.assert_allclose(multiplier.real, picked.real, atol=1e-7)
        np.testing.assert_allclose(np.abs(multiplier.imag), np.abs(picked.imag), atol=1e-7)


def test_the_table_lifts_a_ball_on_a_compliant_contact_higher_than_it_flies():
    ratio, zeta, amplitude = 1.94317663, 0.60729752, 0.96596752

    def orbit(duration):
        return independent.orbit(1, ratio, zeta, "displacement", duration)

    # The durations of 1-T orbits with this amplitude.
    durations = independent.roots(lambda d: orbit(d)[0] - amplitude, np.linspace(3, 6.28, 60))
    (y,) = [orbit(duration) for duration in durations]
    family = Family(1, Contact(ratio, zeta))
    cycle = independent.cycle(ratio, zeta, "displacement", *y[:3])
    assert cycle.time == pytest.approx(2 * np.pi, abs=1e-9)
    observed = family.observables(y, ["stable", "admissible", "max_height"])
    assert observed["stable"]
    assert observed["admissible"]
    assert round(float(observed["max_height"]), 4) == 0.9157
    # The interpolant of the integration, in contact, has seven digits or more.
    assert observed["max_height"] == pytest.approx(cycle.greatest_height(), abs=1e-7)
    # The flight ends lower than it begins, and has no summit.
    assert cycle.bounce < 0


# ϖ, ζ, release, n, an interval of ϖτ_b in which an orbit grazes, and where.
GRAZING = [
    (1e4, 0.69010673, "displacement", 1, 4.341, 4.342, "flight"),
    (5.0, 0.5, "displacement", 3, 3.6, 5.5, "flight"),
    (10.0, 0.69010673, "displacement", 1, 10.5, 10.6, "contact"),
    (10.0, 0.69010673, "force", 1, 20.2, 20.6, "contact"),
    # Its lowest point is a kink of the function that is not to be negative.
    (10.0, 0.69010673, "force", 1, 2.55, 2.65, "flight"),
]


@pytest.mark.parametrize(("ratio", "zeta", "release", "n", "low", "high", "where"), GRAZING)
def test_an_orbit_without_clearance_grazes(ratio, zeta, release, n, low, high, where):
    family = Family(n, Contact(ratio, zeta, release))

    def orbit(angle):
        return independent.orbit(n, ratio, zeta, release, angle / ratio)

    angle = brentq(lambda angle: family.clearance(orbit(angle)), low, high, xtol=1e-14)
    amplitude, phase, velocity, _ = orbit(angle)
    kappa = independent.lag(ratio, zeta, release)
    x = amplitude * np.cos(phase)
    start = np.array([0, velocity - x, amplitude * np.sin(phase), x, 1])
    gap, rate, table, table_velocity, _ = independent.transfer(ratio, zeta, angle / ratio) @ start
    bounce = rate + table_velocity

    def pressed(part):
        moved = independent.transfer(ratio, zeta, angle / ratio * part) @ start
        return -moved[:, 0] - kappa * ratio * moved[:, 1]

    def outside(part):
        since = (2 * np.pi * n - angle / ratio) * part
        end = phase + angle / ratio + since
        height = gap / ratio + table + bounce * since - since**2 / 2 - amplitude * np.sin(end)
        return np.maximum(height, height + kappa * (bounce - since - amplitude * np.cos(end)))

    lowest = {"contact": independent.lowest(pressed), "flight": independent.lowest(outside)}
    # The last samples are 5e-7 of the contact or flight apart: the square of this, times forces.
    assert lowest.pop(where) == pytest.approx(0, abs=1e-10)
    assert min(lowest.values()) > 0


def test_an_orbit_that_lands_without_relative_velocity_grazes():
    """Beyond it an orbit would begin its contact from below."""
    ratio = 2.0
    zeta = 0.69010673
    family = Family(1, Contact(ratio, zeta, "force"))

    def orbit(angle):
        return independent.orbit(1, ratio, zeta, "force", angle / ratio)

    def impact(angle):
        return family.start(orbit(angle))[2]

    angle = brentq(impact, 10, 11, xtol=1e-14)
    assert brentq(lambda angle: family.clearance(orbit(angle)), 10, 11) == pytest.approx(angle)
    assert list(family.possible(orbit(angle + np.array([-1e-3, 1e-3])))) == [True, False]


def test_a_solution_without_the_signs_of_an_orbit_is_none():
    ratio = 5.0
    family = Family(1, Contact(ratio, 0.1))
    y = independent.orbit(1, ratio, 0.1, "displacement", 0.62)
    assert family.possible(y)
    amplitude, phase, velocity, angle = y
    for other in (
        [-amplitude, phase + np.pi, velocity, angle],
        [amplitude, phase, velocity, -0.1],
        [amplitude, phase, velocity, 2 * np.pi * ratio + 0.1],
        [amplitude, phase, amplitude * np.cos(phase) + 0.1, angle],
    ):
        assert not family.possible(np.array(other))
