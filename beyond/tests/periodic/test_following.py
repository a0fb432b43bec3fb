"""Branches along any parameter, their events, and the doubled branches."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from orbits_found import FOUND, balls, first, found_orbit, legs_of

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.numerics.corrector import newton, plane
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.motions.orbit_of_motion import of_impact, of_motion
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.branches.switching import switch
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.whole_branch import whole_branch
from bouncing_ball_beyond.periodic.orbits.balls import Balls
from bouncing_ball_beyond.periodic.orbits.domain_limits import domain_limits
from bouncing_ball_beyond.periodic.orbits.halves import turns_apart, twice
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of, point_of
from bouncing_ball_beyond.periodic.orbits.orbit import orbit_of_point
from bouncing_ball_beyond.periodic.orbits.simulation import is_admissible
from bouncing_ball_beyond.periodic.orbits.special import Special

CLOSED = ["restitution", "spring-damper", "force release", "corrected"]


def start(name, amplitude=1.3):
    return n_t.orbit(balls(name, amplitude).model, 1, amplitude)


@pytest.mark.parametrize("name", CLOSED)
def test_the_bifurcations_of_one_impact_are_those_of_the_closed_form(name):
    model = start(name).model
    down = first(branch_from(start(name), to=0.1), Special.SADDLE_NODE)
    up = first(branch_from(start(name), to=2.0), Special.PERIOD_DOUBLING)
    assert down.amplitude == pytest.approx(n_t.saddle_node(model, 1).amplitude, abs=1e-12)
    assert up.amplitude == pytest.approx(n_t.period_doubling(model, 1).amplitude, abs=1e-12)


@pytest.mark.parametrize(("name", "along", "to"), [
    ("restitution", "restitution", 0.8), ("spring-damper", "frequency_ratio", 3.0),
    ("force release", "restitution", 0.7), ("corrected", "frequency_ratio", 100.0),
])  # fmt: skip
def test_a_branch_along_any_parameter_is_the_closed_form_at_each_point(name, along, to):
    found = branch_from(start(name), along, to)
    assert str(found.branch.end) == f"{along.replace('_', ' ')} = {to:g} is reached"
    for each in list(found)[::4]:
        orbit = n_t.orbit(each.model, 1, 1.3)
        offset = orbit.trace_and_determinant()[0] - each.trace_and_determinant()[0]
        assert abs(offset) < 1e-11


def test_a_grazing_flight_is_where_the_lowest_point_of_the_flight_is_on_the_table():
    found = branch_from(start("restitution", amplitude=2.0), to=0.9)
    grazing = first(found, Special.GRAZING_FLIGHT)
    lam = grazing.amplitude
    x, y = table(np.array(grazing.phase), lam)
    flight = Flight(0.0, -0.5 * grazing.relative_impact_velocity, x, y, lam)
    time = np.linspace(1.0, 6.2, 400_001)
    gap = flight.gap(time)[0]
    inside = (time > 1.0) & (time < 6.2)
    assert abs(gap[inside].min()) < 1e-9


@pytest.mark.parametrize("name", ["restitution", "spring-damper"])
def test_grazing_orbits_are_those_that_bisection_finds(name):
    whole = whole_branch(start(name).model, 1, 6.0, 0.1).resampled(100)
    equations = whole.problem.equations
    bisected = domain_limits(
        whole.problem,
        lambda y: is_admissible(equations, whole.problem.inner(y)),
        whole.branch.points,
    )
    expected = bisected[:, -1]
    located = [each.amplitude for each in whole.special if each.kind == Special.GRAZING_FLIGHT]
    assert np.abs(np.subtract(located, expected)).max() < 1e-12
    ours = []
    for to in (5.9, 0.05):
        found = branch_from(start(name), to=to)
        ours += [each.amplitude for each in found.special if each.kind == Special.GRAZING_FLIGHT]
    assert expected.size and all(np.abs(np.array(ours) - x).min() < 1e-12 for x in expected
                                 if 0.1 < x < 2.5)  # fmt: skip


@pytest.mark.parametrize("name", ["restitution", "spring-damper"])
def test_generations_of_doubled_orbits_attract_balls_and_end_where_they_began(name):
    orbit = start(name)
    before = 0.0
    for generation in range(4):
        doubling = first(branch_from(orbit, to=2.2), Special.PERIOD_DOUBLING)
        lam = doubling.amplitude
        assert doubling.impacts == 2**generation and lam > before
        assert doubling.multipliers()[0] == pytest.approx(-1, abs=1e-9)
        orbit = switch(doubling, aside=0.02 / 2.2**generation)
        back = branch_from(orbit, to=0.5)
        halving = first(back, Special.PERIOD_HALVING)
        assert halving.amplitude == pytest.approx(lam, abs=1e-12)
        before = lam
        impact = orbit.phase[0], orbit.impact_velocity[0]
        motion = final_motions(orbit.model, orbit.amplitude, *impact, impacts=4000)
        assert int(motion.impacts) == orbit.impacts


def test_a_motion_starts_the_continuation_of_the_orbit_on_which_it_ends():
    orbit = of_motion(balls("restitution", 1.6).model, 1.6, 1.0, -3.0)
    assert (orbit.impacts, orbit.periods) == (2, 2)
    doubling = first(branch_from(orbit, to=1.8), Special.PERIOD_DOUBLING)
    assert doubling.amplitude == pytest.approx(1.667130660770, abs=1e-11)


def test_a_chaotic_motion_is_on_no_orbit(refusal):
    with refusal(NoOrbitError, "ends on no orbit that could be followed: it is chaotic"):
        of_motion(balls("restitution", 2.0, restitution=0.85).model, 2.0, 1.0, -3.0, 300)


def test_a_contact_law_is_followed_along_its_stiffness():
    found = branch_from(start("tsuji", amplitude=1.0), "stiffness", 800.0)
    assert str(found.branch.end) == "stiffness = 800 is reached"
    last = list(found)[-1]
    assert n_t.orbit(last.model, 1, 1.0).phase == pytest.approx(last.phase, abs=1e-11)


def test_a_locked_orbit_is_followed_until_it_no_longer_sticks_or_an_impact_grazes():
    orbit = of_motion(balls("restitution", 2.5).model, 2.5, 1.0, -3.0)
    assert legs_of(orbit).departure.sticks.sum() == 1
    found = branch_from(orbit, to=2.50002)
    assert len(found) > 3 and np.all(is_admissible(found.problem, found.branch.points))
    m = found.problem.monodromy(found.branch.points[-1])
    assert max(map(abs, m)) == 0.0


@pytest.mark.parametrize(
    ("amplitude", "impacts", "periods"),
    [(2.2, 17, 11), pytest.param(2.5, 18, 9, marks=pytest.mark.long)],
)
def test_a_locked_orbit_of_a_stiff_contact_is_followed_along_the_stiffness(
    amplitude, impacts, periods
):
    """The ball rests in a long contact once per orbit; a simulation ends on the same impacts."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.5, frequency_ratio=100.0)
    orbit = bouncing_ball_beyond.orbit_of_motion(
        ball, amplitude=amplitude, phase=1.0, velocity=-3.0
    )
    assert (orbit.impacts, orbit.periods) == (impacts, periods)
    assert legs_of(orbit).departure.sticks.sum() == 1
    found = branch_from(orbit, "frequency_ratio", 110.0, most=20)
    orbits = [each for each in found if each.is_admissible()]
    assert len(orbits) > 5
    ratios = [each.parameters["frequency_ratio"] for each in orbits]
    assert min(ratios) == ratios[0] and ratios[-1] > ratios[0] + 1e-4
    for each in orbits[:: len(orbits) - 1]:
        motion = final_motions(each.model, amplitude, 1.0, -3.0)
        assert int(motion.impacts) == impacts and int(motion.periods) == periods
        relative = motion.end_velocity - table(motion.end_phase, amplitude)[0]
        faster = each.relative_impact_velocity - relative
        away = np.hypot(reduce_angle(each.phase - motion.end_phase), faster)
        assert away.min() < 1e-10


