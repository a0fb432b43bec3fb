"""Orbits on other tables, with drag and on a spring: against 40 digits, and published results."""

import numpy as np
import pytest
from mpmath import mp, mpf
from settings_in_forty_digits import Exact

import bouncing_ball
from bouncing_ball import Drag, Spring, Waveform, rigid
from bouncing_ball.errors import NoOrbitError

CASES = {
    "table": (0.5, [1.0, 0.2], Drag(1e-3), 1.0),
    "drag": (0.5, [1.0], Drag(0.05), 1.4),
    "table and drag": (0.5, [1.0, 0.2, -0.05], Drag(0.1), 1.3),
    "spring": (0.6, [1.0], Spring(0.35, 0.02, -1.0), 0.3),
    "spring with a gap": (0.8, [1.0, 0.1], Spring(0.35, 0.02, 1.0), 1.2),
}


def ball_of(case):
    restitution, sine, flight, amplitude = CASES[case]
    return rigid(restitution=restitution, table=Waveform(sine), flight=flight), amplitude


@pytest.mark.parametrize("case", CASES)
def test_orbits_and_multipliers_in_forty_digits(case):
    ball, amplitude = ball_of(case)
    exact = Exact(*CASES[case][:3])
    for one in bouncing_ball.orbits(ball, 1, amplitude=amplitude):
        state = mpf(one.phase), mpf(one.relative_impact_velocity)
        times = [mpf(one.flight_time)]
        known = exact.orbit(mpf(amplitude), state, times, 1)
        digits = 10.0 ** (1 - one.digits_left())
        assert abs(known[0] - one.phase) < digits
        assert abs(known[1] - one.relative_impact_velocity) < digits
        matrix = exact.matrix(mpf(amplitude), known, times)
        found = one.monodromy()
        size = 1 + float(mp.norm(matrix, 1))
        # The entries change by their condition times the error of the state.
        for i in range(2):
            for j in range(2):
                assert abs(matrix[i, j] - found[i, j]) < 100 * digits * size**2
        # The determinant is that of the impact times the loss of the flight, exactly.
        assert abs(mp.det(matrix) - one.determinant()) < 1e-14


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", [pytest.param("table", marks=pytest.mark.long), "drag", "table and drag", "spring"]
)
def test_bifurcations_in_forty_digits(case):
    ball, amplitude = ball_of(case)
    exact = Exact(*CASES[case][:3])
    one = bouncing_ball.orbit(ball, amplitude=amplitude)
    kinds = set()
    for to in (0.2 * amplitude, 3 * amplitude):
        branch = bouncing_ball.follow(one, to=to)
        for _, special in branch.special_states():
            if special.kind not in ("saddle-node", "period doubling"):
                continue
            state = mpf(special.phase), mpf(special.relative_impact_velocity)
            times = [mpf(special.flight_time)]
            sign = 1 if special.kind == "saddle-node" else -1
            known = exact.bifurcation(mpf(special.amplitude), state, times, 1, sign)
            assert abs(known - special.amplitude) < 1e-12, special.kind
            kinds.add(special.kind)
    assert "period doubling" in kinds or case == "spring"


def test_doubled_orbit_and_its_branch_along_the_drag():
    ball = rigid(restitution=0.5, flight=Drag(0.05))
    up = bouncing_ball.follow(bouncing_ball.orbit(ball, amplitude=1.4), to=2.0)
    twice = bouncing_ball.follow(up.first("period doubling"), to=1.8)
    two = list(twice.states())[-1]
    assert two.impacts == 2 and two.is_stable() and two.is_admissible()
    exact = Exact(0.5, [1.0], Drag(0.05))
    state = mpf(two.phase[0]), mpf(two.relative_impact_velocity[0])
    times = [mpf(t) for t in two.flight_time]
    known = exact.orbit(mpf(two.amplitude), state, times, 2)
    assert abs(known[0] - two.phase[0]) < 1e-12
    eigenvalues, _ = mp.eig(exact.matrix(mpf(two.amplitude), known, times))
    expected = sorted((complex(x) for x in eigenvalues), key=lambda x: x.imag)
    found = sorted(two.multipliers(), key=lambda x: x.imag)
    assert np.abs(np.subtract(found, expected)).max() < 1e-11
    along = bouncing_ball.follow(two, along="drag", to=0.2)
    assert along.special_kind.values[0] == "period halving"
    ended = bouncing_ball.orbit_of_motion(
        ball, amplitude=float(two.amplitude), phase=two.phase[0], velocity=two.impact_velocity[0]
    )
    assert ended.impacts == 2 and abs(ended.max_height - two.max_height) < 1e-9


