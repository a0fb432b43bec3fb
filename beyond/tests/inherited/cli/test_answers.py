"""Answers of the subcommands: the numbers of the models, in full precision."""

import pytest
from answer_checks import (
    FORCE,
    OF_ORBIT,
    RARE,
    a_ball_stays_on_a_stable_orbit,
    a_missing_orbit_has_its_reason,
    an_answer_or_a_line,
    every_orbit_is_reached,
    no_saddle_node_is_found,
    stable_exactly_on_its_side,
    the_loss_has_three_names,
)
from hypothesis import given

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited import rigid, spring_damper
from bouncing_ball_beyond.inherited.models.damping import damping_ratio
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, multipliers

ORBIT = ("orbit", "--n", "1", "--restitution", "0.85", "--amplitude", "1.0")
RIGID = rigid(restitution=0.85)
CONTACT = spring_damper(restitution=0.85, frequency_ratio=10.0)
AT_FORCE = spring_damper(restitution=0.85, frequency_ratio=10.0, release="force")
FIELDS = [*OBSERVABLES[1:], *OF_ORBIT]


@pytest.mark.parametrize("side", ["stable", "unstable"])
@pytest.mark.parametrize(
    ("options", "ball"), [((), RIGID), (FORCE[:2], CONTACT), (FORCE, AT_FORCE)]
)
def test_an_orbit_is_that_of_the_call_in_full_precision(ask, side, options, ball):
    answer = ask(*ORBIT, *options, "--side", side)
    of_contact = ["measured_restitution", "damping_ratio"] if options else []
    assert list(answer) == FIELDS + of_contact
    orbit = bouncing_ball_beyond.inherited.orbit(ball, amplitude=1.0, side=side)
    for name in OBSERVABLES[1:]:
        assert answer[name] == getattr(orbit, name)
    stable_exactly_on_its_side(answer, multipliers(orbit).tolist(), side)


def test_the_loss_has_three_names_of_one_meaning(ask):
    the_loss_has_three_names(ask, "orbit", float(damping_ratio(0.85)))


def test_every_orbit_can_be_reached(ask, refused, said):
    every_orbit_is_reached(ask, refused, said, "orbit", FIELDS)


def test_limits_are_those_of_the_call(ask, refused):
    for options, ball in (((), RIGID), (FORCE[:2], CONTACT)):
        answer = ask("limits", "--n", "2", "--restitution", "0.85", *options)
        for name, orbit in bouncing_ball_beyond.inherited.limits(ball, 2)._asdict().items():
            assert answer[name] == {
                "amplitude": orbit.amplitude,
                "phase": orbit.phase,
                "contact_duration": orbit.contact_duration,
                "is_admissible": bool(orbit.admissible),
            }
    no_saddle_node_is_found(refused, "limits")


def test_the_special_orbits_of_a_branch_are_those_of_the_call(ask, refused):
    call = ("branch", "--restitution", "0.85", *FORCE)
    answer = ask(*call, "--amplitude-max", "1.2")
    found = bouncing_ball_beyond.inherited.branch(AT_FORCE, amplitude_max=1.2)
    assert [each["kind"] for each in answer["orbits"]] == found.special_kind.values.tolist()
    amplitudes = [each["amplitude"] for each in answer["orbits"]]
    assert amplitudes == found.special_amplitude.values.tolist()
    assert answer["stable_side"] == "amplitude = 1.2 is reached"
    status, line = refused(*call, "--amplitude-max", "0.1")
    assert status == 1 and "the branch begins at Λ = " in line


def test_the_threshold_of_permanent_contact_is_that_of_the_model(ask):
    call = ("permanent-contact", "--restitution", "0.65", "--frequency-ratio", "6")
    for release in ("displacement", "force"):
        answer = ask(*call, "--release", release)
        ball = spring_damper(restitution=0.65, frequency_ratio=6.0, release=release)
        assert answer["threshold_amplitude"] == bouncing_ball_beyond.inherited.permanent_contact(
            ball
        )


def test_the_thresholds_of_the_errors_are_those_of_the_call(ask):
    answer = ask("thresholds", "--restitution", "0.65", "--amplitude", "1", "--tolerance", "0.02")
    found = bouncing_ball_beyond.inherited.error_thresholds(
        rigid(restitution=0.65), amplitude=1.0, tolerance=0.02
    )
    for name in found.quantity.values.tolist():
        one = found.sel(quantity=name)
        is_found = one.threshold_status.item() == "found"
        expected = one.error_threshold if is_found else one.threshold_status
        assert answer[name] == expected.item()
    assert isinstance(answer["max_height"], float)


def test_a_ball_that_starts_on_a_stable_orbit_stays_on_it(ask, said):
    a_ball_stays_on_a_stable_orbit(ask, said, "orbit", "simulate")


def test_a_phase_beyond_a_turn_is_noted(ask):
    call = ("simulate", "--restitution", "0.5", "--amplitude", "0.5", "--impacts", "10")
    note = "phase 400 is in radians, 63.66 turns of the table; 400 degrees are 6.981"
    assert ask(*call, "--phase", "400")["note"] == note
    assert "note" not in ask(*call, "--phase", "6.28")


def test_a_missing_orbit_exits_1_with_the_reason(refused, outcome):
    a_missing_orbit_has_its_reason(refused, outcome, "orbit")


@given(**RARE)
def test_no_traceback_and_no_warning_ever(outcome, **rare):
    an_answer_or_a_line(outcome, "orbit", **rare)