def test_a_branch_ends_where_the_map_of_the_corrected_model_jumps():
    """There a central difference is large, so that Newton's method seems to converge."""
    model = bouncing_ball_beyond.spring_damper(restitution=0.6977, frequency_ratio=1.488)
    ball = bouncing_ball_beyond.corrected(model)
    start = {"amplitude": 1.21979, "phase": -2.9230134388176703, "velocity": -6.3303630330352965}
    found = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit_of_motion(ball, **start), points=100
    ).to_dataset()
    assert found.sizes["point"] < 100 and "just stays on" in str(found.end_reason[1].values)
    assert found.residual.max() < 1e-12


def test_a_branch_is_followed_although_newtons_method_meets_speeds_without_an_impact():
    """An impact on this law at a thousand times the speeds of the orbits would not end."""
    law = bouncing_ball_beyond.contact_law("hunt-crossley", stiffness=100.0, damping=0.2)
    ball = bouncing_ball_beyond.corrected(law)
    parent = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(ball, n=1, amplitude=0.9), to=2.0
    )
    doubled = bouncing_ball_beyond.follow(parent.first("period doubling")).to_dataset()
    assert str(doubled.end_reason[1].values).startswith("the start of a contact begins to have two")
    assert doubled.residual[:-1].max() < 1e-12
    # At this end rounding errors are divided by a hundredth.
    assert doubled.residual[-1] < 1e-11
    stable = next(
        orbit for orbit in doubled.states() if orbit.is_stable() and orbit.amplitude > 1.2
    )
    start = {"phase": stable.phase[0], "velocity": stable.impact_velocity[0]}
    motion = bouncing_ball_beyond.simulate(ball, amplitude=stable.amplitude, **start, impacts=40)
    turns = motion.time.values[::2] / (4 * np.pi)
    assert np.abs(turns - np.arange(20)).max() < 1e-10


