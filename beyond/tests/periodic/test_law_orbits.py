"""Orbits on any contact: the closed form where there is one, and properties that all laws share."""

import math

import numpy as np
import pytest
from loaded_laws import Sharing
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bouncing_ball_beyond
from bouncing_ball_beyond.accuracy.error_law import curvature_of, doubling_lift, law_errors
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS, paper_error, values
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley, KuwabaraKono, Tsuji
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.start_speed import Flores, LankaraniNikravesh
from bouncing_ball_beyond.models.laws.stepped import Stepped
from bouncing_ball_beyond.models.named_laws import LAWS, law_named
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.law_balls import contact_law
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.law_at_orbit import orbit_of_law
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_beyond.periodic.one_impact.searched_orbits import (
    SearchedOrbits,
    restitution_speed,
)
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import (
    orbits_at as by_formula,
)

KINDS = [SpringDamper, *LAWS.values()]
every_kind = pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])


@pytest.mark.parametrize(
    "law", [HuntCrossley(1e3, 0.08), HuntCrossley(1e3, 0.5), KuwabaraKono(2e3, 0.008)]
)
def test_the_impact_speed_of_the_restitution_models_orbits_solves_its_equation(law):
    model = ContactModel(law)
    n = np.array([1, 2, 5])
    speed, _ = restitution_speed(n, model)
    # The last step of Newton's method is below 1e-3, and leaves its square.
    period = (1 + model.signature(speed).restitution) * speed
    np.testing.assert_allclose(period, 2 * np.pi * n, rtol=1e-6)


def beyond_a_period(speed, signature):
    """Impulse of a free impact less that of the weight in a period, 0 at v₀ of n = 1."""
    return float((1 + signature(speed).restitution) * speed) - 2 * np.pi


def errors_of_durations(name, amplitude, durations):
    """Errors of the restitution model, of the corrected one and by the law, on the contacts with
    these durations, shape (3, duration, quantity).

    The restitution model has r(v). Without Λ the orbits are at its saddle-node.
    """
    found = []
    for duration in durations:
        if name == "by depth":
            # The width is that of the impact, so that r is the same at both durations.
            law = Sharing(np.pi / duration, 0.1, 0.95, 0.5, width=duration / 2)
        else:
            # The damping of Lankarani and Nikravesh is limited by e = 0, and r by 2/3. On stepped
            # contacts the second order that the error law leaves of the height vanishes near 0.65.
            r = 0.7 if issubclass(LAWS[name], LankaraniNikravesh | Stepped) else 0.65
            law = law_of_impact(LAWS[name], r, duration, rigid_speed(1, r))
        model, signature = ContactModel(law), Signature(law)
        speed = brentq(beyond_a_period, 1.0, 7.0, (signature,))
        instant = signature(speed)
        r = float(instant.restitution)
        fold = float(restitution_saddle_node(1, r))
        # Not below it by rounding, and above it by less than the contact moves it.
        lam = fold * (1 + 1e-12) if amplitude is None else amplitude
        exact, corrected, rigid = (
            values(each, 1, lam) for each in (model, CorrectedModel(signature), RestitutionModel(r))
        )
        lift = doubling_lift(r, r + float(instant.d_restitution) * speed)
        rigid[-1] = np.hypot(fold, lift)
        law_of = law_errors(1, instant, lam, curvature_of(signature, speed))
        found.append(
            [paper_error(exact=exact, simple=each) for each in (rigid, corrected)]
            + [[float(law_of[q]) for q in OF_IMPACTS]]
        )
    return np.moveaxis(found, 1, 0)


# A Hertz contact, one whose r depends on the speed, and a law that feels its load and has a kink;
# the others weekly.
OFTEN = ("tsuji", "hunt-crossley")
SELDOM = [pytest.param(x, marks=pytest.mark.long) for x in LAWS if x not in OFTEN]


@pytest.mark.parametrize("name", [*OFTEN, "by depth", *SELDOM])
def test_the_corrected_model_and_the_error_law_leave_errors_of_second_order(name):
    simple, corrected, law = errors_of_durations(name, 1.0, (0.04, 0.02))
    # The next order is a share of D. It is seen in the apparent restitution, most of whose first
    # order cancels, and in the period doubling.
    assert (simple[0] / simple[1])[[0, 1, 2, 4]] == pytest.approx(np.full(4, 2.0), rel=0.04)
    for left in (corrected, simple - law):
        assert left[0] / left[1] == pytest.approx(np.full(len(OF_IMPACTS), 4.0), rel=0.07)


