"""Designs for an engine: its release, its parameters, and the orbit that it will show."""

import math

import pytest
from asked_contacts import answered, assessed, described

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.physical import Physical

pytestmark = pytest.mark.usefixtures("short_runs")

TABLE = {"mass": 0.5, "frequency": "20 Hz", "acceleration": "0.8 g", "n": 1}
STIFF = TABLE | {"stiffness": 1e6}


@pytest.mark.parametrize(
    ("name", "release", "has"),
    [("mujoco", None, "force"), ("lammps", None, "displacement"), ("lammps", "force", "force")],
)
def test_a_restitution_that_is_asked_for_is_met_under_the_engines_release(name, release, has):
    asked, _, settings, *_ = answered(**STIFF, restitution=0.75, engine=name, release=release)
    assert (settings.name, settings.release) == (name, has)
    assert settings.restitution == pytest.approx(0.75, rel=1e-12)
    # The orbit is that of this contact.
    same = assessed(**STIFF, measured_restitution=0.75, release=has)
    assert asked.orbits == same.orbits and asked.measured_restitution == same.measured_restitution
    one = same.judged
    expected = (one.max_height, one.contact_duration, one.greatest_compression)
    found = (settings.max_height, settings.contact_duration, settings.penetration)
    assert found == pytest.approx(expected, rel=1e-12)


def test_a_drop_test_and_a_contact_time_are_met():
    drop = {"contact_time": "2 ms", "drop_height": 1.0, "rebound_height": 0.49}
    found, _, settings, *_ = answered(**TABLE, **drop, engine="drake")
    # The package's own simulation, on a table at rest.
    length = found.case.table.length
    run = ContactModel(found.case.equivalent).simulate(0.0, 0.0, -((2 / length) ** 0.5), 1)
    height = run.release_displacement[0] + run.relative_bounce_velocity[0] ** 2 / 2
    assert length * float(height) == pytest.approx(0.49, rel=1e-9)
    # Without gravity the ball would leave a little faster.
    assert 0.7 < settings.restitution < 0.702
    assert settings.time_step * settings.steps == pytest.approx(2e-3, rel=1e-9)


@pytest.mark.parametrize("engine", ["mujoco", "pybullet", "physx"])
def test_on_a_table_too_a_step_that_is_too_long_has_a_softer_contact(engine):
    """The contact that the orbit needs takes less than a step."""
    table = {"mass": 0.005, "frequency": "30 Hz", "acceleration": "0.8 g", "n": 1}
    settings = answered(**table, restitution=0.8, engine=engine, time_step="1 ms").engine
    assert settings.asked.steps < 2 and "stiffness" in settings.changed
    # Besides what gravity takes of so slow an impact, r is off by the instants within a step.
    assert settings.at_step.is_stable and settings.drop.error < settings.taken_by_gravity + 0.05


def test_hunt_and_crossleys_contact_is_written_for_drake():
    asked = {"contact_time": "2 ms", "restitution": 0.8, "law": "hunt-crossley"}
    found, _, settings, *_ = answered(**TABLE, **asked, engine="drake")
    law = found.law
    assert law["name"] == "hunt-crossley-linear" and settings.restitution == pytest.approx(0.8)
    both = {"point_contact_stiffness": 2 * law["stiffness"]}
    both["hunt_crossley_dissipation"] = law["damping"]
    assert settings.parameters == pytest.approx(both, rel=1e-11)
    assert all(repr(value) in settings.snippet for value in settings.parameters.values())
    assert found.time_step.largest == settings.time_step
    # What is written is read as the same law, and its orbit is the same one.
    read = {"from_engine": "drake", "parameters": settings.parameters}
    again = assessed(**TABLE, **read)
    same = again.law
    assert same.pop("name") == law.pop("name")
    assert same == pytest.approx(law, rel=1e-11)
    got = again.measured_restitution, again.contact_time, again.judged.max_height
    assert got == pytest.approx((0.8, 2e-3, found.judged.max_height), rel=1e-10)
    # For another engine the linear contact of this speed is written.
    linear = answered(**TABLE, **read, engine="lammps").engine
    assert linear.restitution == pytest.approx(0.8, rel=1e-10)
    with pytest.raises(ModelError, match="from_engine drake needs a table"):
        answered(mass=0.5, **read, engine="lammps")
    with pytest.raises(ModelError, match="tsuji is not written for drake"):
        answered(**TABLE, **asked | {"law": "tsuji"}, engine="drake")


