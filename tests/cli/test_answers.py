"""Answers of the subcommands: the numbers of the models, and one line for each mistake."""

import json
import math

import numpy as np
import pytest
from bouncing_ball.contacts.named_laws import LAWS
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.hertzian import HuntCrossley, tsuji_damping
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.periodic.periodic.orbit import OBSERVABLES
from hypothesis import given
from hypothesis import strategies as st

import bouncing_ball
from bouncing_ball import corrected, rigid, spring_damper
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper

ORBIT = ("orbit", "--n", "1", "--restitution", "0.85", "--amplitude", "1.0")
FORCE = ("--frequency-ratio", "10", "--release", "force")
COMPLIANT = ("--restitution", "0.85", "--amplitude", "0.9", "--frequency-ratio", "2")
HERTZ = ("--law", "hunt-crossley", "--set", "stiffness=1000", "--set", "damping=0.08")
FREE = ("--law", "tsuji", "--restitution", "0.65", "--duration", "0.1")
RIGID = rigid(restitution=0.85)
AT_FORCE = spring_damper(restitution=0.85, frequency_ratio=10.0, release="force")
FIELDS = [*OBSERVABLES[1:], "multipliers", "is_stable", "is_admissible", "residual"]


@pytest.mark.parametrize("side", ["stable", "unstable"])
@pytest.mark.parametrize(
    ("options", "ball"),
    [
        ((), RIGID),
        (FORCE[:2], spring_damper(restitution=0.85, frequency_ratio=10.0)),
        ((*FORCE, "--model", "corrected"), corrected(AT_FORCE)),
    ],
)
def test_an_orbit_is_that_of_the_call_in_full_precision(ask, side, options, ball):
    command = (*ORBIT, *options, "--side", side)
    answer = ask(*command)
    of_contact = ["measured_restitution", "damping_ratio"] if options else []
    assert list(answer) == FIELDS + of_contact
    orbit = bouncing_ball.orbit(ball, amplitude=1.0, side=side)
    for name in OBSERVABLES[1:]:
        assert answer[name] == getattr(orbit, name)
    multipliers = orbit.multipliers()
    assert [complex(*pair) for pair in answer["multipliers"]] == multipliers.tolist()
    assert answer["is_stable"] is (side == "stable") is bool(np.all(np.abs(multipliers) < 1))
    # The formulas solve the models' equations to rounding.
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
    contact = spring_damper(restitution=0.85, frequency_ratio=10.0)
    for options, ball in (((), RIGID), (FORCE[:2], contact)):
        answer = ask("limits", "--n", "2", "--restitution", "0.85", *options)
        expected = bouncing_ball.limits(ball, 2)
        for name, orbit in expected._asdict().items():
            assert answer[name] == {
                "amplitude": orbit.amplitude,
                "phase": orbit.phase,
                "contact_duration": orbit.contact_duration,
                "is_admissible": orbit.is_admissible(),
            }
    status, line = refused("limits", "--frequency-ratio", "0.7071", "--damping-ratio", "0.2155")
    assert status == 1 and "no saddle-node was found on the branch of 1-T orbits" in line


def test_the_threshold_of_permanent_contact_is_that_of_the_model(ask):
    call = ("permanent-contact", "--restitution", "0.65", "--frequency-ratio")
    for release in ("displacement", "force"):
        answer = ask(*call, "6", "--release", release)
        contact = SpringDamper.from_restitution(0.65, 6.0, release)
        exact = ContactModel(contact).permanent_contact_threshold()
        assert answer["threshold_amplitude"] == exact


