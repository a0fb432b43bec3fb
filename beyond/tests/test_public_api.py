"""The names that users import from the package."""

import dataclasses
import pickle
import pydoc

import numpy as np
import pytest
from public_face import PublicFace

import bouncing_ball_beyond as bb
from bouncing_ball_beyond import (
    ContactModel,
    RestitutionModel,
    SpringDamper,
    contact_law,
    corrected,
    orbit,
    orbits,
    rigid,
    simulate,
    spring_damper,
)
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.law_at_orbit import orbit_of_law

CONTACT = spring_damper(restitution=0.85, frequency_ratio=10.0)
RIGID = rigid(restitution=0.85)
TSUJI = contact_law("tsuji", stiffness=900.0, damping=0.1)


class TestPublicFace(PublicFace):
    """The names and calls of beyond."""

    bb = bb


def test_only_public_names_are_listed():
    assert dir(bb) == sorted([*bb.__all__, "__version__"])


def test_help_shows_the_way_in():
    text = pydoc.render_doc(bb, renderer=pydoc.plaintext)
    for call in ("bouncing_ball_beyond.orbit(", "bouncing_ball_beyond.follow(", "contact_law("):
        assert call in text


def test_a_single_number_in_is_a_python_number_out():
    one = orbit(CONTACT, 1, amplitude=np.float64(0.9))
    ends = bb.limits(RIGID)
    numbers = (one.phase, one.max_height, one.law.damping_ratio, ends.saddle_node.amplitude)
    assert {type(x) for x in (*numbers, *one.path(1.0))} == {float}
    assert type(one.is_stable()) is type(one.is_admissible()) is bool
    assert type(one.n) is int
    assert type(bb.permanent_contact(CONTACT)) is float


def test_equal_orbits_compare_equal_and_can_be_replaced_and_pickled():
    one = orbit(CONTACT, amplitude=0.9)
    assert one == orbit(CONTACT, amplitude=0.9)
    assert one != orbit(CONTACT, amplitude=0.9, side="unstable")
    assert hash(one) == hash(orbit(CONTACT, amplitude=0.9))
    assert pickle.loads(pickle.dumps(one)) == one
    # What follows from the fields follows from the new ones.
    moved = dataclasses.replace(one, velocities=np.array([-3.5]))
    assert moved.bounce_velocity == -3.5 + one.flight_time
    assert moved.defect() > 0.1 > 1e-12 > one.defect()
    assert dataclasses.replace(moved, velocities=one.velocities) == one
    # Also with what has been computed of it.
    assert pickle.loads(pickle.dumps(one)) == one


def test_an_orbit_with_several_impacts_is_of_the_same_class():
    one = orbit(RIGID, amplitude=1.0)
    ball = rigid(restitution=0.5)
    two = bb.orbit_of_motion(ball, amplitude=1.6)
    assert type(two) is type(one) and (one.impacts, two.impacts, two.periods) == (1, 2, 2)
    assert {type(x) for x in (one.phase, one.flight_time, two.amplitude, two.max_height)} == {float}
    for name in ("phase", "contact_duration", "impact_velocity", "flight_time"):
        assert getattr(two, name).shape == (2,)
    again = bb.orbit_of_motion(ball, amplitude=1.6)
    assert two == again and hash(two) == hash(again) and two != one
    assert pickle.loads(pickle.dumps(two)) == two


@pytest.mark.parametrize("ball", [RIGID, CONTACT, corrected(CONTACT), TSUJI])
def test_a_call_answers_with_the_orbit_of_the_model(ball):
    exact = n_t.orbit(ball, 1, 0.9)
    found = orbit(ball, amplitude=0.9)
    for name in ("phase", "contact_duration", "max_height", "bounce_velocity", "flight_time"):
        assert getattr(found, name) == getattr(exact, name)
    assert found.is_stable() == exact.is_stable()
    assert found.multipliers().tolist() == exact.multipliers().tolist()
    assert repr(found) == repr(exact)
    # Arrays have the same numbers but for rounding in products of matrices.
    row = orbit(ball, n=[1, 1], amplitude=0.9)
    assert row.phase.dims == ("n",) and abs(row.phase[1] - found.phase) < 1e-14
    assert n_t.absence(ball, 1, 0.01) == "below the saddle-node"


