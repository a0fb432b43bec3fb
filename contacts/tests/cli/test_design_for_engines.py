"""``bouncing-ball design --engine`` and ``--from``."""

import json
import math
import re

import pytest
from asked_contacts import answered

from bouncing_ball_contacts.contact.rows import document
from bouncing_ball_contacts.engines.choice import ENGINES

pytestmark = pytest.mark.usefixtures("short_runs")

BALL = ("design", "--mass", "0.5")
STIFF = (*BALL, "--stiffness", "100 kN/m", "--restitution", "0.75")
TABLE = ("--frequency", "20 Hz", "--acceleration", "0.8 g", "--n", "1")
SHAKEN = (*STIFF, *TABLE)
FROM = ("design", "--from", "mujoco", "--solref", "-284244 -68.8", "--solimp", "0.9 0.95 0.001")
CROSSLEY = (*BALL, "--law", "hunt-crossley", "--contact-time", "2 ms", "--restitution", "0.8")
OTHER = ("--from", "lammps", "--set", "kn=1e5")


@pytest.mark.parametrize("command", [STIFF, SHAKEN])
def test_the_settings_are_in_the_answer(ask, command):
    found = ask(*command, "--engine", "mujoco")
    engine = found["engine"]
    assert engine["name"] == "mujoco" and engine["release"] == "force"
    assert engine["restitution"] == pytest.approx(0.75)
    assert found["measured_restitution"] == pytest.approx(0.75)
    stiffness, damping = engine["parameters"]["solref"]
    assert stiffness == pytest.approx(-2e5) and len(engine["parameters"]["solimp"]) == 3
    zeta = -damping / (2 * math.sqrt(-stiffness))
    assert found["damping_ratio"] == pytest.approx(zeta)
    assert engine["time_step"] == pytest.approx(found["contact_time"] / engine["steps"])
    assert (engine["max_height"] is None) is (command == STIFF)


def test_json_is_the_answer_of_the_call(ask):
    given = {"mass": 0.5, "stiffness": 1e5, "restitution": 0.75, "n": 1}
    of_call = answered(**given, frequency=20, acceleration="0.8 g", engine="lammps")
    expected = document(of_call.found) | {"engine": document(of_call.engine)}
    answer = ask(*SHAKEN, "--engine", "lammps")
    assert answer.pop("question")["engine"] == "lammps"
    assert answer == json.loads(json.dumps(expected))


@pytest.mark.parametrize("name", ENGINES)
def test_the_snippet_is_what_the_text_shows(said, ask, name):
    arguments = (*STIFF, "--engine", name, "--restitution-error", "2 %")
    snippet = ask(*arguments)["engine"]["snippet"].splitlines()
    text = [line.strip() for line in said(*arguments).splitlines()]
    first = text.index(snippet[0])
    assert text[first : first + len(snippet)] == [line.strip() for line in snippet]


def test_the_text_with_a_table_has_what_to_expect(said):
    text = said(*SHAKEN, "--engine", "mujoco")
    words = ("orbit, greatest height", "orbit, duration of contact", "orbit, penetration")
    assert all(word in text for word in ("<option timestep", "time step", *words))


def test_what_a_solref_means_needs_no_table(ask, said):
    found = ask(*FROM, "--mass", "500 g")
    assert found["stiffness"] == pytest.approx(142122) and "engine" not in found
    assert found["damping"] == pytest.approx(34.4)
    assert found["natural_frequency"] == pytest.approx(math.sqrt(284244))
    assert found["damping_ratio"] == pytest.approx(0.0645, abs=5e-5)
    assert found["measured_restitution"] == pytest.approx(0.8231, abs=1e-4)
    # The default impedance is told what it costs.
    text = said(*FROM, "--mass", "500 g")
    assert "0.95 a contact feels 0.05 of the load" in text
    # The load σ belongs to the corrected model.
    assert "σ" not in text
    assert "at the surface the spring is 0.9 and the damper 0.95" in text
    solref = ("--from", "mujoco", "--solref", "0.02 0.3", "--solimp", "1e-4 1e-4")
    command = (*BALL, *solref)
    positive = ask(*command)
    assert positive["damping_ratio"] == pytest.approx(0.3) and positive["notes"] == []
    # MuJoCo's default: 20 ms and critical damping.
    default = ask(*BALL, "--from", "mujoco", "--solref", "0.02 1")
    assert default["damping_ratio"] == pytest.approx(1)
    assert default["measured_restitution"] == pytest.approx(math.exp(-2))
    assert "0.95 a contact feels 0.05 of the load" in default["notes"][0]
    assert "0.1353 where it is much deeper" in default["notes"][2]


def test_with_a_table_it_is_a_design(ask):
    command = (*FROM, "--mass", "0.5", *TABLE)
    found = ask(*command)
    omega = math.sqrt(284244) / (40 * math.pi)
    assert found["frequency_ratio"] == pytest.approx(omega)
    assert found["measured_restitution"] == pytest.approx(0.8231, abs=1e-4)
    assert "feels 0.05 of the load" in found["notes"][0]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (FROM, "the mass is missing: the parameters of mujoco do not contain it"),
        (("design", *OTHER), "the mass is missing"),
        ((*BALL, *OTHER, "--set", "kn=2"), "argument --set: kn is given twice"),
        ((*STIFF[:1], *STIFF[3:], "--engine", "mujoco"), "mass is missing"),
        (
            (*BALL, "--from", "mujoco", "--solref", "0.02 1", "--engine", "lammps"),
            "is too large: near the critical",
        ),
        (
            (*BALL, "--from", "mujoco", "--solref", "0.02 1", *TABLE),
            "ζ = 1.0 is not below 1: on a",
        ),
        ((*FROM, "--mass", "1", "--solimp", "a b"), "solimp = 'a b' is not 0 to 5 numbers"),
        ((*FROM, "--mass", "1", "--law", "tsuji"), "--law is not allowed with --from"),
        ((*CROSSLEY, "--engine", "drake"), "--law needs a table, such as --freq"),
        ((*BALL, "--set", "kn=1"), "--set kn needs --from"),
        ((*FROM, "--stiffness", "1"), "--stiffness is not allowed with --from"),
        ((*STIFF, "--engine", "mujoco", "--plot", "a.png"), "--plot needs a table"),
    ],
)
def test_mistakes_are_one_line(refused, arguments, says):
    status, line = refused(*arguments)
    assert status == 2 and says in line


def test_parameters_at_a_step_say_what_suits_it(said, ask):
    given = ("design", "--from", "pybullet", "--mass", "1", "--set", "contactStiffness=1e5",
             "--set", "contactDamping=100")  # fmt: skip
    text = said(*given, "--time-step", "1 ms")
    (suited,) = re.findall(r"What suits this step: (.*)\.", text)
    found = ask("design", *suited.split())["engine"]
    drop = ask(*given, "--time-step", "1 ms")["dropped_at_step"]
    assert found["drop"]["error"] < drop["error"]
    assert f"lies {9.80665e3 / 5e4:.4g} mm deep at rest" in text.replace("196.1 µm", "0.1961 mm")


def test_a_range_has_one_unit_where_both_ends_have_it(said):
    elastic = said("design", "--engine=mujoco", "--mass=1", "--restitution=1", "--time-step=2 ms")
    assert "Dropped from 1 m it rises 1 m; 1 m is r = 1." in elastic
    text = said("design", "--engine=mujoco", "--mass=1", "--restitution=0.7", "--time-step=5 ms",
                "--speed=0.1 m/s")  # fmt: skip
    assert "; a shorter step allows a stiffer contact." in text
