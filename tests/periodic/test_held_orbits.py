"""Orbits of contacts on other tables, with drag and on springs: in 40 digits, and in a limit."""

import numpy as np
import pytest
from held_in_forty_digits import Exact
from mpmath import mp, mpf
from scipy.integrate import solve_ivp

import bouncing_ball
from bouncing_ball import Drag, Spring, Waveform, contact_law, rigid, spring_damper
from bouncing_ball.models.sequence import Status

# ϖ, ζ, release, the table, the flight, its l, q, b and whether the air rests, and Λ.
CASES = {
    "table": (9.0, 0.15, "displacement", [1.0, 0.2], Drag(0.0), (0, 0, -1, 0), 0.65),
    "force": (9.0, 0.15, "force", [1.0, 0.2, -0.05], Drag(0.0), (0, 0, -1, 0), 0.8),
    "drag": (20.0, 0.2, "displacement", [1.0, 0.1], Drag(0.05), (0.05, 0, -1, 1), 1.2),
    "spring": (
        15.0,
        0.1,
        "force",
        [1.0],
        Spring(0.35, 0.02, -1.0),
        (2 * 0.02 * 0.35, 0.35**2, -(0.35**2), 0),
        0.4,
    ),
}


def ball_of(case):
    ratio, zeta, release, sine, flight, numbers, amplitude = CASES[case]
    ball = spring_damper(
        frequency_ratio=ratio,
        damping_ratio=zeta,
        release=release,
        table=Waveform(sine),
        flight=flight,
    )
    lag = 2 * mpf(zeta) / mpf(ratio) if release == "force" else 0
    return ball, Exact(ratio, zeta, lag, sine, numbers), amplitude


def legs_of(one):
    return [
        (mpf(d), mpf(d + f))
        for d, f in zip(np.ravel(one.contact_duration), np.ravel(one.flight_time), strict=True)
    ]


def state_of(one):
    speed = np.ravel(one.relative_impact_velocity)[0]
    return mpf(float(np.ravel(one.phase)[0])), mpf(float(speed))


@pytest.mark.parametrize("case", CASES)
def test_orbits_and_multipliers_in_forty_digits(case):
    ball, exact, amplitude = ball_of(case)
    for one in bouncing_ball.orbits(ball, amplitude=amplitude):
        known = exact.orbit(mpf(amplitude), state_of(one), legs_of(one), 1)
        digits = 10.0 ** (1 - one.digits_left())
        assert abs(known[0] - one.phase) < digits
        assert abs(known[1] - one.relative_impact_velocity) < digits
        matrix = exact.matrix(mpf(amplitude), known, legs_of(one))
        found = one.monodromy()
        size = 1 + float(mp.norm(matrix, 1))
        # The entries change by their condition times the error of the state.
        for i in range(2):
            for j in range(2):
                assert abs(matrix[i, j] - found[i, j]) < 1000 * digits * size**2
        assert abs(mp.det(matrix) - one.determinant()) < 1e-12


# The orbits above have the drag and the spring, and weekly their bifurcations.
@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [pytest.param(x, marks=pytest.mark.long if x in ("drag", "spring") else ()) for x in CASES],
)
def test_bifurcations_in_forty_digits(case):
    ball, exact, amplitude = ball_of(case)
    one = bouncing_ball.orbit(ball, amplitude=amplitude)
    seen = 0
    for to in (0.2 * amplitude, 3 * amplitude):
        for _, special in bouncing_ball.follow(one, to=to).special_states():
            if special.kind not in ("saddle-node", "period doubling"):
                continue
            sign = 1 if special.kind == "saddle-node" else -1
            known = exact.bifurcation(
                mpf(special.amplitude), state_of(special), legs_of(special), 1, sign
            )
            assert abs(known - special.amplitude) < 1e-11, special.kind
            seen += 1
    assert seen


@pytest.mark.slow
def test_a_doubled_orbit_in_forty_digits():
    ball, exact, amplitude = ball_of("table")
    up = bouncing_ball.follow(bouncing_ball.orbit(ball, amplitude=amplitude), to=2.0)
    doubling = up.first("period doubling")
    twice = bouncing_ball.follow(doubling, to=float(doubling.amplitude) + 0.03)
    two = list(twice.states())[-1]
    assert two.impacts == 2
    known = exact.orbit(mpf(two.amplitude), state_of(two), legs_of(two), 2)
    assert abs(known[0] - two.phase[0]) < 1e-11
    eigenvalues, _ = mp.eig(exact.matrix(mpf(two.amplitude), known, legs_of(two)))
    expected = sorted((complex(x) for x in eigenvalues), key=lambda x: (x.imag, x.real))
    found = sorted(two.multipliers(), key=lambda x: (x.imag, x.real))
    assert np.abs(np.subtract(found, expected)).max() < 1e-9
    ended = bouncing_ball.orbit_of_motion(
        ball,
        amplitude=float(two.amplitude),
        phase=two.phase[0],
        velocity=two.impact_velocity[0],
    )
    assert two.is_stable() and ended.impacts == 2
    assert abs(ended.max_height - two.max_height) < 1e-7