@pytest.mark.parametrize("ball", [RIGID, CONTACT, corrected(CONTACT), TSUJI])
def test_a_ball_whose_law_is_known_is_itself_at_every_speed(ball):
    assert ball.at_speed(3.0) is ball.at_orbit(1, 1.0) is ball.at_limits(1) is ball


def test_a_law_by_its_free_impact_has_a_model_at_a_speed():
    ball = contact_law("hunt-crossley", restitution=0.8, duration=0.2)
    stable = ball.at_orbit(1, 1.0)
    assert stable.law == ball.at_orbit(1, 1.0, Side.STABLE).law
    speed = -orbit(ball, amplitude=1.0).relative_impact_velocity
    at_speed = ball.at_speed(speed).law
    assert at_speed.stiffness == pytest.approx(stable.law.stiffness, rel=1e-9)
    known = contact_law("hunt-crossley", restitution=0.8, duration=0.2, speed=speed)
    assert known.law == at_speed


def test_the_name_of_a_side_means_the_side():
    ball = contact_law("hunt-crossley", restitution=0.8, duration=0.2)
    for side in Side:
        by_name = ball.at_orbit(1, 0.9, side.value)
        assert by_name.law == ball.at_orbit(1, 0.9, side).law
        assert (
            n_t.orbit(by_name, 1, 0.9, side.value).phase == n_t.orbit(by_name, 1, 0.9, side).phase
        )
        by_name = orbit_of_law(Tsuji, 0.8, 0.2, 1, 0.9, side.value).law
        assert by_name == orbit_of_law(Tsuji, 0.8, 0.2, 1, 0.9, side).law
    assert ball.at_orbit(1, 0.9).law != ball.at_orbit(1, 0.9, "unstable").law


def test_a_law_or_a_model_of_ones_own_is_a_ball():
    law = Tsuji(900.0, 0.1)
    for ball in (contact_law(law), ContactModel(law)):
        assert orbit(ball, amplitude=0.9) == orbit(TSUJI, amplitude=0.9)
        assert dict(ball.parameters) == dict(TSUJI.parameters)


SPRING = SpringDamper.from_restitution(0.85, 10.0)
MODELS = [
    (RestitutionModel(0.85), RIGID),
    (ContactModel(SPRING), CONTACT),
    (CorrectedModel.of_contact(SPRING), corrected(CONTACT)),
    (ContactModel(Tsuji(900.0, 0.1)), TSUJI),
]
LINEAR = {"frequency_ratio": 10.0, "damping_ratio": CONTACT.law.damping_ratio}
LINEAR |= {"release": "displacement"}
LABELS = [
    {"restitution": 0.85},
    LINEAR,
    {**LINEAR, "model": "corrected"},
    {"law": "tsuji", "stiffness": 900.0, "damping": 0.1},
]


def test_a_model_has_the_parameters_of_its_law():
    assert [dict(model.parameters) for model, _ in MODELS] == LABELS


# The bifurcations of a law, twice, take seconds: weekly. Its orbits are compared above.
OFTEN = [*MODELS[:3], pytest.param(*MODELS[3], marks=pytest.mark.long)]


@pytest.mark.parametrize(("model", "ball"), OFTEN)
def test_the_models_of_the_library_are_the_balls_of_all_calls(model, ball):
    assert type(model) is type(ball) and repr(model) == repr(ball)
    assert orbit(model, amplitude=0.9) == orbit(ball, amplitude=0.9)
    assert orbits(model, amplitude=0.9) == orbits(ball, amplitude=0.9)
    assert bb.limits(model) == bb.limits(ball)
    assert bb.permanent_contact(model) == bb.permanent_contact(ball)
    for call in (
        lambda one: simulate(one, amplitude=[0.9, 1.0], impacts=3),
        lambda one: bb.history(one, amplitude=0.9, periods=1.0),
        lambda one: bb.motion_of(one, amplitude=0.9, phase=1.0),
        lambda one: bb.follow(orbit(one, amplitude=0.9), to=0.95).to_dataset(),
    ):
        assert call(model).equals(call(ball))