def test_a_contact_that_resumes_is_followed_until_the_ball_no_longer_rises():
    case = FOUND[-2]
    orbit = found_orbit(case)
    assert orbit.resumes.tolist() == [False, True]
    simulated = orbit.model.simulate(orbit.amplitude, *case[-2:], 4)
    assert abs(legs_of(orbit).impact.displacement[1] - simulated.displacement[3]) < 1e-12
    found = branch_from(orbit, "frequency_ratio", 20.0)
    end = first(found, Special.GRAZING_IMPACT)
    assert abs(end.relative_impact_velocity[1]) < 1e-12 and end.defect() < 1e-12
    before = list(found)[:-1]
    assert all(each.relative_impact_velocity[1] > 0 for each in before)
    assert all(each.is_admissible() for each in before)
    # A start on such a contact gives the same orbit.
    second = Balls(orbit.model, orbit.amplitude), orbit.phase[1], orbit.impact_velocity[1]
    other = of_impact(*second, 2)
    faster = other.relative_impact_velocity[::-1] - orbit.relative_impact_velocity
    assert np.abs(faster).max() < 1e-12


def test_restitution_and_damping_ratio_are_one_parameter(refusal):
    """Along one of them the other one follows, and is not kept at its first value."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    one = bouncing_ball_beyond.orbit(ball, amplitude=1.0)
    found = bouncing_ball_beyond.follow(one, along="restitution", to=0.7).to_dataset()
    *_, last = found.states()
    less = bouncing_ball_beyond.follow(last, along="damping_ratio", to=0.01).to_dataset()
    assert less.damping_ratio[0] == pytest.approx(float(damping_ratio(0.7)), abs=1e-15)
    *_, damped = less.states()
    back = bouncing_ball_beyond.follow(damped, along="restitution", to=0.7).to_dataset()
    assert abs(back.phase[-1, 0] - found.phase[-1, 0]) < 1e-13
    assert {"restitution", "damping_ratio"}.isdisjoint(found.attrs)
    with refusal(ParameterError, "damping_ratio follows from restitution: both cannot vary"):
        fold = replace(last, kind="saddle-node")
        bouncing_ball_beyond.follow(fold, along=("restitution", "damping_ratio"))


def passes_through(found, y):
    """Whether a branch has a solution that is y to rounding.

    The branch is corrected onto the plane through the state across its direction, from each step
    that crosses this plane.
    """
    problem = found.problem
    points = found.branch.points
    direction = np.linalg.svd(problem.jacobian(y))[2][-1]
    side = (points - y) @ direction
    crossing = np.flatnonzero((side[1:] >= 0) != (side[:-1] >= 0))
    chord = points[crossing + 1] - points[crossing]
    share = side[crossing] / (side[crossing] - side[crossing + 1])
    guess = points[crossing] + share[:, np.newaxis] * chord
    with np.errstate(all="ignore"):
        there = newton(problem, guess, plane(direction, np.broadcast_to(y, guess.shape)))
    gap = np.linalg.norm(there.point - y, axis=-1)
    # Near a fold or where an impact is slow, rounding is enlarged.
    return bool(np.any(there.converged & (gap < 1e-9)))


@pytest.mark.long
@pytest.mark.parametrize("name", CLOSED[:3])
def test_two_hundred_random_orbits_are_followed_without_a_jump(name):
    """Twenty steps there, also past special orbits, and back again: the branch meets its start."""
    random = np.random.default_rng(4)
    count = 0
    special = 0
    while count < 67:
        lam, r, ratio = random.uniform([1.0, 0.3, 3.0], [3.0, 0.9, 60.0])
        model = balls(name, lam, r, ratio).model
        phase, speed = random.uniform([-3.0, 1.0], [3.0, 6.0])
        try:
            orbit = of_motion(model, lam, phase, lam * np.cos(phase) - speed, 1500)
        except NoOrbitError:
            continue
        sticks = legs_of(orbit).departure.sticks
        if orbit.impacts > 12 or np.any(sticks & (name == "restitution")):
            continue
        count += 1
        there = branch_from(orbit, most=20)
        special += bool(there.special)
        # The last point may be a special orbit that ends the branch.
        last = orbit_of_point(there.problem, there.branch.points[-2])
        rises = there.branch.tangents[-2, -1] > 0
        back = branch_from(last, increasing=not rises, most=120)
        # The phases of the last orbit are between -π and π; those of the branch may have left it.
        start = point_of(orbit, there.problem)
        phases, _ = there.problem.states(there.branch.points[-2])
        turned = np.round((last.phases - phases) / (2 * np.pi))
        start[: 2 * orbit.impacts : 2] += 2 * np.pi * turned
        assert passes_through(back, start), (count, lam, r, ratio, phase, speed)
    assert special > 10


@pytest.mark.parametrize("case", FOUND[:2])
def test_a_branch_gives_its_orbits_one_by_one(case):
    impacts = case[1]
    found = branch_from(found_orbit(case), to=1.36)
    orbits = list(found)
    assert len(orbits) == len(found) and all(each.defect() < 1e-11 for each in orbits)
    assert orbits[0].impacts == impacts and f"impacts               {impacts}" in repr(orbits[0])


@pytest.mark.parametrize("name", ["rigid", "spring-damper", "corrected", "law"])
def test_an_orbit_that_no_ball_follows_starts_its_branch(name):
    linear = bouncing_ball_beyond.spring_damper(restitution=0.6, frequency_ratio=1000.0)
    ball = {
        "rigid": bouncing_ball_beyond.rigid(restitution=0.6),
        "spring-damper": linear,
        "corrected": bouncing_ball_beyond.corrected(linear),
        "law": bouncing_ball_beyond.contact_law("hunt-crossley", stiffness=1e7, damping=0.2),
    }[name]
    for n in (1, 3):
        orbit = bouncing_ball_beyond.orbit(ball, n, amplitude=6.0 * n, side="unstable")
        assert not orbit.is_admissible()
        found = bouncing_ball_beyond.follow(orbit, to=5.9 * n).to_dataset()
        first = next(iter(found.states()))
        assert (first.impacts, first.periods) == (1, n)
        # The last Newton step of both is below 1e-12 of y, which is of order 10.
        other = bouncing_ball_beyond.orbit(ball, n, amplitude=5.9 * n, side="unstable")
        for k, here in ((0, orbit), (-1, other)):
            assert found.multiplier_real[k].values == pytest.approx(
                here.multipliers().real, rel=1e-11
            )


@pytest.mark.parametrize("amplitude_max", [None, 6.0])
def test_a_whole_branch_has_its_orbits_and_its_words_are_those_of_follow(amplitude_max):
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    whole = bouncing_ball_beyond.branch(ball, amplitude_max=amplitude_max, points=200)
    there = bouncing_ball_beyond.orbit(ball, amplitude=1.0)
    kinds = {
        orbit.kind: orbit
        for to in (0.1, 5.9)
        for _, orbit in bouncing_ball_beyond.follow(there, to=to).special_states()
    }
    assert [kind for kind, _ in whole.special_states()] == whole.special_kind.values.tolist()
    for kind in ("saddle-node", "period doubling"):
        assert whole.first(kind).amplitude == pytest.approx(kinds[kind].amplitude, abs=1e-12)
    orbits = list(whole.states())
    assert len(orbits) == 200
    assert [each.amplitude for each in orbits] == whole.amplitude.values.tolist()
    top = whole.amplitude.values.max()
    assert str(whole.end_reason[1].values) == f"amplitude = {top:g} is reached"
    with pytest.raises(NoOrbitError, match="the branch has no end of sticking"):
        whole.first("end of sticking")


def test_of_several_branches_one_is_selected(refusal):
    ball = bouncing_ball_beyond.rigid(restitution=0.5)
    several = bouncing_ball_beyond.branch(ball, n=[1, 2], points=10)
    with refusal(ModelError, "these are orbits of several balls: select one of n with isel"):
        several.first("saddle-node")
    for n in (1, 2):
        alone = bouncing_ball_beyond.branch(ball, n=n, points=10)
        assert several.sel(n=n).special_states() == alone.special_states()
        assert list(several.sel(n=n).states()) == list(alone.states())


def test_a_branch_with_an_even_number_of_impacts_passes_a_difference_of_half_a_turn():
    """Its doubling, and stable orbits beyond it, which simulated balls follow."""
    orbit = of_motion(balls("restitution", 1.6).model, 1.6, 1.0, -3.0)
    found = branch_from(orbit, "restitution", 1.0)
    assert str(found.branch.end) == "restitution = 1 is reached"
    doublings = [each for each in found.special if each.kind == Special.PERIOD_DOUBLING]
    # Located by a code with 40 digits.
    assert doublings[-1].model.impact_law == pytest.approx(0.983289547688, abs=1e-12)
    beyond = [each for each in found if 0.9605 < each.model.impact_law < 0.9999]
    assert len(beyond) > 2
    stable = [each for each in beyond if each.is_stable() and each.is_admissible()]
    assert stable
    for each in stable:
        simulated = each.model.simulate(1.6, each.phase[0], each.impact_velocity[0], 200)
        returns = simulated.relative_velocity[::2] - simulated.relative_velocity[0]
        assert np.abs(returns).max() < 1e-9


def test_an_orbit_with_an_odd_number_of_periods_has_no_halves():
    """Its second half never repeats the first, because the table is at another phase."""
    case = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.5), 3, amplitude=4.0)
    whole, y = twice(*equations_of(case, "amplitude"))
    assert turns_apart(whole, y) == 0.0
    odd = replace(whole, turns=np.array([1, 2]))
    assert turns_apart(odd, y) == 1.0


def test_without_a_value_a_branch_ends_at_ten_times_its_first_value(refusal):
    orbit = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.3), amplitude=2.0)
    found = bouncing_ball_beyond.follow(orbit).to_dataset()
    assert str(found.end_reason[1].values) == "amplitude = 20 is reached"


def test_an_end_behind_the_start_says_what_it_is():
    """Behind its saddle-node the branch comes back; nobody has given 1.9."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    found = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(ball, amplitude=1.0), to=0.1
    ).to_dataset()
    assert found.first("saddle-node").amplitude > 0.1
    assert str(found.end_reason[1].values) == (
        "amplitude = 1.9 is reached, as far behind the start as the given value is ahead of it; "
        f"amplitude = 0.1 is beyond the saddle-node at {found.first('saddle-node').amplitude:.6g}"
    )
    assert float(found.amplitude[-1]) == pytest.approx(1.9, rel=1e-12)