@pytest.mark.long
def test_a_strongly_damped_contact_of_drake_has_the_saddle_node_of_its_restitution():
    # r = 1/(dv) with v = 2πg/((1 + r)Ω), and Λ_SN = π(1 - r)/(1 + r).
    strong = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 50.0}
    with pytest.raises(NoOrbitError, match=r"the 1-T orbit needs 2\.885"):
        answered(**TABLE, from_engine="drake", parameters=strong)


def test_a_damper_is_kept_and_its_restitution_is_the_engines():
    settings = answered(**STIFF, damping=100.0, engine="mujoco").engine
    assert settings.parameters["solref"] == [-2e6, -200.0]
    own = assessed(**STIFF, damping=100.0)
    assert settings.restitution == pytest.approx(own.restitution["force"], rel=1e-10)
    assert own.measured_restitution == own.restitution["displacement"] < settings.restitution


def test_a_contact_that_is_chosen_has_settings_too():
    chosen = answered(**TABLE, restitution=0.75, tolerance="5 %", engine="lammps")
    settings = chosen.engine
    assert settings.parameters["kn"] == pytest.approx(chosen.found.stiffness, rel=1e-11)


def test_a_contact_without_a_table_is_that_of_one_with_it():
    asked = {"restitution": 0.75, "engine": "mujoco", "restitution_error": "1 %"}
    found, _, alone, *_ = answered(mass=0.5, stiffness=1e6, **asked)
    with_table = answered(**STIFF, **asked).engine
    assert alone.parameters["solref"] == pytest.approx(with_table.parameters["solref"])
    assert alone.steps == with_table.steps
    assert alone.error == 0.01 and alone.max_height is None
    finer = answered(mass=0.5, stiffness=1e6, **asked | {"restitution_error": 0.001})
    assert finer.engine.steps > 9 * alone.steps
    assert found.measured_restitution == pytest.approx(0.75)


@pytest.mark.parametrize("table", [{}, TABLE])
def test_from_one_engine_to_another_of_another_release(table):
    given = {"mass": 0.5, "from_engine": "lammps", "parameters": {"kn": 1e5, "gamma_n": 20}}
    found = answered(**table | given).found
    assert found.case.equivalent.release == "displacement"
    written, _, settings, *_ = answered(**table | given, engine="mujoco")
    assert settings.parameters["solref"] == pytest.approx([-2e5, -20])
    before = found.measured_restitution
    why = "because contacts end by displacement in lammps, and by force in mujoco"
    changed = f"r changes from {before:.4f} to {written.measured_restitution:.4f}, {why}"
    assert changed in written.notes
    assert answered(**table | given, engine="liggghts").found.notes == found.notes


