"""Branches and cascades against closed forms, the replication, simulation and universal ratios."""

import mpmath
import numpy as np
import pytest
from integrated import around, leg
from scipy.optimize import brentq, fsolve

from bouncing_ball.continuation import bifurcations
from bouncing_ball.spring_damper import Contact
from bouncing_ball_beyond.contacts.balls import Corrected, Rigid, SpringDamper, damping_of
from bouncing_ball_beyond.contacts.named_laws import hunt_crossley, kuwabara_kono, tsuji
from bouncing_ball_beyond.periodic import continuation
from bouncing_ball_beyond.periodic.branches import FollowedBranch
from bouncing_ball_beyond.periodic.continuation import cascade, follow, limits
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.march import LARGEST_TURN, newton
from bouncing_ball_beyond.periodic.orbits import OrbitNotFound, orbit, orbits

# Special orbits are located to some rounding errors of their tests, over the slopes of these.
LOCATED = 1e-10


def saddle_node(n, r):
    """Λ of the saddle-node of the restitution model (Eq. 7)."""
    return n * np.pi * (1 - r) / (1 + r)


def period_doubling(n, r):
    """Λ of its period doubling, where 1 + tr + det = 0 for the exact map (Eq. 5)."""
    return np.hypot(saddle_node(n, r), 2 * (1 + r * r) / (1 + r) ** 2)


@pytest.mark.parametrize(("n", "r"), [(1, 0.3), (1, 0.85), (2, 0.6), (3, 0.95)])
def test_along_the_amplitude_special_orbits_are_the_closed_form(n, r):
    fold, flip = saddle_node(n, r), period_doubling(n, r)
    start = orbit(Rigid(r), amplitude=(fold + flip) / 2, n=n)
    branch = follow(start, to=(0.9 * fold, 1.1 * flip))
    assert [special.kind for special in branch.special] == ["saddle-node", "period doubling"]
    amplitudes = [special.amplitude for special in branch.special]
    assert amplitudes == pytest.approx([fold, flip], abs=LOCATED)
    # At the saddle-node the phase is 0; the stable part is between it and the doubling.
    above = np.array([periodic_orbit.phase > 0 for periodic_orbit in branch.orbits])
    assert np.array_equal(branch.stable, above & (branch.values < flip))
    assert limits(Rigid(r), n=n).saddle_node.amplitude == pytest.approx(fold, abs=LOCATED)
    assert limits(Rigid(r), n=n).period_doubling.amplitude == pytest.approx(flip, abs=LOCATED)


def test_along_the_restitution_special_orbits_are_the_closed_form():
    amplitude = 1.4
    branch = follow(orbit(Rigid(0.5), amplitude=amplitude), along="restitution", to=0.2)
    flip = brentq(lambda r: period_doubling(1, r) - amplitude, 0.5, 0.7)
    fold = brentq(lambda r: saddle_node(1, r) - amplitude, 0.2, 0.5)
    assert branch.first("saddle node").ball.restitution == pytest.approx(fold, abs=LOCATED)
    # Behind the saddle-node the branch comes back to r = 0.8, as far behind the start.
    assert branch.end.startswith("restitution = 0.8 is reached, on the other side of the start")
    assert branch.end.endswith(f"restitution = 0.2 is beyond the saddle-node at {fold:.10g}")
    other = follow(orbit(Rigid(0.5), amplitude=amplitude), along="restitution", to=1.0)
    assert other.first("period-doubling").ball.restitution == pytest.approx(flip, abs=LOCATED)
    assert other.end == "restitution = 1 is reached" and other.values[-1] == 1.0


def test_a_branch_that_comes_back_stays_in_the_range_of_its_parameter():
    start = orbit(Rigid(0.953), n=3, amplitude=1.155)
    branch = follow(start, along="restitution", to=0.25)
    assert branch.values[-1] == 1.0 and branch.values.max() == 1.0
    assert branch.end.startswith("restitution = 1 is reached, on the other side of the start")


