"""The cross-check agrees with itself, and sees what is wrong."""

import numpy as np
import pytest

from bouncing_ball.claims.cross_check import (
    BUDGETS,
    CLOSES,
    FORMULA,
    HOLDS,
    LEAVES,
    CrossCheckError,
    cross_check,
)
from bouncing_ball.configuration.study import typed
from bouncing_ball.studies.frequency_sweeps import apparent_restitution, frequency_sweep
from bouncing_ball.studies.orbit_branches import both_domains, orbit_branches, stability_ranges
from bouncing_ball.studies.release_rules import release_rules
from bouncing_ball.studies.restitution_families import restitution_history, restitution_orbits

# As the configuration gives them.
apparent_restitution, frequency_sweep = map(typed, (apparent_restitution, frequency_sweep))
both_domains, orbit_branches, stability_ranges, release_rules = map(
    typed, (both_domains, orbit_branches, stability_ranges, release_rules)
)
restitution_history, restitution_orbits = map(typed, (restitution_history, restitution_orbits))


def with_attributes(data, parameters, release=None):
    data.attrs = parameters | ({"release": release} if release else {})
    return data


@pytest.fixture(scope="module", params=["displacement", "force"])
def computed_branches(request, continuation_settings):
    parameters = {
        "n": 1,
        "restitution": 0.85,
        "frequency_ratio": [10.0, 2.0],
        "amplitude_max": 1.5,
        "points": 41,
    }
    data = orbit_branches(parameters, request.param, continuation_settings)
    return with_attributes(data, parameters, request.param)


@pytest.fixture
def branches(computed_branches):
    """Both branches under either rule, which a test may change."""
    return computed_branches.copy(deep=True)


def test_branches_agree(branches, continuation_settings):
    result = cross_check({"fig08": branches}, continuation_settings)
    assert np.all(result.disagreement <= result.budget)
    # Every kind of comparison is made on some orbits.
    assert np.all(result.orbits > 0)
    assert int(result.orbits.sel(artifact="fig08", comparison=FORMULA)) == 82 + 7


def test_what_shows_no_orbit_has_no_row(continuation_settings):
    history = {"n": 1, "restitution": 0.85, "amplitude": 1.0, "periods": 1, "samples": 11}
    # Between the saddle-nodes: 10.6643 of the restitution model, 10.6693 of the contact.
    soft = {"n": 20, "restitution": 0.7098, "frequency_ratio": [7.09]}
    soft |= {"amplitude_max": 10.666, "points": 11}
    branch = orbit_branches(soft, "displacement", continuation_settings)
    assert np.isnan(branch.amplitude).all()
    datasets = {
        "fig02": with_attributes(restitution_history(history), history),
        "fig09": with_attributes(branch, soft, "displacement"),
    }
    result = cross_check(datasets, continuation_settings)
    assert result.artifact.values.tolist() == ["fig02"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("variable", "shift"),
    [
        ("phase", 1e-10),
        # Nearly along the branch, which takes nine tenths of it.
        ("amplitude", 1e-9),
        ("impact_velocity", 1e-10),
        ("special_amplitude", 1e-10),
    ],
)
def test_a_wrong_point_is_named(branches, continuation_settings, variable, shift):
    branches[variable][0, 1] += shift
    with pytest.raises(CrossCheckError) as error:
        cross_check({"fig08": branches}, continuation_settings)
    assert "fig08: continuation and formula disagree by" in str(error.value)
    assert "ϖ = 10" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_sweeps_agree(continuation_settings, release):
    parameters = {
        "n": 2,
        "restitution": 0.85,
        "amplitude": [1.0, 0.6],
        "frequency_ratio": {"min": 1.0, "max": 1e3, "samples": 15},
    }
    data = with_attributes(frequency_sweep(parameters, release), parameters, release)
    result = cross_check({"fig10": data}, continuation_settings)
    assert float(result.disagreement.sel(comparison=FORMULA).squeeze()) < 1e-12
    data["impact_velocity"][0, 3] += 1e-9
    with pytest.raises(CrossCheckError, match="Λ = 1, ϖ ="):
        cross_check({"fig10": data}, continuation_settings)


def test_restitution_model_agrees(continuation_settings):
    domains = {"n": [1, 4], "restitution": 0.85, "amplitude_max": 2.0, "points": 31}
    history = {"n": 1, "restitution": 0.85, "amplitude": 1.0, "periods": 1, "samples": 11}
    datasets = {
        "fig02": with_attributes(restitution_history(history), history),
        "fig03": with_attributes(restitution_orbits(domains), domains),
    }
    result = cross_check(datasets, continuation_settings)
    assert np.nanmax(result.disagreement.sel(comparison=HOLDS)) < 1e-12
    assert int(result.orbits.sel(artifact="fig03", comparison=LEAVES)) > 10
    datasets["fig03"]["phase"][1, 2] += 1e-9
    with pytest.raises(CrossCheckError, match=r"4-T orbit .* restitution model"):
        cross_check(datasets, continuation_settings)


