"""Normal forms against the orbits that branch off, and grazing against flights computed anew."""

from dataclasses import replace

import integrated
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from bouncing_ball_beyond import (
    Corrected,
    OrbitNotFound,
    Rigid,
    SpringDamper,
    follow,
    grazing_form,
    normal_form,
    orbit,
)
from bouncing_ball_beyond.periodic.equations import flight

COMPLIANT = SpringDamper(10.0, restitution=0.85)


@pytest.fixture(scope="module")
def doublings():
    """Period doublings of orbits with one and two impacts."""
    doublings = []
    for ball, amplitude, to in ((Rigid(0.5), 1.4, 1.8), (COMPLIANT, 1.0, 1.3)):
        first = follow(orbit(ball, amplitude=amplitude), to=to).first("period doubling")
        doublings += [first, follow(first, to=to).first("period doubling")]
    return doublings


def difference_of_halves(orbit, k):
    """Half the difference of the first impact and the one k impacts later, in time and speed."""
    shift = orbit.times[k] - orbit.times[0] - np.pi * orbit.periods
    return np.hypot(shift, orbit.speeds[k] - orbit.speeds[0]) / 2


def test_doubled_orbits_are_at_the_distance_of_the_normal_form(doublings):
    for doubling in doublings:
        form = normal_form(doubling)
        assert form.supercritical
        assert form.opens_upwards
        assert form.error < 1e-9 * form.coefficient
        ratios = []
        for part in (1.0, 0.5):
            distance = part * 1e-4 / form.rate
            doubled = follow(doubling, to=doubling.amplitude + distance).orbits[-1]
            ratios.append(difference_of_halves(doubled, doubling.impacts) ** 2 / distance)
        # ξ²/dλ is linear in dλ, up to terms of the second order, some (1e-4)².
        limit = 2 * ratios[1] - ratios[0]
        assert limit == pytest.approx(form.rate / form.coefficient, rel=1e-6)


def test_the_rate_is_that_of_the_multiplier(doublings):
    for doubling in doublings[::2]:
        form = normal_form(doubling)
        step = 1e-5
        branch = follow(doubling, to=doubling.amplitude + step)
        assert branch.impacts == 2
        beside = [
            orbit(doubling.ball, amplitude=doubling.amplitude + side * step) for side in (-1, 1)
        ]
        below, above = (periodic_orbit.multipliers[0].real for periodic_orbit in beside)
        # A central difference: the error is one of the square of the step.
        assert -(above - below) / (2 * step) == pytest.approx(form.rate, rel=1e-6)
        assert form.other == pytest.approx(doubling.multipliers[1].real, rel=1e-8)


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9])
def test_the_orbits_of_a_rigid_ball_at_its_saddle_node(restitution):
    # Λ cos φ = Λ_SN, and u does not change: φ² = 2 dΛ/Λ_SN for small φ.
    saddle_node = np.pi * (1 - restitution) / (1 + restitution)
    branch = follow(orbit(Rigid(restitution), amplitude=1.2 * saddle_node), to=saddle_node / 2)
    form = normal_form(branch.first("saddle-node"))
    assert form.direction == pytest.approx((1.0, 0.0), abs=1e-12)
    assert -form.rate / form.coefficient == pytest.approx(2 / saddle_node, rel=1e-9)
    assert form.opens_upwards
    assert form.other == pytest.approx(restitution**2, rel=1e-12)
    with pytest.raises(ValueError, match="neither supercritical nor subcritical"):
        _ = form.supercritical


def test_an_ordinary_orbit_has_no_form():
    one = orbit(Rigid(0.5), amplitude=1.4)
    with pytest.raises(ValueError, match="needs a saddle-node, a period doubling or a Nei"):
        normal_form(one)
    with pytest.raises(OrbitNotFound, match="no flight of the orbit"):
        grazing_form(one)


@pytest.fixture(scope="module")
def grazings():
    """Grazing flights of a rigid ball and of a stiff one."""
    balls = Rigid(0.5), SpringDamper(30.0, restitution=0.5)
    starts = [orbit(ball, amplitude=2.0, side="unstable") for ball in balls]
    return [follow(start, to=3.0).first("grazing of a flight") for start in starts]


def test_the_impact_of_a_rigid_ball_has_the_square_root_of_nordmark(grazings):
    grazing = grazings[0]
    form = grazing_form(grazing)
    leaves, amplitude, r = grazing.times[0], grazing.amplitude, grazing.ball.restitution
    ratios = []
    for lower in (4e-6, 1e-6):
        # The flight of an impact that is a little slower.
        speed = r * grazing.speeds[0] - lower

        def gap(time, speed=speed):
            return flight(time, leaves, 0.0, speed, amplitude)[0]

        touch = (form.phase - leaves) % (2 * np.pi)
        around_touch = (touch - 0.1, touch, touch + 0.1)
        depth = -minimize_scalar(gap, bracket=around_touch, tol=1e-14).fun
        _, closing, _ = integrated.flight(amplitude, leaves, 0.0, speed)
        ratios.append((1 + r) * closing / np.sqrt(depth))
    # The error is one of √d, that is of the square root of what was subtracted from the speed.
    limit = 2 * ratios[1] - ratios[0]
    assert limit == pytest.approx(form.coefficient, rel=1e-5)
    assert form.coefficient == pytest.approx((1 + r) * np.sqrt(2 * form.acceleration), rel=1e-12)


def test_orbits_with_one_impact_more_begin_at_the_grazing(grazings):
    for grazing in grazings:
        form = grazing_form(grazing)
        to = 1.0 if not form.opens_upwards else 3.0
        more = follow(grazing, to=to, points=30)
        assert (more.impacts, more.periods) == (2, 1)
        near = more.orbits[1]
        assert (near.amplitude > grazing.amplitude) == form.opens_upwards
        good = [periodic_orbit for periodic_orbit in more.orbits if periodic_orbit.admissible]
        assert good
        (time, speed), _ = integrated.around(good[-1])
        # The integrator of the contact is the less accurate of the two.
        assert time == pytest.approx(good[-1].times[0], abs=1e-9)
        assert speed == pytest.approx(good[-1].speeds[0], abs=1e-9)
    rigid = grazing_form(grazings[0])
    assert rigid.slope < 0
    assert not rigid.persists
    stiff = grazing_form(grazings[1])
    assert stiff.coefficient == 0
    assert stiff.persists


def test_slow_impacts_of_the_corrected_model_are_refused(grazings):
    ball = Corrected(SpringDamper(30.0, restitution=0.5))
    grazing = grazings[0]
    other = replace(grazing, equations=replace(grazing.equations, ball=ball))
    with pytest.raises(OrbitNotFound, match="takes effect below the table"):
        grazing_form(other)