@pytest.mark.parametrize("name", [*OFTEN, "by depth", *SELDOM])
def test_at_the_saddle_node_the_height_on_any_law_is_right_to_the_order_three_halves(name):
    simple, _, law = errors_of_durations(name, None, (0.01, 0.0025))
    left = (simple - law)[:, 0]
    # The next term is a share √D of it, 0.1 and 0.05.
    assert np.log(left[0] / left[1]) / np.log(4) == pytest.approx(1.5, abs=0.1)
    assert np.all(np.abs(left) < 0.1 * np.abs(law[:, 0]))


@every_kind
def test_a_law_has_the_restitution_and_duration_that_were_asked_for(kind):
    # The damping of this law is limited by e = 0: c = 3/4.
    least = 0.67 if kind is LankaraniNikravesh else 0.3
    for r, duration, speed in ((least, 0.2, 1.0), (0.95, 1e-3, 7.0), (1.0, 0.1, 3.0)):
        impact = law_of_impact(kind, r, duration, speed).signature(speed)
        assert float(impact.restitution) == pytest.approx(r, rel=1e-13)
        assert float(impact.duration) == pytest.approx(duration, rel=1e-13)


def test_a_law_at_an_orbit_is_the_same_for_a_side_and_its_name():
    of_side = orbit_of_law(HuntCrossley, 0.65, 0.1, 1, 1.0, Side.UNSTABLE).law
    assert orbit_of_law(HuntCrossley, 0.65, 0.1, 1, 1.0, "unstable").law == of_side
    assert orbit_of_law(HuntCrossley, 0.65, 0.1, 1, 1.0).law != of_side


def test_an_unknown_law_and_an_impossible_impact_are_refused():
    with pytest.raises(ModelError, match=r"unknown contact law 'rubber': one of hunt-crossley"):
        law_named("rubber")
    for r, duration, speed in ((0.0, 1.0, 1.0), (1.1, 1.0, 1.0), (0.5, 0.0, 1.0), (0.5, 1.0, -1)):
        with pytest.raises(ModelError, match="is not"):
            law_of_impact(HuntCrossley, r, duration, speed)
    with pytest.raises(ModelError, match="hardly leaves"):
        law_of_impact(HuntCrossley, 1e-6, 0.1, 1.0)
    for law, r in ((LankaraniNikravesh, 0.6629), (Flores, 1e-3)):
        with pytest.raises(ModelError, match="hardly leaves"):
            law_of_impact(law, r, 0.1, 1.0)


def test_far_above_the_fold_an_orbit_is_followed_to_or_reported_as_not_found(monkeypatch):
    model = ContactModel(Tsuji(1e3, 0.3))
    orbit = n_t.require_orbit(model, 20, 300.0, Side.UNSTABLE)
    # The contact is one of the collocation's; the equations hold to rounding of z ≈ Λ.
    assert orbit.defect() < 1e-12 * 300
    assert orbit.trace_and_determinant()[0] > 2
    # A walk of a few steps does not arrive, and one of 300 takes seconds.
    monkeypatch.setattr("bouncing_ball_beyond.periodic.one_impact.searched_orbits._POINTS", 8)
    with pytest.raises(NoOrbitError, match="none was found, but one may exist"):
        n_t.require_orbit(model, 20, 1000.0, Side.UNSTABLE)


@pytest.mark.parametrize(
    ("r", "duration"), [(0.85, 0.3), pytest.param(0.5, 0.6, marks=pytest.mark.long)]
)
def test_just_above_the_fold_two_orbits_part_as_the_root_of_the_distance(r, duration):
    model = ContactModel(law_of_impact(HuntCrossley, r, duration, rigid_speed(1, r)))
    fold = n_t.saddle_node(model, 1)
    apart = []
    for above in (1e-6, 1e-4):
        stable, unstable = (
            n_t.orbit(model, 1, fold.amplitude * (1 + above), side) for side in Side
        )
        assert stable.defect() < 1e-11 and unstable.defect() < 1e-11
        assert stable.phase > fold.phase > unstable.phase
        apart.append(float(stable.phase - unstable.phase))
    # The next order of the root is smaller by the distance itself.
    assert apart[1] / apart[0] == pytest.approx(10, rel=1e-3)


@pytest.mark.parametrize(("amplitude", "number"), [(0.9, 3), (3.0, 1)])
def test_a_branch_that_turns_again_is_followed_to_all_of_its_orbits(amplitude, number):
    """Also from far above the fold, which is at Λ = 0.18: the closed form has the same orbits."""
    contact = SpringDamper(2.0, 0.05)
    found = SearchedOrbits(ContactModel(contact)).orbits(1, amplitude)
    known = by_formula(contact, 1, amplitude)
    assert found.contact_duration.shape == (number,)
    assert np.abs(found.contact_duration - known.contact_duration).max() < 1e-11


