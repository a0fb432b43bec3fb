"""Orbits with k impacts in m periods, by a search and from a guess."""

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError
from bouncing_ball_beyond.periodic import k_impacts
from bouncing_ball_beyond.periodic.one_impact import n_t

RIGID = bb.rigid(restitution=0.5)
SPRING = bb.spring_damper(restitution=0.85, frequency_ratio=10.0)
BALLS = [RIGID, SPRING, bb.corrected(SPRING)]


@pytest.mark.parametrize("ball", BALLS)
@pytest.mark.parametrize("n", [1, 2])
def test_with_one_impact_the_search_finds_the_orbits_of_the_closed_form(ball, n):
    amplitude = 1.1 if ball is not RIGID else 1.2 * n
    closed = [each for each in bb.orbits(ball, n, amplitude=amplitude) if each.is_admissible()]
    found = k_impacts.found_orbits(ball, 1, n, amplitude)
    assert len(found) == len(closed) > 0
    for one, other in zip(found, sorted(closed, key=lambda each: -each.max_height), strict=True):
        assert one.distance(other) < 1e-11


@pytest.mark.parametrize(("ball", "amplitude"), [*zip(BALLS, (1.6, 1.1, 1.1), strict=True)])
def test_the_orbits_of_a_doubled_branch_are_found(ball, amplitude):
    doubling = bb.limits(ball).period_doubling
    *_, last = bb.follow(doubling, to=amplitude).states()
    found = bb.orbits(ball, impacts=2, periods=2, amplitude=amplitude)
    assert any(k_impacts._is_same(last, each) for each in found)
    for each in found:
        assert (each.impacts, each.periods) == (2, 2) and each.is_admissible()
        assert each.defect() < 1e-12


@pytest.mark.parametrize("ball", BALLS)
def test_where_a_ball_ends_is_among_the_orbits(ball):
    """Stable orbits are those on which simulated balls end, whatever k and m they have."""
    random = np.random.default_rng(7)
    seen = set()
    for amplitude in (1.07, 1.15, 1.25, 1.6, 1.65):
        for phase, speed in random.uniform([-3.0, 1.0], [3.0, 8.0], size=(4, 2)):
            start = {"phase": phase, "velocity": amplitude * np.cos(phase) - speed}
            try:
                end = bb.orbit_of_motion(ball, amplitude=amplitude, impacts=400, **start)
            except NoOrbitError:
                continue
            if end.impacts > 8 or (ball is RIGID and np.any(end.durations > 0)):
                continue
            given = {"impacts": end.impacts, "periods": end.periods, "amplitude": amplitude}
            found = [each for each in bb.orbits(ball, **given) if each.is_stable()]
            assert any(k_impacts._is_same(end, each) for each in found) or end.impacts == 1
            seen.add((end.impacts, end.periods))
    assert len(seen) > 1


def test_a_finer_grid_of_starts_finds_no_other_orbit(monkeypatch):
    """Three impacts in three periods at r = 0.85 and Λ = 2, whose largest multiplier is 163."""
    ball = bb.rigid(restitution=0.85)
    found = bb.orbits(ball, impacts=3, periods=3, amplitude=2.0)
    monkeypatch.setattr(k_impacts, "PHASES", 200)
    monkeypatch.setattr(k_impacts, "SPEEDS", 100)
    finer = bb.orbits(ball, impacts=3, periods=3, amplitude=2.0)
    assert len(found) == len(finer) == 4 and not any(each.is_stable() for each in found)
    for one, other in zip(found, finer, strict=True):
        assert k_impacts._is_same(one, other)