@pytest.mark.slow
def test_an_impact_grazes_where_the_steady_oscillation_reaches_the_stop():
    # The oscillation without impacts has the amplitude Λ/|ν² - 1 + 2iζν|.
    for nu, zeta, gap in ((0.35, 0.02, 1.0), (0.6, 0.1, 2.0), (1.6, 0.05, 0.7)):
        ball = rigid(restitution=0.8, flight=Spring(nu, zeta, gap))
        expected = gap * abs(nu**2 - 1 + 2j * zeta * nu)
        one = bouncing_ball.orbits(ball, 1, amplitude=1.5 * expected)[0]
        down = bouncing_ball.follow(one, to=0.3 * expected)
        assert down.special_kind.values[-1] == "grazing of an impact"
        assert abs(float(down.special_amplitude[-1]) / expected - 1) < 1e-10
        # Below, an orbit with impacts may attract as well, but not at so small an amplitude.
        far = 0.2 * expected
        assert nu < 0.5 or bouncing_ball.motion_of(ball, amplitude=far).kind.item() == "aloft"


def test_impact_speeds_over_the_gap_are_on_an_ellipse():
    # Shaw and Holmes 1983: between two impacts there is one free oscillation.
    r, nu, lam = 0.8, 0.45, 1.0
    ball = rigid(restitution=r, flight=Spring(nu, 0.0, -0.5))
    one = bouncing_ball.orbit(ball, amplitude=lam)
    branch = bouncing_ball.follow(one, along="gap", to=0.5, points=60)
    speed = -(branch.impact_velocity - lam * np.cos(branch.phase)).values[:, 0]
    across = branch.gap.values + (1 + r) * speed / (2 * nu * np.tan(np.pi * nu))
    along = (1 - r) * speed / 2
    assert np.abs(np.hypot(across, along) / (lam / (1 - nu**2)) - 1).max() < 1e-12


def test_elastic_ball_gains_speed_for_ever():
    # Marò 2022, after Pustyl'nikov: if 2π f′ is π/2 at some phase, a ball gains π at each impact.
    table = Waveform([1.0, 0.25])
    phase = 0.2
    lam = np.pi / 2 / float(table.velocity(phase))
    ball = rigid(restitution=1.0, table=table)
    found = ball.simulate(lam, phase, -np.pi, 8)
    assert np.abs(found.impact_velocity + np.pi * np.arange(1, 9)).max() < 1e-7


# Both terms at once, and a spring; the others weekly.
OFTEN = ("table and drag", "spring")


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", [x if x in OFTEN else pytest.param(x, marks=pytest.mark.long) for x in CASES]
)
def test_grazing_flights_are_where_the_simulation_changes(case):
    ball, amplitude = ball_of(case)
    one = bouncing_ball.orbit(ball, amplitude=amplitude)
    branch = bouncing_ball.follow(one, to=4 * amplitude)
    height = [_lowest(each) for each in branch.states()]
    grazes = [k for k in range(len(height) - 1) if (height[k] > 0) != (height[k + 1] > 0)]
    kinds = branch.special_kind.values.tolist()
    assert kinds.count("grazing of a flight") == len(grazes)
    stays = branch.admissible.values
    for k in grazes:
        assert stays[k] != stays[k + 1]


def _lowest(one):
    """The smallest local minimum of δ in the flight, by samples."""
    time = np.linspace(0, one.flight_time, 801)
    height, _ = one.flight_path(time)
    table = one.amplitude * one.model.place.waveform.height(one.phase + time)
    gap = height - table
    inner = gap[1:-1]
    lows = inner[(inner < gap[:-2]) & (inner < gap[2:])]
    return lows.min() if lows.size else 1.0


@pytest.mark.slow
def test_basins_and_diagrams_are_those_of_the_motions():
    ball = rigid(restitution=0.6, table=Waveform([1.0, 0.2]), flight=Drag(0.1))
    shares = bouncing_ball.basins(ball, amplitude=1.3, starts=4, impacts=100)
    assert abs(float(shares.share.sum()) - 1) < 1e-12
    # A single orbit at the first, and two impacts at the second.
    lam = [0.9, 1.1]
    diagram = bouncing_ball.orbit_diagram(ball, amplitude=lam, starts=2, impacts=150)
    for k, each in enumerate(lam):
        one = bouncing_ball.orbit(ball, amplitude=each)
        seen = diagram.impact_phase[k].values
        assert one.is_stable() == (k == 0) and one.is_admissible()
        assert (np.nanmin(np.abs(seen - one.phase)) < 1e-6) == (k == 0)
    masses = rigid(restitution=0.8, flight=Spring(1.6, 0.05, 0.7))
    over = bouncing_ball.orbit_diagram(masses, amplitude=[0.2, 1.6], starts=2, impacts=60)
    assert set(over.kind[0].values.tolist()) == {"aloft"}
    assert "aloft" not in over.kind[1].values.tolist()


def test_no_orbit_is_said():
    with pytest.raises(NoOrbitError):
        bouncing_ball.orbit(rigid(restitution=0.5, flight=Drag(0.1)), amplitude=0.2)
