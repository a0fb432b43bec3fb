"""Where sticking ends: against the self-similar bounces before the lift-off, in 60 digits.

Near the lift-off the relative gravity falls linearly to 0 as c s, with s the phase left and
c = √(Λ² - 1). With v = c w s² after an impact and a flight over the part u of s, the flight and the
impact (Eq. 2) are ::

    w = u/2 - u²/6,    w′ = r (u/2 - u²/3)/(1 - u)²

The fixed point w* separates balls that come to rest from those that do not; there u is the zero of
u³ - 5u² + (7 - 2r) u - 3 (1 - r) in (0, 1). After j bounces w depends smoothly on the parameter.
"""

from functools import cache, partial

import numpy as np
import pytest
from mpmath import findroot, mp, mpf, workdps
from orbits_found import balls, first

import bouncing_ball_beyond
from bouncing_ball_beyond.motions.orbit_of_motion import of_motion
from bouncing_ball_beyond.periodic.branches import curves
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.branches.sticking_curve import sticking_curve
from bouncing_ball_beyond.periodic.orbits.special import Special

# The zeros of w - w* after j and j + 3 bounces are then equal to rounding.
SETTLED = 1e-17


def fixed_point(r):
    def cubic(u):
        return u**3 - 5 * u**2 + (7 - 2 * r) * u - 3 * (1 - r)

    u = findroot(cubic, (0, 1), solver="anderson")
    return u / 2 - u**2 / 6


def bounce(phase, velocity, lam, r, guess):
    """The impact after a flight that starts on the table, near a time, and δ′ after it."""

    def gap(t):
        fall = mp.sin(phase) - mp.sin(phase + t)
        return lam * fall + (lam * mp.cos(phase) + velocity) * t - t**2 / 2

    def rate(t):
        return lam * (mp.cos(phase) - mp.cos(phase + t)) + velocity - t

    t = mpf(guess)
    step = t
    # Newton's method squares the error, which is then below that of 60 digits.
    while abs(step) > mpf(1e-24) * t:
        step = gap(t) / rate(t)
        t -= step
    return phase + t, -r * rate(t)


def late(lam, r, flights, more):
    """w after the flights from a lift-off, of about these durations, and after more bounces."""
    start = mp.asin(1 / lam)
    phase = start
    velocity = mpf(0)
    for guess in flights:
        phase, velocity = bounce(phase, velocity, lam, r, guess)
    lift_off = start + 2 * mp.pi * mp.ceil((phase - start) / (2 * mp.pi))

    def share():
        return velocity / (mp.sqrt(lam**2 - 1) * (lift_off - phase) ** 2)

    for _ in range(more):
        part = (3 - mp.sqrt(9 - 24 * share())) / 2
        phase, velocity = bounce(phase, velocity, lam, r, part * (lift_off - phase))
    return share()


@cache
def ended(along, amplitude, restitution, to):
    orbit = of_motion(balls("restitution", amplitude, restitution).model, amplitude, 1.0, -5.0)
    found = branch_from(orbit, along, to)
    assert str(found.branch.end).startswith("end of sticking")
    return first(found, Special.STICKING)


CASES = [
    ("amplitude", 1.3744, 0.4847, 2.4),
    ("amplitude", 2.4643, 0.5577, 1.1),
    ("restitution", 3.4664, 0.2341, 0.9),
    ("restitution", 1.3744, 0.4847, 0.9),
]


# One along each parameter, and the others weekly.
@pytest.mark.parametrize(
    ("along", "amplitude", "restitution", "to"),
    [CASES[0], CASES[2], *(pytest.param(*x, marks=pytest.mark.long) for x in CASES[1:4:2])],
)
def test_sticking_ends_where_the_bounces_become_self_similar(along, amplitude, restitution, to):
    self_similar(ended(along, amplitude, restitution, to), along, amplitude, restitution)


# The phases of the impacts, and thus the place of an end, have some roundings; the largest of the
# differences at the twelve points of a curve is 1.3e-13, rounded up.
ONE = 1e-13
ON_A_CURVE = 2e-13


def self_similar(orbit, along, amplitude, restitution, within=ONE):
    """Check the end of sticking along a parameter, at a value of the other one."""
    rest = orbit.contact_duration
    (sticks,) = np.flatnonzero(rest > 0)
    flights = np.roll(orbit.flight_time, -sticks)
    place = orbit.parameters[along]

    def excess(p, more):
        lam, r = (p, mpf(restitution)) if along == "amplitude" else (mpf(amplitude), p)
        return late(lam, r, flights, more) - fixed_point(r)

    with workdps(60):
        zeros = [mpf(place), mpf(place) * (1 + mpf(1e-15))]
        # The bounces enlarge w - w*, so that only the last zeros are near enough to start from.
        while abs(zeros[-1] - zeros[-2]) > SETTLED:
            more = 3 * len(zeros)
            assert more < 60
            beside = zeros[-1] + (zeros[-1] - zeros[-2]) / 100
            zeros.append(findroot(partial(excess, more=more), (zeros[-1], beside), tol=1e-30))
        assert abs(zeros[-1] - place) < within


