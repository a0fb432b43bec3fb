"""The engines themselves, as their snippets are pasted: free impacts, and orbits on a table.

`make test-engines`, with the extra `engines`, writes the dataset engines.nc in docs/data; an engine
that is not installed is skipped by its name, and then the dataset is not written. Table and ball
are in units of g = Ω = 1, and at t = 0 the table is at its lowest: w = -Λ cos t. Where an engine
has no moving table, the table is the frame. Each engine returns the heights over the table, and
the seconds of processor time that its steps took.
"""

import math
import re
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from time import process_time

import numpy as np
import pytest
import xarray as xr
from asked_contacts import answered
from engine_runs import RUN, Trial, drake, mujoco
from installed_engines import LAST_SEEN, only_if_installed
from make_data import ENGINE_STEPS as PARAMETERS
from pandas import DataFrame
from the_docs import DATA, MEASURED

from bouncing_ball_beyond import corrected, limits, rigid, spring_damper
from bouncing_ball_beyond.accuracy.errors import paper_error
from bouncing_ball_beyond.accuracy.simple_models import SIMPLE
from bouncing_ball_beyond.inherited.datasets.files import read_dataset, write_dataset
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio, restitution_coefficient
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_contacts.documents.engine_steps import (
    RUNS_TITLE,
    VARIABLES,
    EngineOrbit,
    model_errors,
    step_errors,
    steps_of,
)
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.engine import ERROR, Physical, Written
from bouncing_ball_contacts.engines.impacts import steps_for
from bouncing_ball_contacts.engines.impedance import Impedance
from bouncing_ball_contacts.engines.scheme import Scheme

RELEASES = [(name, release) for name in RUN for release in ENGINES[name].releases]
LOSSES = (0.65, 0.85)
FAMILIES = (1, 2)
RATIOS = (10, 20, 50)
TOLERANCES = (0.01, 0.001)
SKIPPED, KEPT = 8, 16
# Single bounces at the steps whose error is the corrected model's, if a bounce needs no more steps.
BOUNCES = 4
AFFORDED = {"mujoco": 4e6, "lammps": 4e6, "pybullet": 5e5, "drake": 5e5}
MODELS = ("restitution", "corrected", "spring-damper")
# The free impacts and the orbits of a release and an r, and the single bounces.
ALL = [len(TOLERANCES), len(FAMILIES) * len(RATIOS), len(RUN) * len(RATIOS)]
ORBIT = ("release", "restitution", "n", "frequency_ratio")


@cache
def exact_orbit(release, restitution, n, frequency_ratio):
    """The orbit in the middle of its family's stable range."""
    zeta = float(damping_ratio(restitution, release))
    ball = spring_damper(frequency_ratio=frequency_ratio, damping_ratio=zeta, release=str(release))
    ends = limits(ball, n)
    return n_t.orbit(ball, n, (ends.saddle_node.amplitude + ends.period_doubling.amplitude) / 2)


@cache
def seconds_per_bounce(model, *case):
    """Processor time of an impact in this package's simulation of a ball by a model."""
    orbit = exact_orbit(*case)
    release, restitution, _, ratio = case
    exact = spring_damper(
        frequency_ratio=ratio, measured_restitution=restitution, release=str(release)
    )
    balls = {
        "restitution": rigid(restitution=restitution),
        "corrected": corrected(exact),
        "spring-damper": exact,
    }
    # Imports, and other programs on the machine, make some runs longer.
    spent = math.inf
    for _ in range(10):
        began = process_time()
        balls[model].simulate(
            float(orbit.amplitude),
            phase=float(orbit.phase),
            velocity=float(orbit.impact_velocity),
            impacts=SKIPPED + KEPT,
        )
        spent = min(spent, process_time() - began)
    return spent / (SKIPPED + KEPT)


def settings(name, release, restitution, mass, stiffness, error):
    zeta = float(damping_ratio(restitution, release))
    contact = Physical(mass, stiffness, 2 * zeta * (stiffness * mass) ** 0.5)
    return ENGINES[name].settings(contact, release, error)


def bounces(name, case, found, skipped, kept):
    """Relative errors of the greatest heights of an engine's cycles, and seconds for a bounce.

    The ball begins on its orbit, where the table is at its lowest.
    """
    n = case[2]
    exact = exact_orbit(*case)
    step = found.time_step
    # Back along the flight, from the impact to the table's lowest point.
    back = float(exact.phase) + np.pi / 2
    velocity = float(exact.impact_velocity)
    amplitude = float(exact.amplitude)
    height = amplitude * (1 + np.sin(exact.phase)) - velocity * back - back**2 / 2
    period = 2 * np.pi * n
    cycles = skipped + kept
    trial = Trial(
        settings=found,
        mass=1.0,
        height=float(height),
        speed=velocity + back,
        steps=int(cycles * period / step),
        gravity=1.0,
        amplitude=amplitude,
    )
    above, spent = RUN[name](trial)
    ball = above - amplitude * np.cos(trial.times)
    first = np.searchsorted(trial.times, period * np.arange(skipped, cycles))
    heights = np.maximum.reduceat(ball, first)
    return paper_error(exact=exact.max_height, simple=heights), spent / cycles