def test_only_an_orbit_of_even_numbers_has_halves():
    """Half a period later the table is at another phase if the number of periods is odd."""
    two = orbits(Rigid(0.8), impacts=2, periods=3, amplitude=1.3)[0]
    assert (two.equations.halves(two.z[np.newaxis]) == 1).all()
    one = orbit(Rigid(0.8), amplitude=1.0)
    twice, z = one.equations.doubled(one.z[np.newaxis])
    assert np.abs(twice.halves(z)).max() == 0


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_along_any_parameter_special_orbits_are_those_of_the_replication(release):
    """The doubling at some ϖ is reached along Λ, along ϖ, along ζ and along the frequency."""
    ratio, zeta = 6.0, float(damping_of(0.7))
    contact = Contact(ratio, zeta, release)
    y = bifurcations(1, "period doubling", contact)[:, 0, 0]
    amplitude = y[0]
    ball = SpringDamper(ratio, damping_ratio=zeta, release=release)
    root = np.sqrt(amplitude)
    before = ball.at(frequency_ratio=ratio / np.sqrt(0.9))
    along = {
        "amplitude": (ball, 0.9 * amplitude, 1.1 * amplitude, amplitude),
        "frequency_ratio": (ball.at(frequency_ratio=4.0), amplitude, 9.0, ratio),
        "damping_ratio": (ball.at(damping_ratio=zeta + 0.02), amplitude, zeta - 0.05, zeta),
        "frequency": (before, 0.9 * amplitude, 1.1 * root, root),
    }
    for name, (start, at, to, expected) in along.items():
        branch = follow(orbit(start, amplitude=at), along=name, to=to)
        doublings = [
            special.z[-1] for special in branch.special if special.kind == "period doubling"
        ]
        assert min(abs(np.array(doublings) - expected)) < LOCATED, name


@pytest.mark.parametrize(
    ("ratio", "n", "expected"),
    [(0.61, 1, 1.99987969629), (2.2260684470825036, 2, 1.0486083123)],
)
def test_limits_without_damping(ratio, n, expected):
    """The doubling is at Λ = |1 - 1/ϖ²|/|cos(π/2ϖ)|, and there is no saddle-node above Λ = 0."""
    orbit_limits = limits(SpringDamper(ratio, damping_ratio=0.0), n=n)
    formula = abs(1 - 1 / ratio**2) / abs(np.cos(np.pi / (2 * ratio)))
    assert isinstance(orbit_limits.saddle_node, OrbitNotFound)
    assert orbit_limits.period_doubling.amplitude == pytest.approx(expected, abs=2e-10)
    assert orbit_limits.period_doubling.amplitude == pytest.approx(formula, abs=LOCATED)


def first_doubling(ball, amplitude, to=3.0):
    return follow(orbit(ball, amplitude=amplitude), to=to).first("period doubling")


def test_an_elastic_cascade_has_the_doublings_that_a_fixed_first_step_loses():
    """The doubling of 16 impacts is at 1.26595802161 in 40 digits; the ratio tends to 8.7211."""
    doubling = first_doubling(Rigid(1.0), 0.5)
    branches = cascade(doubling, to=3.0)
    assert [branch.impacts for branch in branches] == [2, 4, 8, 16, 32, 64]
    values = np.array([doubling.amplitude, *(branch.values[-1] for branch in branches)])
    assert values[5] == pytest.approx(1.26595802161, abs=5e-12)
    gaps = np.diff(values)
    assert gaps[-2] / gaps[-1] == pytest.approx(8.7211, rel=1e-3)


@pytest.mark.parametrize(
    "ball",
    [
        Rigid(0.5),
        SpringDamper(30.0, restitution=0.6),
        SpringDamper(8.0, restitution=0.5, release="force"),
        Corrected(SpringDamper(12.0, restitution=0.55)),
    ],
)
def test_cascades_are_complete_up_to_64_impacts(ball):
    """The ratio of successive intervals tends to 4.6692, with errors that fall as its powers."""
    doubling = limits(ball).period_doubling
    branches = cascade(doubling, to=4.0)
    assert [branch.impacts for branch in branches] == [2, 4, 8, 16, 32, 64]
    values = np.array([doubling.amplitude, *(branch.values[-1] for branch in branches)])
    gaps = np.diff(values)
    assert gaps[-2] / gaps[-1] == pytest.approx(4.6692, rel=2e-3)
    if ball == Rigid(0.5):
        assert values[6] == pytest.approx(1.70491466, abs=5e-9)
    # Between two doublings orbits are stable; one with a multiplier of 1 or -1 is at each end.
    for branch in branches:
        assert branch.stable[1:-1].all() and branch.admissible[1:-1].all()


@mpmath.workdps(30)
def hessian_of_action(psi):
    """det ∂²W of an elastic ball with impacts at π/2 ∓ ψ and flights of 6π ± 2ψ, at Λ = ψ/sin ψ.

    W(τ₁, τ₂) is the action of both flights. It is stationary at orbits, and the determinant is zero
    where a multiplier is 1.
    """
    amplitude = psi / mpmath.sin(psi)

    def flight(begin, end):
        z, z_end = (amplitude * mpmath.sin(tau) for tau in (begin, end))
        time = end - begin
        return (z_end - z) ** 2 / (2 * time) - (z + z_end) * time / 2 - time**3 / 24

    def action(first, second):
        return flight(first, second) + flight(second, first + 12 * mpmath.pi)

    place = mpmath.pi / 2 - psi, mpmath.pi / 2 + psi + 6 * mpmath.pi
    assert all(abs(mpmath.diff(action, place, by)) < 1e-20 for by in ((1, 0), (0, 1)))
    orders = ((2, 0), (1, 1), (0, 2))
    first, mixed, second = (mpmath.diff(action, place, by) for by in orders)
    return float(first * second - mixed**2)