def test_both_models_in_one_dataset_and_the_table(continuation_settings):
    domains = {
        "n": 2,
        "restitution": 0.65,
        "frequency_ratio": 10.0,
        "amplitude_max": 2.2,
        "points": 21,
    }
    ranges = {"n": [1, 2], "restitution": 0.85, "frequency_ratio": [10.0], "amplitude_max": 1.5}
    datasets = {
        "fig15": with_attributes(
            both_domains(domains, "displacement", continuation_settings), domains, "displacement"
        ),
        "table1": with_attributes(
            stability_ranges(ranges, "displacement", continuation_settings),
            ranges,
            "displacement",
        ),
    }
    result = cross_check(datasets, continuation_settings)
    # 21 points and 2 bifurcations of each model; 4 bifurcations of the table.
    assert result.orbits.sel(comparison=FORMULA).values.tolist() == [46, 4]
    assert set(BUDGETS) == set(result.comparison.values)


@pytest.mark.parametrize(
    ("changed", "dropped"),
    [
        # The unstable side is inadmissible beyond its grazing orbit.
        ({"amplitude_max": 3.0}, True),
        # The formula's X and Y nearly stand still.
        ({"restitution": 0.99}, False),
    ],
)
def test_branches_of_other_parameters(continuation_settings, changed, dropped):
    parameters = {
        "n": 1,
        "restitution": 0.85,
        "frequency_ratio": [10.0],
        "amplitude_max": 1.5,
        "points": 41,
    } | changed
    data = orbit_branches(parameters, "displacement", continuation_settings)
    result = cross_check(
        {"fig08": with_attributes(data, parameters, "displacement")}, continuation_settings
    )
    closed = int(result.orbits.sel(comparison=CLOSES).squeeze())
    assert closed == int(data.admissible.sum()) and (closed < 41) == dropped


def test_an_orbit_that_is_called_inadmissible_and_is_not_is_compared(
    branches, continuation_settings
):
    branches["admissible"][:] = False
    result = cross_check({"fig08": branches}, continuation_settings)
    assert int(result.orbits.sel(comparison=CLOSES).squeeze()) == 82


def test_a_sweep_beyond_the_end_of_the_continuation(continuation_settings):
    parameters = {
        "n": 1,
        "cases": [{"restitution": 0.65, "amplitude": 1.2}],
        "frequency_ratio": {"min": 0.5, "max": 1e3, "samples": 21},
    }
    data = apparent_restitution(parameters, "displacement")
    result = cross_check(
        {"fig06": with_attributes(data, parameters, "displacement")}, continuation_settings
    )
    there = int(np.isfinite(data.contact_duration).sum())
    assert int(result.orbits.sel(comparison=FORMULA).squeeze()) == there


def test_an_orbit_that_rounding_moves_far(continuation_settings):
    # Elastic, and the table hardly moves: the smallest singular value is 5e-6.
    parameters = {
        "n": 13,
        "restitution": 1.0,
        "amplitude": [0.001],
        "frequency_ratio": {"min": 0.1, "max": 1e6, "samples": 2},
    }
    data = with_attributes(frequency_sweep(parameters, "force"), parameters, "force")
    settings = continuation_settings.model_copy(update={"newton_tolerance": 1e-6})
    cross_check({"fig10": data}, settings)
    data["phase"][0, 0] += 1e-4
    with pytest.raises(CrossCheckError, match=r"ϖ = 0\.1"):
        cross_check({"fig10": data}, settings)


def test_contacts_without_a_saddle_node_are_not_compared(continuation_settings):
    parameters = {
        "n": [1],
        "restitution": 0.85,
        "frequency_ratio": {"min": 1.0, "max": 10.0, "samples": 5},
        "thresholds": {
            "n": 1,
            "restitution": 0.65,
            "amplitude": 1.0,
            "tolerance": 0.01,
            "quantities": ["permanent_contact"],
            "frequency_ratio": {"min": 1, "max": 9, "samples": 5},
        },
    }
    data = release_rules(parameters)
    missing = int(np.isnan(data.bifurcation_amplitude).sum())
    assert missing > 0
    result = cross_check({"ext_release": with_attributes(data, parameters)}, continuation_settings)
    compared = int(result.orbits.sel(comparison=FORMULA).squeeze())
    assert compared == data.bifurcation_amplitude.size - missing
