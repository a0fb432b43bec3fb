"""A time step that is given: against a plain loop, and weekly against the engines themselves."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import RUN, Trial
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts import Contact, EngineSetup, write_contact
from bouncing_ball_contacts.engines import given_step
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.engine import Written
from bouncing_ball_contacts.engines.given_step import spread_in_steps, stiffest_contact
from bouncing_ball_contacts.engines.impacts import FEWEST, has_stable_steps, impacts_in_steps
from bouncing_ball_contacts.engines.physical import Physical
from bouncing_ball_contacts.engines.scheme import Scheme

pytestmark = pytest.mark.usefixtures("short_runs")

FRACTIONS = np.linspace(0.02, 0.98, 17).tolist()


@pytest.fixture(scope="module", autouse=True)
def each_spread_once():
    """The range of r at a step is computed once for all engines with the same scheme."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(given_step, "spread_in_steps", cache(spread_in_steps))
        yield


def plain_loop(zeta, release, h, fraction):
    """A free impact by semi-implicit Euler, as one writes it."""
    x = -h * fraction
    v = -1.0
    for _ in range(1000):
        rate = min(v, 0.0) if release is Release.APPROACH else v
        force = -x - 2 * zeta * rate if x < 0 else 0.0
        if release is Release.FORCE:
            force = max(force, 0.0)
        v += h * force
        x += h * v
        if x >= 0:
            return v
    return -1.0


@pytest.mark.parametrize("release", Release)
@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("h", [0.013, 0.1, 0.4, 1.1, 1.7, 2.5, 5.0])
def test_a_step_of_any_length_is_that_of_a_plain_loop(h, zeta, release):
    found = impacts_in_steps(Scheme.SEMI_IMPLICIT, zeta, release, h, FRACTIONS)
    expected = [plain_loop(zeta, release, h, fraction) for fraction in FRACTIONS]
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5, 2.0])
def test_semi_implicit_steps_grow_beyond_their_limit_and_implicit_ones_never(zeta):
    limit = 2 * (np.sqrt(1 + zeta**2) - zeta)
    for factor, stable in ((0.999, True), (1.001, False)):
        assert has_stable_steps(Scheme.SEMI_IMPLICIT, zeta, factor * limit) is stable
        # A lasting contact, which the wall holds on both sides.
        step = np.array([1.0, 0.0])
        for _ in range(20_000):
            x, v = step
            v -= factor * limit * (x + 2 * zeta * v)
            step = np.array([x + factor * limit * v, v])
            if abs(step).max() > 1e6:
                break
        assert bool(abs(step).max() < 1e4) is stable
    assert has_stable_steps(Scheme.IMPLICIT, zeta, 50.0) and has_stable_steps(
        Scheme.COMPENSATED, zeta, 50.0
    )


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("error", [0.02, 0.003])
def test_the_stiffest_contact_is_within_the_error_and_a_stiffer_one_is_not(scheme, error):
    zeta = 0.1
    contact = SpringDamper(1.0, zeta, Release.FORCE)
    duration = float(contact.free_duration)
    r = float(contact.restitution)
    _, steps = stiffest_contact(scheme, 1.0, zeta, Release.FORCE, 1.0, error)
    assert steps > FEWEST
    # As many instants within a step as show a jump at its side of 1e-5.
    instants = np.linspace(1e-9, 1.0, 100_001)
    for more, within in ((1.0, True), (1 - 1e-3, False)):
        h = duration / (more * steps)
        off = np.abs(impacts_in_steps(scheme, zeta, Release.FORCE, h, instants) - r).max()
        assert bool(off <= error) is within
    stiff, same = stiffest_contact(scheme, 2.0, zeta, Release.FORCE, 1e-4, error)
    assert same == steps and stiff.damping_ratio == pytest.approx(zeta, rel=1e-12)
    assert stiff.contact_time(Release.FORCE) == pytest.approx(1e-4 * steps, rel=1e-12)


