"""Drake's contact with Hunt and Crossley's damping, at a time step that is given."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import Trial, drake
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_contacts.engines import hunt_crossley_steps
from bouncing_ball_contacts.engines.drake import HUNT_CROSSLEY
from bouncing_ball_contacts.engines.engine import LawInSI
from bouncing_ball_contacts.engines.physical import Physical

pytestmark = pytest.mark.usefixtures("short_runs")

GIVEN = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}
ASKED = {"mass": 0.5, "from_engine": "drake", "parameters": GIVEN}
# With so large an error no other contact is sought.
ALONE = ASKED | {"restitution_error": 0.9}
ROUGH = {"restitution_error": 0.01}


@pytest.fixture(scope="module", autouse=True)
def each_spread_once():
    """The range of r at a step is computed once, however many questions contain it."""
    with pytest.MonkeyPatch.context() as patch:
        computed = cache(hunt_crossley_steps.spread_of_damping)
        patch.setattr(hunt_crossley_steps, "spread_of_damping", computed)
        yield


def root(rest, low, high):
    """The zero of an increasing function between two rows of numbers, by bisection."""
    while True:
        middle = (low + high) / 2
        if np.all((middle <= low) | (middle >= high)):
            return middle
        below = rest(middle) < 0
        low = np.where(below, middle, low)
        high = np.where(below, high, middle)


def impacts(speed, step, fraction, damping=0.5, stiffness=1e5):
    """r of impacts, by the equation of each step as it is written, solved by bisection."""
    x = -fraction * step * speed
    v = np.full_like(x, -speed)
    for _ in range(10_000):
        (inside,) = np.nonzero(x < 0)
        if not inside.size:
            return v / speed
        p = -x[inside]
        before = v[inside]

        def rest(after, p=p, before=before):
            force = stiffness * np.maximum(p - step * after, 0) * np.maximum(1 - damping * after, 0)
            return 0.5 * (after - before) - step * force

        v[inside] = root(rest, before, p / step + 1 / damping + np.abs(before))
        x[inside] += step * v[inside]
    return np.where(x < 0, 0.0, v / speed)


@pytest.mark.parametrize(
    ("step", "speed"),
    [
        (1e-4, 2.0),
        (1e-3, 0.3),
        (3e-3, 2.0),
        *(
            pytest.param(*x, marks=pytest.mark.long)
            for x in [(1e-4, 0.3), (1e-3, 2.0), (3e-3, 0.3)]
        ),
    ],
)
def test_the_range_is_that_of_single_impacts(step, speed):
    at = answered(**ALONE, time_step=step, speed=speed).at_step
    many = impacts(speed, step, np.linspace(1e-6, 1.0, 401))
    # Instants 2.5e-3 apart; r changes by less than 2 over one step.
    assert at.least == pytest.approx(many.min(), abs=5e-3)
    assert at.most == pytest.approx(many.max(), abs=5e-3)
    assert at.mean == pytest.approx(many.mean(), abs=5e-3)
    assert at.least <= many.min() + 1e-9 and at.most >= many.max() - 1e-9


def test_the_retuned_damping_restores_the_mean():
    at = answered(**ASKED, **ROUGH, time_step="0.1 ms", speed="1 m/s").at_step
    tuned = ALONE | {"parameters": GIVEN | {"hunt_crossley_dissipation": at.retuned}}
    again = answered(**tuned, time_step="0.1 ms", speed="1 m/s").at_step
    assert not at.is_within and again.mean == pytest.approx(at.restitution, abs=1e-8)


def test_a_step_among_the_parameters_and_one_beside_them_are_one_question(said, refusal):
    beside = answered(**ASKED, **ROUGH, time_step="1 ms", speed="1 m/s").at_step
    among = ASKED | ROUGH | {"parameters": GIVEN | {"time_step": 1e-3}}
    found = answered(**among, speed="1 m/s").at_step
    assert found == replace(beside, is_of_parameters=True)
    # On a table the speed is that of the orbit.
    shaken = answered(**ALONE, time_step="1 ms", frequency="20 Hz", acceleration="0.8 g", n=1)
    assert shaken.at_step.speed == shaken.found.judged.impact_speed
    options = ["--from=drake", "--mass=0.5", "--time-step=1 ms", "--speed=1 m/s"]
    options += [f"--restitution-error={ROUGH['restitution_error']}"]
    options += [f"--set={name}={value}" for name, value in GIVEN.items()]
    text = said("design", *options)
    assert "a free impact at 1 m/s has r = 0.4218 to 0.5201 in place of 0.7484" in text
    with refusal(ModelError, "check the units"):
        answered(**ASKED, time_step="100 s", speed="1 m/s")


LAW = {"mass": 0.5, "law": "hunt-crossley-linear", "contact_time": "7 ms", "restitution": 0.75}
WRITTEN = LAW | {"engine": "drake", "speed": "1 m/s"}


def dropped(settings, drops):
    """Rises of balls that are dropped, by the recipe's parameters and the equation of a step."""
    k = settings.parameters["point_contact_stiffness"] / 2
    damping = settings.parameters["hunt_crossley_dissipation"]
    h = settings.time_step
    x = np.array(drops)
    v = np.zeros_like(x)
    was_in = np.zeros(x.size, dtype=bool)
    rising = np.ones(x.size, dtype=bool)
    for _ in range(100_000):
        free = v - 9.80665 * h
        p = -x

        def rest(after, p=p, free=free):
            force = k * np.maximum(p - h * after, 0) * np.maximum(1 - damping * after, 0)
            return 0.5 * (after - free) - h * force

        inside = p > 0
        v = free
        if inside.any():
            held = root(rest, free, free + 1 + 2 * h * k * np.maximum(p, 0) + 20)
            v = np.where(inside, held, free)
        was_in |= inside
        # A ball stays at its top.
        rising &= ~(was_in & (p <= 0) & (v <= 0))
        if not rising.any():
            return x
        x = np.where(rising, x + h * v, x)
    return np.where(rising, 0.0, x)


