"""The engines' parameters: there and back, in their units, and what comes out of them."""

import re

import hypothesis
import numpy as np
import pytest
from asked_contacts import answered
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_contacts import Contact, describe_contact
from bouncing_ball_contacts.engines.choice import ENGINES, engine_named, engine_of
from bouncing_ball_contacts.engines.engine import ERROR, Physical, twelve_digits
from bouncing_ball_contacts.engines.impacts import error_in_steps

CONTACT = Physical(mass=0.02, stiffness=3e5, damping=7.0)
BOTH = [(name, release) for name, engine in ENGINES.items() for release in engine.releases]


def per_mass(restitution, release=Release.DISPLACEMENT):
    """A contact with k/m = 10⁶."""
    zeta = float(damping_ratio(restitution, release))
    return Physical(1.0, 1e6, 2 * zeta * 1e3)


@pytest.mark.parametrize("name", ENGINES)
@given(mass=st.floats(1e-3, 1e3), stiffness=st.floats(1.0, 1e9), r=st.floats(0.2, 1.0))
@hypothesis.settings(max_examples=4)
def test_the_parameters_of_a_contact_are_read_back_as_this_contact(name, mass, stiffness, r):
    engine = ENGINES[name]
    # Damping on approach leaves e⁻¹, and some engines have no contact without damping.
    hypothesis.assume(r > 0.37 or engine.releases != (Release.APPROACH,))
    hypothesis.assume(r < 1 or name not in ("newton-mujoco", "genesis"))
    assert engine.name == name
    made, _, settings, *_ = answered(mass=mass, stiffness=stiffness, restitution=r, engine=name)
    parameters = dict(settings.parameters)
    if engine.scheme.is_compensated:
        read = Contact(mass=mass, from_engine=name, parameters=parameters)
        note = describe_contact(read).notes[0]
        assert note.startswith("k, c and r are those in the limit of small time steps")
        parameters["time_step"] = settings.time_step
    again = describe_contact(Contact(mass=mass, from_engine=name, parameters=parameters))
    # A step that alone damps as much as the contact is within the error that is allowed.
    rough = engine.scheme.is_compensated and parameters[engine.names[1]] == 0
    # Twelve digits are written; of r near 1 the distance to 1 is that of c.
    assert again.stiffness == pytest.approx(stiffness, rel=ERROR if rough else 2e-11)
    assert again.measured_restitution == pytest.approx(r, rel=2 * ERROR if rough else 1e-10)
    if not rough:
        assert again.damping == pytest.approx(made.damping, rel=2e-11)


@pytest.mark.parametrize(("name", "release"), BOTH)
def test_the_restitution_is_met_under_the_engines_release(name, release):
    found = ENGINES[name].settings(per_mass(0.75, release), release)
    assert found.restitution == pytest.approx(0.75, rel=1e-12)
    assert (found.name, found.release, found.error) == (name, release, ERROR)
    zeta = per_mass(0.75, release).damping_ratio
    assert error_in_steps(ENGINES[name].scheme, zeta, release, found.steps) <= ERROR
    half = np.arccos(zeta if release != "displacement" else 0.0) / np.sqrt(1 - zeta**2)
    # After a damped approach the spring alone takes a quarter of its period.
    time = (half + (np.pi / 2 if release == "approach" else half)) / 1e3
    assert found.time_step * found.steps == pytest.approx(time, rel=1e-12)


