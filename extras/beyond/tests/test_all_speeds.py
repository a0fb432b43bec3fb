"""All n-T orbits of a restitution that depends on the speed, and the other speeds that are named.

The second route is a scan of 10⁵ speeds, and a ball that is followed by the integrator.
"""

import numpy as np
import pytest
from integrated import leg
from scipy.optimize import brentq, minimize_scalar

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.periodic.instants import closing_speeds, instants
from bouncing_ball_beyond.tables.table import SINE

TWO_RISES = bb.Table([(1, 1.0, 0.0), (2, 0.6, 0.3), (5, 0.1, 1.0)])


def step(high, fall, steepness, place):
    return lambda u: high - fall / 2 * (1 + np.tanh(steepness / 2 * (u - place)))


def wave(mean, size, number, shift=0.0):
    return lambda u: mean + size * np.sin(number * u + shift)


def functions():
    """Forty r(u): steps up to 10⁸ times steeper than the grid of speeds, and waves."""
    rng = np.random.default_rng(157)
    for k in range(20):
        fall, place = rng.uniform(0.1, 0.6), rng.uniform(3.4, 5.5)
        yield step(0.95, fall, 10.0 ** (k / 3), place)
        yield wave(0.5, rng.uniform(0.05, 0.45), 2.0 ** (k / 3), rng.uniform(0, 6))


def scanned(r, n):
    """Brackets of the speeds u with (1 + r(u)) u = 2nπ, on a grid of 10⁵ speeds."""
    speeds = np.linspace(0.9999 * n * np.pi, 2.0001 * n * np.pi, 100_001)
    excess = (1 + r(speeds)) * speeds - 2 * n * np.pi
    crossed = np.flatnonzero((excess[1:] > 0) != (excess[:-1] > 0))
    return speeds[crossed], speeds[crossed + 1]


@pytest.mark.parametrize("n", [1, 3])
def test_all_speeds_of_a_scan_are_found(n):
    for r in functions():
        low, high = scanned(r, n)
        speeds = closing_speeds(bb.Rigid(r), n)
        assert len(speeds) == len(low)
        assert np.all((low <= speeds) & (speeds <= high))


@pytest.mark.parametrize("k", range(0, 40, 4))
def test_orbits_are_those_of_the_scan_that_a_ball_follows(k):
    """A ball that starts at the impact of an orbit is there again after a period."""
    r, amplitude = list(functions())[k], 1.2
    ball, expected = bb.Rigid(r), []
    for low, high in zip(*scanned(r, 1), strict=True):
        u = brentq(lambda u: (1 + r(u)) * u - 2 * np.pi, low, high, xtol=1e-15)
        if u - np.pi > amplitude:
            continue
        for side in (1, -1):
            tau = side * np.arccos((u - np.pi) / amplitude)
            # The integrator gets the r of this speed, because it cannot resolve the step.
            lands, closing, _ = leg(bb.Rigid(r(u)), amplitude, tau, u)
            if abs(lands - tau - 2 * np.pi) < 1e-6 and abs(closing - u) < 1e-6:
                expected.append((tau % (2 * np.pi), u))
    impacts = [(orbit.times[0], orbit.speeds[0]) for orbit in bb.orbits(ball, amplitude=amplitude)]
    np.testing.assert_allclose(sorted(impacts), sorted(expected), rtol=0, atol=1e-9)


def test_a_double_root_is_one_orbit_on_each_side():
    """At this r(u) two closing speeds merge; nearby there are two or none."""

    def lowest(high):
        r = step(high, 0.4, 6.0, 3.6)
        bounds = {"bounds": (3.5, 4.2), "options": {"xatol": 1e-12}}
        return minimize_scalar(lambda u: (1 + r(u)) * u, **bounds).fun - 2 * np.pi

    high = brentq(lowest, 0.9, 0.99, xtol=1e-16)
    counts = [
        len(closing_speeds(bb.Rigid(step(high + change, 0.4, 6.0, 3.6)), 1))
        for change in (-1e-9, 0.0, 1e-9)
    ]
    assert counts == [3, 2, 1]
    assert len(bb.orbits(bb.Rigid(step(high, 0.4, 6.0, 3.6)), amplitude=1.0)) == 4


@pytest.mark.parametrize("table", [SINE, TWO_RISES], ids=["sine", "two rises"])
@pytest.mark.parametrize("r", [0.0, 0.3, 0.65, 1.0])
def test_the_list_of_a_constant_restitution_is_complete(r, table):
    """The search over first impacts finds the roots of both scalar equations, and no others."""
    for n, amplitude in ((1, 0.4), (1, 1.3), (2, 2.9)):
        ball = bb.Rigid(r)
        every = instants(ball, n, amplitude, table)
        orbits = bb.orbits(ball, periods=n, amplitude=amplitude, table=table)
        equations = bb.OrbitEquations(ball, 1, n, table=table)
        followed = equations.admissible(np.insert(every, 2, amplitude, axis=1))
        expected = sorted(map(tuple, every[followed]))
        listed = sorted((orbit.times[0], orbit.speeds[0]) for orbit in orbits)
        np.testing.assert_allclose(np.reshape(listed, (-1, 2)), np.reshape(expected, (-1, 2)))


@pytest.mark.parametrize("place", [0.7, 3.8, 300.8])
def test_a_jump_of_the_restitution_is_refused(place):
    with pytest.raises(ValueError, match=f"jumps by 0.3 near u = {place}, .* smooth step"):
        bb.Rigid(lambda u: np.where(u.real < place, 0.8, 0.5))
    assert bb.Rigid(lambda u: 0.65 - 0.15 * np.tanh((u - place) / 1e-6))


@np.errstate(over="ignore", invalid="ignore")
def test_an_r_that_is_not_finite_is_refused_where_orbits_close():
    """Beyond u = 12.9 the exponential overflows, and the derivative is not a number."""
    ball = bb.Rigid(lambda u: 1 / (1 + np.exp(80 * (u - 4))))
    assert bb.orbits(ball, amplitude=7.0, periods=2)
    for ask in (bb.limits, lambda ball, n: bb.orbits(ball, periods=n, amplitude=10.0)):
        with pytest.raises(ValueError, match=r"not finite near u = 1\d\.\d+; 3-T orbits close at"):
            ask(ball, n=3)