@pytest.mark.parametrize(
    ("solref", "says"),
    [
        ("284244 68.8", "a time constant of 284244 s, which no simulation has: -k/m and -c/m are"),
    ],
)
def test_a_solref_that_no_simulation_has_is_refused_with_what_was_meant(solref, says, refusal):
    with refusal(ModelError, says):
        answered(mass=1.0, from_engine="mujoco", solref=solref)
    assert described(mass=1.0, from_engine="mujoco", solref="-284244 -68.8").stiffness == 284244


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"engine": "MuJoCo"}, "physx; did you mean mujoco?"),
        ({"mass": None}, "mass is missing"),
        ({"measured_restitution": 0.7}, "contradict each other"),
        (
            {"stiffness": None, "reduced_modulus": 1e9, "radius": 0.01},
            "is not written for mujoco",
        ),
        (
            {"stiffness": None, "reduced_modulus": 1e9, "radius": 0.01, "engine": None},
            "radius needs a table, such as frequency and acceleration, or speed of an impact",
        ),
    ],
)
def test_a_mistake_is_one_line_that_says_what_is_allowed(given, says, refusal):
    with refusal(ModelError, says):
        answered(**{"engine": "mujoco", "mass": 1.0, "stiffness": 1e5, "restitution": 0.8} | given)


def test_an_engine_takes_each_restitution_as_measured_and_refuses_both(refusal):
    """The release of MuJoCo is that of the force, whose r is larger for the same damping."""
    bare = {"mass": 0.5, "stiffness": 1e5}
    given = answered(**bare, restitution=0.75, engine="mujoco")
    measured = answered(**bare, measured_restitution=0.75, engine="mujoco")
    assert given.engine == measured.engine
    assert given.found.measured_restitution == pytest.approx(0.75, rel=1e-12)
    # Without an engine it is that of Eq. 16, for the displacement release.
    plain = described(**bare, restitution=0.75, release="force")
    assert plain.measured_restitution > 0.76
    with refusal(ModelError, "restitution and measured_restitution contradict each other"):
        answered(**bare, restitution=0.75, measured_restitution=0.75, engine="mujoco")
    # Neither of them: the damping ratio is kept.
    for loss in ({"damping_ratio": 0.1}, {"damping": 2 * 0.1 * (0.5 * 1e5) ** 0.5}):
        kept = described(**bare, **loss, engine="mujoco")
        assert kept.damping_ratio == pytest.approx(0.1, rel=1e-12)
    with refusal(ModelError, "the loss of the contact is missing"):
        answered(**bare, engine="mujoco")


@pytest.mark.parametrize("name", ENGINES)
def test_an_engine_reads_parameters_of_a_ball_with_a_mass_only(name, refusal):
    engine = ENGINES[name]
    found = dict(engine.parameters(Physical(2.0, 200.0, 4.0)))
    found.pop("mass", None)
    assert engine.read(found, 2.0) == pytest.approx((2.0, 200.0, 4.0), rel=1e-12)
    for mass in (0.0, math.inf):
        with refusal(ModelError, "is not a positive number of kg"):
            engine.read(found, mass)
    with refusal(ModelError, "the mass is missing"):
        engine.read(found, None)
    with refusal(ModelError, f"{name} has no 'colour'"):
        engine.read(found | {"colour": 1.0}, 2.0)


@pytest.mark.parametrize("name", sorted(set(ENGINES) - {"mujoco"}))
def test_an_engine_reads_its_two_parameters_in_their_ranges(name, refusal):
    engine = ENGINES[name]
    stiff, lossy = engine.names
    # Genesis has no contact without damping, and MuJoCo's default is what Newton's MuJoCo solver
    # takes for kd = 0.
    damped = name in ("genesis", "newton-mujoco")
    good = {stiff: 100.0, lossy: 0.5 if damped else 0.0}
    assert (engine.read(good, 1.0).damping > 0) == damped
    for change, says in (
        ({stiff: 0.0}, f"{stiff} = 0.0 is not positive"),
        ({lossy: -1.0}, f"{lossy} = -1.0 is not a number of at least 0"),
        ({lossy: math.inf}, f"{lossy} = inf is not a number of at least 0"),
    ):
        with refusal(ModelError, says):
            engine.read(good | change, 1.0)
    for missing in (stiff, lossy):
        rest = {key: value for key, value in good.items() if key != missing}
        with refusal(ModelError, f"{missing} is missing: the parameters of {name} are"):
            engine.read(rest, 1.0)