@pytest.mark.parametrize(("name", "release"), BOTH)
def test_the_snippet_has_the_numbers(name, release):
    found = ENGINES[name].settings(CONTACT, release)
    written = [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", found.snippet)]
    for value in np.concatenate([np.ravel(x) for x in found.parameters.values()]):
        assert twelve_digits(value) in written
    assert found.time_step in written and CONTACT.mass in written
    assert all(len(line) < 110 for line in found.snippet.splitlines())


def test_the_release_is_written_where_there_are_two():
    words = {"lammps": "limit_damping", "liggghts": "limitForce on", "generic": "max(0.0"}
    assert ENGINES["liggghts"].settings(CONTACT, "force").snippet.endswith("0.0 limitForce on")
    for name, word in words.items():
        for release in ENGINES[name].releases:
            assert (word in ENGINES[name].settings(CONTACT, release).snippet) is (
                release is Release.FORCE
            )


@pytest.mark.parametrize(
    ("name", "parameters", "mass", "says"),
    [
        ("mujoco", {"solref": "-100 -1"}, None, "the mass is missing"),
        ("mujoco", {"solref": "-100 -1"}, -1.0, "mass = -1.0 is not a positive number of kg"),
        ("mujoco", {}, 1.0, "solref is missing"),
        ("mujoco", {"solref": "-100"}, 1.0, "solref = '-100' is not 2 numbers"),
        ("mujoco", {"solref": "-100 x"}, 1.0, "solref = '-100 x' is not 2 numbers"),
        ("mujoco", {"solref": [0.0, float("nan")]}, 1.0, "solref = '0.0 nan' is not 2 numbers"),
        ("mujoco", {"solref": "-100 1"}, 1.0, "neither two negative numbers"),
        ("mujoco", {"solref": "0 0"}, 1.0, "nor two positive ones"),
        ("mujoco", {"solref": "-1 -1", "solimp": "1 2 3 4 5 6"}, 1.0, "is not 0 to 5 numbers"),
        ("mujoco", {"solref": "-1 -1", "solimp": "1.5"}, 1.0, "impedance 1.5, which is not in"),
        (
            "mujoco",
            {"solref": "-1 -1", "colour": 1},
            1.0,
            "'colour': its parameters are solref and so",
        ),
        ("mujoco", {"solref": 1.0}, 1.0, "solref = '1.0' is not 2 numbers"),
        ("mujoco", {"solref": None, "solimp": None}, 0.0, "mass = 0.0 is not a positive number"),
        ("lammps", {"kn": 1.0, "gamman": 1.0}, 1.0, "its parameters are kn and gamma_n"),
        ("lammps", {"kn": 1.0}, 1.0, "gamma_n is missing: the parameters of lammps are"),
        ("pybullet", {"damping": 1.0}, 1.0, "did you mean contactDamping?"),
        ("drake", {"dissipation": 1.0}, 1.0, "did you mean hunt_crossley_dissipation?"),
        ("drake", {"relaxaton_time": 1.0}, 1.0, "did you mean relaxation_time?"),
        ("pybullet", {"contactStiffness": 0.0, "contactDamping": 1.0}, 1.0, "is not positive"),
        ("generic", {"stiffness": 1.0, "damping": -1.0}, 1.0, "damping = -1.0 is not a number of"),
        ("generic", {"stiffness": 1.0, "time_step": 1.0}, 1.0, "generic has no 'time_step'"),
        ("drake", {"time_step": 0.0}, 1.0, "time_step = 0.0 is not a positive number of s"),
        ("drake", {"hunt_crossley_dissipation": 1.0}, 1.0, "point_contact_stiffness is missing"),
        (
            "drake",
            {"hunt_crossley_dissipation": 1.0, "time_step": 0.0},
            1.0,
            "time_step = 0.0 is not a positive number of s",
        ),
    ],
)
def test_parameters_that_cannot_be_read_are_refused_in_one_line(
    name, parameters, mass, says, refusal
):
    with refusal(ModelError, says):
        engine_of(name, parameters).contact(parameters, mass)


def test_drakes_hunt_crossley_contact_loses_what_its_work_is():
    # ∫ u du/(1 + Cu) over the impact is 0: (1 - rs) exp(s(1 + r)) = 1 + s with s = Cv.
    given = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}
    for release in ("approach", None):
        contact = Contact(mass=0.5, from_engine="drake", parameters=given, release=release)
        found = describe_contact(contact)
        assert found.stiffness == 1e5 and found.damping is found.measured_restitution is None
    pairs = re.findall(r"([\d.]+) at ([\d.]+) m/s", found.notes[0])
    assert len(pairs) == 3
    for r, s in np.array(pairs, dtype=float) * [1.0, 0.5]:
        # The left side falls with r, which is shown in four digits.
        less, more = r + np.array([-5e-5, 5e-5])
        assert (
            (1 - more * s) * np.exp(s * (1 + more))
            < 1 + s
            < (1 - less * s) * np.exp(s * (1 + less))
        )


@pytest.mark.parametrize(
    ("name", "release", "says"),
    [
        ("unreal", None, "unknown engine 'unreal': one of generic, mujoco, lammps, liggghts"),
        ("mujoco", "displacement", "mujoco has no displacement release: its contacts end by force"),
        ("mercurydpm", "force", "mercurydpm has no force release"),
        ("lammps", "glue", "unknown release 'glue'"),
    ],
)
def test_an_unknown_engine_or_release_is_refused(name, release, says, refusal):
    with refusal(ModelError, says):
        engine_named(name).settings(CONTACT, release)


@pytest.mark.parametrize("zeta", [1.0, 1.5, 20.0])
def test_an_overdamped_ball_comes_back_where_nothing_pulls(zeta):
    # MuJoCo's default is ζ = 1. Of p = (e^{-at} - e^{-bt})/(b - a) the force ends where p″ = 0.
    found = ENGINES["generic"].settings(Physical(1.0, 1.0, 2 * zeta), "force", 0.02)
    assert list(found.restitutions) == ["force"] and "If it ended" not in found.snippet
    a, b = zeta + np.array([-1, 1]) * np.sqrt(zeta**2 - 1)
    end = 2 * np.log(b / a) / (b - a) if zeta > 1 else 2.0
    rate = (a * np.exp(-a * end) - b * np.exp(-b * end)) / (b - a) if zeta > 1 else np.exp(-2)
    assert found.restitution == pytest.approx(abs(rate), rel=1e-12)
    assert found.time_step * found.steps == pytest.approx(end, rel=1e-11)


def test_an_impedance_that_varies_is_told_at_impacts_as_deep_as_its_width():
    # ω = 1/(Tζ) = 500 rad/s, and the width is W = 2 mm: impacts of 0.1, 1 and 10 times Wω = 1 m/s.
    given = {"solref": "0.02 0.1", "solimp": "0.9 0.95 0.002"}
    told = " ".join(ENGINES["mujoco"].notes(given))
    assert re.findall(r"at ([\d.]+) m/s", told) == ["0.1", "1", "10"]
    assert "below the depth of 0.002 m" in told
    # In another unit of length the same width is another number.
    half = ENGINES["mujoco"].law(given, length=2.0)
    assert half.width == ENGINES["mujoco"].law(given).width / 2 == 0.001


def test_no_damping_is_written_without_a_sign():
    found = ENGINES["mujoco"].settings(Physical(1.0, 1e4, 0.0))
    assert 'solref="-10000.0 0.0"' in found.snippet
    again = ENGINES["mujoco"].read({"solref": "-1e4 0"}, 1.0)
    assert again == (1.0, 1e4, 0.0) and np.copysign(1, again.damping) == 1
