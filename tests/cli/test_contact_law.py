"""The command line's contact laws: answers, parameters, and one line for each mistake."""

import math

import pytest

from bouncing_ball.cli.main import main
from bouncing_ball.contacts.laws import LAWS
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.tsuji import tsuji_damping
from bouncing_ball.orbits.law_model import LawModel

HERTZ = ("--law", "hunt-crossley", "--set", "stiffness=1000", "--set", "damping=0.08")
FREE = ("--law", "tsuji", "--restitution", "0.65", "--duration", "0.1")


def test_the_help_names_every_law_and_its_parameters(capsys):
    with pytest.raises(SystemExit):
        main(["orbit", "--help"])
    shown = " ".join(capsys.readouterr().out.split()).replace("- ", "-")
    for law in LAWS.values():
        parameters = ", ".join(law.parameter_names()).replace("_", "-")
        assert f"{law.name} {law.formula} ({parameters})" in shown


def test_an_orbit_has_the_keys_of_the_other_models(ask):
    answer = ask("orbit", *HERTZ, "--amplitude", "1")
    other = ask("orbit", "--restitution", "0.85", "--amplitude", "1",
                "--frequency-ratio", "20")  # fmt: skip
    assert set(other) - {"damping_ratio"} <= set(answer)
    orbit = LawModel(HuntCrossley(1000.0, 0.08)).orbit(1, 1.0)
    assert answer["max_height"] == float(orbit.max_height)
    assert answer["is_stable"] and answer["is_admissible"]
    assert answer["parameters"] == {"stiffness": 1000.0, "damping": 0.08}
    assert answer["frequency_ratio"] == pytest.approx(math.pi / answer["free_duration"])
    corrected = ask("orbit", *HERTZ, "--amplitude", "1", "--model", "corrected")
    assert corrected["max_height"] == pytest.approx(answer["max_height"], rel=1e-3)


def test_a_law_by_its_free_impact_at_the_orbits_own_speed(ask):
    answer = ask("orbit", *FREE, "--amplitude", "1")
    assert answer["measured_restitution"] == pytest.approx(0.65, rel=1e-12)
    assert answer["free_duration"] == pytest.approx(0.1, rel=1e-12)
    assert answer["parameters"]["damping"] == pytest.approx(float(tsuji_damping(0.65)), rel=1e-12)
    # Its own parameters give the same orbit.
    given = [f"{name}={value!r}" for name, value in answer["parameters"].items()]
    again = ask("orbit", "--law", "tsuji", "--set", given[0], "--set", given[1],
                "--amplitude", "1")  # fmt: skip
    assert again["max_height"] == pytest.approx(answer["max_height"], rel=1e-13)
    limits = ask("limits", *FREE)
    assert limits["at_impact_speed"] == pytest.approx(2 * math.pi / 1.65, rel=1e-12)
    assert limits["saddle_node"]["amplitude"] < limits["period_doubling"]["amplitude"]
    run = ask("simulate", *FREE, "--amplitude", "1", "--impacts", "3", "--speed", "4")
    assert run["status"] == "bouncing" and len(run["sequence"]["time"]) == 3


def test_what_was_not_found_is_not_said_not_to_exist(refused):
    # The branch of so compliant a contact has no saddle-node; a closed form knows that.
    soft = ("--law", "linear", "--set", "frequency-ratio=0.7071", "--set", "damping-ratio=0.2155")
    status, line = refused("limits", *soft)
    assert status == 1 and "no saddle node was found on the branch of 1-T orbits" in line
    status, line = refused("limits", "--frequency-ratio", "0.7071", "--damping-ratio", "0.2155")
    assert status == 1 and "the branch of 1-T orbits" in line and "has no saddle node" in line


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((*FREE[:4],), "needs --set stiffness=NUMBER, --set damping=NUMBER, or --restitution and"),
        (("--law", "rubber"), "unknown contact law 'rubber': one of hunt-crossley, tsuji"),
        (("--law", "tsuji", "--set", "stiffness"), "'stiffness' is not NAME=NUMBER"),
        (("--law", "tsuji", "--set", "stiffness=inf"), "is not NAME=NUMBER"),
        (("--law", "tsuji", "--set", "stiffness=1"), "tsuji needs --set damping=NUMBER as well"),
        ((*HERTZ, "--set", "color=1"), "unknown parameter 'color' of hunt-crossley: its param"),
        ((*HERTZ, "--restitution", "0.5"), "--restitution does not go with --set"),
        ((*HERTZ, "--frequency-ratio", "5"), "--frequency-ratio does not go with --law"),
        ((*HERTZ, "--model", "spring-damper"), "--model spring-damper has no --law"),
        ((*HERTZ, "--release", "force"), "the release is part of hunt-crossley"),
        ((*FREE, "--release", "force"), "--release goes with --law linear and --set only"),
        ((*FREE, "--duration", "1e-300"), "a tsuji contact of duration D = 1e-300"),
        ((*FREE, "--speed", "1e300"), "v = 1e+300 has no stiffness within the range"),
        (("--restitution", "0.5", "--duration", "1"), "--duration needs --law"),
        ((*FREE[:2], "--set", "stiffness=9", "--set", "damping=2.3"), "C = 2.3 is not below √5"),
        ((*FREE[:2], "--set", "stiffness=0", "--set", "damping=1"), "stiffness K = 0.0 is not"),
        ((*HERTZ[:3], "stiffness=1000", "--set", "damping=1e3"), "or damped too strongly?"),
        ((*HERTZ[:3], "stiffness=1e300", "--set", "damping=0"), "does not stop the ball"),
    ],
)
def test_a_mistake_exits_2_with_one_line(refused, arguments, said):
    status, line = refused("orbit", *arguments, "--amplitude", "1")
    assert status == 2 and said in line


def test_no_orbit_exits_1_with_the_reason(refused):
    status, line = refused("orbit", *HERTZ, "--amplitude", "0.1")
    assert status == 1 and "below the saddle-node at Λ = 0.25" in line
