"""What time steps cost: the simulated errors against the engines themselves, and their laws."""

import numpy as np
import pytest
from make_data import ENGINE_STEPS
from the_docs import DATA

from bouncing_ball_beyond.accuracy.simple_models import errors
from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.documents.engine_steps import EngineOrbit, conformance
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.scheme import Scheme

RUNS = read_dataset(DATA / "engines.nc")
FORCE = RUNS.sel(release="force")


def conformed(runs=RUNS, **changed):
    return conformance(runs, EngineOrbit(**ENGINE_STEPS | changed))


@pytest.fixture(scope="module")
def found():
    return conformed()


@pytest.mark.slow
def test_the_engines_err_as_their_steps_say():
    ratios = {scheme: [] for scheme in Scheme}
    for n in map(int, FORCE.n):
        for r in map(float, FORCE.restitution):
            runs = FORCE.sel(n=n, restitution=r)
            steps = sorted({int(k) for k in runs.contact_steps.values.ravel()})
            data = conformed(n=n, restitution=r, steps=steps)
            for name in runs.engine.values:
                one = data.sel(n=n, restitution=r, release="force", engine=name)
                scheme = ENGINES[name].scheme
                taken = one.contact_steps
                expected = one.step_error.sel(scheme=scheme, steps=taken)
                ratios[scheme] += (one.bounce_error / expected).values.ravel().tolist()
    # The scatter of 16 bounces, each like the one before, is known to some 30 %, and the mean of 24
    # such runs to 6 %. Three times that.
    for scheme in (Scheme.SEMI_IMPLICIT, Scheme.COMPENSATED):
        assert abs(np.mean(np.log(ratios[scheme]))) < 0.18


def test_the_error_falls_as_one_over_the_steps(found):
    slopes = np.diff(np.log(found.step_error.values)) / np.diff(np.log(found.steps.values))
    assert slopes[..., -1] == pytest.approx(-1, abs=0.01)


def test_each_orbit_ran_at_each_frequency_ratio_in_an_engine():
    assert RUNS.height_error.notnull().any("engine").all()


def test_an_orbit_that_the_dataset_does_not_have_is_refused(refusal):
    for lacking, says in (({"n": [2]}, "n = 1"), ({"restitution": [0.85]}, "restitution = 0.65")):
        with refusal(ModelError, says, "is not among"):
            conformed(RUNS.sel(lacking))


def test_the_models_err_as_everywhere_and_the_simulation_does_not(found):
    for r in found.restitution.values:
        part = found.sel(restitution=r, release="displacement", n=2)
        contact = SpringDamper.from_restitution(r, part.frequency_ratio.values.astype(float))
        signed = errors(contact, 2, part.amplitude.values, ["max_height"])[:, 0]
        simple = part.model_error.sel(model=["restitution", "corrected"]).values
        assert simple == pytest.approx(signed, rel=1e-9)
    assert found.model_error.sel(model="spring-damper").max() < 1e-12
