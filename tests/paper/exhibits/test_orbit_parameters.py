"""Frequency ratios at which there is nothing to draw are refused, with the next that is allowed."""

import re

import numpy as np
import pytest
from pydantic import create_model

import bouncing_ball as bb
from bouncing_ball.paper.exhibits.continuation_of_orbits import BothDomains, Domains
from bouncing_ball.paper.exhibits.orbit_parameters import OrbitsOfContacts
from bouncing_ball.paper.exhibits.time_histories import ContactHistory, Histories
from bouncing_ball.pipeline.configuration_check import check_parameters
from bouncing_ball.pipeline.yaml_files import ConfigurationError

ORBIT = {"n": 1, "restitution": 0.85, "amplitude": 1.0, "samples": 11}
BRANCH = {"n": 1, "restitution": 0.85, "amplitude_max": 1.5, "points": 11}


def mistake(kind, release, ratio, **others):
    """The message of the refusal of parameters in a run with a release rule."""
    run = create_model("Run", release=(str, ...), fig=(kind, ...))
    given = ORBIT if "amplitude" in kind.model_fields else BRANCH
    section = {name: x for name, x in given.items() if name in kind.model_fields}
    with pytest.raises(ConfigurationError) as error:
        check_parameters(
            run, {"release": release, "fig": section | {"frequency_ratio": ratio} | others}
        )
    return str(error.value)


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize(("kind", "ratio"), [(ContactHistory, 0.1), (Histories, [2.0, 0.1])])
def test_a_contact_without_the_orbit_is_refused_with_the_next_that_has_it(kind, ratio, release):
    line = mistake(kind, release, ratio)
    assert "= 0.1 must be the ϖ of a contact with a 1-T orbit at r = 0.85 and Λ = 1: " in line
    limit = float(re.search(r"has one is ([0-9.]+)$", line).group(1))

    def has(ratio):
        ball = bb.spring_damper(restitution=0.85, frequency_ratio=ratio, release=release)
        try:
            return bool(bb.orbit(ball, amplitude=1.0).admissible)
        except bb.NoOrbitError:
            return False

    # The limit has six digits.
    assert has(limit * (1 + 1e-5)) and not has(limit * (1 - 1e-5))
    assert not any(has(0.1 + 0.06 * k) for k in range(10))


@pytest.mark.parametrize("release", ["displacement", pytest.param("force", marks=pytest.mark.long)])
def test_a_figure_of_branches_needs_one_contact_that_has_orbits(release, monkeypatch):
    line = mistake(Domains, release, [0.1, 0.2])
    assert "[0.1, 0.2] must be the ϖ of a contact with a 1-T orbit" in line
    assert "Λ up to 1.5: the next that has one is 0.63" in line
    with monkeypatch.context() as patch:
        # The search is the same.
        patch.setattr(OrbitsOfContacts, "next_stiffer", lambda self, ratio: np.inf)
        assert "Λ up to 1.5" in mistake(BothDomains, release, 0.1)
    # With one that has them nothing is wrong but the number of points.
    assert mistake(Domains, release, [0.1, 10.0], points=1).count("\n") == 0


def test_a_wrong_release_rule_or_family_is_the_only_mistake():
    assert "Λ" not in mistake(ContactHistory, "force", 0.1, n=0)
    assert "amplitude" in mistake(ContactHistory, "force", 0.1, amplitude=0.01)