def test_the_error_law_is_about_the_contacts_own_r(ask):
    contact = ("--damping-ratio", "0.2", "--release", "force", "--amplitude", "1.5")
    found = ask("error-law", *contact)
    exact = ask("orbit", "--frequency-ratio", "1e4", *contact)
    r = repr(found["measured_restitution"])
    plain = ask("orbit", "--restitution", r, "--amplitude", "1.5")
    for name in ("max_height", "bounce_velocity", "phase", "apparent_restitution"):
        error = 1e4 * (exact[name] / plain[name] - 1)
        # The next order is about 1/ϖ of it, more for the apparent restitution.
        assert error == pytest.approx(found["signed"][name], rel=2e-2)
        assert found["coefficients"][name] == abs(found["signed"][name])
    # Nothing to be relative to at r = 1.
    found = ask("error-law", "--restitution", "1", "--amplitude", "0.8")
    assert found["coefficients"]["saddle_node"] is None
    assert found["second_order"]["permanent_contact"] == 1.0


def test_a_ball_that_starts_on_a_stable_orbit_stays_on_it(ask, said):
    contact = (*ORBIT[3:], *FORCE[:2])
    orbit = ask("orbit", *contact)
    start = ("--phase", repr(orbit["phase"]), "--velocity", repr(orbit["impact_velocity"]))
    answer = ask("simulate", *(contact + start), "--impacts", "30")
    assert answer["status"] == "bouncing" and len(answer["sequence"]["time"]) == 30
    # Rounding stays rounding on a stable orbit.
    assert np.ptp(answer["sequence"]["impact_velocity"]) < 1e-12
    call = ("simulate", "--restitution", "0.5", "--amplitude", "0.5", *FORCE[:2])
    answer = ask(*call, "--velocity", "-1")
    assert answer["status"] == "permanent contact"
    assert answer["sequence"]["contact_duration"][-1] is None
    assert said(*call, "--velocity", "-1").splitlines()[-1].split().count("never") == 2


def test_an_orbit_on_a_contact_law_is_that_of_its_model(ask):
    answer = ask("orbit", *HERTZ, "--amplitude", "1")
    assert set(FIELDS) <= set(answer)
    orbit = n_t.orbit(ContactModel(HuntCrossley(1000.0, 0.08)), 1, 1.0)
    assert answer["max_height"] == float(orbit.max_height)
    assert answer["parameters"] == {"stiffness": 1000.0, "damping": 0.08}
    assert answer["frequency_ratio"] == pytest.approx(math.pi / answer["free_duration"])
    corrected = ask("orbit", *HERTZ, "--amplitude", "1", "--model", "corrected")
    assert corrected["max_height"] == pytest.approx(answer["max_height"], rel=1e-3)


def test_a_law_by_its_free_impact_has_it_at_the_speed_in_question(ask):
    answer = ask("orbit", *FREE, "--amplitude", "1")
    assert answer["measured_restitution"] == pytest.approx(0.65, rel=1e-12)
    assert answer["free_duration"] == pytest.approx(0.1, rel=1e-12)
    assert answer["parameters"]["damping"] == pytest.approx(float(tsuji_damping(0.65)), rel=1e-12)
    limits = ask("limits", *FREE)
    assert limits["at_impact_speed"] == pytest.approx(2 * math.pi / 1.65, rel=1e-12)
    assert limits["free_duration"] == pytest.approx(0.1, rel=1e-12)
    # The first impact, of a speed Λ cos φ - z′.
    start = ("simulate", "--amplitude", "1", "--velocity", "-2", "--impacts", "3")
    command = (*start, *FREE)
    run = ask(*command)
    assert run["at_impact_speed"] == 3.0
    assert run["free_duration"] == pytest.approx(0.1, rel=1e-12)


class _OfItsParameters(HuntCrossley):
    """A law that does not define how it is scaled."""

    name = "rubber"
    of_scales = classmethod(ContactLaw.of_scales.__func__)


def test_a_law_that_is_not_scaled_is_given_by_its_parameters_only(refused, monkeypatch):
    monkeypatch.setitem(LAWS, "rubber", _OfItsParameters)
    call = ("--law", "rubber", "--restitution", "0.95", "--duration", "0.3", "--amplitude", "1")
    status, line = refused("orbit", *call)
    assert status == 2
    assert line.endswith("rubber is given by its parameters, not by restitution and duration")