@pytest.mark.parametrize(
    ("error", "restitution"),
    [
        (0.01, 0.9),
        (0.001, 0.5),
        (0.001, 0.8),
        *(
            pytest.param(*x, marks=pytest.mark.long)
            for x in [(0.01, 0.5), (0.01, 0.75), (0.01, 0.8), (0.001, 0.75), (0.001, 0.9)]
        ),
    ],
)
def test_the_stiffest_contact_is_within_the_error_where_the_error_jumps(restitution, error):
    """With the displacement release the sampled number of steps may be too small by a tenth."""
    zeta = float(damping_ratio(restitution))
    rule = Release.DISPLACEMENT
    ball, _ = stiffest_contact(Scheme.SEMI_IMPLICIT, 1.0, zeta, rule, 1.0, error)
    instants = np.linspace(1e-9, 1.0, 20_001)
    step = ball.angular_frequency
    found = impacts_in_steps(Scheme.SEMI_IMPLICIT, ball.damping_ratio, rule, step, instants)
    assert np.abs(found - restitution).max() <= error


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize(
    "steps", [1.6, 7.7, *(pytest.param(x, marks=pytest.mark.long) for x in (3.3, 41.0))]
)
def test_the_range_of_r_at_a_coarse_step_is_that_of_a_million_instants(scheme, steps):
    """r is linear between jumps, so that samples miss at most their distance times its slope."""
    zeta = 0.0335
    instants = np.linspace(1e-9, 1.0, 1_000_001)
    for rule in LINEAR if scheme is not Scheme.SEMI_IMPLICIT else Release:
        h = float(SpringDamper(1.0, zeta, rule).free_duration) / steps
        many = np.maximum(impacts_in_steps(scheme, zeta, rule, h, instants), 0.0)
        found = spread_in_steps(scheme, zeta, rule, h)
        # No slope is steeper than 100.
        assert found.least == pytest.approx(many.min(), abs=1e-4) and found.least <= many.min()
        assert found.most == pytest.approx(many.max(), abs=1e-4) and found.most >= many.max()
        assert found.mean == pytest.approx(many.mean(), abs=1e-5)


def test_the_answer_about_an_unstable_solref_says_so(said, ask):
    unstable = ("design", "--from", "mujoco", "--solref", "0.001 0.1", "--mass", "1")
    text = said(*unstable, "--time-step", "2 ms")
    assert "At a time step of 2 ms the given contact, of 0.1478 steps, is unstable in" in text
    assert "raises the time constant of 0.001 s to 0.004 s, two time steps (refsafe)" in text
    found = ask(*unstable, "--time-step", "2 ms")["at_step"]
    assert found["is_stable"] is False and found["most"] == pytest.approx(25)
    fine = ask(*unstable, "--time-step", "1 us")["at_step"]
    assert fine["is_within"] and fine["remarks"][0].startswith("this holds for impacts much")


@pytest.mark.parametrize("name", ENGINES)
def test_with_an_error_and_no_stiffness_the_contact_is_the_stiffest_within_it(name):
    contact = Contact(mass=0.5, restitution=0.75)
    setup = EngineSetup(engine=name, time_step="0.1 ms", restitution_error=0.01)
    found = write_contact(contact, setup)
    assert found.at_step.is_within and found.time_step == 1e-4 and not found.changed
    stiff = found.contact.stiffness
    again = write_contact(replace(contact, stiffness=stiff), setup)
    for one, other in zip(again.parameters.values(), found.parameters.values(), strict=True):
        # Twelve digits are written, twice.
        assert np.ravel(one) == pytest.approx(np.ravel(other), rel=1e-11)


@pytest.mark.parametrize("name", ENGINES)
def test_of_a_contact_that_is_too_stiff_the_nearest_one_is_written(name):
    contact = Contact(mass=0.5, restitution=0.75, stiffness=4e6)
    setup = EngineSetup(engine=name, time_step="0.1 ms", restitution_error=0.01)
    found = write_contact(contact, setup)
    # The answer has what the step does to the contact that was asked for.
    assert found.changed and not found.asked.is_within
    assert found.asked.restitution == pytest.approx(0.75, rel=1e-11)
    # It is nearer to r than that contact is, which a large error lets through.
    loose = write_contact(contact, replace(setup, restitution_error=0.9))
    assert not loose.changed and found.drop.error < loose.drop.error
    if found.changed != "damping":
        assert found.contact.stiffness < 4e6


def test_the_retuned_damping_restores_the_mean_at_the_step():
    engine = ENGINES["mujoco"]
    ball = Physical(0.5, 1e5, 40.0)
    written, asked = engine.at_step_of(engine.parameters(ball), ball.mass, 1e-3)
    at = written.with_damping(asked.retuned).at_step(1e-3, 0.001)
    assert at.mean == pytest.approx(asked.restitution, abs=1e-8)
    assert at.least < asked.restitution < at.most
    # A compensated step alone damps more than the contact.
    engine = ENGINES["pybullet"]
    coarse = Written(engine, ball, Release.FORCE)
    at = coarse.at_step(1e-3, 0.001)
    assert at.mean < at.restitution and coarse.retuned(at, coarse) is None


