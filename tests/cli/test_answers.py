"""Answers of the subcommands: the numbers of the models, in full precision."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bouncing_ball
from bouncing_ball import rigid, spring_damper
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.periodic.orbit import OBSERVABLES, multipliers

ORBIT = ("orbit", "--n", "1", "--restitution", "0.85", "--amplitude", "1.0")
FORCE = ("--frequency-ratio", "10", "--release", "force")
COMPLIANT = ("--restitution", "0.85", "--amplitude", "0.9", "--frequency-ratio", "2")
RIGID = rigid(restitution=0.85)
CONTACT = spring_damper(restitution=0.85, frequency_ratio=10.0)
AT_FORCE = spring_damper(restitution=0.85, frequency_ratio=10.0, release="force")
FIELDS = [*OBSERVABLES[1:], "multipliers", "is_stable", "is_admissible", "residual"]


@pytest.mark.parametrize("side", ["stable", "unstable"])
@pytest.mark.parametrize(
    ("options", "ball"), [((), RIGID), (FORCE[:2], CONTACT), (FORCE, AT_FORCE)]
)
def test_an_orbit_is_that_of_the_call_in_full_precision(ask, side, options, ball):
    answer = ask(*ORBIT, *options, "--side", side)
    of_contact = ["measured_restitution", "damping_ratio"] if options else []
    assert list(answer) == FIELDS + of_contact
    orbit = bouncing_ball.orbit(ball, amplitude=1.0, side=side)
    for name in OBSERVABLES[1:]:
        assert answer[name] == getattr(orbit, name)
    pairs = [complex(*pair) for pair in answer["multipliers"]]
    assert pairs == multipliers(orbit).tolist()
    assert answer["is_stable"] is (side == "stable") is bool(np.all(np.abs(pairs) < 1))
    # The formulas solve the equations of both models to some roundings.
    assert answer["is_admissible"] is True and answer["residual"] < 1e-13


def test_the_loss_has_three_names_of_one_meaning(ask):
    zeta = repr(float(damping_ratio(0.85)))
    call = ("orbit", "--amplitude", "1", *FORCE)
    by_eq_16 = ask(*call, "--restitution", "0.85")
    assert ask(*call, "--damping-ratio", zeta) == by_eq_16
    # The force release has a higher r than that of Eq. 16.
    assert by_eq_16["measured_restitution"] > 0.85
    own = ask(*call, "--measured-restitution", "0.85")
    assert own["measured_restitution"] == pytest.approx(0.85, rel=1e-14)
    assert own["damping_ratio"] > by_eq_16["damping_ratio"]
    # Without a contact there is one r only.
    bare = ("orbit", "--amplitude", "1")
    assert ask(*bare, "--measured-restitution", "0.7") == ask(*bare, "--restitution", "0.7")


def test_every_orbit_can_be_reached(ask, refused, said):
    call = ("orbit", *COMPLIANT)
    found = ask(*call, "--side", "all")["orbits"]
    assert [orbit["is_stable"] for orbit in found] == [True, False, True]
    third = ask(*call, "--index", "3")
    assert {name: third[name] for name in FIELDS} == found[2]
    status, line = refused(*call, "--index", "4")
    assert status == 1 and "has 3 1-T orbits at Λ = 0.9" in line
    assert "orbit 3" in said(*call, "--side", "all")


def test_limits_are_those_of_the_call(ask, refused):
    for options, ball in (((), RIGID), (FORCE[:2], CONTACT)):
        answer = ask("limits", "--n", "2", "--restitution", "0.85", *options)
        for name, orbit in bouncing_ball.limits(ball, 2)._asdict().items():
            assert answer[name] == {
                "amplitude": orbit.amplitude,
                "phase": orbit.phase,
                "contact_duration": orbit.contact_duration,
                "is_admissible": bool(orbit.admissible),
            }
    status, line = refused("limits", "--frequency-ratio", "0.7071", "--damping-ratio", "0.2155")
    assert status == 1 and "no saddle-node was found on the branch of 1-T orbits" in line


def test_the_special_orbits_of_a_branch_are_those_of_the_call(ask, refused):
    call = ("branch", "--restitution", "0.85", *FORCE)
    answer = ask(*call, "--amplitude-max", "1.2")
    found = bouncing_ball.branch(AT_FORCE, amplitude_max=1.2)
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
        assert answer["threshold_amplitude"] == bouncing_ball.permanent_contact(ball)


def test_the_thresholds_of_the_errors_are_those_of_the_call(ask):
    answer = ask("thresholds", "--restitution", "0.65", "--amplitude", "1", "--tolerance", "0.02")
    found = bouncing_ball.error_thresholds(rigid(restitution=0.65), amplitude=1.0, tolerance=0.02)
    for name in found.quantity.values.tolist():
        one = found.sel(quantity=name)
        is_found = one.threshold_status.item() == "found"
        expected = one.error_threshold if is_found else one.threshold_status
        assert answer[name] == expected.item()
    assert isinstance(answer["max_height"], float)


def test_a_ball_that_starts_on_a_stable_orbit_stays_on_it(ask, said):
    contact = (*ORBIT[3:], *FORCE[:2])
    orbit = ask("orbit", *contact)
    start = ("--phase", repr(orbit["phase"]), "--velocity", repr(orbit["impact_velocity"]))
    answer = ask("simulate", *contact, *start, "--impacts", "30")
    assert answer["status"] == "bouncing" and len(answer["sequence"]["time"]) == 30
    # Rounding stays rounding on a stable orbit.
    assert np.ptp(answer["sequence"]["impact_velocity"]) < 1e-12
    call = ("simulate", "--restitution", "0.5", "--amplitude", "0.5", *FORCE[:2])
    answer = ask(*call, "--velocity", "-1")
    assert answer["status"] == "permanent contact"
    assert answer["sequence"]["contact_duration"][-1] is None
    assert said(*call, "--velocity", "-1").splitlines()[-1].split().count("never") == 2


def test_a_phase_beyond_a_turn_is_noted(ask):
    call = ("simulate", "--restitution", "0.5", "--amplitude", "0.5", "--impacts", "10")
    note = "phase 400 is in radians, 63.66 turns of the table; 400 degrees are 6.981"
    assert ask(*call, "--phase", "400")["note"] == note
    assert "note" not in ask(*call, "--phase", "6.28")


def test_a_missing_orbit_exits_1_with_the_reason(refused, outcome):
    call = ("orbit", "--restitution", "0.85", "--amplitude", "0.1")
    line = "no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node at Λ = 0.254724"
    assert refused(*call) == (1, f"bouncing-ball: {line}")
    status, out, _ = outcome(*call, "--json")
    assert status == 1 and "below the saddle-node" in json.loads(out)["error"]


@given(
    ratio=st.sampled_from([None, 1e-8, 0.7, 1.0, 3.0, 1e8]),
    release=st.sampled_from(["displacement", "force"]),
    r=st.sampled_from([1.0, 0.5, 1e-300]),
    amplitude=st.sampled_from([1e8, 1.0, 1e-300]) | st.floats(1e-300, 1e8),
    n=st.sampled_from([1, 1000]),
    side=st.sampled_from(["stable", "unstable"]),
)
def test_no_traceback_and_no_warning_ever(outcome, ratio, release, r, amplitude, n, side):
    # Warnings are errors in this suite.
    command = ["orbit", "--restitution", str(r), "--amplitude", str(amplitude), "--n", str(n)]
    command += ["--side", side, "--json"]
    if ratio is not None:
        command += ["--frequency-ratio", str(ratio), "--release", release]
    status, out, err = outcome(*command)
    if amplitude < 1e-12:
        assert status == 2 and len(err.splitlines()) == 1
        return
    assert status in (0, 1) and len(err.splitlines()) == status
    assert ("error" in json.loads(out)) is (status == 1)
