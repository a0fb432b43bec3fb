"""Curves of special orbits: closed forms, flights sampled anew, and orbits on both sides."""

import numpy as np
import pytest

from bouncing_ball_beyond import (
    OrbitNotFound,
    Rigid,
    SpringDamper,
    follow,
    orbit,
    special_curve,
)
from bouncing_ball_beyond.periodic.equations import flight

# Orbits are found to rounding errors of numbers up to ten.
ROUNDED = 1e-12
# Special orbits are located to some rounding errors of their tests, over the slopes of these.
LOCATED = 1e-9

COMPLIANT = SpringDamper(2.0, restitution=0.85)
STIFFNESS = ("amplitude", "frequency_ratio")


def height(restitution, n=1):
    """The amplitude of the saddle-node of the restitution model, πn (1 - r)/(1 + r)."""
    return np.pi * n * (1 - restitution) / (1 + restitution)


@pytest.fixture(scope="module")
def rigid():
    """A branch from a saddle-node to a period doubling."""
    return follow(orbit(Rigid(0.5), amplitude=1.4), to=(0.9, 1.8))


@pytest.fixture(scope="module")
def compliant():
    """The branch of a contact with ϖ = 2, which turns back twice."""
    return follow(orbit(COMPLIANT, amplitude=0.9), to=0.1)


@pytest.mark.parametrize("kind", ["saddle-node", "period doubling"])
def test_curves_of_the_restitution_model_are_closed_forms(rigid, kind):
    ranges = {"amplitude": (0.05, 3.0), "restitution": (0.1, 1.0)}
    curve = special_curve(rigid.first(kind), ranges=ranges)
    amplitude, r = curve.z[:, -2:].T
    expected = height(r)
    if kind == "period doubling":
        expected = np.hypot(expected, 2 * (1 + r**2) / (1 + r) ** 2)
    assert amplitude == pytest.approx(expected, rel=ROUNDED)
    # Adjacent points of a picture are close, in units that are changes of the logarithm.
    assert np.abs(np.diff(np.log(curve.refined().z[:, -2]))).max() < 0.1
    assert curve.kind == kind
    assert {special.kind for special in curve.orbits} == {kind}
    if kind == "period doubling":
        assert (curve.start, curve.end) == (
            "amplitude = 3 is reached",
            "restitution = 1 is reached",
        )
        # There both multipliers are -1.
        assert curve.orbits[-1].multipliers == pytest.approx([-1, -1], abs=1e-6)
    else:
        assert "amplitude = 0.05 is reached" in (curve.start, curve.end)


def test_a_curve_of_saddle_nodes_goes_on_beyond_a_cusp(compliant):
    """Two saddle-nodes meet there, and both parameters turn back."""
    ranges = {"amplitude": (0.01, 2.0), "frequency_ratio": (0.9, 3.0)}
    curve = special_curve(compliant.first("saddle-node"), along=STIFFNESS, ranges=ranges)
    ratio = curve.refined(1e-3).z[:, -1]
    # The cusp is at 1.0261355 and Λ = 0.1151558, by another code.
    assert ratio.min() == pytest.approx(1.0261355, abs=1e-4)
    assert ratio.min() > 1.0261355 - 1e-7
    assert curve.end == "frequency_ratio = 3 is reached"
    # The other end is where the ball no longer leaves the table at the end of its contact.
    assert curve.start.startswith("lost release")
    lost = curve.special[0]
    assert lost.kind == "lost release"
    assert abs(lost.relative_bounce_velocity) < 1e-6
    assert not np.any(np.isnan(curve.z))


