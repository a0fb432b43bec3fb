"""Curves of special orbits in two parameters: against closed forms, with cusps and resonances."""

import numpy as np
import pytest
from orbits_found import FOUND, balls, first, found_orbit

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.periodic.branches.curves import Degenerate, curve_through
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.ends import Window
from bouncing_ball_beyond.periodic.orbits.special import Special, flight_margin


def special(name, kind, to, amplitude=1.3):
    orbit = n_t.orbit(balls(name, amplitude).model, 1, amplitude)
    return first(branch_from(orbit, to=to), kind)


def curve_of(start, across, **settings):
    """The curve along Λ and a second parameter."""
    return curve_through(start, Special(start.kind), "amplitude", across, **settings)


@pytest.mark.parametrize(("kind", "to", "formula"), [
    (Special.SADDLE_NODE, 0.1, restitution_saddle_node),
    (Special.PERIOD_DOUBLING, 2.0, restitution_period_doubling),
])  # fmt: skip
def test_the_curves_of_the_restitution_model_are_the_closed_forms(kind, to, formula):
    window = Window(0.2, 0.95)
    found = curve_of(special("restitution", kind, to), "restitution", across_window=window)
    values = found.problem.values(found.branch.points)
    assert values["restitution"].min() == pytest.approx(0.2)
    assert values["restitution"].max() == pytest.approx(0.95)
    assert np.abs(formula(1, values["restitution"]) - values["amplitude"]).max() < 1e-12


def test_along_the_stiffness_the_curve_is_that_of_the_closed_form():
    start = special("spring-damper", Special.PERIOD_DOUBLING, 2.0)
    found = curve_of(start, "frequency_ratio", across_window=Window(3.0, 50.0))
    for each in list(found)[::10]:
        expected = n_t.period_doubling(each.model, 1).amplitude
        assert each.amplitude == pytest.approx(expected, abs=1e-12)


def test_the_curve_of_doublings_ends_at_a_1_to_2_resonance_without_dissipation():
    start = special("restitution", Special.PERIOD_DOUBLING, 2.0)
    found = curve_of(start, "restitution", across_window=Window(0.3, 1.0))
    (resonance,) = found.special
    assert resonance.kind == Degenerate.ONE_TO_TWO
    assert resonance.amplitude == pytest.approx(1.0, abs=1e-8)
    assert "restitution = 1 is reached" in (str(found.branch.start), str(found.branch.end))


def test_without_dissipation_a_curve_of_saddle_nodes_ends_at_a_1_to_1_resonance():
    """With det M = r^{2k}, a saddle-node has the multipliers 1 and r^{2k}, both 1 at r = 1 only."""
    case = next(x for x in FOUND if x[:2] == ("restitution", 3))
    fold = first(branch_from(found_orbit(case), to=0.5), Special.SADDLE_NODE)
    found = curve_of(fold, "restitution", across_window=Window(0.2, 1.0))
    trace, determinant = found.problem.trace_and_determinant(found.branch.points)
    r = found.problem.values(found.branch.points)["restitution"]
    size = np.abs(trace) + 1
    assert np.abs(determinant - r**6).max() < 1e-11 * size.max()
    assert np.abs(trace - 1 - r**6).max() < 1e-11 * size.max()
    (resonance,) = found.special
    assert resonance.kind == Degenerate.ONE_TO_ONE
    assert resonance.parameters["restitution"] == pytest.approx(1, abs=1e-9)
    # A double multiplier moves by the square root of rounding.
    assert np.abs(resonance.multipliers() - 1).max() < 1e-6


def test_two_folds_of_a_compliant_contact_meet_at_a_cusp():
    """It is found from both folds, and between them there are two orbits more."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=2.0)
    branch = bouncing_ball_beyond.follow(bouncing_ball_beyond.orbit(ball, amplitude=0.9), to=0.05)
    folds = [each for kind, each in branch.special_states() if kind == "saddle-node"]
    assert len(folds) >= 2
    cusps = []
    for fold in folds[:2]:
        windows = {"along_window": Window(0.01, 2.0), "across_window": Window(0.9, 3.0)}
        found = curve_of(fold, "frequency_ratio", **windows)
        cusps += [each for each in found.special if each.kind == Degenerate.CUSP]
    values = np.array([list(cusp.parameters.values()) for cusp in cusps])
    assert len(values) == 2 and np.ptp(values, axis=0).max() < 1e-9


def test_grazing_orbits_are_a_curve():
    start = special("restitution", Special.GRAZING_FLIGHT, 0.9, amplitude=2.0)
    found = curve_of(start, "restitution", across_window=Window(0.45, 0.55))
    assert len(found) > 5
    margins = flight_margin(found.problem, found.branch.points)
    # At grazing the minimum may be negative by rounding.
    assert np.abs(margins).max() < 1e-12


def test_a_period_doubling_starts_no_curve_of_saddle_nodes(refusal):
    start = special("restitution", Special.PERIOD_DOUBLING, 2.0)
    with refusal(NoOrbitError, "the start is no saddle-node; Newton's method leads to another"):
        curve_through(start, Special.SADDLE_NODE, "amplitude", "restitution")


def test_a_curve_of_an_unknown_kind_or_parameter_is_refused(refusal):
    start = special("restitution", Special.PERIOD_DOUBLING, 2.0)
    with refusal(ModelError, "these orbits have no 'stiffness': one of restitution, amplitude"):
        curve_through(start, Special.PERIOD_DOUBLING, "amplitude", "stiffness")
    with refusal(ModelError, "'period halving' is not one of"):
        curve_through(start, Special.PERIOD_HALVING, "amplitude", "restitution")


@pytest.mark.parametrize("name", ["rigid", "spring-damper"])
def test_a_curve_without_ranges_ends_with_a_reason_and_its_points_are_spread(name):
    """It took 500 points at an end, most of them within 1e-3 of it."""
    ball = {
        "rigid": bouncing_ball_beyond.rigid(restitution=0.5),
        "spring-damper": bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0),
    }[name]
    fold = bouncing_ball_beyond.limits(ball).saddle_node
    found = bouncing_ball_beyond.follow(fold, along=("amplitude", "restitution")).to_dataset()
    first, last = found.end_reason.values
    assert str(last) == "amplitude = 0.0001 is reached"
    expected = {
        "rigid": "restitution = 0 is reached",
        "spring-damper": "the orbit is next to a release without speed, where its equations are "
        "not smooth",
    }
    assert str(first) == expected[name]
    assert found.sizes["point"] < 150
    place = np.arcsinh(np.stack([found.amplitude, found.restitution]))
    near = [np.hypot(*(place.T - place[:, end]).T) < 1e-3 for end in (0, -1)]
    assert all(each.sum() < 25 for each in near)
    # The closed form of the restitution model.
    if name == "rigid":
        r = found.restitution
        assert np.abs(found.amplitude - np.pi * (1 - r) / (1 + r)).max() < 1e-12