def test_a_law_is_written_for_a_step_with_what_the_engine_then_does():
    answer = answered(**WRITTEN, time_step="1 ms")
    engine = answer.engine
    at = engine.at_step
    k, d = engine.parameters.values()
    many = impacts(1.0, 1e-3, np.linspace(1e-6, 1.0, 401), d, k / 2)
    assert not at.is_within and engine.changed
    assert at.least == pytest.approx(many.min(), abs=5e-3)
    assert at.most == pytest.approx(many.max(), abs=5e-3)
    assert at.mean == pytest.approx(many.mean(), abs=5e-3)
    drops = 1 / (2 * 9.80665) + 1e-3 * np.linspace(-0.5, 0.5, 101)
    rises = dropped(engine, drops) / drops / (2 * 9.80665)
    # A hundred heights of the drop, between which the rise has jumps.
    assert engine.drop.rise == pytest.approx((rises.min(), rises.max()), rel=0.02)
    assert engine.drop.depth_at_rest == pytest.approx(0.5 * 9.80665 / (k / 2), rel=1e-12)
    # The contact that was asked for bounces lower.
    asked = answered(**WRITTEN, time_step="1 ms", restitution_error=0.9).engine
    assert not asked.changed and asked.drop.error > engine.drop.error
    assert engine.asked.restitution == pytest.approx(0.75, rel=1e-9)


def test_on_a_table_a_law_at_a_step_has_the_r_of_its_orbit(said, refusal):
    shaken = {"frequency": "20 Hz", "acceleration": "0.8 g", "n": 1, "engine": "drake"}
    found = answered(**LAW, **shaken, time_step="1 ms")
    assert found.engine.at_step.speed == found.found.judged.impact_speed
    options = [f"--{name.replace('_', '-')}={value}" for name, value in WRITTEN.items()]
    text = said("design", *options, "--time-step=1 ms")
    assert "is not resolved in drake: a free impact at 1 m/s has r = 0.4202 to 0.5206" in text
    with refusal(ModelError, "for drake with"):
        answered(mass="4 g", radius="5 mm", reduced_modulus="50 GPa", restitution=0.9,
                 engine="lammps", time_step="1 ms", speed="1 m/s")  # fmt: skip


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("step", [1e-4, 1e-3, 3e-3])
def test_drake_itself_has_this_range(step):
    only_if_installed("drake")
    ball = Physical(0.5, 1e5, 1.0)
    settings = HUNT_CROSSLEY.settings(ball, law=LawInSI(LinearHuntCrossley(2e5, 0.5)))
    text = re.sub(r"time_step=[^)]*", f"time_step={step!r}", settings.snippet)
    settings = replace(settings, time_step=step, snippet=text, release=str(Release.FORCE))
    at = answered(**ASKED, time_step=step, speed="1 m/s").at_step
    for fraction in (0.02, 0.3, 0.7, 0.98):
        away, _ = drake(Trial(settings, 0.5, fraction * step, -1.0, 12 + int(0.05 / step)))
        r = (away[-1] - away[-2]) / step
        # The ball arrives at this fraction of the step after the one before the contact.
        assert at.least - 1e-5 <= r <= at.most + 1e-5
        assert r == pytest.approx(impacts(1.0, step, np.array([1 - fraction]))[0], abs=1e-5)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("step", ["0.2 ms", "1 ms"])
def test_drake_has_the_r_of_a_recipe_for_this_step(step):
    only_if_installed("drake")
    settings = answered(**WRITTEN, time_step=step).engine
    h = settings.time_step
    at = settings.at_step
    for fraction in (0.02, 0.3, 0.7, 0.98):
        away, _ = drake(Trial(settings, 0.5, fraction * h, -1.0, 12 + int(3 * at.steps)))
        r = (away[-1] - away[-2]) / h
        assert at.least - 1e-5 <= r <= at.most + 1e-5