def test_models_in_an_array_have_an_axis():
    found = orbit(RestitutionModel(np.array([0.5, 0.85])), amplitude=[0.9, 1.4])
    same = orbit(rigid(restitution=[0.5, 0.85]), amplitude=[0.9, 1.4])
    assert found.identical(same)
    # One value of each parameter for each model, and not a grid of them.
    pairs = SpringDamper(np.array([5.0, 10.0]), np.array([0.05, 0.1]))
    found = simulate(ContactModel(pairs), amplitude=[0.9, 1.0, 1.1], impacts=3)
    assert dict(found.time.sizes) == {"amplitude": 3, "model": 2, "impact": 3}
    assert found.frequency_ratio.values.tolist() == [5.0, 10.0]
    one = spring_damper(frequency_ratio=10.0, damping_ratio=0.1)
    one = simulate(one, amplitude=1.1, impacts=3)
    np.testing.assert_array_equal(found.time.isel(amplitude=2, model=1), one.time)


def test_parameters_of_a_law_may_be_arrays():
    stiffness = [500.0, 900.0]
    found = orbit(contact_law("tsuji", stiffness=stiffness, damping=0.1), amplitude=0.9)
    assert found.phase.dims == ("stiffness",)
    assert float(found.phase[1]) == pytest.approx(orbit(TSUJI, amplitude=0.9).phase, rel=1e-12)


@pytest.mark.parametrize("name", ["speed", "restitution", "duration", "stiffness", "other"])
def test_no_number_is_allowed_beside_a_law_that_has_its_parameters(name, refusal):
    with refusal(ModelError, f"{name} is not allowed with a law that has its parameters: tsuji"):
        contact_law(TSUJI.law, **{name: 3.0})
    with refusal(ModelError, "release is not allowed with a law"):
        contact_law(TSUJI.law, release="force")


def test_the_map_of_floats_is_one_of_floats():
    found = rigid(restitution=0.5).cycle(1.2, 0.3, -2.0)
    assert all(isinstance(each, float) for each in found)


@pytest.mark.parametrize("law", ["linear", "elasto-backlash"])
@pytest.mark.parametrize("ratio", [1e300, 1.1e8, 0.9e-8])
def test_the_frequency_ratio_of_a_law_has_the_range_of_that_of_a_spring(law, ratio, refusal):
    given = {"frequency_ratio": ratio, "damping_ratio": 0.1}
    with refusal(ModelError, "frequency_ratio", "is not a number in [1e-08, 1e+08]"):
        spring_damper(**given)
    with refusal(ModelError, "frequency_ratio", "is not a number in [1e-08, 1e+08]"):
        contact_law(law, **given)


@pytest.mark.parametrize("stiffness", [1.1e20, 0.9e-20])
def test_the_stiffness_of_a_law_has_the_range_of_its_frequency_ratio(stiffness, refusal):
    # ϖ ~ K^(2/5).
    with refusal(ModelError, "stiffness", "is not a number in [1e-20, 1e+20]"):
        contact_law("tsuji", stiffness=stiffness, damping=0.1)


def test_all_orbits_at_an_amplitude_are_in_order_of_their_contacts():
    found = orbits(spring_damper(restitution=0.85, frequency_ratio=2.0), amplitude=0.9)
    durations = [each.contact_duration for each in found]
    assert durations == sorted(durations) and len(durations) == 3
    assert [each.is_stable() for each in found] == [True, False, True]


def test_a_sequence_counts_the_impacts_that_it_has():
    stuck = rigid(restitution=0.2).simulate(0.6, 0.0, -np.pi, 50)
    assert stuck.impacts < 50
    assert repr(stuck).startswith(f"ImpactSequence: {stuck.impacts} impacts, then permanent")
    both = rigid(restitution=[0.2, 0.8]).simulate(0.6, 0.0, -np.pi, 50)
    assert f"{stuck.impacts} to 50 impacts of each of 2 balls" in repr(both)
    found = simulate(rigid(restitution=[0.2, 0.8]), amplitude=0.6, impacts=50)
    assert found.time.count("impact").values.tolist() == [stuck.impacts, 50]
    assert found.status.values.tolist() == ["permanent contact", "bouncing"]