def test_a_branch_of_one_family_is_described_as_one_that_is_followed():
    """Both come from one function; the branch of a family has no axis of its impacts."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    whole = bouncing_ball_beyond.branch(ball, n=2, points=40)
    part = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(ball, 2, amplitude=2.0), to=2.5
    ).to_dataset()
    assert {name: whole[name].dims for name in whole.data_vars} == {
        name: tuple(dim for dim in part[name].dims if dim != "impact") for name in part.data_vars
    }
    assert all(whole[name].attrs == part[name].attrs for name in whole.data_vars)
    for name in ("impacts", "periods", "along", "restitution", "frequency_ratio"):
        assert whole.attrs[name] == part.attrs[name]
    several = bouncing_ball_beyond.branch(ball, n=[1, 2], points=40)
    assert several.attrs["impacts"] == 1 and "periods" not in several.attrs
    # A part with one of the impacts has the figure of its phase.
    (line, *_) = part.isel(impact=0).plot().axes[0].lines
    (same, *_) = part.plot().axes[0].lines
    np.testing.assert_array_equal(line.get_xydata(), same.get_xydata())


def test_the_limits_of_a_family_know_what_they_are():
    """From a saddle-node the stable side is followed, and from a doubling the doubled branch."""
    fold, doubling = bouncing_ball_beyond.limits(bouncing_ball_beyond.rigid(restitution=0.5))
    assert (fold.kind, doubling.kind) == ("saddle-node", "period doubling")
    side = bouncing_ball_beyond.follow(fold, to=1.5).to_dataset()
    assert side.stable[1:-1].all() and side.special_kind.values.tolist() == []
    # Below the saddle-node there is no orbit: the same branch is followed, and says so.
    below = bouncing_ball_beyond.follow(fold, to=0.6).to_dataset()
    assert below.stable[1:-1].all() and float(below.amplitude[-1]) > fold.amplitude
    (_, end) = below.end_reason.values
    assert end.endswith(f"; amplitude = 0.6 is beyond the saddle-node at {fold.amplitude:.6g}")
    assert bouncing_ball_beyond.follow(doubling, to=1.6).to_dataset().attrs["impacts"] == 2
    elastic = bouncing_ball_beyond.limits(
        bouncing_ball_beyond.contact_law("tsuji", stiffness=900.0, damping=0.0)
    )
    assert elastic.saddle_node.kind == "saddle-node"


def test_a_point_that_is_no_period_doubling_is_not_switched(refusal):
    """A grazing at Λ = 4.597 gave an orbit at 2.805, and a fold at 1.0472 one at 1.527."""
    ball = bouncing_ball_beyond.rigid(restitution=0.5)
    fold, _ = bouncing_ball_beyond.limits(ball)
    unstable = bouncing_ball_beyond.orbit(ball, amplitude=2.0, side="unstable")
    for point in (fold, unstable):
        with refusal(NoOrbitError, "the orbit is no period doubling: det(M + 1) = "):
            bouncing_ball_beyond.follow(replace(point, kind="period doubling"))
        with refusal(NoOrbitError, "the orbit is no period doubling: det(M + 1) = "):
            switch(point)


@pytest.mark.parametrize("ratio", [1.5, 2.0])
def test_a_branch_that_merges_with_permanent_contact_says_so(ratio):
    """Its points accumulate there: 500 of them were followed to no end at ϖ = 1.5."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=ratio)
    found = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(ball, amplitude=0.9), to=0.01
    ).to_dataset()
    assert "merges with permanent contact" in str(found.end_reason[1].values)
    assert float(found.amplitude[-1]) == pytest.approx(float(ball.permanent_contact_threshold()))
    assert found.sizes["point"] < 200