def test_the_contact_of_a_drop_test_rebounds_as_measured_at_the_step():
    given = {"mass": 0.02, "drop_height": "20 cm", "rebound_height": "10 cm"}
    for error in ({}, {"restitution_error": "1 %"}):
        setup = EngineSetup(engine="mujoco", time_step="0.1 ms", **error)
        found = answered(**given, engine="mujoco", time_step="0.1 ms", **error)
        assert found.engine == write_contact(Contact(**given), setup)
        # Without steps it rebounds as measured, and with them to the error that is told.
        drop = found.engine.drop
        assert drop.height == pytest.approx(0.2)
        again = answered(
            mass=0.02, stiffness=found.engine.contact.stiffness, release="force",
            damping=found.engine.contact.damping, speed=(2 * 9.80665 * 0.2) ** 0.5,
        )  # fmt: skip
        assert again.dropped.rebound_height == pytest.approx(0.1, rel=1e-9)
        assert drop.rise.least < 0.1 * 1.001 and drop.rise.most > 0.1 * 0.96


def test_a_step_that_does_not_resolve_a_contact_has_no_orbit_of_it():
    table = {"frequency": "20 Hz", "acceleration": "0.8 g", "n": 1}
    given = {"mass": 0.5, "stiffness": "1e6 N/m", "restitution": 0.8, "engine": "lammps"}
    fine = answered(**table, **given, time_step="1 us")
    assert fine.engine.max_height == fine.found.judged.max_height and fine.at_step.is_within
    assert fine.found.time_step.largest == 1e-6
    coarse = answered(**table, **given, time_step="1 ms")
    assert coarse.engine.max_height is None and not coarse.at_step.is_within
    # The verdict is on the contact that was asked for, and the drop has the speed of its orbit.
    assert coarse.found.stiffness == 1e6 and coarse.engine.contact.stiffness < 1e6
    speed = coarse.found.judged.impact_speed
    assert coarse.engine.drop.height == pytest.approx(speed**2 / (2 * 9.80665), rel=1e-12)


def test_a_time_step_needs_an_engine(refusal):
    with refusal(ModelError, "time_step needs engine or from_engine, such as generic"):
        answered(mass=1, stiffness=1e5, restitution=0.8, time_step="1 ms")


def test_a_time_step_is_for_a_contact_whose_r_has_no_speed(refusal):
    crossley = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}
    with refusal(ModelError, "time_step with hunt_crossley_dissipation needs speed of an impact"):
        answered(mass=0.5, from_engine="drake", parameters=crossley, time_step="1 ms")
    table = {"mass": 0.5, "frequency": "20 Hz", "acceleration": "0.8 g", "n": 1}
    hertz = {"radius": "5 cm", "reduced_modulus": "1 GPa", "restitution": 0.8}
    with refusal(ModelError, "time_step is given for a spring and a damper, or for drake with"):
        answered(**table, **hertz, engine="lammps", time_step="1 ms")
    with refusal(ModelError, "time_step and parameters time_step give the same"):
        given = {"contactStiffness": 1e5, "contactDamping": 1.0, "time_step": 1e-3}
        answered(mass=0.5, from_engine="pybullet", parameters=given, time_step="1 ms")


def in_engine(name, text, time_step, mass, contact_time):
    """r of free impacts in an engine, which begin at fractions of a step."""
    settings = ENGINES[name].settings(Physical(mass, 1e4, 1.0))
    settings = replace(settings, snippet=text, time_step=time_step)
    found = []
    for fraction in FRACTIONS:
        steps = 12 + int(3 * contact_time / time_step)
        away, _ = RUN[name](Trial(settings, mass, fraction * time_step, -1.0, steps))
        found.append((away[-1] - away[-2]) / time_step)
    return np.array(found)


def by_scheme(at, contact, release):
    """The same by the scheme of the engine."""
    h = contact.angular_frequency * at.time_step
    after = 1 - np.array(FRACTIONS)
    scheme = ENGINES[at.engine].scheme
    return impacts_in_steps(scheme, contact.damping_ratio, release, h, after)