def simulated(name, case, steps):
    """Errors of bounces that begin at random fractions of so many steps, and the corrected model's.

    The bounces are simulated with the engine's scheme, and err by their root mean square.
    """
    release, restitution, n, ratio = case
    contact = SpringDamper(np.array([ratio]), damping_ratio(restitution, release), release)
    orbit = n_t.orbit(ContactModel(contact), n, exact_orbit(*case).amplitude)
    asked = {"n": n, "restitution": restitution, "release": release, "steps": steps}
    errors = step_errors(orbit, EngineOrbit(**PARAMETERS | asked))
    level = model_errors(orbit, 1)[SIMPLE.index("corrected"), 0]
    return errors[[*Scheme].index(ENGINES[name].scheme), 0], abs(float(level))


@pytest.fixture(scope="module")
def record():
    """What the tests measure; the dataset of the docs, written at the end if none is missing."""
    rows: tuple[list[dict], ...] = ([], [], [])
    yield rows
    if [*map(len, rows)] != [len(RELEASES) * len(LOSSES) * number for number in ALL[:2]] + ALL[2:]:
        return
    free, shaken, alone = rows
    whole = DataFrame(shaken).set_index(["engine", *ORBIT])
    exact = whole[["amplitude", "max_height"]].groupby(level=[*ORBIT]).first()
    whole = whole.drop(columns=exact.columns)
    first = DataFrame(free).set_index(["engine", "release", "restitution", "tolerance"])
    single = DataFrame(alone).set_index(["engine", "frequency_ratio"])
    parts = [part.to_xarray() for part in (first, exact, whole, single)]
    seconds = [seconds_per_bounce(model, *whole.index[0][1:]) for model in MODELS]
    parts.append(xr.Dataset({"model_time": ("model", np.divide(seconds, seconds[-1]))}))
    parts[-1]["model"] = list(MODELS)
    data = xr.merge(parts, join="outer").reindex(engine=list(RUN))
    data["engine_version"] = ("engine", [version(name) for name in RUN])
    data = describe(data, VARIABLES).assign_attrs(title=RUNS_TITLE, history=MEASURED)
    write_dataset(data, DATA / "engines.nc")


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("restitution", LOSSES)
@pytest.mark.parametrize(("name", "release"), RELEASES)
def test_a_free_impact_has_the_promised_restitution(name, release, restitution, tolerance, record):
    only_if_installed(name)
    error = tolerance * restitution
    found = settings(name, release, restitution, 0.5, 1e5, error)
    step = found.time_step
    measured = []
    for fraction in (0.02, 0.5, 0.98):
        away, _ = RUN[name](Trial(found, 0.5, fraction * step, -1.0, 2 * found.steps))
        measured.append((away[-1] - away[-2]) / step)
    farthest = max(measured, key=lambda r: abs(r - restitution))
    case = {"engine": name, "release": str(release), "restitution": restitution}
    case |= {"tolerance": tolerance, "measured_restitution": farthest, "free_steps": found.steps}
    record[0].append(case)
    assert found.restitution == pytest.approx(restitution, rel=1e-9)
    # The digits of the flight are those of a height of one, in steps.
    assert abs(farthest - restitution) <= error + 1e-5


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("restitution", LOSSES)
def test_drakes_hunt_and_crossley_has_the_restitution_at_the_orbits_speed(restitution):
    only_if_installed("drake")
    table = {"mass": 0.5, "frequency": 20.0, "acceleration": "0.8 g", "n": 1}
    contact = {"contact_time": 2e-3, "restitution": restitution, "law": "hunt-crossley"}
    options = table | contact | {"engine": "drake", "restitution_error": 0.01}
    made, _, found, *_ = answered(**options)
    speed = float(rigid_speed(1, restitution)) * made.case.table.length / made.case.table.time
    for fraction in (0.02, 0.5, 0.98):
        start = fraction * found.time_step * speed
        away, _ = drake(Trial(found, 0.5, start, -speed, 2 * found.steps))
        r = (away[-1] - away[-2]) / found.time_step / speed
        # The step is that of the linear contact with this r.
        assert abs(r - restitution) <= 1.05 * 0.01


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("zeta", [0.1, 0.25])
@pytest.mark.parametrize(
    ("surface", "share"), [(1e-4, 1e-4), (0.95, 0.95), (0.9999, 0.9999), (0.9, 0.95), (0.2, 0.9)]
)
def test_the_impedance_takes_its_part_of_the_load(surface, share, zeta):
    """A drop with gravity, against the contact law: units of g, and Ω = ω/10."""
    only_if_installed("mujoco")
    ratio, speed, steps = 10.0, 10.0, 20_000
    law = Impedance(ratio, zeta, share, surface, width=0.3)
    end = contacts(law, speed)
    # Back at the table's level after the flight that follows.
    back = np.sqrt(end.rate**2 - 2 * end.penetration)
    r = float(restitution_coefficient(zeta, Release.FORCE))
    found = settings("mujoco", Release.FORCE, r, 1.0, ratio**2, 0.01)
    step = 2 * float(end.duration) / steps
    least = " ".join(map(repr, found.parameters["solimp"]))
    snippet = found.snippet.replace(least, f"{surface!r} {share!r} 0.3")
    found = replace(
        found, time_step=step, snippet=re.sub('timestep="[^"]*"', f'timestep="{step!r}"', snippet)
    )
    heights, _ = mujoco(Trial(found, 1.0, speed * step / 2, -speed, steps, 1.0))
    above = np.flatnonzero(heights > 0)[-1]
    rise = (heights[above] - heights[above - 1]) / step
    measured = np.sqrt(rise**2 + 2 * heights[above] - step * rise) / speed
    # The contact has 10⁴ steps, and one of 450 leaves 0.001 (steps_for): 5e-5.
    assert measured == pytest.approx(float(back) / speed, abs=1e-4)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("frequency_ratio", RATIOS)