def test_a_branch_ends_at_its_limit_also_where_the_flight_nearly_vanishes():
    """At ζ = 1.4e-10 the flight is so short that the end was taken for that of vanishing flights;
    the branch goes on to ζ = 0, where the flight lasts for 0.0076.
    """
    ball = bouncing_ball_beyond.spring_damper(damping_ratio=1e-3, frequency_ratio=1.3)
    whole = bouncing_ball_beyond.branch(ball, amplitude_max=3.0, points=400)
    flights = 2 * np.pi - whole.contact_duration.values
    start = list(whole.states())[int(np.argmin(np.abs(np.log(flights / 0.0023))))]
    found = bouncing_ball_beyond.follow(start, along="damping_ratio", to=0.0).to_dataset()
    assert str(found.end_reason[1].values) == "damping ratio = 0 is reached"
    assert found.damping_ratio[-1] == 0
    *_, last = found.states()
    assert last.flight_time == pytest.approx(0.0076, abs=5e-5) and last.defect() < 1e-12


def test_an_orbit_on_a_resting_table_is_not_followed(refusal):
    """The saddle-node of an elastic ball is at Λ = 0, where all phases are the same orbit."""
    fold, _ = bouncing_ball_beyond.limits(bouncing_ball_beyond.rigid(restitution=1.0))
    with refusal(NoOrbitError, "the table rests at this orbit, where the phase has no meaning"):
        bouncing_ball_beyond.follow(fold, to=0.5)


