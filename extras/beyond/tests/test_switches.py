"""Contacts that end at p = 0 or f = 0, whichever comes first, against another integrator."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond import ForceLaw, OrbitNotFound, follow, limits, orbit, special_curve
from bouncing_ball_beyond.motions import effort
from bouncing_ball_beyond.periodic.continuation import _limit

CASES = [(k, c, a) for k in (300.0, 3000.0) for c in (1.0, 2.0) for a in (1.0, 1.5)]
"""Hunt and Crossley's contact with the force kp^a (1 + cp′), clipped at zero."""


STEP, ERROR = 1e-4, 1e-4
"""Step of the differences. With the errors of 1e-10 of the integrator, they are right to 1e-5."""


def law_of(k, c, a):
    if a == 1.0:
        return ForceLaw(lambda p, v, k, c: k * p * (1 + c * v), {"k": k, "c": c}, release="force")
    return ForceLaw(
        lambda p, v, k, c: k * p * np.sqrt(p) * (1 + c * v), {"k": k, "c": c}, 2, "force"
    )


def return_map(case, amplitude, start):
    """Next impact (τ, u): the force is clipped, and the ball flies from where p = 0."""
    k, c, a = case

    def motion(t, state):
        p, v = state
        force = max(0.0, k * max(p, 0.0) ** a * (1 + c * v))
        return [v, 1 - amplitude * np.sin(t) - force]

    def surface(t, state):
        return state[0]

    surface.terminal, surface.direction = True, -1
    tau, u = start
    given = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": 0.02}
    end = solve_ivp(motion, (tau, tau + 6), [0.0, u], events=surface, **given)
    t, v = end.t_events[0][0], end.y_events[0][0][1]

    def gap(s):
        table = np.sin(t + s) - np.sin(t) - s * np.cos(t)
        return -v * s - s * s / 2 - amplitude * table

    times = np.linspace(1e-3, 14, 3000)
    first = np.flatnonzero((gap(times)[:-1] > 0) & (gap(times)[1:] <= 0))[0]
    s = brentq(gap, times[first], times[first + 1], xtol=1e-14)
    return np.array([t + s, v + s + amplitude * (np.cos(t + s) - np.cos(t))])


def multipliers(case, one):
    """Multipliers by central differences of the return map at an orbit, which it repeats."""
    start = np.array([one.times[0], one.speeds[0]])
    after = return_map(case, one.amplitude, start)
    assert after - start == pytest.approx([2 * np.pi, 0.0], abs=1e-9)
    columns = [
        (return_map(case, one.amplitude, start + h) - return_map(case, one.amplitude, start - h))
        for h in STEP * np.eye(2)
    ]
    return np.linalg.eigvals(np.transpose(columns) / (2 * STEP)).real


def test_a_stable_range_passes_a_switch():
    node, doubling = orbit_limits = limits(law_of(300.0, 2.0, 1.0))
    assert orbit_limits.stable_ranges == ((node.amplitude, doubling.amplitude),)


@pytest.mark.parametrize("case", CASES)
def test_limits_are_those_of_the_clipped_force(case):
    node, doubling = limits(law_of(*case))
    assert min(abs(multipliers(case, node) - 1)) < ERROR
    assert min(abs(multipliers(case, doubling) + 1)) < ERROR


@pytest.mark.parametrize(("case", "start", "to", "at"), [
    ((3000.0, 1.0, 1.5), 2.3, 2.9, 2.3973252),
    ((3000.0, 1.0, 1.5), 2.6, 2.2, 2.3973252),
    ((300.0, 2.0, 1.0), 2.8, 2.45, 2.6070836),
    ((300.0, 2.0, 1.0), 2.5, 2.8, 2.6070836),
])  # fmt: skip
def test_branches_pass_a_switch_in_both_directions(case, start, to, at):
    """Orbits on both sides are admissible and repeat, and none of the flights is lost."""
    branch = follow(orbit(law_of(*case), amplitude=start), to=to)
    assert branch.end == f"amplitude = {to} is reached"
    switch = branch.first("switch of a release")
    assert switch.amplitude == pytest.approx(at, abs=1e-6)
    assert branch.admissible.all()
    for one in branch.orbits[:: len(branch) // 3]:
        start = np.array([one.times[0], one.speeds[0]])
        after = return_map(case, one.amplitude, start)
        assert after - start == pytest.approx([2 * np.pi, 0.0], abs=1e-9)
        assert np.sort(multipliers(case, one)) == pytest.approx(
            np.sort(one.multipliers.real), abs=ERROR
        )
    again = follow(switch, to=to)
    assert again.z[-1] == pytest.approx(branch.z[-1], abs=1e-9)
    with pytest.raises(OrbitNotFound, match="a curve must start at"):
        special_curve(switch, along=("k", "c"))


def test_a_limit_beyond_the_end_of_the_search_is_not_denied():
    end = "the orbits change too fast to be followed"
    assert str(_limit((), "period doubling", end)).startswith("no period doubling is known: the")


def test_progress_is_shown_in_a_terminal_only(monkeypatch, capsys):
    monkeypatch.setattr(effort, "EVERY", 0.0)
    limits(law_of(*CASES[0]))
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    limits(law_of(*CASES[0]))
    assert "limits: the branches of these orbits" in capsys.readouterr().err