def test_an_elastic_cascade_ends_where_its_orbits_lose_their_symmetry():
    """A pitchfork: beyond it there are two more orbits, each the other one in reversed time."""
    psi = brentq(hessian_of_action, 1.5, 1.7, xtol=1e-13)
    place = psi / np.sin(psi)
    assert place == pytest.approx(1.58947842974, abs=1e-11)
    doubling = limits(Rigid(1.0), n=3).period_doubling
    below, above = (follow(doubling, to=place + d).orbits[-1] for d in (-1e-4, 1e-4))
    assert below.stable and not above.stable
    assert (place - below.amplitude) / (above.amplitude - below.amplitude) == pytest.approx(
        (1 - below.turn) / (above.turn - below.turn), abs=1e-3
    )
    (only,) = cascade(doubling, to=3.0)
    assert only.special == () and only.impacts == 2
    assert len(orbits(Rigid(1.0), impacts=2, periods=6, amplitude=1.58)) == 1
    periodic_orbits = orbits(Rigid(1.0), impacts=2, periods=6, amplitude=1.6)
    symmetric, *both = sorted(periodic_orbits, key=lambda periodic_orbit: periodic_orbit.stable)
    assert not symmetric.stable and [periodic_orbit.stable for periodic_orbit in both] == [
        True,
        True,
    ]
    # Reversed, an impact at τ is one at π - τ with the same speed.
    before, after = (
        [periodic_orbit.times[i] % (2 * np.pi) for i in (0, 1)] for periodic_orbit in both
    )
    assert sorted((np.pi - tau) % (2 * np.pi) for tau in before) == pytest.approx(sorted(after))
    branches = cascade(follow(both[0], to=3.0).first("period doubling"), to=3.0, impacts=8)
    assert [branch.special[-1].kind for branch in branches] == 2 * ["period doubling"]


def test_a_branch_along_the_frequency_ratio_takes_steps_in_proportion_to_it():
    start = orbit(SpringDamper(2.0, restitution=0.85), amplitude=1.0)
    up = follow(start, along="frequency_ratio", to=1e6)
    down = follow(up.orbits[-1], to=2.0)
    assert up.end == "frequency_ratio = 1000000 is reached" and len(up) < 100 and len(down) < 100
    assert down.orbits[-1].phase == pytest.approx(start.phase, abs=1e-10)
    # As digits allow, each orbit is that which is found at its ϖ, whatever the size of this number.
    for periodic_orbit in (up.orbits[-1], up.orbits[-9], down.orbits[9]):
        alone = orbit(periodic_orbit.ball, amplitude=1.0)
        assert abs(periodic_orbit.times - alone.times).max() < 1e-11
        assert abs(periodic_orbit.speeds - alone.speeds).max() < 1e-11


def test_a_refined_branch_has_no_corners():
    start = orbit(Rigid(0.5), amplitude=1.4)
    branch = follow(start, to=1.1)
    fine = branch.refined()
    assert len(fine) > 2 * len(branch)
    assert fine.special == branch.special and fine.end == branch.end
    # On this branch Λ cos φ = π/3.
    phases = fine.z[:, 0]
    assert np.abs(fine.values * np.cos(phases) - np.pi / 3).max() < 1e-11
    assert np.abs(np.diff(phases)).max() < 0.05
    assert set(branch.values) <= set(fine.values)


@pytest.mark.parametrize("r", [0.0003, 0.002, 0.005])
def test_a_slow_start_grazes_the_table_at_once(r):
    """After a slow start the table overtakes the ball for a moment, by the equations of a flight.

    The impact is at Λ cos τ = C = π(1 - r)/(1 + r), and the ball leaves with the speed
    r 2π/(1 + r).
    """
    x = np.pi * (1 - r) / (1 + r)

    def touch(unknowns):
        amplitude, t = unknowns
        y = np.sqrt(amplitude**2 - x**2)
        tau = np.arctan2(y, x)
        bounce = 2 * np.pi * r / (1 + r) + x
        gap = bounce * t - t**2 / 2 - amplitude * np.sin(tau + t) + y
        return gap, bounce - t - amplitude * np.cos(tau + t)

    # To the third order in the time, δ = wt - at²/2 + xt³/6 with a = 1 - y has a double zero here.
    a = np.sqrt(16 * np.pi * r * x / 3)
    amplitude, _ = fsolve(touch, (np.hypot(x, 1 - a), 1.5 * a / x), xtol=1e-12)
    branch = follow(orbit(Rigid(r), amplitude=3.45), to=3.145)
    assert [special.kind for special in branch.special] == ["grazing of a flight"]
    assert branch.special[0].amplitude == pytest.approx(amplitude, abs=1e-10)