def test_a_missing_orbit_exits_1_with_the_reason(refused, outcome):
    call = ("orbit", "--restitution", "0.85", "--amplitude", "0.1")
    assert refused(*call) == (
        1,
        "bouncing-ball: no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node "
        "at Λ = 0.254724",
    )
    status, out, _ = outcome(*call, "--json")
    assert status == 1 and "below the saddle-node" in json.loads(out)["error"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("", "a command is missing, one of orbit, limits"),
        ("orbit --amplitude 1", "--restitution --damping-ratio --measured-restitution is required"),
        ("orbit --restitution 0.85", "required: --amplitude"),
        ("permanent-contact --restitution 0.5", "required: --frequency-ratio"),
        ("orbit --damping-ratio 0.1 --amplitude 1", "--damping-ratio needs --frequency-ratio"),
        ("@ --damping-ratio 0.1", "--damping-ratio: not allowed with argument --restitution"),
        ("@ --model spring-damper", "--model spring-damper needs --frequency-ratio"),
        ("@ --model restitution --frequency-ratio 3", "--frequency-ratio has no meaning"),
        ("@ --release force", "--release has no meaning for --model restitution"),
        ("@ --side all --index 2", "not allowed with argument --side"),
        ("@ --tension 1", "unrecognized arguments: --tension 1: see bouncing-ball orbit --help"),
        ("@ --frequency 50", "arguments: --frequency 50; did you mean --frequency-ratio?"),
        ("@ 2", "unrecognized arguments: 2: --amplitude takes one value"),
        ("@ --release Force", "'displacement', 'force', 'approach'); did you mean force?"),
        ("orbit --amplitude 1g", "'1g' is not a number in [1e-12, 1e+08]: give it without a unit"),
        ("orbit --amplitude 1 --restitution 85", "not a number in (0, 1]: did you mean 0.85?"),
        ("orbit --amplitude 1 --restitution 85%", "not a number in (0, 1]: did you mean 0.85?"),
        ("@ --n 2.0", "'2.0' is not a whole number from 1 to 1000: did you mean 2?"),
        ("contact --measured-restitution 0.1 --release force", "r = 0.1 is not in (e⁻², 1]"),
        (
            "simulate --restitution 0.5 --amplitude 1 --velocity 9",
            "rises from the table has no impact: its velocity z′ = 9 is above that of the table, "
            "w′ = 1",
        ),
        ("law tsuji --restitution 0.65", "needs --set stiffness=NUMBER, --set damping=NUMBER, or"),
        (
            "law rubber",
            "unknown contact law 'rubber': one of hunt-crossley, hunt-crossley-linear, tsuji",
        ),
        ("law tsuji --set stiffness=inf", "is not NAME=NUMBER"),
        ("law tsuji --set stiffness=1", "tsuji also needs --set damping=NUMBER"),
        ("law tsuji --set {n}=1", "unknown parameter '{n}' of tsuji"),
        ("law tsuji --set color=1 --restitution 0.5", "--restitution is not allowed with --set"),
        ("law tsuji --frequency-ratio 5", "--frequency-ratio is not allowed with --law"),
        ("law tsuji --model spring-damper", "--model spring-damper has no --law"),
        ("free --release force", "--release is allowed with --set of --law linear only"),
        ("@ --duration 1", "--duration needs --law"),
        (
            "law tsuji --set stiffness=9 --set damping=1 --release force",
            "--release is not allowed: tsuji",
        ),
        ("law tsuji --set stiffness=9 --set damping=2.3", "C = 2.3 is not below √5"),
    ],
)
def test_a_mistake_exits_2_with_one_line(refused, arguments, said):
    words = arguments.split()
    start = {"@": ORBIT, "law": ("orbit", "--amplitude", "1", "--law")}
    start["contact"] = ("orbit", "--amplitude", "9", "--frequency-ratio", "10")
    start["free"] = ("orbit", "--amplitude", "1", *FREE)
    begin = start.get(words[0], words[:1]) if words else ()
    command = (*begin, *words[1:])
    status, line = refused(*command)
    assert status == 2
    assert said in line


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