@pytest.mark.parametrize(("name", "stiff", "lossy"), [("pybullet", 2e5, 5.0), ("drake", 2e5, 4e-5)])
def test_parameters_that_were_not_made_for_a_step_are_compared_with_small_steps(name, stiff, lossy):
    engine = ENGINES[name]
    values = dict(zip(engine.names, (stiff, lossy), strict=True))
    limit = engine.read(values, 0.5)
    r = limit.restitution(engine.release())
    _, fine = engine.at_step_of(values, 0.5, 1e-7)
    assert fine.is_within and fine.restitution == r
    _, coarse = engine.at_step_of(values, 0.5, 4e-3)
    # Implicit Euler by hand: (1 + c h/m + k h²/m) v⁺ = v - h k x/m, or a flight.
    m, k, c = limit
    h = 4e-3
    found = []
    for fraction in FRACTIONS:
        x = -h * fraction
        v = -1.0
        while x < 0:
            pushed = (v - h * k * x / m) / (1 + h * c / m + h * h * k / m)
            v = max(v, pushed)
            x += h * v
        found.append(v)
    assert coarse.restitution == r and not coarse.is_within
    assert coarse.least - 1e-9 <= min(found) <= coarse.least + 0.05
    assert coarse.most - 0.05 <= max(found) <= coarse.most + 1e-9


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("time_step", [1e-3, 4e-3])
def test_pybullet_does_with_parameters_what_the_answer_says(time_step):
    only_if_installed("pybullet")
    _, found = ENGINES["pybullet"].at_step_of(
        {"contactStiffness": 2e5, "contactDamping": 5.0}, 0.5, time_step
    )
    text = (
        f"pybullet.setPhysicsEngineParameter(fixedTimeStep={time_step}, numSubSteps=1,"
        " contactSlop=0)\n"
        "for body in (ball, table):\n"
        "    pybullet.changeDynamics(body, -1, contactStiffness=2e5, contactDamping=5.0,"
        " restitution=0, linearDamping=0, angularDamping=0, contactProcessingThreshold=0)\n"
    )
    measured = in_engine("pybullet", text, time_step, 0.5, 7e-3)
    assert found.least - 2e-3 <= measured.min() <= found.least + 0.05
    assert found.most - 0.05 <= measured.max() <= found.most + 2e-3


SOLREFS = [
    ("0.001 0.1", "2 ms"),
    ("0.02 0.3", "2 ms"),
    ("0.01 0.2", "2 ms"),
    ("0.003 0.5", "2 ms"),
    ("0.02 0.1", "5 ms"),
    ("0.05 0.1", "5 ms"),
    ("-1e6 -200", "0.1 ms"),
    ("-1e6 -200", "1 ms"),
    ("-1e6 -200", "2.5 ms"),
]


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("solref", "time_step"), SOLREFS)
def test_mujoco_does_with_a_solref_what_the_answer_says(solref, time_step):
    only_if_installed("mujoco")
    found = answered(
        mass=1.0, from_engine="mujoco", solref=solref, solimp="1e-4 1e-4", time_step=time_step
    ).at_step
    # MuJoCo raises a time constant to two steps.
    first, second = map(float, solref.split())
    safe = solref if first < 0 else f"{max(first, 2 * found.time_step)} {second}"
    contact = ENGINES["mujoco"].read({"solref": safe}, 1.0)
    text = (
        f'<option timestep="{found.time_step!r}"/>'
        '<default><default class="bounce">'
        f'<geom condim="1" solref="{solref}" solimp="1e-4 1e-4 0.001"/></default></default>'
    )
    lasts = contact.contact_time(Release.FORCE)
    measured = in_engine("mujoco", text, found.time_step, 1.0, lasts)
    # MuJoCo's solver and the impedance 1e-4 leave this much.
    assert measured == pytest.approx(by_scheme(found, contact, Release.FORCE), rel=1e-3, abs=1e-3)
    assert found.least - 1e-3 <= measured.min() and measured.max() <= found.most * (1 + 1e-3)
    assert found.is_stable or measured.max() > 1


PASTED = [
    ("mujoco", 1e5, "1 ms"),
    ("mujoco", 1e5, "0.2 ms"),
    ("lammps", 1e5, "1 ms"),
    ("lammps", 1e5, "0.2 ms"),
    ("pybullet", 1e5, "1 ms"),
    ("pybullet", 1e5, "0.2 ms"),
    ("drake", 1e5, "1 ms"),
]


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("name", "stiffness", "time_step"), PASTED)
def test_an_engine_does_with_a_contact_at_a_step_what_the_answer_says(name, stiffness, time_step):
    only_if_installed(name)
    contact = Contact(mass=0.5, stiffness=stiffness, restitution=0.75)
    setup = EngineSetup(engine=name, time_step=time_step, restitution_error=0.01)
    found = write_contact(contact, setup)
    at = found.asked or found.at_step
    release = Release(found.release)
    zeta = float(damping_ratio(0.75, release))
    physical = Physical(0.5, stiffness, 2 * zeta * float(np.sqrt(stiffness * 0.5)))
    text = Written(ENGINES[name], physical, release).snippet(at.time_step)
    measured = in_engine(name, text, at.time_step, 0.5, at.steps * at.time_step)
    # LAMMPS' velocity is that of the half step, and PyBullet's positions have single precision.
    expected = by_scheme(at, physical, Release(found.release))
    assert measured == pytest.approx(expected, abs=2e-3)
    assert at.least - 2e-3 <= measured.min() and measured.max() <= at.most + 2e-3
    # What is written is another contact, whose free impacts are those of its answer.
    new = found.at_step
    written = in_engine(name, found.snippet, new.time_step, 0.5, new.steps * new.time_step)
    assert new.least - 2e-3 <= written.min() and written.max() <= new.most + 2e-3