@pytest.mark.parametrize("law", [HuntCrossley, SpringDamper])
@pytest.mark.parametrize("value", ["x", "2.0", True, [[1.0], [2.0, 3.0]]])
def test_a_parameter_of_a_law_that_is_no_number_is_refused(law, value, refusal):
    first, second, *_ = law.parameter_names()
    for parameters in ({first: value, second: 0.1}, {first: 2.0, second: value}):
        with refusal(ModelError, f"= {value!r} is not a"):
            law(**parameters)
    with refusal(ModelError, f"{first} of shape (2,) and {second} of shape (3,) do not broadcast"):
        law(**{first: [2.0, 3.0], second: [0.1, 0.2, 0.3]})


@pytest.mark.parametrize("kind", [HuntCrossley, Tsuji])
def test_a_row_of_corrected_models_is_that_of_its_laws(kind):
    laws = kind(np.array([300.0, 2e3, 5e4]), np.array([0.05, 0.1, 0.02]))
    row = CorrectedModel.of_contact(laws)
    one = [CorrectedModel.of_contact(law) for law in laws]
    # The orbits move by rounding only; the tables are the same.
    found = n_t.orbit(row, 1, 1.0).max_height
    np.testing.assert_allclose(found, [n_t.orbit(x, 1, 1.0).max_height for x in one], rtol=1e-12)
    fold = n_t.saddle_node(row, 1).amplitude
    np.testing.assert_allclose(fold, [n_t.saddle_node(x, 1).amplitude for x in one], rtol=1e-11)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_linear_law_is_the_ball_of_the_spring_and_damper(release):
    given = {"frequency_ratio": 2.0, "damping_ratio": 0.05, "release": release}
    ball = contact_law("linear", **given)
    assert (
        ball == bouncing_ball_beyond.spring_damper(**given) and ball.parameters["law"] == "linear"
    )
    assert contact_law(SpringDamper(2.0, 0.05, release)) == ball
    found = bouncing_ball_beyond.orbits(ball, amplitude=0.9)
    searched = bouncing_ball_beyond.orbits(ContactModel(ball.law), amplitude=0.9)
    assert len(found) == 3
    # Newton's method for the orbits of any law has a tolerance of 1e-12.
    assert max(one.distance(other) for one, other in zip(found, searched, strict=True)) < 1e-11


def test_an_overdamped_contact_with_a_force_release_has_orbits():
    """One cycle by scipy, which shares no code: the contact up to zero force, then a parabola."""
    omega, zeta, lam = 20.0, 1.5, 3.0
    ball = contact_law("linear", frequency_ratio=omega, damping_ratio=zeta, release="force")
    orbit = bouncing_ball_beyond.orbit(ball, amplitude=lam)

    def force(_, y):
        return -(omega**2 * y[0] + 2 * zeta * omega * y[1])

    def motion(s, y):
        return y[1], -1 + lam * math.sin(orbit.phase + s) + force(s, y)

    force.terminal = True
    force.direction = -1
    start = [0.0, orbit.relative_impact_velocity]
    run = solve_ivp(motion, (0, 6), start, "DOP853", events=force, rtol=1e-12, atol=1e-14)
    ((gap, rate),) = run.y_events[0]
    (duration,) = run.t_events[0]
    assert duration == pytest.approx(orbit.contact_duration, rel=1e-9)
    left = orbit.phase + duration
    velocity = rate + lam * math.cos(left)
    flight = 2 * math.pi - duration
    landing = gap + lam * math.sin(left) + velocity * flight - flight**2 / 2
    assert landing == pytest.approx(lam * math.sin(orbit.phase), abs=1e-8)
    assert velocity - flight == pytest.approx(orbit.impact_velocity, abs=1e-8)
    assert orbit.is_stable() and bouncing_ball_beyond.limits(ball).saddle_node.amplitude < lam


def test_an_overdamped_contact_is_followed_along_its_damping():
    """The orbits at the end of the branch are those that are found there directly."""
    law = {"frequency_ratio": 20.0, "release": "force"}
    ball = contact_law("linear", damping_ratio=1.5, **law)
    orbit = bouncing_ball_beyond.orbit(ball, amplitude=3.0)
    *_, last = bouncing_ball_beyond.follow(orbit, along="damping_ratio", to=2.0).states()
    there = bouncing_ball_beyond.orbit(
        contact_law("linear", damping_ratio=2.0, **law), amplitude=3.0
    )
    assert float(last.distance(there)) < 1e-10
    with pytest.raises(ModelError, match=r"to = 0.5 is not a finite number ≥ 1"):
        bouncing_ball_beyond.follow(orbit, along="damping_ratio", to=0.5)
