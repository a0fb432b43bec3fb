"""The square root of the return map at a grazing flight, and the branch with one impact more."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError

R = 0.5


def _grazing(ball):
    one = bouncing_ball_beyond.orbit(ball, amplitude=2.0, side="unstable")
    return bouncing_ball_beyond.follow(one, to=3.2).first("grazing of a flight")


def _flight(lam, phase, launch):
    """δ and δ′ of a flight from the table with the absolute velocity ``launch``."""

    def gap(t):
        return lam * (math.sin(phase) - math.sin(phase + t)) + launch * t - t * t / 2

    def rate(t):
        return launch - t - lam * math.cos(phase + t)

    return gap, rate


@pytest.mark.parametrize("depth", [1e-4, 1e-6, 1e-8])
def test_simulated_balls_on_both_sides_of_a_grazing_differ_by_the_square_root(depth):
    ball = bouncing_ball_beyond.rigid(restitution=R)
    orbit = _grazing(ball)
    form = bouncing_ball_beyond.grazing_form(orbit)
    lam = orbit.amplitude

    def start(low):
        """The impact at the phase of the orbit whose flight has this least height, with the time of
        its lowest point; both in closed form.
        """
        touch = math.remainder(form.phase - orbit.phase, 2 * math.pi) % (2 * math.pi)

        def lowest(speed):
            _, rate = _flight(lam, orbit.phase, R * speed + lam * math.cos(orbit.phase))
            return brentq(rate, touch - 0.3, touch + 0.3, xtol=1e-15)

        def height(speed):
            gap, _ = _flight(lam, orbit.phase, R * speed + lam * math.cos(orbit.phase))
            return gap(lowest(speed)) - low

        speed = -orbit.relative_impact_velocity
        found = brentq(height, speed - 0.05, speed + 0.05, xtol=1e-15)
        return found, lowest(found)

    def without_touch(speed):
        """The next impact of a flight that passes through the table."""
        gap, rate = _flight(lam, orbit.phase, R * speed + lam * math.cos(orbit.phase))
        t = brentq(gap, 2 * math.pi - 0.3, 2 * math.pi + 0.3, xtol=1e-15)
        return orbit.phase + t, rate(t), t

    # Above the table the ball flies on.
    speed, _ = start(depth)
    phase, velocity, _ = without_touch(speed)
    real = ball.cycle(lam, orbit.phase, -speed)
    assert math.remainder(float(real.phase) - phase, 2 * math.pi) == pytest.approx(0, abs=1e-11)
    assert float(real.relative_velocity) == pytest.approx(velocity, abs=1e-11)
    # Below it there is another impact, after which the ball lands elsewhere.
    speed, touch = start(-depth)
    phase, velocity, t = without_touch(speed)
    slow = ball.cycle(lam, orbit.phase, -speed)
    real = ball.cycle(lam, slow.phase, slow.relative_velocity)
    kick = form.coefficient * math.sqrt(depth)
    later = kick * (t - touch) / -velocity
    faster = kick + (lam * math.sin(phase) - 1) * later
    # The next term is of the order of the depth, with derivatives of order 10.
    near = pytest.approx
    share = 30 * math.sqrt(depth)
    assert math.remainder(float(real.phase) - phase, 2 * math.pi) == near(later, rel=share)
    assert float(real.relative_velocity) - velocity == near(faster, rel=share, abs=share * kick)
    assert form.coefficient == near((1 + R) * math.sqrt(2 * form.acceleration), rel=1e-12)


def test_the_branch_with_one_impact_more_begins_at_the_grazing():
    ball = bouncing_ball_beyond.rigid(restitution=R)
    orbit = _grazing(ball)
    form = bouncing_ball_beyond.grazing_form(orbit)
    more = bouncing_ball_beyond.follow(orbit, points=10).to_dataset()
    assert more.attrs["impacts"] == 2 and more.attrs["periods"] == 1
    first = next(more.states())
    # Simulated balls follow it, whose certified events are those of the simulation.
    assert first.is_admissible()
    speed = -first.relative_impact_velocity[1]
    assert 0 < speed < 0.01
    # The parameter changes in proportion to the speed, with the slope of the form.
    change = first.amplitude - orbit.amplitude
    assert change == pytest.approx(form.slope * speed, rel=10 * speed)
    assert (change > 0) is form.opens_upwards
    # Here the orbits with one impact and with two exist on the same side.
    below, above = (
        bouncing_ball_beyond.orbit(
            ball, amplitude=orbit.amplitude + x, side="unstable"
        ).is_admissible()
        for x in (-1e-3, 1e-3)
    )
    assert below and not above and not form.opens_upwards and not form.persists


@pytest.mark.parametrize(
    "ball",
    [
        bouncing_ball_beyond.spring_damper(restitution=R, frequency_ratio=20.0),
        pytest.param(
            bouncing_ball_beyond.contact_law("hunt-crossley", stiffness=1e4, damping=0.1),
            marks=pytest.mark.long,
        ),
    ],
)
def test_a_contact_that_lasts_has_no_square_root(ball):
    """The parameter of the orbits with a slow impact changes with the square of its speed."""
    orbit = _grazing(ball)
    form = bouncing_ball_beyond.grazing_form(orbit)
    assert (form.coefficient, form.slope) == (0.0, 0.0)
    first = next(bouncing_ball_beyond.follow(orbit, points=10).states())
    assert first.impacts == 2 and first.is_admissible()
    # Balls beside the grazing orbit: the change of the landing is proportional to the depth.
    lam = orbit.amplitude
    relative = orbit.relative_impact_velocity

    def landing(aside):
        after = ball.cycle(lam, orbit.phase, relative + aside)
        if abs(float(after.relative_velocity)) < 0.1:
            after = ball.cycle(lam, after.phase, after.relative_velocity)
        return np.array([float(after.phase), float(after.relative_velocity)])

    # With S = 0 the quotient of differences stays bounded; with a square root it would grow by 10.
    here = landing(0.0)
    slopes = [
        np.max(np.abs(landing(sign * step) - here)) / step
        for sign in (1, -1)
        for step in (1e-5, 1e-7)
    ]
    assert max(slopes) < 3 * min(slopes)


@pytest.mark.parametrize(
    ("restitution", "ratio", "n", "start"),
    [
        (0.3741033749511521, 26.900080270186287, 2, 3.4),
        # On stiffer contacts, and with less loss, weekly.
        pytest.param(0.387, 48.6, 3, 5.0, marks=pytest.mark.long),
        pytest.param(0.787, 68.4, 3, 5.0, marks=pytest.mark.long),
    ],
)
def test_a_branch_begins_at_its_grazing_and_not_behind_a_fold_beside_it(
    restitution, ratio, n, start
):
    """The parameter of the orbits next to a grazing rises with v², and a saddle-node follows at a
    speed of some hundredths of 1/ϖ.
    """
    ball = bouncing_ball_beyond.spring_damper(restitution=restitution, frequency_ratio=ratio)
    count = 0
    for one in bouncing_ball_beyond.orbits(ball, n=n, amplitude=start):
        branch = bouncing_ball_beyond.follow(one, to=12.0, points=100).to_dataset()
        for kind, orbit in branch.special_states():
            if kind != "grazing of a flight":
                continue
            count += 1
            form = bouncing_ball_beyond.grazing_form(orbit)
            first = next(bouncing_ball_beyond.follow(orbit, points=10).states())
            speed = -first.relative_impact_velocity[form.leg + 1]
            assert 0 < speed < 1e-2 / ratio
            assert (first.amplitude > orbit.amplitude) is form.opens_upwards
            # The simulation, which knows nothing of the equations, has both orbits or none.
            before = branch.admissible.values[branch.amplitude.values < orbit.amplitude][-1]
            assert first.is_admissible() == before
            # On the side on which the form says that there are orbits, a branch may end.
            side = 1.0 if form.opens_upwards else -1.0
            bouncing_ball_beyond.follow(orbit, to=orbit.amplitude + 0.05 * side, points=10)
    assert count


def test_a_saddle_node_beside_a_grazing_is_found():
    """Shooting by the speed of the added impact had found Λ - Λg = 6e-8 at 1e-3 and 8e-8 at 2e-3,
    and -2e-7 at 3e-3, where the branch had begun.
    """
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.3741033749511521, frequency_ratio=26.900080270186287
    )
    for one in bouncing_ball_beyond.orbits(ball, n=2, amplitude=3.4):
        found = bouncing_ball_beyond.follow(one, to=6.2).to_dataset()
        if "grazing of a flight" in found.special_kind:
            grazing = found.first("grazing of a flight")
    more = bouncing_ball_beyond.follow(grazing, to=6.2, points=40).to_dataset()
    kinds = more.special_kind.values.tolist()
    assert kinds[0] == "saddle-node"
    beyond = float(more.special_amplitude[0]) - grazing.amplitude
    assert beyond == pytest.approx(9.2e-8, rel=0.01)


def test_what_has_no_branch_with_one_impact_more_says_why(refusal):
    rigid = bouncing_ball_beyond.rigid(restitution=R)
    orbit = _grazing(rigid)
    with refusal(NoOrbitError, "is beyond the grazing: the orbits with 2 impacts exist"):
        bouncing_ball_beyond.follow(orbit, to=2.6)
    delayed = bouncing_ball_beyond.corrected(
        bouncing_ball_beyond.spring_damper(restitution=R, frequency_ratio=20.0)
    )
    with refusal(NoOrbitError, "in the corrected model an impact takes effect after a delay"):
        bouncing_ball_beyond.follow(_grazing(delayed))
    for other in (bouncing_ball_beyond.orbit(rigid, amplitude=1.4), rigid, 0.5, None):
        with refusal(NoOrbitError, "the orbit is no grazing of a flight of a branch"):
            bouncing_ball_beyond.grazing_form(other)


@pytest.mark.parametrize("restitution", [0.3, 0.45, 0.65])
@pytest.mark.parametrize("ratio", [10.0, 20.0, 50.0])
def test_the_branch_with_one_impact_more_begins_although_rounding_errors_are_large(
    restitution, ratio
):
    """Next to the grazing the equations have rounding errors of 3e-13."""
    ball = bouncing_ball_beyond.spring_damper(restitution=restitution, frequency_ratio=ratio)
    high = bouncing_ball_beyond.orbit(ball, amplitude=2.0, side="unstable")
    grazing = bouncing_ball_beyond.follow(high, to=3.0).first("grazing of a flight")
    more = bouncing_ball_beyond.follow(grazing, points=10)
    assert more.impacts == 2 and more.orbits.defect().max() < 1e-11