def test_a_closed_branch_ends_at_its_start():
    """A loop in r; followed on, the branch would pass its special orbits again and again."""
    ball = bouncing_ball_beyond.rigid(restitution=0.49711198038140114)
    orbit = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=3.2407106247114794)
    found = bouncing_ball_beyond.follow(orbit, along="restitution", to=0.62).to_dataset()
    assert str(found.end_reason[-1].values) == "the branch is closed: it comes back to its start"
    first, *_, last = found.states()
    # The start is an orbit where a ball ends; the first point is that orbit, corrected.
    assert float(last.distance(first)) == 0.0
    assert np.all(np.diff(found.special_point) >= 0)
    again = {
        (kind, round(orbit.parameters["restitution"], 9)) for kind, orbit in found.special_states()
    }
    assert len(again) == found.sizes["special"] == 12


def test_next_to_the_end_of_a_range_a_steep_height_is_no_jump():
    """On this 3-T orbit the height of the landing changes by 250 for r, and r = 1 is the end."""
    orbit = bouncing_ball_beyond.orbit(
        bouncing_ball_beyond.rigid(restitution=0.8), n=3, amplitude=1.24
    )
    found = bouncing_ball_beyond.follow(orbit, along="restitution", to=1.0).to_dataset()
    assert str(found.end_reason[1].values) == "restitution = 1 is reached"
    # A parameter enters as arsinh, and comes back as sinh.
    assert float(found.restitution[-1]) == pytest.approx(1.0, abs=4 * np.finfo(float).eps)
    assert float(found.phase[-1, 0]) == pytest.approx(np.pi / 2, abs=1e-12)