def test_an_orbit_is_found_from_a_guess():
    for ball, (k, m), amplitude in ((RIGID, (3, 3), 1.6), (SPRING, (2, 1), 1.1)):
        for orbit in bb.orbits(ball, impacts=k, periods=m, amplitude=amplitude):
            guess = {"phases": orbit.phase + 0.01, "velocities": orbit.impact_velocity - 0.01}
            found = bb.orbit_near(ball, amplitude=amplitude, **guess)
            assert found.periods == m and found.distance(orbit) < 1e-11
    one = bb.orbit(SPRING, amplitude=0.9)
    guess = {"phases": one.phase, "velocities": one.impact_velocity}
    assert bb.orbit_near(SPRING, amplitude=0.91, **guess).amplitude == 0.91


def test_what_is_no_orbit_is_refused(refusal):
    with refusal(NoOrbitError, "no orbit with 2 impacts in 3 T was found", "but one may exist"):
        bb.orbits(RIGID, impacts=2, periods=3, amplitude=1.6)
    with refusal(ParameterError, "n and periods are the same number: give one of them"):
        bb.orbits(RIGID, 2, periods=3, amplitude=1.6)
    with refusal(ModelError, "impacts = 0 is not a whole number from 1 to 100"):
        bb.orbits(RIGID, impacts=0, amplitude=1.6)
    with refusal(ModelError, "duration needs speed"):
        law = bb.contact_law("tsuji", restitution=0.85, duration=0.1)
        bb.orbits(law, impacts=2, amplitude=1.6)
    with refusal(NoOrbitError, "no orbit with 1 impact that a ball follows was found near"):
        bb.orbit_near(RIGID, amplitude=0.5, phases=[1.0], velocities=[-3.0])
    with refusal(NoOrbitError, "comes to rest on the table after one of these impacts"):
        bb.orbit_near(RIGID, amplitude=0.5, phases=0.0, velocities=0.5)
    with refusal(ParameterError, "velocities has 1 entries, and there are as many as phases: 2"):
        bb.orbit_near(RIGID, amplitude=1.6, phases=[1.0, 2.0], velocities=[-3.0])


@pytest.mark.parametrize("given", [{"impacts": 2}, {"impacts": 2, "periods": 2}, {"periods": 2}])
def test_orbit_points_to_the_search_of_orbits_with_several_impacts(given):
    with pytest.raises(TypeError, match=r"orbits\(\) finds those with several impacts"):
        bb.orbit(RIGID, amplitude=1.6, **given)


def test_an_orbit_is_true_if_it_exists(refusal):
    fold, doubling = bb.limits(bb.spring_damper(damping_ratio=0.9, frequency_ratio=0.5), 1)
    assert bool(fold) == fold.exists and bool(doubling) == doubling.exists
    assert not all((fold, doubling))
    one = bb.orbit(RIGID, amplitude=1.2)
    assert one
    with refusal(ModelError, "several orbits are neither true nor false: see their exists"):
        bool(n_t.orbits(RIGID, 1, 1.2))


def test_attributes_are_suggested_as_keywords_are():
    one = bb.orbit(RIGID, amplitude=1.2)
    found = bb.follow(one, to=1.25)
    for asked, wrong, meant in (
        (one, "impact_velocty", "impact_velocity"),
        (one, "is_stabel", "is_stable"),
        (RIGID, "restituton", "restitution"),
        (found, "special_stats", "special_states"),
        (found.to_dataset(), "special_amplitud", "special_amplitude"),
        (bb, "folow", "follow"),
    ):
        with pytest.raises(AttributeError, match=rf"no attribute '{wrong}'; did you mean {meant}"):
            getattr(asked, wrong)
        assert not hasattr(asked, "something_else")
    with pytest.raises(AttributeError, match=r"no attribute 'admissible'; its orbits and its to_d"):
        _ = found.admissible


def test_an_editor_completes_what_a_user_needs_of_an_orbit():
    one = bb.orbit(RIGID, amplitude=1.2)
    names = dir(one)
    assert not any(name.startswith("_") for name in names)
    assert {"phase", "max_height", "is_stable", "multipliers", "to_dataset", "plot"} <= set(names)
    assert len(names) <= 40 and "flat" not in names