@pytest.mark.parametrize("n", FAMILIES)
@pytest.mark.parametrize("restitution", LOSSES)
@pytest.mark.parametrize(("name", "release"), RELEASES)
def test_an_orbit_has_the_exact_height(name, release, restitution, n, frequency_ratio, record):
    only_if_installed(name)
    case = (release, restitution, n, frequency_ratio)
    orbit = exact_orbit(*case)
    baseline = seconds_per_bounce(MODELS[-1], *case)
    found = settings(name, release, restitution, 1.0, float(frequency_ratio) ** 2, ERROR)
    off, seconds = bounces(name, case, found, SKIPPED, KEPT)
    error = float(off.mean())
    scatter = float(off.std(ddof=1))
    row = dict(zip(ORBIT, (str(release), *case[1:]), strict=True))
    row |= {"amplitude": float(orbit.amplitude), "max_height": float(orbit.max_height)}
    row |= {"engine": name, "contact_steps": found.steps, "bounce_time": seconds / baseline}
    row |= {"height_error": error, "height_scatter": scatter}
    # Bounces that are in step with the time grid begin at one and the same fraction of a step.
    row["step_scatter"] = simulated(name, case, [found.steps])[0].item()
    record[1].append(row)
    assert abs(error) <= row["step_scatter"]


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("frequency_ratio", RATIOS)
@pytest.mark.parametrize("name", RUN)
def test_a_bounce_is_as_right_as_the_corrected_models(name, frequency_ratio, record):
    only_if_installed(name)
    release = Release.of(PARAMETERS["release"])
    r = PARAMETERS["restitution"]
    n = PARAMETERS["n"]
    case = (release, r, n, frequency_ratio)
    many = np.array(PARAMETERS["steps"])
    errors, level = simulated(name, case, PARAMETERS["steps"])
    steps = round(steps_of(many, errors, level))
    row = {"engine": name, "frequency_ratio": frequency_ratio, "single_steps": steps}
    zeta = float(damping_ratio(r, release))
    contact = Physical(1.0, frequency_ratio**2, 2 * zeta * frequency_ratio)
    duration = float(contact.contact_time(release))
    if 2 * np.pi * n / duration * steps > AFFORDED[name]:
        record[2].append(row | {"single_error": np.nan})
        pytest.skip(f"{steps} steps in a contact of {name} take too long")
    single = []
    for many in range(steps, steps + BOUNCES):
        text = Written(ENGINES[name], contact, release).snippet(duration / many)
        coarse = settings(name, release, r, 1.0, frequency_ratio**2, 0.03)
        found = replace(coarse, time_step=duration / many, steps=many, snippet=text)
        single.append(bounces(name, case, found, 0, 1)[0][0])
    row["single_error"] = float(np.sqrt(np.mean(np.square(single))))
    record[2].append(row)
    # One of a few bounces may err three times as much as the mean of many.
    assert row["single_error"] < 3 * level


def test_the_accepted_heights_are_those_of_the_model():
    data = read_dataset(DATA / "engines.nc")
    made = zip(data.engine.values.tolist(), data.engine_version.values.tolist(), strict=True)
    assert dict(made) == {name: LAST_SEEN[name] for name in RUN}
    runs = data.stack(run=["engine", *ORBIT]).dropna("run", subset=["height_error"])
    assert runs.sizes["run"] == 12 * len(RELEASES)
    assert (abs(runs.height_error) <= runs.step_scatter).all()
    away = abs(data.measured_restitution / data.restitution - 1)
    assert (away.max([*away.dims][:3]) <= data.tolerance + 1e-5 / min(LOSSES)).all()
    for place in np.argwhere(data.free_steps.notnull().values):
        one = data.free_steps[tuple(place)]
        rule = Release.of(one.release.item())
        r = one.restitution.item()
        scheme = ENGINES[one.engine.item()].scheme
        zeta = float(damping_ratio(r, rule))
        assert one == steps_for(scheme, zeta, rule, one.tolerance.item() * r)
    for run in runs.run[::7]:
        _, release, *case = run.item()
        exact = exact_orbit(Release.of(release), *case)
        assert runs.max_height.sel(run=run.item()) == pytest.approx(float(exact.max_height), 1e-9)