def test_limits_are_shown_in_a_line():
    text = repr(limits(Rigid(0.5)))
    assert text == "Limits: saddle-node at Λ = 1.047197551; period doubling at Λ = 1.526823701"


def test_a_limit_that_is_missing_has_a_reason():
    elastic = repr(limits(Rigid(1.0)))
    reason = "no saddle-node is known: the branch of orbits is followed until amplitude = 1e-06"
    assert elastic == f"Limits: {reason} is reached; period doubling at Λ = 1"
    # r is 1 within rounding: the damper of this law has no force.
    integrated = kuwabara_kono(restitution=1.0, duration=0.01, speed=np.pi)
    assert repr(limits(integrated)).startswith(f"Limits: {reason} is reached; period doubling at")
    strongly_damped = limits(SpringDamper(5.0, damping_ratio=1.3)).saddle_node
    assert isinstance(strongly_damped, OrbitNotFound)
    assert "vanishing flight at amplitude = 1.0917875" in str(strongly_damped)


@pytest.mark.parametrize(
    ("ratio", "zeta", "n", "amplitude"),
    [
        (13.091781257915382, 0.969992782352811, 1, 3.62704266),
        (6.658720312501095, 1.3152452408927156, 3, 9.36625404),
    ],
)
def test_the_doubling_of_strongly_damped_contacts_is_that_of_an_integrated_ball(
    ratio, zeta, n, amplitude
):
    """Newton's method alone finds other solutions first, on which the ball never leaves."""
    ball = SpringDamper(ratio, damping_ratio=zeta)
    doubling = limits(ball, n=n).period_doubling
    assert doubling.amplitude == pytest.approx(amplitude, abs=1e-8)
    assert doubling.admissible
    step = 1e-4
    shifts = np.array([(step, 0.0), (0.0, step)])
    ends = [[around(doubling, side * shift)[0] for side in (1, -1)] for shift in shifts]
    matrix = np.array([(above - below) / (2 * step) for above, below in ends]).T
    assert np.linalg.eigvals(matrix).min() == pytest.approx(-1, abs=1e-6)


def test_a_branch_of_long_and_stiff_contacts_is_followed_in_few_steps():
    """T = ϖD grows to hundreds, and counts relatively."""
    start = orbit(SpringDamper(80.0, damping_ratio=1.2), amplitude=4.0)
    branch = follow(start, to=(0.5, 20.0))
    assert branch.end == "amplitude = 20 is reached"
    assert branch.values[0] == pytest.approx(1.0003, abs=1e-4)
    assert len(branch) < 200


def test_a_doubled_branch_ends_where_it_is_told_to():
    doubling = first_doubling(Rigid(0.5), 1.4)
    for beyond in (1e-8, 1e-5, 1e-2):
        branch = follow(doubling, to=doubling.amplitude + beyond)
        assert branch.values[-1] == doubling.amplitude + beyond
        assert np.all(branch.values <= branch.values[-1]) and len(branch) > 1
        assert branch.special == () and branch.end.endswith("is reached")
        assert branch.orbits[-1].stable and branch.impacts == 2
    # ξ² is proportional to the distance in Λ: the orbits of two impacts are on a parabola.
    near = [follow(doubling, to=doubling.amplitude + d).orbits[-1] for d in (1e-6, 4e-6)]
    apart = [abs(np.diff(periodic_orbit.speeds)[0]) for periodic_orbit in near]
    assert apart[1] / apart[0] == pytest.approx(2, rel=1e-4)


def test_a_goal_that_rounding_hides_is_refused():
    doubling = first_doubling(Rigid(0.5), 1.4)
    with pytest.raises(OrbitNotFound, match="amplitude is too near to the period doubling"):
        follow(doubling, to=doubling.amplitude + 1e-12)


def test_a_doubled_branch_is_refused_on_the_side_where_it_is_not():
    doubling = first_doubling(Rigid(0.5), 1.4)
    with pytest.raises(OrbitNotFound, match="twice the period are above the period doubling at am"):
        follow(doubling, to=1.2)
    fold = limits(Rigid(0.5)).saddle_node
    with pytest.raises(OrbitNotFound, match=r"orbits of the saddle-node at .* are above it"):
        follow(fold, to=0.5)


def test_from_a_saddle_node_the_stable_branch_is_followed_and_both_if_both_ways():
    fold = limits(Rigid(0.5)).saddle_node
    branch = follow(fold, to=1.3)
    assert branch.special == () and branch.stable[1:].all()
    both = follow(fold, to=(0.5, 1.3))
    lowest = np.argmin(both.values)
    assert both.values[[0, -1]] == pytest.approx([1.3, 1.3]) and 0 < lowest < len(both) - 1
    assert not both.stable[:lowest].any() and both.stable[lowest + 1 :].all()
    assert all(special.kind != "saddle-node" for special in both.special)


