"""Answers of beyond's subcommands: the numbers of the calls, and one line for each mistake."""

import math

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

import bouncing_ball_beyond
from bouncing_ball_beyond import corrected, rigid, spring_damper
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley, tsuji_damping
from bouncing_ball_beyond.models.named_laws import LAWS
from bouncing_ball_beyond.periodic.one_impact import n_t

ORBIT = ("law-orbit", "--n", "1", "--restitution", "0.85", "--amplitude", "1.0")
HERTZ = ("--law", "hunt-crossley", "--set", "stiffness=1000", "--set", "damping=0.08")
FREE = ("--law", "tsuji", "--restitution", "0.65", "--duration", "0.1")
RIGID = rigid(restitution=0.85)
AT_FORCE = spring_damper(restitution=0.85, frequency_ratio=10.0, release="force")
FIELDS = [*OBSERVABLES[1:], *OF_ORBIT]


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
    orbit = bouncing_ball_beyond.orbit(ball, amplitude=1.0, side=side)
    for name in OBSERVABLES[1:]:
        assert answer[name] == getattr(orbit, name)
    stable_exactly_on_its_side(answer, orbit.multipliers().tolist(), side)


def test_the_loss_has_three_names_of_one_meaning(ask):
    the_loss_has_three_names(ask, "law-orbit", float(damping_ratio(0.85)))


def test_every_orbit_can_be_reached(ask, refused, said):
    every_orbit_is_reached(ask, refused, said, "law-orbit", FIELDS)


def test_limits_are_those_of_the_call(ask, refused):
    contact = spring_damper(restitution=0.85, frequency_ratio=10.0)
    for options, ball in (((), RIGID), (FORCE[:2], contact)):
        answer = ask("law-limits", "--n", "2", "--restitution", "0.85", *options)
        expected = bouncing_ball_beyond.limits(ball, 2)
        for name, orbit in expected._asdict().items():
            assert answer[name] == {
                "amplitude": orbit.amplitude,
                "phase": orbit.phase,
                "contact_duration": orbit.contact_duration,
                "is_admissible": orbit.is_admissible(),
            }
    no_saddle_node_is_found(refused, "law-limits")


def test_the_error_law_is_about_the_contacts_own_r(ask):
    contact = ("--damping-ratio", "0.2", "--release", "force", "--amplitude", "1.5")
    found = ask("error-law", *contact)
    exact = ask("law-orbit", "--frequency-ratio", "1e4", *contact)
    r = repr(found["measured_restitution"])
    plain = ask("law-orbit", "--restitution", r, "--amplitude", "1.5")
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
    a_ball_stays_on_a_stable_orbit(ask, said, "law-orbit", "law-simulate")


def test_an_orbit_on_a_contact_law_is_that_of_its_model(ask):
    answer = ask("law-orbit", *HERTZ, "--amplitude", "1")
    assert set(FIELDS) <= set(answer)
    orbit = n_t.orbit(ContactModel(HuntCrossley(1000.0, 0.08)), 1, 1.0)
    assert answer["max_height"] == float(orbit.max_height)
    assert answer["parameters"] == {"stiffness": 1000.0, "damping": 0.08}
    assert answer["frequency_ratio"] == pytest.approx(math.pi / answer["free_duration"])
    corrected = ask("law-orbit", *HERTZ, "--amplitude", "1", "--model", "corrected")
    assert corrected["max_height"] == pytest.approx(answer["max_height"], rel=1e-3)


def test_a_law_by_its_free_impact_has_it_at_the_speed_in_question(ask):
    answer = ask("law-orbit", *FREE, "--amplitude", "1")
    assert answer["measured_restitution"] == pytest.approx(0.65, rel=1e-12)
    assert answer["free_duration"] == pytest.approx(0.1, rel=1e-12)
    assert answer["parameters"]["damping"] == pytest.approx(float(tsuji_damping(0.65)), rel=1e-12)
    limits = ask("law-limits", *FREE)
    assert limits["at_impact_speed"] == pytest.approx(2 * math.pi / 1.65, rel=1e-12)
    assert limits["free_duration"] == pytest.approx(0.1, rel=1e-12)
    # The first impact, of a speed Λ cos φ - z′.
    start = ("law-simulate", "--amplitude", "1", "--velocity", "-2", "--impacts", "3")
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
    status, line = refused("law-orbit", *call)
    assert status == 2
    assert line.endswith("rubber is given by its parameters, not by restitution and duration")


def test_a_missing_orbit_exits_1_with_the_reason(refused, outcome):
    a_missing_orbit_has_its_reason(refused, outcome, "law-orbit")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("", "a command is missing, one of orbit, limits"),
        (
            "law-orbit --amplitude 1",
            "--restitution --damping-ratio --measured-restitution is required",
        ),
        ("law-orbit --restitution 0.85", "required: --amplitude"),
        ("law-orbit --damping-ratio 0.1 --amplitude 1", "--damping-ratio needs --frequency-ratio"),
        ("@ --damping-ratio 0.1", "--damping-ratio: not allowed with argument --restitution"),
        ("@ --model spring-damper", "--model spring-damper needs --frequency-ratio"),
        ("@ --model restitution --frequency-ratio 3", "--frequency-ratio has no meaning"),
        ("@ --release force", "--release has no meaning for --model restitution"),
        ("@ --side all --index 2", "not allowed with argument --side"),
        (
            "@ --tension 1",
            "unrecognized arguments: --tension 1: see bouncing-ball law-orbit --help",
        ),
        ("@ --frequency 50", "arguments: --frequency 50; did you mean --frequency-ratio?"),
        ("@ 2", "unrecognized arguments: 2: --amplitude takes one value"),
        ("@ --release Force", "'displacement', 'force', 'approach'); did you mean force?"),
        (
            "law-orbit --amplitude 1g",
            "'1g' is not a number in [1e-12, 1e+08]: give it without a unit",
        ),
        ("law-orbit --amplitude 1 --restitution 85", "not a number in [0, 1]: did you mean 0.85?"),
        ("law-orbit --amplitude 1 --restitution 85%", "not a number in [0, 1]: did you mean 0.85?"),
        ("@ --n 2.0", "'2.0' is not a whole number from 1 to 1000: did you mean 2?"),
        ("contact --measured-restitution 0.1 --release force", "r = 0.1 is not in (e⁻², 1]"),
        (
            "law-simulate --restitution 0.5 --amplitude 1 --velocity 9",
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
    start = {"@": ORBIT, "law": ("law-orbit", "--amplitude", "1", "--law")}
    start["contact"] = ("law-orbit", "--amplitude", "9", "--frequency-ratio", "10")
    start["free"] = ("law-orbit", "--amplitude", "1", *FREE)
    begin = start.get(words[0], words[:1]) if words else ()
    command = (*begin, *words[1:])
    status, line = refused(*command)
    assert status == 2
    assert said in line


@given(**RARE)
def test_no_traceback_and_no_warning_ever(outcome, **rare):
    an_answer_or_a_line(outcome, "law-orbit", **rare)
