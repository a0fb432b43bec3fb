"""Where laid balls end, by an integrator that shares nothing with the package."""

import integrated
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball.spring_damper import permanent_contact
from bouncing_ball_beyond import Rigid, SpringDamper
from studies.stages import laid_balls

PERIOD = 2 * np.pi


def own_motion(ball, amplitude, contacts):
    """Impacts of a ball that touches the table at its phase 0 with its velocity.

    Returns times, speeds, the flights before them, and the times and speeds of the releases.
    """
    tau, u, impacts = 0.0, 0.0, []
    for _ in range(contacts):
        leaves, gap, speed, _ = integrated.touching(ball, amplitude, tau, u)
        tau, u, _ = integrated.flight(amplitude, leaves, gap, speed)
        impacts.append((tau, u, tau - leaves, leaves, speed))
    return np.array(impacts).T


def own_hop(amplitude, leaves, speed, flight):
    """Maximum of δ in a flight, by samples."""
    t = np.linspace(0, flight, 20001)
    velocity = speed + amplitude * np.cos(leaves)
    rise = amplitude * (np.sin(leaves + t) - np.sin(leaves))
    return (velocity * t - t**2 / 2 - rise).max()


@pytest.mark.parametrize(
    "r, ratio, amplitude, impacts",
    [(0.65, 10.0, 1.0, 1), (0.65, 10.0, 1.15, 2), (0.65, 40.0, 1.1, 4), (0.85, 20.0, 1.06, 3)],
)
def test_both_laid_balls_end_on_the_motion_of_an_integrator(r, ratio, amplitude, impacts):
    motion = laid_balls.on_contacts(r, np.array([amplitude]), np.array([ratio]), 400)
    assert (motion["impacts"].item(), motion["periods"].item()) == (impacts, 1)
    assert not motion["start_decides"].item()
    ball = SpringDamper(ratio, restitution=r)
    tau, u, flight, leaves, speed = own_motion(ball, amplitude, 20 * impacts)
    assert tau[-1] - tau[-1 - impacts] == pytest.approx(PERIOD, abs=1e-6)
    assert all(abs(np.diff(tau[-1 - impacts :])[:-1] - PERIOD) > 1e-2)
    last = flight[-impacts:].argmax() - impacts
    hop = own_hop(amplitude, leaves[last], speed[last], flight[last])
    assert motion["hop"].item() == pytest.approx(hop, rel=1e-5)
    if (ratio, amplitude) == (10.0, 1.0):
        assert u[-1] == pytest.approx(0.0051093, abs=5e-8)


@pytest.mark.parametrize("ratio, amplitude", [(0.6, 2.0), (3.0, 1.1), (50.0, 1.2)])
def test_a_ball_leaves_the_steady_motion_where_an_integrated_one_does(ratio, amplitude):
    ball = SpringDamper(np.array([ratio]), restitution=0.65)
    zeta = float(ball.zeta)
    assert amplitude > permanent_contact(ratio, zeta)
    balls = laid_balls.lift_off(ball, np.array([amplitude]))
    settling = PERIOD * np.ceil(40 / (zeta * ratio) / PERIOD)

    def motion(t, y):
        return [y[1], -1 + amplitude * np.sin(t) - 2 * zeta * ratio * y[1] - ratio**2 * y[0]]

    def surface(t, y):
        return y[0]

    surface.direction = 1
    options = {"method": "DOP853", "events": surface, "rtol": 1e-11, "atol": 1e-14}
    solution = solve_ivp(motion, (0, settling + PERIOD), [0, 0], max_step=0.02, **options)
    leaves, (_, speed) = solution.t_events[0][-1], solution.y_events[0][-1]
    tau, u, _ = integrated.flight(amplitude, leaves, 0.0, speed)
    turned = (tau - balls.phase.item() + np.pi) % PERIOD - np.pi
    assert turned == pytest.approx(0, abs=1e-6)
    assert balls.speed.item() == pytest.approx(u, rel=1e-6)


@pytest.mark.parametrize("r, amplitude", [(0.65, 1.2), (0.85, 1.1), (0.65, 1.38)])
def test_a_rigid_ball_chatters_and_sticks_before_it_leaves_again(r, amplitude):
    motion = laid_balls.in_groups(laid_balls.put_down(Rigid(r), np.array([amplitude])), 400)
    assert motion["periods"].item() == 1
    leaves = tau = np.arcsin(1 / amplitude)
    speed, first = 0.0, None
    for _ in range(400):
        after, u, _ = integrated.flight(amplitude, tau, 0.0, speed)
        first = first or own_hop(amplitude, tau, speed, after - tau)
        tau, speed = after, r * u
        gravity = 1 - amplitude * np.sin(tau)
        rest = 2 * speed / gravity / (1 - r)
        if 0 < rest < 1e-3:
            break
    # The bounces that are left last for `rest`, as a geometric series.
    assert tau + 2 * rest < leaves + PERIOD
    assert 1 - amplitude * np.sin(tau + rest) > 0
    assert motion["hop"].item() == pytest.approx(first, rel=1e-6)


def test_balls_rest_up_to_the_threshold():
    amplitude = np.array([0.9, 0.99, 1.0])
    rigid = laid_balls.in_groups(laid_balls.put_down(Rigid(0.65), amplitude), 400)
    assert rigid["hop"].tolist() == [0, 0, 0] and rigid["periods"].tolist() == [1, 1, 1]
    contact = laid_balls.on_contacts(0.65, amplitude, np.array([10.0]), 400)
    assert (contact["hop"] > 0).ravel().tolist() == [False, False, True]


def test_a_motion_that_rounding_decides_is_unknown():
    """A chaotic transient ends on different motions if Λ changes by 1e-13."""
    given = np.array([1.3]), np.array([5.022008040591447])
    assert laid_balls.on_contacts(0.65, *given, 400)["periods"].item() == 0


def test_a_ball_with_a_small_r_ends_on_the_orbit_that_flies():
    given = 0.1, np.array([2.8]), np.array([100.0])
    hop = laid_balls.on_contacts(*given, 400)["hop"].item()
    assert hop == pytest.approx(laid_balls.flying(*given).item(), rel=1e-6)
    tau, _, flight, leaves, speed = own_motion(SpringDamper(100.0, restitution=0.1), 2.8, 40)
    assert tau[-1] - tau[-2] == pytest.approx(PERIOD, abs=1e-6)
    assert hop == pytest.approx(own_hop(2.8, leaves[-1], speed[-1], flight[-1]), rel=1e-5)
    reached = [
        laid_balls.along_flying(r, 3, np.array([100.0]), 400)["scan_reached"] for r in (0.1, 0.65)
    ]
    assert reached[0] > 0 and reached[1] == 0


def test_the_branch_of_one_contact_ends_where_the_ball_touches_the_surface_within_it():
    ball = SpringDamper(10.0, restitution=0.65)
    counts = laid_balls.on_contacts(0.65, np.array([1.1, 1.107, 1.115]), np.array([10.0]), 400)
    assert counts["impacts"].ravel().tolist() == [1, 1, 2]
    highest = []
    for amplitude in (1.1, 1.107):
        tau, u, *_ = own_motion(ball, amplitude, 12)
        leaves, _, _, motion = integrated.touching(ball, amplitude, tau[-1], u[-1])
        # Away from both ends of the contact.
        gap = motion(np.linspace(tau[-1] + 0.3, leaves - 0.3, 4001))[0]
        highest.append(gap.max())
    assert -1e-3 < highest[0] < highest[1] < 0 and highest[1] > -2e-4