@pytest.mark.parametrize("name", ["saddle node", "saddle-node", "Saddle-Node"])
def test_kinds_are_understood_with_spaces_and_hyphens(name):
    branch = follow(orbit(Rigid(0.5), amplitude=1.2), to=0.5)
    assert branch.first(name).kind == "saddle-node"


def test_an_unknown_kind_is_refused_with_those_that_there_are():
    branch = follow(orbit(Rigid(0.5), amplitude=1.2), to=1.8)
    assert branch.first("period-doubling") is branch.first("period doubling")
    with pytest.raises(OrbitNotFound, match="no fold here; special orbits: peri"):
        branch.first("fold")
    with pytest.raises(OrbitNotFound, match="no saddle-node here; special orbits"):
        branch.first("saddle-node")


def test_the_grazing_of_a_flight_and_the_branch_with_one_impact_more():
    """The gap of the closed form has a minimum of zero; and the longer orbits meet it there."""
    r = 0.5
    branch = follow(orbit(Rigid(r), amplitude=2.0, side="unstable"), to=3.0)
    grazing = branch.first("grazing of a flight")

    def lowest(amplitude):
        phase = -np.arccos(saddle_node(1, r) / amplitude)
        t = np.linspace(0.1, 2 * np.pi - 0.1, 200001)
        table = amplitude * (np.sin(phase + t) - np.sin(phase))
        gap = np.pi * t - t * t / 2 - table
        turns = (gap[1:-1] < gap[:-2]) & (gap[1:-1] < gap[2:])
        return gap[1:-1][turns].min()

    # The samples are 3e-5 apart, and the minimum is flat.
    assert grazing.amplitude == pytest.approx(brentq(lowest, 2.4, 2.6), abs=1e-8)
    before, after = branch.values < grazing.amplitude, branch.values > grazing.amplitude
    assert branch.admissible[before].all() and not branch.admissible[after].any()
    more = follow(grazing, to=1.0)
    assert more.impacts == 2 and more.values[0] == pytest.approx(grazing.amplitude, abs=1e-12)
    assert more.start.startswith("grazing of a flight at amplitude = 2.504299")
    assert more.first("saddle-node").amplitude == pytest.approx(1.484220833, abs=1e-9)


def test_the_grazing_of_an_impact_is_that_of_a_flight_of_the_orbit_without_it():
    three = orbits(Rigid(0.8), impacts=3, periods=3, amplitude=1.2)
    two = orbits(Rigid(0.8), impacts=2, periods=3, amplitude=1.3)
    ends = [follow(periodic_orbit, to=20.0) for periodic_orbit in three]
    impacts = [b.special[-1].amplitude for b in ends if b.special[-1].kind.endswith("an impact")]
    flights = [
        follow(periodic_orbit, to=20.0).first("grazing of a flight").amplitude
        for periodic_orbit in two
    ]
    assert impacts and min(abs(np.subtract.outer(impacts, flights)).ravel()) < 1e-9
    assert all("lands with the speed of the table" in branch.end for branch in ends)
    with pytest.raises(OrbitNotFound, match="branches end at orbits of this kind"):
        follow(ends[0].special[-1], to=1.0)


def test_no_special_orbit_hides_before_the_end_of_a_branch():
    """The saddle-node, the doubling and the grazing are within 2e-5, and a step passes them all."""
    ball = SpringDamper(5.0, restitution=0.5)
    flight = follow(orbit(ball, amplitude=2.0, side="unstable"), to=6.0)
    grazing = flight.first("grazing of a flight")
    back = follow(grazing, to=2.3)
    expected = {special.kind: special.amplitude for special in back.special}
    assert expected.keys() == {"saddle-node", "period doubling"}
    branch = follow(back.orbits[-1], to=2.5)
    assert {special.kind: special.amplitude for special in branch.special} == pytest.approx(
        expected | {"grazing of an impact": grazing.amplitude}, abs=LOCATED
    )
    # Rounding decides on tr/(1 + det) at the end itself, but nothing is divided by zero.
    turns = np.array([periodic_orbit.turn for periodic_orbit in branch.orbits])
    assert np.abs(np.diff(np.arctan(turns[:-1]))).max() < LARGEST_TURN


def test_no_special_orbit_hides_where_multipliers_are_large():
    """From the grazing on tr/(1 + det) falls from 61 to less than -30, within 1e-6 of Λ."""
    ball = SpringDamper(20.0, restitution=0.65)
    near = orbits(ball, amplitude=3.0, impacts=2, periods=3)
    flights = [
        s
        for periodic_orbit in near
        for s in follow(periodic_orbit, to=3.2).special
        if "flight" in s.kind
    ]
    grazing = next(special for special in flights if abs(special.amplitude - 3.1019022) < 1e-7)
    branch = follow(grazing, to=3.4)
    assert [special.kind for special in branch.special] == ["saddle-node", "period doubling"]
    assert (
        branch.orbits[1].turn > 50
        and min(periodic_orbit.turn for periodic_orbit in branch.orbits) < -30
    )