@pytest.mark.parametrize("case", [CASES[0], CASES[2]])
def test_a_simulated_ball_rests_in_its_first_turn_before_the_end_and_not_beyond_it(case):
    """On both sides of the end, from the lift-off on."""
    along, amplitude, restitution, to = case
    orbit = ended(*case)
    ahead = np.sign(to - {"amplitude": amplitude, "restitution": restitution}[along])
    for aside, expected in ((-1e-9, True), (1e-9, False)):
        known = {"amplitude": amplitude, "restitution": restitution}
        known[along] = orbit.parameters[along] + ahead * aside
        lam, r = known.values()
        model = balls("restitution", lam, r).model
        run = model.simulate(lam, np.arcsin(1 / lam), np.sqrt(lam**2 - 1), 300)
        rests = run.time[1:][run.settling[1:] > 0]
        assert bool(rests.size and rests[0] < 2 * np.pi * orbit.periods) is expected


@pytest.fixture(scope="module")
def curve_of_ends():
    """A curve in two parameters, as a user follows it, and as it was found."""
    found = []

    def kept(*arguments):
        found.append(sticking_curve(*arguments))
        return found[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(curves, "sticking_curve", kept)
        curve = bouncing_ball_beyond.follow(
            ended(*CASES[0]),
            along=("amplitude", "restitution"),
            ranges={"restitution": (0.484, 0.487)},
            points=10,
        )
    (branch,) = found
    return curve, branch


@pytest.mark.slow
def test_the_bounces_are_self_similar_along_a_curve_in_two_parameters(curve_of_ends):
    curve, _ = curve_of_ends
    reasons = curve.start_reason, curve.end_reason
    assert reasons == tuple(f"restitution = {r} is reached" for r in (0.484, 0.487))
    assert curve.kind == "end of sticking"
    # Rounding decides whether a point more lies between the ends.
    below, *_, above, _ = curve.states()
    assert below.defect() < 1e-12 and above.defect() < 1e-12
    r = above.model.impact_law
    self_similar(above, "amplitude", above.amplitude, r, within=ON_A_CURVE)


@pytest.mark.slow
def test_a_curve_of_ends_has_the_directions_from_point_to_point(curve_of_ends):
    """Its points are found one by one, and have no tangent of their own."""
    _, curve = curve_of_ends
    chords = curve.points[2:] - curve.points[:-2]
    assert len(chords) > 0
    lengths = np.linalg.norm(chords, axis=-1, keepdims=True)
    np.testing.assert_allclose(curve.tangents[1:-1], chords / lengths, rtol=0, atol=1e-12)


@pytest.mark.long
def test_a_curve_consists_of_balls_that_rest_and_turns_back_in_both_parameters():
    """It ended next to the place where r turns back, and before at an orbit without a rest."""
    orbit = ended(*CASES[1])
    curve = bouncing_ball_beyond.follow(
        orbit, along=("amplitude", "restitution"), ranges={"restitution": (0.55, 0.7)}, points=40
    ).to_dataset()
    first, last = (str(reason) for reason in curve.end_reason.values)
    assert (first, last) == ("restitution = 0.55 is reached", "restitution = 0.55 is passed")
    points = list(curve.states())
    assert all(np.any(point.contact_duration > 0) for point in points)
    turns = [np.argmin(curve.amplitude.values), np.argmax(curve.restitution.values)]
    assert 0 < turns[0] < turns[1] < len(points) - 1
    # Next to the turn r is known at a given Λ, and Λ at a given r beyond it.
    for number, along in ((turns[1], "restitution"), (-3, "amplitude")):
        one = points[number]
        self_similar(one, along, one.amplitude, one.model.impact_law, within=ON_A_CURVE)


def test_a_branch_ends_where_all_flights_before_a_rest_vanish():
    """At Λ = 1 the table no longer falls faster than the ball.

    The branch crept, in 500 steps; 60 to 110 are needed, which rounding decides.
    """
    orbit = bouncing_ball_beyond.orbit_of_motion(
        bouncing_ball_beyond.rigid(restitution=0.218813), amplitude=1.191588
    )
    found = bouncing_ball_beyond.follow(orbit, to=0.95327).to_dataset()
    assert found.attrs["impacts"] == 8
    why = str(found.end_reason.values[-1])
    assert why == "the flights vanish: the orbit merges with permanent contact"
    assert found.sizes["point"] < 250
    # The flights last 0.01 in all. The ball leaves and lands where sin φ is about 1/Λ.
    *_, last = found.states()
    aloft = 2 * np.pi - last.durations.sum()
    assert aloft == pytest.approx(0.01, abs=1e-9)
    assert 0 < last.amplitude - 1 < aloft**2
    assert found.residual.max() < 1e-12


def test_a_branch_with_bounces_that_shrink_by_a_hundred_ends_at_permanent_contact():
    """At r = 0.01 the fourth impact has a millionth of the speed of the first one. The branch crept
    towards Λ = 1, in 500 steps; 5 to 60 are needed, which rounding decides.
    """
    orbit = bouncing_ball_beyond.orbit_of_motion(
        bouncing_ball_beyond.rigid(restitution=0.01), amplitude=1.0005
    )
    found = bouncing_ball_beyond.follow(orbit, to=0.5).to_dataset()
    assert found.attrs["impacts"] == 4
    why = "permanent contact: at a smaller Λ a ball at rest stays on the table"
    assert str(found.end_reason.values[-1]) == why
    assert found.sizes["point"] < 250
    assert 0 < float(found.amplitude[-1]) - 1 < 2e-4