def test_bifurcations_tend_to_those_of_the_rigid_ball():
    table = Waveform([1.0, 0.2])
    limit = rigid(restitution=0.5, table=table)
    known = bouncing_ball.follow(bouncing_ball.orbit(limit, amplitude=0.9), to=1.2)
    expected = float(known.first("period doubling").amplitude)
    apart = []
    for ratio in (2e3, 4e3):
        ball = spring_damper(frequency_ratio=ratio, restitution=0.5, table=table)
        up = bouncing_ball.follow(bouncing_ball.orbit(ball, amplitude=0.9), to=1.2)
        apart.append(abs(float(up.first("period doubling").amplitude) - expected))
    # The difference is of the order of the duration of the contact, which is halved.
    assert apart[0] < 5e-3 and abs(apart[0] / apart[1] - 2) < 0.1


def test_orbits_of_one_harmonic_are_those_of_the_closed_form():
    for ratio in (2.0, 30.0):
        numbers = {"frequency_ratio": ratio, "restitution": 0.7}
        for side in ("stable", "unstable"):
            paper = bouncing_ball.orbit(spring_damper(**numbers), amplitude=0.9, side=side)
            # A second harmonic below rounding is not computed in closed form.
            ball = spring_damper(**numbers, table=Waveform([1.0, 1e-300]))
            other = bouncing_ball.orbit(ball, amplitude=0.9, side=side)
            assert paper.distance(other) < 1e-11
            assert abs(paper.max_height - other.max_height) < 1e-11


@pytest.mark.slow
def test_orbits_of_a_law_are_where_its_balls_end():
    ball = contact_law("hunt-crossley", stiffness=2000.0, damping=0.3, table=Waveform([1.0, 0.2]))
    one = bouncing_ball.orbit(ball, amplitude=0.8)
    ended = bouncing_ball.orbit_of_motion(
        ball, amplitude=0.8, phase=one.phase + 0.01, velocity=one.impact_velocity
    )
    assert one.is_stable() and one.is_admissible()
    assert one.distance(ended) < 1e-6
    up = bouncing_ball.follow(one, to=1.6)
    (special,) = up.special_amplitude.values[up.special_kind.values == "period doubling"]
    for lam, impacts in ((special - 0.05, 1), (special + 0.05, 2)):
        here = bouncing_ball.orbit(ball, amplitude=lam)
        found = bouncing_ball.motion_of(
            ball, amplitude=lam, phase=here.phase + 0.003, velocity=here.impact_velocity
        )
        assert found.impacts.item() == impacts


@pytest.mark.slow
@pytest.mark.parametrize("case", ["table", "force", "spring"])
def test_grazing_flights_are_where_the_simulation_changes(case):
    ball, _, amplitude = ball_of(case)
    branch = bouncing_ball.follow(bouncing_ball.orbit(ball, amplitude=amplitude), to=4 * amplitude)
    stays = branch.admissible.values
    changes = np.flatnonzero(stays[1:] != stays[:-1])
    where = branch.special_point.values[
        [kind.startswith("grazing") for kind in branch.special_kind.values.tolist()]
    ]
    for k in changes:
        assert np.any(np.abs(where - k) <= 1), case


@pytest.mark.slow
@pytest.mark.long
def test_basins_and_diagrams_are_those_of_the_motions():
    ball, _, amplitude = ball_of("drag")
    shares = bouncing_ball.basins(ball, amplitude=amplitude, starts=2, impacts=60)
    assert abs(float(shares.share.sum()) - 1) < 1e-12
    lam = [0.9 * amplitude, amplitude]
    diagram = bouncing_ball.orbit_diagram(ball, amplitude=lam, starts=1, impacts=100)
    checked = 0
    for k, each in enumerate(lam):
        one = bouncing_ball.orbit(ball, amplitude=each)
        if one.is_stable() and one.is_admissible():
            seen = diagram.impact_phase[k].values
            assert np.nanmin(np.abs(seen - one.phase)) < 1e-6
            checked += 1
    assert checked


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_a_mass_that_leaves_its_stop_for_ever_swings_freely(release):
    """Its flight was refused as one out of floating-point range."""
    nu, zeta, gap, lam = 1.6, 0.05, 0.7, 0.5
    ball = spring_damper(
        frequency_ratio=10.0, restitution=0.5, release=release, flight=Spring(nu, zeta, gap)
    )
    # The steady oscillation does not reach the stop.
    assert lam / abs(nu**2 - 1 + 2j * zeta * nu) < gap
    assert bouncing_ball.motion_of(ball, amplitude=lam).kind.item() == "aloft"
    run = ball.simulate(lam, 0.0, -np.pi, 30)
    last = np.flatnonzero(np.isfinite(run.phase))[-1]
    assert 0 < last < 29 and run.status == Status.ALOFT
    left = run.phase[last] + run.contact_duration[last]
    start = [run.release_displacement[last], run.relative_bounce_velocity[last]]

    def motion(t, y):
        return [y[1], -2 * zeta * nu * y[1] - nu**2 * (y[0] - gap) + lam * np.sin(left + t)]

    # The free oscillations decay by e¹⁶.
    swing = solve_ivp(motion, (0, 200), start, rtol=1e-10, atol=1e-12, max_step=0.05)
    assert swing.y[0][swing.t > 0.1].min() > 0