def test_a_lost_release_is_an_orbit_that_leaves_the_table_with_no_speed():
    ball = SpringDamper(7.316726682288825, restitution=0.23276919547357516)
    start = orbit(ball, amplitude=4.0523387951747, n=2)
    branch = follow(start, along="frequency", to=1.04)
    lost = branch.special[-1]
    assert lost.kind == "lost release" and "no longer leaves the table" in branch.end
    assert lost.relative_bounce_velocity == pytest.approx(0, abs=1e-10)
    assert np.abs(lost.equations.linearized(lost.z[np.newaxis]).legs).max() < 1e-11
    assert branch.values[-1] == lost.z[-1]


def test_the_grazing_of_a_release_touches_the_release_within_a_contact():
    ball = SpringDamper(1.580803888063078, damping_ratio=0.25853365407092316, release="force")
    branch = follow(orbit(ball, amplitude=2.5166920162308033, n=2), along="frequency", to=0.92)
    touch = branch.first("grazing of a release")
    T = touch.z[2] * np.linspace(0.02, 0.98, 100001)
    ends = touch.ball.contact(touch.times[0], touch.speeds[0], T, touch.amplitude)
    # The samples are next to the maximum, which is flat.
    assert ends.release.max() == pytest.approx(0, abs=1e-7)
    place = np.argmin(np.abs(branch.z - touch.z).max(axis=1))
    assert len(set(branch.admissible[place - 2 : place + 3])) == 2
    on = follow(touch, to=0.92)
    assert on.impacts == 1 and touch.z[-1] not in [special.z[-1] for special in on.special]


def test_a_flight_vanishes_where_permanent_contact_begins():
    """Λ_SD = √(1 + (4ζ² - 2)/ϖ² + 1/ϖ⁴) (Eq. 28 to 34)."""
    ball = SpringDamper(2.0, restitution=0.85)
    longest = orbits(ball, amplitude=0.9)[-1]
    branch = follow(longest, to=0.1)
    limit = np.sqrt(1 + (4 * ball.zeta**2 - 2) / 4 + 1 / 16)
    assert "the contacts before and after a flight merge" in branch.end
    assert branch.special[-1].kind == "vanishing flight"
    # An impact vanishes at the same place: the end has one name.
    assert np.sum([abs(special.amplitude - limit) < 1e-6 for special in branch.special]) == 1
    # The equations are singular there, so that half of the digits are certain.
    assert branch.values[-1] == pytest.approx(limit, abs=1e-7)
    assert branch.admissible[:-1].all()


def test_a_period_halving_is_the_doubling_from_the_other_side():
    """Twice the period is left at a doubling: followed back, the branch ends there."""
    doubling = first_doubling(Rigid(0.5), 1.4)
    last = follow(doubling, to=1.6).orbits[-1]
    back = follow(last, to=1.3)
    assert back.special[-1].kind == "period halving"
    assert "merges with one of half its period" in back.end
    assert back.special[-1].amplitude == pytest.approx(doubling.amplitude, abs=LOCATED)
    half = follow(back.special[-1], to=1.3)
    assert half.impacts == 1 and half.values[-1] == 1.3 and half.stable[1:].all()


def test_a_range_is_not_left_where_the_parameter_turns_back():
    branch = follow(orbit(Rigid(0.5), amplitude=1.2), to=(0.9, 1.3))
    assert branch.values[[0, -1]].tolist() == [1.3, 1.3]


def test_a_closed_branch_ends_at_its_start():
    """A loop along r with twelve special orbits, each of which is listed once."""
    times = np.array([0.2819, 12.77956, 28.77264, 30.25599, 31.12455])
    speeds = np.array([6.27377, 9.43345, 5.28965, 2.99474, 1.18962])
    equations = OrbitEquations(Rigid(0.49711198038140114), 5, 6)
    z = np.append(np.stack([times, speeds], axis=1), 3.24071062471)
    start = newton(equations, z[np.newaxis]).z[0]
    branch = follow(equations.orbit(start), along="restitution", to=0.62)
    assert branch.end == "the branch is closed: it is back at its start"
    assert branch.orbits[-1].phase == pytest.approx(branch.orbits[0].phase, abs=1e-12)
    assert len(branch.special) == 12
    assert len({(special.kind, round(special.z[-1], 9)) for special in branch.special}) == 12