@pytest.mark.parametrize("ball", [RIGID, CONTACT, corrected(CONTACT)])
def test_a_simulation_over_arrays_is_a_grid_of_single_ones(ball):
    found = simulate(ball, amplitude=1.0, phase=[2.0, 0.1], velocity=[-3.0], impacts=4)
    assert dict(found.time.sizes) == {"phase": 2, "velocity": 1, "impact": 4}
    for k, phase in enumerate((2.0, 0.1)):
        one = ball.simulate(1.0, phase, -3.0, 4)
        each = found.isel(phase=k, velocity=0)
        np.testing.assert_array_equal(each.time, one.time)
        np.testing.assert_array_equal(each.impact_phase, one.phase)
        np.testing.assert_array_equal(each.bounce_velocity, one.bounce_velocity)


@pytest.mark.parametrize(
    "ball",
    [
        CONTACT,
        RIGID,
        pytest.param(contact_law("tsuji", restitution=0.85, duration=0.1), marks=pytest.mark.long),
    ],
)
def test_arrays_give_labelled_orbits_and_limits(ball):
    found = orbit(ball, [1, 2], amplitude=[0.2, 1.0])
    assert found.phase.dims == ("n", "amplitude")
    # Below the saddle-node of both families.
    assert found.phase.sel(amplitude=0.2).isnull().all()
    assert not found.stable.sel(amplitude=0.2).any()
    ends = bb.limits(ball, [1, 2])
    one = orbit(ball, 2, amplitude=1.0)
    for name in ("phase", "max_height", "contact_duration"):
        assert found[name].sel(n=2, amplitude=1.0) == pytest.approx(getattr(one, name), 1e-12)
    node = bb.limits(ball, 2).saddle_node
    assert ends.saddle_node_amplitude.sel(n=2) == pytest.approx(node.amplitude, rel=1e-9)


def test_error_thresholds_are_those_of_the_errors_of_the_models():
    ball = rigid(restitution=[0.65, 0.85])
    found = bb.error_thresholds(
        ball, amplitude=1.0, tolerance=[0.01, 0.05], quantities=["max_height", "phase"]
    )
    assert dict(found.error_threshold.sizes) == {
        "tolerance": 2, "restitution": 2, "simple": 2, "quantity": 2
    }  # fmt: skip
    at = found.isel(tolerance=1).sel(restitution=0.85, simple="restitution")
    ratio = float(at.error_threshold.sel(quantity="max_height"))
    exact = orbit(spring_damper(restitution=0.85, frequency_ratio=ratio), amplitude=1.0)
    simple = orbit(RIGID, amplitude=1.0)
    assert abs(exact.max_height / simple.max_height - 1) == pytest.approx(0.05, rel=1e-9)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: n_t.orbit(RIGID, 1, 1.0, "up"), "one of stable, unstable"),
        (lambda: corrected(RIGID), "restitution impacts have no contact"),
        (lambda: contact_law("tsuji", **{"{x}": 1.0}), "unknown parameter '{x}' of tsuji"),
        (lambda: contact_law("tsuji", stiffness=1.0), "tsuji also needs damping=NUMBER"),
        (lambda: contact_law("tsuji"), "needs stiffness=NUMBER, damping=NUMBER, or restitution"),
        (lambda: contact_law(["tsuji"]), "unknown contact law"),
        (
            lambda: bb.permanent_contact(contact_law("tsuji", restitution=0.5, duration=0.1)),
            "duration needs speed",
        ),
        (
            lambda: corrected(
                contact_law("elasto-backlash", frequency_ratio=[9.0, 8.0], damping_ratio=0.1)
            ),
            "is tabulated for one law",
        ),
    ],
)
def test_wrong_values_are_refused_with_the_allowed_ones(call, says, refusal):
    with refusal(ModelError, says):
        call()