BOTH = [
    (bouncing_ball_beyond.rigid(restitution=0.85), 1),
    (bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0), 2),
]


@pytest.mark.parametrize(("ball", "n"), BOTH)
def test_a_branch_is_followed_both_ways_in_one_call(ball, n):
    """The two branches from the orbit, one after another."""
    orbit = bouncing_ball_beyond.orbit(ball, n, amplitude=1.0)
    low, high = 0.1, 1.4
    whole = bouncing_ball_beyond.follow(orbit, to=(low, high)).to_dataset()
    fold, doubling = bouncing_ball_beyond.limits(ball, n)
    places = {kind: each.amplitude for kind, each in whole.special_states()}
    assert places["saddle-node"] == pytest.approx(fold.amplitude, rel=1e-11)
    assert places["period doubling"] == pytest.approx(doubling.amplitude, rel=1e-11)
    assert np.all(np.diff(whole.special_point) >= 0)
    assert whole.end_reason.values.tolist() == 2 * ["amplitude = 1.4 is reached"]
    # It begins on the unstable side, behind the saddle-node.
    assert not whole.stable[0] and float(whole.amplitude[0]) == pytest.approx(1.4, rel=1e-12)
    up = bouncing_ball_beyond.follow(orbit, to=high).to_dataset()
    np.testing.assert_array_equal(whole.phase.values[-len(up.point) :], up.phase.values)
    # From the saddle-node to both sides it is the same branch.
    of_fold = bouncing_ball_beyond.follow(fold, to=(low, high)).to_dataset()
    for end in (0, -1):
        assert of_fold.phase[end].values == pytest.approx(whole.phase[end].values, abs=1e-11)
    assert "saddle-node" in of_fold.special_kind.values