def test_rows_side_by_side_are_the_single_branches():
    """Each has its own events and end, or the reason why there is no orbit."""
    random = np.random.default_rng(5)
    r, ratio = random.uniform(0.4, 0.95, 12), 10 ** random.uniform(0.5, 2, 12)
    amplitude = saddle_node(1, r) + 0.3
    amplitude[3] = 0.01
    starts = orbit(SpringDamper(ratio, restitution=r), amplitude=amplitude)
    starts += orbit(Rigid([0.5, 0.7]), amplitude=[1.3, 0.9])
    to = np.append(amplitude, [1.3, 0.9]) + random.uniform(-0.5, 1.5, 14)
    to = np.maximum(to, 0.05)
    branches = follow(starts, to=to)
    assert isinstance(branches[3], OrbitNotFound) and branches[3] is starts[3]
    kinds = set()
    for start, goal, branch in zip(starts, to, branches, strict=True):
        if isinstance(start, OrbitNotFound):
            continue
        alone = follow(start, to=float(goal))
        assert isinstance(branch, FollowedBranch) and branch.end == alone.end
        assert branch.values == pytest.approx(alone.values, abs=1e-9)
        assert [special.kind for special in branch.special] == [
            special.kind for special in alone.special
        ]
        for one, other in zip(branch.special, alone.special, strict=True):
            assert one.z == pytest.approx(other.z, abs=1e-8)
        kinds |= {special.kind for special in branch.special}
    assert {"saddle-node", "period doubling"} <= kinds


def shaker(frequency):
    """Λ for a stroke of 0.5 mm at a frequency in hertz."""
    return 0.5e-3 * (2 * np.pi * frequency) ** 2 / 9.80665


def test_along_the_frequency_an_orbit_is_that_of_a_shaker_in_hertz():
    """ϖ is the 500 Hz of the contact over the frequency of the shaker, at a stroke of 0.5 mm."""
    ball = SpringDamper(500.0 / 20.0, restitution=0.85)
    doubling = follow(orbit(ball, amplitude=shaker(20.0)), along="frequency", to=1.2).first(
        "period doubling"
    )
    hertz = doubling.parameters["frequency"] * np.sqrt(9.80665 / 0.5e-3) / (2 * np.pi)
    assert hertz == pytest.approx(22.701, abs=5e-4)
    same = limits(SpringDamper(500.0 / hertz, restitution=0.85)).period_doubling
    assert same.amplitude == pytest.approx(shaker(hertz), abs=LOCATED)
    twice = follow(doubling, to=1.2 * doubling.parameters["frequency"])
    assert (twice.along, twice.impacts) == ("frequency", 2)


def test_wrong_goals_and_parameters_are_named_in_one_line():
    start = orbit(Rigid(0.5), amplitude=1.3)
    for call, text in (
        (lambda: follow(start, along="mass", to=2.0), "along = 'mass': must be one of amplitude"),
        (lambda: follow(start, to=-1.0), r"to: amplitude = -1: must be in \[1e-12, 1e\+08\]"),
        (
            lambda: follow(start, along="restitution", to=1.1),
            r"restitution = 1.1: must be in \[0, 1\]",
        ),
        (lambda: follow(start, along="frequency", to=0.0), r"frequency = 0: must be in \[1e-06, "),
        (lambda: follow(start, to=(1.4, 2.0)), "1.3 of the orbit must be in this range"),
        (lambda: limits(0.7), r"ball = 0\.7: must be a ball, such as Rigid\(0\.7\)"),
        (
            lambda: follow(Rigid(0.5), to=2.0),
            r"orbit = Rigid\(.*\): must be a periodic orbit, such",
        ),
        (lambda: cascade(follow(start), to=2.0), "doubling = FollowedBranch.*: must be a period d"),
        (lambda: follow(start, to=2.0, points=0), "points = 0: must be a whole number from 2"),
        (lambda: follow(start, to=1.3), "amplitude = 1.3 is already the value of the orbit"),
        (
            lambda: follow(orbit(SpringDamper(9.0, 0.5), amplitude=1.3), along="damping_ratio"),
            "along = 'damping_ratio': the ball has frequency_ratio and restitution as parameters",
        ),
    ):
        with pytest.raises(ValueError, match=text) as raised:
            call()
        assert "\n" not in str(raised.value)


def test_without_a_goal_the_parameter_rises_to_ten_times_its_value_or_to_its_end():
    start = orbit(Rigid(0.3), amplitude=2.0)
    assert follow(start).end == "amplitude = 20 is reached"
    assert follow(start, along="restitution").values[-1] == 1.0
    assert follow(start, points=3).end.startswith(
        "the maximum of 3 points is reached; the last one, at amplitude"
    )