def test_a_curve_of_doubled_orbits_goes_through_their_doublings(rigid):
    doubled = follow(rigid.first("period doubling"), to=1.8)
    ranges = {"amplitude": (0.5, 2.0), "restitution": (0.3, 0.9)}
    curve = special_curve(doubled.first("period doubling"), ranges=ranges)
    assert (curve.impacts, curve.periods) == (2, 2)
    point = curve.orbits[len(curve) // 3]
    assert point.turn == pytest.approx(-1, abs=1e-10)
    ball = Rigid(point.parameters["restitution"])
    one = orbit(ball, amplitude=1.02 * height(ball.restitution))
    first = follow(one, to=3.0).first("period doubling")
    second = follow(first, to=3.0).first("period doubling")
    assert second.amplitude == pytest.approx(point.amplitude, rel=1e-10)


def test_flights_graze_along_a_curve():
    start = orbit(Rigid(0.5), amplitude=2.0, side="unstable")
    grazing = follow(start, to=3.0).first("grazing of a flight")
    ranges = {"amplitude": (0.5, 4.0), "restitution": (0.1, 1.0)}
    curve = special_curve(grazing, ranges=ranges)
    assert "restitution = 1 is reached" in (curve.start, curve.end)
    for special in curve.orbits[1:-1]:
        times = np.linspace(0.5, special.flight_time - 0.01, 20001)
        speed = special.relative_bounce_velocity
        gaps = flight(times, special.times[0], 0.0, speed, special.amplitude)[0]
        # Samples miss the lowest point by half a step: δ″ (1.5e-4)²/2.
        assert gaps.min() == pytest.approx(0.0, abs=1e-7)


def test_flights_of_saddle_nodes_graze_before_the_release_is_lost():
    """Both are in the last step of the curve."""
    fold = follow(orbit(SpringDamper(10.0, restitution=0.5), amplitude=1.3), to=0.5)
    ranges = {"amplitude": (0.02, 5.0), "frequency_ratio": (0.3, 30.0)}
    curve = special_curve(fold.first("saddle-node"), along=STIFFNESS, ranges=ranges)
    assert curve.start.startswith("lost release")
    grazing = curve.first("grazing of a flight")
    times = np.linspace(0.1, grazing.flight_time - 0.1, 20001)
    leaves = grazing.times[0] + grazing.contact_duration
    speed = grazing.relative_bounce_velocity
    gaps = flight(times, leaves, 0.0, speed, grazing.amplitude)[0]
    assert gaps.min() == pytest.approx(0.0, abs=1e-7)


def test_a_frequency_is_one_of_two_parameters():
    ball = SpringDamper(25.0, restitution=0.85)
    doubling = follow(orbit(ball, amplitude=0.9), to=1.3).first("period doubling")
    ranges = {"frequency": (0.5, 1.5), "restitution": (0.5, 1.0)}
    curve = special_curve(doubling, along=("frequency", "restitution"), ranges=ranges)
    for special in curve.orbits[::4]:
        assert special.amplitude == pytest.approx(special.parameters["frequency"] ** 2, rel=ROUNDED)
        stroke = special.parameters["frequency_ratio"] ** 2 * special.amplitude
        assert stroke == pytest.approx(25.0**2 * doubling.amplitude, rel=ROUNDED)


def test_a_period_halving_is_a_period_doubling(rigid):
    doubling = rigid.first("period doubling")
    doubled = follow(doubling, to=1.6).orbits[-1]
    halving = follow(doubled, to=1.0).first("period halving")
    ranges = {"amplitude": (1.0, 2.0), "restitution": (0.4, 0.6)}
    curve = special_curve(halving, ranges=ranges)
    assert (curve.impacts, curve.kind) == (1, "period doubling")


@pytest.mark.parametrize(
    ("ball", "to"), [(Rigid(0.5), 2.3), (SpringDamper(30.0, restitution=0.5), 2.5)]
)
def test_the_grazing_of_an_impact_is_that_of_a_flight(ball, to):
    start = orbit(ball, amplitude=2.0, side="unstable")
    grazing = follow(start, to=3.0).first("grazing of a flight")
    # The branch of the rigid ball leaves downwards; that of the stiff one turns back at once.
    more = follow(grazing, to=to)
    assert more.values[-1] < grazing.amplitude
    vanishing = follow(more.orbits[-1], to=4.0).first("grazing of an impact")
    assert vanishing.impacts == 2
    assert vanishing.amplitude == pytest.approx(grazing.amplitude, rel=1e-9)
    with pytest.raises(OrbitNotFound, match=r"a curve must start at .*: grazing of a flight"):
        special_curve(vanishing)


def test_wrong_arguments_are_named(rigid):
    doubling = rigid.first("period doubling")
    with pytest.raises(OrbitNotFound, match="kind = '': a curve must start at a special orbit"):
        special_curve(rigid.orbits[0])
    with pytest.raises(ValueError, match="along = 'stiffness'"):
        special_curve(doubling, along=("amplitude", "stiffness"))
    with pytest.raises(OrbitNotFound, match="no cusp here; special orbits"):
        special_curve(doubling, ranges={"restitution": (0.4, 0.6)}).first("cusp")
    with pytest.raises(ValueError, match="along = 'frequency_ratio': must be the names"):
        special_curve(doubling, along="frequency_ratio")
    with pytest.raises(ValueError, match=r"ranges = \[0\.5, 3\]: must be a mapping of names to"):
        special_curve(doubling, ranges=[0.5, 3])
    with pytest.raises(ValueError, match=r"special = FollowedBranch\(…\): must be a special orbit"):
        special_curve(rigid)
    for second in ("amplitude", "frequency"):
        with pytest.raises(ValueError, match="two different parameters"):
            special_curve(doubling, along=("amplitude", second))
    with pytest.raises(ValueError, match=r"restitution = 0\.5 is not in its range"):
        special_curve(doubling, ranges={"restitution": (0.6, 0.9)})
    with pytest.raises(ValueError, match="frequency_ratio: the parameters of the curve are"):
        special_curve(doubling, ranges={"frequency_ratio": (1, 9)})


def test_a_saddle_node_on_a_curve_of_grazings_is_a_special_orbit():
    """It is no turning point of a parameter."""
    start = orbit(Rigid(0.35), amplitude=2.0, side="unstable")
    grazing = follow(start, to=12.0).first("grazing of a flight")
    curve = special_curve(grazing, ranges={"amplitude": (0.2, 12.0), "restitution": (0.02, 1.0)})
    assert [special.kind for special in curve.special] == ["saddle-node"]