def test_both_ways_there_is_no_other_branch(refusal):
    doubling = bouncing_ball_beyond.limits(BOTH[0][0]).period_doubling
    with refusal(NoOrbitError, "from a period doubling another branch leaves"):
        bouncing_ball_beyond.follow(doubling, to=(0.5, 1.5))
    orbit = bouncing_ball_beyond.orbit(BOTH[0][0], amplitude=1.0)
    with refusal(ParameterError, "the range 1.1 to 1.2 does not contain amplitude = 1"):
        bouncing_ball_beyond.follow(orbit, to=(1.1, 1.2))
    with refusal(ParameterError, "to = -1.0 is not a number in"):
        bouncing_ball_beyond.follow(orbit, to=(-1.0, 1.2))


@pytest.mark.parametrize(
    ("ball", "along", "to"),
    [
        (BOTH[1][0], "damping_ratio", 0.0),
        (BOTH[1][0], "restitution", 1.0),
        (BOTH[0][0], "restitution", 1.0),
    ],
)
def test_a_branch_ends_at_the_end_of_a_range_in_a_few_steps(ball, along, to):
    """There are no balls beyond it: the steps became ever shorter, in 28 rounds in place of 9."""
    found = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(ball, amplitude=1.0), along=along, to=to
    ).to_dataset()
    # A parameter comes back from arsinh with a rounding error.
    assert float(found[along][-1]) == pytest.approx(to, abs=4 * np.finfo(float).eps)
    assert str(found.end_reason[1].values) == f"{along.replace('_', ' ')} = {to:g} is reached"
    assert np.abs(np.diff(found[along].values)).min() > 1e-5
    *_, last = found.states()
    assert last.defect() < 1e-12


def test_a_branch_says_what_its_dataset_says():
    """The record has no labels, and the dataset that is made of it has the same orbits."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.65, frequency_ratio=20.0)
    one = bouncing_ball_beyond.orbit(ball, amplitude=0.8)
    branch = bouncing_ball_beyond.follow(one, to=(0.3, 2.0))
    data = branch.to_dataset()
    assert len(branch) == data.sizes["point"] and branch.along == (data.attrs["along"],)
    assert [branch.start_reason, branch.end_reason] == data.end_reason.values.tolist()
    assert (branch.impacts, branch.periods) == (data.attrs["impacts"], data.attrs["periods"])
    assert list(branch.states()) == list(data.states())
    assert branch.special_states() == data.special_states()
    assert branch.first("saddle-node") == data.first("saddle-node")
    assert branch.orbits.is_stable().tolist() == data.stable.values.tolist()
    assert branch.orbits.is_admissible().tolist() == data.admissible.values.tolist()
    # In order along the branch, which begins at the smaller end of the range.
    places = [orbit.amplitude for _, orbit in branch.special_states()]
    assert len(places) == 2 and data.special_amplitude.values.tolist() == places
    assert branch.orbits.parameters["amplitude"].tolist() == data.amplitude.values.tolist()
    # The orbit at an end, whose parameter has a rounding error, is in the range up to this end.
    whole = bouncing_ball_beyond.follow(branch.orbits[-1], to=(0.3, 2.0))
    assert [kind for kind, _ in whole.special_states()] == ["saddle-node", "period doubling"]
    rows = repr(branch).splitlines()
    assert rows[0] == "FollowedBranch" and rows[-1].endswith(branch.end_reason)
    assert pickle.loads(pickle.dumps(branch)).special_states() == branch.special_states()