def test_a_simulated_ball_ends_on_the_stable_orbits_of_a_cascade():
    """A ball that starts elsewhere is attracted by the orbit of four impacts."""
    doubling = first_doubling(Rigid(0.5), 1.4)
    branches = cascade(doubling, to=1.6999, impacts=4)
    four = branches[1].orbits[len(branches[1]) // 2]
    assert four.impacts == 4 and four.stable and four.admissible
    tau, u = four.times[0], four.speeds[0] + 0.02
    for _ in range(4 * 40):
        tau, u, _ = leg(four.ball, four.amplitude, tau, u)
    assert np.abs(four.speeds - u).min() < 1e-6


# Random branches


def random_ball(number, random):
    """A ball of one of four models, or of a law, its r, and the names of what may vary."""
    r, ratio = random.uniform(0.4, 0.9), 10 ** random.uniform(0.6, 2)
    laws = {57: tsuji, 58: hunt_crossley, 59: kuwabara_kono}
    if number in laws:
        ball = laws[number](restitution=r, duration=np.pi / ratio, speed=3.5)
        return ball, r, ("amplitude", "stiffness", "damping")
    damped = SpringDamper(ratio, restitution=r)
    balls = [
        Rigid(r),
        damped,
        SpringDamper(ratio, damping_ratio=float(damped.zeta), release="force"),
        Corrected(damped),
    ]
    ball = balls[number % 4]
    return ball, r, ("amplitude", "frequency", *ball.parameters)


def closes(periodic_orbit):
    """The distance by which one period by an independent code misses the start of an orbit."""
    if not isinstance(periodic_orbit.ball, Corrected):
        return np.abs(
            around(periodic_orbit)[0] - [periodic_orbit.times[0], periodic_orbit.speeds[0]]
        ).max()
    # The impulse of the instant is 2nπ, and so an orbit is a point of a line of Λ (cos ψ, sin ψ).
    r, _, _, loss = (
        float(quantity) for quantity in periodic_orbit.ball.signature(periodic_orbit.speeds[0])
    )
    line = (1 + r) * np.cos(periodic_orbit.times[0]) - loss * np.sin(periodic_orbit.times[0])
    half = np.pi * periodic_orbit.periods
    return abs(periodic_orbit.amplitude * line - half * (1 - r) + loss)


def test_random_branches_of_all_models_lead_to_orbits_of_independent_codes():
    """Sixty branches along any parameter: a ball that follows their last orbit comes back."""
    random = np.random.default_rng(78)
    counted = 0
    for number in range(60):
        ball, r, names = random_ball(number, random)
        amplitude = random.uniform(0.2, 0.9) * (period_doubling(1, r) - saddle_node(1, r))
        one = orbit(ball, amplitude=saddle_node(1, r) + amplitude)
        along = str(random.choice(names))
        value = one.parameters.get(along, np.sqrt(one.amplitude))
        goal = value * random.uniform(0.9, 1.1)
        branch = follow(one, along=along, to=goal, points=40)
        last = [periodic_orbit for periodic_orbit in branch.orbits if periodic_orbit.admissible][-1]
        # The integrator is right to some 1e-11, which an unstable orbit stretches.
        assert closes(last) < 1e-9 * (1 + np.abs(last.multipliers).max()), (number, branch)
        counted += last.z[-1] != value
    # All of them have moved.
    assert counted == 60


def test_limits_start_from_the_first_orbit_that_a_ball_follows_or_else_the_first_orbit(monkeypatch):
    """Searches return an orbit or none, and whether a ball follows it, for three balls."""
    answers = {
        0: [("a", False), (None, False), ("b", False), ("c", True)],
        1: [(None, False)],
        2: [(None, False), ("a", False), ("b", False)],
    }
    asked = dict.fromkeys(answers, 0)

    def search(equations, amplitude, impacts):
        pairs = []
        for row in (equations.periods - 1).tolist():
            some = answers[row]
            pairs.append(some[min(asked[row], len(some) - 1)])
            asked[row] += 1
        orbits, done = zip(*pairs, strict=True)
        return list(orbits), np.array(done)

    monkeypatch.setattr(continuation, "near_instants", search)
    monkeypatch.setattr(continuation, "shortest_contacts", search)
    balls = Rigid(np.array([0.5, 0.5, 0.5]))
    starts = continuation._between_limits(OrbitEquations(balls, 1, np.array([1, 2, 3])))
    assert starts[0] == "c" and starts[2] == "a"
    assert isinstance(starts[1], OrbitNotFound)
    assert asked[0] == 4


@pytest.mark.parametrize(
    ("ball", "end"),
    [
        (tsuji(restitution=0.03, duration=0.15, speed=6.0), 2.877420),
        (
            kuwabara_kono(stiffness=500.0, damping=0.5),
            "grazing of an impact near amplitude = 1.0055",
        ),
    ],
)
def test_limits_of_laws_at_the_edge_of_rebounding(ball, end):
    """A saddle-node of a shooting by another integrator, or what ends the branch."""
    node = limits(ball).saddle_node
    if isinstance(end, float):
        assert node.amplitude == pytest.approx(end, abs=1e-6)
    else:
        assert str(node).startswith("there is no saddle-node on the branch") and end in str(node)
